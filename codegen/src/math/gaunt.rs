//! Integrals of three harmonics over the sphere in closed form, each an exact surd (docs/MATH.md#products).

use crate::math::exact::Exact;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;

/// A band and an order that is not negative: the pair of harmonics y_{l,m} and y_{l,−m}, one of them where m = 0.
pub type Mode = (usize, usize);

fn factorial(n: usize) -> BigInt {
    (1..=n).map(BigInt::from).product()
}

/// The sum in Racah's formula for the 3j symbol of three bands and the orders m₁, m₂ and −(m₁ + m₂).
fn racah([l1, l2, l3]: [usize; 3], m1: usize, m2: usize) -> BigRational {
    let mut sum = BigRational::zero();
    for t in 0..=l1 + l2 - l3 {
        let differences = [(l3 + t + m1, l2), (l3 + t, l1 + m2), (l1 + l2, l3 + t), (l1, t + m1), (l2 + m2, t)];
        let factors: Option<Vec<usize>> = differences.into_iter().map(|(a, b)| a.checked_sub(b)).collect();
        let Some(factors) = factors else { continue };
        let below: BigInt = factors.into_iter().map(factorial).product();
        let term = BigRational::new(1.into(), below * factorial(t));
        sum += if t % 2 == 0 { term } else { -term };
    }
    sum
}

/// Returns what A B is multiplied by in the complex coefficient of `sum` where A and B are those of `p` and `q` and
/// m_sum = m_p + m_q: √2 π ∫ p_p p_q p_sum dz, and 2π ∫ where an order is 0 (p without the factor √2 of the real harmonics).
/// Zero unless the bands are the sides of a triangle of even circumference.
pub fn gaunt(p: Mode, q: Mode, sum: Mode) -> Exact {
    let modes = [p, q, sum];
    let [l1, l2, l3] = modes.map(|(l, _)| l);
    debug_assert_eq!(p.1 + q.1, sum.1);
    if (l1 + l2 + l3) % 2 == 1 || l1 + l2 < l3 || l1.abs_diff(l2) > l3 {
        return Exact::zero();
    }
    let triangle = BigRational::new(
        factorial(l1 + l2 - l3) * factorial(l1 + l3 - l2) * factorial(l2 + l3 - l1),
        factorial(l1 + l2 + l3 + 1),
    );
    let own: BigInt = modes.iter().map(|&(l, _)| factorial(l)).product();
    let rational = triangle * own * racah([l1, l2, l3], 0, 0) * racah([l1, l2, l3], p.1, q.1);
    let below_root: BigInt =
        modes.iter().map(|&(l, m)| BigInt::from(2 * l + 1) * factorial(l + m) * factorial(l - m)).product();
    let halves = if modes.iter().all(|&(_, m)| m > 0) { 8 } else { 4 };
    let root = Exact::sqrt_ratio(below_root, halves) * Exact::pi_sqrt_power(-1);
    Exact::ratio(rational.numer().clone(), rational.denom().clone()) * root
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::gauss_legendre;
    use crate::math::tables::{k, legendre_polynomial};
    use std::f64::consts::{PI, SQRT_2};

    /// K_l^m P_l^(m)(z) times (1 − z²)^(m/2), with the sign of the phase.
    fn part((l, m): Mode, z: f64) -> f64 {
        let value = legendre_polynomial(l, m).iter().rev().fold(0.0, |sum, c| sum * z + c.to_f64());
        let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
        sign * k(l, m).to_f64() * value * (1.0 - z * z).sqrt().powi(m as i32)
    }

    #[test]
    fn the_closed_form_is_the_integral() {
        let modes: Vec<Mode> = (0..6).flat_map(|l| (0..=l).map(move |m| (l, m))).collect();
        let mut nonzeros = 0;
        for &p in &modes {
            for &q in &modes {
                for &sum in modes.iter().filter(|sum| sum.1 == p.1 + q.1) {
                    let integral: f64 = gauss_legendre(9, -1.0, 1.0)
                        .map(|(z, weight)| weight * part(p, z) * part(q, z) * part(sum, z))
                        .sum();
                    let factor = if p.1 > 0 && q.1 > 0 { SQRT_2 * PI } else { 2.0 * PI };
                    let got = gaunt(p, q, sum);
                    // f64 rounds a sum of nine terms of about one.
                    assert!((got.to_f64() - factor * integral).abs() < 2e-15, "{p:?} {q:?} {sum:?}");
                    nonzeros += usize::from(!got.is_zero());
                }
            }
        }
        assert!(nonzeros > 500, "{nonzeros}");
    }
}
