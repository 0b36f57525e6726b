//! Inputs that no one means to give: coefficients at the ends of f32 and beyond, quaternions that are not of unit length,
//! negated, zero or no number. What is promised is in the docs of the crate `zonal`; here it is tried on every kernel that
//! turns a signal.

use crate::stability::truth::norm;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::code::Runner;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::promise::samples;

/// What the coefficients of a band are scaled to.
pub const VALUES: [(&str, f32); 6] = [
    ("1e38", 1e38),
    ("1e-38", 1e-38),
    ("1e-42", 1e-42),
    ("1e-45", 1e-45),
    ("infinite", f32::INFINITY),
    ("NaN", f32::NAN),
];
/// The band that holds them.
pub const BAND: usize = 2;
/// The kernels that are tried.
pub const SPECS: [&str; 12] = [
    "rotate:5",
    "rotate:5:zxzxz",
    "rotate:5:euler",
    "rotate:5:angles",
    "rotate:5:align",
    "rotate:3",
    "tilt:5",
    "rotate:5:lf3",
    "rotate:5:taylor15",
    "rotate_y:5",
    "zhf:5",
    "rotate:5:loop",
];
const INPUTS: usize = 60;
const SEED: u64 = 0x5bec;

/// What becomes of a band of special coefficients.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The spec.
    pub spec: String,
    /// Which of [`VALUES`].
    pub value: String,
    /// Whether every other band is the same to the last bit as beside an ordinary band.
    pub others_unchanged: bool,
    /// Whether every coefficient of the band is a finite number.
    pub finite: bool,
    /// The largest error of the band over its norm, where both are finite.
    pub error: Option<f64>,
    /// That error in units of the smallest f32.
    pub units: Option<f64>,
}

struct Bench {
    spec: Spec,
    params: Vec<Param>,
    narrow: Runner<f32>,
    wide: Runner<f64>,
}

impl Bench {
    fn new(text: &str) -> Self {
        let spec: Spec = text.parse().expect("names a kernel");
        let code = spec.code();
        let (params, narrow, wide) = (code.params().to_vec(), code.runner(), code.runner());
        Self { spec, params, narrow, wide }
    }

    /// Seeded parameters, and the signal that comes last.
    fn inputs(&self) -> Vec<(Vec<Vec<f64>>, Vec<f32>)> {
        let sets = samples::inputs(&self.params, SEED, INPUTS, None).into_iter();
        sets.map(|mut set| {
            let signal = set.pop().expect("a kernel that turns a signal has one");
            (set, signal.into_iter().map(|x| x as f32).collect())
        })
        .collect()
    }

    fn run(&self, parameters: &[Vec<f64>], c: &[f32]) -> Vec<f32> {
        let narrow: Vec<Vec<f32>> = parameters.iter().map(|list| list.iter().map(|x| *x as f32).collect()).collect();
        let inputs: Vec<&[f32]> = narrow.iter().map(Vec::as_slice).chain([c]).collect();
        self.narrow.run(&inputs, Contraction::Separate)
    }

    fn wide(&self, parameters: &[Vec<f64>], c: &[f32]) -> Vec<f64> {
        let c: Vec<f64> = c.iter().map(|x| f64::from(*x)).collect();
        let inputs: Vec<&[f64]> = parameters.iter().chain([&c]).map(Vec::as_slice).collect();
        self.wide.run(&inputs, Contraction::Separate)
    }
}

fn coefficients(bench: &Bench, name: &str, value: f32) -> Outcome {
    let own = BAND * BAND..(BAND + 1) * (BAND + 1);
    let mut outcome = Outcome {
        spec: bench.spec.to_string(),
        value: name.to_owned(),
        others_unchanged: true,
        finite: true,
        error: None,
        units: None,
    };
    let (mut error, mut units) = (0.0f64, 0.0f64);
    for (parameter, ordinary) in bench.inputs() {
        let mut special = ordinary.clone();
        special[own.clone()].iter_mut().for_each(|x| *x = if value.is_finite() { *x * value } else { value });
        let (before, after) = (bench.run(&parameter, &ordinary), bench.run(&parameter, &special));
        let same = |i: usize| own.contains(&i) || before[i].to_bits() == after[i].to_bits();
        outcome.others_unchanged &= (0..after.len()).all(same);
        outcome.finite &= after[own.clone()].iter().all(|x| x.is_finite());
        let want = &bench.wide(&parameter, &special)[own.clone()];
        let away: Vec<f64> = want.iter().zip(&after[own.clone()]).map(|(a, b)| a - f64::from(*b)).collect();
        error = error.max(norm(away.iter().copied()) / norm(want.iter().copied()));
        units = units.max(norm(away.iter().copied()) / f64::from(f32::from_bits(1)));
    }
    if outcome.finite && value.is_finite() {
        outcome.error = Some(significant(error)).filter(|error| error.is_finite());
        outcome.units = Some(significant(units));
    }
    outcome
}

/// What is done to a quaternion.
pub const QUATERNIONS: [&str; 6] = ["1e-6 too long", "1e-3 too long", "0.1 too long", "negated", "zero", "NaN"];

/// What becomes of a rotation by a quaternion that is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bent {
    /// The spec.
    pub spec: String,
    /// Which of [`QUATERNIONS`].
    pub input: String,
    /// Whether every coefficient is a finite number.
    pub finite: bool,
    /// Whether band 0 passes through to the last bit.
    pub band_0: bool,
    /// Whether every coefficient of the other bands is no number.
    pub all_nan: bool,
    /// The largest change of band l over l times its norm, against the rotation by the quaternion as it was.
    pub change: Option<f64>,
}

fn bent(bench: &Bench, kind: usize) -> Bent {
    let lengths = [1e-6, 1e-3, 0.1];
    let mut found = Bent {
        spec: bench.spec.to_string(),
        input: QUATERNIONS[kind].to_owned(),
        finite: true,
        band_0: true,
        all_nan: true,
        change: None,
    };
    let mut worst = 0.0f64;
    for (q, c) in bench.inputs() {
        let change = |x: &f64| match kind {
            0..=2 => x * (1.0 + lengths[kind]),
            3 => -x,
            4 => 0.0,
            _ => f64::NAN,
        };
        let changed = vec![q[0].iter().map(change).collect()];
        let (before, after) = (bench.run(&q, &c), bench.run(&changed, &c));
        found.finite &= after.iter().all(|x| x.is_finite());
        found.band_0 &= after[0].to_bits() == c[0].to_bits();
        found.all_nan &= after[1..].iter().all(|x| x.is_nan());
        for l in 1..bench.spec.order {
            let band = l * l..(l + 1) * (l + 1);
            let away = before[band.clone()].iter().zip(&after[band.clone()]).map(|(a, b)| f64::from(a - b));
            let change = norm(away);
            let size = norm(c[band].iter().map(|x| f64::from(*x)));
            worst = worst.max(change / (l as f64 * size));
        }
    }
    found.change = found.finite.then(|| significant(worst));
    found
}

/// Every kernel with every value.
pub fn measure(progress: &dyn Progress) -> (Vec<Outcome>, Vec<Bent>) {
    let benches = each(progress, "kernels", &SPECS, |text| Bench::new(text));
    let tasks: Vec<(&Bench, &str, f32)> =
        benches.iter().flat_map(|bench| VALUES.map(|(name, value)| (bench, name, value))).collect();
    let outcomes =
        each(progress, "special coefficients", &tasks, |(bench, name, value)| coefficients(bench, name, *value));
    let turned = benches.iter().filter(|bench| bench.params[0].shape == Shape::Vec4);
    let tasks: Vec<(&Bench, usize)> =
        turned.flat_map(|bench| (0..QUATERNIONS.len()).map(move |kind| (bench, kind))).collect();
    (outcomes, each(progress, "bent quaternions", &tasks, |(bench, kind)| bent(bench, *kind)))
}
