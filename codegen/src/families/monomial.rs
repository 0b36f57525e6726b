//! Evaluation in monomials: Σ over m of Re or Im (x + iy)^m times a polynomial in z, by Horner's rule. A coefficient costs
//! one operation a channel, which is the floor for n² free coefficients, and only the powers of x + iy are shared besides
//! (docs/MATH.md#monomials). The coefficients are turned once, when they are stored, by `to_monomial`.

use crate::families::family::{Acts, Family, Group, Measure, Spec};
use crate::families::parts::params::{direction, signal};
use crate::families::parts::phases::{Phase, turn};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::index::index;
use crate::math::tables;

/// `eval_monomial`.
pub static EVAL_MONOMIAL: Family = Family {
    name: "eval_monomial",
    stem: "eval_monomial",
    group: Group::Evaluate,
    what: |spec| {
        let order = spec.order;
        format!(
            "The sum of c_i y_i(dir) over the harmonics of order {order}, from the coefficients that `to_monomial:{order}` makes."
        )
    },
    kernel: |spec| eval(spec.order),
    measure: Measure::Whole,
    shown: |order| Spec::new(&EVAL_MONOMIAL, order).both(),
    ..Family::PLAIN
};

/// `to_monomial`.
pub static TO_MONOMIAL: Family = Family {
    name: "to_monomial",
    stem: "to_monomial",
    group: Group::Evaluate,
    what: |spec| {
        let order = spec.order;
        format!(
            "From the coefficients of the harmonics of order {order} to those of the monomials that `eval_monomial:{order}` takes; done once, when they are stored."
        )
    },
    kernel: |spec| from_harmonics(spec.order),
    acts: Acts::Mixes,
    shown: |order| Spec::new(&TO_MONOMIAL, order).both(),
    ..Family::PLAIN
};

const LAYOUT: &str = "of z^(l−|m|) Re (x+iy)^m, Im and |m| for m < 0, index l(l+1)+m";

/// The kernel `eval_monomial`: what `eval` returns, from the coefficients of monomials.
fn eval(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let c = builder.param("c", Shape::Array(order * order), Domain::Signal, format!("the coefficients {LAYOUT}"));
    let g = &mut builder.graph;
    let [x, y, z] = [dir[0], dir[1], dir[2]];
    let horner = |g: &mut Graph, m: isize| -> Id {
        let coefficients = (m.unsigned_abs()..order).map(|l| c[index(l, m)]);
        coefficients.rev().reduce(|nested, next| g.mul_add(nested, z, next)).expect("a column holds its own degree")
    };
    let mut sum = horner(g, 0);
    let mut power = Phase { cos: x, sin: y };
    for m in 1..order as isize {
        if m > 1 {
            power = turn(g, power, Phase { cos: x, sin: y });
        }
        for (part, sign) in [(power.cos, 1), (power.sin, -1)] {
            let column = horner(g, sign * m);
            sum = g.mul_add(column, part, sum);
        }
    }
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i y_i(dir)")
}

/// The kernel `to_monomial`: coefficients of harmonics to those that `eval_monomial` takes, a triangular map in each m.
fn from_harmonics(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let zero = g.constant(Exact::zero());
    let mut out = vec![zero; order * order];
    let extent = order as isize - 1;
    for m in -extent..=extent {
        let lowest = m.unsigned_abs();
        for l in (lowest..order).rev() {
            let factor = tables::basis_factor(l, m);
            for (power, value) in tables::legendre_polynomial(l, lowest).into_iter().enumerate() {
                let place = index(lowest + power, m);
                out[place] = g.scale_add(&(&factor * &value), c[index(l, m)], out[place]);
            }
        }
    }
    builder.finish(out, Shape::Array(order * order), format!("the coefficients {LAYOUT}"))
}
