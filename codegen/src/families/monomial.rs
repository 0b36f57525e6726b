//! Evaluation in monomials: Σ over m of Re or Im (x + iy)^m times a polynomial in z, by Horner's rule. A coefficient costs
//! one operation a channel, which is the floor for n² free coefficients, and only the powers of x + iy are shared besides
//! (docs/MATH.md#monomials). The coefficients are turned once, when they are stored, by `to_monomial`.

use crate::families::{Phase, rotate, turn};
use crate::ir::graph::{Graph, Id, Kind};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::index::index;
use crate::math::tables;

const LAYOUT: &str = "of z^(l−|m|) Re (x+iy)^m, Im and |m| for m < 0, index l(l+1)+m";

/// The kernel `eval_monomial`: what `eval` returns, from the coefficients of monomials.
pub fn eval(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Vec3, Kind::Scalar, "the direction, of unit length");
    let c = builder.param("c", Shape::Array(order * order), Kind::Signal, format!("the coefficients {LAYOUT}"));
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
pub fn from_harmonics(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = rotate::signal(&mut builder, order);
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
