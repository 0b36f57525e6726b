//! The worker in Rust of `measure/peers/peers.py`: zonal's rows and those of crates, timed when asked, so that rounds of
//! all workers alternate on one core. It is compiled twice, for the architecture's baseline and for this processor.
//!
//! `zonal-peers FOLDER` writes the inputs and the results in f64 to the folder, says its rows, one a line, ends them with
//! an empty line, and answers each number of a row with nanoseconds a signal. `results` writes what the rows gave.

#[path = "../../../runtime/benches/calls/mod.rs"]
#[allow(dead_code)]
mod calls;

use calls::{Inputs, Row, Work};
use sphrs::{Coordinates, HarmonicsSet, RealSH};
use std::fs;
use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::time::Instant;

/// How many signals a row works on: what they take stays in the second cache.
const COUNT: usize = 1024;
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

fn sphrs(inputs: &Inputs, order: usize) -> Row {
    let set = HarmonicsSet::new(order - 1, RealSH::Spherical);
    let work = Sphrs { directions: inputs.directions.clone(), set, written: Vec::new() };
    Row { function: "evaluate_basis", form: "sphrs", order, work: Box::new(work) }
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
    [f64; N]: zonal::Coefficients<Element = f64, Scalar = f64, Basis = [f64; N]>,
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

fn inputs_to(folder: &Path, inputs: &Inputs) -> io::Result<()> {
    fs::write(folder.join("quaternions"), bytes(inputs.quaternions.iter().flat_map(wide)))?;
    fs::write(folder.join("directions"), bytes(inputs.directions.iter().flat_map(wide)))?;
    fs::write(folder.join("signals"), bytes(inputs.signals.iter().flat_map(wide)))?;
    macro_rules! orders {
        ($($order:literal),*) => { $(truth::<{ $order * $order }>(folder, inputs, $order)?;)* };
    }
    orders!(2, 3, 4, 5, 6, 7, 8, 9, 10);
    Ok(())
}

fn time(work: &mut dyn Work) -> f64 {
    let mut pass = || {
        let start = Instant::now();
        work.run();
        let elapsed = start.elapsed();
        black_box(work.written());
        elapsed.as_nanos() as f64 / COUNT as f64
    };
    (0..PASSES).map(|_| pass()).fold(f64::INFINITY, f64::min)
}

fn main() -> io::Result<()> {
    let folder = std::env::args_os().nth(1).ok_or_else(|| io::Error::other("usage: zonal-peers FOLDER"))?;
    let (folder, inputs) = (Path::new(&folder), Inputs::new(COUNT));
    inputs_to(folder, &inputs)?;
    let mut rows = calls::rows(&inputs);
    rows.extend((2..=10).map(|order| sphrs(&inputs, order)));
    // A further form of zonal's functions, the batches among them, is a row here: its work, its name and its form.

    let mut output = io::stdout().lock();
    rows.iter().try_for_each(|row| writeln!(output, "{} {} {}", row.function, row.order, row.form))?;
    writeln!(output)?;
    output.flush()?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        match line.parse::<usize>().ok().and_then(|place| rows.get_mut(place)) {
            Some(row) => writeln!(output, "{}", time(row.work.as_mut()))?,
            None if line == "results" => {
                for (place, row) in rows.iter().enumerate() {
                    fs::write(
                        folder.join(format!("result.{place}")),
                        bytes(row.work.written().iter().map(|&x| x.into())),
                    )?;
                }
                writeln!(output)?;
            }
            None => return Err(io::Error::other(format!("`{line}` is neither a row nor `results`"))),
        }
        output.flush()?;
    }
    Ok(())
}
