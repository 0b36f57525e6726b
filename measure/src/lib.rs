//! Speed against accuracy, measured: what every rotation method costs, how far it errs at which angle, how it rounds in
//! each precision, what a budget buys. [`Report::measure`] measures, [`render`] turns a report into tables and plots,
//! [`Report::differences`] says where a report is stale. Everything but the times is the same on every run.

pub mod bounds;
#[cfg(feature = "times")]
pub mod clock;
pub mod costs;
pub mod errors;
pub mod factorisation;
pub mod filtering;
pub mod fronts;
pub mod glossy;
pub mod hemisphere;
pub mod instructions;
mod markdown;
pub mod methods;
pub mod numbers;
pub mod papers;
pub mod plots;
pub mod raster;
pub mod report;
pub mod ringing;
pub mod rounding;
pub mod shading;
mod sphere;
pub mod stability;
pub mod svg;
pub mod tables;
pub mod timing;
pub mod turns;

pub use report::Report;

use rayon::prelude::*;
use std::path::Path;

/// Where a run says how far it is.
pub trait Progress: Sync {
    /// A stage of so many steps begins.
    fn stage(&self, name: &str, steps: usize);
    /// A step is done.
    fn step(&self);
}

/// Says nothing.
#[derive(Debug)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _: &str, _: usize) {}
    fn step(&self) {}
}

/// Does one stage in parallel; the results keep the order of the tasks.
fn each<T: Sync, R: Send>(progress: &dyn Progress, name: &str, tasks: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    progress.stage(name, tasks.len());
    let done = |task| {
        let result = work(task);
        progress.step();
        result
    };
    // One task at a time: they differ a hundredfold in size, the largest come last.
    tasks.par_iter().with_max_len(1).map(done).collect()
}

/// A number with four significant digits, as reports hold it.
pub fn significant(value: f64) -> f64 {
    format!("{value:.3e}").parse().expect("a number prints as a number")
}

/// A file of `docs/measure`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// A file of `docs/measure` that `measure/peers` writes: what other programs take, in the same run.
pub const PEERS: &str = "peers.md";

/// Every file of text that a report makes, itself among them.
pub fn render(report: &Report) -> Vec<File> {
    let mut files = vec![File { name: "measure.json".to_owned(), text: report.to_json() }];
    files.extend(tables::files(report));
    files.extend(plots::files(report));
    files.extend(hemisphere::pages::files(&report.hemisphere));
    files
}

/// What is stale in a folder of tables and plots, given a fresh report: figures that changed, times apart, bounds that are
/// no longer what is proven, files that are not what the folder's own figures make, and pictures that are not the report's.
pub fn stale(folder: &Path, fresh: &Report) -> Vec<String> {
    let path = folder.join("measure.json");
    let fault = |error: &dyn std::fmt::Display| vec![format!("{}: {error}", path.display())];
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => return fault(&error),
    };
    let old: Report = match serde_json::from_str(&text) {
        Ok(old) => old,
        Err(error) => return fault(&error),
    };
    let differs = |file: &File| std::fs::read_to_string(folder.join(&file.name)).map_or(true, |text| text != file.text);
    let files = render(&old).into_iter().filter(differs).map(|file| format!("{} does not show its figures", file.name));
    let bounds = bounds::stale(old.bounds.as_deref().unwrap_or_default());
    let instructions = instructions::stale(old.instructions.as_deref().unwrap_or_default());
    let pictures = fresh.pictures().filter_map(|picture| picture.stale(folder));
    old.differences(fresh).into_iter().chain(files).chain(bounds).chain(instructions).chain(pictures).collect()
}
