//! The decomposition itself: weights of rotated zonal harmonics from coefficients, and back
//! (docs/MATH.md#isotropic-decomposition).

use crate::families::family::{Acts, Family, Group, Spec};
use crate::families::isd::directions::{Shared, shared};
use crate::families::parts::bands::each_band;
use crate::families::parts::params::signal;
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Shape};
use std::ops::RangeInclusive;

/// The orders of kernels with shared directions.
pub const ORDERS: RangeInclusive<usize> = 3..=11;
/// Those of the catalogue.
pub const SHOWN: RangeInclusive<usize> = 3..=5;

/// What is wrong with another order.
pub fn outside(order: usize) -> [String; 2] {
    let [least, most] = [ORDERS.start(), ORDERS.end()];
    let help = format!("kernels with shared directions have orders {least} to {most}; `shade` takes others");
    [format!("no shared directions are made into kernels of order {order}"), help]
}

/// What both families share.
const DECOMPOSED: Family =
    Family { group: Group::Shade, acts: Acts::Bands, half: false, orders: ORDERS, outside, ..Family::PLAIN };

/// `isd_matrix`.
pub static ISD_MATRIX: Family = Family {
    name: "isd_matrix",
    stem: "isd_matrix",
    what: |spec| {
        format!(
            "From the weights of rotated zonal harmonics to coefficients of order {}: c = M lambda, M_kj = sqrt(4 pi / (2l+1)) y_l^k(z^j) for the directions z^j, of which band l uses the first 2l+1 (Soler et al. 2015, equation 10).",
            spec.order
        )
    },
    kernel: |spec| {
        let order = spec.order;
        let mut builder = Builder::new();
        let lambda = weights(&mut builder, order);
        let set = directions(order);
        let out = each_band(&mut builder.graph, &lambda, order, |g, l, band| {
            set.matrix(l).iter().map(|row| g.dot(row, band)).collect()
        });
        builder.finish(out, Shape::Array(order * order), "the coefficients, index l(l+1)+m")
    },
    shown: |order| shown(&ISD_MATRIX, order),
    ..DECOMPOSED
};

/// `isd_weights`.
pub static ISD_WEIGHTS: Family = Family {
    name: "isd_weights",
    stem: "isd_weights",
    what: |spec| {
        let order = spec.order;
        format!(
            "From coefficients of order {order} to the weights of rotated zonal harmonics: the inverse of `isd_matrix:{order}` (Soler et al. 2015)."
        )
    },
    kernel: |spec| {
        let order = spec.order;
        let mut builder = Builder::new();
        let c = signal(&mut builder, order);
        let set = directions(order);
        let out = each_band(&mut builder.graph, &c, order, |g, l, band| {
            set.inverse(l).iter().map(|row| g.dot(row, band)).collect()
        });
        builder.finish(out, Shape::Array(order * order), WEIGHTS)
    },
    shown: |order| shown(&ISD_WEIGHTS, order),
    ..DECOMPOSED
};

/// What weights are.
const WEIGHTS: &str = "the weights, 2l+1 for band l from l^2 on, in the order of the directions";

/// The rows of the catalogue of a family of these orders.
pub fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { Spec::new(family, order).both() } else { vec![] }
}

/// Declares the weights.
pub fn weights(builder: &mut Builder, order: usize) -> Vec<Id> {
    builder.param("lambda", Shape::Array(order * order), Domain::Signal, WEIGHTS)
}

/// Returns the directions of an order that a spec may have.
pub fn directions(order: usize) -> &'static Shared {
    shared(order).expect("a spec's order was checked to have directions")
}
