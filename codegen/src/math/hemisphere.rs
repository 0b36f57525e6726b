//! Spherical and hemispherical harmonics as matrices between each other: C, which cuts a function off at the horizon, the best
//! extension E of one that goes on below it, and the generators of rotations about y that they make of the sphere's
//! (docs/MATH.md#the-matrix-c, docs/MATH.md#rotation-on-the-hemisphere). Each couples equal m only, or m with m ± 1, and is
//! the same for m and −m.

use super::exact::{Exact, Real};
use super::index::{coefficients, degrees};
use super::inverse::inverse;
use super::tables::{ladder, legendre_rationals, swap_yz};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;
use std::sync::{LazyLock, OnceLock};

/// The highest order of hemispherical harmonics that has tables.
pub const HIGHEST_ORDER: usize = 10;
/// The order of the spherical harmonics that generators and extensions go by, and the highest that has tables.
pub const SPHERICAL_ORDER: usize = 16;

/// What a function is below the horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Below {
    /// Zero: a lobe.
    Zero,
    /// What it most likely is, from what it is above: a record of radiance.
    GoesOn,
}

/// The matrix of an order m, rows and columns from band m on.
pub type Block = Vec<Vec<Exact>>;

type Polynomial = Vec<BigRational>;

/// The matrices of all m, of reals.
type RealBlocks = Vec<Vec<Vec<Real>>>;

fn integer(i: i64) -> BigRational {
    BigRational::from_integer(i.into())
}

fn times(a: &[BigRational], b: &[BigRational]) -> Polynomial {
    let mut product = vec![BigRational::zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate().filter(|(_, y)| !y.is_zero()) {
            product[i + j] += x * y;
        }
    }
    product
}

/// 2^m (1 − z)^m (z (1 + z))^⌊m/2⌋ P_l^(m)(2z − 1), by rising powers of z.
fn weighted(l: usize, m: usize) -> Polynomial {
    let height = [integer(-1), integer(2)];
    let mut all = legendre_rationals(l, m).into_iter().rev().fold(Polynomial::new(), |nested, factor| {
        let mut next = times(&nested, &height);
        next.resize(next.len().max(1), BigRational::zero());
        next[0] += factor;
        next
    });
    for _ in 0..m {
        all = times(&all, &[integer(2), integer(-2)]);
    }
    for _ in 0..m / 2 {
        all = times(&all, &[BigRational::zero(), integer(1), integer(1)]);
    }
    all
}

/// ∫ z^k dz from 0 to 1, or ∫ z^k √(z + z²) dz = p √2 + s ln(1 + √2), as (p, s).
fn moments(count: usize, is_odd: bool) -> Vec<[BigRational; 2]> {
    if !is_odd {
        return (1..=count).map(|k| [BigRational::new(1.into(), k.into()), BigRational::zero()]).collect();
    }
    let mut all = vec![[BigRational::new(3.into(), 4.into()), BigRational::new((-1).into(), 4.into())]];
    for k in 1..count {
        let ratio = BigRational::new(BigInt::from(2 * k + 1), BigInt::from(2 * (k + 2)));
        let [p, s] = &all[k - 1];
        let next = [BigRational::new(2.into(), (k + 2).into()) - &ratio * p, -(&ratio * s)];
        all.push(next);
    }
    all
}

/// The rows of C for an order m: hemispherical bands from m on, spherical ones from m on.
fn rows(m: usize) -> Block {
    let right: Vec<Polynomial> = (m..SPHERICAL_ORDER).map(|l| legendre_rationals(l, m)).collect();
    let is_odd = m % 2 == 1;
    let moments = moments(3 * HIGHEST_ORDER + SPHERICAL_ORDER, is_odd);
    let factorials = |l: usize| -> BigInt { (l - m + 1..=l + m).map(BigInt::from).product() };
    (m..HIGHEST_ORDER)
        .map(|l| {
            let left = weighted(l, m);
            // What a power of z on the right is multiplied by.
            let of_power: Vec<[BigRational; 2]> = (0..SPHERICAL_ORDER - m)
                .map(|j| {
                    let sum = |part: usize| left.iter().enumerate().map(|(i, x)| x * &moments[i + j][part]).sum();
                    [sum(0), sum(1)]
                })
                .collect();
            right
                .iter()
                .zip(m..)
                .map(|(polynomial, spherical)| {
                    let sum = |part: usize| -> Exact {
                        let terms = polynomial.iter().zip(&of_power);
                        let sum: BigRational = terms.map(|(x, of)| x * &of[part]).sum();
                        Exact::ratio(sum.numer().clone(), sum.denom().clone())
                    };
                    let integral = match is_odd {
                        false => sum(0),
                        true => sum(0) * Exact::sqrt_ratio(2, 1) + sum(1) * Exact::ln_one_plus_sqrt2(),
                    };
                    let bands = (2 * l + 1) * (2 * spherical + 1);
                    integral * Exact::sqrt_ratio(bands, BigInt::from(2) * factorials(l) * factorials(spherical))
                })
                .collect()
        })
        .collect()
}

static C: LazyLock<Vec<Block>> = LazyLock::new(|| (0..HIGHEST_ORDER).map(rows).collect());

static C_REAL: LazyLock<RealBlocks> = LazyLock::new(|| {
    let reals = |row: &Vec<Exact>| row.iter().map(Exact::to_real).collect();
    C.iter().map(|block| block.iter().map(reals).collect()).collect()
});

/// The entry of C for hemispherical band `l` and spherical band `spherical` at the order m, of whatever sign: ∫ H y over the
/// upper hemisphere.
///
/// # Panics
///
/// If a band is below |m| or beyond the tables.
pub fn overlap(l: usize, spherical: usize, m: isize) -> Exact {
    let m = m.unsigned_abs();
    C[m][l - m][spherical - m].clone()
}

/// The fifth root of a positive number, by Newton's iteration from f64's.
fn fifth_root(a: &Real) -> Real {
    let start = a.to_f64().powf(0.2);
    let mut root = Real::from_ratio((start * (1u64 << 60) as f64) as i64, 1i64 << 60);
    // Each step doubles the digits: 53, 106, 212, 424, 848.
    for _ in 0..5 {
        let square = &root * &root;
        let four = Real::from_ratio(4, 1) * &root;
        root = (four + a / &(&square * &square)) / Real::from_ratio(5, 1);
    }
    root
}

/// The prior's power of a coefficient of a band, (1 + l)^(−8/5), as that of radiance falls off.
fn prior(l: usize) -> Real {
    fifth_root(&Real::from_ratio(1, BigInt::from(l + 1).pow(8)))
}

/// E of an order m: spherical bands from m on, hemispherical ones from m to below `order`.
fn extension_block(order: usize, m: usize) -> Vec<Vec<Real>> {
    let c = &C_REAL[m][..order - m];
    let powers: Vec<Real> = (m..SPHERICAL_ORDER).map(prior).collect();
    let weight = Real::from_ratio(1, 1000);
    let gram = |i: usize, j: usize| {
        let terms = c[i].iter().zip(&c[j]).zip(&powers);
        let sum = terms.fold(Real::zero(), |sum, ((x, y), power)| sum + &(x * y) * power);
        if i == j { sum + &weight } else { sum }
    };
    let g: Vec<Vec<Real>> = (0..order - m).map(|i| (0..order - m).map(|j| gram(i, j)).collect()).collect();
    let g = inverse(&g).expect("a Gram matrix with a weight added is positive");
    let entry = |l: usize, power: &Real, j: usize| {
        c.iter().zip(&g).fold(Real::zero(), |sum, (row, g)| sum + &(&row[l] * power) * &g[j])
    };
    let row = |(l, power): (usize, &Real)| (0..order - m).map(|j| entry(l, power, j)).collect();
    powers.iter().enumerate().map(row).collect()
}

/// E for each m.
fn extension_blocks(order: usize) -> &'static [Vec<Vec<Real>>] {
    static KEPT: [OnceLock<RealBlocks>; HIGHEST_ORDER + 1] = [const { OnceLock::new() }; HIGHEST_ORDER + 1];
    KEPT[order].get_or_init(|| (0..order).map(|m| extension_block(order, m)).collect())
}

/// The entry of the best extension E of an order for spherical band `spherical` and hemispherical band `l` at the order m:
/// E = S Cᵀ (C S Cᵀ + 1/1000)⁻¹ with C to spherical order [`SPHERICAL_ORDER`].
///
/// # Panics
///
/// If a band is below |m|, not below the order or beyond the tables.
pub fn extension(order: usize, spherical: usize, l: usize, m: isize) -> Exact {
    let m = m.unsigned_abs();
    Exact::real(extension_blocks(order)[m][spherical - m][l - m].clone())
}

/// What a generator of rotations about y couples the orders m and m + 1 by.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// What the bands of m take from those of m + 1: a row a band of m.
    pub up: Block,
    /// What the bands of m + 1 take from those of m: a row a band of m + 1.
    pub down: Block,
}

/// The generator of rotations about y of an order, for m = 0 and up: C A Cᵀ where functions vanish below the horizon, C A E
/// where they go on, A the sphere's.
pub fn generator(order: usize, below: Below) -> &'static [Coupling] {
    static KEPT: [[OnceLock<Vec<Coupling>>; HIGHEST_ORDER + 1]; 2] =
        [const { [const { OnceLock::new() }; HIGHEST_ORDER + 1] }; 2];
    KEPT[usize::from(below == Below::GoesOn)][order]
        .get_or_init(|| (0..order - 1).map(|m| coupling(order, below, m)).collect())
}

fn coupling(order: usize, below: Below, m: usize) -> Coupling {
    let c = &C_REAL;
    // What a hemispherical coefficient is on the sphere.
    let lifted = |m: usize, l: usize, spherical: usize| match below {
        Below::Zero => c[m][l - m][spherical - m].clone(),
        Below::GoesOn => extension_blocks(order)[m][spherical - m][l - m].clone(),
    };
    let edges: Vec<Real> = (m + 1..SPHERICAL_ORDER).map(|l| ladder(l, m + 1).to_real()).collect();
    let entry = |to: (usize, usize), from: (usize, usize)| {
        let terms = (m + 1..SPHERICAL_ORDER).zip(&edges);
        terms.fold(Real::zero(), |sum, (spherical, edge)| {
            let [(to_m, to_l), (from_m, from_l)] = [to, from];
            sum + &(&c[to_m][to_l - to_m][spherical - to_m] * edge) * &lifted(from_m, from_l, spherical)
        })
    };
    let block = |to: usize, from: usize, sign: i64| -> Block {
        let sign = Exact::int(sign);
        let row = |l: usize| (from..order).map(|k| &sign * &Exact::real(entry((to, l), (from, k)))).collect();
        (to..order).map(row).collect()
    };
    Coupling { up: block(m, m + 1, 1), down: block(m + 1, m, -1) }
}

/// An exact turn about y of spherical bands below [`SPHERICAL_ORDER`], in f64.
struct Turn {
    /// cos kβ and sin kβ.
    multiples: Vec<[f64; 2]>,
}

impl Turn {
    /// By an angle in radians.
    fn new(beta: f64) -> Self {
        Self { multiples: (0..SPHERICAL_ORDER).map(|k| (k as f64 * beta).sin_cos()).map(|(s, c)| [c, s]).collect() }
    }

    /// A band, turned: y and z are exchanged, then comes a turn about z the other way, then the exchange again.
    fn of(&self, x: &[f64]) -> Vec<f64> {
        let l = x.len() / 2;
        let swapped = |x: &[f64]| -> Vec<f64> {
            let row = |a: isize| degrees(l).zip(x).map(|(b, x)| swap_yz(l, a, b).to_f64() * x).sum();
            degrees(l).map(row).collect()
        };
        let x = swapped(x);
        let at = |m: isize| x[l.wrapping_add_signed(m)];
        let turned = degrees(l).map(|m| {
            let [c, s] = self.multiples[m.unsigned_abs()];
            c * at(m) + if m < 0 { -s } else { s } * at(-m)
        });
        swapped(&turned.collect::<Vec<f64>>())
    }
}

/// C times a band of spherical coefficients, added to hemispherical ones.
fn project(order: usize, x: &[f64], out: &mut [f64]) {
    let spherical = x.len() / 2;
    for ((l, m), out) in coefficients(order).zip(out).filter(|((_, m), _)| m.unsigned_abs() <= spherical) {
        *out += overlap(l, spherical, m).to_f64() * x[spherical.wrapping_add_signed(m)];
    }
}

/// The matrix by rows that turns about y by an angle in radians, in f64: C D E where functions go on below the horizon, C D Cᵀ
/// where they vanish, D of spherical order [`SPHERICAL_ORDER`].
pub fn about_y(order: usize, below: Below, beta: f64) -> Vec<Vec<f64>> {
    let turn = Turn::new(beta);
    let lifted = |l: usize, spherical: usize, m: isize| match below {
        Below::Zero => overlap(l, spherical, m).to_f64(),
        Below::GoesOn => extension(order, spherical, l, m).to_f64(),
    };
    let columns: Vec<Vec<f64>> = coefficients(order)
        .map(|(l, m)| {
            let mut column = vec![0.0; order * order];
            for spherical in m.unsigned_abs()..SPHERICAL_ORDER {
                let mut x = vec![0.0; 2 * spherical + 1];
                x[spherical.wrapping_add_signed(m)] = lifted(l, spherical, m);
                project(order, &turn.of(&x), &mut column);
            }
            column
        })
        .collect();
    (0..order * order).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

/// Independent functions on the sphere, each of the power that the prior of the best extension gives it, as hemispherical
/// coefficients before and after a turn about y by an angle in radians: what a record of radiance is expected to be.
pub fn expected_records(order: usize, beta: f64) -> Vec<[Vec<f64>; 2]> {
    let turn = Turn::new(beta);
    coefficients(SPHERICAL_ORDER)
        .map(|(spherical, m)| {
            let mut x = vec![0.0; 2 * spherical + 1];
            x[spherical.wrapping_add_signed(m)] = prior(spherical).to_f64().sqrt();
            [x.clone(), turn.of(&x)].map(|x| {
                let mut out = vec![0.0; order * order];
                project(order, &x, &mut out);
                out
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::gauss_legendre;
    use crate::math::tables;

    /// A harmonic's part in z, over (1 − z²)^(m/2), at a height.
    fn polynomial(l: usize, m: usize, z: f64) -> f64 {
        let row = tables::legendre_polynomial(l, m);
        tables::basis_factor(l, m as isize).to_f64() * row.iter().rev().fold(0.0, |sum, c| sum * z + c.to_f64())
    }

    #[test]
    fn c_is_the_integral_of_both_over_the_hemisphere() {
        for m in 0..6 {
            for l in m..8 {
                for spherical in m..12 {
                    // z = u² takes the root at the horizon away.
                    let integral: f64 = gauss_legendre(60, 0.0, 1.0)
                        .map(|(u, weight)| {
                            let z = u * u;
                            let t = 2.0 * z - 1.0;
                            let rims = ((1.0 - t * t) * (1.0 - z * z)).powf(m as f64 / 2.0);
                            let around = if m == 0 { 2.0 } else { 1.0 } * std::f64::consts::PI;
                            let values = polynomial(l, m, t) * polynomial(spherical, m, z) * rims;
                            weight * 2.0 * u * around * 2f64.sqrt() * values
                        })
                        .sum();
                    let got = overlap(l, spherical, m as isize).to_f64();
                    // 60 points of f64, whose largest terms are some tens.
                    assert!((got - integral).abs() < 2e-13, "{l} {spherical} {m}: {got} {integral}");
                }
            }
        }
    }

    #[test]
    fn c_has_the_non_zeros_that_are_known() {
        let count = |n: usize, spherical: usize| -> usize {
            let of = |m: usize| {
                let pairs = (m..n).flat_map(|l| (m..spherical).map(move |k| (l, k)));
                let all = pairs.filter(|&(l, k)| !overlap(l, k, m as isize).is_zero()).count();
                if m == 0 { all } else { 2 * all }
            };
            (0..n.min(spherical)).map(of).sum()
        };
        assert_eq!([3, 4, 5, 7].map(|spherical| count(3, spherical)), [15, 24, 32, 49]);
        assert_eq!([4, 5, 6, 8].map(|spherical| count(4, spherical)), [37, 52, 68, 99]);
        assert_eq!([6, 7, 8, 10].map(|spherical| count(6, spherical)), [125, 160, 196, 267]);
    }

    #[test]
    fn the_prior_is_a_fifth_root() {
        for l in 0..SPHERICAL_ORDER {
            let power = prior(l);
            assert!((power.to_f64() - ((l + 1) as f64).powf(-1.6)).abs() < 1e-15);
            let fourth = &(&power * &power) * &(&power * &power);
            let fifth = Exact::real(&(&fourth * &power) * &Real::from_ratio(BigInt::from(l + 1).pow(8), 1));
            assert!(fifth.is_one(), "{l}");
        }
    }

    #[test]
    fn a_lobe_s_generator_is_antisymmetric_and_its_entries_are_as_many_as_known() {
        for (order, known) in [(3, 20), (4, 56), (6, 220), (8, 560)] {
            let mut entries = 0;
            for (m, Coupling { up, down }) in generator(order, Below::Zero).iter().enumerate() {
                for (i, row) in up.iter().enumerate() {
                    for (j, x) in row.iter().enumerate() {
                        assert_eq!(*x, -&down[j][i]);
                        entries += if x.is_zero() { 0 } else { 2 } * if m == 0 { 1 } else { 2 };
                    }
                }
            }
            assert_eq!(entries, known, "order {order}");
        }
    }
}
