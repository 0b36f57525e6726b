//! Polynomials in the three coordinates of a direction, exact: harmonics as such, and integrals of them over the upper
//! hemisphere, from which matrices between bases follow by definition.

use crate::math::exact::Exact;
use crate::math::tables;
use std::collections::BTreeMap;

/// The exponents of three coordinates.
pub type Powers = [usize; 3];

/// A sum of monomials, none of which has the factor zero.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polynomial(BTreeMap<Powers, Exact>);

impl Polynomial {
    /// The sum of monomials with their factors.
    pub fn new(terms: impl IntoIterator<Item = (Powers, Exact)>) -> Self {
        let mut sum = Self::default();
        terms.into_iter().for_each(|(powers, factor)| sum.add(powers, factor));
        sum
    }

    /// One.
    pub fn one() -> Self {
        Self::new([([0; 3], Exact::one())])
    }

    /// Returns the monomials with their factors.
    pub fn terms(&self) -> impl Iterator<Item = (Powers, &Exact)> {
        self.0.iter().map(|(powers, factor)| (*powers, factor))
    }

    /// Returns the factor of a monomial.
    pub fn factor(&self, powers: Powers) -> Exact {
        self.0.get(&powers).cloned().unwrap_or_else(Exact::zero)
    }

    /// Adds a monomial.
    pub fn add(&mut self, powers: Powers, factor: Exact) {
        let sum = &self.factor(powers) + &factor;
        match sum.is_zero() {
            true => _ = self.0.remove(&powers),
            false => _ = self.0.insert(powers, sum),
        }
    }

    /// Returns the sum of it and a multiple of another one.
    #[must_use]
    pub fn plus(mut self, factor: &Exact, other: &Self) -> Self {
        other.terms().for_each(|(powers, of)| self.add(powers, factor * of));
        self
    }

    /// Returns a multiple of it.
    #[must_use]
    pub fn scaled(&self, factor: &Exact) -> Self {
        Self::default().plus(factor, self)
    }

    /// Returns the product of two.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let product = |(a, x): (Powers, &Exact)| {
            other.terms().map(move |(b, y)| (std::array::from_fn(|i| a[i] + b[i]), x * y)).collect::<Vec<_>>()
        };
        Self::new(self.terms().flat_map(product))
    }

    /// Returns it in other coordinates: coordinate i of it is coordinate `order[i]` of the result.
    #[must_use]
    pub fn renamed(&self, order: [usize; 3]) -> Self {
        Self::new(self.terms().map(|(powers, factor)| {
            let mut renamed = [0; 3];
            (0..3).for_each(|i| renamed[order[i]] = powers[i]);
            (renamed, factor.clone())
        }))
    }

    /// The harmonic of a band and an order m at (`across` x, `across` y, `along`₀ + `along`₁ z).
    pub fn harmonic(l: usize, m: isize, across: &Exact, along: [Exact; 2]) -> Self {
        let size = m.unsigned_abs();
        let step = [Self::new([([1, 0, 0], across.clone())]), Self::new([([0, 1, 0], across.clone())])];
        let minus = -Exact::one();
        let mut power = [Self::one(), Self::default()];
        for _ in 0..size {
            let [re, im] = &power;
            power = [
                re.times(&step[0]).plus(&minus, &im.times(&step[1])),
                re.times(&step[1]).plus(&Exact::one(), &im.times(&step[0])),
            ];
        }
        let height = Self::new([([0; 3], along[0].clone()), ([0, 0, 1], along[1].clone())]);
        let legendre = tables::legendre_polynomial(l, size);
        let column = legendre
            .iter()
            .rev()
            .fold(Self::default(), |nested, factor| nested.times(&height).plus(factor, &Self::one()));
        column.times(&power[usize::from(m < 0)]).scaled(&tables::basis_factor(l, m))
    }

    /// Its integral over the directions with z ≥ 0: of xᵃ yᵇ zᶜ, for even a and b, it is 2π (a−1)!! (b−1)!! / (a+b)!! times
    /// the integral of (1 − z²)^((a+b)/2) zᶜ from 0 to 1.
    pub fn over_hemisphere(&self) -> Exact {
        let odd_product =
            |to: usize| (1..to).step_by(2).fold(Exact::one(), |product, k| &product * &Exact::int(k as i64));
        let integral = |[a, b, c]: Powers| {
            if a % 2 == 1 || b % 2 == 1 {
                return Exact::zero();
            }
            let half = (a + b) / 2;
            let around =
                (1..=half).fold(Exact::int(2) * Exact::pi_sqrt_power(2), |sum, k| &sum * &Exact::ratio(1, 2 * k));
            // ∫ (1 − z²)^h z^c dz, by its recurrence in h.
            let up =
                (1..=half).fold(Exact::ratio(1, c + 1), |integral, h| &integral * &Exact::ratio(2 * h, c + 1 + 2 * h));
            around * &odd_product(a) * &odd_product(b) * &up
        };
        self.terms().map(|(powers, factor)| factor * &integral(powers)).sum()
    }
}
