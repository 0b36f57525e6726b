//! The recursion of Ivanic and Ruedenberg (J. Phys. Chem. 1996, with the correction of 1998), which makes each band of a
//! rotation from the one below, and its derivative form (Křivánek et al. 2005, appendix A): what the exact rotation is
//! compared with (docs/MATH.md#stability). It is written for harmonics without the Condon-Shortley phase; the signs are
//! put in at the end.

use crate::numbers::Twin;
use crate::stability::truth::{Rotation, Swap};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use std::ops::{Add, Mul, Neg, Sub};
use zonal_codegen::ir::eval::Number;
use zonal_codegen::math::index::degrees;
use zonal_codegen::math::tables::dy_sub_diag;

/// What the recursion computes with: numbers, or a function's value with its derivatives.
trait Ring: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    fn zero() -> Self;
    fn scale(self, factor: f64) -> Self;
}

impl<T: Number> Ring for T {
    fn zero() -> Self {
        T::ZERO
    }
    fn scale(self, factor: f64) -> Self {
        T::from_f64(factor) * self
    }
}

/// A matrix of 2l + 1 rows, m and n from −l to l.
#[derive(Clone, Debug)]
struct Matrix<R> {
    l: isize,
    entries: Vec<R>,
}

impl<R: Ring> Matrix<R> {
    fn at(&self, m: isize, n: isize) -> R {
        self.entries[((m + self.l) * (2 * self.l + 1) + n + self.l) as usize]
    }
}

fn product<R: Ring>(one: &Matrix<R>, below: &Matrix<R>, i: isize, m: isize, n: isize) -> R {
    let l = below.l + 1;
    match n {
        n if n == l => one.at(i, 1) * below.at(m, l - 1) - one.at(i, -1) * below.at(m, 1 - l),
        n if n == -l => one.at(i, 1) * below.at(m, 1 - l) + one.at(i, -1) * below.at(m, l - 1),
        n => one.at(i, 0) * below.at(m, n),
    }
}

/// The band above one.
fn above<R: Ring>(one: &Matrix<R>, below: &Matrix<R>) -> Matrix<R> {
    let l = below.l + 1;
    let p = |i, m, n| product(one, below, i, m, n);
    let mut entries = Vec::with_capacity(((2 * l + 1) * (2 * l + 1)) as usize);
    for m in -l..=l {
        for n in -l..=l {
            let a = m.abs();
            let d = if n.abs() < l { (l + n) * (l - n) } else { 2 * l * (2 * l - 1) } as f64;
            let zero = m == 0;
            let u = (((l + m) * (l - m)) as f64 / d).sqrt();
            let twice = if zero { 2.0 } else { 1.0 };
            let v = 0.5 * (twice * ((l + a - 1) * (l + a)) as f64 / d).sqrt() * if zero { -1.0 } else { 1.0 };
            let w = if zero { 0.0 } else { -0.5 * (((l - a - 1) * (l - a)) as f64 / d).sqrt() };
            let root = 2f64.sqrt();
            let mut sum = R::zero();
            if u != 0.0 {
                sum = sum + p(0, m, n).scale(u);
            }
            let of_v = match m {
                0 => p(1, 1, n) + p(-1, -1, n),
                1 => p(1, 0, n).scale(root),
                -1 => p(-1, 0, n).scale(root),
                m if m > 0 => p(1, m - 1, n) - p(-1, 1 - m, n),
                m => p(1, m + 1, n) + p(-1, -m - 1, n),
            };
            sum = sum + of_v.scale(v);
            if w != 0.0 {
                let of_w = match m > 0 {
                    true => p(1, m + 1, n) + p(-1, -m - 1, n),
                    false => p(1, m - 1, n) - p(-1, 1 - m, n),
                };
                sum = sum + of_w.scale(w);
            }
            entries.push(sum);
        }
    }
    Matrix { l, entries }
}

/// The matrices of the bands from 1, with the Condon-Shortley phase.
fn bands<R: Ring>(one: Matrix<R>, highest: usize) -> Vec<Matrix<R>> {
    let mut all = vec![one];
    for _ in 1..highest {
        all.push(above(&all[0], &all[all.len() - 1]));
    }
    for matrix in &mut all {
        let size = 2 * matrix.l + 1;
        for (place, entry) in matrix.entries.iter_mut().enumerate() {
            if (place as isize / size + place as isize % size) % 2 != 0 {
                *entry = -*entry;
            }
        }
    }
    all
}

/// The rotation matrices of all bands in `T`.
#[derive(Clone, Debug)]
pub struct Matrices<T>(Vec<Matrix<T>>);

impl<T: Number> Matrices<T> {
    /// Of a quaternion, whose 3×3 matrix is made in pairs of doubles and rounded once.
    pub fn new(q: [f64; 4], highest: usize) -> Self {
        let [x, y, z, w] = q.map(Twin::from_f64);
        let (one, two) = (Twin::ONE, Twin::from_f64(2.0));
        let s = two / (x * x + y * y + z * z + w * w);
        let rows = [
            [one - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
            [s * (x * y + w * z), one - s * (x * x + z * z), s * (y * z - w * x)],
            [s * (x * z - w * y), s * (y * z + w * x), one - s * (x * x + y * y)],
        ];
        // Degrees −1, 0, 1 are y, z, x.
        let axes = [1, 2, 0];
        let entries = axes.iter().flat_map(|i| axes.map(|j| T::from_f64(rows[*i][j].to_f64()))).collect();
        Self(bands(Matrix { l: 1, entries }, highest))
    }

    /// The rotated signal of every band.
    pub fn apply(&self, c: &[T]) -> Vec<T> {
        let mut out = vec![c[0]];
        for matrix in &self.0 {
            let l = matrix.l as usize;
            let band = &c[l * l..(l + 1) * (l + 1)];
            for row in matrix.entries.chunks_exact(2 * l + 1) {
                out.push(row.iter().zip(band).fold(T::ZERO, |sum, (a, b)| sum + *a * *b));
            }
        }
        out
    }
}

/// A function of β with its first and second derivative.
#[derive(Clone, Copy, Debug)]
struct Jet<T>([T; 3]);

impl<T: Number> Add for Jet<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<T: Number> Sub for Jet<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<T: Number> Neg for Jet<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<T: Number> Mul for Jet<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([a * d, a * e + b * d, a * f + (b * e + b * e) + c * d])
    }
}

impl<T: Number> Ring for Jet<T> {
    fn zero() -> Self {
        Self([T::ZERO; 3])
    }
    fn scale(self, factor: f64) -> Self {
        let factor = T::from_f64(factor);
        Self(self.0.map(|x| factor * x))
    }
}

/// The cosine and the sine of the angles that derivatives are taken at.
pub const ANGLES: [[f64; 2]; 2] = [[1.0, 0.0], [0.6, 0.8]];

/// The derivatives of the rotation about y by the derivative form, and how far they lie from the truth: A R and A A R,
/// R the rotation and A its derivative at zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Derivatives {
    /// The number type.
    pub number: String,
    /// Which of [`ANGLES`].
    pub angle: usize,
    /// The bands.
    pub bands: Vec<usize>,
    /// For each band the error of the zeroth, the first and the second derivative: the root of the sum of the squares of
    /// its entries' errors, over that of the truth's entries.
    pub errors: Vec<[f64; 3]>,
}

fn derivatives<T: Number>(number: &str, angle: usize, shown: &[usize]) -> Derivatives {
    let jet = |value: f64, slope: f64, bend: f64| Jet([value, slope, bend].map(T::from_f64));
    let zero = jet(0.0, 0.0, 0.0);
    let [c, s] = ANGLES[angle];
    let (cos, sin) = (jet(c, -s, -c), jet(s, c, -s));
    // Degrees −1, 0, 1 are y, z, x; β turns z to x.
    let entries = vec![jet(1.0, 0.0, 0.0), zero, zero, zero, cos, -sin, zero, sin, cos];
    let all = bands(Matrix { l: 1, entries }, shown.last().copied().unwrap_or(1));
    let still = [Twin::ONE, Twin::ZERO];
    let errors = shown.iter().map(|&l| {
        let size = 2 * l + 1;
        let below: Vec<f64> = degrees(l).map(|m| dy_sub_diag(l, m).to_f64()).collect();
        // The generator is antisymmetric and joins neighbours alone.
        let generate = |v: &[f64]| -> Vec<f64> {
            let from = |i: usize| if i == 0 { 0.0 } else { below[i] * v[i - 1] };
            (0..size).map(|i| from(i) - if i + 1 < size { below[i + 1] * v[i + 1] } else { 0.0 }).collect()
        };
        let rotation = Rotation::new([still, [c, s].map(Twin::from_f64), still], l);
        let swap = Swap::new(l);
        let mut sums = [[0.0f64; 2]; 3];
        for j in 0..size {
            let unit: Vec<Twin> = (0..size).map(|i| if i == j { Twin::ONE } else { Twin::ZERO }).collect();
            let column: Vec<f64> = rotation.apply(&swap, &unit).into_iter().map(Twin::to_f64).collect();
            let first = generate(&column);
            let second = generate(&first);
            for (k, want) in [column, first, second].iter().enumerate() {
                for (i, want) in want.iter().enumerate() {
                    let Jet(got) = all[l - 1].entries[i * size + j];
                    sums[k][0] += (got[k].to_f64() - want).powi(2);
                    sums[k][1] += want * want;
                }
            }
        }
        sums.map(|[error, size]| significant((error / size).sqrt()))
    });
    Derivatives { number: number.to_owned(), angle, bands: shown.to_vec(), errors: errors.collect() }
}

/// In f32 and in f64.
pub fn measure(progress: &dyn Progress, shown: &[usize]) -> Vec<Derivatives> {
    let tasks = [(false, 0), (false, 1), (true, 0), (true, 1)];
    each(progress, "derivatives", &tasks, |(wide, angle)| match wide {
        true => derivatives::<f64>("f64", *angle, shown),
        false => derivatives::<f32>("f32", *angle, shown),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::truth::{distance, norm};
    use zonal_codegen::promise::samples::Random;

    #[test]
    fn the_recursion_makes_rotations() {
        let mut random = Random::new(3);
        let q: [f64; 4] = random.unit();
        let exact = Rotation::of_quaternion(q, 6);
        let c: Vec<f64> = (0..49).map(|_| random.signed()).collect();
        let got = Matrices::<f64>::new(q, 6).apply(&c);
        for l in 1..=6 {
            let band = l * l..(l + 1) * (l + 1);
            let signal: Vec<Twin> = c[band.clone()].iter().map(|x| Twin::from_f64(*x)).collect();
            let want = exact.apply(&Swap::new(l), &signal);
            assert!(distance(&got[band], &want) < 1e-14, "band {l}");
            assert!(norm(want.iter().map(|x| x.to_f64())) > 0.1);
        }
    }

    #[test]
    fn the_derivative_form_makes_the_generator() {
        for angle in 0..ANGLES.len() {
            let found = derivatives::<f64>("f64", angle, &[1, 2, 5]);
            assert!(found.errors.iter().flatten().all(|error| *error < 1e-15), "{found:?}");
        }
    }
}
