//! The times: each function, order and layout beside a copy, in turn, the fastest of many rounds.

use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::time::Instant;
use zonal::Error;
use zonal::batch::{self, Block, Row, Signals, SignalsMut, Unit};
use zonal_codegen::families::family::Spec;
use zonal_codegen::ir::code::Code;
use zonal_codegen::promise::samples::Random;

/// How many signals lie in a cache, and how many do not.
pub const IN_CACHE: usize = 1024;
/// More than the last cache holds from order 6 on.
pub const STREAMING: usize = 102_400;

/// What is timed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The vector unit.
    pub unit: String,
    /// The function.
    pub function: String,
    /// The layout.
    pub layout: String,
    /// The order.
    pub order: usize,
    /// How many signals.
    pub signals: usize,
    /// Nanoseconds a signal.
    pub nanoseconds: f64,
    /// Nanoseconds that a copy of the same bytes takes, a signal; of what reads nothing, that a fill takes.
    pub copy: f64,
    /// Nanoseconds that the multiplications take at the unit's peak, a signal.
    pub multiplications: f64,
}

impl Measured {
    /// Returns how many times what it cannot be faster than.
    pub fn k(&self) -> f64 {
        self.nanoseconds / self.copy.max(self.multiplications)
    }

    /// Returns how many copies it takes.
    pub fn copies(&self) -> f64 {
        self.nanoseconds / self.copy
    }
}

/// How a run goes.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// How many rounds of copy and kernel.
    pub rounds: usize,
    /// How many signals a round works on at least.
    pub signals: usize,
}

fn seconds(times: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..times {
        work();
    }
    start.elapsed().as_secs_f64() / times as f64
}

/// Times two things in turn: the fastest of each, in nanoseconds a signal.
fn both(rounds: Rounds, signals: usize, mut copy: impl FnMut(), mut work: impl FnMut()) -> [f64; 2] {
    let times = rounds.signals.div_ceil(signals);
    let mut best = [f64::INFINITY; 2];
    for _ in 0..rounds.rounds {
        // Each finds the caches as itself left them: lines that the other wrote are not written back on its time.
        copy();
        best[0] = best[0].min(seconds(times, &mut copy));
        work();
        best[1] = best[1].min(seconds(times, &mut work));
    }
    best.map(|seconds| seconds * 1e9 / signals as f64)
}

/// The multiplications of a kernel, or of its bands without the set-up.
fn multiplications(spec: &str, without_set_up: bool) -> usize {
    let spec: Spec = spec.parse().expect("a kernel of the catalogue");
    let pieces = spec.in_pieces();
    let pieces = if pieces.is_empty() { vec![spec] } else { pieces };
    let bands = pieces.iter().skip(usize::from(without_set_up));
    bands.map(|spec| Code::cost(&spec.code(), 1)).map(|cost| cost.mul + cost.fma).sum()
}

/// Numbers between −1 and 1 that are the same in every run.
fn numbers(count: usize) -> Vec<f32> {
    let mut random = Random::new(1);
    (0..count).map(|_| random.signed() as f32).collect()
}

/// Unit vectors, a block of sixteen at a time.
fn units<const N: usize>(blocks: usize) -> Vec<Block<f32, N>> {
    let mut random = Random::new(1);
    let mut all = vec![Block::<f32, N>::zero(); blocks];
    for block in &mut all {
        for k in 0..16 {
            for (line, x) in block.0.iter_mut().zip(random.unit::<N>()) {
                line[k] = x as f32;
            }
        }
    }
    all
}

fn blocks<const N: usize>(count: usize) -> Vec<Block<f32, N>> {
    let mut numbers = numbers(count * N * 16).into_iter();
    let mut all = vec![Block::<f32, N>::zero(); count];
    for block in &mut all {
        block.0.iter_mut().flatten().for_each(|x| *x = numbers.next().unwrap_or(0.5));
    }
    all
}

/// What a run of an order measures.
struct Run<'a> {
    unit: Unit,
    peak: f64,
    rounds: Rounds,
    signals: usize,
    order: usize,
    rows: &'a mut Vec<Measured>,
    /// What is timed, by function and layout, where not everything is.
    only: &'a [String],
}

impl Run<'_> {
    fn add(&mut self, function: &str, layout: &str, multiplications: usize, copy: impl FnMut(), work: impl FnMut()) {
        let is_wanted = |wanted: &String| function == wanted || layout == wanted;
        if !self.only.iter().all(is_wanted) {
            return;
        }
        let [copy, nanoseconds] = both(self.rounds, self.signals, copy, work);
        self.rows.push(Measured {
            unit: self.unit.to_string(),
            function: function.to_owned(),
            layout: layout.to_owned(),
            order: self.order,
            signals: self.signals,
            nanoseconds,
            copy,
            multiplications: multiplications as f64 / self.peak,
        });
    }
}

fn done(result: Result<(), Error>) {
    result.expect("sizes fit");
}

/// Copies bytes, opaquely.
fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    black_box(&mut *to).copy_from_slice(black_box(from));
}

/// Times all functions of an order.
fn order<const N: usize>(run: &mut Run<'_>) {
    let (n, count) = (run.order, run.signals / 16);
    let rotate = multiplications(&format!("rotate:{n}"), false);
    let all = multiplications(&format!("rotate:{n}:zyz"), true);
    let tilt = multiplications(&format!("tilt:{n}"), false);
    let (basis, eval) = (multiplications(&format!("basis:{n}"), false), multiplications(&format!("eval:{n}"), false));
    let (quaternions, directions) = (units::<4>(count), units::<3>(count));
    let q = [0.36_f32, 0.48, 0.0, 0.8];
    {
        let (from, mut to) = (blocks::<N>(count), vec![Block::<f32, N>::zero(); count]);
        let mut copied = to.clone();
        let mut values = vec![Block::<f32, 1>::zero(); count];
        run.add(
            "rotate_each",
            "blocks",
            rotate,
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_each(black_box(&quaternions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "rotate_all",
            "blocks",
            all,
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_all(black_box(q), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "tilt_each",
            "blocks",
            tilt,
            || copy(&from, &mut copied),
            || {
                done(batch::tilt_each(black_box(&directions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "eval_each",
            "blocks",
            eval,
            || copy(&from, &mut copied),
            || {
                done(batch::eval_each(black_box(&directions), black_box(&from), black_box(&mut values)));
            },
        );
        let fill = |to: &mut Vec<Block<f32, N>>| black_box(to).fill(black_box(Block::zero()));
        run.add(
            "basis_each",
            "blocks",
            basis,
            || fill(&mut copied),
            || {
                done(batch::basis_each(black_box(&directions), black_box(&mut to)));
            },
        );
    }
    {
        let from = numbers(run.signals * N)
            .chunks_exact(N)
            .map(|c| c.try_into().expect("N numbers"))
            .collect::<Vec<[f32; N]>>();
        let (mut to, mut copied) = (from.clone(), from.clone());
        run.add(
            "rotate_each",
            "arrays",
            rotate,
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_each(black_box(&quaternions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "rotate_all",
            "arrays",
            all,
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_all(black_box(q), black_box(&from), black_box(&mut to)));
            },
        );
    }
    if n == 4 {
        let from = numbers(run.signals * 48);
        let (mut to, mut copied) = (from.clone(), from.clone());
        let row = Row::splat(16);
        run.add(
            "rotate_each",
            "splats",
            3 * rotate,
            || copy(&from, &mut copied),
            || {
                let (from, to) = (Signals::rows(&from, 48, row), SignalsMut::rows(&mut to, 48, row));
                done(batch::rotate_each(black_box(&quaternions), from.expect("fits"), to.expect("fits")));
            },
        );
        run.add(
            "rotate_all",
            "splats",
            3 * all,
            || copy(&from, &mut copied),
            || {
                let (from, to) = (Signals::rows(&from, 48, row), SignalsMut::rows(&mut to, 48, row));
                done(batch::rotate_all(black_box(q), from.expect("fits"), to.expect("fits")));
            },
        );
    }
}

/// Times every function at some orders with a unit.
pub fn measure(
    unit: Unit,
    peak: f64,
    orders: &[usize],
    signals: usize,
    rounds: Rounds,
    only: &[String],
    mut step: impl FnMut(),
) -> Vec<Measured> {
    unit.at_most();
    let mut rows = Vec::new();
    for &n in orders {
        let mut run = Run { unit, peak, rounds, signals, order: n, rows: &mut rows, only };
        match n {
            2 => order::<4>(&mut run),
            3 => order::<9>(&mut run),
            4 => order::<16>(&mut run),
            5 => order::<25>(&mut run),
            6 => order::<36>(&mut run),
            7 => order::<49>(&mut run),
            8 => order::<64>(&mut run),
            9 => order::<81>(&mut run),
            10 => order::<100>(&mut run),
            _ => {}
        }
        step();
    }
    rows
}
