//! Where a truncated series is negative though its light is not: it rings. The share of the directions and the least
//! value, sampled.

use super::harmonics::basis;
use super::project::Projection;
use crate::threads;
use serde::Serialize;
use std::f64::consts::PI;

/// How many directions are sampled: a value of order 10 changes little over the two degrees between them.
const DIRECTIONS: usize = 10_000;

/// Where R, G or B of a series is negative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Negative {
    /// The share of the directions in which one of them is.
    pub share: f64,
    /// The least of their values over the mean of all; above 0 if none is negative.
    pub least: f64,
}

impl Projection {
    /// Where the first bands of this are negative, by 10 000 directions spread evenly over the sphere.
    ///
    /// # Panics
    ///
    /// If there are fewer than `order` bands.
    pub fn negative(&self, order: usize) -> Negative {
        let coefficients = &self.coefficients[..order * order];
        let least = |i: usize| {
            let mut values = vec![0.0; order * order];
            basis(order, direction(i), &mut values);
            let mut sums = [0.0; 3];
            for (coefficient, value) in coefficients.iter().zip(&values) {
                (0..3).for_each(|channel| sums[channel] += coefficient[channel] * value);
            }
            sums.into_iter().fold(f64::INFINITY, f64::min)
        };
        let found = threads::map(0..DIRECTIONS, least);
        let mean = coefficients[0].iter().sum::<f64>() / 3.0 * 0.5 / PI.sqrt();
        let count = found.iter().filter(|&&value| value < 0.0).count();
        let lowest = found.into_iter().fold(f64::INFINITY, f64::min);
        Negative { share: count as f64 / DIRECTIONS as f64, least: if mean > 0.0 { lowest / mean } else { 0.0 } }
    }
}

/// One of the directions: evenly spread, by the golden angle.
fn direction(i: usize) -> [f64; 3] {
    let z = 1.0 - (2 * i + 1) as f64 / DIRECTIONS as f64;
    let (sin, cos) = (i as f64 * PI * (3.0 - 5.0f64.sqrt())).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    [radius * cos, radius * sin, z]
}
