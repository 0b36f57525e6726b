//! The proven f32 rounding bound of each kernel beside the worst that is measured over a million inputs, with products
//! fused and not. Sixteen inputs are run at once, so that the interpreter's own work is shared.

use crate::{Progress, significant};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::{Add, Div, Mul, Neg, Range, Sub};
use zonal_codegen::catalog;
use zonal_codegen::families::Spec;
use zonal_codegen::families::family::Measure;
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::accuracy::Meaning;
use zonal_codegen::promise::bound::Bound;
use zonal_codegen::promise::proofs;
use zonal_codegen::promise::samples;

/// How many inputs each kernel is measured over unless another number is asked for.
pub const INPUTS: usize = 1_000_000;
/// Inputs that are run at once.
const LANES: usize = 16;
/// Inputs that are drawn from one seed.
const CHUNK: usize = 1 << 14;
const SEED: u64 = 0xb0_0d;

/// A bound and what was measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// The proven bound.
    pub proven: f64,
    /// The largest that was measured.
    pub measured: f64,
}

impl Pair {
    /// How many times the bound is what was measured; one where there is no error.
    pub fn ratio(&self) -> f64 {
        if self.proven == 0.0 && self.measured == 0.0 { 1.0 } else { self.proven / self.measured }
    }
}

/// A kernel's bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// The spec.
    pub spec: String,
    /// The order.
    pub order: usize,
    /// Where a multiply-add is rounded twice.
    pub separate: Pair,
    /// Where a multiply-add is rounded once.
    pub fused: Pair,
    /// How many inputs were drawn.
    pub inputs: usize,
}

/// As many numbers as there are lanes.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Lanes<T>([T; LANES]);

macro_rules! lanewise {
    ($($trait:ident $method:ident;)*) => { $(
        impl<T: Number> $trait for Lanes<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i].$method(other.0[i])))
            }
        }
    )* };
}

lanewise! { Add add; Sub sub; Mul mul; Div div; }

impl<T: Number> Neg for Lanes<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<T: Number> Number for Lanes<T> {
    const ONE: Self = Self([T::ONE; LANES]);
    const ZERO: Self = Self([T::ZERO; LANES]);
    const TINY: Self = Self([T::TINY; LANES]);
    const UNIT_ROUNDOFF: f64 = T::UNIT_ROUNDOFF;

    fn nearest(value: &Exact) -> Self {
        Self([T::nearest(value); LANES])
    }

    fn from_f64(value: f64) -> Self {
        Self([T::from_f64(value); LANES])
    }

    /// That of the first lane.
    fn to_f64(self) -> f64 {
        self.0[0].to_f64()
    }

    fn root(self) -> Self {
        Self(self.0.map(T::root))
    }

    fn exp2(self) -> Self {
        Self(self.0.map(T::exp2))
    }

    fn log2(self) -> Self {
        Self(self.0.map(T::log2))
    }

    fn choose(a: Self, b: Self, c: Self, d: Self) -> Self {
        Self(std::array::from_fn(|i| T::choose(a.0[i], b.0[i], c.0[i], d.0[i])))
    }

    /// Through f64, which vector units have everywhere: an f32 product is exact there, so that the sum is rounded twice
    /// only where it lies within 2⁻²⁹ of the middle of two f32s, and then to the one next to what it should be.
    fn fused(self, b: Self, c: Self) -> Self {
        assert!(T::UNIT_ROUNDOFF > 1e-8, "f64 has no wider type");
        Self(std::array::from_fn(|i| T::from_f64(self.0[i].to_f64() * b.0[i].to_f64() + c.0[i].to_f64())))
    }
}

/// What is compared: bands, or numbers one by one.
fn ranges(measure: Measure, order: usize, count: usize) -> Vec<Range<usize>> {
    match measure {
        Measure::Bands | Measure::Added | Measure::Through(_) => (0..order).map(|l| l * l..(l + 1) * (l + 1)).collect(),
        Measure::Product | Measure::Norm => std::iter::once(0..count).collect(),
        _ => (0..count).map(|i| i..i + 1).collect(),
    }
}

/// A program and the signal that it turns.
type Turned = (Program<Lanes<f64>>, Vec<Lanes<f64>>);

/// The programs of a kernel.
struct Runner<'a> {
    spec: &'a Spec,
    listing: &'a Listing,
    narrow: Program<Lanes<f32>>,
    wide: Program<Lanes<f64>>,
    /// What the result is used for, where it is that which is compared.
    rotation: Option<Turned>,
}

impl<'a> Runner<'a> {
    fn new(spec: &'a Spec, listing: &'a Listing) -> Self {
        let rotation = match Meaning::of(spec) {
            Meaning::Itself => None,
            Meaning::Rotated(program, signal) => {
                let signal = signal.into_iter().map(Lanes::from_f64).collect();
                Some((Program::new(program.listing()), signal))
            }
        };
        Self { spec, listing, narrow: Program::new(listing), wide: Program::new(listing), rotation }
    }

    fn meaning(&self, result: Vec<Lanes<f64>>) -> Vec<Lanes<f64>> {
        match &self.rotation {
            None => result,
            Some((program, signal)) => program.run(&[&result, signal], Contraction::Separate),
        }
    }

    /// The largest error of the inputs of a seed, for each contraction; infinite where a result is no number.
    fn worst(&self, seed: u64, count: usize) -> [f64; 2] {
        let inputs = samples::inputs(&self.listing.params, seed, count, None);
        let measure = self.spec.family.measure;
        // Signals have the same norm in every sample.
        let size = inputs.first().map_or(1.0, |input| measure.size(&self.listing.params, input));
        let mut worst = [0.0f64; 2];
        for some in inputs.chunks(LANES) {
            // A last, short group repeats its first input.
            let at = |lane: usize| some.get(lane).unwrap_or(&some[0]);
            let lanes = |param: usize, index: usize| -> [f64; LANES] { std::array::from_fn(|i| at(i)[param][index]) };
            let wide: Vec<Vec<Lanes<f64>>> = (some[0].iter().enumerate())
                .map(|(param, list)| (0..list.len()).map(|index| Lanes(lanes(param, index))).collect())
                .collect();
            let narrow: Vec<Vec<Lanes<f32>>> =
                wide.iter().map(|list| list.iter().map(|x| Lanes(x.0.map(|x| x as f32))).collect()).collect();
            let wide: Vec<&[Lanes<f64>]> = wide.iter().map(Vec::as_slice).collect();
            let narrow: Vec<&[Lanes<f32>]> = narrow.iter().map(Vec::as_slice).collect();
            let want = self.meaning(self.wide.run(&wide, Contraction::Separate));
            for (contraction, worst) in [Contraction::Separate, Contraction::Fused].into_iter().zip(&mut worst) {
                let got = self.narrow.run(&narrow, contraction);
                let got = self.meaning(got.into_iter().map(|x| Lanes(x.0.map(f64::from))).collect());
                for range in ranges(measure, self.spec.order, got.len()) {
                    let mut squares = [0.0f64; LANES];
                    for (a, b) in got[range.clone()].iter().zip(&want[range]) {
                        for lane in 0..LANES {
                            let difference = a.0[lane] - b.0[lane];
                            squares[lane] += difference * difference;
                        }
                    }
                    for square in squares {
                        *worst = if square.is_nan() { f64::INFINITY } else { worst.max(square.sqrt()) };
                    }
                }
            }
        }
        worst.map(|error| error / size)
    }
}

/// The largest f32 rounding error over `count` seeded inputs, in the measure of [`zonal_codegen::promise::accuracy`], where a
/// multiply-add is rounded twice and once.
pub fn worst(spec: &Spec, listing: &Listing, count: usize) -> [f64; 2] {
    let runner = Runner::new(spec, listing);
    let chunks: Vec<usize> = (0..count.div_ceil(CHUNK)).collect();
    let of = |&chunk: &usize| runner.worst(SEED + chunk as u64, CHUNK.min(count - chunk * CHUNK));
    chunks.par_iter().with_max_len(1).map(of).reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
}

/// A kernel with its bound.
pub struct Proven {
    /// What was asked for.
    pub spec: Spec,
    /// What it does: two listings where it decides between them.
    pub ways: Vec<Listing>,
    /// The bound of all.
    pub bound: Bound,
}

/// The kernels of the catalogue that have a bound.
pub fn proven() -> Vec<Proven> {
    let specs: Vec<Spec> = catalog::standard().into_iter().filter(|spec| !spec.rgb).collect();
    let prove = |spec: &Spec| {
        let code = spec.code();
        let bound = proofs::bound(spec, &code)?;
        let ways = match code {
            Code::Straight(listing) => vec![listing],
            Code::Loop(kernel) => vec![Listing::from(&kernel)],
            Code::Branch(branch) => vec![branch.below, branch.above],
        };
        Some(Proven { spec: spec.clone(), ways, bound })
    };
    specs.par_iter().with_max_len(1).filter_map(prove).collect()
}

impl Proven {
    /// The operations of its longest way.
    pub fn steps(&self) -> usize {
        self.ways.iter().map(|listing| listing.steps.len()).max().unwrap_or(0)
    }

    /// The bound beside the worst of so many inputs.
    pub fn measured(&self, inputs: usize) -> Bounds {
        let worst = self.ways.iter().map(|listing| worst(&self.spec, listing, inputs));
        let measured = worst.fold([0.0; 2], |a, b| [f64::max(a[0], b[0]), f64::max(a[1], b[1])]).map(significant);
        let [separate, fused] = [(self.bound.separate, measured[0]), (self.bound.fused, measured[1])]
            .map(|(proven, measured)| Pair { proven: significant(proven), measured });
        Bounds { spec: self.spec.to_string(), order: self.spec.order, separate, fused, inputs }
    }
}

/// Every kernel's, over so many inputs.
pub fn measure(progress: &dyn Progress, inputs: usize) -> Vec<Bounds> {
    let kernels = proven();
    progress.stage("bounds", kernels.len());
    let of = |kernel: &Proven| {
        let row = kernel.measured(inputs);
        progress.step();
        row
    };
    kernels.iter().map(of).collect()
}

/// Where rows are not what the generator proves now.
pub fn stale(rows: &[Bounds]) -> Vec<String> {
    let kernels = proven();
    let mut found: Vec<String> = Vec::new();
    if kernels.len() != rows.len() {
        found.push(format!("bounds: {} kernels, now {}", rows.len(), kernels.len()));
    }
    for (row, Proven { spec, bound, .. }) in rows.iter().zip(&kernels) {
        let now = [significant(bound.separate), significant(bound.fused)];
        let then = [row.separate.proven, row.fused.proven];
        let close = now.iter().zip(then).all(|(a, b)| (a - b).abs() <= 0.01 * a.abs());
        if row.spec != spec.to_string() || !close {
            found.push(format!("bounds: {} is proven to {then:?}, now {spec} to {now:?}", row.spec));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::accuracy::rounding;

    #[test]
    fn lanes_do_what_single_numbers_do() {
        for text in ["rotate:4", "basis:5", "eval:4", "angles:3", "tilt:3"] {
            let spec: Spec = text.parse().unwrap();
            let listing = Listing::new(&spec.kernel());
            let code = Code::Straight(listing.clone());
            let single = [Contraction::Separate, Contraction::Fused]
                .map(|contraction| rounding::<f32>(&spec, &code, SEED, 100, contraction));
            for (lanes, single) in worst(&spec, &listing, 100).into_iter().zip(single) {
                // The reference in f64 is fused there and not here.
                assert!((lanes - single).abs() < 1e-14, "{text}: {lanes:e}, {single:e}");
            }
        }
    }
}
