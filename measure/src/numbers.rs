//! Two number types for the interpreter: binary16, rounded after every operation, and a pair of doubles, which is what
//! the rounding of f64 is measured against.

use std::ops::{Add, Div, Mul, Neg, Sub};
use zonal_codegen::ir::eval::Number;
use zonal_codegen::math::exact::{Exact, Real};

/// A binary16, held as the f64 of the same value.
///
/// A sum, a difference, a product, a quotient or a root of two such numbers is rounded from its f64, which has more than
/// twice the bits, so that rounding twice changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Half(f64);

impl Half {
    const MAX: f64 = 65504.0;

    /// The nearest binary16, ties to even.
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
}

/// A number as the sum of two doubles, the second below half a unit in the last place of the first: 106 bits.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Twin {
    high: f64,
    low: f64,
}

/// a + b and its rounding error.
fn two_sum(a: f64, b: f64) -> Twin {
    let high = a + b;
    let back = high - a;
    Twin { high, low: (a - (high - back)) + (b - back) }
}

/// a · b and its rounding error.
fn two_product(a: f64, b: f64) -> Twin {
    let high = a * b;
    Twin { high, low: a.mul_add(b, -high) }
}

/// An f64 as a real number.
fn real(value: f64) -> Real {
    let bits = value.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1075;
    let significand = (bits & ((1 << 52) - 1)) | (1 << 52);
    let (step, count) = match exponent < 0 {
        true => (Real::from_ratio(1, 2), -exponent),
        false => (Real::from_ratio(2, 1), exponent),
    };
    let scaled = (0..count).fold(Real::from_ratio(significand, 1), |value, _| value * &step);
    if value < 0.0 { Real::zero() - scaled } else { scaled }
}

/// Writes the operators of a type.
macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident |$a:ident, $b:ident| $value:expr;)*) => { $(
        impl $trait for $type {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                $value
            }
        }
    )* };
}

operators! { Half:
    Add add |a, b| Self::round(a.0 + b.0);
    Sub sub |a, b| Self::round(a.0 - b.0);
    Mul mul |a, b| Self::round(a.0 * b.0);
    Div div |a, b| Self::round(a.0 / b.0);
}

operators! { Twin:
    Add add |a, b| {
        let sum = two_sum(a.high, b.high);
        two_sum(sum.high, sum.low + (a.low + b.low))
    };
    Sub sub |a, b| a + -b;
    Mul mul |a, b| {
        let product = two_product(a.high, b.high);
        two_sum(product.high, product.low + (a.high * b.low + a.low * b.high))
    };
    Div div |a, b| {
        let first = Self::from_f64(a.high / b.high);
        let rest = a - b * first;
        first + Self::from_f64(rest.high / b.high)
    };
}

impl Neg for Half {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Neg for Twin {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Number for Half {
    const ONE: Self = Self(1.0);
    const ZERO: Self = Self(0.0);
    // The smallest binary16: what f32's tiny number would be is zero here.
    const TINY: Self = Self(1.0 / 16_777_216.0);
    const UNIT_ROUNDOFF: f64 = 1.0 / 2048.0;
    fn nearest(value: &Exact) -> Self {
        Self::round(value.to_f64())
    }
    fn from_f64(value: f64) -> Self {
        Self::round(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn root(self) -> Self {
        Self::round(self.0.sqrt())
    }
    fn fused(self, b: Self, c: Self) -> Self {
        Self::round(self.0 * b.0 + c.0)
    }
}

impl Number for Twin {
    const ONE: Self = Self { high: 1.0, low: 0.0 };
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const TINY: Self = Self { high: 1e-60, low: 0.0 };
    const UNIT_ROUNDOFF: f64 = f64::EPSILON * f64::EPSILON;
    fn nearest(value: &Exact) -> Self {
        let high = value.to_f64();
        if high == 0.0 {
            return Self::ZERO;
        }
        Self { high, low: (value.to_real() - real(high)).to_f64() }
    }
    fn from_f64(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
    fn to_f64(self) -> f64 {
        self.high + self.low
    }
    fn root(self) -> Self {
        if self.high <= 0.0 {
            return Self::from_f64(self.high.sqrt());
        }
        let first = Self::from_f64(self.high.sqrt());
        let rest = self - first * first;
        first + Self::from_f64(rest.high / (2.0 * first.high))
    }
    fn fused(self, b: Self, c: Self) -> Self {
        self * b + c
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

    /// The crate half rounds f32 as hardware does.
    #[test]
    fn halves_are_those_of_the_crate_half() {
        let mut random = zonal_codegen::promise::samples::Random::new(16);
        for _ in 0..200_000 {
            let value = f32::from_bits(random.bits() as u32);
            let (own, other) = (Half::round(f64::from(value)).0, half::f16::from_f32(value).to_f64());
            assert!(own.to_bits() == other.to_bits() || own.is_nan() && other.is_nan(), "{value}: {own}, not {other}");
        }
        // Most of those overflow or vanish: once more where they do neither.
        for _ in 0..200_000 {
            let value = (random.signed() * 2f64.powi((random.bits() % 44) as i32 - 27)) as f32;
            assert_eq!(Half::round(f64::from(value)).0, half::f16::from_f32(value).to_f64(), "{value}");
        }
    }

    #[test]
    fn twins_hold_a_hundred_bits() {
        let root = Twin::nearest(&Exact::sqrt_ratio(2, 1));
        assert!((root * root - Twin::from_f64(2.0)).to_f64().abs() < 1e-31);
        assert!((Twin::from_f64(2.0).root() - root).to_f64().abs() < 1e-31);
        let third = Twin::nearest(&Exact::ratio(-1, 3));
        assert!((Twin::from_f64(-1.0) / Twin::from_f64(3.0) - third).to_f64().abs() < 1e-32);
        assert!((third * Twin::from_f64(3.0) + Twin::ONE).to_f64().abs() < 1e-31);
    }
}
