//! How much of each band of a light a reflectance shows, in the mean over all normals and views.
//!
//! What is seen are the pixels of a sphere under the light: views weigh by the area that they see of the surface, which is
//! the cosine of their angle to the normal.

use crate::environment::harmonics::basis;
use crate::environment::spectrum::Weights;
use crate::math::fourier;
use crate::math::index::band;
use crate::math::quadrature::gauss_legendre;
use crate::reflectance::brdf::Brdf;
use crate::threads;
use std::f64::consts::PI;

/// Elevations, and azimuths of a quarter turn, of the views that a reflectance is averaged over.
const VIEWS: [usize; 2] = [8, 2];
/// The fewest elevations of the lights at which a reflectance is integrated.
const ELEVATIONS: usize = 96;
/// The fewest azimuths, a power of two.
const AZIMUTHS: usize = 512;

/// Views that stand for all of the hemisphere, each with its weight; the weights add up to one. A reflectance is its own
/// mirror image at both planes of its tangent, so that the azimuths of a quarter are enough, but for a tabulated one; one that
/// is the same all around needs a single one.
pub fn views(brdf: &Brdf) -> Vec<([f64; 3], f64)> {
    let (azimuths, turn) = match (brdf.is_isotropic(), brdf.is_mirrored()) {
        (true, _) => (1, 0.5 * PI),
        (false, true) => (VIEWS[1], 0.5 * PI),
        (false, false) => (4 * VIEWS[1], 2.0 * PI),
    };
    let mut views = Vec::new();
    for (cos, weight) in gauss_legendre(VIEWS[0], 0.0, 1.0) {
        let sin = (1.0 - cos * cos).sqrt();
        for i in 0..azimuths {
            let azimuth = turn * (i as f64 + 0.5) / azimuths as f64;
            views.push(([sin * azimuth.cos(), sin * azimuth.sin(), cos], 2.0 * cos * weight / azimuths as f64));
        }
    }
    views
}

/// How much of the first bands of a light a reflectance shows. Averaged over all frames of the surface, band l of what is
/// reflected has the energy |b_l|² |L_l|² / (2l + 1) (docs/MATH.md#the-order-that-a-budget-asks-for), so that the weight is
/// the mean of |b_l|² / (2l + 1) over the views, and over the channels where they differ.
pub fn weights(brdf: &Brdf, order: usize) -> Weights {
    if let Brdf::Lambert = brdf {
        // |b_l|² is (2l + 1) / 4π times the square of the cosine lobe over π.
        let irradiance = Weights::irradiance(order);
        let factor = 1.0 / (4.0 * PI * PI * PI);
        return Weights {
            of_band: irradiance.of_band.iter().map(|weight| factor * weight).collect(),
            most: factor * irradiance.most,
            rest: factor * irradiance.rest,
        };
    }
    let grid = Grid::new(order);
    let (mut of_band, mut rest) = (vec![0.0; order], 0.0);
    let channels = brdf.channels();
    let each = 1.0 / channels.len() as f64;
    let views = views(brdf);
    let tasks: Vec<_> =
        channels.iter().flat_map(|brdf| views.iter().map(move |&(view, share)| (brdf, view, share))).collect();
    for (found, share) in threads::map(tasks, |(brdf, view, share)| (grid.energies(brdf, view), each * share)) {
        let (bands, all) = found;
        for (l, (weight, energy)) in of_band.iter_mut().zip(&bands).enumerate() {
            *weight += share * energy / (2 * l + 1) as f64;
        }
        rest += share * (all - bands.iter().sum::<f64>()).max(0.0);
    }
    // Of a sum of terms that are not negative none is larger than the whole.
    Weights { of_band, most: rest / (2 * order + 1) as f64, rest }
}

/// Lights above a surface at which a function of them is integrated.
struct Grid {
    order: usize,
    /// The cosine of the angle to the normal, its sine and its weight, and the basis there at azimuth 0.
    rows: Vec<([f64; 2], f64, Vec<f64>)>,
    /// The cosine and the sine of each azimuth.
    azimuths: Vec<[f64; 2]>,
}

impl Grid {
    fn new(order: usize) -> Self {
        let count = AZIMUTHS.max((4 * order).next_power_of_two());
        let row = |(cos, weight): (f64, f64)| {
            let sin = (1.0 - cos * cos).sqrt();
            let mut values = vec![0.0; order * order];
            basis(order, [sin, 0.0, cos], &mut values);
            ([cos, sin], weight * 2.0 * PI / count as f64, values)
        };
        let azimuth = |i: usize| {
            let (sin, cos) = (2.0 * PI * i as f64 / count as f64).sin_cos();
            [cos, sin]
        };
        Self {
            order,
            rows: gauss_legendre(ELEVATIONS.max(order), 0.0, 1.0).map(row).collect(),
            azimuths: (0..count).map(azimuth).collect(),
        }
    }

    /// The energy of each band of [`Brdf::value`] as a function of the light, and that of all bands: the integral of its
    /// square.
    fn energies(&self, brdf: &Brdf, view: [f64; 3]) -> (Vec<f64>, f64) {
        let azimuths = self.azimuths.as_slice();
        let mut coefficients = vec![0.0; self.order * self.order];
        let mut all = 0.0;
        let mut waves = vec![[0.0; 2]; azimuths.len()];
        for ([cos, sin], weight, basis) in &self.rows {
            for i in 0..azimuths.len() {
                let value = brdf.value(view, [sin * azimuths[i][0], sin * azimuths[i][1], *cos]);
                waves[i] = [value, 0.0];
                all += weight * value * value;
            }
            fourier::transform(&mut waves);
            for m in 0..self.order {
                let [even, odd] = waves[m].map(|sum| weight * sum);
                for l in m..self.order {
                    let centre = l * (l + 1);
                    coefficients[centre + m] += basis[centre + m] * even;
                    if m > 0 {
                        coefficients[centre - m] += basis[centre + m] * odd;
                    }
                }
            }
        }
        let energy = |l: usize| coefficients[band(l)].iter().map(|x| x * x).sum();
        ((0..self.order).map(energy).collect(), all)
    }
}
