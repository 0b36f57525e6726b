//! The command `zonal-cache`: draws a room from a radiance cache, or measures it all for `docs/CACHE.md`.

use clap::{Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::process::ExitCode;
use zonal_cache::basis::{Basis, HSH6, HSH10, SH6, SH10};
use zonal_cache::page;
use zonal_cache::picture::strip;
use zonal_cache::record::Sampling;
use zonal_cache::scene::{OBJECTS, Scene, WALL};
use zonal_cache::study::{CAMERA, Setup, filled, squares, table};
use zonal_cache::view::View;
use zonal_cli::terminal::{Failure, bar, ended, out};
use zonal_codegen::files::{self, Replace};

/// Draws rooms with glossy surfaces from a radiance cache.
#[derive(Parser)]
#[command(name = "zonal-cache", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Draws four pictures beside each other: the records, the cache, what an approximate rotation changes, brute force.
    Draw(Draw),
    /// Measures all methods and writes CACHE.md with its pictures; takes some minutes.
    Page {
        /// Where to.
        #[arg(default_value = "docs")]
        folder: PathBuf,
        /// Replaces files that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Room {
    /// A glossy sphere and a glossy bunny.
    Objects,
    /// A glossy wall behind blocks.
    Wall,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stored {
    /// Spherical harmonics.
    Sh,
    /// Hemispherical harmonics.
    Hsh,
}

#[derive(clap::Args)]
struct Draw {
    /// The room.
    #[arg(long, value_enum, default_value = "objects")]
    room: Room,
    /// What the records are stored in.
    #[arg(long, value_enum, default_value = "sh")]
    basis: Stored,
    /// Its order.
    #[arg(long, default_value = "6", value_parser = ["6", "10"])]
    order: String,
    /// The error that a record may have where it serves.
    #[arg(short = 'a', long, default_value_t = 0.2)]
    error: f64,
    /// How many rays a record casts.
    #[arg(long, default_value_t = 1024, value_parser = clap::value_parser!(u64).range(1..=65536))]
    rays: u64,
    /// How many rays a pixel brute force casts.
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u64).range(1..=65536))]
    truth: u64,
    /// The pixels along a side of a picture.
    #[arg(long, default_value_t = 160, value_parser = clap::value_parser!(u64).range(8..=4096))]
    side: u64,
    /// Which rays.
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// The approximate rotation: LF3, tilt, "Taylor 1.5", "LF3 on B" and so on.
    #[arg(long, default_value = "LF3")]
    method: String,
    /// What is yellow in the picture of differences, as a share of the mean.
    #[arg(long, default_value_t = 0.02)]
    bright: f64,
    /// The file to write.
    #[arg(short, long, default_value = "cache.png")]
    output: PathBuf,
    /// Replaces a file that zonal did not write, too.
    #[arg(long)]
    force: bool,
}

fn draw<const C: usize>(draw: &Draw, basis: Basis<C>) -> Result<(), Failure> {
    let error = draw.error;
    if !(0.01..=0.5).contains(&error) {
        let fault = zonal_codegen::fault::Fault::new(format!("the error {error} is not from 0.01 to 0.5"), "try 0.2");
        return Err(fault.into());
    }
    if !basis.methods.iter().any(|method| method.name == draw.method) {
        let names: Vec<&str> = basis.methods.iter().map(|method| method.name).collect();
        let message = format!("`{}` is no rotation of {} of order {}", draw.method, basis.name, basis.order);
        return Err(zonal_codegen::fault::Fault::new(message, format!("name one of: {}", names.join(", "))).into());
    }
    let progress = bar("looking");
    let (scene, gloss) = match draw.room {
        Room::Objects => (Scene::objects()?, OBJECTS),
        Room::Wall => (Scene::wall(), WALL),
    };
    let view = View::new(&scene, &CAMERA, draw.side as usize);
    progress.set_message("brute force");
    progress.set_length(2 * view.glossy.len() as u64);
    let truth = view.brute_force(&scene, draw.truth as usize, draw.seed, || progress.inc(1)).radiance;
    progress.set_message("records");
    let sampling = Sampling { rays: draw.rays as usize, seed: draw.seed };
    let setup = Setup { scene: &scene, gloss, view: &view, truth: &truth, sampling };
    let (cache, seconds) = filled(&setup, basis, error, &|| progress.inc(1));
    let bytes = strip(&squares(&setup, &cache, &draw.method, draw.bright), view.side)?;
    let (folder, name) = files::split(&draw.output);
    files::write_below(folder, &[(name.as_str(), &bytes)], Replace::forced(draw.force))?;
    let records = cache.records.len();
    let text = format!("{records} records in {seconds:.1} s\n\n{}", page::rows(&table(&setup, &cache, seconds)));
    progress.finish_and_clear();
    out(&text)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Page { folder, force } => {
            let progress = bar("measuring");
            let found = page::measured(&page::FULL, &progress)?;
            let written: Vec<(&str, &[u8])> = found.iter().map(|(name, bytes)| (*name, &bytes[..])).collect();
            files::write_below(folder, &written, Replace::forced(*force))?;
            progress.finish_and_clear();
            out(&format!("{} files in {}.\n", written.len(), folder.display()))
        }
        Command::Draw(asked) => match (asked.basis, asked.order.as_str()) {
            (Stored::Sh, "6") => draw(asked, SH6),
            (Stored::Sh, _) => draw(asked, SH10),
            (Stored::Hsh, "6") => draw(asked, HSH6),
            (Stored::Hsh, _) => draw(asked, HSH10),
        },
    }
}

fn main() -> ExitCode {
    ended(run(&Arguments::parse()))
}
