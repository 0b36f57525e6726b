//! Whole numbers times a power of two, rounded to the nearest float or the nearest whole number.

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// A binary floating-point format.
pub struct Format {
    digits: i64,
    least_exponent: i64,
    largest_exponent: i64,
}

pub const BINARY32: Format = Format { digits: 24, least_exponent: -149, largest_exponent: 104 };
pub const BINARY64: Format = Format { digits: 53, least_exponent: -1074, largest_exponent: 971 };

impl Format {
    /// n·2^exponent rounded to nearest, ties to even.
    pub fn round(&self, n: &BigInt, exponent: i64) -> f64 {
        let m = n.magnitude();
        let unit = (m.bits() as i64 + exponent - self.digits).max(self.least_exponent);
        let rounded = match unit - exponent {
            shift if shift <= 0 => m << -shift,
            shift if shift as u64 > m.bits() => BigUint::zero(),
            shift => {
                let floor = m >> shift;
                let half = m.bit(shift as u64 - 1);
                let tie = m.trailing_zeros() == Some(shift as u64 - 1);
                if half && (!tie || floor.bit(0)) { floor + 1u32 } else { floor }
            }
        };
        if m.is_zero() {
            return 0.0;
        }
        let magnitude = if unit > self.largest_exponent {
            f64::INFINITY
        } else {
            rounded.to_u64().unwrap_or(u64::MAX) as f64 * power_of_two(unit)
        };
        if n.is_negative() { -magnitude } else { magnitude }
    }

    /// A rational, rounded likewise: enough digits of its quotient, and a last one that says whether more follow.
    pub fn round_ratio(&self, ratio: &BigRational) -> f64 {
        let (p, q) = (ratio.numer(), ratio.denom().magnitude());
        let shift = (self.digits as u64 + 2 + q.bits()).saturating_sub(p.bits());
        let (quotient, rest) = (p.magnitude() << shift).div_rem(q);
        let sticky = (quotient << 1u32) + u32::from(!rest.is_zero());
        self.round(&BigInt::from_biguint(p.sign(), sticky), -(shift as i64) - 1)
    }
}

fn power_of_two(e: i64) -> f64 {
    f64::from_bits(if e >= -1022 { ((e + 1023) as u64) << 52 } else { 1 << (e + 1074) })
}

/// n/2^shift rounded to the nearest integer.
pub fn round_shift(n: &BigInt, shift: u64) -> BigInt {
    if shift == 0 { n.clone() } else { ((n >> (shift - 1)) + 1) >> 1u32 }
}
