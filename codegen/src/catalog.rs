//! The checked-in set: every family at every order from 2 to 10, as a file an order, a
//! group and a language, with a table of costs and a list of all kernels.

mod batch;
mod frame;

// Names a language: the checked-in set is in these, whichever others zonal knows.
use crate::emit::language::{self, GLSL, RUST, Target, WGSL};
use crate::emit::validate::validate;
use crate::emit::{Function, Module};
use crate::families::all::ALL;
use crate::families::family::{Group, Spec};
use crate::files::File;
use crate::generate::{GenerateError, Row, build};
use crate::threads;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// The orders of the checked-in set.
pub const ORDERS: RangeInclusive<usize> = 2..=10;

/// The table of costs in the checked-in set.
pub const COSTS: &str = "COSTS.md";

/// The list of kernels in the checked-in set.
pub const MANIFEST: &str = "MANIFEST.tsv";

/// What may lie beside the generated files: the set is a package.
pub const BESIDE: [&str; 4] = ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT"];

// Names a language: the shader files of the checked-in set are these, whichever others zonal knows.
const SHADERS: [Target; 2] = [&WGSL, &GLSL];

/// Every spec of the checked-in set, sorted by order, then as families are listed.
pub fn standard() -> Vec<Spec> {
    ORDERS.flat_map(|order| ALL.iter().flat_map(move |family| (family.shown)(order))).collect()
}

/// The table of costs as Markdown.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = "# What each kernel costs\n\nGenerated with the kernels. A multiplication, an addition, a fused multiply-add or a \
                    choice of two numbers is one\noperation; an inverse square root, a reciprocal, a root or a power \
                    (special) is counted apart. *Live* is how many \
                    values\nthe text needs at once, parameters and results aside: what a compiler has to keep in registers; \
                    *registers* are the vector registers that AMD's compiler takes on RDNA 2, of 256, and those that memory \
                    stands in for. \
                    Rounding is in f32,\nrelative to what each file's head says, proven or measured as `MANIFEST.tsv` has \
                    it.\n\n\
                    | spec | total | mul | add | fma | special | constants | live | registers | f32 rounding |\n\
                    |---|---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for row in rows {
        let (cost, footprint) = (row.cost, row.footprint);
        text += &format!(
            "| `{}` | {} | {} | {} | {} | {} | {} | {} | {} | {:e} |\n",
            row.spec,
            cost.total,
            cost.mul,
            cost.add,
            cost.fma,
            cost.special,
            footprint.constants,
            footprint.live,
            if row.registers.measured { row.registers.to_string() } else { "-".to_owned() },
            row.accuracy.rounding_f32
        );
    }
    text
}

/// The functions of an order and a group, as one module.
fn module(order: usize, group: Group, functions: &[Function]) -> Option<Module> {
    let belongs = |function: &&Function| function.spec.order == order && function.spec.family.group == group;
    let functions: Vec<Function> = functions.iter().filter(belongs).cloned().collect();
    (!functions.is_empty()).then(|| Module {
        name: format!("sh{order}_{}", group.name()),
        origin: format!("the standard catalogue, order {order}: {}", group.what()),
        functions,
        ..Module::default()
    })
}

/// Every file of `generated/`.
///
/// # Errors
///
/// If a kernel is too long or its text is refused: a fault of zonal.
pub fn files() -> Result<Vec<File>, GenerateError> {
    files_of(&build(&standard()))
}

/// The files of some functions, laid out as those of `generated/` are.
///
/// # Errors
///
/// If a kernel is too long or its text is refused: a fault of zonal.
pub fn files_of(functions: &[Function]) -> Result<Vec<File>, GenerateError> {
    let orders: BTreeSet<usize> = functions.iter().map(|function| function.spec.order).collect();
    let modules: Vec<Module> = orders
        .iter()
        .flat_map(|&order| Group::ALL.map(|group| (order, group)))
        .filter_map(|(order, group)| module(order, group, functions))
        .collect();
    let tasks: Vec<(&Module, Target)> =
        modules.iter().flat_map(|module| SHADERS.map(|target| (module, target))).collect();
    // Each kernel is validated by itself: naga takes far longer for all of them in one file.
    let check = |function: &Function| {
        SHADERS.into_iter().try_for_each(|target| {
            let text = alone(function, target)?;
            validate(target, &function.shader_name(), &text).map_err(GenerateError::from)
        })
    };
    threads::map(functions, check).into_iter().collect::<Result<(), GenerateError>>()?;
    let shader = |(module, target): &(&Module, Target)| -> Result<File, GenerateError> {
        Ok(File { path: format!("{target}/{}", module.file_name(target)), text: module.text(target)? })
    };
    let shaders: Result<Vec<File>, GenerateError> = threads::map(&tasks, shader).into_iter().collect();
    let rust = threads::map(&orders, |&order| rust_file(order, functions));
    let rust: Result<Vec<File>, GenerateError> = rust.into_iter().collect();
    let mut files = shaders?;
    files.extend(rust?);
    files.extend(frame::files(&orders, &modules));
    files.extend(batch::files(&orders)?);
    let rows: Vec<Row> = functions.iter().map(Row::of).collect();
    files.push(File { path: COSTS.to_owned(), text: markdown(&rows) });
    files.push(File { path: MANIFEST.to_owned(), text: manifest(functions)? });
    files.sort();
    Ok(files)
}

/// The text of one kernel alone, as `zonal show` prints it.
///
/// # Errors
///
/// If a kernel is too long for a language.
pub fn alone(function: &Function, target: Target) -> Result<String, GenerateError> {
    Ok(Module::of(function.clone()).text(target)?)
}

/// A line a kernel: what it is, what it costs, how exact it is, and a hash of its text in each language, so that a review
/// sees which kernels changed.
fn manifest(functions: &[Function]) -> Result<String, GenerateError> {
    let hash = |text: &str| {
        let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        format!("{:016x}", text.bytes().fold(0xcbf2_9ce4_8422_2325, mix))
    };
    let line = |function: &Function| -> Result<String, GenerateError> {
        let row = Row::of(function);
        let (cost, accuracy) = (row.cost, &row.accuracy);
        let method = accuracy.method.last().map_or("-".to_owned(), |(degrees, error)| format!("{error:e}@{degrees}"));
        let numbers = [cost.total, cost.mul, cost.add, cost.fma, cost.special];
        let footprint = [row.footprint.constants, row.footprint.live];
        let mut cells = vec![row.spec.clone(), row.name.clone(), function.spec.family.group.name().to_owned()];
        cells.extend(numbers.into_iter().chain(footprint).map(|number| number.to_string()));
        let registers = [row.registers.registers, row.registers.spilled];
        let known = row.registers.measured;
        cells.extend(registers.map(|number| if known { number.to_string() } else { "-".to_owned() }));
        cells.push(format!("{:e}", accuracy.rounding_f32));
        cells.push(if accuracy.proven { "proven" } else { "measured" }.to_owned());
        cells.push(method);
        for target in language::ALL {
            cells.push(hash(&alone(function, target)?));
        }
        Ok(cells.join("\t") + "\n")
    };
    let lines: Result<Vec<String>, GenerateError> = threads::map(functions, line).into_iter().collect();
    let targets = language::names().join("\t");
    let head = format!(
        "# @generated by zonal from the standard catalogue; do not edit, generate it again. A line a kernel; \
         registers\n# and spilled are vector registers on RDNA 2 as AMD's compiler gives them out, and those that memory \
         stands in for; the last columns\n# are the FNV-1a hash, 64 bits, of what `zonal show SPEC --target LANGUAGE` prints.\n\
         spec\tname\tgroup\ttotal\tmul\tadd\tfma\tspecial\tconstants\tlive\tregisters\tspilled\trounding\tby\tmethod\t{targets}\n"
    );
    Ok(head + &lines?.concat())
}

fn rust_file(order: usize, functions: &[Function]) -> Result<File, GenerateError> {
    let module = Module {
        name: format!("sh{order}"),
        origin: format!("the standard catalogue, order {order}"),
        functions: functions.iter().filter(|function| function.spec.order == order).cloned().collect(),
        ..Module::default()
    };
    let path = format!("rust/sh{order}.rs");
    let text = module.rust_file()?;
    // Names a language: the crate of the checked-in set is Rust.
    validate(&RUST, &path, &text)?;
    Ok(File { path, text })
}
