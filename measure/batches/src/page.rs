//! The page of the times and its figures as data.

use crate::time::{IN_CACHE, Measured, STREAMING};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;

/// The page.
pub const PAGE: &str = "BATCHES.md";
/// The figures.
pub const JSON: &str = "batches.json";

/// What was measured in one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The processor, as the system calls it.
    pub machine: String,
    /// The units, each with the multiplications that it does in a nanosecond.
    pub units: Vec<(String, f64)>,
    /// The times.
    pub rows: Vec<Measured>,
}

/// A law: what is asked of a function's k, or of its copies.
struct Law {
    what: &'static str,
    most: f64,
    holds: fn(&Measured) -> bool,
    value: fn(&Measured) -> f64,
}

fn of(row: &Measured, function: &str, layout: &str) -> bool {
    row.function == function && row.layout == layout
}

/// What issue and design asked for before it was measured.
const LAWS: [Law; 9] = [
    Law {
        what: "`rotate_each` of blocks in a cache, orders 5 to 10: k",
        most: 1.35,
        holds: |row| of(row, "rotate_each", "blocks") && row.signals == IN_CACHE && row.order >= 5 && row.is_vector(),
        value: Measured::k,
    },
    Law {
        what: "the same at the orders 3 and 4: k",
        most: 1.5,
        holds: |row| {
            of(row, "rotate_each", "blocks")
                && row.signals == IN_CACHE
                && (3..5).contains(&row.order)
                && row.is_vector()
        },
        value: Measured::k,
    },
    Law {
        what: "`rotate_each` of blocks from memory, orders 6 to 10, AVX-512: copies",
        most: 1.25,
        holds: |row| {
            of(row, "rotate_each", "blocks") && row.signals == STREAMING && row.order >= 6 && row.unit == "AVX-512"
        },
        value: Measured::copies,
    },
    Law {
        what: "the same with AVX2: copies",
        most: 1.7,
        holds: |row| {
            of(row, "rotate_each", "blocks") && row.signals == STREAMING && row.order >= 6 && row.unit == "AVX2"
        },
        value: Measured::copies,
    },
    Law {
        what: "`rotate_all` of splats from memory: copies",
        most: 1.0,
        holds: |row| of(row, "rotate_all", "splats") && row.signals == STREAMING && row.is_vector(),
        value: Measured::copies,
    },
    Law {
        what: "`rotate_each` of splats from memory: copies",
        most: 2.2,
        holds: |row| of(row, "rotate_each", "splats") && row.signals == STREAMING && row.is_vector(),
        value: Measured::copies,
    },
    Law {
        what: "`basis_each` in a cache, orders 3 to 10: fills",
        most: 1.3,
        holds: |row| of(row, "basis_each", "blocks") && row.signals == IN_CACHE && row.order >= 3 && row.is_vector(),
        value: Measured::copies,
    },
    Law {
        what: "`eval_each` in a cache, orders 3 to 10: copies",
        most: 1.2,
        holds: |row| of(row, "eval_each", "blocks") && row.signals == IN_CACHE && row.order >= 3 && row.is_vector(),
        value: Measured::copies,
    },
    Law {
        what: "`rotate_all` of blocks in a cache, orders 5 to 10: k",
        most: 1.35,
        holds: |row| of(row, "rotate_all", "blocks") && row.signals == IN_CACHE && row.order >= 5 && row.is_vector(),
        value: Measured::k,
    },
];

impl Measured {
    /// Whether its unit is one that laws are about.
    fn is_vector(&self) -> bool {
        self.unit.starts_with("AVX")
    }
}

/// Returns the figures as JSON.
///
/// # Errors
///
/// If a figure is not a number.
pub fn json(report: &Report) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(report)? + "\n")
}

fn name(signals: usize) -> &'static str {
    if signals == IN_CACHE { "in a cache" } else { "from memory" }
}

/// Returns the page.
pub fn markdown(report: &Report) -> String {
    let mut page = format!(
        "<!-- Written by `cargo measure-batches`; do not edit. -->\n\n# What batches take\n\n\
         The functions of `zonal::batch`, each beside a copy of the same bytes, in turn in one run on one thread; the fastest of \
         many rounds of each. A time means little on another machine, so that it is given as *copies*, how many times as long as the \
         copy, or as a fill of what is written where nothing is read, and as *k*, how many times as long as the slower of the copy and \
         of the multiplications at the peak of the vector unit, which no program beats. {} signals lie in a cache, {} do not from \
         order 6 on. `rotate_each` has a quaternion for each signal, in blocks. Machine: {}.\n\n",
        IN_CACHE, STREAMING, report.machine
    );
    for (unit, peak) in &report.units {
        let _ = writeln!(page, "* {unit}: {peak:.0} multiplications, each with an addition, in a nanosecond.");
    }
    page += "\n## What was asked for\n\n| what | at most | found | held by | not by |\n|---|---|---|---|---|\n";
    for law in &LAWS {
        let found: Vec<&Measured> = report.rows.iter().filter(|row| (law.holds)(row)).collect();
        let (least, most) = range(found.iter().map(|row| (law.value)(row)));
        let missed: Vec<String> = found
            .iter()
            .filter(|row| (law.value)(row) > law.most)
            .map(|row| format!("{} {} ({:.2})", row.unit, row.order, (law.value)(row)))
            .collect();
        let held = found.len() - missed.len();
        let _ = writeln!(
            page,
            "| {} | {:.2} | {least:.2} to {most:.2} | {held} of {} | {} |",
            law.what,
            law.most,
            found.len(),
            missed.join(", ")
        );
    }
    let layouts = layouts(report);
    let (least, most) = range(layouts.iter().map(|(_, times)| *times));
    let missed: Vec<String> = layouts
        .iter()
        .filter(|(_, times)| *times > ARRAYS)
        .map(|(row, times)| format!("{} {} ({times:.2})", row.unit, row.order))
        .collect();
    let _ = writeln!(
        page,
        "| `rotate_each` of arrays in a cache, from order 4 on: times as long as of blocks | {ARRAYS:.2} | {least:.2} to {most:.2} | \
         {} of {} | {} |",
        layouts.len() - missed.len(),
        layouts.len(),
        missed.join(", ")
    );
    page += "\nWhat does not hold is named by its unit and order, with what was found.\n";
    for (unit, _) in &report.units {
        for signals in [IN_CACHE, STREAMING] {
            let rows: Vec<&Measured> =
                report.rows.iter().filter(|row| &row.unit == unit && row.signals == signals).collect();
            if rows.is_empty() {
                continue;
            }
            let orders: BTreeSet<usize> = rows.iter().map(|row| row.order).collect();
            let _ = write!(page, "\n## {unit}, {}\n\n| function, layout |", name(signals));
            orders.iter().for_each(|order| page += &format!(" {order}: ns, copies, k |"));
            page += &format!("\n|---|{}\n", "---|".repeat(orders.len()));
            let mut kinds: Vec<(&str, &str)> = Vec::new();
            for row in &rows {
                if !kinds.contains(&(&row.function, &row.layout)) {
                    kinds.push((&row.function, &row.layout));
                }
            }
            for (function, layout) in kinds {
                let _ = write!(page, "| `{function}`, {layout} |");
                for order in &orders {
                    let row = rows.iter().find(|row| of(row, function, layout) && row.order == *order);
                    page += &row.map_or(" |".to_owned(), |row| {
                        format!(" {:.2}, {:.2}, {:.2} |", row.nanoseconds, row.copies(), row.k())
                    });
                }
                page.push('\n');
            }
        }
    }
    page
}

/// How many times as long as blocks arrays may take.
const ARRAYS: f64 = 2.2;

/// The least and the most of some figures.
fn range(figures: impl Iterator<Item = f64>) -> (f64, f64) {
    figures.fold((f64::INFINITY, 0.0), |(least, most), x| (least.min(x), most.max(x)))
}

/// How many times as long arrays take as blocks.
fn layouts(report: &Report) -> Vec<(&Measured, f64)> {
    let asked = |row: &&Measured| {
        of(row, "rotate_each", "arrays") && row.signals == IN_CACHE && row.order >= 4 && row.is_vector()
    };
    let blocks = |row: &Measured| {
        let is_same = |other: &&Measured| {
            of(other, "rotate_each", "blocks")
                && other.signals == IN_CACHE
                && other.order == row.order
                && other.unit == row.unit
        };
        report.rows.iter().find(is_same).map(|blocks| blocks.nanoseconds)
    };
    let rows = report.rows.iter().filter(asked);
    rows.filter_map(|row| blocks(row).map(|blocks| (row, row.nanoseconds / blocks))).collect()
}
