//! Shading by weights of rotated zonal harmonics, as the paper writes it: by the light's bands at the turned directions
//! (equation 22), or, where the light is a zonal function, by Legendre polynomials of the cosines (equations 24 and 34). It
//! equals the direct form, at more operations (docs/MATH.md#isotropic-decomposition).

use crate::families::family::Family;
use crate::families::isd::decomposition::{ORDERS, directions, outside, shown, weights};
use crate::families::isd::{SHADED, SHADING, light_and_back, to_local, zonal_light};
use crate::families::parts::legendre::{leading, monic};
use crate::families::parts::quaternion::turned;
use crate::families::parts::sums::inner;
use crate::families::parts::{columns, turned as lobes};
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Kernel, Shape};

/// `isd_shade`.
pub static ISD_SHADE: Family = Family {
    name: "isd_shade",
    stem: "isd_shade",
    what: |spec| {
        let order = spec.order;
        format!(
            "Shades by isotropic decomposition of order {order}: the light's bands at the directions, turned to the world, times the weights that `isd_weights:{order}` makes (Soler et al. 2015, equation 22). `shade:{order}` gives the same for fewer operations."
        )
    },
    orders: ORDERS,
    outside,
    kernel: |spec| environment(spec.order),
    shown: |order| shown(&ISD_SHADE, order),
    ..SHADING
};

/// `isd_shade_zonal`.
pub static ISD_SHADE_ZONAL: Family = Family {
    name: "isd_shade_zonal",
    stem: "isd_shade_zonal",
    what: |spec| {
        let order = spec.order;
        format!(
            "Shades by isotropic decomposition of order {order} under a light that is a zonal function about a direction, as a sphere or a cone is, by the weights that `isd_weights:{order}` makes (Soler et al. 2015, equations 24 and 34). `shade_zonal:{order}` gives the same for fewer operations."
        )
    },
    orders: ORDERS,
    outside,
    kernel: |spec| zonal(spec.order),
    shown: |order| shown(&ISD_SHADE_ZONAL, order),
    ..SHADING
};

/// Σ π_l λ_l^j Σ_k e_l^k y_l^k(R⁻¹ z^j).
fn environment(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let (e, back) = light_and_back(&mut builder, order);
    let lambda = weights(&mut builder, order);
    let g = &mut builder.graph;
    let set = directions(order);
    let first = |l: usize| (0..2 * l + 1).collect();
    let bands: Vec<Vec<usize>> = (0..order).map(first).collect();
    let sum = lobes::sum(g, &back, &set.directions, &bands, &lambda, &e, columns::zonal);
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}

/// Σ g_l Σ_j λ_l^j P_l(R d · z^j): π_l √((2l + 1) / 4π) is one.
fn zonal(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = to_local(&mut builder);
    let [dir, bands] = zonal_light(&mut builder, order);
    let lambda = weights(&mut builder, order);
    let g = &mut builder.graph;
    let dir = turned(g, &q, [dir[0], dir[1], dir[2]]);
    let values: Vec<Vec<Id>> = directions(order)
        .directions
        .iter()
        .map(|z| {
            let cosine = g.dot(z, &dir);
            monic(g, cosine, order)
        })
        .collect();
    let mut sum = None;
    for (l, &band) in bands.iter().enumerate() {
        let at: Vec<Id> = values[..2 * l + 1].iter().map(|of| of[l]).collect();
        let of_band = inner(g, &lambda[l * l..(l + 1) * (l + 1)], &at);
        let factor = g.scale(&leading(l), band);
        let term = g.mul(of_band, factor);
        sum = Some(sum.map_or(term, |sum| g.add(sum, term)));
    }
    let sum = sum.expect("there is a band 0");
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}
