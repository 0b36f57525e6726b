//! Zonal harmonic factorization (Nowrouzezahrai, Simari and Fiume, "Sparse Zonal Harmonic Factorization for Efficient
//! SH Rotation"): a band as a sum of 2l+1 rotated copies of its zonal harmonic, with few non-zeros in the change of basis
//! (docs/MATH.md#zonal-factorisation).
//!
//! For lobe directions ω_d let `Y[d][m] = y_l^m(ω_d)` and `Â = Y⁻¹`, rows m, columns d (the paper's equations 10 and
//! 11). A band's function is f(ω) = Σ_m c_m y_l^m(ω).
//!
//! * *Tailored to the signal*: the samples f(ω_d) are Y c, so c = Â f. A rotated function f(R⁻¹ω) has the samples
//!   f(R⁻¹ω_d), whence the rotated coefficients `c'_m = Σ_d Â[m][d] f(R⁻¹ω_d)`.
//! * *Standard*: with weights `z = Âᵀ c` is c = Yᵀ z, that is f(ω) = Σ_d z_d Σ_m y_l^m(ω_d) y_l^m(ω), a sum of zonal
//!   lobes about the ω_d. To rotate it is to rotate these: `c'_m = Σ_d z_d y_l^m(Rω_d)`. (The paper writes the lobes
//!   as y_l^0 turned to ω_d, its equations 7 to 9; a lobe here is √((2l+1)/4π) times that, and its equation 9 lacks
//!   the inverse of this factor.)
//!
//! One file: lobes, their sets and the records that they are read from.

use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::math::exact::{Exact, Real};
use crate::math::inverse::inverse;
use crate::math::linear::condition;
use crate::math::roots::squared_root;
use crate::math::tables::band_values;

/// The highest band whose roots may name a direction.
const HIGHEST_BAND: usize = 64;

/// The highest order, and the highest band of its own, that lobe sets are searched and kept for.
pub const HIGHEST_SIZE: usize = 10;

/// The largest condition number of a set that kernels use: rounding grows with it, and up to here less than it does on the
/// way from a quaternion to the lobes' basis values.
pub const LARGEST_CONDITION: f64 = 40.0;

/// A direction: the pole, a point of the equator, or one whose z is a root of an associated Legendre function, which is
/// what makes zeros in Y.
///
/// It is written `pole`, `equator 3/4` (at azimuth 3/4 π) or `P6,1#2 1/3`: z the second largest root above 0 of
/// P_6^1, at azimuth π/3.
///
/// ```
/// use zonal_codegen::{families::zhf::lobes::Lobe, math::exact::Exact};
/// let lobe: Lobe = "P2,0#1 1/4".parse()?;
/// assert_eq!(lobe.xyz(), [(); 3].map(|()| Exact::sqrt_ratio(1, 3)));
/// # Ok::<(), zonal_codegen::families::zhf::lobes::LobeError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lobe {
    height: Height,
    /// The azimuth in units of π, as numerator and denominator.
    azimuth: (i64, i64),
    z: Exact,
    sine: Exact,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Height {
    Pole,
    Equator,
    Root { l: usize, m: usize, rank: usize },
}

/// Why a text names no direction.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LobeError {
    /// Not of the form that [`Lobe`] describes.
    #[error("`{0}` is no lobe direction: expected `pole`, `equator 3/4` or `P6,1#2 1/3`")]
    Form(String),
    /// The Legendre function has fewer roots.
    #[error("`{0}` names a root that does not exist: P_l^m, l ≤ 64, has (l-m)/2 roots above 0, counted from 1")]
    Root(String),
}

impl Lobe {
    fn new(height: Height, azimuth: (i64, i64)) -> Self {
        let z = match height {
            Height::Pole => Exact::one(),
            Height::Equator => Exact::zero(),
            Height::Root { l, m, rank } => squared_root(l, m, rank).sqrt(),
        };
        let sine = (Exact::one() - &z * &z).sqrt();
        Self { height, azimuth, z, sine }
    }

    /// The unit vector: exact if the squared z is rational and the azimuth a multiple of 15°.
    pub fn xyz(&self) -> [Exact; 3] {
        let [x, y] = self.horizontal_power(1);
        [x, y, self.z.clone()]
    }

    /// The direction in words, for a comment.
    pub fn describe(&self) -> String {
        let height = match self.height {
            Height::Pole => return "the pole".into(),
            Height::Equator => "equator".into(),
            Height::Root { l, m, rank } => format!("z = root {rank} of P_{l}^{m}"),
        };
        let azimuth = match self.azimuth {
            (0, _) => "0".into(),
            (1, 1) => "π".into(),
            (1, d) => format!("π/{d}"),
            (n, 1) => format!("{n}π"),
            (n, d) => format!("{n}π/{d}"),
        };
        format!("{height}, azimuth {azimuth}")
    }

    /// The real and imaginary part of (x+iy)^m.
    fn horizontal_power(&self, m: usize) -> [Exact; 2] {
        let (n, d) = self.azimuth;
        let turns = n * m as i64;
        let size = power(&self.sine, m);
        [&size * Exact::cos_pi(turns, d), size * Exact::sin_pi(turns, d)]
    }
}

impl FromStr for Lobe {
    type Err = LobeError;

    fn from_str(text: &str) -> Result<Self, LobeError> {
        parse(text).ok_or_else(|| LobeError::Form(text.into())).and_then(|(height, azimuth)| match height {
            Height::Root { l, m, rank } if l > HIGHEST_BAND || rank == 0 || m + 2 * rank > l => {
                Err(LobeError::Root(text.into()))
            }
            _ => Ok(Self::new(height, azimuth)),
        })
    }
}

fn parse(text: &str) -> Option<(Height, (i64, i64))> {
    if text == "pole" {
        return Some((Height::Pole, (0, 1)));
    }
    let (height, azimuth) = text.split_once(' ')?;
    let (n, d) = azimuth.split_once('/').unwrap_or((azimuth, "1"));
    let azimuth = (n.parse::<i32>().ok()?.into(), d.parse::<u16>().ok().filter(|&d| d > 0)?.into());
    if height == "equator" {
        return Some((Height::Equator, azimuth));
    }
    let (l, rest) = height.strip_prefix('P')?.split_once(',')?;
    let (m, rank) = rest.split_once('#')?;
    let [l, m, rank] = [l, m, rank].map(|n| n.parse::<u8>().ok().map(usize::from));
    Some((Height::Root { l: l?, m: m?, rank: rank? }, azimuth))
}

impl fmt::Display for Lobe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.height {
            Height::Pole => return f.write_str("pole"),
            Height::Equator => f.write_str("equator")?,
            Height::Root { l, m, rank } => write!(f, "P{l},{m}#{rank}")?,
        }
        match self.azimuth {
            (n, 1) => write!(f, " {n}"),
            (n, d) => write!(f, " {n}/{d}"),
        }
    }
}

/// The lobe directions of an order, shared by its bands.
#[derive(Debug)]
pub struct LobeSet {
    /// The order: bands 0 to order-1.
    pub order: usize,
    /// The directions.
    pub directions: Vec<Lobe>,
    /// For each band l the indices of its 2l+1 directions.
    pub subsets: Vec<Vec<usize>>,
    change: Vec<OnceLock<Vec<Vec<Exact>>>>,
}

impl LobeSet {
    fn new(order: usize, directions: Vec<Lobe>, subsets: Vec<Vec<usize>>) -> Self {
        let change = subsets.iter().map(|_| OnceLock::new()).collect();
        Self { order, directions, subsets, change }
    }

    /// The directions of band `l`, in the order of its subset.
    pub fn lobes(&self, l: usize) -> Vec<Lobe> {
        self.subsets[l].iter().map(|&d| self.directions[d].clone()).collect()
    }

    /// Â of band `l`, as [`a_hat`] makes it; computed once.
    pub fn a_hat(&self, l: usize) -> &[Vec<Exact>] {
        self.change[l].get_or_init(|| {
            a_hat(l, &self.lobes(l))
                .unwrap_or_else(|| panic!("the lobes of order {}, band {l} are dependent", self.order))
        })
    }
}

/// The directions for an order of 2 to 10 that band l uses the first 2l+1 of.
pub fn shared(order: usize) -> Option<&'static LobeSet> {
    static SETS: Sets<LobeSet> = [const { OnceLock::new() }; HIGHEST_SIZE + 1];
    set_of(Mode::Nested, order, &SETS)
}

/// The directions for an order of 2 to 10 of which each band uses any 2l+1: Â is sparser than that of [`shared`].
pub fn shared_free(order: usize) -> Option<&'static LobeSet> {
    static SETS: Sets<LobeSet> = [const { OnceLock::new() }; HIGHEST_SIZE + 1];
    set_of(Mode::Free, order, &SETS)
}

/// The 2l+1 directions for a band `l` alone, 2 to 10, that make Â sparsest of all sets found.
pub fn single_band(l: usize) -> Option<&'static [Lobe]> {
    static SETS: Sets<Vec<Lobe>> = [const { OnceLock::new() }; HIGHEST_SIZE + 1];
    let read = || Some(chosen(Mode::Band, l)?.directions().expect("data/lobes.toml names directions"));
    SETS.get(l)?.get_or_init(read).as_deref()
}

/// `Y[d][m+l] = y_l^m(ω_d)`.
pub fn lobe_values(l: usize, lobes: &[Lobe]) -> Vec<Vec<Exact>> {
    lobes.iter().map(|lobe| band_values(l, &lobe.z, |m| lobe.horizontal_power(m))).collect()
}

/// `Â = Y⁻¹`, rows m, columns d, to 512 bits, its zeros exact; none if the lobes are dependent or not 2l+1.
pub fn a_hat(l: usize, lobes: &[Lobe]) -> Option<Vec<Vec<Exact>>> {
    let n = 2 * l + 1;
    if lobes.len() != n {
        return None;
    }
    let rows: Vec<Vec<Real>> =
        lobe_values(l, lobes).iter().map(|row| row.iter().map(Exact::to_real).collect()).collect();
    Some(inverse(&rows)?.into_iter().map(|row| row.into_iter().map(Exact::real).collect()).collect())
}

fn power(x: &Exact, n: usize) -> Exact {
    (0..n).fold(Exact::one(), |product, _| product * x)
}

/// How the bands of a lobe set share its directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// Band l of an order n takes the first 2l+1 of 2n−1 directions.
    Nested,
    /// Band l of an order n takes any 2l+1 of 2n−1 directions.
    Free,
    /// One band l with 2l+1 directions of its own.
    Band,
}

impl Mode {
    /// All of them with their names.
    pub const ALL: [(Self, &str); 3] = [(Self::Nested, "nested"), (Self::Free, "free"), (Self::Band, "band")];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(mode, _)| *mode == self).map_or("", |(_, name)| name)
    }

    /// The bands of a set of this size, which is an order or, for [`Mode::Band`], a band.
    pub fn bands(self, size: usize) -> std::ops::Range<usize> {
        match self {
            Self::Band => size..size + 1,
            _ => 0..size,
        }
    }
}

/// A lobe set as a search finds it and as `data/lobes.toml` holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// How its bands share directions.
    pub mode: Mode,
    /// The order; for [`Mode::Band`] the band.
    pub size: usize,
    /// The seed of the search that found it.
    pub seed: u32,
    /// Which try of that search found it.
    pub attempt: usize,
    /// The non-zeros of Â in each band.
    pub nonzeros: Vec<usize>,
    /// The largest condition number of any band's Y, to four decimals.
    pub condition: f64,
    /// The directions, as [`Lobe`] writes them.
    pub lobes: Vec<String>,
    /// For [`Mode::Free`] the indices of each band's directions; otherwise empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub subsets: Vec<Vec<usize>>,
}

/// Why a record is no lobe set.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RecordError {
    /// A text that names no direction.
    #[error(transparent)]
    Lobe(#[from] LobeError),
    /// The counts do not fit the size.
    #[error("the {mode} set of size {size} has {found}, expected {expected}", mode = mode.name())]
    Shape {
        /// How its bands share directions.
        mode: Mode,
        /// Its size.
        size: usize,
        /// What it holds.
        found: String,
        /// What it should.
        expected: String,
    },
    /// A band's directions are dependent.
    #[error("the lobes of band {0} are dependent")]
    Dependent(usize),
    /// An entry of Â that is neither zero nor far from it.
    #[error("an entry of Â of band {0} is below 2^-60 and no zero")]
    Undecided(usize),
}

impl Record {
    /// A set of these directions, its non-zeros and condition from exact numbers.
    ///
    /// # Errors
    ///
    /// If it is no lobe set.
    pub fn new(
        mode: Mode,
        size: usize,
        (seed, attempt): (u32, usize),
        lobes: Vec<String>,
        subsets: Vec<Vec<usize>>,
    ) -> Result<Self, RecordError> {
        let mut record = Self { mode, size, seed, attempt, nonzeros: vec![], condition: 0.0, lobes, subsets };
        (record.nonzeros, record.condition) = record.counted()?;
        Ok(record)
    }

    /// All non-zeros.
    pub fn total(&self) -> usize {
        self.nonzeros.iter().sum()
    }

    /// Each band with the indices of its directions.
    pub fn parts(&self) -> Vec<(usize, Vec<usize>)> {
        let prefix = |l: usize| (0..2 * l + 1).collect();
        let of = |l: usize| self.subsets.get(l).cloned().unwrap_or_else(|| prefix(l));
        self.mode.bands(self.size).map(|l| (l, of(l))).collect()
    }

    /// The non-zeros and the condition that the directions have, whatever the record says.
    ///
    /// # Errors
    ///
    /// If it is no lobe set.
    pub fn counted(&self) -> Result<(Vec<usize>, f64), RecordError> {
        let lobes = self.directions()?;
        let mut nonzeros = Vec::new();
        let mut largest = 0.0f64;
        for (l, members) in self.parts() {
            let lobes: Vec<Lobe> = members.iter().map(|&d| lobes[d].clone()).collect();
            let change = a_hat(l, &lobes).ok_or(RecordError::Dependent(l))?;
            let entries: Vec<f64> = change.iter().flatten().filter(|x| !x.is_zero()).map(Exact::to_f64).collect();
            // Less than 2^-60 and no zero to 512 bits: not to be told from an error.
            if entries.iter().any(|x| x.abs() < 2f64.powi(-60)) {
                return Err(RecordError::Undecided(l));
            }
            nonzeros.push(entries.len());
            largest = largest.max(band_condition(l, &lobes));
        }
        Ok((nonzeros, (largest * 1e4).round() / 1e4))
    }

    /// The directions, their number and that of the subsets checked.
    fn directions(&self) -> Result<Vec<Lobe>, RecordError> {
        let shape =
            |found: String, expected: String| RecordError::Shape { mode: self.mode, size: self.size, found, expected };
        let highest = match self.mode {
            Mode::Band => self.size,
            _ => self.size.max(1) - 1,
        };
        let count = 2 * highest + 1;
        if self.lobes.len() != count {
            return Err(shape(format!("{} directions", self.lobes.len()), count.to_string()));
        }
        let subsets = if self.mode == Mode::Free { self.size } else { 0 };
        if self.subsets.len() != subsets {
            return Err(shape(format!("{} subsets", self.subsets.len()), subsets.to_string()));
        }
        for (l, subset) in self.subsets.iter().enumerate() {
            if subset.len() != 2 * l + 1 || subset.iter().any(|&d| d >= count) {
                return Err(shape(format!("the subset {subset:?} for band {l}"), format!("{} indices", 2 * l + 1)));
            }
        }
        self.lobes.iter().map(|text| Ok(text.parse()?)).collect()
    }
}

/// The condition number of `Y` of band `l`: the quotient of its largest and its smallest singular value.
pub fn band_condition(l: usize, lobes: &[Lobe]) -> f64 {
    let values = lobe_values(l, lobes);
    condition(&values.iter().map(|row| row.iter().map(Exact::to_f64).collect()).collect::<Vec<_>>())
}

/// A file of lobe sets.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Records {
    /// The sets.
    #[serde(default)]
    pub set: Vec<Record>,
}

/// Every set that `data/lobes.toml` holds: for each mode and size those that no other beats in both non-zeros and
/// condition.
pub fn records() -> &'static [Record] {
    static RECORDS: OnceLock<Records> = OnceLock::new();
    let read = || toml::from_str(include_str!("../../../data/lobes.toml")).expect("data/lobes.toml is as declared");
    &RECORDS.get_or_init(read).set
}

/// The set that kernels use: the sparsest whose condition is at most [`LARGEST_CONDITION`], the better conditioned of two
/// that are equally sparse.
pub fn chosen(mode: Mode, size: usize) -> Option<&'static Record> {
    let fits = |record: &&Record| record.mode == mode && record.size == size && record.condition <= LARGEST_CONDITION;
    records().iter().filter(fits).min_by(|a, b| a.total().cmp(&b.total()).then(a.condition.total_cmp(&b.condition)))
}

/// One cell a size, filled when it is first asked for.
type Sets<T> = [OnceLock<Option<T>>; HIGHEST_SIZE + 1];

fn set_of(mode: Mode, order: usize, sets: &'static Sets<LobeSet>) -> Option<&'static LobeSet> {
    let read = || {
        let record = chosen(mode, order)?;
        let lobes = record.directions().expect("data/lobes.toml names directions");
        Some(LobeSet::new(order, lobes, record.parts().into_iter().map(|(_, members)| members).collect()))
    };
    sets.get(order)?.get_or_init(read).as_ref()
}
