//! The bands of a light as cubemaps, f_l(ω) = Σ_m c_lm y_l^m(ω), each on the smallest faces that keep an error of bilinear
//! reads (docs/MATH.md#band-tables). The texels of a face's rim lie on the cube's edges, where its neighbours have the same
//! ones, so that no read reaches over an edge. It knows neither kernels nor files.

use super::cube;
use super::error::MAX_SIDE;
use super::harmonics::basis;
use super::project::Projection;
use crate::fault::Fault;
use crate::math::half::Half;
use crate::threads;

/// The most bands that tables are made of.
pub const MAX_BANDS: usize = 32;
/// The least and the largest error that may be asked for, relative to a band's largest value.
pub const ERRORS: [f64; 2] = [1e-5, 0.5];
/// How many cells of a table its error is measured in, spread evenly over all; of fewer in each.
const CELLS: usize = 20_000;
/// In how many parts they are measured, a thread each at most.
const PARTS: usize = 16;

/// What a texel's numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texel {
    /// IEEE binary16.
    Half,
    /// IEEE binary32.
    Float,
}

impl Texel {
    /// Returns the bytes of three channels.
    pub fn bytes(self) -> usize {
        match self {
            Self::Half => 6,
            Self::Float => 12,
        }
    }

    /// Returns a number as a texel holds it.
    pub fn round(self, value: f64) -> f64 {
        match self {
            Self::Half => Half::round(value).to_f64(),
            Self::Float => f64::from(value as f32),
        }
    }

    /// By how much numbers up to `largest` may be rounded, relative to it: half a unit of the last place of the largest, and
    /// of the smallest that there is.
    fn roundoff(self, largest: f64) -> f64 {
        match self {
            Self::Half => 2f64.powi(-11) + 2f64.powi(-25) / largest,
            Self::Float => 2f64.powi(-24),
        }
    }
}

/// A band of a light as a cubemap, for R, G and B.
#[derive(Clone, Debug, PartialEq)]
pub struct BandTable {
    /// The band.
    pub band: usize,
    /// The texels along a side of a face: the first and the last lie on the face's rim; one texel is the face's middle.
    pub side: usize,
    /// The six faces in the order of [`FACES`](super::FACES), each row by row from the top.
    pub texels: Vec<[f64; 3]>,
    /// What the numbers were rounded to.
    pub texel: Texel,
    /// The band's largest value of all directions and channels, without its sign.
    pub largest: f64,
    /// By how much a read errs at most, relative to the largest value: measured in the middles of cells and of their sides.
    pub error: f64,
}

/// A place of a texel across a face, from −1 to 1.
fn place(i: usize, side: usize) -> f64 {
    if side == 1 { 0.0 } else { (2 * i) as f64 / (side - 1) as f64 - 1.0 }
}

/// Returns the angle between neighbouring texels in the middle of a face, where it is largest, in radians.
pub fn step(side: usize) -> f64 {
    2.0 / (side.max(2) - 1) as f64
}

/// Returns the side for which the bound l² h² / 4 of a bilinear read of band l, with texels h apart, is `error`.
pub fn bound_side(band: usize, error: f64) -> usize {
    if band == 0 { 1 } else { 1 + (band as f64 / error.sqrt()).ceil() as usize }
}

/// A band, and room to evaluate it.
struct Band<'a> {
    l: usize,
    coefficients: &'a [[f64; 3]],
    values: Vec<f64>,
}

impl<'a> Band<'a> {
    fn new(light: &'a Projection, l: usize) -> Self {
        let coefficients = &light.coefficients[l * l..(l + 1) * (l + 1)];
        Self { l, coefficients, values: vec![0.0; (l + 1) * (l + 1)] }
    }

    fn at(&mut self, direction: [f64; 3]) -> [f64; 3] {
        basis(self.l + 1, direction, &mut self.values);
        let mut sum = [0.0; 3];
        for (c, y) in self.coefficients.iter().zip(&self.values[self.l * self.l..]) {
            (0..3).for_each(|channel| sum[channel] += c[channel] * y);
        }
        sum
    }
}

/// The bilinear mean of four corners: left above, right above, left below, right below.
fn mixed(corners: [[f64; 3]; 4], [right, down]: [f64; 2]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let [a, b, c, d] = corners.map(|corner| corner[k]);
        (a + right * (b - a)) * (1.0 - down) + (c + right * (d - c)) * down
    })
}

fn largest_of(values: impl Iterator<Item = [f64; 3]>) -> f64 {
    values.flatten().fold(0.0, |most, value| value.abs().max(most))
}

impl Projection {
    /// Returns the value of one band in a direction of length 1.
    ///
    /// # Panics
    ///
    /// If the band is not below the order.
    pub fn band(&self, band: usize, direction: [f64; 3]) -> [f64; 3] {
        Band::new(self, band).at(direction)
    }

    /// The largest value of a band, by places so near that a maximum between them is at most 2 % larger.
    fn largest(&self, l: usize) -> f64 {
        let side = 6 * l + 2;
        let row = |row: usize| {
            let mut band = Band::new(self, l);
            let (face, v) = (row / side, place(row % side, side));
            largest_of((0..side).map(|x| band.at(cube::towards(face, place(x, side), v).0)))
        };
        threads::map(0..6 * side, row).into_iter().fold(0.0, f64::max)
    }

    /// Returns by how much a bilinear read of a band's table with faces of `side` texels errs at most, relative to `largest`,
    /// measured in the middles of cells and of two of their sides; of many cells in 20,000 that are spread evenly. The table
    /// itself is not made.
    ///
    /// # Panics
    ///
    /// If the band is not below the order.
    pub fn read_error(&self, band: usize, side: usize, texel: Texel, largest: f64) -> f64 {
        let cells = side.max(2) - 1;
        let all = 6 * cells * cells;
        // Odd, so that rows do not repeat.
        let stride = all.div_ceil(CELLS) | 1;
        let part = |first: usize| {
            let mut own = Band::new(self, band);
            let mut worst = 0f64;
            for cell in (first..all).step_by(stride * PARTS) {
                let (face, x, y) = (cell / (cells * cells), cell % cells, cell / cells % cells);
                let mut at = |right: f64, down: f64| {
                    let place = |i: usize, part: f64| (2.0 * (i as f64 + part)) / cells as f64 - 1.0;
                    own.at(cube::towards(face, place(x, right), place(y, down)).0)
                };
                let middle = |face: usize| cube::towards(face, 0.0, 0.0).0;
                let corners = match side {
                    1 => [Band::new(self, band).at(middle(face)); 4],
                    _ => [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)],
                };
                let corners = corners.map(|corner| corner.map(|value| texel.round(value)));
                for [right, down] in [[0.5, 0.5], [0.5, 0.0], [0.0, 0.5]] {
                    let (read, want) = (mixed(corners, [right, down]), at(right, down));
                    worst = worst.max(largest_of(std::iter::once([0, 1, 2].map(|k| read[k] - want[k]))));
                }
            }
            worst
        };
        let starts = (0..PARTS).map(|i| i * stride);
        threads::map(starts, part).into_iter().fold(0.0, f64::max) / largest
    }

    /// Returns a band's table with faces of a side.
    ///
    /// # Panics
    ///
    /// If the band is not below the order, or the side is 0.
    pub fn band_table_of(&self, band: usize, side: usize, texel: Texel) -> BandTable {
        let largest = self.largest(band);
        let error = if largest > 0.0 { self.read_error(band, side, texel, largest) } else { 0.0 };
        let row = |row: usize| -> Vec<[f64; 3]> {
            let mut own = Band::new(self, band);
            let (face, v) = (row / side, place(row % side, side));
            let texels = (0..side).map(|x| own.at(cube::towards(face, place(x, side), v).0));
            texels.map(|value| value.map(|v| texel.round(v))).collect()
        };
        BandTable { band, side, texels: threads::map(0..6 * side, row).concat(), texel, largest, error }
    }

    /// Returns a band's table with the smallest faces in which a bilinear read errs by at most `error` of the band's largest
    /// value, as [`Projection::read_error`] measures it: faces of one texel less do not. A band that is zero, as the odd ones of
    /// irradiance are, has one texel.
    ///
    /// # Errors
    ///
    /// If the texels' rounding alone errs by more, a value is beyond them, or faces would be larger than
    /// [`MAX_SIDE`].
    ///
    /// # Panics
    ///
    /// If the band is not below the order.
    pub fn band_table(&self, band: usize, error: f64, texel: Texel) -> Result<BandTable, Fault> {
        let largest = self.largest(band);
        if largest == 0.0 || band == 0 {
            return Ok(self.band_table_of(band, 1, texel));
        }
        let wider = "take floats instead of halves";
        if texel == Texel::Half && largest > 0.99 * Half::MAX {
            let message = format!("band {band} reaches {largest:.3e}, beyond the {} of half precision", Half::MAX);
            return Err(Fault::new(message, wider));
        }
        let rounding = texel.roundoff(largest);
        if rounding >= error {
            let message = format!(
                "band {band} errs by {rounding:.1e} of its largest value where its texels are rounded, as much as the {error:e} that are asked for"
            );
            return Err(Fault::new(message, format!("ask for a larger error, or {wider}")));
        }
        let measured = |side: usize| self.read_error(band, side, texel, largest);
        let bound = bound_side(band, error);
        // The error falls as the square of the side.
        let first = measured(bound.min(MAX_SIDE));
        let mut side = (1.0 + (bound - 1) as f64 * (first / error).sqrt()).ceil().clamp(2.0, MAX_SIDE as f64) as usize;
        while measured(side) > error {
            side += 1;
            if side > MAX_SIDE {
                let message = format!(
                    "band {band} takes faces of some {bound} texels a side for an error of {error:e}, more than {MAX_SIDE}"
                );
                return Err(Fault::new(message, "ask for a larger error, or for fewer bands"));
            }
        }
        while side > 2 && measured(side - 1) <= error {
            side -= 1;
        }
        Ok(self.band_table_of(band, side, texel))
    }
}

impl BandTable {
    /// Returns the bytes of its texels.
    pub fn bytes(&self) -> usize {
        self.texels.len() * self.texel.bytes()
    }

    /// Returns what is read in a direction, whose length does not matter: the bilinear mean of the four texels around it.
    pub fn read(&self, direction: [f64; 3]) -> [f64; 3] {
        let last = self.side - 1;
        let (face, place) = cube::locate(direction);
        let at = place.map(|value| (0.5 * (value + 1.0) * last as f64).clamp(0.0, last as f64));
        let [x, y] = at.map(|value| (value as usize).min(last.saturating_sub(1)));
        let texel = |x: usize, y: usize| self.texels[(face * self.side + y.min(last)) * self.side + x.min(last)];
        let corners = [texel(x, y), texel(x + 1, y), texel(x, y + 1), texel(x + 1, y + 1)];
        mixed(corners, [at[0] - x as f64, at[1] - y as f64])
    }

    /// Returns the six faces beside each other, from left to right, row by row from the top: [`Layout::HorizontalStrip`](super::Layout).
    pub fn strip(&self) -> Vec<[f64; 3]> {
        let texel = |i: usize| {
            let (x, y) = (i % (6 * self.side), i / (6 * self.side));
            self.texels[(x / self.side * self.side + y) * self.side + x % self.side]
        };
        (0..self.texels.len()).map(texel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::promise::samples::Random;

    fn light(order: usize) -> Projection {
        let mut random = Random::new(11);
        let coefficients = (0..order * order).map(|_| [(); 3].map(|()| random.signed())).collect();
        Projection { order, coefficients, beyond: 0.0 }
    }

    #[test]
    fn a_read_is_within_the_error_that_was_asked_for_and_no_smaller_side_is() {
        let light = light(7);
        let mut random = Random::new(12);
        for (error, texel) in [(0.05, Texel::Half), (0.01, Texel::Half), (0.003, Texel::Float)] {
            for band in 0..7 {
                let table = light.band_table(band, error, texel).unwrap_or_else(|error| panic!("{error}"));
                assert!(table.error <= error && table.texels.len() == 6 * table.side * table.side);
                // The bound is one of the second order: where steps are long beside a wave, curvature adds to it.
                assert!(table.side <= 1 + (1.3 * bound_side(band, error) as f64) as usize, "{band} {error}");
                if band > 0 {
                    assert!(light.read_error(band, table.side - 1, texel, table.largest) > error, "{band} {error}");
                }
                let mut worst = 0f64;
                for _ in 0..4000 {
                    let direction = random.unit::<3>();
                    let (read, want) = (table.read(direction), light.band(band, direction));
                    worst = worst.max(largest_of(std::iter::once([0, 1, 2].map(|k| read[k] - want[k]))));
                }
                // Between the middles a read errs by a little more: a tenth is ample.
                assert!(worst <= 1.1 * error * table.largest, "{band} {error}: {worst}");
                assert!(band == 0 || worst > 0.3 * error * table.largest, "{band} {error}: {worst}");
            }
        }
    }

    #[test]
    fn reads_are_continuous_over_edges_and_corners() {
        let table = light(5).band_table(4, 0.05, Texel::Float).expect("it fits");
        for corner in [[1.0, 1.0, 0.3], [1.0, -0.2, 1.0], [-0.7, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]] {
            let near = |sign: [f64; 3]| table.read([0, 1, 2].map(|i| corner[i] + 1e-9 * sign[i]));
            let first = near([1.0, 0.0, 0.0]);
            for sign in [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]] {
                let other = near(sign);
                // A step of 1e-9 changes band 4 by a few times that.
                assert!((0..3).all(|k| (first[k] - other[k]).abs() < 1e-7), "{corner:?}: {first:?} {other:?}");
            }
        }
    }

    #[test]
    fn what_no_table_holds_is_refused_with_its_figure() {
        let mut light = light(4);
        let refused = |light: &Projection, error: f64, texel: Texel| {
            light.band_table(3, error, texel).expect_err("it cannot be").to_string()
        };
        let fine = refused(&light, 4e-4, Texel::Half);
        assert!(fine.contains("4.9e-4") && fine.contains("floats"), "{fine}");
        assert!(refused(&light, 1e-6, Texel::Float).contains("3001 texels"));
        light.coefficients.iter_mut().flatten().for_each(|c| *c *= 1e6);
        assert!(refused(&light, 0.01, Texel::Half).contains("65504"));
        assert!(light.band_table(3, 0.01, Texel::Float).is_ok());
        light.coefficients.iter_mut().flatten().for_each(|c| *c = 0.0);
        let table = light.band_table(3, 0.01, Texel::Half).expect("nothing takes no room");
        assert_eq!((table.side, table.error, table.read([0.0, 0.6, 0.8])), (1, 0.0, [0.0; 3]));
        // What is no direction has no value, and is no reason to stop.
        assert!(light.band_table_of(3, 4, Texel::Half).read([f64::NAN; 3])[0].is_nan());
    }
}
