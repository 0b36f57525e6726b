//! The command `zonal-explorer`, to which `zonal explore`, `zonal plan --plot` and `zonal project --plot` hand over: what is
//! seen of kernels and of light, as a page and as plots.

mod http;
mod lighting;
mod own;
mod page;
mod plot;
mod serve;
mod upload;

use clap::{Parser, Subcommand};
use own::Own;
use std::path::PathBuf;
use std::process::ExitCode;
use zonal_cli::projected::Asked;
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
    /// A normal-mapped object under an environment map, in WebGL2 or WebGPU: the chosen order and way to turn coefficients
    /// beside the exact way of that order and all bands, which are summed by brute force, with costs, errors and times. A
    /// map may also be dropped on the page while it is served.
    Explore {
        /// Maps, a scene, or both. A map is .hdr, .exr or .png, as latitude and longitude or as a cubemap in a strip or a
        /// cross; six faces are named by the folder that holds them or by a pattern, as in `sky/day_*.png`. A scene is a
        /// TOML file; its map, mesh, normal map, reflectance and camera are shown first.
        #[arg(value_name = "MAP|SCENE")]
        inputs: Vec<PathBuf>,
        /// A mesh of one's own, a Wavefront OBJ file, y up.
        #[arg(long, value_name = "FILE.obj")]
        mesh: Option<PathBuf>,
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
    /// Shows what a scene would get, and why, and plots its light and each method's error over the angle.
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
    /// Projects an environment map, says which order it takes and why, and plots it.
    Project {
        #[command(flatten)]
        asked: Asked,
        /// The plot.
        #[arg(long, value_name = "FILE.svg")]
        plot: PathBuf,
        /// Replaces a plot that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
}

fn main() -> ExitCode {
    ended(match Arguments::parse().command {
        Command::Explore { inputs, mesh, out, port, no_serve, force } => Own::read(&inputs, mesh.as_deref())
            .and_then(|own| serve::explore(&own, out, port, !no_serve, Replace::forced(force))),
        Command::Plan { scene, json, plot, force } => plot::plan(scene.as_deref(), json, &plot, Replace::forced(force)),
        Command::Project { asked, plot, force } => plot::project(&asked, &plot, Replace::forced(force)),
    })
}
