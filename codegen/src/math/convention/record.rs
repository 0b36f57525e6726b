//! The record of a convention, and the exact matrices by which coefficients become those of another and back
//! (docs/MATH.md#frames).

use super::axes::Axes;
use crate::math::exact::Exact;
use crate::math::index::{band_degree, degrees, index};
use serde::Serialize;

/// What a coefficient is, besides its sign, of what zonal's orthonormal basis has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// That of an orthonormal basis.
    Orthonormal,
    /// Times the constant of its harmonic, so that the program multiplies 1, y, z, x, xy, yz, 3z² − 1, zx and x² − y².
    Folded,
    /// SN3D, as ambisonics have it: times √(4π / (2l + 1)). A source of strength 1 has 1 at the first place.
    Schmidt,
}

/// Where the coefficients of a band lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// At l (l + 1) + m, as zonal has them.
    Acn,
    /// 1; x, y, z; xz, zy, yx, 3z² − 1, x² − y²: up to order 3.
    ByPolynomial,
}

/// What a program reads its coefficients as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// Radiance, or any function on the sphere.
    Any,
    /// Irradiance alone: it multiplies no cosine factors.
    Irradiance,
}

/// How a program holds coefficients. What it evaluates at a direction of its own frame is what zonal evaluates at the
/// same direction in zonal's frame, over π where `over_pi` says so.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Convention {
    /// What it is called, as in `three_js`.
    pub name: &'static str,
    /// The program or the format, and what of it.
    #[serde(skip)]
    pub title: &'static str,
    /// Where the program says so.
    #[serde(skip)]
    pub source: &'static str,
    /// Its axes that are zonal's x, y and z.
    pub axes: Axes,
    /// Whether its basis has the Condon-Shortley phase (−1)^m, as zonal's has.
    #[serde(skip)]
    pub phase: bool,
    /// Its factors.
    #[serde(skip)]
    pub scale: Scale,
    /// Whether its coefficients are those over π: of what a white diffuse surface sends out, if they are of irradiance.
    #[serde(skip)]
    pub over_pi: bool,
    /// Its indices.
    #[serde(skip)]
    pub places: Places,
    /// What they are of.
    #[serde(skip)]
    pub holds: Holds,
    /// The most bands that it takes.
    #[serde(skip)]
    pub max_order: usize,
    /// What is done there with the coefficients, as code or in words.
    #[serde(skip)]
    pub there: &'static str,
}

impl Convention {
    /// Returns where the coefficient of band `l`, degree `m` lies.
    pub fn place(&self, l: usize, m: isize) -> usize {
        match (self.places, l, m) {
            (Places::ByPolynomial, 1, -1) => 2,
            (Places::ByPolynomial, 1, 0) => 3,
            (Places::ByPolynomial, 1, 1) => 1,
            (Places::ByPolynomial, 2, -2) => 6,
            (Places::ByPolynomial, 2, 0) => 7,
            (Places::ByPolynomial, 2, 1) => 4,
            _ => index(l, m),
        }
    }

    /// Returns what the coefficient of band `l`, degree `m` is multiplied by once it is in the frame of the convention.
    pub fn factor(&self, l: usize, m: isize) -> Exact {
        let scale = match self.scale {
            Scale::Orthonormal => Exact::one(),
            Scale::Folded => folded(l, m),
            Scale::Schmidt => Exact::sqrt_ratio(4, 2 * l + 1) * Exact::pi_sqrt_power(1),
        };
        let scale = if self.over_pi { scale * Exact::pi_sqrt_power(-2) } else { scale };
        if self.phase || m % 2 == 0 { scale } else { -scale }
    }

    /// The matrix of band `l`, exactly: the rows by the degree of what the convention has, the columns by that of what
    /// zonal has.
    pub fn to_matrix(&self, l: usize) -> Vec<Vec<Exact>> {
        let row = |a| degrees(l).map(|b| self.factor(l, a) * self.axes.entry(l, b, a)).collect();
        degrees(l).map(row).collect()
    }

    /// The inverse of [`Convention::to_matrix`]: the rows by zonal's degree.
    pub fn from_matrix(&self, l: usize) -> Vec<Vec<Exact>> {
        let row = |a| degrees(l).map(|b| self.axes.entry(l, a, b) / self.factor(l, b)).collect();
        degrees(l).map(row).collect()
    }

    /// Returns zonal's coefficients as the convention has them: whole bands from band 0 on, `N` channels each.
    ///
    /// # Panics
    ///
    /// If there are not n² of them, or n is above `max_order`.
    pub fn convert_to<const N: usize>(&self, coefficients: &[[f64; N]]) -> Vec<[f64; N]> {
        if self.has_own_basis() && self.axes == Axes::default() {
            return coefficients.to_vec();
        }
        self.converted(coefficients, |l| self.to_matrix(l), |place| self.there(place), |place| place)
    }

    /// Returns the convention's coefficients as zonal has them: the inverse of [`Convention::convert_to`].
    ///
    /// # Panics
    ///
    /// As [`Convention::convert_to`].
    pub fn convert_from<const N: usize>(&self, coefficients: &[[f64; N]]) -> Vec<[f64; N]> {
        if self.has_own_basis() && self.axes == Axes::default() {
            return coefficients.to_vec();
        }
        self.converted(coefficients, |l| self.from_matrix(l), |place| place, |place| self.there(place))
    }

    /// Where the convention has what zonal has at a place.
    fn there(&self, place: usize) -> usize {
        let (l, m) = band_degree(place);
        self.place(l, m)
    }

    /// The coefficients times the matrix of each band, whose rows and columns are zonal's places, wherever they stand.
    fn converted<const N: usize>(
        &self,
        coefficients: &[[f64; N]],
        matrix: impl Fn(usize) -> Vec<Vec<Exact>>,
        to: impl Fn(usize) -> usize,
        from: impl Fn(usize) -> usize,
    ) -> Vec<[f64; N]> {
        let (count, order) = (coefficients.len(), coefficients.len().isqrt());
        assert!(order * order == count, "{count} coefficients are no whole bands");
        assert!(order <= self.max_order, "{} takes {} bands, not {order}", self.name, self.max_order);
        let mut converted = vec![[0.0; N]; count];
        for l in 0..order {
            for (row, entries) in matrix(l).into_iter().enumerate() {
                for (column, entry) in entries.into_iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                    let (entry, value) = (entry.to_f64(), coefficients[from(l * l + column)]);
                    let sums = &mut converted[to(l * l + row)];
                    (0..N).for_each(|channel| sums[channel] += entry * value[channel]);
                }
            }
        }
        converted
    }

    /// Whether it has zonal's signs, factors and indices, so that zonal's kernels take its coefficients and its directions
    /// as they are.
    pub fn has_own_basis(&self) -> bool {
        self.phase && self.scale == Scale::Orthonormal && !self.over_pi && self.places == Places::Acn
    }

    /// Returns the frame in words: "y up, the map's centre along +x, +z to its right".
    pub fn frame(&self) -> String {
        let [up, centre, right] = [self.axes.up(), self.axes.centre(), self.axes.right()];
        format!("{} up, the map's centre along {centre}, {right} to its right", up.to_string().replace('+', ""))
    }

    /// Returns how coefficients differ from zonal's but for the frame, in words; nothing if they do not.
    pub fn differences(&self) -> String {
        let words = [
            (!self.phase, "without the sign (-1)^m"),
            (self.scale == Scale::Folded, "times the constants of the basis"),
            (self.scale == Scale::Schmidt, "times sqrt(4 pi / (2l + 1)), which is SN3D"),
            (self.over_pi, "over pi"),
            (self.places == Places::ByPolynomial, "in the order 1, x, y, z, xz, zy, yx, 3zz - 1, xx - yy"),
        ];
        words.iter().filter(|(holds, _)| *holds).map(|(_, words)| *words).collect::<Vec<_>>().join(", ")
    }

    /// Returns the axes and what else a reader of coefficients has to know, as one sentence without its stop.
    pub fn sentence(&self) -> String {
        let (frame, differences) = (self.frame(), self.differences());
        match differences.is_empty() {
            true => frame,
            false => format!("{frame}; as `{}` takes them: {differences}; no kernel of zonal does", self.name),
        }
    }
}

/// The constant of a harmonic of the first three bands before its polynomial.
fn folded(l: usize, m: isize) -> Exact {
    let (p, q) = match (l, m) {
        (0, _) => (1, 4),
        (1, _) => (3, 4),
        (_, 0) => (5, 16),
        (_, 2) => (15, 16),
        _ => (15, 4),
    };
    Exact::sqrt_ratio(p, q) * Exact::pi_sqrt_power(-1)
}
