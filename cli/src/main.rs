//! The command `zonal`: reads arguments, calls the library, prints. It decides nothing about kernels; what draws and what
//! bakes is other programs, to which it hands over.

mod bands;
mod commands;
mod directions;
mod hand_over;
mod init;
mod products;
mod search;
mod sought;
mod told;
mod vectors;

use clap::{Parser, Subcommand};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;
use zonal_cli::projected::Asked;
use zonal_cli::terminal::{Failure, ended, out};
use zonal_codegen::emit::language::{self, Arrays};
use zonal_codegen::families::Spec;
use zonal_codegen::families::text::family_names;
use zonal_codegen::files::Replace;
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
        /// The scene, a TOML file; without one, that of a glossy surface, which zonal carries with it.
        scene: Option<PathBuf>,
        /// The folder to write to, instead of the one that the scene names.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replaces files that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
    /// Writes a scene to begin with: all that it may hold, with what it means.
    Init {
        /// The file to write.
        #[arg(default_value = "scene.toml")]
        file: PathBuf,
        /// An environment map that it names.
        #[arg(long)]
        map: Option<PathBuf>,
        /// Replaces a file that is there.
        #[arg(long)]
        force: bool,
    },
    /// Prints the format of scenes as JSON schema, by which an editor completes and checks them.
    Schema,
    /// Shows what a scene would get, and why.
    Plan {
        /// The scene, a TOML file; without one, the glossy scene that zonal carries with it.
        scene: Option<PathBuf>,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
        /// Writes a plot too: of the light its error over the order, its energy by band, the map and the spheres that it
        /// lights; of each rotation every method's error over the angle.
        #[arg(long, value_name = "FILE.svg")]
        plot: Option<PathBuf>,
        /// Replaces a plot that zonal did not write, too.
        #[arg(long, requires = "plot")]
        force: bool,
    },
    /// Lists the standard specs with their costs and errors.
    List {
        /// Only this family.
        #[arg(long, value_parser = family_names())]
        family: Option<String>,
        /// Only this order; the catalogue has 2 to 10, and `show` prints others.
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
        /// The form of the file, for what takes it in otherwise.
        #[arg(long, value_parser = language::forms())]
        form: Option<String>,
    },
    /// Projects an environment map, and says which order it takes and why.
    Project {
        #[command(flatten)]
        asked: Asked,
        /// Writes a plot too: the error over the order, the energy by band, the map beside its reconstruction, and the
        /// spheres that both light.
        #[arg(long, value_name = "FILE.svg")]
        plot: Option<PathBuf>,
        /// Replaces a plot that zonal did not write, too.
        #[arg(long, requires = "plot")]
        force: bool,
    },
    /// Writes the bands of a map as cubemaps, each as small as an error allows, and the text that reads them in shaders.
    Bands(bands::Arguments),
    /// Prints test vectors as JSON: inputs, and what a kernel gives in f32 and f64.
    ///
    /// A result that is not finite is one of the strings "NaN", "Infinity" and "-Infinity".
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
    /// Bakes the light of a map into the vertices or the lightmap of a mesh: `zonal bake --help`.
    #[command(disable_help_flag = true)]
    Bake {
        /// What `zonal-bake` takes.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Writes a page that shows the kernels at work, and serves it to this machine: `zonal explore --help`.
    #[command(disable_help_flag = true)]
    Explore {
        /// What `zonal-explorer explore` takes.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
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
        /// Replaces files that zonal did not write, too; such files are never removed.
        #[arg(long, conflicts_with = "check")]
        force: bool,
    },
    /// Searches for lobe directions that make the zonal factorisation sparse.
    SearchLobes(search::Arguments),
    /// Searches for plans that make products and squares cheap.
    SearchProducts(products::Arguments),
    /// Searches for directions about which zonal harmonics make up every function of their bands with small weights.
    SearchDirections(directions::Arguments),
}

/// A spec that stands on the command line.
fn spec_of(text: &str) -> Result<Spec, Failure> {
    text.parse().map_err(|error| Diagnostic::of_spec("SPEC", text, error).into())
}

/// Runs the command and says how it ended: 0, 1 for what went wrong, 2 for arguments that make no sense.
fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Generate { scene, out, force } => commands::generate(scene.as_deref(), out, Replace::forced(force)),
        Command::Init { file, map, force } => init::run(&file, map.as_deref(), Replace::forced(force)),
        Command::Schema => out(zonal_templates::SCENE_SCHEMA),
        Command::Plan { scene, json, plot: None, .. } => commands::plan(scene.as_deref(), json),
        Command::Plan { plot: Some(_), .. } => hand_over::same(),
        Command::List { family, order, json } => commands::list(family.as_deref(), order, json),
        Command::Show { spec, target, arrays, form } => {
            commands::show(&spec, &target, arrays.as_deref(), form.as_deref())
        }
        Command::Project { asked, plot: None, .. } => commands::project(&asked),
        Command::Project { plot: Some(_), .. } => hand_over::same(),
        Command::Bands(arguments) => bands::run(&arguments),
        Command::Vectors { spec, inputs, count, seed } => vectors::print(&spec, inputs, count as usize, seed),
        Command::Bake { arguments } => hand_over::bake(arguments),
        Command::Explore { arguments } => hand_over::explore(arguments),
        Command::Render { arguments } => hand_over::render(arguments),
        Command::Catalog { check, dir, force } => commands::catalog(&dir, check, Replace::forced(force)),
        Command::SearchLobes(arguments) => search::run(&arguments),
        Command::SearchProducts(arguments) => products::run(&arguments),
        Command::SearchDirections(arguments) => directions::run(&arguments),
    };
    ended(result)
}
