//! The bench itself: every kernel, as it is or with a corrupted constant, run on every driver and measured.

use crate::cases::{Cases, FEW, tolerance};
use crate::devices::{COLUMNS, Devices};
use crate::row::Row;
use crate::{report, wrap};
use std::collections::BTreeSet;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use zonal_codegen::catalog::standard;
use zonal_codegen::emit::Function;
use zonal_codegen::emit::dialect::Dialect;
use zonal_codegen::emit::language::{Arrays, GLSL, Target, WGSL};
use zonal_codegen::families::Spec;
use zonal_codegen::generate::build;
use zonal_tests::toys;

/// The order of the kernels that get a corrupted constant, if their family has it.
const MUTATED_ORDER: usize = 4;
/// What a corrupted constant is multiplied by.
const CORRUPTION: f64 = 1.001;

/// What to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Every kernel of the catalogue.
    Catalogue,
    /// A kernel of each family with a constant that is wrong.
    Mutated,
    /// Kernels of every shape of array, passed in each way that a language knows besides its own.
    Arrays,
    /// Kernels that do what none of the catalogue does.
    Toys,
}

/// The kernels that are run with their arrays in each way that a language does not do by itself.
pub const ARRAYS: [&str; 13] = [
    "basis:4",
    "eval:4",
    "eval:4:rgb",
    "rotate:3",
    "rotate:4:rgb",
    "rotate:4:angles",
    "angles:4",
    "tilt:4",
    "tilt:4:rgb",
    "rotate_adaptive:4",
    "zhf:3:rgb",
    "taylor15:4:rgb:loop",
    "rotate:4:loop",
];

/// Where the constants of a text are: every literal with a point that is not zero, outside comments.
fn constants(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '.' || c == '_';
        let mut at = 0;
        while let Some(skip) = (!line.starts_with("//")).then(|| line[at..].find(is_word)).flatten() {
            let from = at + skip;
            at = line[from..].find(|c| !is_word(c)).map_or(line.len(), |length| from + length);
            let word = &line[from..at];
            if word.starts_with(|c: char| c.is_ascii_digit())
                && word.contains('.')
                && word.parse::<f64>().is_ok_and(|value| value != 0.0)
            {
                found.push(start + from..start + at);
            }
        }
        start += line.len();
    }
    found
}

/// The text with its first, middle or last constant changed, each with a word on what was done; a text without constants
/// gets a sum for its first difference, or a difference for its first sum.
fn corrupted(text: &str) -> Vec<(String, String)> {
    let found = constants(text);
    let mut places = vec![0, found.len() / 2, found.len().saturating_sub(1)];
    places.dedup();
    let change = |place: usize| {
        let range = found.get(place)?.clone();
        let old = &text[range.clone()];
        let new = old.parse::<f64>().ok()? * CORRUPTION;
        let text = format!("{}{new:?}{}", &text[..range.start], &text[range.end..]);
        Some((format!("constant {place}: {old} became {new}"), text))
    };
    let sign = |(old, new)| {
        let code = text.lines().find(|line| !line.starts_with("//") && line.contains(old))?;
        Some((format!("a sign of `{}`", code.trim()), text.replacen(code, &code.replacen(old, new, 1), 1)))
    };
    let changed: Vec<(String, String)> = places.into_iter().filter_map(change).collect();
    match changed.is_empty() {
        true => [(" - ", " + "), (" + ", " - ")].into_iter().find_map(sign).into_iter().collect(),
        false => changed,
    }
}

/// The specs to run: all, or those of [`ARRAYS`], or the toys, or of each family that which has the nearest order to [`MUTATED_ORDER`], in one channel
/// if there is such a kernel.
fn specs(mode: Mode) -> Vec<Spec> {
    if mode == Mode::Arrays {
        return ARRAYS.map(|spec| spec.parse().expect("the list holds specs")).to_vec();
    }
    if mode == Mode::Toys {
        return toys::specs();
    }
    let mut specs = standard();
    if mode == Mode::Mutated {
        specs.sort_by_key(|spec| (spec.rgb, spec.order.abs_diff(MUTATED_ORDER)));
        let mut families = BTreeSet::new();
        specs.retain(|spec| families.insert(report::family(spec)));
    }
    specs
}

fn functions(mode: Mode) -> Vec<Function> {
    let mut functions = build(&specs(mode));
    // The longest first, so that the threads end together.
    functions.sort_by_key(|function| std::cmp::Reverse(function.built.code.cost(function.spec.channels()).total));
    functions
}

/// The texts to run of a function in a language, each with what is other about it.
fn texts(function: &Function, target: Target, mode: Mode) -> Vec<(String, Dialect, String)> {
    let own = wrap::dialect(function, target, None);
    // What reads and writes a memory calls functions of the user's: tests/tests/it/memory.rs runs it.
    let others = || target.arrays.iter().filter(|&&arrays| arrays != own.arrays && arrays != Arrays::Memory);
    let passed = |arrays: &Arrays| {
        let dialect = wrap::dialect(function, target, Some(*arrays));
        (arrays.name().to_owned(), dialect, wrap::file(function, dialect))
    };
    match mode {
        Mode::Catalogue | Mode::Toys => vec![(String::new(), own, wrap::file(function, own))],
        Mode::Mutated => {
            corrupted(&wrap::file(function, own)).into_iter().map(|(change, text)| (change, own, text)).collect()
        }
        Mode::Arrays => others().map(passed).collect(),
    }
}

/// The most threads and browsers at once.
const MAX_THREADS: usize = 4;

/// Runs on as many devices of each driver as there are processors, and hands lines to `print`: what each driver calls
/// itself, and every row.
///
/// # Errors
///
/// If there is no device, or a text is refused.
pub fn run(mode: Mode, print: impl Fn(&dyn fmt::Display) + Sync) -> Result<(), String> {
    let functions = functions(mode);
    let next = AtomicUsize::new(0);
    let work = || -> Result<(), String> {
        let mut devices = Devices::open()?;
        COLUMNS.iter().for_each(|column| print(&format!("{}\t{}", column.name(), devices.name(*column))));
        while let Some(function) = functions.get(next.fetch_add(1, Ordering::Relaxed)) {
            // A fault that few inputs show, more would show too.
            let cases = match mode {
                Mode::Mutated => Cases::some(function, FEW),
                _ => Cases::new(function),
            };
            for target in [&WGSL, &GLSL] {
                let texts = texts(function, target, mode);
                for column in COLUMNS.into_iter().filter(|column| column.target == target) {
                    for (change, dialect, text) in &texts {
                        let start = Instant::now();
                        let text = column.wrapped(function, *dialect, text);
                        let got = devices.run(column.driver, &cases.job(function, target, &text));
                        let got = got.map_err(|error| format!("{} of `{}`: {error}", column.name(), function.spec))?;
                        print(&Row {
                            spec: function.spec.to_string(),
                            column: column.name(),
                            change: change.clone(),
                            error: cases.error(&got),
                            tolerance: tolerance(function),
                            seconds: start.elapsed().as_secs_f64(),
                        });
                    }
                }
            }
        }
        Ok(())
    };
    let count = std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().unwrap_or_else(|_| Err("a kernel failed".to_owned())))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_found_outside_comments_and_names() {
        let text = "// 1.5 in words\nlet t1 = 0.25 * c[2] + x.y;\nconst A = f(-1.5, 0.0, 2.0);\n";
        let words: Vec<&str> = constants(text).into_iter().map(|range| &text[range]).collect();
        assert_eq!(words, ["0.25", "1.5", "2.0"]);
        assert_eq!(corrupted("a = 2.0;").len(), 1);
        assert_eq!(corrupted("a = 2.0;")[0].1, "a = 2.002;");
        assert_eq!(corrupted("// b - c\na = b - c;")[0].1, "// b - c\na = b + c;");
        assert_eq!(corrupted("a = b + c;")[0].1, "a = b - c;");
        assert!(corrupted("a = b;").is_empty());
    }

    #[test]
    fn a_row_reads_back() {
        let row = Row {
            spec: "eval:3".to_owned(),
            column: COLUMNS[1].name(),
            change: String::new(),
            error: f64::INFINITY,
            tolerance: 1.5e-7,
            seconds: 0.25,
        };
        assert_eq!(row.to_string().parse(), Ok(row));
    }
}
