//! How exact a kernel is: the rounding error of its f32 form, proven ([`crate::promise::bound`]) and, against its f64 form, measured
//! over seeded inputs; for an approximate rotation the error of the method at an angle, computed from its matrix.

// Names a family: what every approximate rotation is compared with.
use crate::families::axis;
use crate::families::family::{AngleAs, MAX_ORDER, Measure, Spec};
use crate::ir::code::Code;
use crate::ir::eval::{Contraction, Number, Program};
use crate::ir::kernel::{Kernel, Param};
use crate::ir::listing::Listing;
use crate::math::half::Half;
use crate::math::linear::spectral_norm;
use crate::promise::bound::Bound;
use crate::promise::law;
use crate::promise::proofs;
use crate::promise::samples;

/// The tilts in degrees at which a file's head says the method's error.
pub const ANGLES: [f64; 4] = [5.0, 10.0, 15.0, 25.0];
/// How many inputs rounding is measured over.
const SAMPLES: usize = 256;
/// How many for a loop beyond the orders of unrolled kernels, whose every run is a hundred thousand operations.
const LONG_LOOP_SAMPLES: usize = 8;
/// Where nothing is proven, the measured worst case is multiplied by this before it is promised.
pub const MARGIN: f64 = 3.0;
const SEED: u64 = 0x0005_a0a1;

/// What is promised of a kernel.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Accuracy {
    /// The rounding error that is promised of f32, or of f16 for a kernel of that precision, in the measure of
    /// `relative_to`: the proven one where there is a proof, else [`MARGIN`] times the measured one.
    pub rounding_f32: f64,
    /// Whether it is proven, for IEEE arithmetic, contracted or not.
    pub proven: bool,
    /// The largest that was measured.
    pub measured_f32: f64,
    /// What the rounding error is relative to.
    pub relative_to: &'static str,
    /// How many inputs it was measured over.
    pub samples: usize,
    /// For an approximate rotation the largest error of any band (spectral norm) at angles in degrees; none beyond the
    /// orders of unrolled kernels, where it is the law that is said.
    pub method: Vec<(f64, f64)>,
}

/// Rounds up to two significant digits.
pub fn round_up(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let text = format!("{value:.1e}");
    let rounded: f64 = text.parse().expect("a number prints as a number");
    if rounded >= value {
        return rounded;
    }
    let (digits, exponent) = text.split_once('e').expect("scientific notation has an exponent");
    let tenths: i64 = digits.replace('.', "").parse().expect("two digits");
    let exponent: i32 = exponent.parse().expect("an integer");
    format!("{}e{}", tenths + 1, exponent - 1).parse().expect("a number")
}

impl Measure {
    /// What an error in it is relative to.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bands | Self::Through(_) => "the norm of a band",
            Self::Added => "the norm of a band, which is one, as is the size of what is added",
            Self::Whole => "the norm of the coefficients, each band of norm one",
            Self::Norm => "the norm of the coefficients",
            Self::Product => "the product of both factors' norms",
            Self::Absolute => "one",
        }
    }

    /// Returns the largest error of `got` in this measure, for inputs whose bands have the norm one or, of a product, for
    /// signals of which the norms multiply to one; before it is divided by [`Measure::size`]. NaN if there is one.
    pub fn error(self, got: &[f64], want: &[f64], order: usize) -> f64 {
        let difference = |range: std::ops::Range<usize>| {
            got[range.clone()].iter().zip(&want[range]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
        };
        match self {
            Self::Bands | Self::Added | Self::Through(_) => {
                (0..order).map(|l| difference(l * l..(l + 1) * (l + 1))).fold(0.0, larger)
            }
            Self::Product | Self::Norm => difference(0..got.len()),
            _ => (0..got.len()).map(|i| difference(i..i + 1)).fold(0.0, larger),
        }
    }
}

impl Measure {
    /// Returns what an error in it is divided by, for inputs: the norms of the factors of a product, one squared where both
    /// are the same; the norm of the signal where it is no bands of norm one; else one.
    pub fn size(self, params: &[Param], input: &[Vec<f64>]) -> f64 {
        let given = || params.iter().zip(input).filter(|(param, _)| param.domain.is_coefficients());
        let mut norms = given().map(|(_, list)| list.iter().map(|x| x * x).sum::<f64>().sqrt());
        match self {
            Self::Product if given().count() == 1 => norms.map(|norm| norm * norm).sum(),
            Self::Product => norms.product(),
            Self::Norm => norms.next().unwrap_or(1.0),
            _ => 1.0,
        }
    }
}

/// The larger of two numbers, or NaN if one is.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The largest rounding error of running in `T`, against f64, over `count` seeded inputs.
pub fn rounding<T: Number>(spec: &Spec, code: &Code, seed: u64, count: usize, contraction: Contraction) -> f64 {
    let (narrow, wide) = (code.runner::<T>(), code.runner::<f64>());
    let (measure, meaning) = (spec.family.measure, Meaning::of(spec));
    samples::inputs(code.params(), seed, count, None)
        .iter()
        .map(|input| {
            let rounded: Vec<Vec<T>> =
                input.iter().map(|list| list.iter().map(|&x| T::from_f64(x)).collect()).collect();
            let narrow_input: Vec<&[T]> = rounded.iter().map(Vec::as_slice).collect();
            let wide_input: Vec<&[f64]> = input.iter().map(Vec::as_slice).collect();
            let got: Vec<f64> = narrow.run(&narrow_input, contraction).iter().map(|x| x.to_f64()).collect();
            let want = wide.run(&wide_input, contraction);
            let error = measure.error(&meaning.apply(got), &meaning.apply(want), spec.order);
            error / measure.size(code.params(), input)
        })
        .fold(0.0, larger)
}

/// What a result is compared by: itself, or, for the angles of a rotation, of which two have no meaning apart at the
/// poles, the signal that they rotate.
pub enum Meaning {
    /// The result itself.
    Itself,
    /// What a fixed signal becomes.
    Rotated(Box<Program<f64>>, Vec<f64>),
}

impl Meaning {
    /// What the results of a spec's kernel are compared by.
    pub fn of(spec: &Spec) -> Self {
        match spec.family.measure {
            Measure::Through(rotation) => Self::rotated(spec.order, &rotation(spec.order)),
            _ => Self::Itself,
        }
    }

    fn rotated(order: usize, rotation: &Kernel) -> Self {
        let norm = |i: usize| ((2 * i.isqrt() + 1) as f64).sqrt();
        let signal = (0..order * order).map(|i| 1.0 / norm(i)).collect();
        Self::Rotated(Box::new(Program::new(&Listing::new(rotation))), signal)
    }

    /// What a result means.
    pub fn apply(&self, result: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Itself => result,
            Self::Rotated(program, signal) => program.run(&[&result, signal], Contraction::Separate),
        }
    }
}

impl Accuracy {
    /// Measures a kernel.
    pub fn of(spec: &Spec, code: &Code) -> Self {
        let samples = match code {
            Code::Loop(_) if spec.order > MAX_ORDER => LONG_LOOP_SAMPLES,
            _ => SAMPLES,
        };
        let measure = |contraction| match spec.half {
            true => rounding::<Half>(spec, code, SEED, samples, contraction),
            false => rounding::<f32>(spec, code, SEED, samples, contraction),
        };
        let both = || [Contraction::Separate, Contraction::Fused].map(measure).to_vec();
        let worst = proofs::kept(spec, code, &format!("measured {samples}"), both).into_iter().fold(0.0, larger);
        let method = match spec.is_approximate() && spec.order <= MAX_ORDER {
            true => {
                let errors = method_errors(spec, &ANGLES.map(f64::to_radians));
                ANGLES.into_iter().zip(errors.into_iter().map(round_up)).collect()
            }
            false => vec![],
        };
        // What is proven is proven of f32.
        let bound = if spec.half { None } else { proofs::bound(spec, code) };
        Self {
            rounding_f32: round_up(bound.as_ref().map_or(worst * MARGIN, Bound::value)),
            proven: bound.is_some(),
            measured_f32: round_up(worst),
            relative_to: spec.family.measure.name(),
            samples,
            method,
        }
    }
}

/// The largest error of any band, as a spectral norm, of an approximate rotation by `angle` radians; zero for an exact
/// one. A rotation about z changes no norm, so that a z, y, z rotation has the error of its y rotation.
pub fn method_error(spec: &Spec, angle: f64) -> f64 {
    method_errors(spec, &[angle])[0]
}

/// [`method_error`] at several angles, by the [law].
pub fn method_errors(spec: &Spec, angles: &[f64]) -> Vec<f64> {
    let error = |&angle: &f64| law::errors(spec, angle).iter().map(|error| error.max).fold(0.0, larger);
    angles.iter().map(error).collect()
}

/// An approximate rotation about y, or a tilt of z towards x, less the exact one, by the kernels' own operations.
pub struct Difference {
    order: usize,
    /// The approximate one and what it is given; none for an exact kernel.
    approximate: Option<(Program<f64>, AngleAs)>,
    exact: Program<f64>,
}

impl Difference {
    /// Of a spec's kernel.
    pub fn new(spec: &Spec) -> Self {
        let order = spec.order;
        let approximate = spec.family.by_band.map(|by_band| {
            let kernel = (by_band.plane)(order, &spec.methods);
            (Program::new(&Listing::new(&kernel)), by_band.given)
        });
        // Names a family: what every approximate rotation is compared with.
        let exact = Spec::new(&axis::ROTATE_Y, order).kernel();
        Self { order, approximate, exact: Program::new(&Listing::new(&exact)) }
    }

    /// What becomes of a signal at an angle in radians.
    pub fn of(&self, angle: f64, signal: &[f64]) -> Vec<f64> {
        let Some((approximate, given)) = &self.approximate else { return vec![0.0; signal.len()] };
        let (sin, cos) = angle.sin_cos();
        let parameter = match given {
            AngleAs::Angle => vec![angle],
            AngleAs::Phase => vec![cos, sin],
            AngleAs::Normal => vec![sin, 0.0, cos],
        };
        let want = self.exact.run(&[&[cos, sin], signal], Contraction::Separate);
        let got = approximate.run(&[&parameter, signal], Contraction::Separate);
        got.iter().zip(&want).map(|(a, b)| a - b).collect()
    }

    /// The matrix of each band by its columns.
    pub fn bands(&self, angle: f64) -> Vec<Vec<Vec<f64>>> {
        // No band mixes with another, so that one run gives a column of every band.
        let columns: Vec<Vec<f64>> = (0..2 * self.order - 1)
            .map(|j| {
                let mut unit = vec![0.0; self.order * self.order];
                (0..self.order).filter(|l| j <= 2 * l).for_each(|l| unit[l * l + j] = 1.0);
                self.of(angle, &unit)
            })
            .collect();
        let band = |l: usize| columns[..2 * l + 1].iter().map(move |column| column[l * l..(l + 1) * (l + 1)].to_vec());
        (0..self.order).map(|l| band(l).collect()).collect()
    }
}

/// For each angle in radians the error of each band, as a spectral norm, of an approximate rotation by it, from the
/// kernel's own matrix: what the [law] is checked against.
pub fn band_errors(spec: &Spec, angles: &[f64]) -> Vec<Vec<f64>> {
    let difference = Difference::new(spec);
    angles.iter().map(|&angle| difference.bands(angle).iter().map(|band| spectral_norm(band)).collect()).collect()
}
