//! Numbers with two derivatives, with which a generated kernel computes its own.

use std::ops::{Add, Mul, Neg, Sub};
use zonal::real::{Real, Signal};

/// A value and its derivatives along two tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub slopes: [f64; 2],
}

impl Dual {
    /// Returns a number that does not change.
    pub fn constant(value: f64) -> Self {
        Self { value, slopes: [0.0; 2] }
    }

    /// Returns a function of the number, by its value and its derivative there.
    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: self.slopes.map(|s| slope * s) }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let slopes = [self.slopes[0] + other.slopes[0], self.slopes[1] + other.slopes[1]];
        Self { value: self.value + other.value, slopes }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(|s| -s) }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (Self { value: a, slopes: [b, c] }, Self { value: d, slopes: [e, f] }) = (self, other);
        Self { value: a * d, slopes: [b * d + a * e, c * d + a * f] }
    }
}

impl Signal<Self> for Dual {
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn fma(self, t: Self, c: Self) -> Self {
        self * t + c
    }
    fn fms(self, t: Self, c: Self) -> Self {
        self * t - c
    }
    fn fnma(self, t: Self, c: Self) -> Self {
        c - self * t
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn choose(a: Self, b: Self, c: Self, d: Self) -> Self {
        if a.value < b.value { c } else { d }
    }
}

impl Real for Dual {
    const TINY: Self = Self { value: <f64 as Real>::TINY, slopes: [0.0; 2] };
    fn lit(value: f64) -> Self {
        Self::constant(value)
    }
    fn lit2(_: f32, wide: f64) -> Self {
        Self::constant(wide)
    }
    fn root(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }
    fn recip(self) -> Self {
        let reciprocal = 1.0 / self.value;
        self.through(reciprocal, -reciprocal * reciprocal)
    }
    fn at_most(self, limit: Self) -> bool {
        self.value <= limit.value
    }
    fn exp2(self) -> Self {
        let power = self.value.exp2();
        self.through(power, power * std::f64::consts::LN_2)
    }
    fn log2(self) -> Self {
        self.through(self.value.log2(), 1.0 / (self.value * std::f64::consts::LN_2))
    }
    fn abs(self) -> Self {
        self.through(self.value.abs(), self.value.signum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kernel_differentiates_itself() {
        let at = |t: f64| [0.48 + 0.1 * t, -0.6 + 0.3 * t, 0.64 - 0.2 * t];
        let slopes = [0.1, 0.3, -0.2];
        let dir: [Dual; 3] = std::array::from_fn(|k| Dual { value: at(0.0)[k], slopes: [slopes[k], -2.0 * slopes[k]] });
        let found = zonal::sh6::hsh_basis(dir);
        let h = 1e-5;
        let (up, down) = (zonal::sh6::hsh_basis(at(h)), zonal::sh6::hsh_basis(at(-h)));
        for i in 0..36 {
            let wanted = (up[i] - down[i]) / (2.0 * h);
            // Central differences err by h² times the third derivative, some hundreds, and by rounding over h.
            assert!((found[i].slopes[0] - wanted).abs() < 1e-7, "{i}: {} {wanted}", found[i].slopes[0]);
            assert!((found[i].slopes[1] + 2.0 * wanted).abs() < 2e-7);
        }
    }
}
