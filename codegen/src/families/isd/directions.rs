//! Directions of isotropic decomposition: sets as data, of the rotated zonal harmonics that share them and of other mother
//! functions whose levels do not, and the matrices M and M⁻¹ that shared ones make (docs/MATH.md#isotropic-decomposition).

use crate::families::isd::mother::{Decomposition, Levels, Mother};
use crate::math::exact::{Exact, Real};
use crate::math::inverse::inverse;
use crate::math::linear::condition;
use crate::math::tables::band_values;
use num_rational::BigRational;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// The most bands above 0 that a set is searched and kept for.
pub const HIGHEST_BAND: usize = 19;
/// The most bands above 0 that a set of other mother functions is searched and kept for.
pub const HIGHEST_OWN: usize = 10;

/// A set of directions as a search finds it and as `data/directions.toml` holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The highest band; band l uses the first 2l + 1 directions, or, of other mother functions, the 2l + 1 from l² on.
    pub bands: usize,
    /// The mother functions; harmonics, which share directions, if it is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mother: Option<Mother>,
    /// The seed of the search that found it, if the search of this program did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// How many tries that search took.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tries: Option<usize>,
    /// The largest condition number of any band's M, or that of the whole M of other mother functions, to four decimals.
    pub condition: f64,
    /// The directions, which need not be of unit length.
    pub directions: Vec<[f64; 3]>,
}

/// A file of sets.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Records {
    /// The sets.
    #[serde(default)]
    pub set: Vec<Record>,
}

impl Records {
    /// Reads a file of sets.
    ///
    /// # Errors
    ///
    /// If it holds none, or one that is no set of its bands, or whose condition is another one.
    pub fn read(text: &str) -> Result<Self, String> {
        let records: Self = toml::from_str(text).map_err(|error| error.message().to_owned())?;
        for record in &records.set {
            let counted = record.counted()?;
            if (counted - record.condition).abs() > 1e-4 * (1.0 + counted) {
                let (bands, said) = (record.bands, record.condition);
                return Err(format!("the set of {bands} bands has the condition {counted:.4}, not {said}"));
            }
        }
        Ok(records)
    }
}

impl Record {
    /// Returns the largest condition number of any band's M.
    ///
    /// # Errors
    ///
    /// If the number of bands or of directions is wrong, or a direction has no length.
    pub fn counted(&self) -> Result<f64, String> {
        let (bands, count) = (self.bands, self.directions.len());
        let most = self.mother.map_or(HIGHEST_BAND, |_| HIGHEST_OWN);
        if !(1..=most).contains(&bands) {
            return Err(format!("a set of {bands} bands: there are sets of 1 to {most}"));
        }
        let wanted = self.mother.map_or(2 * bands + 1, |_| (bands + 1) * (bands + 1));
        if count != wanted {
            return Err(format!("the set of {bands} bands has {count} directions, not {wanted}"));
        }
        let length = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if let Some(at) = self.directions.iter().position(|v| !(1e-6..=1e6).contains(&length(v))) {
            return Err(format!("direction {at} of the set of {bands} bands has no length that can be told"));
        }
        let unit: Vec<[f64; 3]> = self.directions.iter().map(|v| v.map(|x| x / length(v))).collect();
        if let Some(mother) = self.mother {
            return Ok(Decomposition::measured(mother, &Levels::own(bands, &unit)?).condition);
        }
        let of = |l: usize| condition(&gram(l, &unit[..2 * l + 1])).sqrt();
        Ok((1..=bands).map(of).fold(1.0, f64::max))
    }
}

/// P_l of the cosines between directions of unit length, which is MᵀM of band l.
pub fn gram(l: usize, directions: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let cosine = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let row = |a: &[f64; 3]| directions.iter().map(|b| legendre(l, cosine(a, b))[0]).collect();
    directions.iter().map(row).collect()
}

/// Returns P_l(x) and its derivative.
pub fn legendre(l: usize, x: f64) -> [f64; 2] {
    let (mut before, mut value) = (0.0, 1.0);
    let (mut slope_before, mut slope) = (0.0, 0.0);
    for k in 0..l {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
        // P'_(k+1) = P'_(k−1) + (2k + 1) P_k.
        (slope_before, slope) = (slope, slope_before + (2.0 * k + 1.0) * before);
    }
    [value, slope]
}

/// Every set that `data/directions.toml` holds.
pub fn kept() -> &'static [Record] {
    static RECORDS: OnceLock<Records> = OnceLock::new();
    let read =
        || toml::from_str(include_str!("../../../data/directions.toml")).expect("data/directions.toml is as declared");
    &RECORDS.get_or_init(read).set
}

/// Returns the best kept set of so many bands that rotated zonal harmonics share.
pub fn best(bands: usize) -> Option<&'static Record> {
    best_of(None, bands)
}

/// Returns the best kept set of so many bands of mother functions, shared if there are none.
pub fn best_of(mother: Option<Mother>, bands: usize) -> Option<&'static Record> {
    let fits = kept().iter().filter(|record| (record.mother, record.bands) == (mother, bands));
    fits.min_by(|a, b| a.condition.total_cmp(&b.condition))
}

/// The directions of an order, exact, with the matrices that they make.
#[derive(Debug)]
pub struct Shared {
    /// The directions, of unit length to 512 bits.
    pub directions: Vec<[Exact; 3]>,
    inverses: Vec<OnceLock<Vec<Vec<Exact>>>>,
}

/// Returns the directions of an order; none if no set is kept of its bands.
pub fn shared(order: usize) -> Option<&'static Shared> {
    static SETS: [OnceLock<Option<Shared>>; HIGHEST_BAND + 2] = [const { OnceLock::new() }; HIGHEST_BAND + 2];
    let read = || {
        let record = best(order.checked_sub(1)?)?;
        let directions = record.directions.iter().map(|v| exact_unit(*v)).collect::<Option<Vec<_>>>()?;
        Some(Shared { directions, inverses: (0..order).map(|_| OnceLock::new()).collect() })
    };
    SETS.get(order)?.get_or_init(read).as_ref()
}

pub(super) fn exact_unit(v: [f64; 3]) -> Option<[Exact; 3]> {
    let real = |x: f64| BigRational::from_float(x).map(|x| Real::from_ratio(x.numer().clone(), x.denom().clone()));
    let [x, y, z] = [real(v[0])?, real(v[1])?, real(v[2])?];
    let square = &x * &x + &y * &y + &z * &z;
    let length = square.sqrt();
    Some([x, y, z].map(|x| Exact::real(&x / &length)))
}

impl Shared {
    /// Returns M of a band: row k + l and column j hold π_l y_l^k(z^j), π_l = √(4π / (2l + 1)).
    pub fn matrix(&self, l: usize) -> Vec<Vec<Exact>> {
        let factor = Exact::sqrt_ratio(4, 2 * l as i64 + 1) * Exact::pi_sqrt_power(1);
        let columns: Vec<Vec<Exact>> = self.directions[..2 * l + 1].iter().map(|v| values(l, v)).collect();
        (0..2 * l + 1).map(|k| columns.iter().map(|column| &factor * &column[k]).collect()).collect()
    }

    /// Returns M⁻¹ of a band, to 512 bits.
    ///
    /// # Panics
    ///
    /// If it has none: kept sets have one.
    pub fn inverse(&self, l: usize) -> &[Vec<Exact>] {
        self.inverses[l].get_or_init(|| {
            let rows: Vec<Vec<Real>> =
                self.matrix(l).iter().map(|row| row.iter().map(Exact::to_real).collect()).collect();
            let inverse = inverse(&rows).expect("the directions of a kept set are independent");
            inverse.into_iter().map(|row| row.into_iter().map(Exact::real).collect()).collect()
        })
    }
}

/// y_l^m for m from −l to l.
pub(super) fn values(l: usize, [x, y, z]: &[Exact; 3]) -> Vec<Exact> {
    let mut powers = vec![[Exact::one(), Exact::zero()]];
    for _ in 0..l {
        let [re, im] = powers.last().expect("begins with one");
        powers.push([re * x - im * y, re * y + im * x]);
    }
    band_values(l, z, |m| powers[m].clone())
}
