//! Nodes and weights on the sphere, on the upper hemisphere and on what of it is left above the horizon after a turn; the
//! seeded frames that signals are seen in.

use super::bases::SH;
use std::f64::consts::PI;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::{Random, matrix_of};

/// A direction and its weight, in steradians.
pub type Node = ([f64; 3], f64);

/// Nodes in rings: of each height and its weight, `count` nodes around.
fn rings(heights: impl Iterator<Item = (f64, f64)>, count: usize) -> Vec<Node> {
    let around = |(z, weight): (f64, f64)| {
        let radius = (1.0 - z * z).max(0.0).sqrt();
        (0..count).map(move |i| {
            let (sin, cos) = (2.0 * PI * (i as f64 + 0.5) / count as f64).sin_cos();
            ([radius * cos, radius * sin, z], weight * 2.0 * PI / count as f64)
        })
    };
    heights.flat_map(around).collect()
}

/// The whole sphere: exact for products of harmonics of a total degree below 2 `count`.
pub fn sphere(count: usize) -> Vec<Node> {
    rings(gauss_legendre(count, -1.0, 1.0), 2 * count)
}

/// The upper hemisphere, `count` rings of twice as many nodes. The rings are even in √z: bases that hold it are smooth so.
pub fn hemisphere(count: usize) -> Vec<Node> {
    rings(gauss_legendre(count, 0.0, 1.0).map(|(t, weight)| (t * t, 2.0 * t * weight)), 2 * count)
}

/// The directions of the upper hemisphere that a turn about y by `beta` leaves above the horizon, `count`² of them, and
/// where it takes them. They lie on circles about y; towards the edges they are dense as in [`hemisphere`].
pub fn above(beta: f64, count: usize) -> Vec<([f64; 3], [f64; 3], f64)> {
    let smooth = |from: f64, to: f64| {
        gauss_legendre(count, 0.0, 1.0).map(move |(s, weight)| {
            (from + (to - from) * s * s * (3.0 - 2.0 * s), (to - from) * 6.0 * s * (1.0 - s) * weight)
        })
    };
    let around: Vec<(f64, f64)> = smooth(beta, PI).collect();
    let arc = |(angle, weight): (f64, f64)| {
        let (radius, y) = angle.sin_cos();
        let at = move |turn: f64| [radius * turn.cos(), y, (radius * turn.sin()).max(0.0)];
        around.clone().into_iter().map(move |(turn, w)| (at(turn), at(turn - beta), weight * w * radius))
    };
    smooth(0.0, PI).flat_map(arc).collect()
}

/// A direction turned about y by `beta`: z goes towards x.
pub fn about_y(beta: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = beta.sin_cos();
    [cos * x + sin * z, y, cos * z - sin * x]
}

/// Seeded frames, as the directions of their axes in the world: any turn is as likely as any other.
pub fn frames(seed: u64, count: usize) -> Vec<[[f64; 3]; 3]> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let m = matrix_of(random.unit());
            [0, 1, 2].map(|i| [m[3 * i], m[3 * i + 1], m[3 * i + 2]])
        })
        .collect()
}

/// A direction of the world in a frame.
pub fn local(frame: &[[f64; 3]; 3], direction: [f64; 3]) -> [f64; 3] {
    frame.map(|axis| axis.iter().zip(direction).map(|(a, b)| a * b).sum())
}

/// A direction of a frame in the world.
pub fn global(frame: &[[f64; 3]; 3], direction: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|axis| frame[axis][i] * direction[axis]).sum())
}

/// What is seen of a light in a frame, both in spherical harmonics, by nodes that are exact for products of two of its order.
pub fn seen(nodes: &[Node], light: &[f64], frame: &[[f64; 3]; 3]) -> Vec<f64> {
    let order = light.len().isqrt();
    let mut sums = vec![0.0; light.len()];
    for (direction, weight) in nodes {
        let there = SH.at(order, global(frame, *direction));
        let radiance: f64 = light.iter().zip(there).map(|(c, y)| c * y).sum();
        let here = SH.at(order, *direction);
        sums.iter_mut().zip(here).for_each(|(sum, y)| *sum += weight * radiance * y);
    }
    sums
}
