//! The times: each function, order and layout beside a copy, in turn, the fastest of many rounds.

use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::time::Instant;
use zonal::Error;
use zonal::batch::{self, Block, Row, Signals, SignalsMut, Unit};
use zonal_codegen::families::family::Spec;
use zonal_codegen::ir::code::Code;
use zonal_codegen::promise::samples::Random;

/// How many signals lie in a cache at most.
pub const IN_CACHE: usize = 1024;
/// How many bytes of signals and results lie in a core's own cache wherever its pages are: half of one of a mebibyte.
pub const CACHED: usize = 512 << 10;
/// How many bytes of signals and results lie in none: twice as many as the last cache of a desktop's processor holds.
pub const STREAMED: usize = 64 << 20;

/// How many signals of so many numbers have those bytes: whole thousands.
#[must_use]
pub fn streamed(numbers: usize) -> usize {
    STREAMED.div_ceil(2 * numbers * size_of::<f32>()).next_multiple_of(1024)
}

/// How often everything is made anew, so that where it comes to lie in memory is luck of one time alone.
const TAKES: usize = 6;

/// Where signals lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[derive(clap::ValueEnum)]
pub enum Place {
    /// In a cache of the core.
    Cache,
    /// In memory.
    Memory,
}

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
    /// Where the signals lie.
    pub place: Place,
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
    place: Place,
    order: usize,
    rows: &'a mut Vec<Measured>,
    /// What is timed, by function and layout, where not everything is.
    only: &'a [String],
}

impl Run<'_> {
    /// How many signals of so many numbers there are.
    fn signals(&self, numbers: usize) -> usize {
        match self.place {
            Place::Cache => IN_CACHE.min(CACHED / (2 * numbers * size_of::<f32>()) / 64 * 64),
            Place::Memory => streamed(numbers),
        }
    }

    fn add(
        &mut self,
        function: &str,
        layout: &str,
        (signals, multiplications): (usize, usize),
        copy: impl FnMut(),
        work: impl FnMut(),
    ) {
        let is_wanted = |wanted: &String| function == wanted || layout == wanted;
        if !self.only.iter().all(is_wanted) {
            return;
        }
        let [copy, nanoseconds] = both(self.rounds, signals, copy, work);
        let is_same = |row: &&mut Measured| row.function == function && row.layout == layout && row.order == self.order;
        if let Some(row) = self.rows.iter_mut().find(is_same) {
            row.nanoseconds = row.nanoseconds.min(nanoseconds);
            row.copy = row.copy.min(copy);
            return;
        }
        self.rows.push(Measured {
            unit: self.unit.to_string(),
            function: function.to_owned(),
            layout: layout.to_owned(),
            order: self.order,
            place: self.place,
            signals,
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
    let (n, signals) = (run.order, run.signals(N));
    let count = signals / 16;
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
            (signals, rotate),
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_each(black_box(&quaternions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "rotate_all",
            "blocks",
            (signals, all),
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_all(black_box(q), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "tilt_each",
            "blocks",
            (signals, tilt),
            || copy(&from, &mut copied),
            || {
                done(batch::tilt_each(black_box(&directions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "eval_each",
            "blocks",
            (signals, eval),
            || copy(&from, &mut copied),
            || {
                done(batch::eval_each(black_box(&directions), black_box(&from), black_box(&mut values)));
            },
        );
        let fill = |to: &mut Vec<Block<f32, N>>| black_box(to).fill(black_box(Block::zero()));
        run.add(
            "basis_each",
            "blocks",
            (signals, basis),
            || fill(&mut copied),
            || {
                done(batch::basis_each(black_box(&directions), black_box(&mut to)));
            },
        );
    }
    {
        let from =
            numbers(signals * N).chunks_exact(N).map(|c| c.try_into().expect("N numbers")).collect::<Vec<[f32; N]>>();
        let (mut to, mut copied) = (from.clone(), from.clone());
        run.add(
            "rotate_each",
            "arrays",
            (signals, rotate),
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_each(black_box(&quaternions), black_box(&from), black_box(&mut to)));
            },
        );
        run.add(
            "rotate_all",
            "arrays",
            (signals, all),
            || copy(&from, &mut copied),
            || {
                done(batch::rotate_all(black_box(q), black_box(&from), black_box(&mut to)));
            },
        );
    }
    if n == 4 {
        let signals = run.signals(48);
        let (from, quaternions) = (numbers(signals * 48), units::<4>(signals / 16));
        let (mut to, mut copied) = (from.clone(), from.clone());
        let row = Row::splat(16);
        run.add(
            "rotate_each",
            "splats",
            (signals, 3 * rotate),
            || copy(&from, &mut copied),
            || {
                let (from, to) = (Signals::rows(&from, 48, row), SignalsMut::rows(&mut to, 48, row));
                done(batch::rotate_each(black_box(&quaternions), from.expect("fits"), to.expect("fits")));
            },
        );
        run.add(
            "rotate_all",
            "splats",
            (signals, 3 * all),
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
    place: Place,
    rounds: Rounds,
    only: &[String],
) -> Vec<Measured> {
    unit.at_most();
    let mut rows = Vec::new();
    for &n in orders {
        for take in 0..TAKES {
            // What is kept here meanwhile has other pages of memory taken for the signals.
            let kept = vec![1_u8; take << 20];
            black_box(&kept);
            let rounds = Rounds { rounds: rounds.rounds.div_ceil(TAKES), ..rounds };
            let mut run = Run { unit, peak, rounds, place, order: n, rows: &mut rows, only };
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
        }
    }
    rows
}
