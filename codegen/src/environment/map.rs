//! A map in memory: what surrounds a point, as latitude and longitude or as a cube, refused if it is no radiance.

use super::cube;
use super::error::MapError;
use super::layout::{Expected, FACES, check_size};
use std::f64::consts::PI;

/// The radiance around a point. Twice as wide as high it is a latitude-longitude map; six times as high as wide it is a
/// cube, its faces one below the other in the order of [`FACES`]. See the [module](super) for the directions
/// of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The number of columns: twice the height, or a sixth of it.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// The linear RGB radiance of `width * height` texels, row by row from the top, each row from the left. Finite,
    /// not negative, in the units of the file (a header's exposure is left alone).
    pub texels: Vec<[f64; 3]>,
}

impl Map {
    /// Whether it is a cube.
    pub fn is_cube(&self) -> bool {
        self.height == 6 * self.width
    }

    /// This map, if it is one that [`Map::from_bytes`] could have given: for a map made by hand. `name` is what
    /// errors call it.
    ///
    /// # Errors
    ///
    /// If it is empty, of other proportions, larger than [`MAX_WIDTH`](super::MAX_WIDTH) or
    /// [`MAX_SIDE`](super::MAX_SIDE) say, has another number of texels than its size says, or a texel is not finite or
    /// negative, or all are zero.
    pub fn checked(self, name: &str) -> Result<Self, MapError> {
        let (width, height) = (self.width, self.height);
        check_size(name, width, height, Expected::Whole)?;
        if !self.is_cube() && width != 2 * height {
            return Err(MapError::Shape { name: name.to_owned(), width, height, is_face: false });
        }
        if self.texels.len() != self.width * self.height {
            return Err(MapError::malformed(name, &format!("it has {} texels", self.texels.len())));
        }
        let place = |i: usize| match self.is_cube() {
            false => (name.to_owned(), i % self.width, i / self.width),
            true => {
                let (x, y) = (i % self.width, i / self.width);
                (format!("{name}, face {}", FACES[y / self.width]), x, y % self.width)
            }
        };
        let wrong = |bad: fn(f64) -> bool| {
            let found = |t: &[f64; 3]| t.iter().copied().find(|&v| bad(v));
            let mut wrong = self.texels.iter().enumerate().filter_map(|(i, t)| Some((i, found(t)?)));
            wrong.next().map(|(i, value)| (place(i), value, 1 + wrong.count()))
        };
        if let Some(((name, x, y), value, count)) = wrong(|v| !v.is_finite()) {
            return Err(MapError::NotFinite { name, count, x, y, value });
        }
        if let Some(((name, x, y), _, count)) = wrong(|v| v < 0.0) {
            let lowest = self.texels.iter().flatten().copied().fold(0.0, f64::min);
            return Err(MapError::Negative { name, count, lowest, x, y });
        }
        if self.texels.iter().flatten().all(|&v| v == 0.0) {
            return Err(MapError::Black { name: name.to_string() });
        }
        Ok(self)
    }

    /// The unit direction (x, y, z) of the centre of the texel in column `x` (from 0 at the left) of row `y` (from 0
    /// at the top).
    pub fn direction(&self, x: usize, y: usize) -> [f64; 3] {
        if self.is_cube() {
            return cube::direction(self.width, y / self.width, x, y % self.width);
        }
        let azimuth = PI - 2.0 * PI * (x as f64 + 0.5) / self.width as f64;
        let (sin, cos) = (PI * (y as f64 + 0.5) / self.height as f64).sin_cos();
        [sin * azimuth.cos(), sin * azimuth.sin(), cos]
    }

    /// Returns the unit direction of a place in the texel in column `x` of row `y`, from 0 to 1 across it from the left and
    /// from the top, and the solid angle there of a step of one in both: the texel's own, the same at every place, in a
    /// latitude-longitude map. Places that are spread evenly, each weighed by its solid angle, integrate over the texel.
    pub fn inside(&self, x: usize, y: usize, [right, down]: [f64; 2]) -> ([f64; 3], f64) {
        if self.is_cube() {
            return cube::inside(self.width, y / self.width, [x as f64 + right, (y % self.width) as f64 + down]);
        }
        let cosine = |row: usize| (PI * row as f64 / self.height as f64).cos();
        let z = cosine(y) + down * (cosine(y + 1) - cosine(y));
        let (sin, cos) = (PI - 2.0 * PI * (x as f64 + right) / self.width as f64).sin_cos();
        let radius = (1.0 - z * z).max(0.0).sqrt();
        ([radius * cos, radius * sin, z], self.solid_angle(x, y))
    }

    /// The solid angle in steradians of the texel in column `x` (from 0 at the left) of row `y` (from 0 at the top). All
    /// texels together have 4π.
    pub fn solid_angle(&self, x: usize, y: usize) -> f64 {
        match self.is_cube() {
            true => cube::solid_angle(self.width, x, y % self.width),
            false => solid_angle(self.width, self.height, y),
        }
    }

    /// The radiance of the texel in which a direction (x, y, z) lies; its length does not matter.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and has no or too few texels; see [`Map::checked`].
    pub fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        if self.is_cube() {
            let [face, x, y] = cube::texel(self.width, direction);
            return self.texels[(face * self.width + y) * self.width + x];
        }
        let [x, y, z] = direction;
        let part = |share: f64, count: usize| ((share * count as f64) as usize).min(count - 1);
        let column = part(0.5 - y.atan2(x) / (2.0 * PI), self.width);
        let row = part(x.hypot(y).atan2(z) / PI, self.height);
        self.texels[row * self.width + column]
    }

    /// This as a latitude-longitude map of so many rows: itself if it is one already, or each texel the mean of what nine
    /// directions in it find in the cube. For pictures; what is projected is never resampled.
    pub fn unrolled(&self, height: usize) -> Self {
        if !self.is_cube() {
            return self.clone();
        }
        const SAMPLES: usize = 3;
        // The directions of texels of a map that is finer by this factor.
        let fine = Self { width: 2 * height * SAMPLES, height: height * SAMPLES, texels: vec![] };
        let texel = |i: usize| {
            let (column, row) = (i % (2 * height), i / (2 * height));
            let mut sum = [0.0; 3];
            for (x, y) in (0..SAMPLES).flat_map(|y| (0..SAMPLES).map(move |x| (x, y))) {
                let found = self.radiance(fine.direction(column * SAMPLES + x, row * SAMPLES + y));
                (0..3).for_each(|k| sum[k] += found[k] / (SAMPLES * SAMPLES) as f64);
            }
            sum
        };
        Self { width: 2 * height, height, texels: (0..2 * height * height).map(texel).collect() }
    }

    /// The square of the radiance, integrated over the sphere and summed over R, G and B: what the energies of all
    /// the bands come to.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and its width is 0; see [`Map::checked`].
    pub fn energy(&self) -> f64 {
        if self.is_cube() {
            return cube::energy(self.width, &self.texels);
        }
        let rows = self.texels.chunks_exact(self.width).enumerate();
        rows.map(|(y, row)| self.solid_angle(0, y) * row.iter().flatten().map(|v| v * v).sum::<f64>()).sum()
    }
}

/// The solid angle in steradians of each texel in row `y` of a latitude-longitude map.
pub(super) fn solid_angle(width: usize, height: usize, y: usize) -> f64 {
    let half = 0.5 * PI / height as f64;
    let cosines = 2.0 * half.sin() * ((2 * y + 1) as f64 * half).sin();
    2.0 * PI / width as f64 * cosines
}
