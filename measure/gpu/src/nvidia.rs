//! What kernels cost on NVIDIA's GPUs, by NVIDIA's own assembler and without a GPU: CUDA C through clang to PTX, `ptxas` for registers
//! and spills, `nvdisasm` for the instructions. Both come from PyPI, where they can be had; what is not there is named.

use crate::cuda::CUDA;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::families::{Form, Spec};
use zonal_codegen::generate;
use zonal_codegen::ir::kernel::Shape;
use zonal_codegen::ir::pieces::SET_UP;

/// The architectures: Ampere (A100) and Ada (RTX 40).
pub const ARCHITECTURES: [&str; 2] = ["sm_80", "sm_89"];

/// The page, and its figures.
pub const PAGE: &str = "NVIDIA.md";
/// The figures.
pub const JSON: &str = "nvidia.json";

/// The packages of PyPI and the program of each.
const PROGRAMS: [(&str, &str); 2] = [("nvidia-cuda-nvcc-cu12", "ptxas"), ("nvidia-cuda-nvdisasm", "nvdisasm")];

/// What is counted of a kernel on an architecture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counted {
    /// Registers of a thread.
    pub registers: usize,
    /// Bytes that did not find one, stored and loaded.
    pub spilled: usize,
    /// Multiplications, additions and fused multiply-adds of f32.
    pub operations: usize,
    /// Those of them that are fused.
    pub fused: usize,
    /// Roots, reciprocals and powers.
    pub special: usize,
}

/// A kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The spec.
    pub spec: String,
    /// Whether it is called a band at a time.
    pub in_pieces: bool,
    /// The operations that are counted of it, for all channels.
    pub operations: usize,
    /// Its roots and reciprocals.
    pub special: usize,
    /// On each architecture.
    pub on: Vec<Counted>,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// What `ptxas` says that it is.
    pub assembler: String,
    /// What clang says that it is.
    pub compiler: String,
    /// The kernels.
    pub rows: Vec<Row>,
}

/// The programs that are needed.
struct Programs {
    clang: PathBuf,
    ptxas: PathBuf,
    nvdisasm: PathBuf,
}

fn found(folder: &Path, name: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    entries.into_iter().find_map(|path| match path.is_dir() {
        true => found(&path, name),
        false => path.file_name().is_some_and(|found| found == name).then_some(path),
    })
}

/// Finds the programs below a folder, into which they are installed if they are not there.
fn programs(folder: &Path) -> Result<Programs, String> {
    for (package, program) in PROGRAMS {
        if found(folder, program).is_none() {
            let pip = ["-m", "pip", "install", "--quiet", "--no-deps", "--target"];
            // Both packages have a folder of one name, which pip does not write twice.
            let status = Command::new("python3").args(pip).arg(folder.join(package)).arg(package).status();
            if !status.is_ok_and(|status| status.success()) {
                return Err(format!("`{program}` cannot be had: `python3 -m pip install {package}` fails here"));
            }
        }
    }
    let program = |name: &str| found(folder, name).ok_or_else(|| format!("`{name}` is not in its package"));
    let clang =
        ["clang-19", "clang-18", "clang-17", "clang-16"].into_iter().find(|name| version(Path::new(name)).is_some());
    let clang = clang.ok_or("clang 16 to 19 is missing: apt-get install clang-16")?;
    Ok(Programs { clang: clang.into(), ptxas: program("ptxas")?, nvdisasm: program("nvdisasm")? })
}

/// The line of what a program says of itself that has the word *release* or *version*.
fn version(program: &Path) -> Option<String> {
    let output = Command::new(program).arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find(|line| line.contains("release") || line.contains("version"));
    line.map(|line| line.trim().to_owned())
}

/// The kernels that are compiled: those that a planner chooses between, and bases and values, for one channel and three.
fn specs() -> Vec<Spec> {
    let texts = ["rotate:{}", "rotate:{}:zxzxz", "rotate:{}:angles", "rotate:{}:lifted", "tilt:{}", "eval:{}"];
    let of = |order: usize| {
        let both = texts.iter().map(move |text| text.replace("{}", &order.to_string()));
        let both = both.flat_map(|text| [text.clone(), format!("{text}:rgb")]);
        both.chain([format!("basis:{order}"), format!("taylor15:{order}"), format!("lf3:{order}")])
    };
    (2..=10).flat_map(of).filter_map(|text| text.parse().ok()).collect()
}

/// Loads of a parameter, or stores of a result, at numbers from one on, a line each.
fn numbers(
    name: &str,
    shape: Shape,
    channels: usize,
    first: usize,
    line: impl Fn(String, usize) -> String,
) -> (String, usize) {
    let parts = ["x", "y", "z", "w"];
    let mut text = String::new();
    let mut next = first;
    let mut add = |place: String, of: usize| {
        for part in &parts[..of.max(1)] {
            let place = if of > 0 { format!("{place}.{part}") } else { place.clone() };
            text += &line(place, next);
            next += 1;
        }
    };
    let of_channels = if channels == 3 { 3 } else { 0 };
    match shape {
        Shape::Scalar => add(name.to_owned(), of_channels),
        Shape::Vec3 => add(name.to_owned(), 3),
        Shape::Vec4 => add(name.to_owned(), 4),
        Shape::Pair => add(name.to_owned(), 2),
        Shape::Pairs(n) => (0..n).for_each(|i| add(format!("{name}[{i}]"), 2)),
        Shape::Vectors(n) => (0..n).for_each(|i| add(format!("{name}[{i}]"), 3)),
        Shape::Mat3 => (0..3).for_each(|i| add(format!("{name}[{i}]"), 3)),
        Shape::Array(n) => (0..n).for_each(|i| add(format!("{name}[{i}]"), of_channels)),
    }
    (text, next)
}

/// A program as it is written: which parameters are known, and how many numbers of what is read they take.
#[derive(Default)]
struct Writer {
    params: usize,
    known: Vec<&'static str>,
}

impl Writer {
    /// The statements that read what a function takes besides the signal and what is made, unless it is known.
    fn read(&mut self, function: &Function) -> String {
        let dialect = function.dialect(&CUDA, None).expect("what is chosen is printed");
        let mut text = String::new();
        for param in function.built.code.params().iter().filter(|param| param.kind.is_scalar()) {
            if param.name == SET_UP || self.known.contains(&param.name) {
                continue;
            }
            let passed = dialect.passed(param.shape, param.kind);
            text += &format!("    {}\n", (CUDA.statements.variable)(&passed, param.name));
            let load = |place: String, number: usize| format!("    {place} = in[{number} * N];\n");
            let (loads, next) = numbers(param.name, param.shape, 1, self.params, load);
            text += &loads;
            self.params = next;
            self.known.push(param.name);
        }
        text
    }

    /// The statements that call a function, whose signal is at a place of what is read, and name its result.
    fn call(&mut self, function: &Function, signal: usize, result: &str) -> String {
        let code = &function.built.code;
        let dialect = function.dialect(&CUDA, None).expect("what is chosen is printed");
        let variable = |shape, kind, name: &str| {
            format!("    {}\n", (CUDA.statements.variable)(&dialect.passed(shape, kind), name))
        };
        let mut text = String::new();
        for param in code.params().iter().filter(|param| !param.kind.is_scalar()) {
            text += &variable(param.shape, param.kind, param.name);
            let load = |place: String, number: usize| format!("    {place} = in[{number} * N];\n");
            text += &numbers(param.name, param.shape, function.spec.channels(), signal, load).0;
        }
        let (shape, kind) = code.result();
        let arguments: Vec<&str> = code.params().iter().map(|param| param.name).collect();
        let (name, arguments) = (function.shader_name(), arguments.join(", "));
        text += &variable(shape, kind, result);
        text + &match dialect.is_written(shape) {
            true => format!("    {name}({arguments}, {result});\n"),
            false => format!("    {result} = {name}({arguments});\n"),
        }
    }
}

/// Where signals begin in what is read; parameters stand before.
const SIGNALS: usize = 128;

/// A program: a thread a signal, of which numbers lie in rows of signals.
fn program(functions: &[Function]) -> String {
    let module = Module { name: "kernel".to_owned(), functions: functions.to_vec(), ..Module::default() };
    let text = module.text(&CUDA).expect("what is chosen is printed");
    let (mut body, mut writer) = (String::new(), Writer::default());
    for function in functions {
        body += &writer.read(function);
    }
    for function in functions {
        let (shape, kind) = function.built.code.result();
        let channels = function.spec.channels();
        let first = match function.spec.form {
            Form::SetUp => {
                body += &writer.call(function, SIGNALS, SET_UP);
                continue;
            }
            Form::Band(l) => l * l * channels,
            Form::Unrolled | Form::Loop => 0,
        };
        let of = if kind.is_scalar() { 1 } else { channels };
        let store = |place: String, number: usize| format!("    o[{number} * N] = {place};\n");
        let call = writer.call(function, SIGNALS + first, "r");
        let _ = writeln!(body, "    {{\n{call}{}    }}", numbers("r", shape, of, first, store).0);
    }
    format!(
        "{text}\n#define N 65536\nextern \"C\" __attribute__((global)) void kernel(const float* __restrict in, float* __restrict o) {{\n    \
         const unsigned id = __nvvm_read_ptx_sreg_tid_x() + __nvvm_read_ptx_sreg_ctaid_x() * 256;\n    in += id;\n    o += id;\n{body}}}\n"
    )
}

fn output(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(text) } else { Err(format!("{command:?}: {text}")) }
}

/// The number before some words.
fn before(text: &str, words: &str) -> usize {
    let at = text.find(words).unwrap_or(0);
    let digits: String = text[..at].trim_end().chars().rev().take_while(char::is_ascii_digit).collect();
    digits.chars().rev().collect::<String>().parse().unwrap_or(0)
}

fn count(programs: &Programs, text: &str, architecture: &str) -> Result<Counted, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("k.cu"), text).map_err(|error| error.to_string())?;
    let flags =
        ["-x", "cuda", "--cuda-device-only", "-nocudainc", "-nocudalib", "-O3", "-S", "-Wno-unknown-cuda-version"];
    let clang = &mut Command::new(&programs.clang);
    output(
        clang.args(flags).arg(format!("--cuda-gpu-arch={architecture}")).arg(path("k.cu")).arg("-o").arg(path("k.ptx")),
    )?;
    let ptxas = &mut Command::new(&programs.ptxas);
    let said =
        output(ptxas.arg(format!("-arch={architecture}")).arg("-v").arg(path("k.ptx")).arg("-o").arg(path("k.cubin")))?;
    let instructions = output(Command::new(&programs.nvdisasm).arg(path("k.cubin")))?;
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    for line in instructions.lines() {
        let Some((_, code)) = line.trim_start().strip_prefix("/*").and_then(|line| line.split_once("*/")) else {
            continue;
        };
        let word = code.split_whitespace().find(|word| !word.starts_with('@'));
        let Some(name) = word.and_then(|word| word.split(['.', ';']).next()) else { continue };
        *names.entry(name).or_default() += 1;
    }
    let of = |name: &str| names.get(name).copied().unwrap_or(0);
    Ok(Counted {
        registers: before(&said, " registers"),
        spilled: before(&said, " bytes spill stores") + before(&said, " bytes spill loads"),
        operations: of("FFMA") + of("FMUL") + of("FADD"),
        fused: of("FFMA"),
        special: of("MUFU"),
    })
}

/// Compiles all kernels, with programs below a folder.
///
/// # Errors
///
/// If a program cannot be had or refuses a kernel; the message says which.
pub fn measured(folder: &Path) -> Result<Report, String> {
    let programs = programs(folder)?;
    let specs = specs();
    let with_pieces = |spec: &Spec| [vec![spec.clone()], spec.in_pieces()].concat();
    let all: Vec<Spec> = specs.iter().flat_map(with_pieces).collect();
    let functions: BTreeMap<Spec, Function> = all.iter().cloned().zip(generate::build(&all)).collect();
    let of = |spec: &Spec| functions[spec].clone();
    let row = |(spec, pieces): &(Spec, Vec<Function>)| -> Result<Row, String> {
        let cost = functions[spec].built.code.cost(spec.channels());
        let text = program(pieces);
        let on = ARCHITECTURES.iter().map(|architecture| count(&programs, &text, architecture));
        Ok(Row {
            spec: spec.to_string(),
            in_pieces: pieces.len() > 1,
            operations: cost.total,
            special: cost.special,
            on: on.collect::<Result<_, _>>()?,
        })
    };
    let tasks: Vec<(Spec, Vec<Function>)> = specs
        .iter()
        .flat_map(|spec| {
            let pieces: Vec<Function> = spec.in_pieces().iter().map(of).collect();
            let whole = (spec.clone(), vec![of(spec)]);
            if pieces.len() > 1 { vec![whole, (spec.clone(), pieces)] } else { vec![whole] }
        })
        .collect();
    let rows: Result<Vec<Row>, String> = tasks.par_iter().map(row).collect();
    let says = |program: &Path| version(program).unwrap_or_default();
    Ok(Report { assembler: says(&programs.ptxas), compiler: says(&programs.clang), rows: rows? })
}

/// Returns the page.
pub fn markdown(report: &Report) -> String {
    let mut page = format!(
        "<!-- Written by `cargo measure-gpu --nvidia`; do not edit. -->\n\n# What kernels cost on NVIDIA's GPUs\n\n\
         Kernels as CUDA C through clang ({}) and NVIDIA's assembler ({}), for {} (Ampere, A100) and {} (Ada, RTX 40); nothing runs. A \
         thread turns one signal, whose numbers lie in rows of signals; *in pieces* a band is loaded, turned and stored at a time. \
         *Instructions* are multiplications, additions and fused multiply-adds of f32 as the disassembler counts them, beside the \
         operations that zonal counts; *spilled* are bytes that did not find a register. Roots and reciprocals are the hardware's \
         approximations. No test reads these figures, and nothing of NVIDIA's is part of zonal. All of them are in \
         [nvidia.json](nvidia.json).\n\n",
        report.compiler, report.assembler, ARCHITECTURES[0], ARCHITECTURES[1]
    );
    let ratios: Vec<f64> =
        report.rows.iter().map(|row| row.on[0].operations as f64 / row.operations.max(1) as f64).collect();
    let range = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(*x), most.max(*x)));
    let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
    let _ = writeln!(
        page,
        "On {} a kernel takes {:.2} to {:.2} instructions an operation, {mean:.2} in the mean.\n",
        ARCHITECTURES[0], range.0, range.1
    );
    page += "| kernel | called | operations |";
    for name in ARCHITECTURES {
        page += &format!(" {name}: instructions, fused | special | registers | spilled |");
    }
    page += &format!("\n|---|---|---|{}\n", "---|---|---|---|".repeat(ARCHITECTURES.len()));
    for row in &report.rows {
        let called = if row.in_pieces { "in pieces" } else { "whole" };
        let _ = write!(page, "| `{}` | {called} | {} + {} |", row.spec, row.operations, row.special);
        for on in &row.on {
            let Counted { registers, spilled, operations, fused, special } = on;
            let _ = write!(page, " {operations}, {fused} | {special} | {registers} | {spilled} |");
        }
        page.push('\n');
    }
    page
}
