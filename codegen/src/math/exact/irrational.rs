//! π and ln(1+√2) to as many bits as are asked for.

use std::sync::OnceLock;

use num_bigint::{BigInt, BigUint};
use num_traits::{One, Zero};

/// The bits to which π and ln(1+√2) are kept.
const CACHED_BITS: u64 = 2048;

/// π·2^bits, rounded down but for the last unit.
pub fn pi_bits(bits: u64) -> BigUint {
    static CACHE: OnceLock<BigUint> = OnceLock::new();
    cached(&CACHE, bits, |bits| {
        let arctan = |inverse: u32| {
            let mut power = (BigInt::one() << bits) / inverse;
            let mut sum = power.clone();
            for k in 1u32.. {
                power /= -i64::from(inverse * inverse);
                if power.is_zero() {
                    break;
                }
                sum += &power / (2 * k + 1);
            }
            sum
        };
        arctan(5) * 16 - arctan(239) * 4
    })
}

/// ln(1+√2)·2^bits, rounded down but for the last unit: Σ 2^(-k-1/2)/(2k+1).
pub fn ln_bits(bits: u64) -> BigUint {
    static CACHE: OnceLock<BigUint> = OnceLock::new();
    cached(&CACHE, bits, |bits| {
        let mut power = (BigInt::one() << (2 * bits - 1)).sqrt();
        let mut sum = BigInt::zero();
        for k in 0u32.. {
            if power.is_zero() {
                break;
            }
            sum += &power / (2 * k + 1);
            power >>= 1;
        }
        sum
    })
}

/// A constant to `bits` bits, from the cache if that holds as many.
fn cached(cache: &OnceLock<BigUint>, bits: u64, compute: impl Fn(u64) -> BigInt) -> BigUint {
    let guarded = |bits: u64| (compute(bits + 32) >> 32u32).magnitude().clone();
    if bits > CACHED_BITS { guarded(bits) } else { cache.get_or_init(|| guarded(CACHED_BITS)) >> (CACHED_BITS - bits) }
}
