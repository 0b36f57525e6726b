//! The integral of a signal that is kept as weights of zonal lobes, and turned, times another: given as coefficients, or as
//! weights of lobes too (docs/MATH.md#coupling-of-lobes). Only the lobes' directions are turned.

use crate::families::family::{Acts, Family, Group, Measure, Spec};
use crate::families::parts::legendre::{leading, monic};
use crate::families::parts::params::quaternion;
use crate::families::parts::quaternion::matrix_of_quaternion;
use crate::families::parts::sums::inner;
use crate::families::parts::{columns, turned};
use crate::families::zhf::lobes;
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::Exact;

/// What both families share.
const COUPLED: Family = Family {
    group: Group::Factorise,
    orders: 2..=10,
    outside: |order| {
        let message = format!("no lobe directions are known for order {order}");
        [message, "lobes have orders 2 to 10; `rotate`, then `dot` take others".to_owned()]
    },
    half: false,
    measure: Measure::Product,
    acts: Acts::Mixes,
    ..Family::PLAIN
};

/// `zhf_dot`.
pub static ZHF_DOT: Family = Family {
    name: "zhf_dot",
    stem: "zhf_dot",
    what: |spec| {
        let order = spec.order;
        format!(
            "The integral of a sum of zonal lobes of order {order}, turned, times a signal: w_lj multiplies y_l^0 about lobe j of band l, and is what `zhf_weights:{order}` makes times sqrt((2l+1) / 4 pi) (Nowrouzezahrai et al. 2012, section 7.2)."
        )
    },
    kernel: |spec| with_signal(spec.order),
    shown: |order| if matches!(order, 3 | 4) { Spec::new(&ZHF_DOT, order).both() } else { vec![] },
    ..COUPLED
};

/// `zhf_dot_lobes`.
pub static ZHF_DOT_LOBES: Family = Family {
    name: "zhf_dot_lobes",
    stem: "zhf_dot_lobes",
    what: |spec| {
        let order = spec.order;
        format!(
            "The integral of a sum of zonal lobes of order {order}, turned, times another such sum that is not: w_lj and v_lj multiply y_l^0 about lobe j of band l, and are what `zhf_weights:{order}` makes times sqrt((2l+1) / 4 pi) (Nowrouzezahrai et al. 2012, section 7.2)."
        )
    },
    kernel: |spec| with_lobes(spec.order),
    shown: |order| if matches!(order, 3 | 4) { Spec::new(&ZHF_DOT_LOBES, order).both() } else { vec![] },
    ..COUPLED
};

/// Declares the weights of lobes.
fn weights(builder: &mut Builder, name: &'static str, order: usize) -> Vec<Id> {
    let doc = "the weights of the lobes, 2l+1 for band l from l^2 on, in the order of the band's lobes";
    builder.param(name, Shape::Array(order * order), Domain::Signal, doc)
}

fn directions(order: usize) -> Vec<[Exact; 3]> {
    lobes(order).directions.iter().map(|lobe| lobe.xyz()).collect()
}

/// Σ_l n*_l Σ_j w_lj Σ_m g_lm y_lm(R ω_j), n*_l = √(4π / (2l + 1)).
fn with_signal(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let w = weights(&mut builder, "w", order);
    let doc = "the coefficients of the other signal, index l(l+1)+m";
    let signal = builder.param("g", Shape::Array(order * order), Domain::Signal, doc);
    let g = &mut builder.graph;
    let rows = matrix_of_quaternion(g, &q);
    let sum = turned::sum(g, &rows, &directions(order), &lobes(order).subsets, &w, &signal, columns::zonal);
    builder.finish(vec![sum], Shape::Scalar, COUPLING)
}

/// Σ_l Σ_ij w_lj v_li P_l(R ω_j · ω_i).
fn with_lobes(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let w = weights(&mut builder, "w", order);
    let v = weights(&mut builder, "v", order);
    let g = &mut builder.graph;
    let rows = matrix_of_quaternion(g, &q);
    let constant = directions(order);
    let turned = turned::directions(g, &rows, &constant);
    let values: Vec<Vec<Vec<Id>>> = constant
        .iter()
        .map(|fixed| {
            turned
                .iter()
                .map(|moved| {
                    let cosine = g.dot(fixed, moved);
                    monic(g, cosine, order)
                })
                .collect()
        })
        .collect();
    let mut sum = None;
    for (l, members) in lobes(order).subsets.iter().enumerate() {
        let range = l * l..(l + 1) * (l + 1);
        let of_fixed: Vec<Id> = members
            .iter()
            .map(|&fixed| {
                let at: Vec<Id> = members.iter().map(|&moved| values[fixed][moved][l]).collect();
                inner(g, &w[range.clone()], &at)
            })
            .collect();
        let of_band = inner(g, &of_fixed, &v[range]);
        let term = g.scale(&leading(l), of_band);
        sum = Some(sum.map_or(term, |sum| g.add(sum, term)));
    }
    let sum = sum.expect("there is a band 0");
    builder.finish(vec![sum], Shape::Scalar, COUPLING)
}

/// What is returned.
const COUPLING: &str = "the integral of the product";
