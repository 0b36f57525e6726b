//! Windows of bands that fall with l(l + 1), by a width that is given (docs/MATH.md#ringing).

use crate::families::family::{Acts, Family, Group, Proof, Spec};
use crate::families::parts::params::signal;
use crate::families::parts::zonal::log2_e;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Shape};
use crate::math::exact::Exact;

/// The orders that the catalogue has.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// Damps the square of the Laplacian instead of blurring.
const LAPLACIAN: &[&str] = &["laplacian"];

/// `window`.
pub static WINDOW: Family = Family {
    name: "window",
    stem: "window",
    group: Group::Irradiance,
    half: false,
    acts: Acts::Bands,
    proof: Proof::Nothing,
    choices: &[LAPLACIAN],
    what: |spec| {
        let order = spec.order;
        match spec.has(LAPLACIAN[0]) {
            false => format!(
                "Blurs a signal of order {order}: band l times exp(-mu l (l+1)), the diffusion of heat on the sphere. It keeps what is positive so far up as the bands go."
            ),
            true => format!(
                "Damps a signal of order {order}: band l times 1 / (1 + mu l^2 (l+1)^2) (Sloan 2008). Band 1 loses most of what is of use: `window:{order}` errs by less."
            ),
        }
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let doc = "how wide it is, not negative; 0 changes nothing";
        let mu = builder.param("mu", Shape::Scalar, Domain::Between(0.0, 1.0), doc)[0];
        let c = signal(&mut builder, spec.order);
        let g = &mut builder.graph;
        let factors = if spec.has(LAPLACIAN[0]) { damping(g, mu, spec.order) } else { heat(g, mu, spec.order) };
        let out = c.iter().enumerate().map(|(place, &c)| g.mul(c, factors[place.isqrt()])).collect();
        builder.finish(out, Shape::Array(spec.order * spec.order), "the windowed coefficients")
    },
    shown: |order| if SHOWN.contains(&order) { Spec::new(&WINDOW, order).both() } else { vec![] },
    ..Family::PLAIN
};

/// e^(−μ l(l+1)), each from the one below by t^l, where t = e^(−2μ).
fn heat(g: &mut Graph, mu: Id, order: usize) -> Vec<Id> {
    let exponent = g.scale(&-(Exact::int(2) * log2_e()), mu);
    let first = g.exp2(exponent);
    let one = g.constant(Exact::one());
    let mut power = first;
    let mut factors = vec![one, first];
    for l in 2..order {
        power = g.mul(power, first);
        factors.push(g.mul(factors[l - 1], power));
    }
    factors
}

fn damping(g: &mut Graph, mu: Id, order: usize) -> Vec<Id> {
    let factor = |l: usize| {
        let weight = (l * (l + 1)) as i64;
        let divisor = g.affine(&Exact::int(weight * weight), mu, &Exact::one());
        if l == 0 { g.constant(Exact::one()) } else { g.recip(divisor) }
    };
    (0..order).map(factor).collect()
}
