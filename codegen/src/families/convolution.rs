//! Convolution with a zonal function, which multiplies each band by a number (docs/MATH.md#zonal-functions), and the
//! clamped cosine's, which makes irradiance of radiance (docs/MATH.md#the-clamped-cosine).

use crate::families::family::{Acts, Family, Group, Spec};
use crate::families::parts::columns;
use crate::families::parts::params::signal;
use crate::families::parts::zonal::cosine_lobe;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};

/// The orders that the catalogue has: those of DirectXMath.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// `convolve`.
pub static CONVOLVE: Family = Family {
    name: "convolve",
    stem: "convolve",
    group: Group::Light,
    acts: Acts::Bands,
    what: |spec| {
        format!(
            "Convolves a signal of order {} with the function of the angle whose zonal coefficients are given: band l times sqrt(4 pi / (2l+1)) g_l (Funk 1916, Hecke 1918).",
            spec.order
        )
    },
    kernel: |spec| convolve(spec.order),
    shown: |order| shown(&CONVOLVE, order),
    ..Family::PLAIN
};

/// `convolve_cosine`.
pub static CONVOLVE_COSINE: Family = Family {
    name: "convolve_cosine",
    stem: "convolve_cosine",
    group: Group::Light,
    acts: Acts::Bands,
    what: |spec| {
        format!(
            "Convolves a signal of order {} with the clamped cosine: radiance becomes irradiance, band l times pi, 2 pi/3, pi/4, 0, -pi/24, 0, pi/64 and so on (Ramamoorthi and Hanrahan 2001). Divided by pi it is what a white surface sends out.",
            spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let c = signal(&mut builder, spec.order);
        let g = &mut builder.graph;
        let out = c.iter().enumerate().map(|(place, &c)| g.scale(&cosine_lobe(place.isqrt()), c)).collect();
        builder.finish(out, Shape::Array(spec.order * spec.order), "the coefficients of the irradiance")
    },
    shown: |order| shown(&CONVOLVE_COSINE, order),
    ..Family::PLAIN
};

fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { Spec::new(family, order).both() } else { vec![] }
}

fn convolve(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let doc = "the zonal coefficients of the function, one a band";
    let zonal = builder.param("g", Shape::Array(order), Domain::Zonal, doc);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let factors: Vec<_> = zonal.iter().enumerate().map(|(l, &g_l)| g.scale(&columns::zonal(l), g_l)).collect();
    let out = c.iter().enumerate().map(|(place, &c)| g.mul(c, factors[place.isqrt()])).collect();
    builder.finish(out, Shape::Array(order * order), "the convolved coefficients")
}
