//! The page of the times and its figures as data.

use crate::time::{CACHED, IN_CACHE, Measured, Place, STREAMED};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::ops::RangeInclusive;

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
    function: &'static str,
    layout: &'static str,
    place: Place,
    orders: RangeInclusive<usize>,
    units: &'static [&'static str],
    value: fn(&Measured) -> f64,
}

impl Law {
    fn is_about(&self, row: &Measured) -> bool {
        of(row, self.function, self.layout)
            && row.place == self.place
            && self.orders.contains(&row.order)
            && self.units.contains(&row.unit.as_str())
    }
}

fn of(row: &Measured, function: &str, layout: &str) -> bool {
    row.function == function && row.layout == layout
}

/// The units that laws are about.
const VECTOR: &[&str] = &["AVX-512", "AVX2"];
/// The widest alone, which does what it multiplies while memory waits.
const WIDEST: &[&str] = &["AVX-512"];
/// One that multiplies half as fast.
const HALF: &[&str] = &["AVX2"];

/// What issue and design asked for before it was measured.
#[rustfmt::skip]
const LAWS: [Law; 12] = [
    Law { what: "`rotate_each` of blocks in a cache, orders 5 to 10: k", most: 1.35, function: "rotate_each", layout: "blocks",
        place: Place::Cache, orders: 5..=10, units: VECTOR, value: Measured::k },
    Law { what: "the same at the orders 3 and 4: k", most: 1.5, function: "rotate_each", layout: "blocks",
        place: Place::Cache, orders: 3..=4, units: VECTOR, value: Measured::k },
    Law { what: "`rotate_all` of blocks in a cache, orders 5 to 10: k", most: 1.35, function: "rotate_all", layout: "blocks",
        place: Place::Cache, orders: 5..=10, units: VECTOR, value: Measured::k },
    Law { what: "`rotate_each` of blocks from memory, orders 6 to 10, AVX-512: copies", most: 1.25, function: "rotate_each", layout: "blocks",
        place: Place::Memory, orders: 6..=10, units: WIDEST, value: Measured::copies },
    Law { what: "the same with AVX2, whose multiplications at order 10 alone take more than a copy: k", most: 1.7, function: "rotate_each", layout: "blocks",
        place: Place::Memory, orders: 6..=10, units: HALF, value: Measured::k },
    Law { what: "`rotate_all` of splats from memory, AVX-512: copies", most: 1.0, function: "rotate_all", layout: "splats",
        place: Place::Memory, orders: 4..=4, units: WIDEST, value: Measured::copies },
    Law { what: "the same with AVX2: copies", most: 1.0, function: "rotate_all", layout: "splats",
        place: Place::Memory, orders: 4..=4, units: HALF, value: Measured::copies },
    Law { what: "`rotate_each` of splats from memory: copies", most: 2.2, function: "rotate_each", layout: "splats",
        place: Place::Memory, orders: 4..=4, units: VECTOR, value: Measured::copies },
    Law { what: "`basis_each` in a cache, orders 3 to 10, AVX-512: fills", most: 1.3, function: "basis_each", layout: "blocks",
        place: Place::Cache, orders: 3..=10, units: WIDEST, value: Measured::copies },
    Law { what: "the same with AVX2, whose multiplications alone take more than a fill: k", most: 1.3, function: "basis_each", layout: "blocks",
        place: Place::Cache, orders: 3..=10, units: HALF, value: Measured::k },
    Law { what: "`eval_each` in a cache, orders 3 to 10, AVX-512: copies", most: 1.2, function: "eval_each", layout: "blocks",
        place: Place::Cache, orders: 3..=10, units: WIDEST, value: Measured::copies },
    Law { what: "the same with AVX2, whose multiplications alone take more than a copy: k", most: 1.2, function: "eval_each", layout: "blocks",
        place: Place::Cache, orders: 3..=10, units: HALF, value: Measured::k },
];

/// Returns the figures as JSON.
///
/// # Errors
///
/// If a figure is not a number.
pub fn json(report: &Report) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(report)? + "\n")
}

fn name(place: Place) -> &'static str {
    match place {
        Place::Cache => "in a cache",
        Place::Memory => "from memory",
    }
}

/// Returns the page.
pub fn markdown(report: &Report) -> String {
    let mut page = format!(
        "<!-- Written by `cargo measure-batches`; do not edit. -->\n\n# What batches take\n\n\
         The functions of `zonal::batch`, each beside a copy of the same bytes, in turn in one run on one thread; the fastest of \
         many rounds of each. A time means little on another machine, so that it is given as *copies*, how many times as long as the \
         copy, or as a fill of what is written where nothing is read, and as *k*, how many times as long as the slower of the copy and \
         of the multiplications at the peak of the vector unit, which no program beats. In a cache there are \
         {IN_CACHE} signals, or as many as make {} KiB with their results if those are fewer, from memory as many as make {} MiB. Each is run once before it is timed, so that it \
         finds the caches as it leaves them, and everything is made anew some times. `rotate_each` has a quaternion for each signal, \
         in blocks. Machine: {}.\n\n",
        CACHED >> 10,
        STREAMED >> 20,
        report.machine
    );
    for (unit, peak) in &report.units {
        let _ = writeln!(page, "* {unit}: {peak:.0} multiplications, each with an addition, in a nanosecond.");
    }
    page += "\n## What was asked for\n\n| what | at most | found | held by | not by |\n|---|---|---|---|---|\n";
    for Verdict { what, most, found } in &verdicts(report) {
        let missed = missed(*most, found);
        let (least, worst) =
            found.iter().fold((f64::INFINITY, 0.0_f64), |(least, worst), (_, x)| (least.min(*x), worst.max(*x)));
        let held = found.len() - missed.len();
        let _ = writeln!(
            page,
            "| {what} | {most:.2} | {least:.2} to {worst:.2} | {held} of {} | {} |",
            found.len(),
            missed.join(", ")
        );
    }
    page += "\nWhat does not hold is named by its unit and order, with what was found.\n";
    for (unit, _) in &report.units {
        for place in [Place::Cache, Place::Memory] {
            let rows: Vec<&Measured> =
                report.rows.iter().filter(|row| &row.unit == unit && row.place == place).collect();
            if rows.is_empty() {
                continue;
            }
            let orders: BTreeSet<usize> = rows.iter().map(|row| row.order).collect();
            let _ = write!(page, "\n## {unit}, {}\n\n| function, layout |", name(place));
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

/// What was found of what a law asks.
struct Verdict<'a> {
    what: &'static str,
    most: f64,
    found: Vec<(&'a Measured, f64)>,
}

/// How many times as long as blocks arrays may take.
const ARRAYS: f64 = 2.2;

/// What was found of each law.
fn verdicts(report: &Report) -> Vec<Verdict<'_>> {
    let of_law = |law: &Law| {
        let rows = report.rows.iter().filter(|row| law.is_about(row));
        Verdict { what: law.what, most: law.most, found: rows.map(|row| (row, (law.value)(row))).collect() }
    };
    let what = "`rotate_each` of arrays in a cache, from order 4 on: times as long as of blocks";
    LAWS.iter().map(of_law).chain([Verdict { what, most: ARRAYS, found: layouts(report) }]).collect()
}

/// The units and orders that take more than a law allows.
fn missed(most: f64, found: &[(&Measured, f64)]) -> Vec<String> {
    let missed = found.iter().filter(|(_, x)| *x > most);
    missed.map(|(row, x)| format!("{} {} ({x:.2})", row.unit, row.order)).collect()
}

/// Returns a sentence for each law that does not hold, with what was found.
pub fn not_held(report: &Report) -> Vec<String> {
    let sentence = |Verdict { what, most, found }: &Verdict<'_>| {
        let missed = missed(*most, found);
        (!missed.is_empty()).then(|| format!("{what}, at most {most:.2}: {}", missed.join(", ")))
    };
    verdicts(report).iter().filter_map(sentence).collect()
}

/// How many times as long arrays take as blocks.
fn layouts(report: &Report) -> Vec<(&Measured, f64)> {
    let asked = |row: &&Measured| {
        of(row, "rotate_each", "arrays")
            && row.place == Place::Cache
            && row.order >= 4
            && VECTOR.contains(&row.unit.as_str())
    };
    let blocks = |row: &Measured| {
        let is_same = |other: &&Measured| {
            of(other, "rotate_each", "blocks")
                && other.place == Place::Cache
                && other.order == row.order
                && other.unit == row.unit
        };
        report.rows.iter().find(is_same).map(|blocks| blocks.nanoseconds)
    };
    let rows = report.rows.iter().filter(asked);
    rows.filter_map(|row| blocks(row).map(|blocks| (row, row.nanoseconds / blocks))).collect()
}
