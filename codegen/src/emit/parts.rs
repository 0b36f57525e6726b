//! A long body cut into functions that hand on what later ones need, for compilers that do not take a function of
//! thousands of lines. Only a language with [`Generic`] is cut, and its syntax is that of Rust.

use crate::emit::body::{Body, Line};
use crate::emit::dialect::Dialect;
use crate::emit::language::record::Generic;
use crate::ir::graph::Kind;
use serde::Serialize;
use std::collections::BTreeSet;

/// One part of a function.
#[derive(Serialize)]
pub struct PartText {
    name: String,
    params: Vec<String>,
    result: String,
    body: Vec<String>,
    results: String,
}

/// The function that is cut.
pub struct Whole<'a> {
    /// Its name and what it has of its own in the names of its parts.
    pub name: [&'a str; 2],
    /// Its parameters as they stand in a signature.
    pub params: &'a [String],
    /// The names of its parameters.
    pub arguments: Vec<&'a str>,
    /// Whether it has a signal.
    pub has_signal: bool,
}

/// Names and the type of an array of them.
type Group = (Vec<String>, &'static str);

fn tuple(items: Vec<String>) -> String {
    match items.len() {
        1 => items[0].clone(),
        _ => format!("({})", items.join(", ")),
    }
}

fn brackets((names, _): &Group) -> String {
    format!("[{}]", names.join(", "))
}

/// Returns the lines of a body, calls of its parts if there are more than `chunk`, and the parts.
pub fn cut(
    whole: &Whole<'_>,
    dialect: Dialect,
    generic: &Generic,
    body: &Body,
    chunk: usize,
) -> (Vec<String>, Vec<PartText>) {
    let statements = |lines: &[Line]| lines.iter().map(|line| line.statement(dialect)).collect::<Vec<_>>();
    if body.lines.len() <= chunk {
        return (statements(&body.lines), vec![]);
    }
    let kinds: Vec<Kind> = body.lines.iter().map(|line| line.kind).collect();
    let groups = |names: &BTreeSet<usize>| -> Vec<Group> {
        let [scalar, signal] = generic.numbers;
        let of = |(is_scalar, number)| {
            let of_kind = names.iter().filter(|&&name| kinds[name].is_scalar() == is_scalar);
            (of_kind.map(|name| format!("t{name}")).collect::<Vec<_>>(), number)
        };
        let groups = [(true, scalar), (false, signal)].map(of);
        groups.into_iter().filter(|(names, _)| !names.is_empty()).collect()
    };
    let types = |(names, number): &Group| (dialect.language.types.array)(number, names.len());
    let (mut lines, mut parts) = (Vec::new(), Vec::new());
    for (place, chunk) in body.lines.chunks(chunk).enumerate() {
        let first = chunk[0].number;
        let end = first + chunk.len();
        let needed: BTreeSet<usize> =
            chunk.iter().flat_map(|line| &line.names).copied().filter(|&name| name < first).collect();
        let later = body.lines[end..].iter().flat_map(|line| &line.names);
        let results = body.results.iter().flat_map(|(_, names)| names);
        let handed: BTreeSet<usize> =
            later.chain(results).copied().filter(|name| (first..end).contains(name)).collect();
        let (inputs, outputs) = (groups(&needed), groups(&handed));
        let mut params = whole.params.to_vec();
        params.extend(inputs.iter().map(|input| format!("{}: {}", brackets(input), types(input))));
        let [function, part] = whole.name;
        let name = format!("{function}_{part}_{place}");
        let arguments = whole.arguments.iter().map(|name| (*name).to_owned());
        let call: Vec<String> = arguments.chain(inputs.iter().map(brackets)).collect();
        let handed = tuple(outputs.iter().map(brackets).collect());
        let generics = generic.arguments[usize::from(whole.has_signal)];
        lines.push(format!("let {handed} = {name}{generics}({});", call.join(", ")));
        parts.push(PartText {
            name,
            params,
            result: tuple(outputs.iter().map(types).collect()),
            body: statements(chunk),
            results: handed,
        });
    }
    (lines, parts)
}
