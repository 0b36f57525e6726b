//! A scalar as the proofs see it: an interval, and how far its f32 value is off in both ways of contraction.

use crate::promise::bound::norm::SLACK;
use crate::promise::bound::roundoff::Both;

/// Half of f32's smallest number: what a product that underflows may lose besides.
pub const UNDERFLOW: f64 = 1e-45;
/// More than f64's unit roundoff: what a midpoint may lose.
pub const EPSILON: f64 = f64::EPSILON;

/// A scalar: its exact value is within `radius` of `mid`, its f32 value within `error` of the exact one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Value {
    pub mid: f64,
    pub radius: f64,
    pub error: Both,
}

impl Value {
    pub fn magnitude(self) -> f64 {
        self.mid.abs() + self.radius
    }

    pub fn times(self, b: Self) -> Self {
        let mid = self.mid * b.mid;
        let (size, other) = (self.magnitude(), b.magnitude());
        let error = |i: usize| size * b.error[i] + other * self.error[i] + self.error[i] * b.error[i];
        let radius = self.mid.abs() * b.radius + self.radius * other + mid.abs() * EPSILON;
        Self { mid, radius, error: [error(0), error(1)] }
    }

    pub fn plus(self, b: Self) -> Self {
        let mid = self.mid + b.mid;
        let error = [self.error[0] + b.error[0], self.error[1] + b.error[1]];
        Self { mid, radius: self.radius + b.radius + mid.abs() * EPSILON, error }
    }

    pub fn negated(self) -> Self {
        Self { mid: -self.mid, ..self }
    }

    /// Rounded in the modes that say so.
    pub fn rounded(mut self, roundoff: f64, modes: [bool; 2]) -> Self {
        let size = self.magnitude();
        for (error, _) in self.error.iter_mut().zip(modes).filter(|(_, rounded)| *rounded) {
            *error += roundoff * (size + *error) + UNDERFLOW;
        }
        self
    }

    /// f(x) for a positive f that falls in |x|, with the error of rounding it and `times` − 1 denominators.
    pub fn falling(self, f: impl Fn(f64) -> f64, roundoff: f64, times: i32) -> Self {
        let low = self.mid.abs() - self.radius;
        let (least, most) = (f(self.magnitude()) * (1.0 - 1e-14), f(low) * (1.0 + 1e-14));
        let error = self.error.map(|e| {
            if low <= e {
                return f64::INFINITY;
            }
            // f is convex: its change is largest where the argument is smallest.
            let change = f(low - e) - f(low) + 1e-14 * f(low);
            change + (f(low) + change) * ((1.0 + roundoff) * (1.0 - roundoff).powi(1 - times) - 1.0)
        });
        Self { mid: (least + most) / 2.0 * self.mid.signum(), radius: (most - least) / 2.0, error }
    }

    /// The derivative of |x|^−p for a p of 1 or ½, as a midpoint and a radius, and what the change of x^−p by x's error differs from it.
    pub fn slope(self, p: f64) -> (f64, f64, Both) {
        let (low, high) = (self.mid.abs() - self.radius, self.magnitude());
        let slope = |x: f64| -p * x.powf(-p - 1.0);
        let rest = self.error.map(|e| match low > e {
            true => p * (p + 1.0) / 2.0 * (low - e).powf(-p - 2.0) * e * e * SLACK,
            false => f64::INFINITY,
        });
        let (steep, flat) = (slope(low), slope(high));
        ((steep + flat) / 2.0, (flat - steep).abs() / 2.0 + 1e-14 * steep.abs(), rest)
    }
}
