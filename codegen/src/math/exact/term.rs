//! A term of an exact sum, `q·√d·π^(k/2)·ln(1+√2)^j`, and bounds of sums of terms to as many bits as a decision takes.

use std::cmp::Ordering;

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::factor::square_free;
use super::irrational::{ln_bits, pi_bits};

/// Below this many bits a number without a squared prime up to [`LARGEST_PRIME`] that is no square is square-free.
const SURELY_SQUARE_FREE: u64 = 36;

/// The most bits that rounding or deciding a sign tries.
const MOST_BITS: u64 = 1 << 15;

#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Term {
    pub surd: Surd,
    pub coefficient: BigRational,
}

/// `√root·π^(pi/2)·ln(1+√2)^ln`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Surd {
    pub pi: i32,
    pub ln: i32,
    pub root: BigUint,
}

impl Term {
    pub fn times(&self, other: &Self) -> Self {
        let (factor, root) = if self.surd.root.is_one() {
            (BigUint::one(), other.surd.root.clone())
        } else if other.surd.root.is_one() {
            (BigUint::one(), self.surd.root.clone())
        } else {
            let common = self.surd.root.gcd(&other.surd.root);
            let rest = (&self.surd.root / &common) * (&other.surd.root / &common);
            if rest.bits() <= SURELY_SQUARE_FREE {
                (common, rest)
            } else {
                let (square, rest) = square_free(rest);
                (common * square, rest)
            }
        };
        let mut coefficient = &self.coefficient * &other.coefficient;
        if !factor.is_one() {
            coefficient *= BigInt::from(factor);
        }
        Self { surd: Surd { pi: self.surd.pi + other.surd.pi, ln: self.surd.ln + other.surd.ln, root }, coefficient }
    }

    pub fn inverse(&self) -> Self {
        Self {
            surd: Surd { pi: -self.surd.pi, ln: -self.surd.ln, root: self.surd.root.clone() },
            coefficient: (&self.coefficient * BigInt::from(self.surd.root.clone())).recip(),
        }
    }

    /// The term under √prime → -√prime.
    pub fn conjugate(&self, prime: u32) -> Self {
        let flip = (&self.surd.root % prime).is_zero();
        let coefficient = if flip { -&self.coefficient } else { self.coefficient.clone() };
        Self { surd: self.surd.clone(), coefficient }
    }

    /// The absolute value as `m·2^e`, its relative error below 2^-bits: the root of the square's rational and π
    /// parts, times the logarithm's.
    fn magnitude(&self, bits: u64) -> (BigUint, i64) {
        let Surd { pi, ln, root } = &self.surd;
        let work = bits + 16 + u64::from((pi.unsigned_abs() + ln.unsigned_abs()).max(1).ilog2());
        let mut numerator = self.coefficient.numer().magnitude().pow(2) * root;
        let mut denominator = self.coefficient.denom().magnitude().pow(2);
        let mut exponent = -(work as i64) * i64::from(*pi);
        match pi.cmp(&0) {
            Ordering::Greater => numerator *= pi_bits(work).pow(pi.unsigned_abs()),
            Ordering::Less => denominator *= pi_bits(work).pow(pi.unsigned_abs()),
            Ordering::Equal => {}
        }
        let mut shift = (2 * (bits + 8) + denominator.bits()).saturating_sub(numerator.bits()) as i64;
        shift += (exponent - shift).rem_euclid(2);
        let mut m = ((numerator << shift) / denominator).sqrt();
        exponent = (exponent - shift) / 2;
        match ln.cmp(&0) {
            Ordering::Greater => {
                m *= ln_bits(work).pow(ln.unsigned_abs());
                exponent -= work as i64 * i64::from(*ln);
            }
            Ordering::Less => {
                let divisor = ln_bits(work).pow(ln.unsigned_abs());
                let up = bits + 8 + divisor.bits();
                m = (m << up) / divisor;
                exponent -= up as i64 + work as i64 * i64::from(*ln);
            }
            Ordering::Equal => {}
        }
        (m, exponent)
    }
}

impl Surd {
    pub fn one() -> Self {
        Self { pi: 0, ln: 0, root: BigUint::one() }
    }

    pub fn is_one(&self) -> bool {
        self.pi == 0 && self.ln == 0 && self.root.is_one()
    }
}

/// Bounds of the sum in units of 2^exponent, about `bits` bits below the largest term: `(low, high, exponent)`.
pub fn enclose(terms: &[Term], bits: u64) -> (BigInt, BigInt, i64) {
    let parts: Vec<_> = terms.iter().map(|t| (t.magnitude(bits), t.coefficient.is_negative())).collect();
    let top = parts.iter().map(|((m, e), _)| m.bits() as i64 + e).max().unwrap_or(0);
    let exponent = top - bits as i64 - 4;
    let mut sum = BigInt::zero();
    for ((m, e), negative) in parts {
        let part = BigInt::from(if e >= exponent { m << (e - exponent) } else { m >> (exponent - e) });
        sum += if negative { -part } else { part };
    }
    // A part is below 2^(bits + 4) and known to 2^-bits of itself, and loses less than 1 by its shift.
    let error = BigInt::from(17 * terms.len());
    (&sum - &error, sum + error, exponent)
}

/// The value of `of` on which both bounds of a sum agree, with as many bits as that takes.
pub fn refine<T: PartialEq>(terms: &[Term], of: impl Fn(&BigInt, i64) -> T) -> T {
    let mut bits = 96;
    loop {
        let (low, high, exponent) = enclose(terms, bits);
        let value = of(&low, exponent);
        if bits > MOST_BITS || value == of(&high, exponent) {
            return value;
        }
        bits *= 2;
    }
}
