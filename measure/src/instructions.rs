//! The instructions of single calls, counted by callgrind: what the compiler makes of a kernel's operations, loads and
//! stores and all. Counting starts valgrind on the bench `instructions` of the crate zonal, which nothing but the command
//! does; a test holds the ledger to the operations that kernels have now.

use crate::markdown::{file, short, table};
use crate::{File, significant};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::listing::Listing;

/// The functions of the bench, their forms, what of the generator they call at order n.
pub const FUNCTIONS: [(&str, &str, &str); 8] = [
    ("rotate", "call", "rotate:n"),
    ("rotate", "into", "rotate:n"),
    ("apply", "call", "rotate:n:angles"),
    ("evaluate_basis", "call", "basis:n"),
    ("evaluate_basis", "into", "basis:n"),
    ("evaluate", "call", "eval:n"),
    ("tilt", "call", "tilt:n"),
    ("tilt", "into", "tilt:n"),
];
/// The forms of the bench. The linker keeps one of two functions that are the same to the last instruction, under either name.
const FORMS: [&str; 2] = ["call", "into"];
const ORDERS: std::ops::RangeInclusive<usize> = 2..=10;
/// Instructions an operation. A multiply-add is two, and numbers are loaded and stored; what lies outside was counted wrongly.
const LEAST: f64 = 1.0;
const MOST: f64 = 6.0;

/// What a call takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instructions {
    /// The kernel.
    pub spec: String,
    /// The function of zonal: that of the bench, with `_into` where it writes in place.
    pub function: String,
    /// The order.
    pub order: usize,
    /// The kernel's operations for one channel, special ones among them.
    pub operations: usize,
    /// Instructions of one call.
    pub count: u64,
}

fn spec_of(function: usize, order: usize) -> Spec {
    FUNCTIONS[function].2.replace(":n", &format!(":{order}")).parse().expect("is of the catalogue")
}

fn operations(spec: &Spec) -> usize {
    Listing::new(&spec.kernel()).cost(1).total
}

/// The functions of a callgrind file with their instructions, what they call included.
fn counted(text: &str) -> BTreeMap<String, u64> {
    let mut names: BTreeMap<&str, &str> = BTreeMap::new();
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    let mut current = "";
    for line in text.lines() {
        if let Some((key, value)) = line.split_once('=')
            && matches!(key, "fn" | "cfn")
        {
            let (id, name) = value.split_once(' ').unwrap_or((value, ""));
            if !name.is_empty() {
                names.insert(id, name);
            }
            if key == "fn" {
                current = names.get(id).copied().unwrap_or_default();
            }
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c))
            && let Some(count) = line.split_whitespace().nth(1).and_then(|count| count.parse::<u64>().ok())
        {
            *counts.entry(current.to_owned()).or_default() += count;
        }
    }
    counts
}

fn output(command: &mut Command) -> Result<Vec<u8>, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stderr(Stdio::piped()).output().map_err(|error| format!("{name}: {error}"))?;
    match output.status.success() {
        true => Ok(output.stdout),
        false => Err(format!("{name}: {}\n{}", output.status, String::from_utf8_lossy(&output.stderr))),
    }
}

/// Compiles the bench for the architecture's baseline and returns where it is.
fn built(root: &Path) -> Result<PathBuf, String> {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["bench", "--package", "zonal", "--bench", "instructions", "--features", "all-orders", "--no-run"]);
    // A target directory of its own keeps other flags of the user's apart from what is counted here.
    command.args(["--message-format", "json", "--target-dir", "target/instructions"]).current_dir(root);
    command.env("RUSTFLAGS", "");
    let messages = output(&mut command)?;
    let executable = |line: &str| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        (message["target"]["name"] == "instructions").then(|| Some(message["executable"].as_str()?.to_owned()))?
    };
    let path = String::from_utf8_lossy(&messages).lines().find_map(executable);
    path.map(PathBuf::from).ok_or_else(|| "cargo built no bench `instructions`".to_owned())
}

/// Counts the calls of the workspace that lies at `root`.
///
/// # Errors
///
/// If the bench does not compile, if valgrind is not there or fails, or if a function is not in what it counted: says
/// which.
pub fn measure(root: &Path) -> Result<Vec<Instructions>, String> {
    let bench = built(root)?;
    // Callgrind takes one name at a time.
    let mut counts = BTreeMap::new();
    for form in FORMS {
        let file = bench.with_extension(format!("{form}.callgrind"));
        let mut command = Command::new("valgrind");
        command.arg("--tool=callgrind").arg(format!("--callgrind-out-file={}", file.display()));
        command.arg(format!("--toggle-collect=*::calls::order*::*::{form}*"));
        output(command.arg(&bench).stdout(Stdio::null()))
            .map_err(|error| format!("{error}; valgrind is Debian's package of that name"))?;
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        counts.extend(counted(&text).into_iter().filter(|(name, _)| name.contains(&format!("::{form}"))));
    }
    let count = |order: usize, function: &str, form: &str| {
        let name = format!("::order{order}::{function}::");
        let named = |form: &str| counts.iter().find(|(known, _)| known.contains(&format!("{name}{form}")));
        let found = named(form).or_else(|| FORMS.iter().find_map(|form| named(form)));
        found.map(|(_, &count)| count).ok_or_else(|| format!("callgrind counted no `{name}{form}`"))
    };
    let mut rows = Vec::new();
    for (place, (function, form, _)) in FUNCTIONS.iter().enumerate() {
        for order in ORDERS {
            let spec = spec_of(place, order);
            rows.push(Instructions {
                operations: operations(&spec),
                spec: spec.to_string(),
                function: format!("{function}{}", if *form == "into" { "_into" } else { "" }),
                order,
                count: count(order, function, form)?,
            });
        }
    }
    Ok(rows)
}

/// What changed between two ledgers, a line a call.
pub fn changes(old: &[Instructions], new: &[Instructions]) -> Vec<String> {
    let changed = |row: &Instructions| {
        let before = old.iter().find(|before| (&before.function, before.order) == (&row.function, row.order))?;
        let text = || format!("{} at order {}: {} → {}", row.function, row.order, before.count, row.count);
        (before.count != row.count).then(text)
    };
    new.iter().filter_map(changed).collect()
}

/// Where a ledger is not of the kernels as they are, or cannot be right.
pub fn stale(rows: &[Instructions]) -> Vec<String> {
    let mut found = Vec::new();
    let wanted: Vec<(usize, usize)> =
        (0..FUNCTIONS.len()).flat_map(|function| ORDERS.map(move |order| (function, order))).collect();
    if rows.len() != wanted.len() {
        return vec![format!(
            "instructions: {} calls, now {}: `cargo measure --instructions`",
            rows.len(),
            wanted.len()
        )];
    }
    for (row, (function, order)) in rows.iter().zip(wanted) {
        let spec = spec_of(function, order);
        let now = operations(&spec);
        if row.spec != spec.to_string() || row.operations != now {
            found.push(format!("instructions: {} had {} operations, now {spec} has {now}", row.spec, row.operations));
        }
        let share = row.count as f64 / row.operations as f64;
        if !(LEAST..=MOST).contains(&share) {
            found.push(format!("instructions: {} takes {} for {} operations", row.spec, row.count, row.operations));
        }
    }
    found
}

/// The page.
pub(crate) fn page(rows: Option<&[Instructions]>) -> File {
    let title = "Instructions of single calls";
    let Some(rows) = rows else {
        return file("instructions", title, &["Not counted yet: run `cargo measure --instructions`.".to_owned()]);
    };
    let lines = rows.iter().map(|row| {
        vec![
            format!("`{}`", row.function),
            format!("`{}`", row.spec),
            row.operations.to_string(),
            row.count.to_string(),
            short(significant(row.count as f64 / row.operations as f64)),
        ]
    });
    let parts = [
        "Instructions of one call in f32, counted by valgrind's callgrind, which `cargo measure --instructions` starts and \
         which prints what has changed since; compiled for release and the architecture's baseline (x86-64), so without \
         multiply-add instructions: a multiply-add is one operation and two instructions. A call is zonal's function as a program \
         has it, in a function of its own; loads, stores and moves count. The counts are the same \
         on every run of one compiler; a test holds the operations to the kernels and the ratios to what is possible."
            .to_owned(),
        table(&["function", "kernel", "operations", "instructions", "an operation"], lines),
    ];
    file("instructions", title, &parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_callgrind_is_read() {
        let text = "events: Ir\n\nfl=(1) x.rs\nfn=(1) a::calls::order5::rotate::call\n0 100\n+3 20\n* 1\ncfn=(2) memcpy\n\
                    calls=2 0\n0 30\n\nfn=(2)\n0 30\n\nfn=(1)\n-1 4\ntotals: 185\n";
        let counted = counted(text);
        assert_eq!(counted["a::calls::order5::rotate::call"], 155);
        assert_eq!(counted["memcpy"], 30);
    }

    #[test]
    fn what_cannot_be_is_found() {
        let row = |function: usize, order: usize, per: f64| {
            let spec = spec_of(function, order);
            let operations = operations(&spec);
            let count = (per * operations as f64) as u64;
            let function = FUNCTIONS[function].0.to_owned();
            Instructions { spec: spec.to_string(), function, order, operations, count }
        };
        let rows: Vec<Instructions> =
            (0..FUNCTIONS.len()).flat_map(|f| ORDERS.map(move |order| row(f, order, 2.0))).collect();
        assert_eq!(stale(&rows), [""; 0]);
        assert_eq!(stale(&rows[1..]).len(), 1);
        let mut wrong = rows.clone();
        wrong[3].operations += 1;
        wrong[7].count = 1;
        assert_eq!(stale(&wrong).len(), 2);
        assert_eq!(changes(&rows, &wrong).len(), 1);
        assert!(page(Some(&rows)).text.contains("| `rotate` | `rotate:5` | 224 | 448 | 2 |"));
    }
}
