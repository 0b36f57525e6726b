//! Whether the planner's price of a kernel puts kernels into the order that their cycles have.

use crate::compile::{GPUS, Report, Row};
use crate::kernels::Called;
use crate::page::{SHOWN, table};
use crate::registers;
use std::ops::RangeInclusive;
use zonal_codegen::families::{Form, Group, Spec};
use zonal_codegen::plan::contest::{busy, spill};
use zonal_codegen::plan::{ISSUE_CYCLES, MEMORY_CYCLES, READ_WEIGHT, RESULT_CYCLES, SPECIAL_WEIGHT, SPILL_WEIGHT};
use zonal_codegen::promise::registers::{MOST, MOST_WAVES, ROOM};

/// A form in which kernels are compared.
#[derive(Clone, Debug)]
pub struct Compared {
    /// How they are called.
    pub called: Called,
    /// Whether the signal has three channels.
    pub rgb: bool,
    /// It, in words.
    pub words: &'static str,
    /// The orders: what has one band alone is in one piece.
    pub orders: RangeInclusive<usize>,
}

/// What is compared. Three channels at once are pieces: whole, they spill too many registers to be told apart.
pub const COMPARED: [Compared; 3] = [
    Compared { called: Called::Whole, rgb: false, words: "whole, one channel", orders: 2..=10 },
    Compared { called: Called::Pieces, rgb: false, words: "in pieces, one channel", orders: 3..=10 },
    Compared { called: Called::Pieces, rgb: true, words: "in pieces, three channels", orders: 3..=10 },
];

/// How well what the planner counts says what a GPU needs: of the pairs of an order's rotations and tilts.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// The order.
    pub order: usize,
    /// How many kernels.
    pub kernels: usize,
    /// The share of the pairs of which the planner's cheaper one takes no more cycles.
    pub share: f64,
    /// The correlation of the ranks by price and by cycles.
    pub correlation: f64,
    /// Pairs that are told apart wrongly, the worse first.
    pub wrong: Vec<Wrong>,
}

/// A pair that is told apart wrongly.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrong {
    /// The one that the planner holds for cheaper.
    pub cheaper: String,
    /// The other one.
    pub other: String,
    /// How many times the cycles of the other it takes.
    pub times: f64,
    /// The waves of both.
    pub waves: [u64; 2],
}

/// Whether a row is a kernel that turns a signal by itself or with given numbers; a set-up turns none.
fn order_of(row: &Row, compared: &Compared) -> Option<usize> {
    let spec: Spec = row.spec.parse().ok()?;
    let is_turn = matches!(spec.family.group, Group::Rotate | Group::Tilt | Group::SmallAngle);
    let is_compared = row.called == compared.called && spec.rgb == compared.rgb && spec.form == Form::Unrolled;
    (is_turn && is_compared && spec.family.has_signal()).then_some(spec.order)
}

/// The ranks of values, those that are equal in the middle of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |value: &f64| {
        let below = values.iter().filter(|other| *other < value).count();
        let equal = values.iter().filter(|other| *other == value).count();
        below as f64 + (equal - 1) as f64 / 2.0
    };
    values.iter().map(rank).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (of_a, of_b) = (mean(a), mean(b));
    let product = |a: &[f64], of_a: f64, b: &[f64], of_b: f64| -> f64 {
        a.iter().zip(b).map(|(x, y)| (x - of_a) * (y - of_b)).sum()
    };
    product(a, of_a, b, of_b) / (product(a, of_a, a, of_a) * product(b, of_b, b, of_b)).sqrt()
}

fn at_order(order: usize, rows: &[&Row], gpu: usize) -> Agreement {
    let channels = |row: &Row| row.spec.parse().map_or(1, |spec: Spec| spec.channels());
    let price =
        |row: &Row| busy(row.weight, channels(row), row.gpus[registers::GPU].registers as usize) + spill(row.held);
    let cycles = |row: &Row| row.gpus[gpu].cycles;
    let (mut right, mut all, mut wrong) = (0, 0, vec![]);
    for (place, first) in rows.iter().enumerate() {
        for second in &rows[place + 1..] {
            let (cheap, dear) = if price(first) <= price(second) { (first, second) } else { (second, first) };
            if price(cheap) == price(dear) {
                continue;
            }
            all += 1;
            if cycles(cheap) <= cycles(dear) {
                right += 1;
                continue;
            }
            wrong.push(Wrong {
                cheaper: cheap.spec.clone(),
                other: dear.spec.clone(),
                times: cycles(cheap) as f64 / cycles(dear) as f64,
                waves: [cheap, dear].map(|row| row.gpus[gpu].waves),
            });
        }
    }
    wrong.sort_by(|a, b| b.times.total_cmp(&a.times));
    let both =
        [rows.iter().map(|row| price(row) as f64).collect(), rows.iter().map(|row| cycles(row) as f64).collect()];
    let [by_price, by_cycles] = both.map(|values: Vec<f64>| ranks(&values));
    Agreement {
        order,
        kernels: rows.len(),
        share: f64::from(right) / f64::from(all.max(1)),
        correlation: correlation(&by_price, &by_cycles),
        wrong,
    }
}

/// Returns the agreement at each order on a GPU.
pub fn agreement(report: &Report, gpu: usize, compared: &Compared) -> Vec<Agreement> {
    let turning: Vec<(usize, &Row)> =
        report.rows.iter().filter_map(|row| Some((order_of(row, compared)?, row))).collect();
    let rows = |order: usize| turning.iter().filter(move |(of, _)| *of == order).map(|(_, row)| *row);
    compared.orders.clone().map(|order| at_order(order, &rows(order).collect::<Vec<_>>(), gpu)).collect()
}

/// Returns the paragraphs of the page.
pub fn section(report: &Report) -> Vec<String> {
    let names = SHOWN.map(|gpu| GPUS[gpu].family);
    let mut heads = vec!["order".to_owned(), "kernels".to_owned()];
    for name in names {
        heads.extend(["pairs", "ranks", "worst, times the cycles"].map(|what| format!("{name}: {what}")));
    }
    let mut parts = vec![format!(
        "The planner's price of a kernel is its weight: its operations, both sides of a branch among them, {SPECIAL_WEIGHT} for a \
         root or a reciprocal and {READ_WEIGHT} for a number that it is given besides the signal; or, if that is more, what \
         its waves wait for. And {SPILL_WEIGHT} for a number that it holds at once beyond {MOST}. A wave waits \
         {MEMORY_CYCLES} cycles for memory and {RESULT_CYCLES} for each result before it does the next operation of a channel, \
         in which time other waves run: as many as the registers of a unit of RDNA 2 leave room for, {ROOM} by those of the \
         kernel, {MOST_WAVES} at the most. An operation keeps the unit busy for {ISSUE_CYCLES} cycles, so that for weight w, c \
         channels and v waves the price is the larger of w and ({RESULT_CYCLES} w / c + {MEMORY_CYCLES}) / ({ISSUE_CYCLES} v). \
         The numbers are the hardware's as AMD's compiler has them, not fitted; with {RESULT_CYCLES} cycles any answer of \
         memory from 200 to 500 keeps 95 % of the pairs of every table."
    ), "*Pairs*: of all pairs of an order's rotations, small ones among them, and tilts, the share in which the one that the \
         planner holds for cheaper takes no more cycles. *Ranks*: the correlation of the ranks by price and by cycles \
         (Spearman's). What disagrees is listed below each table. By operations alone the lifted rotation would be the cheapest \
         of all from order 6 on, and at order 8 those that leave room for two waves would come before others that leave room \
         for three. RDNA 3 gives out registers in other steps, so that what is ordered by waves of RDNA 2 is not always in its \
         order."
        .to_owned()];
    for compared in &COMPARED {
        let by_gpu = SHOWN.map(|gpu| agreement(report, gpu, compared));
        let row = |place: usize| {
            let mut cells = vec![by_gpu[0][place].order.to_string(), by_gpu[0][place].kernels.to_string()];
            for agreed in by_gpu.iter().map(|all| &all[place]) {
                cells.push(format!("{:.1} %", 100.0 * agreed.share));
                cells.push(format!("{:.3}", agreed.correlation));
                cells.push(match agreed.wrong.first() {
                    Some(worst) => format!("`{}` before `{}`: {:.2}", worst.cheaper, worst.other, worst.times),
                    None => "none".to_owned(),
                });
            }
            cells
        };
        let words = compared.words;
        parts.push(format!("{}{}:", words[..1].to_uppercase(), &words[1..]));
        parts.push(table(&heads, (0..by_gpu[0].len()).map(row)));
        let lines = by_gpu.iter().zip(names).flat_map(|(all, name)| {
            all.iter().filter(|agreed| !agreed.wrong.is_empty()).map(move |agreed| {
                let pair = |wrong: &Wrong| format!("`{}` before `{}` {:.2}", wrong.cheaper, wrong.other, wrong.times);
                let pairs: Vec<String> = agreed.wrong.iter().map(pair).collect();
                format!("- {name}, order {}: {}.", agreed.order, pairs.join(", "))
            })
        });
        parts.push(lines.collect::<Vec<_>>().join("\n"));
    }
    parts
}
