//! The command `cargo measure-batches`: times every batch function beside a copy of the same bytes, prints each time with the
//! law's k, and writes `docs/BATCHES.md` and `docs/batches.json` if everything was timed.

use clap::Parser;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use zonal::batch::Unit;
use zonal_measure_batches::page::{self, Report};
use zonal_measure_batches::peak;
use zonal_measure_batches::time::{Measured, Place, Rounds, measure};

/// Time every batch function beside a copy of the same bytes.
#[derive(Parser)]
#[command(name = "cargo measure-batches", version)]
struct Arguments {
    /// The orders.
    #[arg(long, value_delimiter = ',', default_value = "2,3,4,5,6,7,8,9,10")]
    orders: Vec<usize>,
    /// How many rounds, of which the fastest counts.
    #[arg(long, default_value_t = 60)]
    rounds: usize,
    /// Time a function, a layout or both alone, and write nothing.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Time these units alone, and write nothing.
    #[arg(long, value_delimiter = ',')]
    units: Vec<String>,
    /// Time signals in a cache alone, or in memory, and write nothing.
    #[arg(long)]
    place: Option<Place>,
    /// Fail if anything that was timed takes longer than the page's laws allow.
    #[arg(long)]
    check: bool,
    /// The folder of the page and its figures.
    #[arg(long, default_value_os_t = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs"))]
    output: PathBuf,
}

/// What the system calls the processor.
fn machine() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        Some(line.split(':').nth(1)?.trim().to_owned())
    };
    let model = field("model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    match field("cpu family") {
        Some(family) => format!("{model}, family {family}"),
        None => model,
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut report = Report { machine: machine(), units: Vec::new(), rows: Vec::new() };
    for unit in Unit::ALL.into_iter().rev() {
        let is_asked_for = arguments.units.is_empty() || arguments.units.contains(&unit.to_string());
        if !is_asked_for {
            continue;
        }
        if !unit.is_there() {
            println!("{unit}: this processor has none");
            continue;
        }
        let peak = peak::multiplications(unit);
        println!("{unit}: {peak:.1} multiplications a nanosecond");
        report.units.push((unit.to_string(), peak));
        for place in [Place::Cache, Place::Memory] {
            if arguments.place.is_some_and(|asked| asked != place) {
                continue;
            }
            // A round from memory takes as long as many in a cache.
            let rounds = if place == Place::Cache { arguments.rounds } else { arguments.rounds.div_ceil(5) };
            let rounds = Rounds { rounds, signals: 20_480 };
            let rows = measure(unit, peak, &arguments.orders, place, rounds, &arguments.only);
            for row in &rows {
                let Measured { function, layout, order, signals, nanoseconds, copy, multiplications, .. } = row;
                println!(
                    "{unit} {signals:7} {function:12} {layout:8} {order:2}: {nanoseconds:7.2} ns, copy {copy:6.2}, peak \
                     {multiplications:6.2}, {:5.2} copies, k {:4.2}",
                    row.copies(),
                    row.k()
                );
            }
            report.rows.extend(rows);
        }
    }
    let is_whole = arguments.only.is_empty() && arguments.units.is_empty() && arguments.place.is_none();
    if is_whole && arguments.orders.len() == 9 {
        std::fs::write(arguments.output.join(page::JSON), page::json(&report)?)?;
        std::fs::write(arguments.output.join(page::PAGE), page::markdown(&report))?;
    }
    let not_held = page::not_held(&report);
    match arguments.check && !not_held.is_empty() {
        true => Err(not_held.join("\n").into()),
        false => Ok(()),
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
