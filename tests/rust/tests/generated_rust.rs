//! The emitted Rust is the interpreter, to the last bit: every function of `generated/rust` runs on seeded inputs,
//! extremes first, in f32 and f64, one channel and three, and its results are compared with `to_bits`. The build script
//! makes the table of functions, which the standard catalogue is looked up in, so that none can be forgotten.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use zonal::real::{Channels, FUSED, Lanes};
use zonal_codegen::catalog;
use zonal_codegen::families::Spec;
use zonal_codegen::families::family::Measure;
use zonal_codegen::ir::code::Runner;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::kernel::Param;
use zonal_codegen::promise::samples::{self, Random};

/// How numbers round here: twice, unless the tests are compiled for a processor with multiply-adds.
const CONTRACTION: Contraction = if FUSED { Contraction::Fused } else { Contraction::Separate };
const SEED: u64 = 0x9e_11;
const SAMPLES: usize = 24;

/// A value that is read from a row of numbers and written to one.
trait Flat<T>: Sized {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Self;
    fn write(&self, numbers: &mut Vec<T>);
}

macro_rules! flat_number {
    ($($number:ident)*) => { $(
        impl Flat<$number> for $number {
            fn read(numbers: &mut impl Iterator<Item = $number>) -> Self {
                numbers.next().expect("a number for each place")
            }
            fn write(&self, numbers: &mut Vec<$number>) {
                numbers.push(*self);
            }
        }
    )* };
}
flat_number!(f32 f64);

impl<T, V: Flat<T>, const N: usize> Flat<T> for [V; N] {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Self {
        std::array::from_fn(|_| V::read(numbers))
    }
    fn write(&self, numbers: &mut Vec<T>) {
        self.iter().for_each(|value| value.write(numbers));
    }
}

fn read<T: Copy, V: Flat<T>>(numbers: &[T]) -> V {
    let mut numbers = numbers.iter().copied();
    let value = V::read(&mut numbers);
    assert_eq!(numbers.count(), 0, "no number is left over");
    value
}

fn written<T, V: Flat<T>>(value: V) -> Vec<T> {
    let mut numbers = Vec::new();
    value.write(&mut numbers);
    numbers
}

/// A kernel on rows of numbers, one a parameter.
type Flattened<T> = fn(&[Vec<T>]) -> Vec<T>;

/// Every function under its module's name and its own.
type Table<T> = BTreeMap<&'static str, Flattened<T>>;

include!(concat!(env!("OUT_DIR"), "/table.rs"));

/// Equality to the last bit, but for NaN, which has many.
trait Same: Number {
    fn same(self, other: Self) -> bool;
}

macro_rules! same {
    ($($number:ident)*) => { $(
        impl Same for $number {
            fn same(self, other: Self) -> bool {
                self.to_bits() == other.to_bits() || (self.is_nan() && other.is_nan())
            }
        }
    )* };
}
same!(f32 f64);

fn assert_same<T: Same + Debug>(got: &[T], want: &[T], what: impl Fn() -> String) {
    let same = got.len() == want.len() && got.iter().zip(want).all(|(a, b)| a.same(*b));
    assert!(same, "{}: {got:?} is not {want:?}", what());
}

/// Runs every spec of the catalogue, and what functions for three channels call, in one precision, in the interpreter and from the table.
fn compare<T: Same>(table: &Table<T>) {
    let specs: BTreeSet<Spec> = catalog::standard().into_iter().flat_map(|spec| [spec.base(), spec]).collect();
    assert_eq!(table.len(), specs.len(), "a function a spec");
    let mut kernels: BTreeMap<Spec, (Vec<Param>, Runner<T>)> = BTreeMap::new();
    for spec in &specs {
        let name = format!("sh{}::{}", spec.order, spec.stem());
        let function = table.get(&name[..]).unwrap_or_else(|| panic!("`{name}` is not in generated/rust"));
        let (params, runner) = kernels.entry(spec.base()).or_insert_with(|| {
            let code = spec.code();
            (code.params().to_vec(), code.runner())
        });
        if FUSED && matches!(spec.family.measure, Measure::Product) {
            println!("{spec} is not compared: a product of signals is a number of its own in Rust, and never fused");
            continue;
        }
        compare_one(spec, params, runner, *function);
    }
}

fn compare_one<T: Same>(spec: &Spec, params: &[Param], runner: &Runner<T>, function: Flattened<T>) {
    let inputs: Vec<Vec<Vec<T>>> = samples::inputs(params, SEED, SAMPLES, None)
        .iter()
        .map(|input| input.iter().map(|row| row.iter().map(|&x| T::from_f64(x)).collect()).collect())
        .collect();
    let channels = spec.channels();
    for i in 0..SAMPLES {
        // The parameters of one input, the signals of as many inputs as there are channels.
        let one = |channel: usize| -> Vec<&[T]> {
            let of = |param: &Param| if param.kind.is_scalar() { i } else { (i + channel) % SAMPLES };
            params.iter().enumerate().map(|(place, param)| &inputs[of(param)][place][..]).collect()
        };
        let each: Vec<Vec<T>> = (0..channels).map(|channel| runner.run(&one(channel), CONTRACTION)).collect();
        let rows: Vec<Vec<T>> = (0..params.len())
            .map(|place| {
                let channels = params[place].kind.numbers(channels);
                interleaved(&(0..channels).map(|channel| one(channel)[place]).collect::<Vec<_>>())
            })
            .collect();
        let want = interleaved(&each.iter().map(Vec::as_slice).collect::<Vec<_>>());
        assert_same(&function(&rows), &want, || format!("{spec} at input {i}"));
    }
}

fn interleaved<T: Copy>(rows: &[&[T]]) -> Vec<T> {
    (0..rows[0].len()).flat_map(|i| rows.iter().map(move |row| row[i])).collect()
}

#[test]
fn every_function_equals_the_interpreter_bit_for_bit_in_f32() {
    let mut table = Table::new();
    every_function!(table, f32);
    compare(&table);
}

#[test]
fn every_function_equals_the_interpreter_bit_for_bit_in_f64() {
    let mut table = Table::new();
    every_function!(table, f64);
    compare(&table);
}

const LANES: usize = 16;

/// Sixteen problems at once and one by one.
fn lanes<const P: usize, const N: usize, const R: usize>(
    seed: u64,
    at_once: impl Fn([Lanes<f32, LANES>; P], &[Lanes<f32, LANES>; N]) -> [Lanes<f32, LANES>; R],
    one: impl Fn([f32; P], &[f32; N]) -> [f32; R],
) {
    let mut random = Random::new(seed);
    let params: [[f32; P]; LANES] = std::array::from_fn(|_| random.unit().map(|x| x as f32));
    let signals: [[f32; N]; LANES] = std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32));
    let got = at_once(across(&params), &across(&signals));
    for lane in 0..LANES {
        let want = one(params[lane], &signals[lane]);
        assert_same(&got.map(|value| value.0[lane]), &want, || format!("lane {lane}"));
    }
}

fn across<const N: usize>(rows: &[[f32; N]; LANES]) -> [Lanes<f32, LANES>; N] {
    std::array::from_fn(|i| Lanes(rows.map(|row| row[i])))
}

#[test]
fn lanes_equal_single_runs_bit_for_bit() {
    lanes(1, |dir, _: &[_; 0]| zonal::sh5::basis(dir), |dir, _| zonal::sh5::basis(dir));
    lanes(2, |dir, c| [zonal::sh8::eval(dir, c)], |dir, c| [zonal::sh8::eval(dir, c)]);
    lanes(3, zonal::sh3::rotate, zonal::sh3::rotate);
    lanes(4, zonal::sh5::rotate, zonal::sh5::rotate);
    lanes(5, zonal::sh4::rotate_align, zonal::sh4::rotate_align);
    lanes(6, zonal::sh5::tilt, zonal::sh5::tilt);
    lanes(7, |[beta], c| zonal::sh5::lf3_y(beta, c), |[beta], c| zonal::sh5::lf3_y(beta, c));
}

#[test]
fn channels_of_lanes_equal_single_runs_bit_for_bit() {
    type Wide = Lanes<f32, LANES>;
    let mut random = Random::new(8);
    let q: [[f32; 4]; LANES] = std::array::from_fn(|_| random.unit().map(|x| x as f32));
    let signals: [[[f32; 25]; LANES]; 3] =
        std::array::from_fn(|_| std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32)));
    let wide = signals.map(|channel| across(&channel));
    let c: [Channels<Wide, 3>; 25] = std::array::from_fn(|i| Channels([wide[0][i], wide[1][i], wide[2][i]]));
    let got = zonal::sh5::rotate(across(&q), &c);
    for (channel, signal) in signals.iter().enumerate() {
        for lane in 0..LANES {
            let want = zonal::sh5::rotate(q[lane], &signal[lane]);
            assert_same(&got.map(|value| value.0[channel].0[lane]), &want, || {
                format!("channel {channel}, lane {lane}")
            });
        }
    }
}
