//! Gauss-Legendre quadrature in f64: the nodes and the weights of a rule on an interval.

use std::f64::consts::PI;

/// The nodes and weights of the Gauss-Legendre rule of `count` points on an interval.
pub fn gauss_legendre(count: usize, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let n = count as f64;
    (0..count).map(move |i| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's method from Tricomi's estimate doubles the digits with each of these.
        for _ in 0..6 {
            let (mut before, mut value) = (1.0, x);
            for l in 2..=count {
                let l = l as f64;
                (before, value) = (value, ((2.0 * l - 1.0) * x * value - (l - 1.0) * before) / l);
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        let half = 0.5 * (to - from);
        (0.5 * (from + to) + half * x, half * 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// The nodes, from −1 to 1, and the weights of the five-point rule, in closed form.
pub fn gauss_legendre_5() -> [(f64, f64); 5] {
    let (root_10_7, root_70) = ((10.0f64 / 7.0).sqrt(), 70.0f64.sqrt());
    let inner = (5.0 - 2.0 * root_10_7).sqrt() / 3.0;
    let outer = (5.0 + 2.0 * root_10_7).sqrt() / 3.0;
    let inner_weight = (322.0 + 13.0 * root_70) / 900.0;
    let outer_weight = (322.0 - 13.0 * root_70) / 900.0;
    [(-outer, outer_weight), (-inner, inner_weight), (0.0, 128.0 / 225.0), (inner, inner_weight), (outer, outer_weight)]
}
