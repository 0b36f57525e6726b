//! Irradiance from four coefficients or five, for probes that hold no more: reconstructions that are not linear, so that
//! they neither blend nor filter (docs/MATH.md#ringing).

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
        let linear = linear(g, dot, c[0]);
        let out = g.mul_add(guess, zonal, linear);
        builder.finish(vec![out], Shape::Scalar, "the irradiance")
    },
    shown: |order| Spec::only(&EVAL_ZH3, order).into_iter().collect(),
    ..OF_FOUR
};

/// `eval_zh3:stored`.
pub static EVAL_ZH3_STORED: Family = Family {
    name: "eval_zh3",
    method: "stored",
    stem: "eval_zh3_stored",
    usual: |_, _| false,
    what: |_| {
        "Irradiance by the normal from the four coefficients of irradiance of one channel and the one of a zonal band 2 about the direction of band 1, which `to_zh3` makes (Roughton et al. 2024): not linear in the coefficients, and it may be negative.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let dir = direction(&mut builder);
        let doc = "the four coefficients of the irradiance of one channel, index l(l+1)+m, and its zonal band 2";
        let c = builder.param("c", Shape::Array(5), Domain::Coefficients, doc);
        let g = &mut builder.graph;
        let (axis, square) = axis(g, &c);
        let dot = inner(g, &axis, &dir);
        let inverse = g.recip(square);
        let cosine = g.mul(dot, dot);
        let cosine = g.mul(cosine, inverse);
        // √(5/16π) (3 cos² − 1).
        let factor = Exact::sqrt_ratio(5, 16) * Exact::pi_sqrt_power(-1);
        let zonal = g.affine(&(&factor * &Exact::int(3)), cosine, &-factor);
        let linear = linear(g, dot, c[0]);
        let out = g.mul_add(zonal, c[4], linear);
        builder.finish(vec![out], Shape::Scalar, "the irradiance")
    },
    shown: |order| Spec::only(&EVAL_ZH3_STORED, order).into_iter().collect(),
    ..OF_FOUR
};

/// `to_zh3`.
pub static TO_ZH3: Family = Family {
    name: "to_zh3",
    stem: "to_zonal_quadratic",
    orders: 3..=3,
    what: |_| {
        "From the nine coefficients of one channel to the four of bands 0 and 1 and one of a zonal band 2 about the direction of band 1, which is next to band 2 in the mean square; zero where band 1 is (Roughton et al. 2024).".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let doc = "the nine coefficients of one channel, index l(l+1)+m, of radiance or of irradiance";
        let c = builder.param("c", Shape::Array(9), Domain::Coefficients, doc);
        let g = &mut builder.graph;
        let ([x, y, z], square) = axis(g, &c);
        // √(4π/5) Σ c_2m y_2m(a) = √3 (c4 xy − c5 yz − c7 xz + c8 (x² − y²) / 2) + c6 (2z² − x² − y²) / 2.
        let half = Exact::ratio(1, 2);
        let (x2, y2) = (g.mul(x, x), g.mul(y, y));
        let difference = g.sub(x2, y2);
        let sum = g.add(x2, y2);
        let down = g.scale(&half, sum);
        let z2 = g.mul(z, z);
        let height = g.sub(z2, down);
        let [of_y, of_z] = [g.mul(c[4], y), g.mul(c[7], z)];
        let of_x = g.sub(of_y, of_z);
        let of_x = g.mul(of_x, x);
        let yz = g.mul(y, z);
        let of_yz = g.mul(c[5], yz);
        let across = g.sub(of_x, of_yz);
        let halved = g.scale(&half, c[8]);
        let across = g.mul_add(halved, difference, across);
        let along = g.mul(c[6], height);
        let value = g.scale_add(&Exact::sqrt_ratio(3, 1), across, along);
        let inverse = g.recip(square);
        let zonal = g.mul(value, inverse);
        let mut out = c[..4].to_vec();
        out.push(zonal);
        builder.finish(out, Shape::Array(5), "the five coefficients")
    },
    shown: |order| Spec::only(&TO_ZH3, order).into_iter().collect(),
    ..OF_FOUR
};

fn declared(builder: &mut Builder) -> (Vec<Id>, Vec<Id>) {
    let dir = direction(builder);
    let doc = "the four coefficients of the irradiance of one channel, index l(l+1)+m";
    (dir, builder.param("c", Shape::Array(4), Domain::Coefficients, doc))
}

/// The vector of band 1, and its square, a tiny number more.
fn axis(g: &mut Graph, c: &[Id]) -> ([Id; 3], Id) {
    let axis = [g.neg(c[3]), g.neg(c[1]), c[2]];
    let tiny = g.tiny();
    (axis, axis.iter().fold(tiny, |sum, &a| g.mul_add(a, a, sum)))
}

/// Bands 0 and 1.
fn linear(g: &mut Graph, dot: Id, first: Id) -> Id {
    let mean = g.scale(&(Exact::ratio(1, 2) * Exact::pi_sqrt_power(-1)), first);
    g.scale_add(&(Exact::sqrt_ratio(3, 4) * Exact::pi_sqrt_power(-1)), dot, mean)
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
    let (axis, square) = axis(g, c);
    let shorter = g.rsqrt(square);
    let size = g.mul(square, shorter);
    let tiny = g.tiny();
    let positive = g.max(c[0], tiny);
    Lobe { dot: inner(g, &axis, dir), size, shorter, inverse: g.recip(positive) }
}
