//! Shaders compiled for GPUs: the program starts itself once a GPU, since the environment says which one the driver is to
//! be.

use crate::device::{Compiler, Counted};
use crate::kernels::{Called, Kernel, Pass};
use crate::loops;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A GPU that RADV compiles for.
#[derive(Clone, Copy, Debug)]
pub struct Gpu {
    /// What RADV calls its family.
    pub family: &'static str,
    /// Its architecture and a card that has it.
    pub what: &'static str,
}

/// One of each architecture of AMD's that games are still played on.
pub const GPUS: [Gpu; 3] = [
    Gpu { family: "polaris10", what: "GCN 4 (Radeon RX 480)" },
    Gpu { family: "navi21", what: "RDNA 2 (Radeon RX 6800)" },
    Gpu { family: "gfx1100", what: "RDNA 3 (Radeon RX 7900)" },
];

/// A kernel, and what was counted of it for each of [`GPUS`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// The spec.
    pub spec: String,
    /// How it is called.
    pub called: Called,
    /// Its operations, for all channels.
    pub operations: usize,
    /// Its roots and reciprocals.
    pub special: usize,
    /// What its operations and the numbers that it is given besides the signal weigh together.
    pub weight: usize,
    /// Numbers that it holds at once.
    pub held: usize,
    /// What was counted.
    pub gpus: [Counted; GPUS.len()],
}

/// What was counted, and by which driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Report {
    /// The driver, with its version.
    pub driver: String,
    /// The kernels.
    pub rows: Vec<Row>,
    /// Loops over memory, beside others.
    pub loops: Vec<loops::Row>,
}

/// What a child prints.
#[derive(Serialize, Deserialize)]
struct Told {
    driver: String,
    counted: Vec<Counted>,
}

/// Where Debian's package puts what tells the Vulkan loader of RADV.
const MANIFESTS: &str = "/usr/share/vulkan/icd.d";

fn manifest() -> Result<PathBuf, String> {
    let files = std::fs::read_dir(MANIFESTS).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_it = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("radeon_icd"));
    files.into_iter().find(is_it).ok_or_else(|| {
        "Mesa's RADV is missing; install it: apt-get install -y --no-install-recommends mesa-vulkan-drivers libvulkan1".to_owned()
    })
}

/// What is counted of passes that run after each other: what any of them needs, and what all of them take.
fn together(passes: &[Pass], counted: &[Counted]) -> Counted {
    let mut all = Counted { waves: u64::MAX, ..Counted::default() };
    for (pass, counted) in passes.iter().zip(counted) {
        all.instructions += pass.times * counted.instructions;
        all.registers = all.registers.max(counted.registers);
        all.spilled = all.spilled.max(counted.spilled);
        all.waves = all.waves.min(counted.waves);
        all.cycles += pass.times * counted.cycles;
        all.latency += counted.latency;
    }
    all
}

fn path(folder: &Path, place: usize) -> PathBuf {
    folder.join(format!("{place}.spv"))
}

/// Compiles what a folder holds and prints what was counted: what the program does where it started itself.
///
/// # Errors
///
/// If a shader cannot be read, or the driver refuses it.
pub fn child(folder: &Path) -> Result<(), Box<dyn Error>> {
    let compiler = Compiler::new()?;
    let mut counted = Vec::new();
    while let Ok(bytes) = std::fs::read(path(folder, counted.len())) {
        let words: Vec<u32> = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        counted.push(compiler.counted(&words)?);
    }
    let told = Told { driver: compiler.driver(), counted };
    println!("{}", serde_json::to_string(&told)?);
    Ok(())
}

/// Compiles shaders for every GPU, by `program`, which is this package's; `step` is called after each GPU.
///
/// # Errors
///
/// If the driver is missing, with what to install, or refuses a shader.
pub fn compile(program: &Path, kernels: &[Kernel], step: impl Fn()) -> Result<Report, Box<dyn Error>> {
    let manifest = manifest()?;
    let folder = tempfile::tempdir()?;
    let passes: Vec<&Pass> = kernels.iter().flat_map(|kernel| &kernel.passes).collect();
    for (place, pass) in passes.iter().enumerate() {
        let bytes: Vec<u8> = pass.spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(path(folder.path(), place), bytes)?;
    }
    let mut driver = String::new();
    let mut columns = Vec::new();
    for gpu in GPUS {
        let output = Command::new(program)
            .arg("--child")
            .arg(folder.path())
            .env("RADV_FORCE_FAMILY", gpu.family)
            .env("VK_ICD_FILENAMES", &manifest)
            .env("VK_DRIVER_FILES", &manifest)
            .env("XDG_RUNTIME_DIR", std::env::var_os("XDG_RUNTIME_DIR").unwrap_or_else(|| std::env::temp_dir().into()))
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .output()?;
        let told: Told = match output.status.success() {
            true => serde_json::from_slice(&output.stdout)?,
            false => return Err(format!("{}: {}", gpu.family, String::from_utf8_lossy(&output.stderr)).into()),
        };
        if told.counted.len() != passes.len() {
            return Err(format!("{}: {} of {} shaders", gpu.family, told.counted.len(), passes.len()).into());
        }
        driver = told.driver;
        let mut rest = &told.counted[..];
        let of = |kernel: &Kernel| {
            let (own, others) = rest.split_at(kernel.passes.len());
            rest = others;
            together(&kernel.passes, own)
        };
        columns.push(kernels.iter().map(of).collect::<Vec<Counted>>());
        step();
    }
    let row = |(place, kernel): (usize, &Kernel)| Row {
        spec: kernel.spec.clone(),
        called: kernel.called,
        operations: kernel.operations,
        special: kernel.special,
        weight: kernel.weight,
        held: kernel.held,
        gpus: std::array::from_fn(|gpu| columns[gpu][place]),
    };
    Ok(Report { driver, rows: kernels.iter().enumerate().map(row).collect(), loops: vec![] })
}
