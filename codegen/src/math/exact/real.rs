//! Real numbers of 512 bits after the point: what no exact sum can express.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};
use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::irrational::pi_bits;
use super::operator::operator;
use super::round::{BINARY64, round_shift};

/// A real number held to 512 bits after the point.
///
/// Two that agree, rounded, in 440 bits after the point are equal: a value found in two ways is one constant.
#[derive(Clone, Debug)]
pub struct Real(pub(super) BigInt);

impl Real {
    /// The bits after the point.
    pub const BITS: u64 = 512;

    /// The bits of them that count in a comparison.
    const COMPARED_BITS: u64 = 440;

    /// The bits of them that tell a number from zero.
    const ZERO_BITS: u64 = 400;

    /// The bits after the point in the series of the cosine.
    const SERIES_BITS: u64 = Self::BITS + 64;

    /// The number 0.
    pub fn zero() -> Self {
        Self(BigInt::zero())
    }

    /// The rational p/q.
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn from_ratio(p: impl Into<BigInt>, q: impl Into<BigInt>) -> Self {
        Self(divide(&(p.into() << Self::BITS), &q.into()))
    }

    /// π.
    pub fn pi() -> Self {
        Self(round_shift(&pi_bits(Self::SERIES_BITS).into(), Self::SERIES_BITS - Self::BITS))
    }

    /// cos(π·p/q).
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn cos_pi(p: i64, q: i64) -> Self {
        let (p, q) = (i128::from(p).abs(), i128::from(q).abs());
        let turned = p % (2 * q);
        let folded = turned.min(2 * q - turned);
        if 2 * folded > q { -&Self::cos_series(q - folded, q) } else { Self::cos_series(folded, q) }
    }

    /// sin(π·p/q).
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn sin_pi(p: i64, q: i64) -> Self {
        // sin(πp/q) = cos(π(q-2p)/(2q)), with p reduced so that nothing overflows.
        let p = (i128::from(p) * i128::from(q.signum())).rem_euclid(2 * i128::from(q).abs());
        let q = i128::from(q).abs();
        let folded = if 2 * p > 3 * q { 5 * q - 2 * p } else { (q - 2 * p).abs() };
        if folded > q { -&Self::cos_series(2 * q - folded, 2 * q) } else { Self::cos_series(folded, 2 * q) }
    }

    /// cos(π·p/q) for 0 ≤ p/q ≤ 1/2 by its Taylor series.
    fn cos_series(p: i128, q: i128) -> Self {
        let angle = BigInt::from(pi_bits(Self::SERIES_BITS)) * p / q;
        let square = -((&angle * &angle) >> Self::SERIES_BITS);
        let mut term = BigInt::one() << Self::SERIES_BITS;
        let mut sum = term.clone();
        for k in (2u32..).step_by(2) {
            term = round_shift(&(&term * &square), Self::SERIES_BITS) / (k * (k - 1));
            if term.is_zero() {
                break;
            }
            sum += &term;
        }
        Self(round_shift(&sum, Self::SERIES_BITS - Self::BITS))
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        Self(self.0.abs())
    }

    /// The square root.
    ///
    /// # Panics
    ///
    /// If the number is negative.
    pub fn sqrt(&self) -> Self {
        Self((&self.0 << Self::BITS).sqrt())
    }

    /// Whether the number is below 2^-400 in size.
    pub fn is_negligible(&self) -> bool {
        self.0.bits() <= Self::BITS - Self::ZERO_BITS
    }

    /// The nearest `f64`.
    pub fn to_f64(&self) -> f64 {
        BINARY64.round(&self.0, -(Self::BITS as i64))
    }

    fn quotient(&self, other: &Self) -> Self {
        Self(divide(&(&self.0 << Self::BITS), &other.0))
    }

    fn key(&self) -> BigInt {
        round_shift(&self.0, Self::BITS - Self::COMPARED_BITS)
    }
}

/// p/q rounded to the nearest integer.
fn divide(p: &BigInt, q: &BigInt) -> BigInt {
    ((p << 1u32) + q).div_floor(&(q << 1u32))
}

impl PartialEq for Real {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Real {}

impl Hash for Real {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Real {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

operator!(Real, Add, add, |a, b| Real(&a.0 + &b.0));
operator!(Real, Sub, sub, |a, b| Real(&a.0 - &b.0));
operator!(Real, Mul, mul, |a, b| Real(round_shift(&(&a.0 * &b.0), Real::BITS)));
operator!(Real, Div, div, |a, b| a.quotient(b));

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-&self.0)
    }
}

impl Neg for Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-self.0)
    }
}
