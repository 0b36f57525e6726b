//! Frames: which signed axes of a program point where zonal's point. A frame is a signed permutation of the axes, so that
//! it changes coefficients by one exact matrix a band (docs/MATH.md#frames).

use crate::math::exact::Exact;
use crate::math::tables::swap_yz;
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// A signed axis of a frame, as in −z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1 or 2: x, y or z.
    place: usize,
    negative: bool,
}

impl Axis {
    /// The axis +x.
    pub const X: Self = Self { place: 0, negative: false };
    /// The axis +y.
    pub const Y: Self = Self { place: 1, negative: false };
    /// The axis +z.
    pub const Z: Self = Self { place: 2, negative: false };

    /// Returns the opposite axis.
    #[must_use]
    pub const fn minus(self) -> Self {
        Self { place: self.place, negative: !self.negative }
    }

    /// Returns the component of a direction along it.
    pub fn of(self, direction: [f64; 3]) -> f64 {
        if self.negative { -direction[self.place] } else { direction[self.place] }
    }

    fn letter(self) -> char {
        ['x', 'y', 'z'][self.place]
    }
}

/// With its sign, as in `+x`.
impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", if self.negative { '-' } else { '+' }, self.letter())
    }
}

/// The axes of a frame that are zonal's x, y and z. With them a map has its centre along the first, what is left of the
/// centre along the second, and its top row along the third.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes([Axis; 3]);

/// Zonal's own.
impl Default for Axes {
    fn default() -> Self {
        Self([Axis::X, Axis::Y, Axis::Z])
    }
}

impl Axes {
    /// The axes to a map's centre, to the left of it and up, or none if they are not three different ones.
    pub const fn new(centre: Axis, left: Axis, up: Axis) -> Option<Self> {
        match centre.place == left.place || left.place == up.place || up.place == centre.place {
            true => None,
            false => Some(Self([centre, left, up])),
        }
    }

    /// Returns the axis along which the centre of a map lies.
    pub fn centre(self) -> Axis {
        self.0[0]
    }

    /// Returns the axis along which what is right of the centre of a map lies, seen from inside.
    pub fn right(self) -> Axis {
        self.0[1].minus()
    }

    /// Returns the axis along which the top row of a map lies.
    pub fn up(self) -> Axis {
        self.0[2]
    }

    /// Whether the frame is left-handed, so that it differs from zonal's by a reflection.
    pub fn is_left_handed(self) -> bool {
        let [a, b, c] = self.0.map(|axis| axis.place);
        let odd = (b + 3 - a) % 3 != 1 || (c + 3 - b) % 3 != 1;
        self.0.iter().filter(|axis| axis.negative).count() % 2 == usize::from(!odd)
    }

    /// Returns the direction in zonal's frame of one in this frame.
    pub fn to_zonal(self, direction: [f64; 3]) -> [f64; 3] {
        self.0.map(|axis| axis.of(direction))
    }

    /// Returns the direction in this frame of one in zonal's: the inverse of [`Axes::to_zonal`].
    pub fn from_zonal(self, direction: [f64; 3]) -> [f64; 3] {
        let mut turned = [0.0; 3];
        for (axis, value) in self.0.into_iter().zip(direction) {
            turned[axis.place] = if axis.negative { -value } else { value };
        }
        turned
    }

    /// The components that [`Axes::to_zonal`] and [`Axes::from_zonal`] take of a direction, as a vector in GLSL or HLSL
    /// without its type: `(n.x, -n.z, n.y)`.
    pub fn swizzles(self, name: &str) -> [String; 2] {
        let term = |axis: Axis| format!("{}{name}.{}", if axis.negative { "-" } else { "" }, axis.letter());
        let inverse = [0, 1, 2].map(|place| {
            let at = self.0.iter().position(|axis| axis.place == place).unwrap_or(place);
            Axis { place: at, negative: self.0[at].negative }
        });
        [self.0, inverse].map(|axes| format!("({})", axes.map(term).join(", ")))
    }

    /// Returns the entry [a, b] of D(M) in band `l`, M what [`Axes::to_zonal`] does: y(Mω) = D(M) y(ω). It is orthogonal, so
    /// that its transpose takes zonal's coefficients into this frame.
    pub fn entry(self, l: usize, a: isize, b: isize) -> Exact {
        let flips = self.0.map(|axis| axis.negative);
        let entry = match self.0.map(|axis| axis.place) {
            [0, 1, 2] => unit(a == b),
            [1, 0, 2] => {
                let (place, sign) = swapped_xy(a);
                if place == b { signed(Exact::one(), sign) } else { Exact::zero() }
            }
            [first, _, third] => {
                // Exchanges of x and y before and after the one of y and z: xy·yz is (z, x, y), yz·xy is (y, z, x).
                let (after, before) = (first == 2, third == 0);
                let (a, left) = if after { swapped_xy(a) } else { (a, false) };
                let (b, right) = if before { swapped_xy(b) } else { (b, false) };
                signed(swap_yz(l, a, b), left != right)
            }
        };
        signed(entry, is_flipped(l, a, flips))
    }
}

fn unit(is_one: bool) -> Exact {
    if is_one { Exact::one() } else { Exact::zero() }
}

fn signed(entry: Exact, negative: bool) -> Exact {
    if negative { -entry } else { entry }
}

/// The harmonic of the same band that one is when x and y are exchanged, and whether it changes its sign: the factor
/// (x + iy)^m becomes i^m (x − iy)^m.
fn swapped_xy(m: isize) -> (isize, bool) {
    match m.rem_euclid(4) {
        0 => (m, m < 0),
        2 => (m, m > 0),
        _ => (-m, m.unsigned_abs() % 4 == 3),
    }
}

/// Whether a harmonic changes its sign when the signs of some axes are turned (docs/MATH.md#conventions).
fn is_flipped(l: usize, m: isize, [x, y, z]: [bool; 3]) -> bool {
    let odd = m % 2 != 0;
    let flips = [x && ((m < 0) != odd), y && m < 0, z && (l.is_multiple_of(2) == odd)];
    flips.into_iter().fold(false, |all, flip| all != flip)
}

/// Three signed axes, as in `x,-z,y`: where a map's centre is, what is left of it, and up.
impl FromStr for Axes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let axis = |text: &str| {
            let (negative, letter) = match text.trim().split_at_checked(1) {
                Some(("-", rest)) => (true, rest),
                Some(("+", rest)) => (false, rest),
                _ => (false, text.trim()),
            };
            let place = ["x", "y", "z"].iter().position(|known| *known == letter)?;
            Some(Axis { place, negative })
        };
        let axes: Option<Vec<Axis>> = text.split(',').map(axis).collect();
        let different = match axes.as_deref() {
            Some(&[centre, left, up]) => Self::new(centre, left, up),
            _ => None,
        };
        different.ok_or_else(|| format!("`{text}` is not three axes"))
    }
}

/// As [`Axes::from_str`] reads them.
impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [centre, left, up] = self.0.map(|axis| axis.to_string().replace('+', ""));
        write!(f, "{centre},{left},{up}")
    }
}

impl Serialize for Axes {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::index::degrees;

    /// All 48 frames.
    fn all() -> Vec<Axes> {
        let axes = [Axis::X, Axis::Y, Axis::Z].into_iter().flat_map(|axis| [axis, axis.minus()]);
        let axes: Vec<Axis> = axes.collect();
        let pairs = axes.iter().flat_map(|&a| axes.iter().map(move |&b| (a, b)));
        pairs.flat_map(|(a, b)| axes.iter().filter_map(move |&c| Axes::new(a, b, c))).collect()
    }

    #[test]
    fn there_are_48_frames_half_of_them_left_handed() {
        let all = all();
        assert_eq!(all.len(), 48);
        for axes in &all {
            let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| axes.to_zonal(axis));
            let determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
                + c[0] * (a[1] * b[2] - a[2] * b[1]);
            assert_eq!(determinant < 0.0, axes.is_left_handed(), "{axes}");
            assert_eq!(axes.to_string().parse(), Ok(*axes));
            assert_eq!(axes.to_zonal(axes.from_zonal([1.0, 2.0, 3.0])), [1.0, 2.0, 3.0]);
        }
        assert_eq!(all.iter().filter(|axes| axes.is_left_handed()).count(), 24);
    }

    #[test]
    fn matrices_are_exact_and_orthogonal_and_band_1_is_the_frame_itself() {
        for axes in all() {
            for l in 0..6 {
                for (a, b) in degrees(l).flat_map(|a| degrees(l).map(move |b| (a, b))) {
                    let product: Exact = degrees(l).map(|c| axes.entry(l, a, c) * axes.entry(l, b, c)).sum();
                    assert_eq!(product, unit(a == b), "{axes}, band {l}: {a}, {b}");
                }
            }
            // Band 1 is (−y, z, −x).
            let band = |[x, y, z]: [f64; 3]| [-y, z, -x];
            let direction = [0.3, -0.5, 0.7];
            let values = band(direction);
            let turned = [-1, 0, 1].map(|a| {
                let terms = [-1, 0, 1].into_iter().zip(values).map(|(b, y)| axes.entry(1, a, b).to_f64() * y);
                terms.sum::<f64>()
            });
            assert_eq!(turned, band(axes.to_zonal(direction)), "{axes}");
        }
    }

    #[test]
    fn what_is_no_frame_is_refused() {
        for text in ["", "x", "x,y", "x,y,y", "x,y,-x", "x,y,z,x", "x;y;z", "--x,y,z", "x,y,w", "é,y,z"] {
            assert!(text.parse::<Axes>().is_err(), "{text}");
        }
        assert_eq!("x, +y, z".parse(), Ok(Axes::default()));
    }

    #[test]
    fn swizzles_are_what_the_functions_do() {
        let axes: Axes = "z,x,y".parse().expect("three axes");
        assert_eq!(axes.swizzles("n"), ["(n.z, n.x, n.y)", "(n.y, n.z, n.x)"]);
        assert_eq!(axes.from_zonal([1.0, 2.0, 3.0]), [2.0, 3.0, 1.0]);
    }
}
