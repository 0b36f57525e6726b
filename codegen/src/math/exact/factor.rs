//! Squares under a root: a natural number as a square times what holds none.

use std::sync::OnceLock;

use num_bigint::BigUint;
use num_integer::Integer;
use num_traits::{One, ToPrimitive, Zero};

/// Primes up to this one are found under a root; what is left above it is only tested for being a square.
const LARGEST_PRIME: u32 = 4096;

fn primes() -> &'static [u32] {
    static PRIMES: OnceLock<Vec<u32>> = OnceLock::new();
    PRIMES.get_or_init(|| {
        let mut primes: Vec<u32> = Vec::new();
        for n in 2..LARGEST_PRIME {
            if primes.iter().take_while(|&p| p * p <= n).all(|p| n % p != 0) {
                primes.push(n);
            }
        }
        primes
    })
}

/// `n` as s²·d: `(s, d)`, `n` not 0.
pub fn square_free(mut n: BigUint) -> (BigUint, BigUint) {
    let (mut square, mut free) = (BigUint::one(), BigUint::one());
    let twos = n.trailing_zeros().unwrap_or(0);
    n >>= twos;
    square <<= twos / 2;
    free <<= twos % 2;
    for &p in &primes()[1..] {
        if let Some(small) = n.to_u64() {
            if small < u64::from(p).pow(2) {
                break;
            }
            if small % u64::from(p) != 0 {
                continue;
            }
        }
        loop {
            let (quotient, rest) = n.div_rem(&p.into());
            if !rest.is_zero() {
                break;
            }
            n = quotient;
            if (&free % p).is_zero() {
                free /= p;
                square *= p;
            } else {
                free *= p;
            }
        }
    }
    let root = n.sqrt();
    if &root * &root == n { (square * root, free) } else { (square, free * n) }
}

/// The smallest prime factor, if it is below [`LARGEST_PRIME`].
pub fn smallest_prime(n: &BigUint) -> Option<u32> {
    primes().iter().copied().find(|&p| (n % p).is_zero())
}
