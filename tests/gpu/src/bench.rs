//! The bench itself: every kernel, as it is or with a corrupted constant, run on the driver of this process and measured.

use crate::cases::{Cases, INPUTS, tolerance};
use crate::gpu::Gpu;
use crate::{report, wrap};
use std::fmt;
use std::str::FromStr;
use std::sync::atomic::{AtomicUsize, Ordering};
use zonal_codegen::catalog::{build, standard};
use zonal_codegen::emit::Function;
use zonal_codegen::emit::dialect::Target;

/// The order of the kernels that get a corrupted constant.
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
}

/// What was measured of one text on one driver.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The spec.
    pub spec: String,
    /// The language.
    pub target: Target,
    /// What was corrupted, if anything was.
    pub change: String,
    /// The largest error.
    pub error: f64,
    /// What it may be.
    pub tolerance: f64,
}

impl Row {
    /// Whether the driver computes what the interpreter does.
    pub fn agrees(&self) -> bool {
        self.error <= self.tolerance
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\t{}\t{}\t{:e}\t{:e}", self.spec, self.target, self.change, self.error, self.tolerance)
    }
}

impl FromStr for Row {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<f64>().map_err(|error| format!("{text}: {error}"));
        match line.split('\t').collect::<Vec<_>>()[..] {
            [spec, target, change, error, tolerance] => Ok(Self {
                spec: spec.to_owned(),
                target: target.parse()?,
                change: change.to_owned(),
                error: number(error)?,
                tolerance: number(tolerance)?,
            }),
            _ => Err(format!("no row: {line}")),
        }
    }
}

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

/// The text with its first, middle or last constant changed, each with a word on what was done.
fn corrupted(text: &str) -> Vec<(String, String)> {
    let found = constants(text);
    let mut places = vec![0, found.len() / 2, found.len().saturating_sub(1)];
    places.dedup();
    places.retain(|&place| place < found.len());
    let change = |place: usize| {
        let range = found[place].clone();
        let old = &text[range.clone()];
        let new = old.parse::<f64>().expect("a constant is a number") * CORRUPTION;
        let text = format!("{}{new:?}{}", &text[..range.start], &text[range.end..]);
        (format!("constant {place}: {old} became {new}"), text)
    };
    places.into_iter().map(change).collect()
}

fn functions(mode: Mode) -> Vec<Function> {
    let mut specs = standard();
    if mode == Mode::Mutated {
        specs.retain(|spec| spec.order == MUTATED_ORDER && !spec.rgb);
        specs.dedup_by_key(|spec| report::family(spec));
    }
    let mut functions = build(&specs);
    // The longest first, so that the threads end together.
    functions.sort_by_key(|function| std::cmp::Reverse(function.built.code.cost(function.spec.channels()).total));
    functions
}

/// Runs on as many devices as there are processors, and hands the name of the driver and each row to `report`.
///
/// # Errors
///
/// If there is no device.
pub fn run(mode: Mode, started: impl Fn(&str) + Sync, report: impl Fn(Row) + Sync) -> Result<(), String> {
    let functions = functions(mode);
    let next = AtomicUsize::new(0);
    let work = || -> Result<(), String> {
        let gpu = Gpu::open()?;
        started(&gpu.name);
        while let Some(function) = functions.get(next.fetch_add(1, Ordering::Relaxed)) {
            let cases = Cases::new(function);
            for target in [Target::Wgsl, Target::Glsl] {
                let file = wrap::file(function, target);
                let texts = match mode {
                    Mode::Catalogue => vec![(String::new(), file)],
                    Mode::Mutated => corrupted(&file),
                };
                for (change, text) in texts {
                    let text = wrap::compute(function, target, &text);
                    let name = function.shader_name();
                    let got = gpu.run(&name, target, &text, &cases.inputs, wrap::output_len(function), INPUTS);
                    let (error, tolerance) = (cases.error(&got), tolerance(function));
                    report(Row { spec: function.spec.to_string(), target, change, error, tolerance });
                }
            }
        }
        Ok(())
    };
    let count = std::thread::available_parallelism().map_or(1, usize::from);
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
        assert!(corrupted("a = b;").is_empty());
    }

    #[test]
    fn a_row_reads_back() {
        let row = Row {
            spec: "eval:3".to_owned(),
            target: Target::Glsl,
            change: String::new(),
            error: f64::INFINITY,
            tolerance: 1.5e-7,
        };
        assert_eq!(row.to_string().parse(), Ok(row));
    }
}
