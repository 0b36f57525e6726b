//! What a kernel is run on and what it has to give: seeded inputs with the extremes among them, signals that are zero,
//! huge, small, subnormal or several of these by band, results of the interpreter in f64, and how far a driver may be from them.

use crate::job::Job;
use crate::wrap::{self, VECTOR};
use std::ops::{Add, Div, Mul, Neg, Sub};
use zonal_codegen::emit::Function;
use zonal_codegen::emit::language::Target;
use zonal_codegen::families::family::{Acts, Measure};
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::Param;
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::accuracy::MARGIN;
use zonal_codegen::promise::samples;

/// How many inputs a kernel is run on, at least and at most; both are multiples of [`wrap::GROUP`].
pub const INPUTS: [usize; 2] = [2048, 8192];
/// How many operations the interpreter does for a kernel, if the number of inputs may be chosen by it.
const OPERATIONS: usize = 1 << 20;
/// The first inputs hold the extremes of each parameter.
const EXTREMES: usize = 16;
/// So many inputs in a row have one kind of signal; a quarter of them have extreme parameters.
const BLOCK: usize = 4 * EXTREMES;
/// So few inputs hold the extremes and every kind of signal: enough to notice what is wrong.
pub const FEW: usize = 8 * BLOCK;
/// 2^100, about 1.3e30.
const HUGE: f64 = (1u128 << 100) as f64;
/// 2^-80, about 8e-25: what a driver loses by flushing subnormal numbers stays far below a rounding.
const SMALL: f64 = 1.0 / (1u128 << 80) as f64;
/// 2^-126, the smallest normal number of f32: what a flush to zero may take away.
const NORMAL: f64 = f32::MIN_POSITIVE as f64;
/// 2^-130: every item of a signal of norm one becomes subnormal, which a driver may take for zero.
const SUBNORMAL: f64 = NORMAL / 16.0;
/// 2^-23, one unit in the last place of a number just above a power of two.
const ULP: f64 = f32::EPSILON as f64;

/// An f64 with the small constant of f32, so that the reference and the shader compute the same function: the angles of
/// a rotation that leaves two of them free depend on it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Wide(f64);

macro_rules! operator {
    ($($operator:ident $name:ident $sign:tt),*) => {$(
        impl $operator for Wide {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    )*};
}

operator!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Number for Wide {
    const ONE: Self = Self(1.0);
    const ZERO: Self = Self(0.0);
    const TINY: Self = Self(<f32 as Number>::TINY as f64);
    const UNIT_ROUNDOFF: f64 = <f64 as Number>::UNIT_ROUNDOFF;
    fn nearest(value: &Exact) -> Self {
        Self(value.to_f64())
    }
    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn root(self) -> Self {
        Self(self.0.sqrt())
    }
    fn fused(self, b: Self, c: Self) -> Self {
        Self(self.0.mul_add(b.0, c.0))
    }
}

/// How far a result may be from the interpreter's, in the kernel's own measure.
///
/// That is one and a half times the rounding which the kernel's file promises, or [`MARGIN`] times the worst that was
/// measured where that is less: drivers round additions and multiplications as the interpreter does, fused or not, but
/// some merge factors, which moves roundings about. Vulkan and
/// WGSL allow 2 ulp for an inverse square root and 2.5 ulp for a division, where the promise was measured with correct
/// roundings; each enters band l through three angles to the power l at most, hence 3 (n - 1) times 2.5 ulp for a kernel
/// that has one; powers and logarithms of numbers about one are within 5 ulp, which is less. A flushed subnormal number
/// changes a small signal by 2^-46 of it; 2^-40 leaves room for some.
pub fn tolerance(function: &Function) -> f64 {
    let (built, order) = (&function.built, function.spec.order as f64);
    let promised = match function.spec.family.measure {
        // The file promises what the angles rotate; here they are compared themselves, and l of them add up.
        Measure::Through(_) => 2.0 * ULP * order,
        _ => 1.5 * built.accuracy.rounding_f32.min(MARGIN * built.accuracy.measured_f32),
    };
    let special = match built.code.cost(1).special {
        0 => 0.0,
        _ => 3.0 * (order - 1.0) * 2.5 * ULP,
    };
    promised + special + 1.0 / (1u64 << 40) as f64
}

/// How many inputs a kernel is run on: the more the shorter it is.
fn inputs(function: &Function) -> usize {
    let operations = function.built.code.cost(function.spec.channels()).total;
    let [least, most] = INPUTS;
    (OPERATIONS / operations.max(1)).next_power_of_two().clamp(least, most)
}

/// The band of an item of a signal or a result, if its length says so.
fn band(index: usize, len: usize, order: usize) -> Option<usize> {
    match len {
        _ if len == order * order => Some(index.isqrt()),
        _ if len == order => Some(index),
        _ => None,
    }
}

/// What the items of one band of a signal are multiplied by.
fn scale(block: usize, band: Option<usize>) -> f64 {
    const BY_BAND: [f64; 4] = [HUGE, 1.0, 0.0, SMALL];
    match (block % 8, band) {
        (3, _) => SUBNORMAL,
        (4, _) => 0.0,
        (5, _) => HUGE,
        (6, _) => SMALL,
        (7, Some(band)) => BY_BAND[band % 4],
        _ => 1.0,
    }
}

/// The inputs of one kernel and the results that they should have.
#[derive(Debug)]
pub struct Cases {
    /// How many there are.
    count: usize,
    /// The inputs, each a number of whole vectors.
    inputs: Vec<f32>,
    /// The results, one after the other, and what each number of them is measured in.
    wanted: Vec<(f64, f64)>,
    /// How many numbers a result has.
    result: usize,
    channels: usize,
    by_band: bool,
    /// What the error of a result that is measured as one is relative to: the norms of the signals, where none is scaled.
    norms: Option<f64>,
    /// How far the result of a subnormal signal may be off: the item itself and each operation may be flushed.
    flushed: f64,
}

impl Cases {
    /// The cases of a kernel.
    pub fn new(function: &Function) -> Self {
        Self::some(function, inputs(function))
    }

    /// Cases of a kernel, of which [`FEW`] hold the extremes and every kind of signal.
    pub fn some(function: &Function, count: usize) -> Self {
        let (built, order) = (&function.built, function.spec.order);
        let params = built.code.params();
        let samples = samples::inputs(params, 7, count, None);
        // A loop is held to its unrolled twin, which is the faster to run.
        let runner = match &built.code {
            Code::Straight(_) | Code::Branch(_) => built.code.runner::<Wide>(),
            Code::Loop(_) => Code::Straight(Listing::new(&function.spec.kernel())).runner(),
        };
        let (shape, kind) = built.code.result();
        let channels = wrap::channels(function, kind);
        let family = function.spec.family;
        // Of a product's two signals the second stays as it is drawn: both huge would overflow.
        let first = params.iter().position(|param| !param.kind.is_scalar());
        let is_scaled = |place: usize| kind != Kind::Product || first == Some(place);
        // The square of one signal scales as the square of what it is multiplied by.
        let is_square = kind == Kind::Product && params.iter().filter(|param| !param.kind.is_scalar()).count() == 1;
        let of_signal = |unit: f64| if is_square { unit.sqrt() } else { unit };
        let by_band = matches!(family.measure, Measure::Bands) && family.acts != Acts::Mixes;
        let band_of = |index: usize, len: usize| if by_band { band(index, len, order) } else { None };
        let (mut inputs, mut wanted) = (Vec::new(), Vec::new());
        for case in 0..count {
            let parameters = if case % BLOCK < EXTREMES { case % EXTREMES } else { case };
            // Channels share their parameters and differ in their signals.
            let lists: Vec<Vec<Vec<Wide>>> = (0..channels)
                .map(|channel| {
                    let list = |(place, param): (usize, &Param)| {
                        if param.kind.is_scalar() {
                            return samples[parameters][place].iter().map(|&x| Wide(x)).collect();
                        }
                        let signal = samples[(case + channel) % count][place].iter().enumerate();
                        let len = param.shape.len();
                        let unit = |i: usize| match is_scaled(place) {
                            true => of_signal(scale(case / BLOCK + channel, band_of(i, len))),
                            false => 1.0,
                        };
                        signal.map(|(i, x)| Wide(f64::from((x * unit(i)) as f32))).collect()
                    };
                    params.iter().enumerate().map(list).collect()
                })
                .collect();
            for (place, param) in params.iter().enumerate() {
                let channels = &lists[..wrap::channels(function, param.kind)];
                for i in 0..param.shape.len() {
                    inputs.extend(channels.iter().map(|channel| channel[place][i].0 as f32));
                }
            }
            inputs.resize(inputs.len().next_multiple_of(VECTOR), 0.0);
            let results: Vec<Vec<Wide>> = lists
                .iter()
                .map(|lists| {
                    let slices: Vec<&[Wide]> = lists.iter().map(Vec::as_slice).collect();
                    runner.run(&slices, Contraction::Separate)
                })
                .collect();
            for i in 0..shape.len() {
                let unit = |channel: usize| match kind.is_scalar() {
                    true => 1.0,
                    false => scale(case / BLOCK + channel, band_of(i, shape.len())),
                };
                wanted.extend(results.iter().enumerate().map(|(channel, result)| (result[i].0, unit(channel))));
            }
        }
        // What is flushed may be multiplied by as much as a signal of norm one is.
        let of_units = wanted.iter().filter(|(_, unit)| *unit > SUBNORMAL);
        let gain = of_units.map(|(value, unit): &(f64, f64)| (value / unit).abs()).fold(1.0, f64::max);
        let flushed = (1 + built.code.cost(1).total) as f64 * gain * NORMAL;
        let is_one = matches!(family.measure, Measure::Product | Measure::Norm);
        let norms = is_one.then(|| family.measure.size(params, &samples[0]));
        Self { count, inputs, wanted, result: shape.len(), channels, by_band, norms, flushed }
    }

    /// The cases as a job for a device.
    pub fn job<'a>(&'a self, function: &Function, target: Target, text: &'a str) -> Job<'a> {
        let (takes, gives) = (wrap::input_vectors(function), wrap::output_vectors(function));
        Job { target, text, inputs: &self.inputs, count: self.count, takes, gives }
    }

    /// The largest error in the kernel's measure: of a band or a product as a whole, or of each number. Not finite if a
    /// zero signal does not give exact zeros, if a subnormal one gives anything larger than that, or if anything is not a
    /// number.
    pub fn error(&self, got: &[f32]) -> f64 {
        let size = self.result * self.channels;
        let got = got.chunks(size.next_multiple_of(VECTOR)).flat_map(|result| &result[..size]);
        let relative = |(&got, &(want, unit)): (&f32, &(f64, f64))| match (f64::from(got) - want, unit) {
            (0.0, 0.0) => 0.0,
            (difference, SUBNORMAL) if difference.abs() <= self.flushed => 0.0,
            (_, SUBNORMAL) => f64::INFINITY,
            (difference, unit) => difference / unit,
        };
        let errors: Vec<f64> = got.zip(&self.wanted).map(relative).collect();
        let mut worst = 0.0;
        for case in errors.chunks(size) {
            for channel in 0..self.channels {
                let mut bands = vec![0.0; self.result];
                for i in 0..self.result {
                    let error = case[i * self.channels + channel];
                    let part = if self.by_band { i.isqrt() } else { i };
                    bands[if self.norms.is_some() { 0 } else { part }] += error * error;
                }
                worst = bands.into_iter().fold(worst, |worst, square: f64| match square.is_nan() {
                    true => f64::INFINITY,
                    false => worst.max(square),
                });
            }
        }
        worst.sqrt() / self.norms.unwrap_or(1.0)
    }
}
