//! What stands above a function: what it computes, over which inputs, at what cost and within which error, in plain
//! ASCII so that every compiler reads it.

use crate::emit::language::Arrays;
use crate::families::family::{Form, Spec};
use crate::ir::code::Code;
use crate::ir::kernel::Domain;
use crate::ir::kernel::Param;
use crate::ir::op::{Op, Price};
use crate::promise::accuracy::{Accuracy, MARGIN};
use crate::promise::built::Built;
use crate::promise::registers::{Called, measured};

const WIDTH: usize = 100;

/// The convention that every kernel keeps, one sentence a line.
pub const CONVENTION: [&str; 2] = [
    "Convention: real orthonormal harmonics with the Condon-Shortley phase (band 1 is -y, z, -x), index l(l+1)+m,",
    "order n = bands 0 to n-1 = n^2 coefficients; a rotation R takes c to D(R) c, with y(R w) = D(R) y(w).",
];

/// Replaces what is not ASCII.
pub fn ascii(text: &str) -> String {
    const NAMES: [(char, &str); 24] = [
        ('α', "alpha"),
        ('β', "beta"),
        ('γ', "gamma"),
        ('φ', "phi"),
        ('ω', "w"),
        ('π', "pi"),
        ('ν', "nu"),
        ('Â', "A^"),
        ('ᵀ', "^T"),
        ('Σ', "sum"),
        ('√', "sqrt"),
        ('²', "^2"),
        ('³', "^3"),
        ('⁻', "^-"),
        ('¹', "1"),
        ('−', "-"),
        ('·', "*"),
        ('×', "x"),
        ('≤', "<="),
        ('≥', ">="),
        ('…', "..."),
        ('°', " deg"),
        ('ř', "r"),
        ('á', "a"),
    ];
    text.chars()
        .map(|c| match NAMES.iter().find(|(from, _)| *from == c) {
            Some((_, to)) => (*to).to_owned(),
            None if c.is_ascii() => c.to_string(),
            None => "?".to_owned(),
        })
        .collect()
}

/// Breaks a sentence into lines; those after the first are indented by `indent`.
pub fn wrap(text: &str, indent: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("starts with one");
        if !line.is_empty() && line.len() + 1 + word.len() > WIDTH {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

fn parameter(param: &Param) -> String {
    format!("{}: {}.", param.name, param.doc)
}

/// Returns how many special operations a kernel has and which, as a sentence goes on after its other operations; nothing if it
/// has none.
pub fn special(code: &Code, channels: usize) -> String {
    let (count, names) = (code.cost(channels).special, code.names(Price::Special));
    let usual = [Op::Recip(()).name(), Op::Rsqrt(()).name()];
    match (names.iter().all(|name| usual.contains(name)), count) {
        (_, 0) => String::new(),
        (true, 1) => " and 1 inverse square root or reciprocal".to_owned(),
        (true, _) => format!(" and {count} inverse square roots or reciprocals"),
        (false, _) => format!(" and {count} special ({})", names.join(", ")),
    }
}

/// What a kernel costs, in a sentence.
fn cost(built: &Built, channels: usize, arrays: Arrays) -> String {
    let cost = built.code.cost(channels);
    let special = special(&built.code, channels);
    let choice = match cost.choice {
        0 => String::new(),
        n => format!(", {n} min, max or select"),
    };
    let footprint = built.code.footprint();
    let live = if matches!(arrays, Arrays::Sink | Arrays::Memory) { footprint.passing } else { footprint.live };
    let below = match &built.code {
        Code::Branch(branch) => format!(" above the limit, {} below it", branch.costs(channels)[0].total),
        _ => String::new(),
    };
    format!(
        "Operations: {} ({} mul, {} add, {} fma{choice}){special}{below}; {} constants, {live} live values.",
        cost.total, cost.mul, cost.add, cost.fma, footprint.constants
    )
}

/// For which parameters a kernel's promises hold, in words.
fn domain(params: &[Param]) -> String {
    // That some angles may be any is not said beside one that is bounded.
    let is_bounded = params.iter().any(|param| param.domain.max_angle().is_some());
    let said = params.iter().filter(|param| !(is_bounded && param.domain == Domain::Phases));
    let words: Vec<String> = said.filter_map(|param| param.domain.in_words(param.name)).collect();
    match words.is_empty() {
        true => "for every input".to_owned(),
        false => words.join(", "),
    }
}

/// How exact a kernel is and where, in sentences.
pub fn error(spec: &Spec, params: &[Param], accuracy: &Accuracy) -> String {
    let domain = domain(params);
    let (measured, samples) = (accuracy.measured_f32, accuracy.samples);
    let why = match accuracy.proven {
        true => {
            format!("proven for IEEE arithmetic, contracted or not; the worst of {samples} measured is {measured:e}")
        }
        false => format!("{MARGIN} times the worst of {samples} measured, {measured:e}; not proven"),
    };
    // A piece's domain is its own; its error is that of all pieces together.
    let together = if spec.form.is_piece() { "with its other pieces " } else { "" };
    let mut text = format!(
        "Error: {together}{} rounding at most {:e} of {}, {domain} ({why}).",
        if spec.half { "f16" } else { "f32" },
        accuracy.rounding_f32,
        accuracy.relative_to
    );
    if !accuracy.method.is_empty() {
        let at: Vec<String> =
            accuracy.method.iter().map(|(degrees, error)| format!("{error:e} at {degrees}")).collect();
        text += &format!(
            " Method error, the worst band's in spectral norm: {} degrees; it grows without bound beyond.",
            at.join(", ")
        );
    }
    if spec.half {
        text += " Numbers beyond 65504 are infinite in f16, and those below 6e-5 lose digits.";
    }
    if spec.is_approximate() && accuracy.method.is_empty() {
        text += " Method error: about (l beta)^2 / 4 in band l while l beta is below 1.";
    }
    text
}

/// What a kernel computes, and then sentences on its parameters, its result, its cost and its error.
fn sentences(built: &Built, spec: &Spec, arrays: Arrays) -> (String, Vec<String>) {
    let mut rest: Vec<String> = built.code.params().iter().map(parameter).collect();
    rest.push(format!("Returns {}.", built.code.result_doc()));
    rest.push(cost(built, spec.channels(), arrays));
    rest.push(error(spec, built.code.params(), &built.accuracy));
    let what = (spec.family.what)(spec);
    let what = match spec.form {
        Form::Unrolled | Form::Loop => what,
        Form::SetUp => format!("The numbers that bands of `{}` take, once for all of them. {what}", spec.whole()),
        Form::Band(l) => format!(
            "Band {l} of `{}` alone, so that a band is loaded, changed and stored at a time. {what}",
            spec.whole()
        ),
    };
    (format!("`{spec}`: {what}"), rest)
}

/// How many registers a kernel takes on a GPU, as a sentence, if it was measured.
fn on_gpu(spec: &Spec) -> Option<String> {
    let of = |called| {
        measured(spec, called).map(|found| match found.spilled {
            0 => found.registers.to_string(),
            spilled => format!("{} and memory for {spilled} more", found.registers),
        })
    };
    let whole = of(Called::Whole)?;
    let pieces = of(Called::Pieces).map_or_else(String::new, |pieces| format!("; in pieces {pieces}"));
    let memory = of(Called::Memory).filter(|_| measured(spec, Called::Pieces).is_some_and(|found| found.spilled > 0));
    let memory = memory.map_or_else(String::new, |memory| format!(", with arrays in memory {memory}"));
    Some(format!("Vector registers on RDNA 2: {whole}{pieces}{memory}."))
}

/// All that stands above a function of a shader, a sentence a line.
pub fn function(built: &Built, spec: &Spec, arrays: Arrays) -> Vec<String> {
    let (what, mut rest) = sentences(built, spec, arrays);
    // After what it costs, which the error ends.
    let place = rest.len() - 1;
    rest.splice(place..place, on_gpu(spec));
    let mut lines = wrap(&what, 0);
    lines.extend(rest.iter().flat_map(|sentence| wrap(sentence, 4)));
    lines.iter().map(|line| ascii(line)).collect()
}

/// Returns it as Markdown whose first paragraph stands alone, as an index of functions shows it.
pub fn listed(built: &Built, spec: &Spec, arrays: Arrays) -> Vec<String> {
    let (what, rest) = sentences(built, spec, arrays);
    let mut lines = wrap(&what, 0);
    lines.push(String::new());
    lines.extend(rest.iter().flat_map(|sentence| wrap(&format!("- {sentence}"), 2)));
    lines.iter().map(|line| ascii(line)).collect()
}
