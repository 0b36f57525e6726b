//! `docs/GPU.md` and the figures behind it.

use crate::compile::{GPUS, Report, Row};
use crate::device::Counted;
use crate::kernels::{Called, MUCH};
use crate::{loops, price, registers};
use std::collections::BTreeMap;
use zonal_codegen::families::Spec;
use zonal_codegen::plan::contest::SPECIAL_WEIGHT;

/// The page.
pub const PAGE: &str = "GPU.md";
/// The figures.
pub const JSON: &str = "gpu.json";

/// The GPUs that the page shows: the others are in the figures.
pub(crate) const SHOWN: [usize; 2] = [1, 2];
/// Orders of the tables.
const ORDERS: std::ops::RangeInclusive<usize> = 3..=10;

/// Returns the figures, a line a kernel.
///
/// # Errors
///
/// None that a report gives rise to.
pub fn json(report: &Report) -> Result<String, serde_json::Error> {
    let rows: Result<Vec<String>, _> = report.rows.iter().map(serde_json::to_string).collect();
    let loops: Result<Vec<String>, _> = report.loops.iter().map(serde_json::to_string).collect();
    let (driver, rows, loops) = (serde_json::to_string(&report.driver)?, rows?.join(",\n"), loops?.join(",\n"));
    Ok(format!("{{\"driver\": {driver},\n\"rows\": [\n{rows}\n],\n\"loops\": [\n{loops}\n]}}\n"))
}

/// Rows by their spec and how they are called.
struct Rows<'a>(BTreeMap<(&'a str, Called), &'a Row>);

impl<'a> Rows<'a> {
    fn new(report: &'a Report) -> Self {
        Self(report.rows.iter().map(|row| ((row.spec.as_str(), row.called), row)).collect())
    }

    fn get(&self, spec: &str, called: Called) -> Option<&'a Row> {
        self.0.get(&(spec, called)).copied()
    }
}

pub(crate) fn table(columns: &[String], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut text = format!("| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
    rows.into_iter().for_each(|row| text += &format!("| {} |\n", row.join(" | ")));
    text
}

fn registers(counted: Counted) -> String {
    match counted.spilled {
        0 => counted.registers.to_string(),
        spilled => format!("{} + **{spilled}**", counted.registers),
    }
}

/// A kernel called in several ways, on the GPUs that are shown.
fn compared(rows: &Rows<'_>, spec: &str, ways: &[Called]) -> Option<Vec<String>> {
    let found: Vec<&Row> = ways.iter().map(|&called| rows.get(spec, called)).collect::<Option<_>>()?;
    let mut cells = vec![format!("`{spec}`"), found[0].operations.to_string()];
    for gpu in SHOWN {
        for row in &found {
            let counted = row.gpus[gpu];
            cells.extend([registers(counted), counted.waves.to_string(), counted.cycles.to_string()]);
        }
    }
    Some(cells)
}

fn heads(ways: &[Called]) -> Vec<String> {
    let mut heads = vec!["kernel".to_owned(), "operations".to_owned()];
    for gpu in SHOWN {
        let name = GPUS[gpu].family;
        for called in ways {
            let called = match called {
                Called::Whole => "whole",
                Called::Pieces => "pieces",
                Called::Channels => "by channels",
                Called::Memory => "in memory",
            };
            heads.extend(["registers", "waves", "cycles"].map(|what| format!("{name}, {called}: {what}")));
        }
    }
    heads
}

/// Kernels with their arrays in memory beside another way in which they spill.
fn in_memory_table(rows: &Rows<'_>, other: Called, specs: &[&str]) -> String {
    let spills =
        |spec: &str| rows.get(spec, other).is_some_and(|row| SHOWN.iter().any(|&gpu| row.gpus[gpu].spilled > 0));
    let ways = [other, Called::Memory];
    let specs = specs.iter().filter(|spec| spec.ends_with(":rgb") == (other == Called::Channels) && spills(spec));
    table(&heads(&ways), specs.filter_map(|spec| compared(rows, spec, &ways)))
}

/// A loop beside the straight lines that do the same.
fn looped(rows: &Rows<'_>, row: &Row) -> Option<Vec<String>> {
    let straight = row.spec.replace(":loop", "");
    let straight = rows.get(&straight, Called::Whole)?;
    let mut cells = vec![format!("`{}`", row.spec), straight.operations.to_string()];
    for gpu in SHOWN {
        let [line, own] = [straight.gpus[gpu], row.gpus[gpu]];
        let times = own.cycles as f64 / line.cycles as f64;
        cells.extend([line.cycles.to_string(), own.cycles.to_string(), format!("{times:.1}"), registers(own)]);
    }
    Some(cells)
}

/// The least and the largest of cycles an operation, of kernels that spill nothing.
fn per_operation(report: &Report, gpu: usize) -> [f64; 3] {
    let is_counted = |row: &&Row| row.called == Called::Whole && row.operations >= 100 && row.gpus[gpu].spilled == 0;
    let mut all: Vec<f64> = report
        .rows
        .iter()
        .filter(is_counted)
        .filter(|row| !row.spec.ends_with(":loop"))
        .map(|row| row.gpus[gpu].cycles as f64 / (row.operations + SPECIAL_WEIGHT * row.special) as f64)
        .collect();
    all.sort_by(f64::total_cmp);
    [0, all.len() / 2, all.len().saturating_sub(1)].map(|place| all.get(place).copied().unwrap_or_default())
}

/// Returns the page.
pub fn markdown(report: &Report) -> String {
    let rows = Rows::new(report);
    let spills = |called: Called| {
        let of = |gpu: usize| {
            let kernels = report.rows.iter().filter(|row| row.called == called && row.gpus[gpu].spilled > 0);
            kernels.filter(|row| rows.get(&row.spec, Called::Pieces).is_some()).count().to_string()
        };
        (0..GPUS.len()).map(of).collect::<Vec<_>>()
    };
    let in_memory: Vec<&str> =
        report.rows.iter().filter(|row| row.called == Called::Memory).map(|row| row.spec.as_str()).collect();
    let shared = report.rows.iter().filter(|row| row.called == Called::Pieces).count();
    let turns = |suffix: &str, name: &str| -> String {
        let ways = match suffix {
            "" => &[Called::Whole, Called::Pieces][..],
            _ => &[Called::Whole, Called::Pieces, Called::Channels],
        };
        let all = ORDERS.filter_map(|order| compared(&rows, &format!("{name}:{order}{suffix}"), ways));
        table(&heads(ways), all)
    };
    let looping = report.rows.iter().filter(|row| row.spec.ends_with(":loop") && row.called == Called::Whole);
    let mut loop_heads = vec!["loop".to_owned(), "operations".to_owned()];
    for gpu in SHOWN {
        loop_heads.extend(
            ["unrolled, cycles", "loop, cycles", "times", "loop, registers"]
                .map(|what| format!("{}: {what}", GPUS[gpu].family)),
        );
    }
    let cycles: Vec<Vec<String>> = GPUS
        .iter()
        .enumerate()
        .map(|(place, gpu)| {
            let [least, middle, most] = per_operation(report, place).map(|value| format!("{value:.2}"));
            vec![gpu.family.to_owned(), gpu.what.to_owned(), least, middle, most]
        })
        .collect();
    let named = GPUS.map(|gpu| format!("{} is {}", gpu.family, gpu.what)).join(", ");
    let [whole, pieces, channels] =
        [Called::Whole, Called::Pieces, Called::Channels].map(|called| spills(called).join(", "));
    let slower: Vec<f64> = report
        .rows
        .iter()
        .filter(|row| row.spec.ends_with(":loop") && row.spec.parse::<Spec>().is_ok_and(|spec| spec.order > 3))
        .filter_map(|row| {
            let straight = rows.get(&row.spec.replace(":loop", ""), Called::Whole)?;
            (straight.gpus[SHOWN[0]].spilled == 0).then_some(())?;
            Some(row.gpus[SHOWN[0]].cycles as f64 / straight.gpus[SHOWN[0]].cycles as f64)
        })
        .collect();
    let [least, most] =
        [slower.iter().copied().fold(f64::INFINITY, f64::min), slower.iter().copied().fold(0.0, f64::max)];
    let parts = [
        "<!-- Written by `cargo measure-gpu`; do not edit. -->".to_owned(),
        "# What kernels cost on GPUs".to_owned(),
        format!(
            "Every kernel of the catalogue, from its WGSL through naga, compiled by AMD's driver in Mesa ({}) for GPUs that \
             are not there; nothing runs. {named}. A thread turns one signal, of which the coefficients and the parameters lie \
             in storage buffers, in rows of signals. *Registers* are vector registers, and what is added to them in bold are \
             those that did not suffice, so that memory stands in; *waves* are how many a unit holds at once, which is what \
             hides the time that memory takes; *cycles* are what a wave keeps the busiest part of a unit for, the driver's \
             inverse throughput, loads and stores among them. All figures are in [{JSON}]({JSON}). `cargo measure-gpu` writes \
             this page; a test holds what it says in sentences.",
            report.driver
        ),
        "## Whole and in pieces".to_owned(),
        format!(
            "`rotate:8:pieces` is a set-up and a function a band: a shader loads, turns and stores one band at a time. The \
             operations are those of the whole; what lives at once is less. Of the {shared} kernels of the catalogue that have \
             pieces, so many spill registers on {}: whole {whole}; in pieces {pieces}. *By channels* turns a band of one channel \
             after the other by the functions of one channel: of the kernels of three channels {channels} spill so. Bands that hold \
             {MUCH} numbers or more were compiled with their arrays in memory too, below.",
            GPUS.map(|gpu| gpu.family).join(", ")
        ),
        turns("", "rotate"),
        turns(":rgb", "rotate"),
        turns("", "tilt"),
        turns(":rgb", "tilt"),
        "## Arrays in memory".to_owned(),
        format!(
            "Arrays that are values take registers, and so does what a set-up hands on: too many where bands take hundreds of \
             numbers, as the lifted rotation's do and those of the zonal factorisation. With `arrays = \"memory\"` a function takes \
             places in a memory that functions of the user's read and write: each number is read where it is used, and each \
             result is written as soon as it is known. Here a shader a piece, the set-up's once a signal and those of bands once a \
             channel, with all arrays in storage buffers; in one shader the compiler keeps what it read for a band until another \
             one reads it again. Cycles are those of all shaders together; what a band alone makes is made for each channel. Of \
             the {} kernels that were compiled so {} spill on {}. Where values suffice, memory costs cycles; those that spill in \
             pieces, or by channels, on {} or {} are:",
            in_memory.len(),
            spills(Called::Memory).join(", "),
            GPUS.map(|gpu| gpu.family).join(", "),
            GPUS[SHOWN[0]].family,
            GPUS[SHOWN[1]].family
        ),
        in_memory_table(&rows, Called::Pieces, &in_memory),
        in_memory_table(&rows, Called::Channels, &in_memory),
        "## Loops".to_owned(),
        format!(
            "A loop over a local array indexes registers by chains of moves. It saves text and time to compile: from order 4 on \
             the loops of the catalogue take {least:.1} to {most:.0} times the cycles of their straight lines on {}, where \
             those spill nothing, if a loop runs eight times, one in it four times and one in that twice, as the driver \
             takes it, which does not know. That is too little for `taylor15`, whose loop runs once a coefficient, and for the \
             rotations beyond order 6. Where straight lines spill, it is pieces that help.",
            GPUS[SHOWN[0]].family
        ),
        table(&loop_heads, looping.filter_map(|row| looped(&rows, row))),
        loops::section(report).join("\n\n"),
        "## Operations and cycles".to_owned(),
        format!(
            "Cycles by operations (and {SPECIAL_WEIGHT} for a root or a reciprocal), over whole kernels \
             of 100 operations or more that spill nothing: the least, the middle, the largest. Two cycles an operation are \
             what RDNA takes for a wave of 64; the rest is loads and stores."
        ),
        table(&["GPU", "which", "least", "middle", "largest"].map(str::to_owned), cycles),
    ];
    let parts = parts.into_iter().chain(price::section(report)).chain(registers::section(report)).collect::<Vec<_>>();
    parts.join("\n\n").replace("\n\n\n", "\n\n")
}
