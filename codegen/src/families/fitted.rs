//! What is found of a signal: its dominant direction, and the directional light and the ambient that come nearest to its
//! irradiance (Sloan 2008; docs/MATH.md#lights-from-a-signal).

use crate::families::basis;
use crate::families::family::{Family, Group, Measure, Proof, Spec};
use crate::families::parts::params::{direction, signal};
use crate::families::parts::sums::inner;
use crate::families::parts::zonal::{cosine_lobe, delta};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Shape};
use crate::math::exact::Exact;

/// The orders that the catalogue has: those of DirectXMath.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// `dominant`.
pub static DOMINANT: Family = Family {
    name: "dominant",
    stem: "dominant",
    direction: Some(0),
    group: Group::Light,
    half: false,
    measure: Measure::Absolute,
    proof: Proof::Nothing,
    what: |spec| {
        format!(
            "The dominant direction of a signal of order {}, in which the irradiance of its bands 0 and 1 is largest (Sloan 2008): of an RGB signal give the luminance. It is z where band 1 is zero, or its square below 2^-126: for bands from 1e-19 to 1e19 in size.",
            spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder, spec.order);
        let found = dominant(&mut builder.graph, &c);
        builder.finish(found.to_vec(), Shape::Vec3, "the direction, of unit length")
    },
    shown: |order| shown(&DOMINANT, order),
    ..Family::PLAIN
};

/// `light_fit`.
pub static LIGHT_FIT: Family = Family {
    name: "light_fit",
    stem: "light_fit",
    direction: Some(0),
    group: Group::Light,
    half: false,
    measure: Measure::Absolute,
    proof: Proof::Nothing,
    what: |spec| {
        format!(
            "The directional light in the dominant direction of a signal of order {}, and the ambient radiance, whose irradiance together is nearest to that of the signal (Sloan 2008). Of an RGB signal give the luminance, then take `light_fit_along:{}:rgb`. The light of zeros is zero, from z.",
            spec.order, spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder, spec.order);
        let g = &mut builder.graph;
        let dir = dominant(g, &c);
        let [light, ambient] = fit(g, spec.order, &dir, &c);
        let [x, y, z] = dir;
        let doc = "the direction x, y, z of unit length, the light's irradiance, the ambient radiance";
        builder.finish(vec![x, y, z, light, ambient], Shape::Array(5), doc)
    },
    shown: |order| shown(&LIGHT_FIT, order),
    ..Family::PLAIN
};

/// `light_fit_along`.
pub static LIGHT_FIT_ALONG: Family = Family {
    name: "light_fit_along",
    stem: "light_fit_along",
    group: Group::Light,
    measure: Measure::Whole,
    what: |spec| {
        format!(
            "The directional light from a given direction, and the ambient radiance, whose irradiance together is nearest to that of a signal of order {} (Sloan 2008): what `light_fit` does, in each channel, where the direction is known.",
            spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let dir = direction(&mut builder);
        let c = signal(&mut builder, spec.order);
        let found = fit(&mut builder.graph, spec.order, &dir, &c);
        builder.finish(found.to_vec(), Shape::Array(2), "the light's irradiance, the ambient radiance")
    },
    shown: |order| if SHOWN.contains(&order) { Spec::new(&LIGHT_FIT_ALONG, order).both() } else { vec![] },
    ..Family::PLAIN
};

fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { vec![Spec::new(family, order)] } else { vec![] }
}

/// Declares the coefficients `c` of one channel.
fn coefficients(builder: &mut Builder, order: usize) -> Vec<Id> {
    let doc = "the coefficients of one channel, index l(l+1)+m";
    builder.param("c", Shape::Array(order * order), Domain::Coefficients, doc)
}

/// The direction of band 1, which is (−y, z, −x).
fn dominant(g: &mut Graph, c: &[Id]) -> [Id; 3] {
    let xyz = [g.neg(c[3]), g.neg(c[1]), c[2]];
    let square = inner(g, &xyz, &xyz);
    let shorter = g.rsqrt(square);
    // 2^-126: below it f32 has fewer digits, or none.
    let third = Exact::ratio(1, 1i64 << 42);
    let least = g.constant(&(&third * &third) * &third);
    let axis = [0, 0, 1].map(|x| g.constant(Exact::int(x)));
    std::array::from_fn(|i| {
        let unit = g.mul(xyz[i], shorter);
        g.select_less(least, square, unit, axis[i])
    })
}

/// A_l² where it is not zero, else one.
fn weight_or_one(l: usize) -> Exact {
    let factor = cosine_lobe(l);
    if factor.is_zero() { Exact::one() } else { &factor * &factor }
}

/// The light's irradiance and the ambient radiance: least squares over the bands from 1 on, each weighted by A_l², then
/// what is left of band 0.
fn fit(g: &mut Graph, order: usize, dir: &[Id], c: &[Id]) -> [Id; 2] {
    let counts = |l: usize| l > 0 && !cosine_lobe(l).is_zero();
    let places: Vec<Option<usize>> = (0..order * order).map(|place| counts(place.isqrt()).then_some(place)).collect();
    let sum = basis::sum(g, dir, c, &places, weight_or_one);
    let size = (1..order).filter(|&l| counts(l)).fold(Exact::zero(), |sum, l| {
        let y = delta(l);
        &sum + &(&weight_or_one(l) * &(&y * &y))
    });
    let light = g.scale(&(&Exact::one() / &size), sum);
    let first = delta(0);
    let left = g.scale(&first, c[0]);
    let ambient = g.scale_add(&-&(&first * &first), light, left);
    [light, ambient]
}
