//! The command line: its arguments, and how what goes wrong is shown.

mod commands;
mod explore;
mod plot;
mod render;
mod search;
mod vectors;

use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressFinish};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;
use zonal_codegen::builder::Error;
use zonal_codegen::drawn::draw;
use zonal_codegen::emit::language::{self, Arrays};
use zonal_codegen::families::Spec;
use zonal_codegen::families::text::family_names;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// Spherical-harmonics kernels as WGSL, GLSL and Rust, each with its cost and its error.
#[derive(Parser)]
#[command(version, about, after_help = "Try `zonal generate`, then read what it wrote; or `zonal show rotate:5`.")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Chooses, generates, validates and writes the kernels of a scene.
    Generate {
        /// The scene, a TOML file; without one, a glossy scene that zonal carries with it.
        scene: Option<PathBuf>,
        /// The folder to write to, instead of the one that the scene names.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Shows what a scene would get, and why.
    Plan {
        /// The scene, a TOML file; without one, the glossy scene that zonal carries with it.
        scene: Option<PathBuf>,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
        /// Writes a plot too: each method's error over the angle, with what the scene allows.
        #[arg(long, value_name = "FILE.svg")]
        plot: Option<PathBuf>,
    },
    /// Lists the standard specs with their costs and errors.
    List {
        /// Only this family.
        #[arg(long, value_parser = family_names())]
        family: Option<String>,
        /// Only this order.
        #[arg(long, value_parser = clap::value_parser!(u64).range(2..=10))]
        order: Option<u64>,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
    },
    /// Prints one kernel.
    Show {
        /// What to print, as in `rotate:5:rgb`.
        spec: String,
        /// The language.
        #[arg(long, default_value = "wgsl", value_parser = language::ALL.map(|language| language.name))]
        target: String,
        /// How it takes and returns arrays, if the language knows more than one way.
        #[arg(long, value_parser = Arrays::ALL.map(|(_, name)| name))]
        arrays: Option<String>,
    },
    /// Projects an environment map and says what each order leaves out.
    Project {
        /// The map, .hdr or .exr, twice as wide as high.
        map: PathBuf,
        /// How many bands.
        #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=64))]
        order: u64,
        /// Irradiance instead of radiance.
        #[arg(long)]
        irradiance: bool,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
    },
    /// Prints test vectors as JSON: inputs, and what a kernel gives in f32 and f64.
    Vectors {
        /// The kernel, as in `rotate:5:rgb`.
        spec: String,
        /// A JSON list of objects keyed by parameter name, instead of seeded inputs.
        #[arg(long, value_name = "FILE", conflicts_with_all = ["count", "seed"])]
        inputs: Option<PathBuf>,
        /// How many seeded inputs, extremes first.
        #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u64).range(1..=10_000))]
        count: u64,
        /// Which seeded inputs.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Writes a page that shows the kernels at work, and serves it to this machine.
    ///
    /// A normal-mapped object under an environment map, in WebGL2 or WebGPU: the chosen way to turn coefficients beside
    /// the exact one and their difference, with costs, errors and times.
    Explore {
        /// The folder to write to, instead of `zonal-out/explorer`.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// The port on 127.0.0.1; 0 takes one that is free.
        #[arg(long, value_name = "N", default_value_t = 0, conflicts_with = "no_serve")]
        port: u16,
        /// Only writes.
        #[arg(long)]
        no_serve: bool,
    },
    /// Draws the picture of a scene, or a comparison: `zonal render --help`.
    #[command(disable_help_flag = true)]
    Render {
        /// What `zonal-render` takes.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Writes the standard catalogue, or checks it.
    Catalog {
        /// Writes nothing; fails if a file is stale, missing or orphaned.
        #[arg(long)]
        check: bool,
        /// The folder of the catalogue.
        #[arg(long, value_name = "DIR", default_value = "generated")]
        dir: PathBuf,
    },
    /// Searches for lobe directions that make the zonal factorisation sparse.
    SearchLobes(search::Arguments),
}

/// Why a command ends early.
enum Failure {
    /// Something is wrong, and this says what.
    Shown(Diagnostic),
    /// Another program told what is wrong, and ended with this code.
    Told(u8),
    /// Nobody reads the output any more.
    Closed,
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Shown(diagnostic)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Scene(diagnostic) => diagnostic.into(),
            other => Diagnostic::nowhere(other.to_string(), "").into(),
        }
    }
}

macro_rules! failure_from {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Error::from(error).into()
            }
        })*
    };
}

failure_from!(zonal_codegen::generate::GenerateError, zonal_codegen::files::FileError);

/// Something that turns while a command works, on terminals only; it vanishes when it is dropped.
fn progress(message: &str) -> ProgressBar {
    let bar = ProgressBar::new_spinner().with_message(message.to_owned()).with_finish(ProgressFinish::AndClear);
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// Prints to the standard output; a closed pipe ends the command in silence.
fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::Closed,
        _ => Diagnostic::nowhere(format!("cannot print: {error}"), "").into(),
    })
}

/// Prints a value as JSON.
fn out_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Diagnostic::nowhere(format!("cannot print JSON: {error}"), ""))?;
    out(&(text + "\n"))
}

/// A spec that stands on the command line.
fn spec_of(text: &str) -> Result<Spec, Failure> {
    text.parse().map_err(|error| Diagnostic::of_spec("SPEC", text, error).into())
}

/// Runs the command and says how it ended: 0, 1 for what went wrong, 2 for arguments that make no sense.
pub fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Generate { scene, out } => commands::generate(scene, out),
        Command::Plan { scene, json, plot } => commands::plan(scene, json, plot),
        Command::List { family, order, json } => commands::list(family.as_deref(), order, json),
        Command::Show { spec, target, arrays } => commands::show(&spec, &target, arrays.as_deref()),
        Command::Project { map, order, irradiance, json } => commands::project(&map, order as usize, irradiance, json),
        Command::Vectors { spec, inputs, count, seed } => vectors::print(&spec, inputs, count as usize, seed),
        Command::Explore { out, port, no_serve } => explore::explore(out, port, !no_serve),
        Command::Render { arguments } => render::render(&arguments),
        Command::Catalog { check, dir } => commands::catalog(&dir, check),
        Command::SearchLobes(arguments) => search::run(&arguments),
    };
    match result {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Told(code)) => ExitCode::from(code),
        Err(Failure::Shown(diagnostic)) => {
            // If even this cannot be printed, the exit code still tells.
            let _ = write!(io::stderr(), "{}", draw(&diagnostic));
            ExitCode::FAILURE
        }
    }
}
