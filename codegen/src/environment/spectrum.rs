//! What is seen of a light, band by band: how much each band weighs in it, what energy it has there, and by how much every
//! order errs, at least and at most. It knows neither maps nor reflectances.
//!
//! What is seen is linear in the light, and each band of the light gives a band of it: the light itself is, in a mirror,
//! with a weight of 1; irradiance by the normal; reflected light by the normal and the view, in the mean over all of them
//! (docs/MATH.md#the-order-that-a-budget-asks-for).

use super::harmonics::cosine_lobe;
use std::f64::consts::PI;

/// Energies by band: of a light, or of what is seen of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The energy of each of the first bands.
    pub bands: Vec<f64>,
    /// At most the energy of all bands beyond.
    pub beyond: f64,
}

impl Spectrum {
    /// The energy of all bands, at most.
    pub fn energy(&self) -> f64 {
        self.bands.iter().sum::<f64>() + self.beyond
    }

    /// The relative rms error of each order, at most: entry n−1 is √(energy left out by order n / energy of all), from 0 to
    /// 1, for the orders 1 to the number of the bands. As far as `beyond` is known, this is the error itself.
    pub fn errors(&self) -> Vec<f64> {
        self.errors_if(self.beyond)
    }

    /// The relative rms error of each order, at least: that against the known bands.
    pub fn least_errors(&self) -> Vec<f64> {
        self.errors_if(0.0)
    }

    /// The relative rms errors of the orders 1 to `order` against that order.
    ///
    /// # Panics
    ///
    /// If there are fewer bands.
    pub fn errors_against(&self, order: usize) -> Vec<f64> {
        Self { bands: self.bands[..order].to_vec(), beyond: 0.0 }.errors()
    }

    fn errors_if(&self, beyond: f64) -> Vec<f64> {
        let mut left = beyond;
        let mut errors = vec![0.0; self.bands.len()];
        for (error, band) in errors.iter_mut().zip(&self.bands).rev() {
            *error = left;
            left += band;
        }
        let total = left;
        errors.iter_mut().for_each(|error| *error = if total > 0.0 { (*error / total).sqrt() } else { 0.0 });
        errors
    }
}

/// How much of the energy of each band of a light is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// The weight of each of the first bands.
    pub of_band: Vec<f64>,
    /// At least the weight of every band beyond.
    pub most: f64,
    /// At least the sum of (2l + 1) times the weight over the bands l beyond; infinite where there is no such bound.
    pub rest: f64,
}

impl Weights {
    /// The light itself, as a mirror shows it.
    pub fn mirror(order: usize) -> Self {
        Self { of_band: vec![1.0; order], most: 1.0, rest: f64::INFINITY }
    }

    /// Irradiance: the square of the [`cosine_lobe`].
    pub fn irradiance(order: usize) -> Self {
        let mut of_band: Vec<f64> = (0..order + 2).map(|l| cosine_lobe(l).powi(2)).collect();
        let most = of_band[order].max(of_band[order + 1]);
        of_band.truncate(order);
        // (2l+1) A_l² of all bands is 4π times the integral of the squared cosine lobe.
        let all = 8.0 * PI * PI / 3.0;
        let within: f64 = of_band.iter().enumerate().map(|(l, weight)| (2 * l + 1) as f64 * weight).sum();
        Self { of_band, most, rest: (all - within).max(0.0) }
    }

    /// What is seen of a light that is nowhere negative, of which as many bands are known and which falls into two parts in
    /// any of these ways.
    ///
    /// Beyond the bands, what is seen of a part is at most the largest weight there times the part's energy; and since a band
    /// l of what is nowhere negative holds at most 2l + 1 times the energy of band 0, it is at most `rest` times that. The
    /// first is close for what is spread out, the second for small lights.
    pub fn seen(&self, light: &Spectrum, ways: &[Parts]) -> Spectrum {
        let bands: Vec<f64> = self.of_band.iter().zip(&light.bands).map(|(weight, energy)| weight * energy).collect();
        let of_parts = |parts: &Parts| {
            // Amplitudes add up at most.
            let bright = if parts.uniform > 0.0 { (self.rest * parts.uniform).sqrt() } else { 0.0 };
            (bright + (self.most * parts.others).sqrt()).powi(2)
        };
        let beyond = ways.iter().map(of_parts).fold(self.most * light.beyond, f64::min);
        Spectrum { bands, beyond }
    }
}

/// A light in two parts: the bright texels, and the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// The energy of band 0 of the bright part.
    pub uniform: f64,
    /// The energy of the other part.
    pub others: f64,
}
