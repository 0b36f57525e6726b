//! What stability is measured against: the basis from its polynomials in whole numbers of any length, rotations as
//! products with the exact J in pairs of doubles. Neither shares a recurrence with the kernels.

use crate::numbers::Twin;
use num_bigint::BigInt;
use std::collections::HashMap;
use std::ops::RangeInclusive;
use zonal_codegen::ir::eval::Number;
use zonal_codegen::math::exact::{Exact, Real};
use zonal_codegen::math::tables::swap_yz;

/// The bits after the point to which a value of the basis is computed.
const BITS: u64 = 600;

/// An f64 as a whole number and how often it is halved.
fn dyadic(value: f64) -> (BigInt, u64) {
    let bits = value.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64;
    // The smallest exponent is shared by the denormal numbers, which lack the leading bit.
    let (significand, halvings) = match exponent {
        0 => (bits & ((1 << 52) - 1), 1074),
        _ => (bits & ((1 << 52) - 1) | 1 << 52, 1075 - exponent),
    };
    let mut number = BigInt::from(significand);
    if halvings < 0 {
        number <<= halvings.unsigned_abs();
    }
    (if value < 0.0 { -number } else { number }, halvings.max(0) as u64)
}

/// One band of the basis: for each m the coefficients of 2^l l! P_l^(m) by falling powers of z, every second one.
#[derive(Clone, Debug)]
pub struct Band {
    l: usize,
    polynomials: Vec<Vec<BigInt>>,
    factorials: Vec<BigInt>,
}

impl Band {
    /// Of a band.
    pub fn new(l: usize) -> Self {
        let mut factorials = vec![BigInt::from(1)];
        for n in 1..=2 * l {
            factorials.push(&factorials[n - 1] * n);
        }
        let polynomial = |m: usize| {
            // 2^l l! P_l = d^l/dz^l (z² − 1)^l, differentiated m times more.
            let mut choose = BigInt::from(1);
            let mut terms = Vec::new();
            for j in 0..=l {
                let Some(power) = (2 * l - 2 * j).checked_sub(l + m) else { break };
                let term = &choose * (&factorials[2 * l - 2 * j] / &factorials[power]);
                terms.push(if j % 2 == 0 { term } else { -term });
                choose = choose * (l - j) / (j + 1);
            }
            terms
        };
        Self { l, polynomials: (0..=l).map(polynomial).collect(), factorials }
    }

    /// The band.
    pub fn l(&self) -> usize {
        self.l
    }

    /// The 2l + 1 values at (x, y, z), which is taken as it is: P_l^(m)(z) times the real or imaginary part of (x + iy)^m.
    pub fn values(&self, [x, y, z]: [f64; 3]) -> Vec<Twin> {
        let l = self.l;
        let (z, halvings) = dyadic(z);
        let square = &z * &z;
        // x and y over one power of two.
        let ((mut a, p), (mut b, q)) = (dyadic(x), dyadic(y));
        let common = p.max(q);
        a <<= common - p;
        b <<= common - q;
        let (mut re, mut im) = (BigInt::from(1), BigInt::from(0));
        let mut values = vec![Twin::ZERO; 2 * l + 1];
        let root_pi = Exact::pi_sqrt_power(-1).to_real();
        for m in 0..=l {
            let mut sum = BigInt::from(0);
            for (place, term) in self.polynomials[m].iter().enumerate() {
                // Each step down in the power of z is two halvings more.
                sum = sum * &square + (term << (2 * halvings * place as u64));
            }
            let degree = l - m;
            let odd = degree % 2;
            if odd == 1 {
                sum *= &z;
            }
            // (2l + 1) (l − m)! / (4 π (l + m)!), twice that unless m = 0, over (2^l l!)².
            let twice = if m == 0 { 1 } else { 2 };
            let factorial = |n: usize| &self.factorials[n];
            let top = BigInt::from((2 * l + 1) * twice) * factorial(l - m);
            let bottom = (factorial(l + m) * factorial(l) * factorial(l)) << (2 + 2 * l);
            let places = degree as u64 * halvings + common * m as u64;
            let value = |part: &BigInt| -> Twin {
                let product = part * &sum;
                let squared = (&product * &product * &top) << (2 * BITS);
                let root = (squared / (&bottom << (2 * places))).sqrt();
                let size = Real::from_ratio(root, BigInt::from(1) << BITS) * &root_pi;
                let negative = (product.sign() == num_bigint::Sign::Minus) != (m % 2 == 1);
                Twin::nearest(&Exact::real(if negative { -size } else { size }))
            };
            values[l + m] = value(&re);
            if m > 0 {
                values[l - m] = value(&im);
            }
            (re, im) = (&re * &a - &im * &b, &re * &b + &im * &a);
        }
        values
    }
}

/// J of a band, the exchange of y and z, row by row with the columns that are not zero.
#[derive(Clone, Debug)]
pub struct Swap(Vec<Vec<(usize, Twin)>>);

impl Swap {
    /// Of a band.
    pub fn new(l: usize) -> Self {
        let degrees = || -(l as isize)..=l as isize;
        let place = |m: isize| (m + l as isize) as usize;
        let mut known: HashMap<(usize, usize), Twin> = HashMap::new();
        let mut rows = vec![Vec::new(); 2 * l + 1];
        for (a, b) in degrees().flat_map(|a| degrees().map(move |b| (a, b))) {
            let (i, j) = (place(a), place(b));
            let entry = *known.entry((i.min(j), i.max(j))).or_insert_with(|| Twin::nearest(&swap_yz(l, a, b)));
            if entry != Twin::ZERO {
                rows[i].push((j, entry));
            }
        }
        Self(rows)
    }

    fn apply(&self, c: &[Twin]) -> Vec<Twin> {
        self.0.iter().map(|row| row.iter().fold(Twin::ZERO, |sum, (j, x)| sum + *x * c[*j])).collect()
    }

    /// The band.
    pub fn l(&self) -> usize {
        self.0.len() / 2
    }

    /// The rows with the entries that are not zero.
    pub fn rows(&self) -> &[Vec<(usize, Twin)>] {
        &self.0
    }
}

/// A (cosine, sine) pair.
pub type Pair = [Twin; 2];

/// e^{ia} e^{ib}.
pub fn turn([a, b]: Pair, [c, d]: Pair) -> Pair {
    [a * c - b * d, a * d + b * c]
}

/// The multiples 0 to `count` of an angle.
pub fn multiples(pair: Pair, count: usize) -> Vec<Pair> {
    let mut all = vec![[Twin::ONE, Twin::ZERO]];
    for _ in 0..count {
        all.push(turn(all[all.len() - 1], pair));
    }
    all
}

fn about_z(c: &[Twin], phases: &[Pair]) -> Vec<Twin> {
    let l = c.len() / 2;
    let mut out = c.to_vec();
    for m in 1..=l {
        let [cos, sin] = phases[m];
        out[l + m] = cos * c[l + m] - sin * c[l - m];
        out[l - m] = cos * c[l - m] + sin * c[l + m];
    }
    out
}

/// A rotation Rz(α) Ry(β) Rz(γ) by the multiples of its angles.
#[derive(Clone, Debug)]
pub struct Rotation {
    /// The multiples of α, β and γ from 0.
    pub angles: [Vec<Pair>; 3],
}

impl Rotation {
    /// By three pairs, for bands up to `highest`.
    pub fn new(pairs: [Pair; 3], highest: usize) -> Self {
        Self { angles: pairs.map(|pair| multiples(pair, highest.max(1))) }
    }

    /// By a quaternion (x, y, z, w) of any length but zero, for bands up to `highest`.
    pub fn of_quaternion(q: [f64; 4], highest: usize) -> Self {
        let [x, y, z, w] = q.map(Twin::from_f64);
        let unit = |[a, b]: Pair| -> Pair {
            let length = (a * a + b * b).root();
            match length == Twin::ZERO {
                true => [Twin::ONE, Twin::ZERO],
                false => [a / length, b / length],
            }
        };
        // α + γ is twice the phase of w + iz, α − γ twice that of y − ix.
        let (plus, minus) = (unit([w, z]), unit([y, -x]));
        let (a, b) = (w * w + z * z, x * x + y * y);
        let two = Twin::from_f64(2.0);
        let beta = unit([a - b, two * (a * b).root()]);
        Self::new([turn(plus, minus), beta, turn(plus, [minus[0], -minus[1]])], highest)
    }

    /// Of one band.
    pub fn apply(&self, swap: &Swap, c: &[Twin]) -> Vec<Twin> {
        let [alpha, beta, gamma] = &self.angles;
        // Ry(β) = J Rz(−β) J.
        let back: Vec<Pair> = beta.iter().map(|[cos, sin]| [*cos, -*sin]).collect();
        let tilted = swap.apply(&about_z(&swap.apply(&about_z(c, gamma)), &back));
        about_z(&tilted, alpha)
    }
}

/// The root of a sum of squares.
pub fn norm(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The norm of what a list of numbers lies from the truth by; infinite if one of them is no number.
pub fn distance<T: Number>(got: &[T], want: &[Twin]) -> f64 {
    let away = got.iter().zip(want).map(|(a, b)| (*b - Twin::from_f64(a.to_f64())).to_f64());
    let distance = norm(away);
    if distance.is_finite() { distance } else { f64::INFINITY }
}

/// The bands of a range that are measured: all up to 16, then every eighth and the last.
pub fn sampled(bands: RangeInclusive<usize>) -> Vec<usize> {
    let last = *bands.end();
    bands.filter(|l| *l <= 16 || l % 8 == 0 || *l == last).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;

    /// The two truths agree: the basis at R z is the rotated basis at z.
    #[test]
    fn the_basis_is_the_rotated_zonal_one() {
        let mut random = Random::new(7);
        for l in [1, 2, 5, 17] {
            let q: [f64; 4] = random.unit();
            let [x, y, z, w] = q;
            let square = x * x + y * y + z * z + w * w;
            let direction = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w + z * z - x * x - y * y];
            let mut pole = vec![Twin::ZERO; 2 * l + 1];
            pole[l] = Band::new(l).values([0.0, 0.0, 1.0])[l];
            let turned = Rotation::of_quaternion(q, l).apply(&Swap::new(l), &pole);
            let values = Band::new(l).values(direction.map(|x| x / square));
            for (a, b) in turned.iter().zip(&values) {
                assert!((*a - *b).to_f64().abs() < 1e-15 * (l * l) as f64, "band {l}");
            }
        }
    }

    #[test]
    fn whole_numbers_hold_what_f64_holds() {
        for value in [0.0, 1.0, -0.75, 3.5e10, 1e-300, f64::MIN_POSITIVE / 4.0] {
            let (number, halvings) = dyadic(value);
            let back = Real::from_ratio(number.clone(), BigInt::from(1) << halvings.min(400)).to_f64();
            let scaled = if halvings > 400 { back * 2f64.powi(-((halvings - 400) as i32)) } else { back };
            assert_eq!(scaled, value);
        }
        assert_eq!(sampled(1..=63)[15..], [16, 24, 32, 40, 48, 56, 63]);
    }
}
