//! How the coefficients of a hemispherical record change as its point moves in the tangent plane: the exact derivative, a
//! sample at a time, bounded at pole and horizon (docs/MATH.md#translational-gradients).

use crate::families::family::{Acts, Family, Measure, Proof, Spec};
use crate::families::hemisphere::COMMON;
use crate::families::hemisphere::evaluate::{hemispheric, stretch};
use crate::families::parts::columns;
use crate::families::parts::derivative::derivatives;
use crate::families::parts::sums::inner;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::Exact;

/// The least cosine that a hit is taken to be seen at, as numerator and denominator: the derivative divides by it.
pub const GRAZING: [i64; 2] = [1, 10];

/// `hsh_gradient`.
pub static HSH_GRADIENT: Family = Family {
    name: "hsh_gradient",
    stem: "hsh_gradient",
    what: |spec| {
        format!(
            "What one sample adds to the derivative of the hemispherical coefficients of order {} as their point moves in the tangent plane: exact, where Gautron et al. 2004 take a difference. To be multiplied by the sample's weight, 2 pi / N of N uniform ones; all scales as 1 / r. A hit seen at a cosine below 0.1 counts as one seen at 0.1.",
            spec.order
        )
    },
    measure: Measure::Norm,
    acts: Acts::Mixes,
    proof: Proof::Nothing,
    kernel: |spec| gradient(spec.order),
    shown: |order| if matches!(order, 3 | 4 | 6) { Spec::new(&HSH_GRADIENT, order).both() } else { vec![] },
    ..COMMON
};

/// L (dH + H (3 ω·e + m·e / cos ξ) / r), of which dH is the derivative along the motion of ω by −(e − ω (ω·e)) / r.
fn gradient(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let doc = "the direction of the sample, of unit length, above the horizon";
    let dir = builder.param("dir", Shape::Vec3, Domain::Hemisphere, doc);
    let doc = "the direction in which the point moves, of unit length, in the tangent plane: its z counts as zero";
    let e = builder.param("e", Shape::Vec3, Domain::Direction, doc);
    let doc = "the distance from the point to what the sample hits, above zero";
    let r = builder.param("r", Shape::Scalar, Domain::Between(1.0, 1000.0), doc)[0];
    let doc = "the normal of what the sample hits, of unit length, on the side of the point";
    let m = builder.param("m", Shape::Vec3, Domain::Direction, doc);
    let doc = "the radiance that the sample sees, one number a channel";
    let light = builder.param("light", Shape::Scalar, Domain::Signal, doc)[0];
    let g = &mut builder.graph;
    let [k, height] = stretch(g, dir[2]);
    let (x, y) = (g.mul(k, dir[0]), g.mul(k, dir[1]));
    let inverse = g.recip(r);
    let [along, toward] = [inner(g, &dir[..2], &e[..2]), inner(g, &m[..2], &e[..2])];
    let pull = g.mul(along, inverse);
    // 1 + 1 / (2 (1 + z)), times υ; twice z + 1 is the stretched height and three.
    let twice = g.affine(&Exact::one(), height, &Exact::int(3));
    let share = g.recip(twice);
    let swing = g.mul_add(share, pull, pull);
    let lever = g.mul(k, inverse);
    let mut moved = |at, e| {
        let push = g.mul(lever, e);
        let carried = g.mul(at, swing);
        g.sub(carried, push)
    };
    let (dx, dy) = (moved(x, e[0]), moved(y, e[1]));
    let double = g.affine(&Exact::one(), height, &Exact::one());
    let dz = g.mul(double, pull);
    let values = columns::values(g, &[x, y, height], order, hemispheric);
    let slopes = derivatives(g, &values, &[[x, dx], [y, dy], [height, dz]]);
    let facing = inner(g, &dir, &m);
    let facing = g.neg(facing);
    let least = g.constant(Exact::ratio(GRAZING[0], GRAZING[1]));
    let cosine = g.max(facing, least);
    let secant = g.recip(cosine);
    let change = g.mul(toward, secant);
    let change = g.scale_add(&Exact::int(3), along, change);
    let change = g.mul(change, inverse);
    let out = values
        .iter()
        .zip(&slopes)
        .map(|(&value, &slope)| {
            let sum = g.mul_add(value, change, slope);
            g.mul(light, sum)
        })
        .collect();
    let doc = "what the sample adds to the derivative along e, index l(l+1)+m";
    builder.finish(out, Shape::Array(order * order), doc)
}
