//! A map projected on spherical harmonics in f64, as it stands in memory or as it is read, and what each order leaves
//! out.

use super::cube;
use super::error::MapError;
use super::harmonics::{basis, cosine_lobe};
use super::lamps::{Lamps, Octaves};
use super::layout::{Expected, Layout};
use super::loaded::{self, Format, Loaded};
use super::map::{Map, solid_angle};
use super::radiance::{Radiance, Row};
use super::spectrum::{Parts, Spectrum, Weights};
use super::waves::{Waves, dot};
use crate::math::quadrature::gauss_legendre_5;
use crate::threads;
use std::f64::consts::PI;
use std::path::Path;

/// How many rows are summed before they are added to the others.
const BAND: usize = 16;

/// A function on the sphere, one for each of R, G and B, as the coefficients of its first bands.
///
/// *Order n* is bands 0 to n−1, n² coefficients, at index l(l+1)+m. The basis is real and orthonormal with the
/// Condon-Shortley phase: band 1 is √(3/4π)·(−y, z, −x).
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// The number of bands.
    pub order: usize,
    /// `order * order` coefficients, each for R, G and B: of radiance, or of irradiance in the same unit times
    /// steradians.
    pub coefficients: Vec<[f64; 3]>,
    /// The energy (as [`Projection::band_energy`] counts it) of the bands from `order` on. What [`Map::project`]
    /// gives is exact but for rounding, about 1e-15 of the whole; what [`Projection::irradiance`] gives is an upper
    /// bound.
    pub beyond: f64,
}

/// What a map is found to be when it is projected.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Its first bands.
    pub projection: Projection,
    /// The numbers of its columns and rows.
    pub size: [usize; 2],
    /// Its brightest texels.
    pub lamps: Lamps,
    /// Its bright texels and the others, in many ways.
    pub parts: Vec<Parts>,
}

/// What projects rows of a size.
struct Projector {
    order: usize,
    width: usize,
    height: usize,
    waves: Waves,
    /// The cosine and the sine of the azimuth of each column.
    azimuths: Vec<[f64; 2]>,
    /// √((4l² − 1) / (l² − m²)) for the degrees l above m, by m.
    ratios: Vec<Vec<f64>>,
}

/// Coefficients, energy and texels of some rows.
struct Part {
    coefficients: Vec<[f64; 3]>,
    energy: f64,
    octaves: Octaves,
}

impl Projector {
    fn new(order: usize, width: usize, height: usize) -> Self {
        let ratio = |l: usize, m: usize| ((4 * l * l - 1) as f64 / (l * l - m * m) as f64).sqrt();
        let ratios = (0..order).map(|m| (m + 1..order).map(|l| ratio(l, m)).collect()).collect();
        let azimuth = |x: usize| {
            let (sin, cos) = (PI - 2.0 * PI * (x as f64 + 0.5) / width as f64).sin_cos();
            [cos, sin]
        };
        let azimuths = (0..width).map(azimuth).collect();
        Self { order, width, height, waves: Waves::new(order, width), azimuths, ratios }
    }

    fn nothing(&self) -> Part {
        Part { coefficients: vec![[0.0; 3]; self.order * self.order], energy: 0.0, octaves: Octaves::new() }
    }

    /// The rows from `first` on, each of which `read` writes over three planes.
    fn part<R>(&self, first: usize, rows: &[R], read: impl Fn(&R, [&mut [f64]; 3])) -> Part {
        let mut part = self.nothing();
        let mut planes: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; self.width]);
        for (y, row) in (first..).zip(rows) {
            read(row, planes.each_mut().map(Vec::as_mut_slice));
            let squares: f64 = planes.iter().map(|plane| dot(plane, plane)).sum();
            part.energy += solid_angle(self.width, self.height, y) * squares;
            self.count(y, planes.each_ref().map(Vec::as_slice), &mut part.octaves);
            let zonal = self.zonal(y);
            for (channel, plane) in planes.iter().enumerate() {
                self.add(&zonal, &self.waves.integrals(plane), channel, &mut part.coefficients);
            }
        }
        part
    }

    /// Counts the texels of a row.
    fn count(&self, y: usize, [red, green, blue]: [&[f64]; 3], octaves: &mut Octaves) {
        let solid_angle = solid_angle(self.width, self.height, y);
        let (sin, cos) = (PI * (y as f64 + 0.5) / self.height as f64).sin_cos();
        let azimuths = self.azimuths.as_slice();
        let mut x = 0;
        while x < azimuths.len() {
            octaves.add([red[x], green[x], blue[x]], solid_angle, [sin * azimuths[x][0], sin * azimuths[x][1], cos]);
            x += 1;
        }
    }

    /// Adds the products of what was integrated over the polar angle and over the azimuth.
    fn add(&self, zonal: &[f64], integrals: &[[f64; 2]], channel: usize, sums: &mut [[f64; 3]]) {
        let mut place = 0;
        for (m, [cos, sin]) in integrals.iter().enumerate() {
            let mut l = m;
            while l < self.order {
                let centre = l * (l + 1);
                sums[centre + m][channel] += zonal[place] * cos;
                if m > 0 {
                    sums[centre - m][channel] += zonal[place] * sin;
                }
                (place, l) = (place + 1, l + 1);
            }
        }
    }

    /// For each m, for each l from m on, the basis at azimuth 0 integrated over the polar angle θ of row `y` with weight
    /// sin θ: by Gauss-Legendre quadrature of five nodes in steps over which no harmonic turns by more than π/4, good to
    /// rounding.
    fn zonal(&self, y: usize) -> Vec<f64> {
        let steps = (4 * self.order).div_ceil(self.height).max(1);
        let step = PI / (self.height * steps) as f64;
        let mut sums = vec![0.0; self.order * (self.order + 1) / 2];
        for i in y * steps..(y + 1) * steps {
            for (node, weight) in gauss_legendre_5() {
                let (sin, cos) = (step * (i as f64 + 0.5 + 0.5 * node)).sin_cos();
                self.add_legendre(sin, cos, 0.5 * step * weight * sin, &mut sums);
            }
        }
        sums
    }

    /// Adds the basis at azimuth 0, times a weight.
    fn add_legendre(&self, sin: f64, cos: f64, weight: f64, sums: &mut [f64]) {
        let (mut sectoral, mut place) = (0.5 / PI.sqrt(), 0);
        for (m, ratios) in self.ratios.iter().enumerate() {
            if m > 0 {
                let factor = if m == 1 { 3.0 } else { (2 * m + 1) as f64 / (2 * m) as f64 };
                sectoral *= -factor.sqrt() * sin;
            }
            let (mut before, mut value, mut last) = (0.0, sectoral, 1.0);
            sums[place] += weight * value;
            for &ratio in ratios {
                place += 1;
                (before, value) = (value, ratio * (cos * value - before / last));
                sums[place] += weight * value;
                last = ratio;
            }
            place += 1;
        }
    }

    fn whole(&self, parts: impl IntoIterator<Item = Part>) -> Survey {
        let mut whole = self.nothing();
        for part in parts {
            for (sum, coefficient) in whole.coefficients.iter_mut().zip(part.coefficients) {
                (0..3).for_each(|channel| sum[channel] += coefficient[channel]);
            }
            whole.energy += part.energy;
            whole.octaves.join(&part.octaves);
        }
        let mut projection = Projection { order: self.order, coefficients: whole.coefficients, beyond: 0.0 };
        projection.beyond = (whole.energy - projection.energy()).max(0.0);
        whole.octaves.survey(projection, [self.width, self.height])
    }
}

impl Octaves {
    fn survey(&self, projection: Projection, size: [usize; 2]) -> Survey {
        Survey { projection, size, lamps: self.brightest(), parts: self.parts() }
    }
}

impl Map {
    /// The radiance projected on the first `order` bands: the coefficients, and the energy that they leave out.
    ///
    /// The time of a latitude-longitude map grows as the number of texels times `order`; that of a cubemap as the number of
    /// texels, and as the fourth power of `order`. Coefficients of a cubemap are good to 1e-9 of the norm of them all.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and has fewer texels than its size says; see [`Map::checked`].
    pub fn project(&self, order: usize) -> Projection {
        self.survey(order).projection
    }

    /// [`Map::project`], with the brightest texels of the map.
    ///
    /// # Panics
    ///
    /// As [`Map::project`].
    pub fn survey(&self, order: usize) -> Survey {
        if self.is_cube() {
            let coefficients = cube::project(self.width, &self.texels, order);
            let mut projection = Projection { order, coefficients, beyond: 0.0 };
            projection.beyond = (self.energy() - projection.energy()).max(0.0);
            let mut octaves = Octaves::new();
            for (i, &texel) in self.texels.iter().enumerate() {
                let (x, y) = (i % self.width, i / self.width);
                octaves.add(texel, self.solid_angle(x, y), self.direction(x, y));
            }
            return octaves.survey(projection, [self.width, self.height]);
        }
        let projector = Projector::new(order, self.width, self.height);
        let read = |row: &&[[f64; 3]], [red, green, blue]: [&mut [f64]; 3]| {
            let mut x = 0;
            while x < row.len() {
                (red[x], green[x], blue[x]) = (row[x][0], row[x][1], row[x][2]);
                x += 1;
            }
        };
        let part = |first: usize| {
            let rows: Vec<_> =
                (first..self.height.min(first + BAND)).map(|y| &self.texels[y * self.width..][..self.width]).collect();
            projector.part(first, &rows, read)
        };
        projector.whole(threads::map((0..self.height).step_by(BAND), part))
    }
}

impl Projection {
    /// [`Projection::from_bytes`] of a file, or of six that hold the faces of a cube, as [`Map::read`] takes them.
    ///
    /// # Errors
    ///
    /// As [`Map::read`].
    pub fn read(path: &Path, order: usize) -> Result<(Self, [usize; 2]), MapError> {
        Survey::read(path, order).map(|survey| (survey.projection, survey.size))
    }

    /// The projection of the map that a file holds, with the image's numbers of columns and rows: as [`Map::from_bytes`] and
    /// [`Map::project`] give it, but a latitude-longitude map in Radiance HDR is projected while it is read and never stands
    /// in memory.
    ///
    /// # Errors
    ///
    /// As [`Map::from_bytes`].
    pub fn from_bytes(name: &str, bytes: &[u8], order: usize) -> Result<(Self, [usize; 2]), MapError> {
        Survey::from_bytes(name, bytes, order).map(|survey| (survey.projection, survey.size))
    }

    /// The energy of each band: the sum of the squares of its coefficients over m and over R, G and B. By Parseval's
    /// identity this is the integral over the sphere of the square of what the band adds.
    pub fn band_energy(&self) -> Vec<f64> {
        let band = |l: usize| &self.coefficients[l * l..(l + 1) * (l + 1)];
        (0..self.order).map(|l| band(l).iter().flatten().map(|c| c * c).sum()).collect()
    }

    /// The energy of each band and of those beyond.
    pub fn spectrum(&self) -> Spectrum {
        Spectrum { bands: self.band_energy(), beyond: self.beyond }
    }

    /// The energy of all bands, those beyond the projection included.
    pub fn energy(&self) -> f64 {
        self.spectrum().energy()
    }

    /// Whether a band holds nothing but rounding: less than 1e-13 of the whole in rms terms. Band 3 and every later
    /// odd band of irradiance is exactly zero, so that orders 3 and 4 are one and the same irradiance.
    ///
    /// # Panics
    ///
    /// If `band` is not below the order.
    pub fn vanishes(&self, band: usize) -> bool {
        self.band_energy()[band] <= 1e-26 * self.energy()
    }

    /// The irradiance on a surface by its normal, if this is radiance, nowhere negative: each band times its
    /// [`cosine_lobe`].
    ///
    /// The energy beyond the projection is only bounded: by the largest factor there, and because a band l of what is
    /// nowhere negative holds at most 2l+1 times the energy of band 0. So it is at most 3.2 % of the irradiance in rms
    /// terms beyond order 10, 0.53 % beyond order 32 and 0.19 % beyond order 64, whatever the map, and small bright
    /// lights come near that. Project to order 32 to choose a small order of irradiance.
    pub fn irradiance(&self) -> Self {
        let mut coefficients = self.coefficients.clone();
        for l in 0..self.order {
            for c in coefficients[l * l..(l + 1) * (l + 1)].iter_mut().flatten() {
                *c *= cosine_lobe(l);
            }
        }
        let spectrum = self.spectrum();
        let whole = spectrum.bands.first().map(|&uniform| Parts { uniform, others: 0.0 });
        let beyond = Weights::irradiance(self.order).seen(&spectrum, whole.as_slice()).beyond;
        Self { order: self.order, coefficients, beyond }
    }

    /// The relative rms error that each order leaves: entry n−1 is √(energy left out by order n / energy of all), from
    /// 0 to 1, for the orders 1 to `order`. Never below the truth; above it for irradiance, as far as `beyond` is.
    pub fn errors(&self) -> Vec<f64> {
        self.spectrum().errors()
    }

    /// The smallest order whose relative rms error, as [`Projection::errors`] gives it, is at most `budget`; none if
    /// the whole projection leaves more, and a larger one has to be made to find it.
    pub fn smallest_order(&self, budget: f64) -> Option<usize> {
        self.errors().iter().position(|&error| error <= budget).map(|i| i + 1)
    }

    /// The values of R, G and B that the bands give in a direction (x, y, z), of length 1. A truncated series rings:
    /// values may be negative where the whole function is not.
    pub fn evaluate(&self, direction: [f64; 3]) -> [f64; 3] {
        let mut values = vec![0.0; self.order * self.order];
        basis(self.order, direction, &mut values);
        let mut sums = [0.0; 3];
        for (coefficient, value) in self.coefficients.iter().zip(values) {
            for channel in 0..3 {
                sums[channel] += coefficient[channel] * value;
            }
        }
        sums
    }
}

impl Survey {
    /// [`Survey::from_bytes`] of a file, or of six that hold the faces of a cube, as [`Map::read`] takes them.
    ///
    /// # Errors
    ///
    /// As [`Map::read`].
    pub fn read(path: &Path, order: usize) -> Result<Self, MapError> {
        match loaded::single(path)? {
            Some((name, bytes)) => Self::from_bytes(&name, &bytes, order),
            None => Loaded::read(path).map(|loaded| Self { size: loaded.size, ..loaded.map.survey(order) }),
        }
    }

    /// What the map that a file holds is found to be, with the image's numbers of columns and rows: as [`Map::from_bytes`]
    /// and [`Map::survey`] give it, but a latitude-longitude map in Radiance HDR is projected while it is read and never
    /// stands in memory.
    ///
    /// # Errors
    ///
    /// As [`Map::from_bytes`].
    pub fn from_bytes(name: &str, bytes: &[u8], order: usize) -> Result<Self, MapError> {
        if let Format::Radiance = loaded::format(name, bytes)? {
            let image = Radiance::new(name, bytes, Expected::Whole)?;
            if image.is_upright() && Layout::of(image.width, image.height) == Some(Layout::LatitudeLongitude) {
                return Self::from_rows(name, image, order);
            }
        }
        let Loaded { map, size, .. } = Loaded::from_bytes(name, bytes)?;
        Ok(Self { size, ..map.survey(order) })
    }

    /// The survey of rows, while they are read.
    fn from_rows(name: &str, mut image: Radiance<'_>, order: usize) -> Result<Self, MapError> {
        let (width, height) = (image.width, image.height);
        let projector = Projector::new(order, width, height);
        let bands = (0..height).step_by(BAND).map(|first| {
            let rows = (first..height.min(first + BAND)).map(|_| image.row());
            rows.collect::<Result<Vec<Row>, MapError>>().map(|rows| (first, rows))
        });
        let part = |band: Result<(usize, Vec<Row>), MapError>| {
            band.map(|(first, rows)| projector.part(first, &rows, Row::read))
        };
        let whole = projector.whole(threads::map(bands, part).into_iter().collect::<Result<Vec<Part>, MapError>>()?);
        match whole.projection.energy() == 0.0 {
            true => Err(MapError::Black { name: name.to_owned() }),
            false => Ok(whole),
        }
    }
}
