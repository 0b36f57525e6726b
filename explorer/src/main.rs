//! The command `zonal-explorer`, to which `zonal explore` and `zonal plan --plot` hand over: what is seen of kernels without
//! drawing a picture, as a page and as plots.

mod http;
mod page;
mod plot;
mod serve;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;
use zonal_cli::terminal::ended;
use zonal_codegen::files::Replace;

/// The page on which kernels are seen at work, and the plots of plans: what `zonal` hands over.
#[derive(Parser)]
#[command(name = "zonal", bin_name = "zonal", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
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
        /// Replaces files that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
    /// Shows what a scene would get, and why, and plots each method's error over the angle.
    Plan {
        /// The scene, a TOML file; without one, the glossy scene that zonal carries with it.
        scene: Option<PathBuf>,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
        /// The plot, with what the scene allows.
        #[arg(long, value_name = "FILE.svg")]
        plot: PathBuf,
        /// Replaces a plot that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
}

fn main() -> ExitCode {
    ended(match Arguments::parse().command {
        Command::Explore { out, port, no_serve, force } => serve::explore(out, port, !no_serve, Replace::forced(force)),
        Command::Plan { scene, json, plot, force } => plot::plan(scene.as_deref(), json, &plot, Replace::forced(force)),
    })
}
