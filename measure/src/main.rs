//! The command `cargo measure`: measures, and writes the tables and plots of `docs/measure`, or says that they are stale.
//! `cargo measure-times` is the same with the feature `times`: it takes the times too.

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;
use zonal_measure::timing::Timing;
use zonal_measure::{Progress, Report, bounds, instructions, render, stale};

/// Measure every method: errors over the angle, operations, memory, rounding, time.
#[derive(Parser)]
#[command(name = "cargo measure", version)]
struct Arguments {
    /// Compare the docs with a fresh measurement and the tables and plots with their figures; write nothing.
    #[arg(long)]
    check: bool,
    /// Measure only the rounding bounds: each kernel over so many inputs, a million by default, which takes minutes.
    #[arg(long, value_name = "INPUTS", num_args = 0..=1, default_missing_value = "1000000")]
    #[arg(conflicts_with = "check")]
    bounds: Option<usize>,
    /// Take only the times again; the command must be built for them, as `cargo measure-times` is.
    #[arg(long, conflicts_with_all = ["check", "bounds"])]
    only_times: bool,
    /// Count only the instructions of single calls, by valgrind, and say what has changed.
    #[arg(long, conflicts_with_all = ["check", "bounds", "only_times"])]
    instructions: bool,
    /// The folder of the tables and plots.
    #[arg(long, default_value_os_t = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measure"))]
    output: PathBuf,
}

/// A bar for the stage that is running.
struct Bar(Mutex<ProgressBar>);

impl Progress for Bar {
    fn stage(&self, name: &str, steps: usize) {
        let style = ProgressStyle::with_template("{msg:24} [{bar:40}] {pos}/{len} {elapsed}").expect("is a template");
        let bar = ProgressBar::new(steps as u64).with_style(style.progress_chars("=> ")).with_message(name.to_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        let mut current = self.0.lock().expect("no holder panics");
        current.finish();
        *current = bar;
    }

    fn step(&self) {
        self.0.lock().expect("no holder panics").inc(1);
    }
}

fn write(folder: &Path, report: &Report) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    render(report).into_iter().try_for_each(|file| std::fs::write(folder.join(file.name), file.text))?;
    report.pictures().try_for_each(|picture| std::fs::write(folder.join(&picture.name), picture.png()))
}

/// The report that a folder holds.
fn last(folder: &Path) -> Option<Report> {
    let text = std::fs::read_to_string(folder.join("measure.json")).ok()?;
    serde_json::from_str(&text).ok()
}

/// A part of the report that a folder holds, which may be of an earlier form in its other parts.
fn kept<T: serde::de::DeserializeOwned>(folder: &Path, part: &str) -> Option<T> {
    let text = std::fs::read_to_string(folder.join("measure.json")).ok()?;
    let mut report: serde_json::Value = serde_json::from_str(&text).ok()?;
    serde_json::from_value(report.get_mut(part)?.take()).ok()
}

/// The times: taken now, if the command was built for it, else those that the folder holds.
#[cfg(feature = "times")]
fn timing(_: &Path, bar: &Bar) -> Option<Timing> {
    Some(zonal_measure::clock::measure(bar))
}

#[cfg(not(feature = "times"))]
fn timing(folder: &Path, _: &Bar) -> Option<Timing> {
    kept(folder, "timing")
}

/// The report that the folder holds with one part of it measured again.
fn part(arguments: &Arguments, bar: &Bar) -> Result<Report, String> {
    let folder = &arguments.output;
    let old = last(folder)
        .ok_or_else(|| format!("{}: holds no report of this form; `cargo measure` writes one", folder.display()))?;
    let report = match arguments.bounds {
        Some(inputs) => Report { bounds: Some(bounds::measure(bar, inputs.max(1))), ..old },
        None if arguments.instructions => {
            let counted = instructions::measure(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))?;
            let before = old.instructions.as_deref().unwrap_or_default();
            instructions::changes(before, &counted).iter().for_each(|change| println!("{change}"));
            Report { instructions: Some(counted), ..old }
        }
        None => Report { timing: timing(folder, bar), ..old },
    };
    bar.0.lock().expect("no holder panics").finish();
    Ok(report)
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let folder = &arguments.output;
    let bar = Bar(Mutex::new(ProgressBar::hidden()));
    if arguments.bounds.is_some() || arguments.only_times || arguments.instructions {
        return match part(&arguments, &bar) {
            Ok(report) => written(folder, &report),
            Err(error) => {
                eprintln!("error: {error}");
                ExitCode::FAILURE
            }
        };
    }
    let mut report = Report::measure(&bar);
    if arguments.check {
        bar.0.lock().expect("no holder panics").finish();
        let found = stale(folder, &report);
        found.iter().take(20).for_each(|difference| eprintln!("{difference}"));
        return match found.len() {
            0 => ExitCode::SUCCESS,
            count => {
                eprintln!("{}: {count} differences; `cargo measure` writes it again", folder.display());
                ExitCode::FAILURE
            }
        };
    }
    report.timing = timing(folder, &bar);
    report.bounds = kept(folder, "bounds");
    report.instructions = kept(folder, "instructions");
    bar.0.lock().expect("no holder panics").finish();
    written(folder, &report)
}

fn written(folder: &Path, report: &Report) -> ExitCode {
    match write(folder, report) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}; name a folder that can be written with --output", folder.display());
            ExitCode::FAILURE
        }
    }
}
