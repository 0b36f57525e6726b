//! The command `zonal-render`: reads a scene, draws it, writes the picture and its figures. It decides nothing about
//! either.

use clap::{Parser, Subcommand};
use indicatif::ProgressBar;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use zonal_cli::terminal::{Failure, bar, ended, out};
use zonal_codegen::fault::Fault;
use zonal_codegen::files::{self, MARK, Replace};
use zonal_codegen::scene::Scene;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::Method;
use zonal_render::figures::{Figures, Row, Truth, convergence, percent};
use zonal_render::gpu::{Gpu, Stage};
use zonal_render::pages::Page;
use zonal_render::strip;
use zonal_render::subject::{Instead, Subject};

/// How many pixels are summed by brute force for `--reference`.
const POINTS: usize = 4000;

/// What the help ends with.
const NOTES: &str = "The figures are printed, and lie beside the picture as JSON. Errors are shares of the mean radiance \
                     and are measured before the tone curve, which is Reinhard's (2002) for each channel with white at 4, \
                     after the exposure that takes the object's log-average luminance to 0.3; then sRGB.";

/// Draws the picture of a scene with its generated kernels, on a GPU or a software adapter.
#[derive(Parser)]
#[command(name = "zonal-render", version, after_help = NOTES)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
struct Arguments {
    #[command(subcommand)]
    other: Option<Other>,
    /// The scene, a TOML file with the tables `[environment]`, `[brdf]` and `[picture]`.
    #[arg(required = true)]
    scene: Option<PathBuf>,
    /// The picture to write, a PNG file; the scene's name without it.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draws a strip: exact, the scene's method, their difference in false colours, no rotation.
    #[arg(long)]
    compare: bool,
    /// Prints how the exact picture nears brute force on the CPU, for the orders 2 to 10; the JSON has it too.
    #[arg(long)]
    reference: bool,
    /// The number of bands, instead of the scene's.
    #[arg(long, value_parser = clap::value_parser!(u64).range(2..=16))]
    order: Option<u64>,
    /// The method, instead of the scene's.
    #[arg(long, value_parser = Method::ALL.map(Method::name))]
    method: Option<String>,
    /// How many samples a pixel has along each side.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..=4))]
    samples: u64,
    /// Replaces a picture or figures that zonal did not write, too.
    #[arg(long)]
    force: bool,
}

/// What is written besides the picture of a scene.
#[derive(Subcommand)]
enum Other {
    /// Measures all that a page of zonal's documentation says and writes it with its picture.
    Page {
        /// The page.
        page: Page,
        /// The folder of zonal's scenes, which it is measured on.
        #[arg(long, value_name = "DIR", default_value = "scenes")]
        scenes: PathBuf,
        /// The folder to write to.
        #[arg(long, value_name = "DIR", default_value = "docs")]
        out: PathBuf,
        /// Replaces files that zonal did not write, too.
        #[arg(long)]
        force: bool,
    },
}

/// The figures as they lie beside the picture, for which they say who wrote it.
#[derive(Serialize)]
struct Beside<'a> {
    origin: String,
    #[serde(flatten)]
    figures: &'a Figures,
    /// How the exact picture nears brute force, if that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    reference: Vec<Row>,
}

fn run(arguments: &Arguments) -> Result<String, Diagnostic> {
    let start = Instant::now();
    let bar = bar("reading");
    if let Some(Other::Page { page, scenes, out, force }) = &arguments.other {
        let found = page.files(scenes, &bar)?;
        let files: Vec<(&str, &[u8])> = found.iter().map(|(name, bytes)| (*name, &bytes[..])).collect();
        files::write_below(out, &files, Replace::forced(*force)).map_err(Fault::from)?;
        bar.finish_and_clear();
        let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
        let seconds = start.elapsed().as_secs_f64();
        return Ok(format!("{} in {}, in {seconds:.1} s.\n", names.join(" and "), out.display()));
    }
    // Without a scene and another command the arguments are refused before.
    let scene = arguments.scene.clone().unwrap_or_default();
    let method = arguments.method.as_deref().map(str::parse).transpose();
    let method: Option<Method> = method.map_err(|message: String| Diagnostic::nowhere(message, ""))?;
    let instead = Instead { order: arguments.order.map(|order| order as usize), method };
    let subject = Subject::new(&Scene::read(&scene)?, instead)?;
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.png", subject.name)));
    if output.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
        let message = format!("`{}` is no name of a PNG file", output.display());
        return Err(Diagnostic::nowhere(message, "end it in `.png`"));
    }
    let gpu = Gpu::open()?;
    let drawing = if arguments.compare { strip::compared } else { strip::single };
    let (canvas, figures) = drawing(&gpu, &subject, arguments.samples as usize, &bar)?;
    let mut text = format!(
        "{}: {}, order {}, {} by {} pixels on {}\n\n",
        figures.scene, figures.brdf, figures.order, figures.size[0], figures.size[1], figures.adapter
    );
    if let Some(table) = subject.brdf.table() {
        let _ = writeln!(text, "  {}\n", table.told());
    }
    for picture in &figures.pictures {
        let name = picture.spec.as_deref().unwrap_or("no rotation");
        let errors = match arguments.compare && picture.method != Method::Exact {
            true => format!(", error: mean {}, worst {}", percent(picture.errors.mean), percent(picture.errors.worst)),
            false => String::new(),
        };
        let _ = writeln!(
            text,
            "  {name:18} {:5} operations, {:6.1} ms a frame{errors}",
            picture.operations, picture.milliseconds
        );
    }
    let mut rows = Vec::new();
    if arguments.reference {
        let (told, found) = reference(&gpu, &subject, &bar)?;
        text += "\n";
        text += &told;
        rows = found;
    }
    let json =
        serde_json::to_string_pretty(&Beside { origin: format!("{MARK} render"), figures: &figures, reference: rows })
            .map_err(|error| Diagnostic::nowhere(error.to_string(), ""))?;
    let json = json + "\n";
    let sidecar = output.with_extension("json");
    let ((folder, picture), (_, beside)) = (files::split(&output), files::split(&sidecar));
    let written = [(picture.as_str(), &canvas.png()[..]), (beside.as_str(), json.as_bytes())];
    files::write_below(folder, &written, Replace::forced(arguments.force)).map_err(Fault::from)?;
    bar.finish_and_clear();
    let [width, height] = canvas.size;
    let seconds = start.elapsed().as_secs_f64();
    let _ = writeln!(
        text,
        "\n{} ({width} by {height}) and its figures in {}, in {seconds:.1} s.",
        output.display(),
        sidecar.display()
    );
    Ok(text)
}

/// The table of `--reference`, and its rows.
fn reference(gpu: &Gpu, subject: &Subject, bar: &ProgressBar) -> Result<(String, Vec<Row>), Diagnostic> {
    bar.set_position(0);
    bar.set_message("brute force");
    let stage = Stage::new(gpu, subject, subject.size)?;
    let truth = Truth::new(&stage, POINTS, bar)?;
    bar.set_message("orders 2 to 10");
    let rows = convergence(&stage, &truth, 2..=10)?;
    let mut text = format!(
        "  The exact kernel against brute force: {} pixels, all {} texels{}, shares of the mean radiance\n\n",
        truth.views.len(),
        subject.map.texels.len(),
        if subject.lights.is_empty() { "" } else { " and lights" }
    );
    let _ = writeln!(text, "  {:>5} {:>10} {:>10} {:>10} {:>14}", "order", "mean", "rms", "worst", "expected rms");
    for row in &rows {
        let [mean, rms, worst, expected] =
            [row.errors.mean, row.errors.rms, row.errors.worst, row.expected].map(percent);
        let _ = writeln!(text, "  {:>5} {mean:>10} {rms:>10} {worst:>10} {expected:>14}", row.order);
    }
    Ok((text, rows))
}

fn main() -> ExitCode {
    ended(run(&Arguments::parse()).map_err(Failure::from).and_then(|text| out(&text)))
}
