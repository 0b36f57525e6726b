//! Numbers known exactly, which every table of this module is made of and every constant of a kernel starts as
//! (docs/MATH.md#exact-constants).
//!
//! An [`Exact`] is a finite sum of `q·√d·π^(k/2)·ln(1+√2)^j`, held in a canonical form, so that a zero, a one or
//! a repeated constant is recognised without an epsilon. What no such sum can express (a quotient of sums, a root of
//! a polynomial) is a [`Real`] of 512 fractional bits. Either is rounded once, to the nearest `f32` or `f64`.

mod factor;
mod irrational;
mod operator;
mod real;
mod round;
mod term;
#[cfg(test)]
mod tests;

pub use real::Real;

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::{BigInt, BigUint, Sign};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use factor::{smallest_prime, square_free};
use operator::operator;
use round::{BINARY32, BINARY64, Format, round_shift};
use term::{Surd, Term, enclose, refine};

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

fn sign(n: &BigInt) -> i32 {
    match n.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

operator!(Exact, Add, add, |a, b| a.add_exact(b));
operator!(Exact, Sub, sub, |a, b| a.sub_exact(b));
operator!(Exact, Mul, mul, |a, b| a.mul_exact(b));
operator!(Exact, Div, div, |a, b| a.div_exact(b));
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
