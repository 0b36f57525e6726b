//! Mother functions: the functions of the angle from an axis of which turned copies make up a reflectance, one a level, and the
//! matrix M that takes the copies' weights to coefficients (docs/MATH.md#mother-functions). It computes in f64, and refuses
//! copies whose M cannot be inverted in any precision that a shader has.

use crate::environment::harmonics::basis;
use crate::math::index::coefficients;
use crate::math::linear::condition;
use crate::math::quadrature::gauss_legendre;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The largest condition number that is not refused: f32, whose roundoff is 6e-8, keeps one digit there.
pub const HOPELESS: f64 = 1e6;

/// A profile of mother functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mother {
    /// y_l^0, of which `isd_weights` makes its weights.
    Harmonic,
    /// P_l.
    Legendre,
    /// exp(−(1 − z) l²).
    Gaussian,
    /// The product of both.
    GaussLegendre,
    /// max(0, z)^(4l).
    Phong,
    /// z^(4l), as the paper prints it: an even function, of which no copies make up odd bands.
    EvenPhong,
}

impl Mother {
    /// All of them, with their names.
    pub const ALL: [(Self, &str); 6] = [
        (Self::Harmonic, "harmonic"),
        (Self::Legendre, "Legendre"),
        (Self::Gaussian, "Gaussian"),
        (Self::GaussLegendre, "Gauss-Legendre"),
        (Self::Phong, "clamped Phong"),
        (Self::EvenPhong, "even Phong"),
    ];

    /// Those whose levels have directions of their own, with the words that specs, files and commands have for them.
    pub const OWN: [(Self, &'static str); 4] = [
        (Self::Gaussian, "gaussian"),
        (Self::GaussLegendre, "gauss_legendre"),
        (Self::Phong, "phong"),
        (Self::EvenPhong, "even_phong"),
    ];

    /// Returns the one of [`Mother::OWN`] that a word means.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::OWN.iter().find(|(_, known)| *known == word).map(|(mother, _)| *mother)
    }

    /// Returns its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(mother, _)| *mother == self).map_or("", |(_, name)| name)
    }

    /// Returns the function of a level at the cosine `z`.
    pub fn value(self, level: usize, z: f64) -> f64 {
        let l = level as f64;
        let legendre = || *legendre_to(level, z).last().expect("holds P_0");
        let gaussian = || (-(1.0 - z) * l * l).exp();
        match self {
            Self::Harmonic => ((2.0 * l + 1.0) / (4.0 * PI)).sqrt() * legendre(),
            Self::Legendre => legendre(),
            Self::Gaussian => gaussian(),
            Self::GaussLegendre => gaussian() * legendre(),
            Self::Phong => z.max(0.0).powi(4 * level as i32),
            Self::EvenPhong => z.powi(4 * level as i32),
        }
    }

    /// Returns β_ll' for the bands l' up to `bands`: the coefficients of y_l'^0 in the function of a level.
    pub fn beta(self, level: usize, bands: usize) -> Vec<f64> {
        let from = if self == Self::Phong { 0.0 } else { -1.0 };
        let mut sums = vec![0.0; bands + 1];
        // Exact for powers to 4 · 40; a Gaussian of level 20 falls to nothing within 60 of these nodes.
        for (z, weight) in gauss_legendre(160, from, 1.0) {
            let value = TAU * weight * self.value(level, z);
            sums.iter_mut().zip(legendre_to(bands, z)).for_each(|(sum, p)| *sum += value * p);
        }
        let norm = |l: usize| ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
        sums.iter().enumerate().map(|(l, sum)| norm(l) * sum).collect()
    }
}

/// P_0 to P_l.
fn legendre_to(l: usize, z: f64) -> Vec<f64> {
    let mut all = vec![1.0, z];
    for k in 1..l {
        let (n, value) = (k as f64, all[k]);
        all.push(((2.0 * n + 1.0) * z * value - n * all[k - 1]) / (n + 1.0));
    }
    all.truncate(l + 1);
    all
}

/// A set of directions for each level.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels(Vec<Vec<[f64; 3]>>);

impl Levels {
    /// Level l takes the first 2l + 1 of the directions.
    ///
    /// # Errors
    ///
    /// If there are too few.
    pub fn shared(bands: usize, directions: &[[f64; 3]]) -> Result<Self, String> {
        let level = |l: usize| directions.get(..2 * l + 1).map(<[_]>::to_vec);
        let few = || format!("{} directions are too few for {bands} bands: give {}", directions.len(), 2 * bands + 1);
        (0..=bands).map(level).collect::<Option<_>>().map(Self).ok_or_else(few)
    }

    /// Level l takes the 2l + 1 directions from l² on.
    ///
    /// # Errors
    ///
    /// If there are not (L + 1)² of them.
    pub fn own(bands: usize, directions: &[[f64; 3]]) -> Result<Self, String> {
        let (count, want) = (directions.len(), (bands + 1) * (bands + 1));
        match count == want {
            true => Ok(Self((0..=bands).map(|l| directions[l * l..(l + 1) * (l + 1)].to_vec()).collect())),
            false => Err(format!("{count} directions do not suit {bands} bands: give {want}")),
        }
    }

    /// Returns the directions of each level.
    pub fn directions(&self) -> &[Vec<[f64; 3]>] {
        &self.0
    }

    /// Directions spread over the whole sphere by the golden angle and dealt to the levels: none near another of its own or of
    /// another level.
    pub fn dealt(bands: usize) -> Self {
        let count = (bands + 1) * (bands + 1);
        let golden = PI * (3.0 - 5f64.sqrt());
        let at = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let rim = (1.0 - z * z).sqrt();
            [rim * cos, rim * sin, z]
        };
        // The level that has least of its share of what is dealt so far takes the next.
        let mut levels = vec![Vec::new(); bands + 1];
        for i in 0..count {
            let lack = |l: &usize| (2 * l + 1) as f64 * (i + 1) as f64 / count as f64 - levels[*l].len() as f64;
            let free = (0..=bands).filter(|l| levels[*l].len() < 2 * l + 1);
            let next = free.max_by(|a, b| lack(a).total_cmp(&lack(b))).expect("as many places as directions");
            levels[next].push(at(i));
        }
        Self(levels)
    }
}

/// The decomposition by one profile of mother functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Decomposition {
    /// M, by its rows: row l'(l'+1)+m', column l² + j for direction j of level l.
    pub matrix: Vec<Vec<f64>>,
    /// The quotient of M's largest and smallest singular value.
    pub condition: f64,
}

impl Decomposition {
    /// The matrix of a profile and its condition, whatever that is: β_ll' π_l' y_l'^m'(z).
    pub fn measured(mother: Mother, levels: &Levels) -> Self {
        let bands = levels.0.len() - 1;
        let columns: Vec<Vec<f64>> = levels
            .0
            .iter()
            .enumerate()
            .flat_map(|(l, directions)| {
                let beta = mother.beta(l, bands);
                let factor = move |at: usize| beta[at] * (4.0 * PI / (2 * at + 1) as f64).sqrt();
                directions.iter().map(move |&z| {
                    let mut values = vec![0.0; (bands + 1) * (bands + 1)];
                    basis(bands + 1, z, &mut values);
                    coefficients(bands + 1).zip(values).map(|((at, _), y)| factor(at) * y).collect()
                })
            })
            .collect();
        let matrix = (0..columns.len()).map(|i| columns.iter().map(|column: &Vec<f64>| column[i]).collect()).collect();
        Self { condition: condition(&columns), matrix }
    }

    /// The matrix of a profile.
    ///
    /// # Errors
    ///
    /// If it is singular, or so nearly that f32 would not keep a digit: its condition number is told, and what to do.
    pub fn new(mother: Mother, levels: &Levels) -> Result<Self, String> {
        let made = Self::measured(mother, levels);
        // NaN is refused too.
        if made.condition <= HOPELESS {
            return Ok(made);
        }
        let (name, bands) = (mother.name(), levels.0.len() - 1);
        let what = if made.condition < 1e15 { "nearly singular" } else { "singular" };
        let help = match mother {
            Mother::EvenPhong => {
                "take the clamped one, max(0, z)^(4l): copies of an even function make up no odd bands"
            }
            Mother::Harmonic | Mother::Legendre => "spread the directions of each band",
            _ => "give each level directions of its own, over the whole sphere",
        };
        Err(format!(
            "M of {name} mother functions of {bands} bands is {what}: its condition number is {:.1e}, above {HOPELESS:e}; {help}",
            made.condition
        ))
    }
}
