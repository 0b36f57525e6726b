//! The constants of the basis and of its rotations in closed form, each an exact surd: docs/MATH.md#norms-and-recurrences,
//! docs/MATH.md#the-generator and docs/MATH.md#the-exchange-of-y-and-z have the formulas.
//!
//! The basis is real and orthonormal, with the Condon-Shortley phase: band 1 is √(3/4π)·(-y, z, -x), and
//! `y_l^m = √2 K_l^m (-1)^m P_l^(m)(z) Re (x+iy)^m` for m > 0, with Im and |m| for m < 0, without √2 for m = 0.
//! A rotation R acts by `y(Rω) = D y(ω)`, on coefficients by `c' = D c`.

use num_bigint::BigInt;
use num_integer::{Integer, binomial};
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::exact::Exact;
use super::index::degrees;
use std::sync::OnceLock;

/// The norm `K_l^m = √((2l+1)(l-m)! / (4π(l+m)!))`, 0 ≤ m ≤ l.
pub fn k(l: usize, m: usize) -> Exact {
    Exact::sqrt_ratio(2 * l + 1, 4 * product(l - m + 1, l + m)) * Exact::pi_sqrt_power(-1)
}

/// What `P_l^(m)(z)` times the cosine or sine part of (x+iy)^|m| is multiplied by in y_l^m: the norm, √2 unless m = 0,
/// and the sign (-1)^m.
pub fn basis_factor(l: usize, m: isize) -> Exact {
    let norm = k(l, m.unsigned_abs());
    match m {
        0 => norm,
        m if m % 2 == 0 => norm * Exact::sqrt_ratio(2, 1),
        _ => -(norm * Exact::sqrt_ratio(2, 1)),
    }
}

/// Returns y_l^m for m from −l to l at a direction of height `z`, of which `horizontal(m)` is (x + iy)^m.
pub fn band_values(l: usize, z: &Exact, horizontal: impl Fn(usize) -> [Exact; 2]) -> Vec<Exact> {
    let mut row = vec![Exact::zero(); 2 * l + 1];
    for m in 0..=l {
        let polar = &basis_factor(l, m as isize) * evaluate(&legendre_polynomial(l, m), z);
        let [cosine, sine] = horizontal(m);
        // Degree 0 writes its zero sine first.
        row[l - m] = &polar * sine;
        row[l + m] = polar * cosine;
    }
    row
}

/// A polynomial, even or odd, by Horner's rule in z².
fn evaluate(coefficients: &[Exact], z: &Exact) -> Exact {
    let square = z * z;
    let parity = (coefficients.len() + 1) % 2;
    let even = coefficients.iter().skip(parity).step_by(2).rev();
    let value = even.fold(Exact::zero(), |sum, c| sum * &square + c);
    if parity == 1 { value * z } else { value }
}

/// The coefficients, lowest first, of the polynomial `P_l^(m)(z)`, the m-th derivative of the Legendre polynomial P_l;
/// every second one is zero. Rational, with denominators that divide 2^l.
pub fn legendre_polynomial(l: usize, m: usize) -> Vec<Exact> {
    let exact = |c: BigRational| Exact::ratio(c.numer().clone(), c.denom().clone());
    legendre_rationals(l, m).into_iter().map(exact).collect()
}

/// [`legendre_polynomial`] as rational numbers.
pub fn legendre_rationals(l: usize, m: usize) -> Vec<BigRational> {
    let mut coefficients = vec![BigRational::zero(); (l + 1).saturating_sub(m)];
    for j in 0..=l / 2 {
        let Some(power) = (l - 2 * j).checked_sub(m) else {
            break;
        };
        let choices = binomial(BigInt::from(l), j.into()) * binomial(BigInt::from(2 * l - 2 * j), l.into());
        let numerator = choices * product(power + 1, l - 2 * j);
        coefficients[power] = BigRational::new(if j % 2 == 0 { numerator } else { -numerator }, BigInt::one() << l);
    }
    coefficients
}

/// The normalised recurrence's `(a, b)` for l > m: `K_l P_l^(m) = a z K_(l-1) P_(l-1)^(m) - b K_(l-2) P_(l-2)^(m)`, all
/// K of degree m, with `a = √((4l²-1)/(l²-m²))` and `b = √(((l-1)²-m²)(2l+1) / ((2l-3)(l²-m²)))`, which is 0 at l = m+1.
pub fn legendre_recurrence(l: usize, m: usize) -> (Exact, Exact) {
    let width = l * l - m * m;
    let a = Exact::sqrt_ratio(4 * l * l - 1, width);
    let b = if l == m + 1 {
        Exact::zero()
    } else {
        Exact::sqrt_ratio(((l - 1) * (l - 1) - m * m) * (2 * l + 1), (2 * l - 3) * width)
    };
    (a, b)
}

/// The ladder coefficient `a_m(l) = ½√((l+m)(l-m+1))`, times √2 at m = 1; 1 ≤ m ≤ l.
pub fn ladder(l: usize, m: usize) -> Exact {
    Exact::sqrt_ratio((l + m) * (l + 1 - m) * if m == 1 { 2 } else { 1 }, 4)
}

/// The entry [m, m-1] of dD/dβ at 0 for the rotation by β about y. The derivative is antisymmetric, and has no entries
/// but these and their mirror images [m-1, m].
pub fn dy_sub_diag(l: usize, m: isize) -> Exact {
    match m {
        1.. => -ladder(l, m.unsigned_abs()),
        0 => Exact::zero(),
        _ if m.unsigned_abs() == l => Exact::zero(),
        // The edge from -k to -k-1 is that from k to k+1; only m = 0 to 1 has the √2.
        _ => ladder(l, m.unsigned_abs() + 1),
    }
}

/// The entry [m, m] of d²D/dβ² at 0 for the rotation by β about y.
pub fn ddy_diag(l: usize, m: isize) -> Exact {
    let (all, m_squared) = ((l * (l + 1)) as i64, (m * m) as i64);
    let quarters = -2 * (all - m_squared)
        + match m {
            1 => -all,
            -1 => all,
            _ => 0,
        };
    Exact::ratio(quarters, 4)
}

/// The bands below this are kept once computed: every rotation reads them again.
const KEPT_BANDS: usize = 16;

/// The entry [a, b] of J, the action of swapping y and z on band `l`: a symmetric involution. It is `±√n/2^l` with a
/// natural n.
pub fn swap_yz(l: usize, a: isize, b: isize) -> Exact {
    static KEPT: [OnceLock<Vec<Exact>>; KEPT_BANDS] = [const { OnceLock::new() }; KEPT_BANDS];
    let Some(band) = KEPT.get(l) else {
        return swap_entry(l, a, b);
    };
    let size = 2 * l + 1;
    let entries = band.get_or_init(|| {
        let all = degrees(l).flat_map(|a| degrees(l).map(move |b| swap_entry(l, a, b)));
        all.collect()
    });
    let place = |m: isize| m.wrapping_add_unsigned(l) as usize;
    entries[place(a) * size + place(b)].clone()
}

fn swap_entry(l: usize, a: isize, b: isize) -> Exact {
    let odd = |m: isize| (l + m.unsigned_abs()) % 2 == 1;
    if (a < 0) != odd(b) || (b < 0) != odd(a) {
        return Exact::zero();
    }
    let (p, q) = (a.unsigned_abs(), b.unsigned_abs());
    let (w, mirrored) = (alternating_sum(l, p, q), alternating_sum(l, q, p));
    let scale = match (p, q) {
        (0, 0) => 1,
        (0, _) | (_, 0) => 2,
        _ => 4,
    };
    let flips = l + (p + q).div_ceil(2) + usize::from(a >= 0 && b < 0);
    let size = Exact::sqrt_ratio((&w * mirrored).abs() * scale, BigInt::one() << (2 * l));
    if flips.is_odd() != w.is_negative() { -size } else { size }
}

/// The entry [a, b] of the rotation of band `l` about x by +90° (y to z; `sign` positive) or -90° (`sign` negative).
/// As R(+90°) swaps y and z and then turns y around, its matrix is J with the rows m < 0 negated, and that of R(-90°),
/// its transpose, J with the columns m < 0 negated.
pub fn x90(l: usize, a: isize, b: isize, sign: i32) -> Exact {
    let entry = swap_yz(l, a, b);
    if (if sign < 0 { b } else { a }) < 0 { -entry } else { entry }
}

/// `Σ_k (-1)^(k+a-b) C(l+b, k) C(l-b, l-a-k)`.
fn alternating_sum(l: usize, a: usize, b: usize) -> BigInt {
    let first = b.saturating_sub(a);
    let mut term = binomial(BigInt::from(l + b), first.into()) * binomial(BigInt::from(l - b), (l - a - first).into());
    let mut sum = BigInt::zero();
    for k in first..=l - a {
        if (k + a + b).is_even() {
            sum += &term;
        } else {
            sum -= &term;
        }
        term = term * ((l + b).saturating_sub(k) * (l - a - k)) / ((k + 1) * (k + 1 + a - b));
    }
    sum
}

/// `from·(from+1)···to`, 1 if empty.
fn product(from: usize, to: usize) -> BigInt {
    (from..=to).map(BigInt::from).product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::index::degrees;

    #[test]
    fn the_swap_is_a_symmetric_involution_and_x90_an_inverse_pair() {
        for l in [0, 1, 2, 3, 6, 9] {
            for a in degrees(l) {
                for b in degrees(l) {
                    let unit = if a == b { Exact::one() } else { Exact::zero() };
                    let times = |f: &dyn Fn(isize, isize) -> Exact, g: &dyn Fn(isize, isize) -> Exact| {
                        degrees(l).map(|i| f(a, i) * g(i, b)).sum::<Exact>()
                    };
                    let j = |a, b| swap_yz(l, a, b);
                    assert_eq!(j(a, b), j(b, a));
                    assert_eq!(times(&j, &j), unit);
                    assert_eq!(times(&|a, b| x90(l, a, b, 1), &|a, b| x90(l, a, b, -1)), unit);
                }
            }
        }
    }

    #[test]
    fn the_swap_has_a_unit_row_at_l_64() {
        let row = degrees(64).map(|b| swap_yz(64, 3, b)).map(|e| &e * &e).sum::<Exact>();
        assert_eq!(row, Exact::one());
    }

    #[test]
    fn the_recurrence_makes_the_polynomials() {
        for m in 0..6 {
            for l in m + 1..9 {
                let (a, b) = legendre_recurrence(l, m);
                let row = |l: usize| -> Vec<Exact> { legendre_polynomial(l, m).iter().map(|c| c * k(l, m)).collect() };
                let (two, one) = (if l >= m + 2 { row(l - 2) } else { Vec::new() }, row(l - 1));
                for (i, c) in row(l).iter().enumerate() {
                    let up = if i > 0 { one[i - 1].clone() } else { Exact::zero() };
                    let back = two.get(i).cloned().unwrap_or_else(Exact::zero);
                    assert_eq!(*c, &a * up - &b * back);
                }
            }
        }
    }
}
