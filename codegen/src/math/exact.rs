//! Numbers known exactly, which every table of this module is made of and every constant of a kernel starts as
//! (docs/MATH.md#exact-constants).
//!
//! An [`Exact`] is a finite sum of `q·√d·π^(k/2)·ln(1+√2)^j`, held in a canonical form, so that a zero, a one or
//! a repeated constant is recognised without an epsilon. What no such sum can express (a quotient of sums, a root of
//! a polynomial) is a [`Real`] of 512 fractional bits. Either is rounded once, to the nearest `f32` or `f64`.
//! One file: a term, sums of terms and how they are rounded know each other from within.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};
use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

use num_bigint::{BigInt, BigUint, Sign};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Primes up to this one are found under a root; what is left above it is only tested for being a square.
const LARGEST_PRIME: u32 = 4096;

/// Below this many bits a number without a squared prime up to [`LARGEST_PRIME`] that is no square is square-free.
const SURELY_SQUARE_FREE: u64 = 36;

/// The most bits that rounding or deciding a sign tries.
const MOST_BITS: u64 = 1 << 15;

/// The bits to which π and ln(1+√2) are kept.
const CACHED_BITS: u64 = 2048;

/// An exactly known real number: a finite sum of `q·√d·π^(k/2)·ln(1+√2)^j`, `q` rational, `d` a square-free natural,
/// `k` and `j` integers; or, for derived constants, a [`Real`].
///
/// Equal sums are equal values of this type: `==`, `Hash` and the zero test are decided on integers. (They take π and
/// ln(1+√2) to be algebraically independent, and no prime above 4096 to occur squared beside another one under the
/// same root.) The order is that of the form, good for a map's key; [`Exact::signum`] of a difference compares values.
///
/// Arithmetic with a `Real` gives a `Real`, except that an integer result, 0 included, becomes exact again.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Exact(Form);

#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Form {
    /// Sorted by surd; no coefficient is zero.
    Sum(Vec<Term>),
    Real(Real),
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Term {
    surd: Surd,
    coefficient: BigRational,
}

/// `√root·π^(pi/2)·ln(1+√2)^ln`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Surd {
    pi: i32,
    ln: i32,
    root: BigUint,
}

impl Exact {
    /// The number 0.
    pub fn zero() -> Self {
        Self(Form::Sum(Vec::new()))
    }

    /// The number 1.
    pub fn one() -> Self {
        Self::int(1)
    }

    /// The integer `i`.
    pub fn int(i: i64) -> Self {
        Self::rational(BigRational::from_integer(i.into()))
    }

    /// The rational p/q.
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn ratio(p: impl Into<BigInt>, q: impl Into<BigInt>) -> Self {
        Self::rational(BigRational::new(p.into(), q.into()))
    }

    /// The square root √(p/q).
    ///
    /// # Panics
    ///
    /// If `q` is zero or p/q is negative.
    pub fn sqrt_ratio(p: impl Into<BigInt>, q: impl Into<BigInt>) -> Self {
        let ratio = BigRational::new(p.into(), q.into());
        assert!(!ratio.is_negative(), "the root of the negative number {ratio}");
        if ratio.is_zero() {
            return Self::zero();
        }
        let (p_root, p_rest) = square_free(ratio.numer().magnitude().clone());
        let (q_root, q_rest) = square_free(ratio.denom().magnitude().clone());
        let coefficient = BigRational::new(p_root.into(), (q_root * &q_rest).into());
        Self::term(coefficient, Surd { root: p_rest * q_rest, ..Surd::one() })
    }

    /// The power π^(k/2).
    pub fn pi_sqrt_power(k: i32) -> Self {
        Self::term(BigRational::one(), Surd { pi: k, ..Surd::one() })
    }

    /// The number ln(1+√2).
    pub fn ln_one_plus_sqrt2() -> Self {
        Self::term(BigRational::one(), Surd { ln: 1, ..Surd::one() })
    }

    /// The number `r`; exact again if `r` is an integer but for a negligible rest.
    pub fn real(r: Real) -> Self {
        let nearest = round_shift(&r.0, Real::BITS);
        if (&r - &Real(&nearest << Real::BITS)).is_negligible() {
            Self::rational(BigRational::from_integer(nearest))
        } else {
            Self(Form::Real(r))
        }
    }

    /// cos(π·p/q): a sum of roots if the angle is a multiple of 15°, a `Real` otherwise.
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn cos_pi(p: i64, q: i64) -> Self {
        let (steps, rest) = (12 * i128::from(p).abs()).div_rem(&i128::from(q).abs());
        if rest != 0 {
            return Self::real(Real::cos_pi(p, q));
        }
        let turned = steps % 24;
        let folded = turned.min(24 - turned);
        let root = |n: i64, d: i64| Self::sqrt_ratio(n, d);
        let cosine = match folded.min(12 - folded) {
            0 => Self::one(),
            1 => root(3, 8) + root(1, 8),
            2 => root(3, 4),
            3 => root(1, 2),
            4 => Self::ratio(1, 2),
            5 => root(3, 8) - root(1, 8),
            _ => Self::zero(),
        };
        if folded > 6 { -cosine } else { cosine }
    }

    /// sin(π·p/q), as [`Exact::cos_pi`].
    ///
    /// # Panics
    ///
    /// If `q` is zero.
    pub fn sin_pi(p: i64, q: i64) -> Self {
        let p = p % (2 * q);
        Self::cos_pi(q - 2 * p, 2 * q)
    }

    /// The square root: exact for a rational, a `Real` otherwise.
    ///
    /// # Panics
    ///
    /// If the number is negative.
    pub fn sqrt(&self) -> Self {
        match &self.0 {
            Form::Sum(terms) => match &terms[..] {
                [] => Self::zero(),
                [term] if term.surd.is_one() => {
                    Self::sqrt_ratio(term.coefficient.numer().clone(), term.coefficient.denom().clone())
                }
                _ => Self::real(self.to_real().sqrt()),
            },
            Form::Real(r) => Self::real(r.sqrt()),
        }
    }

    fn rational(q: BigRational) -> Self {
        Self::term(q, Surd::one())
    }

    fn term(coefficient: BigRational, surd: Surd) -> Self {
        if coefficient.is_zero() { Self::zero() } else { Self(Form::Sum(vec![Term { surd, coefficient }])) }
    }

    /// Whether this is 0: for a sum decided on integers; a `Real` below 2^-400 has become the sum 0 already. (A
    /// derived constant is meant to be 0 or above 2^-60 in size; what lies between is an error of its derivation.)
    pub fn is_zero(&self) -> bool {
        matches!(&self.0, Form::Sum(terms) if terms.is_empty())
    }

    /// Whether this is 1, decided as [`Exact::is_zero`] is.
    pub fn is_one(&self) -> bool {
        matches!(&self.0, Form::Sum(terms)
            if terms.len() == 1 && terms[0].coefficient.is_one() && terms[0].surd.is_one())
    }

    /// The sign: -1, 0 or 1.
    pub fn signum(&self) -> i32 {
        match &self.0 {
            Form::Sum(terms) => match &terms[..] {
                [] => 0,
                [term] => sign(term.coefficient.numer()),
                terms => refine(terms, |n, _| sign(n)),
            },
            Form::Real(r) => sign(&r.0),
        }
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        if self.signum() < 0 { -self } else { self.clone() }
    }

    /// The value to 512 fractional bits.
    pub fn to_real(&self) -> Real {
        match &self.0 {
            Form::Sum(terms) => {
                let (low, high, exponent) = enclose(terms, Real::BITS + 64);
                let excess = exponent + Real::BITS as i64;
                if excess <= 0 {
                    return Real(round_shift(&(low + high), excess.unsigned_abs() + 1));
                }
                let (low, high, exponent) = enclose(terms, Real::BITS + 64 + excess as u64);
                Real(round_shift(&(low + high), (-exponent) as u64 - Real::BITS + 1))
            }
            Form::Real(r) => r.clone(),
        }
    }

    /// The nearest `f32`, ties to even, rounded once from the exact value.
    pub fn to_f32(&self) -> f32 {
        self.round(&BINARY32) as f32
    }

    /// The nearest `f64`, ties to even, rounded once from the exact value.
    pub fn to_f64(&self) -> f64 {
        self.round(&BINARY64)
    }

    fn round(&self, format: &Format) -> f64 {
        match &self.0 {
            Form::Sum(terms) => match &terms[..] {
                [] => 0.0,
                [term] if term.surd.is_one() => format.round_ratio(&term.coefficient),
                terms => refine(terms, |n, exponent| format.round(n, exponent)),
            },
            Form::Real(r) => format.round(&r.0, -(Real::BITS as i64)),
        }
    }

    fn sum(mut terms: Vec<Term>) -> Self {
        if terms.len() > 1 {
            terms.sort_by(|a, b| a.surd.cmp(&b.surd));
            terms.dedup_by(|next, kept| {
                let same = next.surd == kept.surd;
                if same {
                    kept.coefficient += &next.coefficient;
                }
                same
            });
        }
        terms.retain(|term| !term.coefficient.is_zero());
        Self(Form::Sum(terms))
    }

    fn add_exact(&self, other: &Self) -> Self {
        match (&self.0, &other.0) {
            (Form::Sum(a), _) if a.is_empty() => other.clone(),
            (_, Form::Sum(b)) if b.is_empty() => self.clone(),
            (Form::Sum(a), Form::Sum(b)) => Self::sum(a.iter().chain(b).cloned().collect()),
            _ => Self::real(&self.to_real() + &other.to_real()),
        }
    }

    fn sub_exact(&self, other: &Self) -> Self {
        self.add_exact(&-other)
    }

    fn mul_exact(&self, other: &Self) -> Self {
        match (&self.0, &other.0) {
            (Form::Sum(a), Form::Sum(b)) => {
                Self::sum(a.iter().flat_map(|x| b.iter().map(move |y| x.times(y))).collect())
            }
            _ if self.is_zero() || other.is_zero() => Self::zero(),
            _ if self.is_one() => other.clone(),
            _ if other.is_one() => self.clone(),
            _ => Self::real(&self.to_real() * &other.to_real()),
        }
    }

    fn div_exact(&self, other: &Self) -> Self {
        assert!(!other.is_zero(), "division of {self:?} by zero");
        if let (Form::Sum(_), Form::Sum(terms)) = (&self.0, &other.0) {
            if let [term] = &terms[..] {
                return self.mul_exact(&Self::sum(vec![term.inverse()]));
            }
            if let Some(inverse) = other.conjugate_inverse() {
                return self.mul_exact(&inverse);
            }
        }
        if self.is_zero() {
            return Self::zero();
        }
        Self::real(&self.to_real() / &other.to_real())
    }

    /// The inverse of a sum whose terms differ only by rational multiples of roots of at most 4 primes: each factor
    /// that changes the sign of one root removes that root from the denominator.
    fn conjugate_inverse(&self) -> Option<Self> {
        let Form::Sum(terms) = &self.0 else {
            return None;
        };
        let first = &terms[0].surd;
        if terms.iter().any(|t| (t.surd.pi, t.surd.ln) != (first.pi, first.ln)) {
            return None;
        }
        let mut numerator = Self::term(BigRational::one(), Surd { pi: -first.pi, ln: -first.ln, root: BigUint::one() });
        let mut denominator = self * &numerator;
        for _ in 0..=4 {
            let Form::Sum(terms) = &denominator.0 else {
                return None;
            };
            let Some(root) = terms.iter().map(|t| &t.surd.root).find(|root| !root.is_one()) else {
                return Some(numerator.mul_exact(&Self::sum(vec![terms[0].inverse()])));
            };
            let prime = smallest_prime(root)?;
            let conjugate = Self(Form::Sum(terms.iter().map(|t| t.conjugate(prime)).collect()));
            numerator = &numerator * &conjugate;
            denominator = &denominator * &conjugate;
        }
        None
    }
}

impl Term {
    fn times(&self, other: &Self) -> Self {
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

    fn inverse(&self) -> Self {
        Self {
            surd: Surd { pi: -self.surd.pi, ln: -self.surd.ln, root: self.surd.root.clone() },
            coefficient: (&self.coefficient * BigInt::from(self.surd.root.clone())).recip(),
        }
    }

    /// The term under √prime → -√prime.
    fn conjugate(&self, prime: u32) -> Self {
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
    fn one() -> Self {
        Self { pi: 0, ln: 0, root: BigUint::one() }
    }

    fn is_one(&self) -> bool {
        self.pi == 0 && self.ln == 0 && self.root.is_one()
    }
}

/// Bounds of the sum in units of 2^exponent, about `bits` bits below the largest term: `(low, high, exponent)`.
fn enclose(terms: &[Term], bits: u64) -> (BigInt, BigInt, i64) {
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
fn refine<T: PartialEq>(terms: &[Term], of: impl Fn(&BigInt, i64) -> T) -> T {
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

fn sign(n: &BigInt) -> i32 {
    match n.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

/// A binary floating-point format.
struct Format {
    digits: i64,
    least_exponent: i64,
    largest_exponent: i64,
}

const BINARY32: Format = Format { digits: 24, least_exponent: -149, largest_exponent: 104 };
const BINARY64: Format = Format { digits: 53, least_exponent: -1074, largest_exponent: 971 };

impl Format {
    /// n·2^exponent rounded to nearest, ties to even.
    fn round(&self, n: &BigInt, exponent: i64) -> f64 {
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
    fn round_ratio(&self, ratio: &BigRational) -> f64 {
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
fn round_shift(n: &BigInt, shift: u64) -> BigInt {
    if shift == 0 { n.clone() } else { ((n >> (shift - 1)) + 1) >> 1u32 }
}

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
fn square_free(mut n: BigUint) -> (BigUint, BigUint) {
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
fn smallest_prime(n: &BigUint) -> Option<u32> {
    primes().iter().copied().find(|&p| (n % p).is_zero())
}

/// π·2^bits, rounded down but for the last unit.
fn pi_bits(bits: u64) -> BigUint {
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
fn ln_bits(bits: u64) -> BigUint {
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

/// A real number held to 512 bits after the point.
///
/// Two that agree, rounded, in 440 bits after the point are equal: a value found in two ways is one constant.
#[derive(Clone, Debug)]
pub struct Real(BigInt);

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

/// Writes an operator for references and values alike.
macro_rules! operator {
    ($type:ty, $trait:ident, $method:ident, |$a:ident, $b:ident| $value:expr) => {
        impl $trait for &$type {
            type Output = $type;
            fn $method(self, other: Self) -> $type {
                let ($a, $b) = (self, other);
                $value
            }
        }
        impl $trait for $type {
            type Output = $type;
            fn $method(self, other: Self) -> $type {
                (&self).$method(&other)
            }
        }
        impl $trait<&$type> for $type {
            type Output = $type;
            fn $method(self, other: &$type) -> $type {
                (&self).$method(other)
            }
        }
        impl $trait<$type> for &$type {
            type Output = $type;
            fn $method(self, other: $type) -> $type {
                self.$method(&other)
            }
        }
    };
}

operator!(Exact, Add, add, |a, b| a.add_exact(b));
operator!(Exact, Sub, sub, |a, b| a.sub_exact(b));
operator!(Exact, Mul, mul, |a, b| a.mul_exact(b));
operator!(Exact, Div, div, |a, b| a.div_exact(b));
operator!(Real, Add, add, |a, b| Real(&a.0 + &b.0));
operator!(Real, Sub, sub, |a, b| Real(&a.0 - &b.0));
operator!(Real, Mul, mul, |a, b| Real(round_shift(&(&a.0 * &b.0), Real::BITS)));
operator!(Real, Div, div, |a, b| a.quotient(b));

impl Neg for &Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        self.clone().neg()
    }
}

impl Neg for Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        match self.0 {
            Form::Sum(mut terms) => {
                for term in &mut terms {
                    term.coefficient = -std::mem::take(&mut term.coefficient);
                }
                Exact(Form::Sum(terms))
            }
            Form::Real(r) => Exact(Form::Real(-r)),
        }
    }
}

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

impl Sum for Exact {
    fn sum<I: Iterator<Item = Exact>>(iter: I) -> Self {
        iter.fold(Self::zero(), |a, b| a + b)
    }
}

impl From<i64> for Exact {
    fn from(i: i64) -> Self {
        Self::int(i)
    }
}

impl From<Real> for Exact {
    fn from(r: Real) -> Self {
        Self::real(r)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(n: i64) -> Exact {
        Exact::sqrt_ratio(n, 1)
    }

    #[test]
    fn roots_are_square_free() {
        assert_eq!(root(12), Exact::int(2) * root(3));
        assert_eq!(root(49), Exact::int(7));
        assert_eq!(Exact::sqrt_ratio(8, 27), Exact::ratio(2, 9) * root(6));
        assert_eq!(root(0), Exact::zero());
        let large = 1_000_003_i64;
        assert_eq!(root(large * large), Exact::int(large));
        assert_eq!(root(6 * large) * root(15 * large), Exact::int(3 * large) * root(10));
    }

    #[test]
    fn sums_are_canonical() {
        let a = root(2) + root(3) + Exact::ratio(1, 2);
        let b = Exact::ratio(1, 2) + root(3) + root(2);
        assert_eq!(a, b);
        assert!((&a - &b).is_zero());
        assert_eq!((root(2) + root(3)) * (root(3) - root(2)), Exact::one());
        assert!((root(2) * root(8) / Exact::int(4)).is_one());
        assert_eq!(Exact::pi_sqrt_power(1) * Exact::pi_sqrt_power(-1), Exact::one());
        assert_eq!((0..4).map(Exact::int).sum::<Exact>(), Exact::int(6));
    }

    #[test]
    fn divides_by_conjugation() {
        for divisor in [
            root(2) + Exact::one(),
            root(2) + root(3) + root(5) + Exact::ratio(1, 3),
            root(2) + root(3) + root(5) + root(7),
            (root(6) - root(10)) * Exact::pi_sqrt_power(-3),
            (root(2) + Exact::one()) * Exact::ln_one_plus_sqrt2(),
        ] {
            assert_eq!(Exact::one() / &divisor * &divisor, Exact::one());
            assert!(matches!((Exact::one() / &divisor).0, Form::Sum(_)));
        }
        assert_eq!(Exact::one() / (root(2) - Exact::one()), root(2) + Exact::one());
        let five = root(2) + root(3) + root(5) + root(7) + root(11) + Exact::one();
        assert!(matches!((Exact::one() / &five).0, Form::Real(_)));
        assert!((Exact::one() / &five * five).is_one());
        let mixed = Exact::pi_sqrt_power(2) + Exact::one();
        assert_eq!(&mixed / (&mixed * Exact::ratio(1, 3)), Exact::int(3));
    }

    #[test]
    fn signs_are_decided_past_cancellation() {
        // 3363/2378 is a convergent of √2.
        let close = root(2) - Exact::ratio(3363, 2378);
        assert_eq!(close.signum(), -1);
        assert_eq!(close.abs().signum(), 1);
        let mut tiny = root(2) - Exact::one();
        for _ in 0..7 {
            tiny = &tiny * &tiny;
        }
        assert_eq!(tiny.signum(), 1);
        let expected = (2f64.sqrt() - 1.0).powi(128);
        assert!((tiny.to_f64() / expected - 1.0).abs() < 1e-13);
        assert_eq!(Exact::zero().signum(), 0);
    }

    #[test]
    fn rounds_to_nearest() {
        assert_eq!(Exact::ratio(1, 10).to_f64(), 0.1);
        assert_eq!(Exact::ratio(-1, 10).to_f32(), -0.1);
        assert_eq!(root(2).to_f64(), std::f64::consts::SQRT_2);
        assert_eq!(root(2).to_f32(), std::f32::consts::SQRT_2);
        assert_eq!(Exact::pi_sqrt_power(2).to_f64(), std::f64::consts::PI);
        assert_eq!(Exact::pi_sqrt_power(-2).to_f64(), std::f64::consts::FRAC_1_PI);
        assert_eq!((Exact::int(2) * Exact::pi_sqrt_power(-1)).to_f64(), std::f64::consts::FRAC_2_SQRT_PI);
        assert_eq!(Exact::ln_one_plus_sqrt2().to_f64(), 0.881_373_587_019_543);
        assert_eq!((Exact::one() / Exact::ln_one_plus_sqrt2()).to_f64(), 1.134_592_657_106_511);
        assert_eq!((Exact::one() / Exact::ln_one_plus_sqrt2()).to_real().to_f64(), 1.134_592_657_106_511);
        // √3/(2√π), the band-1 constant.
        assert_eq!((Exact::sqrt_ratio(3, 4) * Exact::pi_sqrt_power(-1)).to_f64(), 0.488_602_511_902_919_9);
    }

    #[test]
    fn rounds_at_the_ends_of_the_range() {
        let power = |e: u32| BigInt::one() << e;
        assert_eq!(Exact::ratio(1, power(149)).to_f32(), f32::from_bits(1));
        assert_eq!(Exact::ratio(1, power(150)).to_f32(), 0.0);
        assert_eq!(Exact::ratio(3, power(150)).to_f32(), f32::from_bits(2));
        assert_eq!(Exact::ratio(power(200) + 1, power(350)).to_f32(), f32::from_bits(1));
        assert_eq!(Exact::ratio(1, power(400)).to_f32(), 0.0);
        assert_eq!(Exact::ratio(1, power(1074)).to_f64(), f64::from_bits(1));
        assert_eq!(Exact::ratio(power(128), 1).to_f32(), f32::INFINITY);
        assert_eq!(Exact::ratio(-power(1024), 1).to_f64(), f64::NEG_INFINITY);
        assert_eq!(Exact::ratio(power(128) - power(103), 1).to_f32(), f32::INFINITY);
        assert_eq!(Exact::ratio(power(128) - power(103) - 1, 1).to_f32(), f32::MAX);
        assert_eq!(Exact::ratio(power(1024) - power(970) - 1, 1).to_f64(), f64::MAX);
        assert_eq!((Exact::ratio(power(300), 1) * root(2)).to_f32(), f32::INFINITY);
        assert_eq!((Exact::ratio(power(300), 1) * root(2)).to_real().to_f64(), 2f64.powi(300) * 2f64.sqrt());
    }

    #[test]
    fn rounds_once() {
        // 1 + 2^-24 is halfway between two f32; 2^-60 more is lost in f64.
        let above: BigInt = BigInt::from((1_i64 << 60) + (1_i64 << 36) + 1);
        let rational = Exact::ratio(above.clone(), 1_i64 << 60);
        assert_eq!(rational.to_f64() as f32, 1.0);
        assert_eq!(rational.to_f32(), 1.0 + f32::EPSILON);
        let surd = Exact::sqrt_ratio(above.pow(2) + 1, BigInt::one() << 120);
        assert_eq!(surd.to_f64() as f32, 1.0);
        assert_eq!(surd.to_f32(), 1.0 + f32::EPSILON);
        let real = Exact::real(rational.to_real());
        assert_eq!(real.to_f32(), 1.0 + f32::EPSILON);
        assert_eq!(Exact::ratio((1 << 24) + 1, 1 << 24).to_f32(), 1.0);
        assert_eq!(Exact::ratio((1 << 24) + 3, 1 << 24).to_f32(), 1.0 + 2.0 * f32::EPSILON);
    }

    #[test]
    fn reals_compute() {
        let third = Real::from_ratio(1, 3);
        let three = Real::from_ratio(3, 1);
        assert_eq!(&third * &three, Real::from_ratio(1, 1));
        assert_eq!(&Real::from_ratio(1, 1) / &three, third);
        assert_eq!(Real::from_ratio(-1, 3).abs(), third);
        let two = Real::from_ratio(2, 1);
        assert!((&two.sqrt() * &two.sqrt() - &two).is_negligible());
        assert_eq!(Real::pi().to_f64(), std::f64::consts::PI);
        assert!(third < three);
        assert!(!Exact::real(third).is_zero());
        assert_eq!(Exact::real(&two.sqrt() * &two.sqrt()), Exact::int(2));
    }

    #[test]
    fn cosines_and_sines() {
        assert_eq!(Real::cos_pi(1, 2), Real::zero());
        assert_eq!(Real::cos_pi(1, 3), Real::from_ratio(1, 2));
        assert_eq!(Real::cos_pi(-2, 3), Real::from_ratio(-1, 2));
        assert_eq!(Real::sin_pi(1, 6), Real::from_ratio(1, 2));
        assert_eq!(Real::sin_pi(7, -6), Real::from_ratio(1, 2));
        assert_eq!(Real::cos_pi(1, 4), Real::from_ratio(1, 2).sqrt());
        for p in -30..30 {
            let (cos, sin) = (Real::cos_pi(p, 7), Real::sin_pi(p, 7));
            let angle = std::f64::consts::PI * p as f64 / 7.0;
            assert!((cos.to_f64() - angle.cos()).abs() < 1e-14);
            assert!((sin.to_f64() - angle.sin()).abs() < 1e-14);
            assert!((&(&cos * &cos) + &(&sin * &sin) - Real::from_ratio(1, 1)).is_negligible());
        }
    }

    #[test]
    fn exact_cosines_are_the_series() {
        for q in [1, 2, 3, 4, 5, 6, 7, 8, 12] {
            for p in -30..30 {
                for (exact, real) in
                    [(Exact::cos_pi(p, q), Real::cos_pi(p, q)), (Exact::sin_pi(p, q), Real::sin_pi(p, q))]
                {
                    assert_eq!(exact.to_real(), real);
                }
            }
        }
    }

    #[test]
    fn roots_of_numbers() {
        assert_eq!(Exact::ratio(4, 9).sqrt(), Exact::ratio(2, 3));
        assert_eq!(Exact::ratio(3, 7).sqrt(), Exact::sqrt_ratio(3, 7));
        let nested = (Exact::int(2) + root(2)).sqrt();
        assert_eq!(nested, Exact::int(2) * Exact::cos_pi(1, 8));
        assert_eq!(Exact::zero().sqrt(), Exact::zero());
    }

    #[test]
    fn a_real_agrees_with_its_sum() {
        for sum in [
            root(7) - Exact::ratio(5, 3),
            Exact::pi_sqrt_power(-3) * root(5),
            Exact::ratio(11, 12) * root(2) - Exact::ratio(3, 4) * Exact::ln_one_plus_sqrt2(),
        ] {
            assert!((Exact::real(sum.to_real()) - &sum).is_zero());
            assert_eq!(Exact::real(sum.to_real()).to_f64(), sum.to_f64());
            assert_eq!(Exact::real(sum.to_real()).signum(), sum.signum());
        }
    }
}
