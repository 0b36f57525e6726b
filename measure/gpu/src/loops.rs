//! Loops that index memory instead of arrays of their own: the text of a loop as WGSL has it, with what it reads and
//! writes moved into storage buffers or into memory that a group shares. An experiment of what such a form would cost;
//! no kernel is printed so.
//!
//! The driver does not know how often a loop runs and weighs its body as eight times. What a body takes is therefore found
//! by compiling the text without the loop, too, and is multiplied by how often it runs.

use crate::compile::{self, GPUS, Report};
use crate::device::Counted;
use crate::kernels::{Called, Kernel, Pass, shaders};
use crate::page::{SHOWN, table};
use crate::shader::{self, GROUP, ROW};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::Path;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::language::WGSL;
use zonal_codegen::families::Spec;
use zonal_codegen::generate;

/// How often the driver takes a loop to run.
const TAKEN: f64 = 8.0;
/// The orders of which there are straight lines and loops.
const ORDERS: [usize; 8] = [4, 5, 6, 7, 8, 9, 10, 16];

/// How a rotation about y by a small angle is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    /// Straight lines, all coefficients at once.
    Straight,
    /// Straight lines, a band at a time.
    Pieces,
    /// The paper's loop over arrays of the function's own.
    Own,
    /// The loop over storage buffers.
    Storage,
    /// The loop over memory that a group shares, from and to storage buffers.
    Shared,
}

const WAYS: [(Way, &str); 5] = [
    (Way::Straight, "straight lines"),
    (Way::Pieces, "in pieces"),
    (Way::Own, "loop, own arrays"),
    (Way::Storage, "loop, storage"),
    (Way::Shared, "loop, shared"),
];

/// What a way takes at an order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// The order.
    pub order: usize,
    /// The way.
    pub way: Way,
    /// What was counted on each GPU.
    pub gpus: [Counted; GPUS.len()],
    /// The same without the loop, if there is one.
    pub outside: Option<[Counted; GPUS.len()]>,
}

impl Row {
    /// Returns the cycles on a GPU, with the loop as often as it runs: once for each coefficient but the first and the last.
    pub fn cycles(&self, gpu: usize) -> f64 {
        let all = self.gpus[gpu].cycles as f64;
        match &self.outside {
            None => all,
            Some(outside) => {
                let rest = (outside[gpu].cycles as f64).min(all);
                rest + (all - rest) / TAKEN * (self.order * self.order - 2) as f64
            }
        }
    }
}

/// Puts something else for each item of an array in a text.
fn indexed(text: &str, array: &str, item: impl Fn(&str) -> String) -> String {
    let start = format!("{array}[");
    let (mut done, mut rest) = (String::new(), text);
    while let Some(at) = rest.find(&start) {
        let is_name = rest[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_');
        let open = at + start.len();
        if is_name {
            done += &rest[..open];
            rest = &rest[open..];
            continue;
        }
        let close = open + rest[open..].find(']').expect("brackets are closed");
        done += &rest[..at];
        done += &item(&rest[open..close]);
        rest = &rest[close + 1..];
    }
    done + rest
}

/// A text without its loops.
fn without_loops(text: &str) -> String {
    let (mut kept, mut is_inside) = (String::new(), false);
    for line in text.lines() {
        is_inside |= line.starts_with("    for (");
        if !is_inside {
            kept += line;
            kept.push('\n');
        }
        is_inside &= line != "    }";
    }
    kept
}

/// A text whose loop ends at a number that the compiler does not know, so that it stays a loop.
fn unbounded(text: &str, order: usize) -> String {
    text.replace(&format!("i < {};", order * order - 1), "i < i32(parameters[0]);")
}

/// The text of a loop of one channel with memory for its arrays, as a whole shader.
fn in_memory(spec: &Spec, way: Way, has_loop: bool) -> String {
    let function = generate::build(std::slice::from_ref(spec)).remove(0);
    let text = Module::of(function).text(&WGSL).unwrap_or_else(|limit| panic!("{limit}"));
    let (before, body) = text.split_once("\nfn ").expect("a function");
    let (_, body) = body.split_once("{\n").expect("it has a body");
    let (body, _) = body.split_once("\n}").expect("it ends");
    let numbers = spec.order * spec.order;
    let buffer = |name: &'static str| move |at: &str| format!("{name}[u32({at}) * {ROW}u + at]");
    let mut body = body.to_owned();
    let mut globals = String::new();
    body = match way {
        Way::Shared => {
            let length = numbers * GROUP;
            globals +=
                &format!("var<workgroup> taken: array<f32, {length}>;\nvar<workgroup> given: array<f32, {length}>;\n");
            // One number comes and one goes, so that nothing is left out as unused.
            let place = "u32(parameters[1])";
            let taken = indexed(&body, "c", |at| format!("taken[u32({at}) * {GROUP}u + lane]"));
            let given = indexed(&taken, "r", |at| format!("given[u32({at}) * {GROUP}u + lane]"));
            format!("    taken[{place}] = beta;\n{given}\n    results[at] = given[{place}];")
        }
        _ => indexed(&indexed(&body, "c", buffer("coefficients")), "r", buffer("results")),
    };
    let mut offset = 0;
    for constant in before.split("\nconst ").skip(1) {
        let (name, rest) = constant.split_once(" = array<f32, ").expect("a table");
        let length: usize = rest[..rest.find('>').expect("a length")].parse().expect("a number");
        body = indexed(&body, name, |at| format!("tables[u32({at}) + {offset}u]"));
        offset += length;
    }
    let lines = body.lines().filter(|line| !line.contains("var r: array") && !line.contains("return r;"));
    let mut body: String = lines.map(|line| format!("{line}\n")).collect();
    if !has_loop {
        body = without_loops(&body);
    }
    body = unbounded(&body, spec.order);
    format!(
        "@group(0) @binding(0) var<storage, read> parameters: array<f32>;\n\
         @group(0) @binding(1) var<storage, read> coefficients: array<f32>;\n\
         @group(0) @binding(2) var<storage, read_write> results: array<f32>;\n\
         @group(0) @binding(3) var<storage, read> tables: array<f32>;\n{globals}\
         @compute @workgroup_size({GROUP})\n\
         fn main(@builtin(global_invocation_id) thread: vec3<u32>, @builtin(local_invocation_index) lane: u32) {{\n    \
         let at = thread.x;\n    let beta = parameters[at];\n{body}}}\n"
    )
}

/// The paper's loop with arrays of its own, as a whole shader.
fn own(spec: &Spec, has_loop: bool) -> String {
    let function = generate::build(std::slice::from_ref(spec)).remove(0);
    let text = shader::whole(&function);
    let (before, body) = text.split_once("\nfn ").expect("a function");
    let body = if has_loop { body.to_owned() } else { without_loops(body) };
    unbounded(&format!("{before}\nfn {body}"), spec.order)
}

/// Compiles every way at every order, by `program`, which is this package's.
///
/// # Errors
///
/// As [`compile::compile`].
pub fn measured(program: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let spec = |text: String| text.parse::<Spec>().unwrap_or_else(|error| panic!("{text}: {}", error.message));
    let mut kernels: Vec<Kernel> = Vec::new();
    let mut asked: Vec<(usize, Way, bool)> = Vec::new();
    for order in ORDERS {
        for kernel in shaders(&[spec(format!("taylor15:{order}"))]) {
            let way = match kernel.called {
                Called::Whole => Way::Straight,
                Called::Pieces => Way::Pieces,
                Called::Channels | Called::Memory => continue,
            };
            asked.push((order, way, true));
            kernels.push(kernel);
        }
        let looped = spec(format!("taylor15:{order}:loop"));
        let like = shaders(std::slice::from_ref(&looped)).remove(0);
        // The driver takes minutes for an array of 256 that is indexed, and a group has no memory for it.
        for way in [Way::Own, Way::Storage, Way::Shared].into_iter().filter(|&way| way == Way::Storage || order <= 10) {
            for has_loop in [true, false] {
                let text = match way {
                    Way::Own => own(&looped, has_loop),
                    _ => in_memory(&looped, way, has_loop),
                };
                asked.push((order, way, has_loop));
                let pass = Pass { spirv: shader::spirv(&text), times: 1 };
                kernels.push(Kernel { passes: vec![pass], ..like.clone() });
            }
        }
    }
    let report = compile::compile(program, &kernels, || ())?;
    let mut rows: Vec<Row> = Vec::new();
    for ((order, way, has_loop), found) in asked.into_iter().zip(report.rows) {
        match rows.last_mut() {
            Some(row) if !has_loop => row.outside = Some(found.gpus),
            _ => rows.push(Row { order, way, gpus: found.gpus, outside: None }),
        }
    }
    Ok(rows)
}

/// Returns the paragraphs of the page.
pub fn section(report: &Report) -> Vec<String> {
    let mut heads = vec!["order".to_owned()];
    for gpu in SHOWN {
        heads.extend(WAYS.map(|(_, words)| format!("{}: {words}", GPUS[gpu].family)));
    }
    let of = |order: usize, way: Way| report.loops.iter().find(|row| row.order == order && row.way == way);
    let rows = ORDERS.map(|order| {
        let mut cells = vec![order.to_string()];
        for gpu in SHOWN {
            for (way, _) in WAYS {
                cells.push(of(order, way).map_or_else(String::new, |row| {
                    let spilled = match row.gpus[gpu].spilled {
                        0 => String::new(),
                        spilled => format!(" (**{spilled}**)"),
                    };
                    format!("{:.0}{spilled}", row.cycles(gpu))
                }));
            }
        }
        cells
    });
    let [least, most] = pays(report);
    let last = ORDERS[ORDERS.len() - 1];
    let cycles = |way: Way| {
        let of = SHOWN.map(|gpu| of(last, way).map_or(0.0, |row| row.cycles(gpu)));
        of.map(|cycles| format!("{cycles:.0}")).join(" and ")
    };
    vec![
        format!(
            "`taylor15:n`, the rotation about y that the paper prints as a loop, in five ways: cycles with the loop counted as often \
             as it runs, and in bold what it spills. *Own arrays* is the form that is printed; *storage* and *shared* are texts \
             made for this page, of which one reads and writes storage buffers at each place, its tables among them, and the other \
             memory that the group shares, where the coefficients are and stay. Shared memory leaves room for few waves. From \
             order 4 on the better of the two takes {least:.1} to {most:.1} times the cycles of the pieces. At order {last}, where the \
             straight lines of all bands spill, the loop over storage takes {} against their {} cycles, and the pieces {}: no loop \
             pays on these GPUs at any order, and what helps is pieces.",
            cycles(Way::Storage),
            cycles(Way::Straight),
            cycles(Way::Pieces)
        ),
        table(&heads, rows),
    ]
}

/// Returns how many times the cycles of the pieces the better of the loops over memory takes, at least and at most.
pub fn pays(report: &Report) -> [f64; 2] {
    let cycles = |order: usize, way: Way, gpu: usize| {
        report.loops.iter().find(|row| row.order == order && row.way == way).map(|row| row.cycles(gpu))
    };
    let mut bounds = [f64::INFINITY, 0.0];
    for order in ORDERS {
        for gpu in SHOWN {
            let memory = [Way::Storage, Way::Shared].into_iter().filter_map(|way| cycles(order, way, gpu));
            if let (Some(pieces), Some(best)) = (cycles(order, Way::Pieces, gpu), memory.reduce(f64::min)) {
                bounds = [bounds[0].min(best / pieces), bounds[1].max(best / pieces)];
            }
        }
    }
    bounds
}
