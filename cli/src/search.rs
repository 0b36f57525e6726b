//! The command that searches for lobe directions: which searches, for how long, and where their states and their finds go.

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use zonal_cli::terminal::{Failure, out};
// Names a family: the search for its lobes is a command.
use zonal_codegen::families::zhf::lobes::{HIGHEST_SIZE, Mode, Record, Records, chosen};
use zonal_codegen::families::zhf::search::{self, Search, Task};
use zonal_codegen::files::{self, File};
use zonal_codegen::plan::text::table;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// How many tries are made between two writings of the state.
const BATCH: usize = 8;

const HEAD: &str = "\
# Lobe directions for the zonal harmonic factorization: what `zonal search-lobes --out` found and kept, by mode and size
# the sets that no other beats in both non-zeros of Â and condition of Y. A seed and a try (`attempt`) find a set again;
# src/sh/zhf.rs says how a direction is written and which of the sets kernels use.
";

/// What to search, for how long.
#[derive(Args)]
pub struct Arguments {
    /// How bands share directions: the first of them, any of them, or a band of its own. Without it, each of the three.
    #[arg(long, value_parser = Mode::ALL.map(|(_, name)| name))]
    mode: Option<String>,
    /// The order, or for `band` the band, 2 to 10; a range as in `2-6`.
    #[arg(long, default_value = "2-6", value_parser = sizes)]
    size: RangeInclusive<usize>,
    /// The seed: one seed finds one result.
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// How many tries for each set; with --resume those of the state count.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    tries: u64,
    /// Ends after about so many seconds, the same for each set, wherever the tries are.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seconds: Option<u64>,
    /// The largest condition number of a set that is kept.
    #[arg(long, default_value_t = 100.0)]
    max_condition: f64,
    /// A state file: read if it exists, written as the search goes on.
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Adds what is found to a file of lobe sets, which keeps what nothing beats.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn sizes(text: &str) -> Result<RangeInclusive<usize>, String> {
    let (from, to) = text.split_once('-').unwrap_or((text, text));
    let number = |text: &str| text.parse::<usize>().map_err(|_| format!("`{text}` is no number; write it as 5 or 2-6"));
    let (from, to) = (number(from)?, number(to)?);
    match 2 <= from && from <= to && to <= HIGHEST_SIZE {
        true => Ok(from..=to),
        false => Err(format!("sizes are 2 to {HIGHEST_SIZE}, the smaller first")),
    }
}

fn write(path: &Path, text: String) -> Result<(), Failure> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    files::write(folder, &[File { path: name, text }])?;
    Ok(())
}

/// The text of a file, or none if there is no such file.
fn read(path: &Path) -> Result<Option<String>, Failure> {
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => {
            Err(Diagnostic::nowhere(format!("{}: cannot be read ({error})", path.display()), "check the path").into())
        }
    }
}

fn known(path: &Path) -> Result<Vec<Record>, Failure> {
    let Some(text) = read(path)? else { return Ok(Vec::new()) };
    let records: Records = toml::from_str(&text).map_err(|error| {
        let message = format!("{}: holds no lobe sets: {}", path.display(), error.message());
        Diagnostic::nowhere(message, "name a file that `--out` wrote, or a new one")
    })?;
    Ok(records.set)
}

fn zeros(record: &Record) -> f64 {
    let entries: usize = record.mode.bands(record.size).map(|l| (2 * l + 1).pow(2)).sum();
    100.0 * (1.0 - record.total() as f64 / entries as f64)
}

fn shown(searches: &[Search]) -> String {
    let head = ["set", "tries", "non-zeros", "zeros in %", "condition", "try", "kernels use", "condition"];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for search in searches {
        let Task { mode, size, .. } = search.task;
        let own = chosen(mode, size);
        let cell = |of: &dyn Fn(&Record) -> String, record: Option<&Record>| record.map_or_else(|| "-".to_owned(), of);
        let mut rows: Vec<Option<&Record>> = search.found.iter().map(Some).collect();
        if rows.is_empty() {
            rows.push(None);
        }
        for (i, record) in rows.into_iter().enumerate() {
            let (name, tries, own) = match i {
                0 => (format!("{} {size}", mode.name()), search.tries.to_string(), own),
                _ => (String::new(), String::new(), None),
            };
            lines.push(vec![
                name,
                tries,
                cell(&|r| r.total().to_string(), record),
                cell(&|r| format!("{:.1}", zeros(r)), record),
                cell(&|r| format!("{:.2}", r.condition), record),
                cell(&|r| r.attempt.to_string(), record),
                own.map_or_else(String::new, |r| r.total().to_string()),
                own.map_or_else(String::new, |r| format!("{:.2}", r.condition)),
            ]);
        }
    }
    table(&lines)
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let modes = Mode::ALL.into_iter().filter(|(_, name)| arguments.mode.as_deref().is_none_or(|mode| mode == *name));
    let (seed, max_condition) = (arguments.seed, arguments.max_condition);
    let tasks: Vec<Task> = modes
        .flat_map(|(mode, _)| arguments.size.clone().map(move |size| Task { mode, size, seed, max_condition }))
        .collect();
    let fault = |error: search::SearchError| Diagnostic::nowhere(error.to_string(), "see `zonal search-lobes --help`");
    let mut searches = tasks.iter().map(|task| Search::new(*task)).collect::<Result<Vec<_>, _>>().map_err(fault)?;
    if let Some(path) = &arguments.resume
        && let Some(text) = read(path)?
    {
        searches = search::resume(&text, &tasks).map_err(|error| {
            let help = "go on with the options that it was made with, or name another file";
            Diagnostic::nowhere(format!("{}: {error}", path.display()), help)
        })?;
    }
    // What cannot be added to is better known before the search than after it.
    let mut all = arguments.out.as_deref().map(known).transpose()?;

    let tries = arguments.tries as usize;
    let made: usize = searches.iter().map(|search| search.tries.min(tries)).sum();
    let style = ProgressStyle::with_template("{msg:40} [{bar:40}] {pos}/{len} {elapsed}").expect("is a template");
    let bar = ProgressBar::new((tries * searches.len()) as u64).with_style(style.progress_chars("=> "));
    bar.set_position(made as u64);
    bar.enable_steady_tick(Duration::from_millis(200));
    let share = arguments.seconds.map(|seconds| Duration::from_secs(seconds) / searches.len() as u32);
    for i in 0..searches.len() {
        let start = Instant::now();
        while searches[i].tries < tries && share.is_none_or(|share| start.elapsed() < share) {
            let best = searches[i].best().map_or_else(String::new, |r| format!(": {} non-zeros", r.total()));
            bar.set_message(format!("{} {}{best}", searches[i].task.mode.name(), searches[i].task.size));
            let batch = BATCH.min(tries - searches[i].tries);
            searches[i].advance(batch, || bar.inc(1));
            if let Some(path) = &arguments.resume {
                write(path, search::state_text(&searches))?;
            }
        }
    }
    bar.finish_and_clear();

    if let (Some(path), Some(all)) = (&arguments.out, &mut all) {
        searches.iter().flat_map(|search| &search.found).for_each(|record| search::keep(all, record.clone()));
        let text = toml::to_string(&Records { set: all.clone() })
            .map_err(|error| Diagnostic::nowhere(format!("cannot write the sets: {error}"), ""))?;
        write(path, format!("{HEAD}\n{text}"))?;
    }
    out(&shown(&searches))
}
