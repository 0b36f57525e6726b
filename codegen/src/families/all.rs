//! The list of all families: a row each. Whatever is done for every family, or finds one by its name, reads it.

use crate::families::family::Family;
use crate::families::{
<<<<<<< HEAD
    about_y, align, axis, basis, convolution, fitted, lifted, lights, monomial, small_turn, tensor, tilt, zhf, zonal,
    zonal_functions, zxzxz, zyz,
=======
    about_y, align, axis, basis, lifted, monomial, product, small_turn, tensor, tilt, zhf, zonal, zxzxz, zyz,
>>>>>>> products
};

/// Every family, by group; the catalogue and every list of families are in this order.
pub static ALL: &[&Family] = &[
    &basis::BASIS,
    &basis::EVAL,
    &monomial::EVAL_MONOMIAL,
    &monomial::TO_MONOMIAL,
    &zyz::ZYZ,
    &tensor::TENSOR,
    &tensor::MATRIX,
    &zyz::EULER,
    &zyz::ANGLES,
    &zyz::FROM_ANGLES,
    &lifted::LIFTED,
    &lifted::ROTATE_LIFTED,
    &zxzxz::ZXZXZ,
    &align::ALIGN,
    &zonal::ZONAL,
    &tilt::TILT,
    &tilt::TILT_PRESCALED,
    &tilt::TILT_SCALE,
    &tilt::TILT_UNSCALE,
    &about_y::ABOUT_Y,
    &about_y::SMALL_ZYZ,
    &small_turn::ROTATE_SMALL,
    &small_turn::ROTATE_ADAPTIVE,
    &zhf::ZHF,
    &zhf::ZHF_WEIGHTS,
    &zhf::ZHF_TAILORED,
    &axis::ROTATE_Z,
    &axis::ROTATE_Y,
    &axis::SWAP_YZ,
    &axis::ROTATE_X_PLUS_90,
    &axis::ROTATE_X_MINUS_90,
<<<<<<< HEAD
    &zonal_functions::CAP,
    &zonal_functions::GAUSSIAN,
    &zonal_functions::GAUSSIAN_NARROW,
    &zonal_functions::PHONG,
    &zonal_functions::HENYEY_GREENSTEIN,
    &convolution::CONVOLVE,
    &convolution::CONVOLVE_COSINE,
    &convolution::IRRADIANCE,
    &lights::LIGHT_DIRECTIONAL,
    &lights::LIGHT_SPHERE,
    &lights::LIGHT_CONE,
    &lights::LIGHT_HEMISPHERE,
    &lights::LIGHT_GAUSSIAN,
    &fitted::DOMINANT,
    &fitted::LIGHT_FIT,
    &fitted::LIGHT_FIT_ALONG,
=======
    &product::PRODUCT,
    &product::SQUARE,
    &product::DOT,
    &product::grey::MATRIX,
    &product::grey::BY_MATRIX,
    &product::grey::GREY,
    &product::zonal::ZONAL,
    &product::zonal::ZONAL_ABOUT,
    &product::zonal::ZONAL_ANGLES,
    &product::zonal::COSINE,
    &product::zonal::COSINE_ABOUT,
    &product::zonal::COSINE_ANGLES,
    &product::zonal::HEMISPHERE,
    &product::zonal::HEMISPHERE_ABOUT,
    &product::zonal::HEMISPHERE_ANGLES,
    &product::zonal::AXIS_ANGLES,
>>>>>>> products
    #[cfg(test)]
    &super::toy::EXCHANGED_Y,
];
