//! Tables of pairs of directions, the view and the light, for surfaces that need not be isotropic. Directions are a grid over
//! the hemisphere: E elevations from the normal, 0°, to the horizon, 90°, both included, and A azimuths from x towards y, the
//! first at 0°. The grids of views and of lights are the first and the last two sides of an array in NumPy's format,
//!
//! * (E_v, A_v, E_l, A_l), grey, or (E_v, A_v, E_l, A_l, 3) for R, G and B. A_v = 1 says that the surface is isotropic: then
//!   azimuths of the light are told from that of the view;
//!
//! or both are one grid with the same step in both angles, A = 4 (E − 1), and lie in an OpenEXR image of (E A)² texels:
//! direction (e, a) of the light is column e A + a, that of the view is row e A + a. So E = 10 gives an image of 360², 16 one of
//! 960², 24 one of 2208². R, G and B are the channels, or Y alone.

use crate::environment::MapError;
use crate::environment::harmonics::{basis, turn_about_z};
use crate::fault::Fault;
use crate::math::quadrature::gauss_legendre;
use crate::reflectance::measured::entries::{Missing, between, checked, filled, refused};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The most elevations or azimuths that a grid has.
const MAX_SIDE: usize = 1024;
/// The most elevations of an image: its side is 4224 then.
const MAX_ELEVATIONS: usize = 33;
/// What an image has to be.
const IMAGE: &str =
    "write an image of E A by E A texels with A = 4 (E - 1), as 360 for 10 elevations or 960 for 16, 33 at most";
/// What an array has to be.
const ARRAY: &str = "write the shape (E_v, A_v, E_l, A_l) or (E_v, A_v, E_l, A_l, 3): 2 to 1024 elevations, 3 to 1024 azimuths, \
                     or 1 azimuth of an isotropic view";

/// A grid of directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// The elevations, from the normal to the horizon, both included.
    pub elevations: usize,
    /// The azimuths, from x towards y.
    pub azimuths: usize,
}

/// The table.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairs {
    views: Grid,
    lights: Grid,
    entries: Vec<[f32; 3]>,
}

impl Grid {
    /// The grid of an image with so many elevations.
    pub fn even(elevations: usize) -> Self {
        Self { elevations, azimuths: 4 * (elevations - 1) }
    }

    /// How many directions it has.
    pub fn count(self) -> usize {
        self.elevations * self.azimuths
    }

    /// Returns a direction by its place, elevation · azimuths + azimuth, as a unit vector.
    pub fn direction(self, place: usize) -> [f64; 3] {
        let (e, a) = (place / self.azimuths, place % self.azimuths);
        let (sin, cos) = (FRAC_PI_2 * e as f64 / (self.elevations - 1) as f64).sin_cos();
        let (y, x) = (TAU * a as f64 / self.azimuths as f64).sin_cos();
        [sin * x, sin * y, cos]
    }

    /// The four directions around one, each by its place with its share.
    fn around(self, direction: [f64; 3], azimuth: f64) -> [(usize, f64); 4] {
        let angle = direction[0].hypot(direction[1]).atan2(direction[2]);
        let (e, down) = between(angle / FRAC_PI_2 * (self.elevations - 1) as f64, self.elevations - 1);
        let (a, along) = between((azimuth / TAU).rem_euclid(1.0) * self.azimuths as f64, self.azimuths);
        let a = a % self.azimuths;
        let next = (a + 1) % self.azimuths;
        let place = |e: usize, a: usize| e * self.azimuths + a;
        [
            (place(e, a), (1.0 - down) * (1.0 - along)),
            (place(e, next), (1.0 - down) * along),
            (place(e + 1, a), down * (1.0 - along)),
            (place(e + 1, next), down * along),
        ]
    }
}

/// The elevations of an image, by its side.
fn elevations_of(side: usize) -> Option<usize> {
    (2..=MAX_ELEVATIONS).find(|&e| Grid::even(e).count() == side)
}

/// Refuses an image of another size.
pub(super) fn check_image(name: &str, width: usize, height: usize) -> Result<(), MapError> {
    match width == height && elevations_of(width).is_some() {
        true => Ok(()),
        false => Err(MapError::refused(
            name,
            format!("an image of {width} by {height} texels is no table of pairs of directions"),
            IMAGE,
        )),
    }
}

impl Pairs {
    pub(super) fn of_image(name: &str, width: usize, texels: &[[f64; 3]]) -> Result<(Self, Missing), Fault> {
        let unknown = || refused(name, "the image is no table of pairs of directions", IMAGE);
        let grid = Grid::even(elevations_of(width).ok_or_else(unknown)?);
        if texels.len() != width * width {
            return Err(unknown());
        }
        let place = |at: usize| format!("view {}, light {}", at / width, at % width);
        Ok(Self { views: grid, lights: grid, entries: checked(name, place, texels)? }.completed())
    }

    pub(super) fn of_array(name: &str, shape: &[usize], values: &[f64]) -> Result<(Self, Missing), Fault> {
        let unknown =
            || refused(name, format!("an array of the shape {shape:?} is no table of pairs of directions"), ARRAY);
        let (sides, channels) = match *shape {
            [a, b, c, d] => ([a, b, c, d], 1),
            [a, b, c, d, channels @ (1 | 3)] => ([a, b, c, d], channels),
            _ => return Err(unknown()),
        };
        let [elevations, azimuths, light_elevations, light_azimuths] = sides;
        let is_elevations = |count| (2..=MAX_SIDE).contains(&count);
        let is_azimuths = |count| (3..=MAX_SIDE).contains(&count);
        let fits = is_elevations(elevations)
            && (azimuths == 1 || is_azimuths(azimuths))
            && is_elevations(light_elevations)
            && is_azimuths(light_azimuths);
        let views = Grid { elevations, azimuths };
        let lights = Grid { elevations: light_elevations, azimuths: light_azimuths };
        if !fits || values.len() != views.count() * lights.count() * channels {
            return Err(unknown());
        }
        let rgb = |entry: &[f64]| if let [r, g, b] = *entry { [r, g, b] } else { [entry[0]; 3] };
        let values: Vec<[f64; 3]> = values.chunks_exact(channels).map(rgb).collect();
        let place = |at: usize| format!("view {}, light {}", at / lights.count(), at % lights.count());
        Ok(Self { views, lights, entries: checked(name, place, &values)? }.completed())
    }

    /// Fills what is missing along the lights' elevations; what is isotropic becomes its own mirror image.
    fn completed(mut self) -> (Self, Missing) {
        let Grid { elevations, azimuths } = self.lights;
        let mut missing = Missing::default();
        let mut line = vec![[0.0; 3]; elevations];
        for (view, slice) in self.entries.chunks_exact_mut(elevations * azimuths).enumerate() {
            // Neither light nor view at the horizon counts as above it.
            let is_view_above = view / self.views.azimuths + 1 < self.views.elevations;
            for a in 0..azimuths {
                (0..elevations).for_each(|e| line[e] = slice[e * azimuths + a]);
                let above = if is_view_above { &line[..elevations - 1] } else { &[] };
                let lack = above.iter().filter(|value| value.iter().any(|x| *x < 0.0)).count();
                missing.of += above.len();
                missing.filled += lack;
                if filled(&mut line) {
                    missing.black += lack;
                }
                (0..elevations).for_each(|e| slice[e * azimuths + a] = line[e]);
            }
        }
        if self.is_isotropic() {
            for row in self.entries.chunks_exact_mut(azimuths) {
                for a in 1..azimuths.div_ceil(2) {
                    let mean = [0, 1, 2].map(|c| 0.5 * (row[a][c] + row[azimuths - a][c]));
                    (row[a], row[azimuths - a]) = (mean, mean);
                }
            }
        }
        (self, missing)
    }

    pub(super) fn entries(&self) -> &[[f32; 3]] {
        &self.entries
    }

    pub(super) fn is_isotropic(&self) -> bool {
        self.views.azimuths == 1
    }

    pub(super) fn views(&self) -> [usize; 2] {
        [self.views.elevations, self.views.azimuths]
    }

    pub(super) fn told(&self) -> String {
        let grid = |Grid { elevations, azimuths }: Grid| format!("{elevations} × {azimuths}");
        let kind = if self.is_isotropic() { "isotropic" } else { "anisotropic" };
        format!("pairs of {} views and {} lights, {kind}", grid(self.views), grid(self.lights))
    }

    /// What an isotropic table turns by to have the view at azimuth 0.
    fn turn(&self, view: [f64; 3]) -> f64 {
        if self.is_isotropic() { view[1].atan2(view[0]) } else { 0.0 }
    }

    pub(super) fn at(&self, view: [f64; 3], light: [f64; 3]) -> [f64; 3] {
        let azimuth = |v: [f64; 3]| v[1].atan2(v[0]);
        let lights = self.lights.around(light, azimuth(light) - self.turn(view));
        let mut sum = [0.0; 3];
        for (v, a) in self.views.around(view, azimuth(view)) {
            for (l, b) in lights {
                let entry = self.entries[v * self.lights.count() + l];
                (0..3).for_each(|c| sum[c] += a * b * f64::from(entry[c]));
            }
        }
        sum
    }

    /// The table is linear between its entries: around a row by its Fourier sums, each times sinc² of half a step, which is
    /// exact; across the rows by a rule of Gauss for each step.
    pub(super) fn coefficients(&self, view: [f64; 3], order: usize, shown: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        let Grid { elevations, azimuths } = self.lights;
        let view = [view[0], view[1], view[2].max(0.0)];
        let around = self.views.around(view, view[1].atan2(view[0]));
        let step = TAU / azimuths as f64;
        let value = |at: usize| {
            let entry = |v: usize| self.entries[v * self.lights.count() + at].map(f64::from);
            around.iter().map(|&(v, share)| share * shown(entry(v))).sum::<f64>()
        };
        let waves: Vec<[f64; 2]> = (0..azimuths).map(|a| <[f64; 2]>::from((step * a as f64).sin_cos())).collect();
        // For each elevation and m the integrals of the row times cos mφ and sin mφ.
        let amplitudes: Vec<Vec<[f64; 2]>> = (0..elevations)
            .map(|e| {
                let row: Vec<f64> = (0..azimuths).map(|a| value(e * azimuths + a)).collect();
                (0..order)
                    .map(|m| {
                        let half = 0.5 * m as f64 * step;
                        let sinc = if m == 0 { 1.0 } else { half.sin() / half };
                        let mut sums = [0.0; 2];
                        for (a, value) in row.iter().enumerate() {
                            let [sin, cos] = waves[m * a % azimuths];
                            sums[0] += value * cos;
                            sums[1] += value * sin;
                        }
                        sums.map(|sum| sum * step * sinc * sinc)
                    })
                    .collect()
            })
            .collect();
        let mut sums = vec![0.0; order * order];
        let mut values = vec![0.0; order * order];
        let width = FRAC_PI_2 / (elevations - 1) as f64;
        for e in 0..elevations - 1 {
            for (share, weight) in gauss_legendre(4 + 2 * order / (elevations - 1), 0.0, 1.0) {
                let (sin, cos) = (width * (e as f64 + share)).sin_cos();
                basis(order, [sin, 0.0, cos], &mut values);
                let weight = weight * width * sin * cos;
                for m in 0..order {
                    let [even, odd] = [0, 1].map(|part| {
                        weight * ((1.0 - share) * amplitudes[e][m][part] + share * amplitudes[e + 1][m][part])
                    });
                    for l in m..order {
                        let centre = l * (l + 1);
                        sums[centre + m] += values[centre + m] * even;
                        if m > 0 {
                            sums[centre - m] += values[centre + m] * odd;
                        }
                    }
                }
            }
        }
        turn_about_z(order, self.turn(view), &mut sums);
        sums
    }
}
