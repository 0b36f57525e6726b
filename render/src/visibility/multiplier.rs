//! The light of a map as what multiplies a function of an order: the matrix M_ik = ∫ E y_i y_k, for which all bands of the light
//! to 2n − 2 matter (docs/MATH.md#visibility).

use rayon::prelude::*;
use std::f64::consts::PI;
use zonal_codegen::environment::Projection;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::math::quadrature::gauss_legendre;

/// Three symmetric matrices, of R, G and B.
#[derive(Clone, Debug)]
pub struct Multiplier {
    /// The order of what is multiplied.
    pub order: usize,
    rows: Vec<[Vec<f64>; 3]>,
}

/// A rule that integrates harmonics over the sphere exactly, up to a degree.
pub struct Grid {
    /// Directions.
    pub directions: Vec<[f64; 3]>,
    /// Their solid angles.
    pub weights: Vec<f64>,
}

impl Grid {
    /// Returns the rule of a degree: Gauss nodes in z, evenly spread azimuths.
    pub fn of_degree(degree: usize) -> Self {
        let azimuths = degree + 1;
        let mut grid = Self { directions: vec![], weights: vec![] };
        for (z, weight) in gauss_legendre(degree / 2 + 1, -1.0, 1.0) {
            let radius = (1.0 - z * z).sqrt();
            for i in 0..azimuths {
                let (sin, cos) = (2.0 * PI * i as f64 / azimuths as f64).sin_cos();
                grid.directions.push([radius * cos, radius * sin, z]);
                grid.weights.push(weight * 2.0 * PI / azimuths as f64);
            }
        }
        grid
    }

    /// Returns the harmonics of an order in every direction, one row a direction.
    pub fn harmonics(&self, order: usize) -> Vec<Vec<f64>> {
        let row = |direction: &[f64; 3]| {
            let mut values = vec![0.0; order * order];
            basis(order, *direction, &mut values);
            values
        };
        self.directions.iter().map(row).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Multiplier {
    /// Returns the matrices of a light, of which the bands below 2n − 1 count; bands that it does not have are none.
    pub fn new(light: &Projection, order: usize) -> Self {
        let bands = light.order.min(2 * order - 1);
        // Two harmonics below n, and the light below 2n − 1.
        let grid = Grid::of_degree(4 * (order - 1));
        let harmonics = grid.harmonics(bands.max(order));
        let shine = |k: usize| -> Vec<f64> {
            let e: Vec<f64> = light.coefficients[..bands * bands].iter().map(|c| c[k]).collect();
            harmonics.iter().zip(&grid.weights).map(|(y, weight)| weight * dot(&e, y)).collect()
        };
        let light = [0, 1, 2].map(shine);
        let row = |i: usize| {
            let mut rows = [0, 1, 2].map(|_| vec![0.0; i + 1]);
            for (at, y) in harmonics.iter().enumerate() {
                for (row, light) in rows.iter_mut().zip(&light) {
                    let factor = light[at] * y[i];
                    row.iter_mut().zip(y).for_each(|(sum, y)| *sum += factor * y);
                }
            }
            rows
        };
        let mut rows: Vec<[Vec<f64>; 3]> = (0..order * order).into_par_iter().map(row).collect();
        // What is above the diagonal is what is below.
        for i in 0..rows.len() {
            let above: Vec<[f64; 3]> = rows[i + 1..].iter().map(|rows| rows.each_ref().map(|row| row[i])).collect();
            (0..3).for_each(|k| rows[i][k].extend(above.iter().map(|of| of[k])));
        }
        Self { order, rows }
    }

    /// Returns the product of the light with a function of an order up to the matrices', cut off at that order.
    ///
    /// # Panics
    ///
    /// If the function has more bands.
    pub fn product(&self, v: &[f64]) -> Vec<[f64; 3]> {
        self.rows[..v.len()].iter().map(|rows| rows.each_ref().map(|row| dot(&row[..v.len()], v))).collect()
    }

    /// Returns a column of a channel's matrix: y_i times the light, cut off at the order.
    pub fn column(&self, i: usize, channel: usize) -> Vec<f64> {
        self.rows[i][channel].clone()
    }
}
