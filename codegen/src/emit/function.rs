//! A function as text, in pieces that a template lays out: what stands above it, its signature, its lines.

use crate::emit::body::{Body, RESULT};
use crate::emit::dialect::{Dialect, Laid};
use crate::emit::docs;
use crate::emit::language::{self, Target};
use crate::emit::loop_body;
use crate::emit::module::{Function, Limit};
use crate::emit::parts::{self, PartText, Whole};
use crate::families::family::Spec;
use crate::ir::code::Code;
use crate::ir::kernel::Shape;
use crate::ir::listing::Listing;
use serde::Serialize;

/// A function, ready for a template.
#[derive(Serialize)]
pub struct FunctionText {
    doc: Vec<String>,
    tables: Vec<String>,
    /// Its name.
    pub name: String,
    generics: String,
    params: Vec<String>,
    result: String,
    parts: Vec<PartText>,
    body: Vec<String>,
    /// The functions that do the same for arrays of arrays, in a language whose functions are generic.
    pub wrappers: Vec<WrapperText>,
}

/// A function that calls a generic one.
#[derive(Clone, Serialize)]
pub struct WrapperText {
    /// Its name.
    pub name: String,
    /// Its parameters.
    pub params: Vec<String>,
    /// The type of its result.
    pub result: String,
    /// What it does.
    pub call: String,
}

/// Where in a function its result is given back.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    /// Within a branch.
    Branch,
    /// At its end.
    End,
}

struct Printer<'a> {
    function: &'a Function,
    dialect: Dialect,
    name: &'a str,
    params: Vec<String>,
    parts: Vec<PartText>,
}

impl Printer<'_> {
    /// Refuses a text of so many of `what`, of which a language's compilers take `most`.
    fn too_long(&self, size: usize, what: &str, most: impl Fn(Target) -> usize) -> Limit {
        let language = self.dialect.language;
        let why = format!("{size} {what}, and {} is the most that compilers take", most(language));
        let able = language::ALL.iter().filter(|language| size <= most(language)).map(|able| format!("`{able}`"));
        let able = able.collect::<Vec<_>>().join(" or ");
        let other = if able.is_empty() { String::new() } else { format!(", or the target {able} alone") };
        self.function.limit(language, why, format!("take a lower order or another method{other}"))
    }

    /// What a part of the function is called with.
    fn arguments(&self, result: Shape) -> Vec<&'static str> {
        let mut arguments: Vec<&str> = self.function.built.code.params().iter().map(|param| param.name).collect();
        arguments.extend(self.dialect.is_handed_over(result).then_some(RESULT));
        arguments
    }

    /// The lines of a listing, to its result. `part` is for the names of its parts, if it is cut.
    fn listing(&mut self, listing: &Listing, part: &str, at: At) -> Result<Vec<String>, Limit> {
        let (dialect, language) = (self.dialect, self.dialect.language);
        let body = Body::new(listing, dialect);
        if body.lines.len() > language.max_statements {
            return Err(self.too_long(body.lines.len(), "statements", |target| target.max_statements));
        }
        let mut lines: Vec<String> = match (&language.generic, language.chunk) {
            (Some(generic), Some(chunk)) => {
                let whole = Whole {
                    name: [self.name, part],
                    params: &self.params,
                    arguments: self.arguments(listing.result),
                    has_signal: self.function.has_signal(),
                };
                let (lines, parts) = parts::cut(&whole, dialect, generic, &body, chunk);
                self.parts.extend(parts);
                lines
            }
            _ => body.lines.iter().map(|line| line.statement(dialect)).collect(),
        };
        let numbers: Vec<String> = body.results.into_iter().map(|(text, _)| text).collect();
        lines.extend(self.ending(listing, &numbers, at));
        Ok(lines)
    }

    /// The lines that give a result back.
    fn ending(&self, listing: &Listing, numbers: &[String], at: At) -> Vec<String> {
        let (dialect, statements) = (self.dialect, self.dialect.language.statements);
        let (shape, kind) = (listing.result, listing.result_kind);
        if dialect.is_handed_over(shape) {
            return if at == At::Branch { vec!["return;".to_owned()] } else { vec![] };
        }
        let passed = dialect.passed(shape, kind);
        let (is_written, is_struct) = (dialect.is_written(shape), passed.is_struct());
        if is_written || is_struct {
            let items = dialect.items(RESULT, shape);
            let stored = dialect.grouped(shape, kind, numbers).into_iter().enumerate();
            let mut lines: Vec<String> = stored.map(|(i, item)| format!("{items}[{i}] = {item};")).collect();
            if is_struct {
                lines.insert(0, (statements.variable)(&passed, RESULT));
                lines.push(format!("return {RESULT};"));
            } else if at == At::Branch {
                lines.push("return;".to_owned());
            }
            return lines;
        }
        let (before, after) = match statements.tail && at == At::End {
            true => ("", ""),
            false => ("return ", ";"),
        };
        match dialect.laid(shape, kind, numbers) {
            None => vec![format!("{before}{}{after}", numbers[0])],
            Some(Laid { open, lines, close }) => {
                let items = lines.iter().map(|line| format!("    {line}"));
                let first = std::iter::once(format!("{before}{open}"));
                first.chain(items).chain(std::iter::once(format!("{close}{after}"))).collect()
            }
        }
    }

    /// The way that is taken where the first of two numbers is at most the second.
    fn early(&self, condition: &Listing, below: Vec<String>) -> Vec<String> {
        let condition = Body::new(condition, self.dialect);
        let mut lines: Vec<String> = condition.lines.iter().map(|line| line.statement(self.dialect)).collect();
        let [(value, _), (limit, _)] = &condition.results[..] else {
            unreachable!("a condition compares two numbers");
        };
        lines.push((self.dialect.language.statements.at_most)(value, limit));
        lines.extend(below.into_iter().map(|line| format!("    {line}")));
        lines.push("}".to_owned());
        lines
    }
}

impl Function {
    /// What a user writes where arrays are places, as lines of a comment.
    fn places(&self, dialect: Dialect) -> Vec<String> {
        let code = &self.built.code;
        let (shape, kind) = code.result();
        let arrays = code.params().iter().filter(|param| dialect.is_place(param.shape));
        let read: Vec<String> =
            arrays.map(|param| format!("`{}({} + i)`", dialect.accessor("read", param.kind), param.name)).collect();
        let mut text = String::new();
        if !read.is_empty() {
            text += &format!("Number i of what it takes is {}. ", read.join(", "));
        }
        if dialect.is_place(shape) {
            let write = dialect.accessor("write", kind);
            text += &format!("Number i of the result goes to `{write}({RESULT} + i, number)`. ");
            if !read.is_empty() {
                text += "The result may lie where a signal does, but not where other arrays do. ";
            }
        }
        match text.is_empty() {
            true => vec![],
            false => docs::wrap(&format!("{text}You write these functions."), 4),
        }
    }

    /// Prints the function under a name; `spec` is what its documentation says it serves.
    ///
    /// # Errors
    ///
    /// If it is too long for the language's compilers.
    pub(crate) fn text(&self, dialect: Dialect, name: String, spec: &Spec) -> Result<FunctionText, Limit> {
        let (code, language) = (&self.built.code, dialect.language);
        let (shape, kind) = code.result();
        let mut params: Vec<String> = code.params().iter().map(|param| dialect.parameter(param)).collect();
        let mut result = (language.result)(&dialect.passed(shape, kind));
        if dialect.is_written(shape) {
            let output = if let Code::Loop(kernel) = code { kernel.output } else { RESULT };
            params.push(dialect.output(output, shape, kind));
            result = language.nothing.to_owned();
        }
        let mut printer = Printer { function: self, dialect, name: &name, params, parts: vec![] };
        let mut tables = vec![];
        let body = match code {
            Code::Straight(listing) => printer.listing(listing, "part", At::End)?,
            Code::Branch(branch) => {
                let below = printer.listing(&branch.below, "below", At::Branch)?;
                let mut lines = printer.early(&branch.condition, below);
                lines.extend(printer.listing(&branch.above, "above", At::End)?);
                lines
            }
            Code::Loop(_) if dialect.is_handed_over(shape) => {
                let why = "a loop asks for its numbers in no fixed order".to_owned();
                return Err(self.limit(language, why, "leave `loop` out, or leave `arrays` out".to_owned()));
            }
            Code::Loop(kernel) => {
                if let Some(table) = loop_body::too_long(kernel, language) {
                    return Err(printer.too_long(table.values.len(), "values in a table", |target| target.max_table));
                }
                let mut printed = loop_body::print(kernel, dialect, &name.to_uppercase());
                tables = printed.tables;
                match (printed.result.is_empty(), language.statements.tail) {
                    (true, _) => {}
                    (false, true) => printed.lines.push(printed.result),
                    (false, false) => printed.lines.push(format!("return {};", printed.result)),
                }
                printed.lines
            }
        };
        let Printer { params, parts, .. } = printer;
        let places = self.places(dialect);
        let generic = language.generic.as_ref();
        Ok(FunctionText {
            // What is generic is read in rustdoc.
            doc: generic.map_or_else(
                || [docs::function(&self.built, spec, dialect.arrays), places].concat(),
                |_| docs::listed(&self.built, spec, dialect.arrays),
            ),
            tables,
            generics: generic.map_or("", |generic| generic.bounds[usize::from(self.has_signal())]).to_owned(),
            name,
            params,
            result,
            parts,
            body,
            wrappers: vec![],
        })
    }
}
