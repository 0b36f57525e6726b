//! The command `cargo measure-gpu`: compiles the catalogue for GPUs that are not there and writes `docs/GPU.md` and
//! `docs/gpu.json`.

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;
use zonal_codegen::catalog;
use zonal_measure_gpu::compile::{self, GPUS, Report};
use zonal_measure_gpu::kernels::shaders;
use zonal_measure_gpu::{loops, nvidia, page, registers};

/// Compile every kernel of the catalogue for AMD's GPUs, by the driver's own compiler, and write what it counts.
#[derive(Parser)]
#[command(name = "cargo measure-gpu", version)]
struct Arguments {
    /// The folder of the page and its figures.
    #[arg(long, default_value_os_t = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs"))]
    output: PathBuf,
    /// The table of registers that the planner goes by.
    #[arg(long, default_value_os_t = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../codegen/data/registers.tsv"))]
    table: PathBuf,
    /// Write the page and the table of the figures that are there, and compile nothing.
    #[arg(long)]
    page: bool,
    /// Compile rotations, tilts and evaluations by NVIDIA's assembler, which is installed from PyPI below this folder if it is not
    /// there, and write `NVIDIA.md` alone.
    #[arg(long, value_name = "FOLDER", num_args = 0..=1, default_missing_value = "target/nvidia")]
    nvidia: Option<PathBuf>,
    /// Compile a folder of shaders and print what is counted: how the program calls itself.
    #[arg(long, hide = true)]
    child: Option<PathBuf>,
}

fn bar(what: &'static str, steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:24} [{bar:40}] {pos}/{len} {elapsed}").expect("is a template");
    let bar = ProgressBar::new(steps as u64).with_style(style.progress_chars("=> ")).with_message(what);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn measured() -> Result<Report, Box<dyn Error>> {
    let building = bar("building", 1);
    let kernels = shaders(&catalog::standard());
    building.finish();
    let compiling = bar("compiling", GPUS.len());
    let program = std::env::current_exe()?;
    let mut report = compile::compile(&program, &kernels, || compiling.inc(1))?;
    report.loops = loops::measured(&program)?;
    compiling.finish();
    Ok(report)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    if let Some(folder) = &arguments.child {
        return compile::child(folder);
    }
    if let Some(folder) = &arguments.nvidia {
        let report = nvidia::measured(folder)?;
        std::fs::write(arguments.output.join(nvidia::JSON), serde_json::to_string_pretty(&report)? + "\n")?;
        std::fs::write(arguments.output.join(nvidia::PAGE), nvidia::markdown(&report))?;
        return Ok(());
    }
    let figures = arguments.output.join(page::JSON);
    let report = match arguments.page {
        true => serde_json::from_str(&std::fs::read_to_string(&figures)?)?,
        false => measured()?,
    };
    std::fs::write(&figures, page::json(&report)?)?;
    std::fs::write(&arguments.table, registers::tsv(&report))?;
    std::fs::write(arguments.output.join(page::PAGE), page::markdown(&report))?;
    Ok(())
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
