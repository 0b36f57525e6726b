//! The error of an approximate rotation over the angle, as Figure 3 of Křivánek et al. 2005 has it: D(β) is the
//! difference of the approximate and the exact matrix, its largest singular value the largest error of any signal of
//! norm one, the mean of its n² singular values what the paper calls the average error, their root mean square the rms
//! error of a random signal, and |D L| / |L| the error of a lobe L.

use crate::methods::{METHODS, Method};
use crate::stability::truth::norm;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::families::Spec;
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::linear::singular_values;
use zonal_codegen::math::tables::{basis_factor, legendre_polynomial};
use zonal_codegen::promise::accuracy::Difference;

/// The measures of an error, by the index that reports use.
pub const NORMS: [&str; 5] = ["max", "mean singular value", "rms", "lobe cos⁵", "lobe cos²⁰"];
/// The place of the largest error in [`NORMS`].
pub const MAX: usize = 0;
/// The place of the mean singular value in [`NORMS`].
pub const MEAN: usize = 1;
/// The place of the rms error in [`NORMS`].
pub const RMS: usize = 2;
/// The place of the lobe cos⁵ in [`NORMS`].
pub const LOBE: usize = 3;
/// The errors whose angle is sought.
pub const LEVELS: [f64; 4] = [1e-4, 1e-3, 1e-2, 1e-1];
/// The angles in degrees that tables show.
pub const SHOWN: [f64; 5] = [5.0, 10.0, 15.0, 25.0, 45.0];
/// The smallest and the largest angle in degrees.
pub const RANGE: [f64; 2] = [0.1, 45.0];
const STEPS: usize = 64;
/// Where the search for a crossing below the grid begins.
const SMALLEST: f64 = 1e-3;

/// The errors of one method at one order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// The method's name.
    pub method: String,
    /// The order.
    pub order: usize,
    /// For each of [`NORMS`] the error at each angle of the grid.
    pub errors: [Vec<f64>; 5],
    /// For each of [`NORMS`] the angle in degrees at which the error first reaches each of [`LEVELS`], if it does.
    pub reaches: [[Option<f64>; 4]; 5],
    /// For each of [`NORMS`] the error at each angle of [`SHOWN`].
    pub shown: [[f64; 5]; 5],
}

/// The angles of the grid in degrees, evenly spaced in their logarithm.
pub fn grid() -> Vec<f64> {
    let ratio = RANGE[1] / RANGE[0];
    (0..=STEPS).map(|i| significant(RANGE[0] * ratio.powf(i as f64 / STEPS as f64))).collect()
}

/// The coefficients m = 0 of the clamped lobe max(0, z)^s, all scaled alike: K_l ∫ z^s P_l dz over [0, 1].
pub fn lobe(exponent: i64, order: usize) -> Vec<f64> {
    (0..order)
        .map(|l| {
            let terms = legendre_polynomial(l, 0).into_iter().zip(1..);
            let integral: Exact = terms.map(|(c, k)| c / Exact::int(exponent + k)).sum();
            (basis_factor(l, 0) * integral).to_f64()
        })
        .collect()
}

/// A method's kernel against the exact rotation, ready to run.
pub struct Comparison {
    order: usize,
    difference: Difference,
    lobes: [Vec<f64>; 2],
}

impl Comparison {
    /// Of a spec's kernel.
    pub fn new(spec: &Spec) -> Self {
        let order = spec.order;
        Self { order, difference: Difference::new(spec), lobes: [5, 20].map(|exponent| lobe(exponent, order)) }
    }

    fn lobe_error(&self, angle: f64, lobe: &[f64]) -> f64 {
        let mut signal = vec![0.0; self.order * self.order];
        lobe.iter().enumerate().for_each(|(l, c)| signal[l * (l + 1)] = *c);
        norm(self.difference.of(angle, &signal)) / norm(signal)
    }

    /// The error in each of [`NORMS`] at an angle in radians.
    pub fn errors(&self, angle: f64) -> [f64; 5] {
        let values: Vec<f64> = self.difference.bands(angle).iter().flat_map(|band| singular_values(band)).collect();
        let count = values.len() as f64;
        let [five, twenty] = [0, 1].map(|i| self.lobe_error(angle, &self.lobes[i]));
        [
            values.iter().copied().fold(0.0, f64::max),
            values.iter().sum::<f64>() / count,
            (values.iter().map(|x| x * x).sum::<f64>() / count).sqrt(),
            five,
            twenty,
        ]
    }

    /// The angle in degrees at which an error first reaches a level, by bisection between two angles of the grid.
    fn crossing(&self, norm: usize, level: f64, grid: &[f64], errors: &[f64]) -> Option<f64> {
        let place = errors.iter().position(|error| *error >= level)?;
        let (mut low, mut high) = (if place == 0 { SMALLEST } else { grid[place - 1] }, grid[place]);
        while high / low > 1.00005 {
            let middle = (low * high).sqrt();
            match self.errors(middle.to_radians())[norm] >= level {
                true => high = middle,
                false => low = middle,
            }
        }
        Some(significant(high))
    }

    /// The whole curve.
    pub fn curve(&self, method: &Method) -> Curve {
        let grid = grid();
        let at: Vec<[f64; 5]> = grid.iter().map(|degrees| self.errors(degrees.to_radians())).collect();
        let errors: [Vec<f64>; 5] = std::array::from_fn(|norm| at.iter().map(|all| all[norm]).collect());
        let reaches = std::array::from_fn(|norm| LEVELS.map(|level| self.crossing(norm, level, &grid, &errors[norm])));
        let shown = SHOWN.map(|degrees| self.errors(degrees.to_radians()));
        Curve {
            method: method.name.to_owned(),
            order: self.order,
            errors: errors.map(|list| list.into_iter().map(significant).collect()),
            reaches,
            shown: std::array::from_fn(|norm| shown.map(|all| significant(all[norm]))),
        }
    }
}

/// Every method at every order for which it is no exact rotation.
pub fn measure(progress: &dyn Progress) -> Vec<Curve> {
    let at = |order: usize| METHODS.iter().filter(move |method| order >= method.first_order).map(move |m| (order, m));
    let tasks: Vec<(usize, &Method)> = ORDERS.flat_map(at).collect();
    each(progress, "errors over the angle", &tasks, |(order, method)| {
        Comparison::new(&method.spec(*order)).curve(method)
    })
}
