//! Environment maps: reads a latitude-longitude image (Radiance `.hdr` or OpenEXR `.exr`), refuses what is no
//! radiance, projects it on spherical harmonics in f64 and tells what each order leaves out. It knows nothing of
//! kernels.
//!
//! # Directions
//!
//! The polar axis of the harmonics, +z, is up: the top row of the map surrounds +z, the bottom row −z. Seen from
//! inside, the centre of the map lies along +x, columns to the right of it turn towards −y (so a quarter of the width
//! right of the centre is −y, a quarter left of it +y), and the left and right edges meet at −x. Blender places an
//! environment texture so; three.js does too, with its axes (x, y, z) read as (x, −z, y).
//!
//! # Quadrature
//!
//! A texel is one radiance over the whole of its solid angle. The harmonics are integrated over each texel, exactly
//! but for rounding, so that a projection is the least-squares fit of the map, band energies obey Parseval's identity
//! whatever the size of the map, and rounding is all that separates a uniform map from a single coefficient.
//! (Sampling the harmonics at the centres of texels would change order 10 of a 256×128 map by about 1e-3 in rms.)
//! docs/MATH.md#projection-of-maps has the integrals.

use std::f64::consts::PI;
use std::io::{Cursor, ErrorKind};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use image::codecs::{hdr::HdrDecoder, openexr::OpenExrDecoder};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat};
use rayon::prelude::*;

/// The widest map that is read; its height is half of this.
pub const MAX_WIDTH: usize = 8192;

/// A latitude-longitude map of radiance around a point. See the [module](self) for its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The number of columns, twice the height.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// The linear RGB radiance of `width * height` texels, row by row from the top, each row from the left. Finite,
    /// not negative, in the units of the file (a header's exposure is left alone).
    pub texels: Vec<[f64; 3]>,
}

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

/// Why a file is no environment map. Each message is one line: the file, what is wrong, what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The file cannot be opened or read.
    #[error("{name}: cannot be read ({source}); check the path and its permissions")]
    Unreadable {
        /// The file.
        name: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The content is in another format, whatever the file is called.
    #[error("{name}: holds {found}, neither Radiance HDR nor OpenEXR; save the map as .hdr or .exr")]
    Format {
        /// The file.
        name: String,
        /// What it holds, as far as its first bytes tell: "nothing", "a Png image", "unknown data".
        found: String,
    },
    /// The content is damaged, or uses a part of its format that is not supported.
    #[error("{name}: cannot be decoded ({message}); save or download the map again")]
    Malformed {
        /// The file.
        name: String,
        /// What the decoder says.
        message: String,
    },
    /// There are no texels.
    #[error("{name}: is empty, {width}×{height} texels; save a map of at least 2×1 texels")]
    Empty {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// The map is not twice as wide as high.
    #[error(
        "{name}: is {width}×{height} texels, but a latitude-longitude map is twice as wide as high; \
         convert it to that layout, uncropped"
    )]
    Shape {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// The map is wider than [`MAX_WIDTH`].
    #[error(
        "{name}: is {width}×{height} texels, above the limit of {MAX_WIDTH} columns; \
         reduce it (256×128 serves order 10) and save it again"
    )]
    TooLarge {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// Texels hold a NaN or an infinity.
    #[error(
        "{name}: {count} of its texels are not finite, the first at column {x}, row {y} ({value}); \
         replace them by radiance and save the map again"
    )]
    NotFinite {
        /// The file.
        name: String,
        /// How many texels have such a channel.
        count: usize,
        /// The column of the first one, from 0 at the left.
        x: usize,
        /// The row of the first one, from 0 at the top.
        y: usize,
        /// Its first such channel: a NaN or an infinity.
        value: f64,
    },
    /// Texels hold negative radiance.
    #[error(
        "{name}: {count} of its texels hold negative radiance, down to {lowest}, the first at \
         column {x}, row {y}; clamp the map to 0 and save it again"
    )]
    Negative {
        /// The file.
        name: String,
        /// How many texels have a negative channel.
        count: usize,
        /// The most negative channel of all texels.
        lowest: f64,
        /// The column of the first one, from 0 at the left.
        x: usize,
        /// The row of the first one, from 0 at the top.
        y: usize,
    },
    /// Every texel is zero, so that no error relative to the map exists.
    #[error("{name}: is black all over; check how it was exported")]
    Black {
        /// The file.
        name: String,
    },
}

impl Map {
    /// Reads a map from a file, Radiance HDR or OpenEXR by its content, whatever its extension.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or for any reason of [`Map::from_bytes`].
    pub fn read(path: &Path) -> Result<Self, MapError> {
        let name = path.display().to_string();
        match std::fs::read(path) {
            Ok(bytes) => Self::from_bytes(&name, &bytes),
            Err(source) => Err(MapError::Unreadable { name, source }),
        }
    }

    /// Reads a map from the bytes of a file, Radiance HDR or OpenEXR by its content. `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// If the format is another one, the bytes are damaged, the map is empty, not twice as wide as high or wider than
    /// [`MAX_WIDTH`], or a texel is not finite or negative, or all are zero.
    ///
    /// No bytes make it panic. (A damaged OpenEXR file in DWA compression can still name sizes for which its decoder
    /// asks for more memory than there is, which ends the process.)
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        // The decoders are not proof against overflow in damaged files.
        let decoded = catch_unwind(AssertUnwindSafe(|| {
            if bytes.starts_with(b"#?") {
                let decoder = HdrDecoder::new_nonstrict(Cursor::new(bytes));
                Self::decode(name, decoder)
            } else if matches!(image::guess_format(bytes), Ok(ImageFormat::OpenExr)) {
                let decoder = OpenExrDecoder::with_alpha_preference(Cursor::new(bytes), Some(false));
                Self::decode(name, decoder)
            } else {
                let found = match image::guess_format(bytes) {
                    Ok(format) => format!("a {format:?} image"),
                    Err(_) if bytes.is_empty() => "nothing".to_string(),
                    Err(_) => "unknown data".to_string(),
                };
                Err(MapError::Format { name: name.to_string(), found })
            }
        }));
        let decoded = decoded.unwrap_or_else(|_| Err(malformed(name, "the decoder gave up")));
        decoded?.checked(name)
    }

    /// This map, if it is one that [`Map::from_bytes`] could have given: for a map made by hand. `name` is what
    /// errors call it.
    ///
    /// # Errors
    ///
    /// If it is empty, not twice as wide as high, wider than [`MAX_WIDTH`], has another number of texels than its
    /// size says, or a texel is not finite or negative, or all are zero.
    pub fn checked(self, name: &str) -> Result<Self, MapError> {
        check_size(name, self.width, self.height)?;
        if self.texels.len() != self.width * self.height {
            return Err(malformed(name, &format!("it has {} texels", self.texels.len())));
        }
        let place = |i: usize| (i % self.width, i / self.width);
        let wrong = |bad: fn(f64) -> bool| {
            let found = |t: &[f64; 3]| t.iter().copied().find(|&v| bad(v));
            let mut wrong = self.texels.iter().enumerate().filter_map(|(i, t)| Some((i, found(t)?)));
            wrong.next().map(|(i, value)| (place(i), value, 1 + wrong.count()))
        };
        if let Some(((x, y), value, count)) = wrong(|v| !v.is_finite()) {
            return Err(MapError::NotFinite { name: name.to_string(), count, x, y, value });
        }
        if let Some(((x, y), _, count)) = wrong(|v| v < 0.0) {
            let lowest = self.texels.iter().flatten().copied().fold(0.0, f64::min);
            return Err(MapError::Negative { name: name.to_string(), count, lowest, x, y });
        }
        if self.texels.iter().flatten().all(|&v| v == 0.0) {
            return Err(MapError::Black { name: name.to_string() });
        }
        Ok(self)
    }

    fn decode<D: ImageDecoder>(name: &str, decoder: Result<D, ImageError>) -> Result<Self, MapError> {
        let undecodable = |error: ImageError| match error {
            ImageError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => malformed(name, "it ends too early"),
            error => malformed(name, &error.to_string()),
        };
        let decoder = decoder.map_err(undecodable)?;
        let (width, height) = decoder.dimensions();
        let (width, height) = (width as usize, height as usize);
        check_size(name, width, height)?;
        let image = DynamicImage::from_decoder(decoder).map_err(undecodable)?.into_rgb32f();
        let texels = image.pixels().map(|p| p.0.map(f64::from)).collect();
        Ok(Self { width, height, texels })
    }

    /// The unit direction (x, y, z) of the centre of the texel in column `x` (from 0 at the left) of row `y` (from 0
    /// at the top).
    pub fn direction(&self, x: usize, y: usize) -> [f64; 3] {
        let azimuth = PI - 2.0 * PI * (x as f64 + 0.5) / self.width as f64;
        let (sin, cos) = (PI * (y as f64 + 0.5) / self.height as f64).sin_cos();
        [sin * azimuth.cos(), sin * azimuth.sin(), cos]
    }

    /// The solid angle in steradians of each texel in row `y` (from 0 at the top). All texels together have 4π.
    pub fn solid_angle(&self, y: usize) -> f64 {
        let half = 0.5 * PI / self.height as f64;
        let cosines = 2.0 * half.sin() * ((2 * y + 1) as f64 * half).sin();
        2.0 * PI / self.width as f64 * cosines
    }

    /// The square of the radiance, integrated over the sphere and summed over R, G and B: what the energies of all
    /// the bands come to.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and its width is 0; see [`Map::checked`].
    pub fn energy(&self) -> f64 {
        let rows = self.texels.chunks_exact(self.width).enumerate();
        rows.map(|(y, row)| self.solid_angle(y) * row.iter().flatten().map(|v| v * v).sum::<f64>()).sum()
    }

    /// The radiance projected on the first `order` bands: the coefficients, and the energy that they leave out.
    ///
    /// The time grows as the number of texels times `order`.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and its width is 0, or it has fewer texels than its size says; see
    /// [`Map::checked`].
    pub fn project(&self, order: usize) -> Projection {
        let fourier = self.fourier(order);
        let mut coefficients = vec![[0.0; 3]; order * order];
        for (row, zonal) in fourier.iter().zip(self.rows_of_basis(order)) {
            for (l, m) in (0..order).flat_map(|l| (0..=l).map(move |m| (l, m))) {
                let centre = l * (l + 1);
                for channel in 0..3 {
                    let [cos, sin] = row[m][channel];
                    coefficients[centre + m][channel] += zonal[centre + m] * cos;
                    if m > 0 {
                        coefficients[centre - m][channel] += zonal[centre + m] * sin;
                    }
                }
            }
        }
        let mut projection = Projection { order, coefficients, beyond: 0.0 };
        projection.beyond = (self.energy() - projection.energy()).max(0.0);
        projection
    }

    /// For each row, for each m below `order`, the integrals of the three channels times cos mφ and sin mφ.
    fn fourier(&self, order: usize) -> Vec<Vec<[[f64; 2]; 3]>> {
        let width = self.width as f64;
        let waves: Vec<Vec<[f64; 2]>> = (0..order)
            .map(|m| {
                let m = m as f64;
                let half = PI * m / width;
                let weight = if m == 0.0 { 2.0 * PI / width } else { 2.0 * half.sin() / m };
                let phase = |x: usize| m * (PI - 2.0 * PI * (x as f64 + 0.5) / width);
                (0..self.width).map(|x| [weight * phase(x).cos(), weight * phase(x).sin()]).collect()
            })
            .collect();
        let rows = self.texels[..self.width * self.height].par_chunks_exact(self.width);
        rows.map(|row| {
            let integrate = |wave: &Vec<[f64; 2]>| {
                let mut sums = [[0.0; 2]; 3];
                for (texel, [cos, sin]) in row.iter().zip(wave) {
                    for channel in 0..3 {
                        sums[channel][0] += texel[channel] * cos;
                        sums[channel][1] += texel[channel] * sin;
                    }
                }
                sums
            };
            waves.iter().map(integrate).collect()
        })
        .collect()
    }

    /// For each row, the basis at azimuth 0 integrated over the polar angle θ with weight sin θ: by Gauss-Legendre
    /// quadrature of five nodes in steps over which no harmonic turns by more than π/4, good to rounding.
    fn rows_of_basis(&self, order: usize) -> impl Iterator<Item = Vec<f64>> {
        let steps = (4 * order).div_ceil(self.height).max(1);
        let step = PI / (self.height * steps) as f64;
        let rows = 0..self.height;
        rows.map(move |y| {
            let mut sums = vec![0.0; order * order];
            let mut values = vec![0.0; order * order];
            for i in y * steps..(y + 1) * steps {
                for (node, weight) in gauss_legendre_5() {
                    let (sin, cos) = (step * (i as f64 + 0.5 + 0.5 * node)).sin_cos();
                    basis(order, [sin, 0.0, cos], &mut values);
                    for (sum, value) in sums.iter_mut().zip(&values) {
                        *sum += 0.5 * step * weight * sin * value;
                    }
                }
            }
            sums
        })
    }
}

impl Projection {
    /// The energy of each band: the sum of the squares of its coefficients over m and over R, G and B. By Parseval's
    /// identity this is the integral over the sphere of the square of what the band adds.
    pub fn band_energy(&self) -> Vec<f64> {
        let band = |l: usize| &self.coefficients[l * l..(l + 1) * (l + 1)];
        (0..self.order).map(|l| band(l).iter().flatten().map(|c| c * c).sum()).collect()
    }

    /// The energy of all bands, those beyond the projection included.
    pub fn energy(&self) -> f64 {
        self.band_energy().iter().sum::<f64>() + self.beyond
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
        let factors: Vec<f64> = (0..self.order + 2).map(cosine_lobe).collect();
        let mut coefficients = self.coefficients.clone();
        for l in 0..self.order {
            for c in coefficients[l * l..(l + 1) * (l + 1)].iter_mut().flatten() {
                *c *= factors[l];
            }
        }
        let largest = factors[self.order].abs().max(factors[self.order + 1].abs());
        let mut beyond = largest * largest * self.beyond;
        if let Some(&uniform) = self.band_energy().first() {
            // (2l+1) A_l² of all bands is 4π times the integral of the squared cosine lobe.
            let all = 8.0 * PI * PI / 3.0;
            let terms = (0..self.order).map(|l| (2 * l + 1) as f64 * factors[l] * factors[l]);
            beyond = beyond.min(uniform * (all - terms.sum::<f64>()).max(0.0));
        }
        Self { order: self.order, coefficients, beyond }
    }

    /// The relative rms error that each order leaves: entry n−1 is √(energy left out by order n / energy of all), from
    /// 0 to 1, for the orders 1 to `order`. Never below the truth; above it for irradiance, as far as `beyond` is.
    pub fn errors(&self) -> Vec<f64> {
        let total = self.energy();
        let mut left = self.beyond;
        let mut errors = vec![0.0; self.order];
        for (error, band) in errors.iter_mut().zip(self.band_energy()).rev() {
            *error = if total > 0.0 { (left / total).sqrt() } else { 0.0 };
            left += band;
        }
        errors
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

/// The factor A_l by which band `l` of radiance gives the irradiance of a surface, the clamped cosine's integral over
/// the hemisphere against the Legendre polynomial: π, 2π/3, π/4, 0, −π/24, 0, π/64, …. It is in steradians, and exactly
/// 0 for every odd band above 1.
///
/// For even l it is 2π (−1)^(l/2−1) / ((l+2)(l−1)) · l! / (2^l (l/2)!²) (Ramamoorthi and Hanrahan 2001, equation 19).
pub fn cosine_lobe(l: usize) -> f64 {
    if l == 1 {
        return 2.0 * PI / 3.0;
    }
    if l % 2 == 1 {
        return 0.0;
    }
    let central: f64 = (1..=l / 2).map(|k| -((2 * k - 1) as f64) / (2 * k) as f64).product();
    let l = l as f64;
    -2.0 * PI * central / ((l + 2.0) * (l - 1.0))
}

/// The harmonics of the bands below `order` in a direction (x, y, z) of length 1, into the first `order * order` of
/// `values`, at index l(l+1)+m. Polynomials in x, y and z, so that the poles are like any other place.
pub(crate) fn basis(order: usize, direction: [f64; 3], values: &mut [f64]) {
    let [x, y, z] = direction;
    let mut sectoral = 0.5 / PI.sqrt();
    let (mut cos, mut sin) = (1.0, 0.0);
    for m in 0..order {
        if m > 0 {
            let factor = if m == 1 { 3.0 } else { (2 * m + 1) as f64 / (2 * m) as f64 };
            sectoral *= -factor.sqrt();
            (cos, sin) = (x * cos - y * sin, x * sin + y * cos);
        }
        let (mut before, mut legendre) = (0.0, sectoral);
        let mut last_ratio = 1.0;
        for l in m..order {
            if l > m {
                let (ll, mm) = ((l * l) as f64, (m * m) as f64);
                let ratio = ((4.0 * ll - 1.0) / (ll - mm)).sqrt();
                (before, legendre) = (legendre, ratio * (z * legendre - before / last_ratio));
                last_ratio = ratio;
            }
            let centre = l * (l + 1);
            values[centre + m] = legendre * cos;
            if m > 0 {
                values[centre - m] = legendre * sin;
            }
        }
    }
}

/// The nodes, from −1 to 1, and the weights of the five-point Gauss-Legendre rule.
fn gauss_legendre_5() -> [(f64, f64); 5] {
    let (root_10_7, root_70) = ((10.0f64 / 7.0).sqrt(), 70.0f64.sqrt());
    let inner = (5.0 - 2.0 * root_10_7).sqrt() / 3.0;
    let outer = (5.0 + 2.0 * root_10_7).sqrt() / 3.0;
    let inner_weight = (322.0 + 13.0 * root_70) / 900.0;
    let outer_weight = (322.0 - 13.0 * root_70) / 900.0;
    [(-outer, outer_weight), (-inner, inner_weight), (0.0, 128.0 / 225.0), (inner, inner_weight), (outer, outer_weight)]
}

fn check_size(name: &str, width: usize, height: usize) -> Result<(), MapError> {
    let name = name.to_string();
    if width == 0 || height == 0 {
        Err(MapError::Empty { name, width, height })
    } else if Some(width) != height.checked_mul(2) {
        Err(MapError::Shape { name, width, height })
    } else if width > MAX_WIDTH {
        Err(MapError::TooLarge { name, width, height })
    } else {
        Ok(())
    }
}

fn malformed(name: &str, message: &str) -> MapError {
    MapError::Malformed { name: name.to_string(), message: message.replace(char::is_control, " ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::promise::samples::Random;

    /// A map whose texels hold the value of `radiance`, by column, row and direction, in all channels.
    fn map(height: usize, radiance: impl Fn(usize, usize, [f64; 3]) -> f64) -> Map {
        let mut map = Map { width: 2 * height, height, texels: Vec::new() };
        for (x, y) in (0..height).flat_map(|y| (0..2 * height).map(move |x| (x, y))) {
            map.texels.push([radiance(x, y, map.direction(x, y)); 3]);
        }
        map
    }

    fn distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
        assert_eq!(a.len(), b.len());
        let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    }

    fn legendre(l: usize, z: f64) -> f64 {
        let mut pair = (0.0, 1.0);
        for k in 0..l {
            let k = k as f64;
            pair = (pair.1, ((2.0 * k + 1.0) * z * pair.1 - k * pair.0) / (k + 1.0));
        }
        pair.1
    }

    fn exr(width: u32, height: u32, texels: Vec<f32>) -> Vec<u8> {
        let image = image::Rgb32FImage::from_raw(width, height, texels).unwrap();
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::OpenExr).unwrap();
        bytes.into_inner()
    }

    /// An HDR file of 16 columns and `rows` rows, each run-length encoded in the old way.
    fn hdr(rows: &[u8]) -> Vec<u8> {
        [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n", rows].concat()
    }

    #[test]
    fn basis_is_orthonormal_with_condon_shortley_phase() {
        let nu = (3.0 / (4.0 * PI)).sqrt();
        let mut random = Random::new(1);
        let mut directions = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]];
        for _ in 0..20 {
            let [x, y, z] = [random.signed(), random.signed(), random.signed()];
            let length = (x * x + y * y + z * z).sqrt();
            directions.push([x / length, y / length, z / length]);
        }
        for [x, y, z] in directions {
            let mut values = vec![f64::NAN; 20 * 20];
            basis(20, [x, y, z], &mut values);
            let expected = [
                0.5 / PI.sqrt(),
                -nu * y,
                nu * z,
                -nu * x,
                nu * 5.0f64.sqrt() * x * y,
                -nu * 5.0f64.sqrt() * y * z,
                (5.0 / (16.0 * PI)).sqrt() * (3.0 * z * z - 1.0),
                -nu * 5.0f64.sqrt() * x * z,
                nu * 1.25f64.sqrt() * (x * x - y * y),
            ];
            for (value, expected) in values.iter().zip(expected) {
                assert!((value - expected).abs() < 1e-15, "{value} is not {expected}");
            }
            for l in 0..20 {
                let sum: f64 = values[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum();
                let expected = (2 * l + 1) as f64 / (4.0 * PI);
                assert!((sum / expected - 1.0).abs() < 1e-13, "band {l}");
            }
        }
    }

    #[test]
    fn cosine_lobe_is_the_integral_of_the_clamped_cosine() {
        for l in 0..40 {
            let steps = 200;
            let mut integral = 0.0;
            for i in 0..steps {
                for (node, weight) in gauss_legendre_5() {
                    let z = (i as f64 + 0.5 + 0.5 * node) / steps as f64;
                    integral += PI / steps as f64 * weight * z * legendre(l, z);
                }
            }
            assert!((cosine_lobe(l) - integral).abs() < 1e-14, "band {l}");
        }
        assert_eq!(cosine_lobe(0), PI);
        assert!((cosine_lobe(4) + PI / 24.0).abs() < 1e-16);
        assert!((3..100).step_by(2).all(|l| cosine_lobe(l) == 0.0));
    }

    #[test]
    fn directions_follow_the_documented_layout() {
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02);
        let map = map(128, |_, _, _| 1.0);
        assert!(close(map.direction(128, 64), [1.0, 0.0, 0.0]));
        assert!(close(map.direction(192, 64), [0.0, -1.0, 0.0]));
        assert!(close(map.direction(64, 64), [0.0, 1.0, 0.0]));
        assert!(close(map.direction(0, 64), [-1.0, 0.0, 0.0]));
        assert!(close(map.direction(17, 0), [0.0, 0.0, 1.0]));
        assert!(close(map.direction(17, 127), [0.0, 0.0, -1.0]));
        let sphere: f64 = (0..128).map(|y| 256.0 * map.solid_angle(y)).sum();
        assert!((sphere - 4.0 * PI).abs() < 1e-13);
    }

    #[test]
    fn a_bright_texel_is_found_where_its_direction_says() {
        for (x, y) in [(0, 0), (3, 1), (9, 4), (15, 7), (8, 3)] {
            let map = map(8, |i, j, _| f64::from((i, j) == (x, y)));
            let c = map.project(2).coefficients;
            let vector = [-c[3][0], -c[1][0], c[2][0]];
            let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
            let cos: f64 = vector.iter().zip(map.direction(x, y)).map(|(a, b)| a * b / length).sum();
            assert!(cos > 0.98, "column {x}, row {y}: cosine {cos}");
        }
    }

    #[test]
    fn a_uniform_map_of_any_size_is_band_0_alone() {
        for height in [1, 2, 3, 16, 128] {
            let map = map(height, |_, _, _| 2.5);
            let projection = map.project(10);
            let mut expected = vec![[0.0; 3]; 100];
            expected[0] = [2.0 * PI.sqrt() * 2.5; 3];
            assert!(distance(&projection.coefficients, &expected) < 1e-12);
            assert!((projection.energy() / map.energy() - 1.0).abs() < 1e-14);
            assert_eq!(projection.smallest_order(1e-6), Some(1));
            assert!((1..10).all(|l| projection.vanishes(l)) && !projection.vanishes(0));
            let [e, ..] = projection.irradiance().evaluate([0.6, 0.0, 0.8]);
            assert!((e / (2.5 * PI) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_bright_hemisphere_is_projected_exactly() {
        // The texels' edges are the hemisphere's, so that rounding alone is left.
        for height in [2, 6, 128] {
            let c = map(height, |_, _, d| f64::from(d[2] > 0.0)).project(8).coefficients;
            for l in 0..8 {
                // The integral of P_l from 0 to 1.
                let integral = match l {
                    0 => 1.0,
                    _ => (legendre(l - 1, 0.0) - legendre(l + 1, 0.0)) / (2 * l + 1) as f64,
                };
                let expected = ((2 * l + 1) as f64 * PI).sqrt() * integral;
                assert!((c[l * (l + 1)][0] - expected).abs() < 1e-13, "height {height}, band {l}");
            }
            let c = map(height, |_, _, d| f64::from(d[1] > 0.0)).project(8).coefficients;
            assert!((c[1][0] + (3.0 * PI).sqrt() / 2.0).abs() < 1e-13, "height {height}");
            assert!(c[2][0].abs() < 1e-13 && c[3][0].abs() < 1e-13);
        }
    }

    #[test]
    fn a_clamped_cosine_has_the_coefficients_of_the_lobe() {
        let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        let dot = |d: [f64; 3]| d.iter().zip(axis).map(|(a, b)| a * b).sum::<f64>();
        let projection = map(128, |_, _, d| dot(d).max(0.0)).project(8);
        let mut expected = vec![0.0; 64];
        basis(8, axis, &mut expected);
        for l in 0..8 {
            for i in l * l..(l + 1) * (l + 1) {
                expected[i] *= cosine_lobe(l);
            }
        }
        let expected: Vec<_> = expected.iter().map(|&v| [v; 3]).collect();
        // Texels of width Δ = π/128 change band l by l(l+1) Δ²/24 at first order: 7·8 · 2.5e-5 at most.
        assert!(distance(&projection.coefficients, &expected) < 1.4e-3 * expected[0][0]);
    }

    #[test]
    fn a_sampled_series_comes_back() {
        let mut random = Random::new(1);
        let coefficients = (0..25).map(|_| [random.signed(), random.signed(), random.signed()]).collect();
        let series = Projection { order: 5, coefficients, beyond: 0.0 };
        let error = |height: usize| {
            let mut map = map(height, |_, _, _| 0.0);
            for i in 0..map.texels.len() {
                map.texels[i] = series.evaluate(map.direction(i % map.width, i / map.width));
            }
            let back = map.project(5).coefficients;
            distance(&back, &series.coefficients) / series.energy().sqrt()
        };
        // A texel holds the series at its centre. Averaging a harmonic over a texel of width Δ changes it by
        // l(l+1) Δ²/24 at first order: 20 · 2.5e-5 for band 4 of 256×128. Less for the lower bands.
        let (coarse, fine) = (error(64), error(128));
        assert!(fine < 5e-4, "{fine}");
        assert!((coarse / fine - 4.0).abs() < 0.05, "{coarse} {fine}");
    }

    #[test]
    fn shifting_columns_turns_the_series_about_z() {
        let mut random = Random::new(1);
        let texels = (0..16 * 8).map(|_| [random.signed(), random.signed(), random.signed()]).collect();
        let map = Map { width: 16, height: 8, texels };
        let mut turned = map.clone();
        turned.texels.chunks_exact_mut(16).for_each(|row| row.rotate_left(3));
        let angle = 3.0 * 2.0 * PI / 16.0;
        let mut expected = map.project(7).coefficients;
        for (l, m) in (0..7).flat_map(|l| (1..=l).map(move |m| (l, m))) {
            let (sin, cos) = (m as f64 * angle).sin_cos();
            for channel in 0..3 {
                let (plus, minus) = (l * (l + 1) + m, l * (l + 1) - m);
                let (a, b) = (expected[plus][channel], expected[minus][channel]);
                expected[plus][channel] = cos * a - sin * b;
                expected[minus][channel] = sin * a + cos * b;
            }
        }
        assert!(distance(&turned.project(7).coefficients, &expected) < 1e-13);
    }

    #[test]
    fn energies_obey_parseval_even_for_orders_beyond_the_map() {
        let mut random = Random::new(1);
        let texels =
            (0..8 * 4).map(|_| [random.signed().abs(), random.signed().abs(), random.signed().abs()]).collect();
        let map = Map { width: 8, height: 4, texels };
        let whole = map.project(60);
        assert!((whole.energy() / map.energy() - 1.0).abs() < 1e-14);
        let errors = whole.errors();
        assert!(errors.windows(2).all(|e| e[0] >= e[1]) && errors[59] > 0.0);
        let bands = whole.band_energy();
        for order in [0, 1, 4, 20] {
            let part = map.project(order);
            assert_eq!(part.coefficients.len(), order * order);
            let beyond = whole.beyond + bands[order..].iter().sum::<f64>();
            assert!((part.beyond / beyond - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn orders_of_irradiance_are_chosen_by_a_bound_that_holds() {
        // A single bright texel is the hardest case: nearly all of its radiance lies beyond any order.
        let map = map(64, |x, y, _| if (x, y) == (40, 30) { 1e6 } else { 1.0 });
        let truth = map.project(128).irradiance();
        assert!(truth.beyond < 1e-6 * truth.energy());
        for (order, promised) in [(10, 0.032), (32, 0.0053), (64, 0.0019)] {
            let judged = map.project(order).irradiance();
            assert!(judged.beyond >= truth.beyond + truth.band_energy()[order..].iter().sum::<f64>());
            for (judged, truth) in judged.errors().iter().zip(truth.errors()) {
                assert!(*judged >= truth && judged * judged < truth * truth + promised * promised);
            }
        }
        let errors = truth.errors();
        assert_eq!(errors[2], errors[3]);
        assert!(truth.vanishes(3) && truth.vanishes(5) && !truth.vanishes(4));
        assert_eq!(truth.smallest_order(errors[3]), Some(3));
        assert_eq!(truth.smallest_order(0.0), None);
        assert_eq!(truth.smallest_order(f64::NAN), None);
    }

    #[test]
    fn formats_are_told_apart_by_content() {
        let found = |bytes: &[u8]| match Map::from_bytes("a.hdr", bytes) {
            Err(MapError::Format { found, .. }) => found,
            other => panic!("{other:?}"),
        };
        assert_eq!(found(b""), "nothing");
        assert_eq!(found(b"A text.\n"), "unknown data");
        assert_eq!(found(b"\x89PNG\r\n\x1a\n"), "a Png image");
        let texel = [128, 64, 32, 129];
        let read = |bytes: &[u8]| Map::from_bytes("a.exr", bytes).unwrap().texels[0];
        assert_eq!(read(&hdr(&texel.repeat(16 * 8))), [1.0, 0.5, 0.25]);
        let old = [b"#?RGBE\n", &hdr(&texel.repeat(16 * 8))[11..]].concat();
        assert_eq!(read(&old), [1.0, 0.5, 0.25]);
        assert_eq!(read(&exr(2, 1, vec![1.0, 0.5, 0.25, 0.0, 0.0, 0.0])), [1.0, 0.5, 0.25]);
    }

    #[test]
    fn what_is_no_radiance_is_refused() {
        let message = |width: u32, height: u32, change: &[(usize, f32)]| {
            let mut texels = vec![1.0; 3 * (width * height) as usize];
            change.iter().for_each(|&(i, v)| texels[i] = v);
            Map::from_bytes("a.exr", &exr(width, height, texels)).unwrap_err().to_string()
        };
        assert_eq!(
            message(4, 2, &[(10, f32::NAN), (23, f32::INFINITY), (0, -1.0)]),
            "a.exr: 2 of its texels are not finite, the first at column 3, row 0 (NaN); \
             replace them by radiance and save the map again"
        );
        assert_eq!(
            message(4, 2, &[(12, -0.5), (13, -2.0), (20, -0.25)]),
            "a.exr: 2 of its texels hold negative radiance, down to -2, the first at \
             column 0, row 1; clamp the map to 0 and save it again"
        );
        assert_eq!(
            message(4, 4, &[]),
            "a.exr: is 4×4 texels, but a latitude-longitude map is twice as wide as high; \
             convert it to that layout, uncropped"
        );
        let black: Vec<_> = (0..6).map(|i| (i, 0.0)).collect();
        assert_eq!(message(2, 1, &black), "a.exr: is black all over; check how it was exported");
        let sized = |size: &str| {
            let file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
            Map::from_bytes("a.hdr", file.as_bytes()).unwrap_err()
        };
        assert!(matches!(sized("-Y 0 +X 0"), MapError::Empty { .. }));
        assert!(matches!(sized("-Y 8192 +X 16384"), MapError::TooLarge { width: 16384, .. }));
        assert!(matches!(sized("-Y 100000 +X 100000"), MapError::Shape { .. }));
        assert!(matches!(sized("+Y 8 +X 16"), MapError::Malformed { .. }));
        let short = Map { width: 2, height: 1, texels: vec![[1.0; 3]] };
        assert!(matches!(short.checked("short"), Err(MapError::Malformed { .. })));
    }

    #[test]
    fn no_bytes_make_it_panic() {
        let error = |bytes: &[u8]| match Map::from_bytes("a", bytes) {
            Err(error) => error.to_string(),
            Ok(_) => String::new(),
        };
        let good_hdr = hdr(&[128, 64, 32, 129].repeat(16 * 8));
        let good_exr = exr(4, 2, vec![1.0; 24]);
        assert_eq!(error(&good_hdr), "");
        for length in 1..good_hdr.len() {
            assert_ne!(error(&good_hdr[..length]), "");
        }
        for length in 1..good_exr.len() {
            assert_ne!(error(&good_exr[..length]), "");
        }
        assert!(error(&good_hdr[..300]).contains("it ends too early"));
        // Runs of length 0 multiply the decoder's counter until it overflows.
        let overflow = [[9, 9, 9, 9].as_slice(), &[1, 1, 1, 0].repeat(40)].concat();
        assert!(error(&hdr(&overflow)).contains("cannot be decoded"));
        let mut random = Random::new(1);
        for good in [&good_hdr, &good_exr] {
            for _ in 0..2000 {
                let mut bytes = good.clone();
                for _ in 0..3 {
                    let i = (random.signed().abs() * bytes.len() as f64) as usize;
                    bytes[i] = (random.signed() * 128.0) as i8 as u8;
                }
                let message = error(&bytes);
                assert!(!message.contains('\n'), "{message}");
            }
        }
    }
}
