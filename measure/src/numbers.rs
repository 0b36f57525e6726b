//! A number type for the interpreter: a pair of doubles, which is what the rounding of f64 is measured against.

use std::ops::{Add, Div, Mul, Neg, Sub};
use zonal_codegen::ir::eval::Number;
use zonal_codegen::math::exact::{Exact, Real};

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

impl Neg for Twin {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
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
    fn twins_hold_a_hundred_bits() {
        let root = Twin::nearest(&Exact::sqrt_ratio(2, 1));
        assert!((root * root - Twin::from_f64(2.0)).to_f64().abs() < 1e-31);
        assert!((Twin::from_f64(2.0).root() - root).to_f64().abs() < 1e-31);
        let third = Twin::nearest(&Exact::ratio(-1, 3));
        assert!((Twin::from_f64(-1.0) / Twin::from_f64(3.0) - third).to_f64().abs() < 1e-32);
        assert!((third * Twin::from_f64(3.0) + Twin::ONE).to_f64().abs() < 1e-31);
    }
}
