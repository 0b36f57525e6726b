//! Numbers of IEEE binary16, in which f16 kernels are interpreted: rounded after every operation.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A binary16, held as the f64 of the same value.
///
/// A sum, a difference, a product, a quotient or a root of two such numbers is rounded from its f64, which has more than
/// twice the bits, so that rounding twice changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Half(f64);

impl Half {
    /// The largest that is finite.
    pub const MAX: f64 = 65504.0;
    /// Zero.
    pub const ZERO: Self = Self(0.0);
    /// One.
    pub const ONE: Self = Self(1.0);

    /// Returns the nearest binary16, ties to even.
    pub fn round(value: f64) -> Self {
        if value == 0.0 || !value.is_finite() {
            return Self(value);
        }
        // The exponent of the last bit: ten below the first, and never below that of the denormal numbers.
        let exponent = ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
        let unit = 2f64.powi((exponent - 10).max(-24));
        let rounded = (value / unit).round_ties_even() * unit;
        Self(if rounded.abs() > Self::MAX { f64::INFINITY.copysign(value) } else { rounded })
    }

    /// Returns its value.
    pub fn to_f64(self) -> f64 {
        self.0
    }
}

impl Add for Half {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::round(self.0 + other.0)
    }
}

impl Sub for Half {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::round(self.0 - other.0)
    }
}

impl Mul for Half {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::round(self.0 * other.0)
    }
}

impl Div for Half {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::round(self.0 / other.0)
    }
}

impl Neg for Half {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_round_to_even_and_overflow() {
        for (value, rounded) in [
            (1.0 + 1.0 / 2048.0, 1.0),
            (1.0 + 3.0 / 2048.0, 1.0 + 2.0 / 1024.0),
            (1.0 + 1.01 / 2048.0, 1.0 + 1.0 / 1024.0),
            (65519.0, 65504.0),
            (65520.0, f64::INFINITY),
            (1.6 * 2f64.powi(-24), 2.0 * 2f64.powi(-24)),
            (0.4 * 2f64.powi(-24), 0.0),
        ] {
            assert_eq!(Half::round(value).0, rounded, "{value}");
            assert_eq!(Half::round(-value).0, -rounded, "{value}");
        }
    }
}
