//! The list of all families: a row each. Whatever is done for every family, or finds one by its name, reads it.

use crate::families::family::Family;
use crate::families::{
    about_y, align, axis, basis, lifted, monomial, small_turn, tensor, tilt, zhf, zonal, zxzxz, zyz,
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
    #[cfg(test)]
    &super::toy::EXCHANGED_Y,
];
