//! Irradiance from four coefficients, for probes that hold no more: two reconstructions that are not linear, so that they
//! neither blend nor filter (docs/MATH.md#ringing).

use crate::families::family::{Family, Group, Measure, Proof, Spec};
use crate::families::parts::params::direction;
use crate::families::parts::sums::inner;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Shape};
use crate::math::exact::Exact;

/// What the records of this file leave as it is.
const OF_FOUR: Family = Family {
    group: Group::Irradiance,
    orders: 2..=2,
    one_order: true,
    half: false,
    measure: Measure::Absolute,
    proof: Proof::Nothing,
    ..Family::PLAIN
};

/// `eval_geomerics`.
pub static EVAL_GEOMERICS: Family = Family {
    name: "eval_geomerics",
    stem: "eval_geomerics",
    what: |_| {
        "Irradiance by the normal from the four coefficients of irradiance of one channel, as if of a light and an ambient (the reconstruction of Geomerics): never negative where band 0 is positive, and not linear in the coefficients. H4 from radiance of order 3 errs as little with as many numbers, by three operations.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let (dir, c) = declared(&mut builder);
        let g = &mut builder.graph;
        let Lobe { dot, size, shorter, inverse } = lobe(g, &dir, &c);
        let one = g.constant(Exact::one());
        // r = √3/2 |c1| / c0, at most 1.
        let ratio = g.scale(&Exact::sqrt_ratio(3, 4), size);
        let ratio = g.mul(ratio, inverse);
        let ratio = g.min(ratio, one);
        let sum = g.add(ratio, one);
        let sum = g.recip(sum);
        let ambient = g.affine(&Exact::int(2), sum, &-Exact::one());
        let exponent = g.affine(&Exact::int(2), ratio, &Exact::one());
        let cosine = g.mul(dot, shorter);
        let half = Exact::ratio(1, 2);
        let height = g.affine(&half, cosine, &half);
        let tiny = g.tiny();
        let height = g.max(height, tiny);
        let logarithm = g.log2(height);
        let logarithm = g.mul(exponent, logarithm);
        let power = g.exp2(logarithm);
        let four = g.scale(&Exact::int(4), ratio);
        let shape = g.mul_add(four, power, ambient);
        let mean = g.scale(&(half * Exact::pi_sqrt_power(-1)), c[0]);
        let out = g.mul(mean, shape);
        builder.finish(vec![out], Shape::Scalar, "the irradiance")
    },
    shown: |order| Spec::only(&EVAL_GEOMERICS, order).into_iter().collect(),
    ..OF_FOUR
};

/// `eval_zh3`.
pub static EVAL_ZH3: Family = Family {
    name: "eval_zh3",
    stem: "eval_zh3_hallucinated",
    what: |_| {
        "Irradiance by the normal from the four coefficients of irradiance of one channel, with a zonal band 2 about the direction of band 1 that is guessed of both (Roughton et al. 2024): not linear in the coefficients, and it may be negative.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let (dir, c) = declared(&mut builder);
        let g = &mut builder.graph;
        let Lobe { dot, size, shorter, inverse } = lobe(g, &dir, &c);
        // Of radiance the ratio is L = 3/2 |c1| / c0, at most √3; the guess is |L1| (0.08 + 0.6 L), |L1| = 3/(2π) |c1|.
        let most = g.constant(Exact::sqrt_ratio(4, 3));
        let ratio = g.mul(size, inverse);
        let ratio = g.min(ratio, most);
        // A_2 √(5/16π) 3/(2π).
        let factor = Exact::sqrt_ratio(5, 16) * Exact::pi_sqrt_power(-1) * Exact::ratio(3, 8);
        let guess = g.affine(&(&factor * &Exact::ratio(9, 10)), ratio, &(&factor * &Exact::ratio(2, 25)));
        // |c1| (3 cos² − 1).
        let square = g.mul(dot, dot);
        let square = g.mul(square, shorter);
        let minus = g.neg(size);
        let zonal = g.scale_add(&Exact::int(3), square, minus);
        let mean = g.scale(&(Exact::ratio(1, 2) * Exact::pi_sqrt_power(-1)), c[0]);
        let linear = g.scale_add(&(Exact::sqrt_ratio(3, 4) * Exact::pi_sqrt_power(-1)), dot, mean);
        let out = g.mul_add(guess, zonal, linear);
        builder.finish(vec![out], Shape::Scalar, "the irradiance")
    },
    shown: |order| Spec::only(&EVAL_ZH3, order).into_iter().collect(),
    ..OF_FOUR
};

fn declared(builder: &mut Builder) -> (Vec<Id>, Vec<Id>) {
    let dir = direction(builder);
    let doc = "the four coefficients of the irradiance of one channel, index l(l+1)+m";
    (dir, builder.param("c", Shape::Array(4), Domain::Coefficients, doc))
}

/// What both take of band 1.
struct Lobe {
    /// Its vector times the normal.
    dot: Id,
    /// Its length.
    size: Id,
    /// One over its length; finite where it vanishes.
    shorter: Id,
    /// One over band 0; finite where that is not positive.
    inverse: Id,
}

fn lobe(g: &mut Graph, dir: &[Id], c: &[Id]) -> Lobe {
    let axis = [g.neg(c[3]), g.neg(c[1]), c[2]];
    let tiny = g.tiny();
    let square = axis.iter().fold(tiny, |sum, &a| g.mul_add(a, a, sum));
    let shorter = g.rsqrt(square);
    let size = g.mul(square, shorter);
    let positive = g.max(c[0], tiny);
    Lobe { dot: inner(g, &axis, dir), size, shorter, inverse: g.recip(positive) }
}
