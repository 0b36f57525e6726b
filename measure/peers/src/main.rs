//! The worker in Rust of `measure/peers/peers.py`: zonal's rows and those of crates, timed when asked, so that rounds of
//! all workers alternate on one core. It is compiled twice, for the architecture's baseline and for this processor.
//!
//! `zonal-peers FOLDER SIGNALS` writes so many inputs and the results in f64 to the folder, says its rows, one a line, ends them with
//! an empty line, and answers each number of a row with nanoseconds a signal. `results` writes what the rows give.

#[path = "../../../runtime/benches/calls/mod.rs"]
mod calls;

use calls::{Inputs, Make, Row, Work};
use sphrs::{Coordinates, HarmonicsSet, RealSH};
use std::fs;
use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::time::Instant;
use zonal::batch::{self, Block, Signals, SignalsMut};
use zonal::{Coefficients, Error, Rotation};

/// A round is the fastest of so many passes.
const PASSES: usize = 5;

/// The harmonics of the crate sphrs, in f32, to the degree below an order.
struct Sphrs {
    directions: Vec<[f32; 3]>,
    set: HarmonicsSet<f32, RealSH>,
    written: Vec<f32>,
}

impl Work for Sphrs {
    fn run(&mut self) {
        self.written.clear();
        for &[x, y, z] in &self.directions {
            self.written.extend(self.set.eval(&Coordinates::cartesian(x, y, z)));
        }
    }

    fn written(&self) -> &[f32] {
        &self.written
    }
}

fn sphrs(order: usize) -> Row {
    let make: Make = Box::new(move |inputs| {
        let set = HarmonicsSet::new(order - 1, RealSH::Spherical);
        Box::new(Sphrs { directions: inputs.directions.clone(), set, written: Vec::new() })
    });
    Row { function: "evaluate_basis", form: "sphrs", order, make }
}

/// Rows of splats as files have them, 3 first coefficients and the rest of red, green and blue, turned as one who has them
/// in memory does it: a channel at a time, by one rotation for all.
struct Splats<const N: usize>
where
    [f32; N]: Coefficients,
{
    turn: Rotation<[f32; N]>,
    rows: Vec<f32>,
    written: Vec<f32>,
}

impl<const N: usize> Work for Splats<N>
where
    [f32; N]: Coefficients<Element = f32, Scalar = f32>,
{
    fn run(&mut self) {
        self.written.copy_from_slice(&self.rows);
        for row in self.written.chunks_exact_mut(3 * N) {
            for channel in 0..3 {
                let rest = 3 + channel * (N - 1);
                let c = std::array::from_fn(|i| if i == 0 { row[channel] } else { row[rest + i - 1] });
                row[rest..rest + N - 1].copy_from_slice(&self.turn.apply(&c)[1..]);
            }
        }
    }

    fn written(&self) -> &[f32] {
        &self.written
    }
}

/// The signal of a channel of a splat, of whose 100 numbers the channels take n² each.
fn channel<const N: usize>(numbers: &[f32; 100], channel: usize) -> [f32; N] {
    std::array::from_fn(|i| numbers[channel * N + i])
}

/// A splat of three signals.
fn splat<T: Copy, const N: usize>(channels: [[T; N]; 3]) -> Vec<T> {
    channels.iter().map(|c| c[0]).chain(channels.iter().flat_map(|c| c[1..].iter().copied())).collect()
}

fn splats<const N: usize>(order: usize) -> Row
where
    [f32; N]: Coefficients<Element = f32, Scalar = f32>,
{
    let row = |numbers: &[f32; 100]| splat::<f32, N>([0, 1, 2].map(|place| channel(numbers, place)));
    let make: Make = Box::new(move |inputs| {
        let rows: Vec<f32> = inputs.signals.iter().flat_map(row).collect();
        Box::new(Splats { turn: Rotation::new(inputs.quaternions[0]), written: rows.clone(), rows })
    });
    Row { function: "splats", form: "call", order, make }
}

/// A batch, and what it wrote, signal after signal.
struct Batched<B, W> {
    run: B,
    written: W,
    rows: std::cell::OnceCell<Vec<f32>>,
}

/// What batches write to.
trait Written {
    fn rows(&self) -> Vec<f32>;
}

impl Written for Vec<f32> {
    fn rows(&self) -> Vec<f32> {
        self.clone()
    }
}

impl<const N: usize> Written for Vec<[f32; N]> {
    fn rows(&self) -> Vec<f32> {
        self.as_flattened().to_vec()
    }
}

impl<const N: usize> Written for Vec<Block<f32, N>> {
    fn rows(&self) -> Vec<f32> {
        (0..self.len() * 16).flat_map(|k| self[k / 16].0.map(|line| line[k % 16])).collect()
    }
}

impl<W: Written, B: FnMut(&mut W) -> Result<(), Error>> Work for Batched<B, W> {
    fn run(&mut self) {
        (self.run)(&mut self.written).expect("sizes fit");
    }

    fn written(&self) -> &[f32] {
        self.rows.get_or_init(|| self.written.rows())
    }
}

fn batched<W: Written + 'static>(
    written: W,
    run: impl FnMut(&mut W) -> Result<(), Error> + 'static,
) -> Box<dyn Work> {
    Box::new(Batched { run, written, rows: std::cell::OnceCell::new() })
}

/// Signals of an order as arrays.
fn arrays<const N: usize>(inputs: &Inputs) -> Vec<[f32; N]> {
    inputs.signals.iter().map(|c| std::array::from_fn(|i| c[i])).collect()
}

/// The same, or parameters, in blocks.
fn blocks<const N: usize>(arrays: &[[f32; N]]) -> Vec<Block<f32, N>> {
    let mut blocks = vec![Block::zero(); Block::<f32, N>::count(arrays.len())];
    batch::copy_each(arrays, &mut blocks).expect("as many blocks as hold the arrays");
    blocks
}

/// The batches of an order: of arrays, and of blocks.
fn batches<const N: usize>(order: usize) -> Vec<Row> {
    let row = |function, form, make: fn(&Inputs) -> Box<dyn Work>| Row { function, form, order, make: Box::new(make) };
    vec![
        row("rotate", "arrays", |inputs| {
            let (q, c) = (inputs.quaternions.clone(), arrays::<N>(inputs));
            batched(c.clone(), move |to| batch::rotate_each(&q, &c, to))
        }),
        row("rotate", "blocks", |inputs| {
            let (q, c) = (blocks(&inputs.quaternions), blocks(&arrays::<N>(inputs)));
            batched(c.clone(), move |to| batch::rotate_each(&q, &c, to))
        }),
        row("apply", "arrays", |inputs| {
            let (q, c) = (inputs.quaternions[0], arrays::<N>(inputs));
            batched(c.clone(), move |to| batch::rotate_all(q, &c, to))
        }),
        row("apply", "blocks", |inputs| {
            let (q, c) = (inputs.quaternions[0], blocks(&arrays::<N>(inputs)));
            batched(c.clone(), move |to| batch::rotate_all(q, &c, to))
        }),
        row("evaluate_basis", "arrays", |inputs| {
            let directions = inputs.directions.clone();
            batched(arrays::<N>(inputs), move |to| batch::basis_each(&directions, to))
        }),
        row("evaluate_basis", "blocks", |inputs| {
            let directions = blocks(&inputs.directions);
            batched(blocks(&arrays::<N>(inputs)), move |to| batch::basis_each(&directions, to))
        }),
        row("evaluate", "arrays", |inputs| {
            let (directions, c) = (inputs.directions.clone(), arrays::<N>(inputs));
            batched(vec![0.0_f32; c.len()], move |to: &mut Vec<f32>| batch::eval_each(&directions, &c, to.as_mut_slice()))
        }),
        row("evaluate", "blocks", |inputs| {
            let (directions, c) = (blocks(&inputs.directions), blocks(&arrays::<N>(inputs)));
            batched(vec![Block::<f32, 1>::zero(); c.len()], move |to| batch::eval_each(&directions, &c, to))
        }),
        row("tilt", "arrays", |inputs| {
            let (n, c) = (inputs.normals.clone(), arrays::<N>(inputs));
            batched(c.clone(), move |to| batch::tilt_each(&n, &c, to))
        }),
        row("tilt", "blocks", |inputs| {
            let (n, c) = (blocks(&inputs.normals), blocks(&arrays::<N>(inputs)));
            batched(c.clone(), move |to| batch::tilt_each(&n, &c, to))
        }),
    ]
}

/// Rows of splats by a batch.
fn splat_batch<const N: usize>(order: usize) -> Row {
    let make: Make = Box::new(|inputs| {
        let row = |numbers: &[f32; 100]| splat::<f32, N>([0, 1, 2].map(|place| channel(numbers, place)));
        let rows: Vec<f32> = inputs.signals.iter().flat_map(row).collect();
        let (q, places) = (inputs.quaternions[0], zonal::batch::Row::splat(N));
        batched(rows.clone(), move |to: &mut Vec<f32>| {
            batch::rotate_all(q, Signals::rows(&rows, 3 * N, places)?, SignalsMut::rows(to, 3 * N, places)?)
        })
    });
    Row { function: "splats", form: "arrays", order, make }
}

fn bytes(numbers: impl IntoIterator<Item = f64>) -> Vec<u8> {
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}

fn wide<const N: usize>(x: &[f32; N]) -> [f64; N] {
    x.map(f64::from)
}

/// The same in f64, of length one to its precision.
fn unit<const N: usize>(x: &[f32; N]) -> [f64; N] {
    let x = wide(x);
    let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    x.map(|x| x / length)
}

/// What zonal gives in f64 at an order, function after function.
fn truth<const N: usize>(folder: &Path, inputs: &Inputs, order: usize) -> io::Result<()>
where
    [f64; N]: Coefficients<Element = f64, Scalar = f64, Basis = [f64; N]>,
{
    let signals: Vec<[f64; N]> = inputs.signals.iter().map(|c| std::array::from_fn(|i| f64::from(c[i]))).collect();
    let write =
        |function: &str, numbers: Vec<f64>| fs::write(folder.join(format!("{function}.{order}")), bytes(numbers));
    let turned = |q: &[f32; 4], c: &[f64; N]| zonal::rotate(unit(q), c);
    write("rotate", inputs.quaternions.iter().zip(&signals).flat_map(|(q, c)| turned(q, c)).collect())?;
    write("apply", signals.iter().flat_map(|c| turned(&inputs.quaternions[0], c)).collect())?;
    write(
        "evaluate_basis",
        inputs.directions.iter().flat_map(|dir| zonal::evaluate_basis::<[f64; N]>(unit(dir))).collect(),
    )?;
    write("evaluate", inputs.directions.iter().zip(&signals).map(|(dir, c)| zonal::evaluate(unit(dir), c)).collect())?;
    write("tilt", inputs.normals.iter().zip(&signals).flat_map(|(n, c)| zonal::tilt(unit(n), c)).collect())
}

/// What zonal gives in f64 for splats of an order.
fn splat_truth<const N: usize>(folder: &Path, inputs: &Inputs, order: usize) -> io::Result<()>
where
    [f64; N]: Coefficients<Element = f64, Scalar = f64>,
{
    let turned = |c: [f32; N]| zonal::rotate(unit(&inputs.quaternions[0]), &wide(&c));
    let row = |numbers: &[f32; 100]| splat([0, 1, 2].map(|place| turned(channel(numbers, place))));
    fs::write(folder.join(format!("splats.{order}")), bytes(inputs.signals.iter().flat_map(row)))
}

fn inputs_to(folder: &Path, inputs: &Inputs) -> io::Result<()> {
    fs::write(folder.join("quaternions"), bytes(inputs.quaternions.iter().flat_map(wide)))?;
    fs::write(folder.join("directions"), bytes(inputs.directions.iter().flat_map(wide)))?;
    fs::write(folder.join("signals"), bytes(inputs.signals.iter().flat_map(wide)))?;
    macro_rules! orders {
        ($($order:literal),*) => { $(truth::<{ $order * $order }>(folder, inputs, $order)?;)* };
    }
    orders!(2, 3, 4, 5, 6, 7, 8, 9, 10);
    splat_truth::<4>(folder, inputs, 2)?;
    splat_truth::<9>(folder, inputs, 3)?;
    splat_truth::<16>(folder, inputs, 4)
}

fn time(work: &mut dyn Work, signals: usize) -> f64 {
    let mut pass = || {
        let start = Instant::now();
        work.run();
        let elapsed = start.elapsed();
        black_box(work.written());
        elapsed.as_nanos() as f64 / signals as f64
    };
    (0..PASSES).map(|_| pass()).fold(f64::INFINITY, f64::min)
}

fn main() -> io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let usage = || io::Error::other("usage: zonal-peers FOLDER SIGNALS");
    let folder = arguments.next().ok_or_else(usage)?;
    let count: usize = arguments.next().and_then(|count| count.parse().ok()).ok_or_else(usage)?;
    let (folder, inputs) = (Path::new(&folder), Inputs::new(count));
    inputs_to(folder, &inputs)?;
    let mut rows = calls::rows();
    rows.extend((2..=10).map(sphrs));
    rows.extend([splats::<4>(2), splats::<9>(3), splats::<16>(4)]);
    rows.extend([splat_batch::<4>(2), splat_batch::<9>(3), splat_batch::<16>(4)]);
    macro_rules! batches {
        ($($order:literal),*) => { $(rows.extend(batches::<{ $order * $order }>($order));)* };
    }
    batches!(2, 3, 4, 5, 6, 7, 8, 9, 10);

    let mut output = io::stdout().lock();
    rows.iter().try_for_each(|row| writeln!(output, "{} {} {}", row.function, row.order, row.form))?;
    writeln!(output)?;
    output.flush()?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        match line.parse::<usize>().ok().and_then(|place| rows.get(place)) {
            Some(row) => writeln!(output, "{}", time((row.make)(&inputs).as_mut(), count))?,
            None if line == "results" => {
                for (place, row) in rows.iter().enumerate() {
                    let mut work = (row.make)(&inputs);
                    work.run();
                    let numbers = work.written().iter().map(|&x| x.into());
                    fs::write(folder.join(format!("result.{place}")), bytes(numbers))?;
                }
                writeln!(output)?;
            }
            None => return Err(io::Error::other(format!("`{line}` is neither a row nor `results`"))),
        }
        output.flush()?;
    }
    Ok(())
}
