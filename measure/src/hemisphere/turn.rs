//! The matrices of rotations on the hemisphere (docs/MATH.md#rotation-on-the-hemisphere), numerically: C from spherical to
//! hemispherical harmonics, D a rotation about y, A its derivative, E the best extension below the horizon, the generators
//! B₀ = C A Cᵀ and B = C A E; and those of Gautron et al. 2004, section 4.

use super::bases::{HSH, SH};
use super::grid::{above, hemisphere};
use super::matrix::Matrix;
use zonal_codegen::math::index::{band_degree, degrees, index};
use zonal_codegen::math::tables::dy_sub_diag;

/// The spherical order behind generators and extensions.
pub const SPHERE: usize = 16;
/// The nodes, squared, by which digons are integrated.
const NODES: usize = 48;

/// C: `order`² rows, `sphere`² columns.
pub fn conversion(order: usize, sphere: usize) -> Matrix {
    // Only equal m meet, and those by polynomials in √z and √(1 + z): the azimuths need no more nodes than the rings.
    let nodes = hemisphere(40);
    let mut sums = vec![vec![0.0; sphere * sphere]; order * order];
    for (direction, weight) in &nodes {
        let (h, y) = (HSH.at(order, *direction), SH.at(sphere, *direction));
        for (i, (row, h)) in sums.iter_mut().zip(h).enumerate() {
            let (_, m) = band_degree(i);
            for l in m.unsigned_abs()..sphere {
                row[index(l, m)] += weight * h * y[index(l, m)];
            }
        }
    }
    Matrix::from_fn(order * order, sphere * sphere, |i, j| sums[i][j])
}

/// A, the derivative of a rotation about y at angle 0.
pub fn derivative(order: usize) -> Matrix {
    let below: Vec<f64> = (0..order).flat_map(|l| degrees(l).map(move |m| dy_sub_diag(l, m).to_f64())).collect();
    Matrix::from_fn(order * order, order * order, |i, j| match (band_degree(i), band_degree(j)) {
        ((l, _), (k, _)) if l != k => 0.0,
        _ if i == j + 1 => below[i],
        _ if j == i + 1 => -below[j],
        _ => 0.0,
    })
}

/// D, the rotation about y by `beta`: bands do not mix.
pub fn y_rotation(order: usize, beta: f64) -> Matrix {
    let derivative = derivative(order);
    let bands: Vec<Matrix> = (0..order)
        .map(|l| {
            let size = 2 * l + 1;
            let band = Matrix::from_fn(size, size, |i, j| derivative.at(l * l + i, l * l + j));
            band.mixed(beta, &band, 0.0).exp()
        })
        .collect();
    Matrix::from_fn(order * order, order * order, |i, j| {
        let l = i.isqrt();
        if l == j.isqrt() { bands[l].at(i - l * l, j - l * l) } else { 0.0 }
    })
}

/// E = S Cᵀ (C S Cᵀ + 10⁻³ 1)⁻¹ with S the powers (1 + l)^−1.6 of bands: the best extension of what is seen above the
/// horizon. `conversion` is C.
pub fn extension(conversion: &Matrix) -> Matrix {
    let power = |i: usize| (1.0 + i.isqrt() as f64).powf(-1.6);
    let back = Matrix::from_fn(conversion.columns(), conversion.rows(), |i, j| power(i) * conversion.at(j, i));
    let size = conversion.rows();
    back.over(&conversion.times(&back).mixed(1.0, &Matrix::identity(size), 1e-3))
}

/// The three shears of LF3 on a generator: even m by half the angle, odd m by the angle, even m again.
pub fn lf3(generator: &Matrix, beta: f64, signal: &[f64]) -> Vec<f64> {
    let mut h = signal.to_vec();
    for (parity, step) in [(0, 0.5 * beta), (1, beta), (0, 0.5 * beta)] {
        let added = generator.apply(&h);
        for (i, (h, added)) in h.iter_mut().zip(added).enumerate() {
            if band_degree(i).1.unsigned_abs() % 2 == parity {
                *h += step * added;
            }
        }
    }
    h
}

/// Gautron's equation 13: the angle on the sphere that the hemisphere is stretched to.
pub fn stretched(beta: f64) -> f64 {
    (2.0 * beta.cos() - 1.0).acos()
}

/// Gautron's equation 10, M(β): what of each function a turn about y leaves above the horizon.
pub fn without_digon(order: usize, beta: f64) -> Matrix {
    integrated(order, beta, |here, _| HSH.at(order, here))
}

/// Gautron's equation 14: digon and turn in one, the exact turn of what is zero below the horizon.
pub fn turned(order: usize, beta: f64) -> Matrix {
    integrated(order, beta, |_, there| HSH.at(order, there))
}

/// ∫ a(ω) H(ω)ᵀ over what a turn leaves above the horizon; functions of m < 0 are odd in y, the others even.
fn integrated(order: usize, beta: f64, a: impl Fn([f64; 3], [f64; 3]) -> Vec<f64>) -> Matrix {
    let count = order * order;
    let odd = |i: usize| band_degree(i).1 < 0;
    let parts = [false, true].map(|part| (0..count).filter(|i| odd(*i) == part).collect::<Vec<usize>>());
    let mut sums = parts.each_ref().map(|part| vec![0.0; part.len() * part.len()]);
    for (here, there, weight) in above(beta, NODES) {
        let (left, right) = (a(here, there), HSH.at(order, here));
        for (part, sums) in parts.iter().zip(&mut sums) {
            let right: Vec<f64> = part.iter().map(|j| weight * right[*j]).collect();
            for (i, row) in part.iter().zip(sums.chunks_mut(part.len())) {
                let factor = left[*i];
                row.iter_mut().zip(&right).for_each(|(sum, value)| *sum += factor * value);
            }
        }
    }
    let mut place = vec![0; count];
    parts.iter().for_each(|part| part.iter().enumerate().for_each(|(at, i)| place[*i] = at));
    Matrix::from_fn(count, count, |i, j| {
        let part = usize::from(odd(i));
        if odd(i) == odd(j) { sums[part][place[i] * parts[part].len() + place[j]] } else { 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hemisphere::grid::about_y;
    use crate::hemisphere::matrix::relative;

    #[test]
    fn a_rotation_moves_the_functions_as_it_moves_directions() {
        let (beta, direction) = (0.7, [0.48, -0.6, 0.64]);
        let moved = y_rotation(12, beta).apply(&SH.at(12, direction));
        assert!(relative(&moved, &SH.at(12, about_y(beta, direction))) < 1e-13);
    }

    #[test]
    fn the_conversion_is_that_of_the_documents() {
        let c = conversion(3, 3);
        let root = 2f64.sqrt();
        let first = (9.0f64 / 8.0).sqrt() * (11.0 / 12.0 * root - 0.75 * (1.0 + root).ln());
        for (i, j, wanted) in
            [(1, 1, first), (0, 0, 0.5f64.sqrt()), (0, 2, 6f64.sqrt() / 4.0), (2, 2, 8f64.sqrt().recip()), (2, 0, 0.0)]
        {
            assert!((c.at(i, j) - wanted).abs() < 1e-13, "{i}, {j}: {}", c.at(i, j));
        }
        // Their printed matrix is not this one.
        assert!((c.at(5, 1) + 0.1578).abs() < 5e-5 && (c.at(6, 6) - 0.1768).abs() < 5e-5);
    }

    #[test]
    fn what_a_turn_leaves_is_all_at_angle_zero_and_as_the_sphere_says() {
        let one = Matrix::identity(25);
        let rows = |m: &Matrix| (0..25).flat_map(|i| m.row(i).to_vec()).collect::<Vec<f64>>();
        assert!(relative(&rows(&without_digon(5, 0.0)), &rows(&one)) < 1e-12);
        assert!(relative(&rows(&turned(5, 0.0)), &rows(&one)) < 1e-12);
        // By way of ever more bands of the sphere; they converge slowly, for the function has an edge.
        let error = |sphere: usize| {
            let c = conversion(5, sphere);
            let way = c.times(&y_rotation(sphere, 0.4)).times(&c.transposed());
            relative(&rows(&way), &rows(&turned(5, 0.4)))
        };
        let (near, far) = (error(12), error(24));
        assert!(far < 0.03 && far < 0.75 * near, "{near}, {far}");
    }
}
