//! Text: a module of functions in one language. Templates lay out what people read and hold no mathematics; the
//! lines of the bodies come finished from the listing, the Rust that only rustc reads is quoted.

pub mod body;
pub mod dialect;
pub mod docs;
pub mod loop_body;
pub mod names;
pub mod support;
pub mod validate;

use crate::families::family::Spec;
use crate::ir::code::Code;
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::listing::Listing;
use crate::ir::program::LoopKernel;
use crate::promise::built::Built;
use body::{Body, CHUNK, Line};
use dialect::{Dialect, Target};
use serde::Serialize;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};
use tera::{Context, Tera};

/// A shader function of more statements than this is refused: compilers take seconds for it.
pub const MAX_STATEMENTS: usize = 5000;

/// A function to print: a kernel, the spec it serves and its name.
#[derive(Clone, Debug)]
pub struct Function {
    /// The kernel.
    pub built: Arc<Built>,
    /// The spec, its channels included.
    pub spec: Spec,
    /// A name that replaces the spec's own.
    pub name: Option<String>,
}

/// Constants to print: coefficients of an environment.
#[derive(Clone, Debug, PartialEq)]
pub struct Constants {
    /// The name, in lower case.
    pub name: String,
    /// What they are.
    pub doc: String,
    /// RGB coefficients, index l(l+1)+m.
    pub values: Vec<[f64; 3]>,
}

/// What goes into one file.
#[derive(Clone, Debug, Default)]
pub struct Module {
    /// The name of the file without its extension.
    pub name: String,
    /// What made it: a spec or a scene.
    pub origin: String,
    /// The functions, in order.
    pub functions: Vec<Function>,
    /// The constants, in order.
    pub constants: Vec<Constants>,
}

/// Why a kernel cannot be printed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{spec}` cannot be printed for {target}: {why}; {help}")]
pub struct Limit {
    /// The kernel.
    pub spec: String,
    /// The language.
    pub target: Target,
    /// What stands in the way.
    pub why: String,
    /// What to do.
    pub help: String,
}

#[derive(Serialize)]
struct FunctionText {
    doc: Vec<String>,
    tables: Vec<String>,
    name: String,
    generics: String,
    params: Vec<String>,
    result: String,
    parts: Vec<PartText>,
    body: Vec<String>,
    open: String,
    results: Vec<String>,
    close: String,
    wrappers: Vec<WrapperText>,
}

#[derive(Serialize)]
struct PartText {
    name: String,
    params: Vec<String>,
    result: String,
    body: Vec<String>,
    results: String,
}

#[derive(Clone, Serialize)]
struct WrapperText {
    name: String,
    params: Vec<String>,
    result: String,
    call: String,
}

impl FunctionText {
    /// Sets the lines and the result of a listing.
    fn print(&mut self, dialect: Dialect, listing: &Listing, (lines, body): (Vec<String>, Body)) {
        self.body = lines;
        let items: Vec<String> = body.results.into_iter().map(|(text, _)| text).collect();
        (self.open, self.results, self.close) = results(dialect, listing.result, listing.result_kind, &items);
    }

    /// What has been printed so far as the way that is taken where the condition holds.
    fn early_return(&mut self, dialect: Dialect, condition: &Listing) -> Vec<String> {
        let condition = Body::new(condition, dialect);
        let mut lines: Vec<String> = condition.lines.iter().map(|line| statement(dialect, line)).collect();
        let [(value, _), (limit, _)] = &condition.results[..] else {
            unreachable!("a condition compares two numbers");
        };
        lines.push(match dialect.target {
            Target::Rust => format!("if ({value}).at_most({limit}) {{"),
            _ => format!("if ({value} <= {limit}) {{"),
        });
        lines.extend(self.body.drain(..).map(|line| format!("    {line}")));
        lines.push(format!("    return {}", self.open));
        lines.extend(self.results.drain(..).map(|line| format!("        {line}")));
        lines.push(format!("    {};", self.close));
        lines.push("}".to_owned());
        lines
    }

    fn print_loop(&mut self, kernel: &LoopKernel, dialect: Dialect) {
        let printed = loop_body::print(kernel, dialect, &self.name.to_uppercase());
        (self.tables, self.body, self.results) = (printed.tables, printed.lines, vec![printed.result]);
    }
}

fn templates() -> &'static Tera {
    static TEMPLATES: OnceLock<Tera> = OnceLock::new();
    TEMPLATES.get_or_init(|| {
        let mut tera = Tera::default();
        tera.add_raw_templates([
            ("wgsl", include_str!("../../templates/wgsl.tera")),
            ("glsl", include_str!("../../templates/glsl.tera")),
            ("rust", include_str!("../../templates/rust.tera")),
        ])
        .expect("the templates parse: a test renders each");
        tera
    })
}

/// The first lines of a file.
fn head(origin: &str) -> Vec<String> {
    let made = format!("@generated by zonal from {origin}; do not edit, generate it again.");
    let mut lines = docs::wrap(&made, 0);
    lines.extend(docs::CONVENTION.map(str::to_owned));
    lines.into_iter().map(|line| docs::ascii(&line)).collect()
}

/// The expressions of a result, grouped as its shape asks.
pub(crate) fn results(dialect: Dialect, shape: Shape, kind: Kind, items: &[String]) -> (String, Vec<String>, String) {
    let Some(constructor) = dialect.constructor(shape, kind) else {
        return (String::new(), items.to_vec(), String::new());
    };
    let groups: Vec<String> = items
        .chunks(constructor.size)
        .map(|group| match &constructor.group {
            Some((open, close)) => format!("{open}{}{close}", group.join(", ")),
            None => group.join(", "),
        })
        .collect();
    let last = groups.len() - 1;
    let comma = |i: usize| if i < last || dialect.target == Target::Rust { "," } else { "" };
    let lines = groups.iter().enumerate().map(|(i, group)| format!("{group}{}", comma(i))).collect();
    (constructor.open, lines, constructor.close.to_owned())
}

fn statement(dialect: Dialect, line: &Line) -> String {
    format!("{} = {};", dialect.binding(&format!("t{}", line.number), line.kind), line.text)
}

impl Function {
    /// The name in a shader.
    pub fn shader_name(&self) -> String {
        self.name.clone().unwrap_or_else(|| self.spec.name())
    }

    /// Refuses f16 where there is none.
    fn check_half(&self, target: Target) -> Result<(), Limit> {
        match self.spec.half && target != Target::Wgsl {
            false => Ok(()),
            true => Err(Limit {
                spec: self.spec.to_string(),
                target,
                why: "only WGSL has f16".to_owned(),
                help: "leave `f16` out, or name `wgsl` as the only target".to_owned(),
            }),
        }
    }

    fn shader(&self, target: Target) -> Result<FunctionText, Limit> {
        self.check_half(target)?;
        let dialect = Dialect { target, rgb: self.spec.rgb, half: self.spec.half };
        let name = self.shader_name();
        let mut text = self.frame(dialect, name, &self.spec);
        let lines = |listing: &Listing| {
            let body = Body::new(listing, dialect);
            let size = body.lines.len();
            match size > MAX_STATEMENTS {
                true => Err(self.limit(target, size, "statements", MAX_STATEMENTS)),
                false => Ok((body.lines.iter().map(|line| statement(dialect, line)).collect(), body)),
            }
        };
        match &self.built.code {
            Code::Straight(listing) => text.print(dialect, listing, lines(listing)?),
            Code::Branch(branch) => {
                text.print(dialect, &branch.below, lines(&branch.below)?);
                let early = text.early_return(dialect, &branch.condition);
                text.print(dialect, &branch.above, lines(&branch.above)?);
                text.body.splice(0..0, early);
            }
            Code::Loop(kernel) => {
                if let Some(table) = loop_body::too_long(kernel) {
                    return Err(self.limit(target, table.values.len(), "values in a table", loop_body::MAX_TABLE));
                }
                text.print_loop(kernel, dialect);
            }
        }
        Ok(text)
    }

    fn limit(&self, target: Target, size: usize, what: &'static str, limit: usize) -> Limit {
        Limit {
            spec: self.spec.to_string(),
            target,
            why: format!("{size} {what}, and {limit} is the most that compilers take"),
            help: "take a lower order, or another method".to_owned(),
        }
    }

    /// All of a function but its body.
    fn frame(&self, dialect: Dialect, name: String, spec: &Spec) -> FunctionText {
        let built = &self.built;
        let (shape, kind) = built.code.result();
        FunctionText {
            doc: docs::function(built, spec),
            tables: vec![],
            name,
            generics: match self.has_signal() {
                true => "<T: Real, V: Signal<T>>".to_owned(),
                false => "<T: Real>".to_owned(),
            },
            params: built.code.params().iter().map(|param| dialect.parameter(param)).collect(),
            result: dialect.type_of(shape, kind),
            parts: vec![],
            body: vec![],
            open: String::new(),
            results: vec![],
            close: String::new(),
            wrappers: vec![],
        }
    }

    fn has_signal(&self) -> bool {
        self.built.code.params().iter().any(|param| param.kind == Kind::Signal)
    }

    /// The name of the generic function in Rust, and that of its RGB twin if the spec is RGB.
    pub(crate) fn rust_names(&self) -> (String, Option<String>) {
        match (&self.name, self.spec.rgb) {
            (Some(name), false) => (name.clone(), None),
            (Some(name), true) => (format!("{name}_channels"), Some(name.clone())),
            (None, false) => (self.spec.stem(), None),
            (None, true) => (self.spec.base().stem(), Some(self.spec.stem())),
        }
    }

    fn rust(&self, name: String) -> FunctionText {
        let dialect = Dialect { target: Target::Rust, rgb: false, half: false };
        let mut text = self.frame(dialect, name, &self.spec.base());
        match &self.built.code {
            Code::Straight(listing) => {
                let body = Body::new(listing, dialect);
                let lines = self.rust_body(&mut text, dialect, &body, "part");
                text.print(dialect, listing, (lines, body));
            }
            Code::Branch(branch) => {
                let body = Body::new(&branch.below, dialect);
                let lines = self.rust_body(&mut text, dialect, &body, "below");
                text.print(dialect, &branch.below, (lines, body));
                let early = text.early_return(dialect, &branch.condition);
                let body = Body::new(&branch.above, dialect);
                let lines = self.rust_body(&mut text, dialect, &body, "above");
                text.print(dialect, &branch.above, (lines, body));
                text.body.splice(0..0, early);
            }
            Code::Loop(kernel) => text.print_loop(kernel, dialect),
        }
        text
    }

    /// The lines of a body; a long one is cut into parts that hand on what later parts need.
    fn rust_body(&self, text: &mut FunctionText, dialect: Dialect, body: &Body, part: &str) -> Vec<String> {
        if body.lines.len() <= CHUNK {
            return body.lines.iter().map(|line| statement(dialect, line)).collect();
        }
        let mut lines = Vec::new();
        let kinds: Vec<Kind> = body.lines.iter().map(|line| line.kind).collect();
        let chunks: Vec<&[Line]> = body.lines.chunks(CHUNK).collect();
        let turbofish = match self.has_signal() {
            true => "::<T, V>",
            false => "::<T>",
        };
        let arguments: Vec<&str> = self.built.code.params().iter().map(|param| param.name).collect();
        for (place, chunk) in chunks.iter().enumerate() {
            let first = chunk[0].number;
            let end = first + chunk.len();
            let needed: BTreeSet<usize> =
                chunk.iter().flat_map(|line| &line.names).copied().filter(|&name| name < first).collect();
            let later = body.lines[end..].iter().flat_map(|line| &line.names);
            let results = body.results.iter().flat_map(|(_, names)| names);
            let handed: BTreeSet<usize> =
                later.chain(results).copied().filter(|name| (first..end).contains(name)).collect();
            let split = |names: &BTreeSet<usize>, kind: Kind| -> Vec<String> {
                names.iter().filter(|&&name| kinds[name] == kind).map(|name| format!("t{name}")).collect()
            };
            let list = |names: &BTreeSet<usize>| -> Vec<(Vec<String>, &'static str)> {
                [(Kind::Scalar, "T"), (Kind::Signal, "V")]
                    .map(|(kind, number)| (split(names, kind), number))
                    .into_iter()
                    .filter(|(names, _)| !names.is_empty())
                    .collect()
            };
            let (inputs, outputs) = (list(&needed), list(&handed));
            let tuple = |items: Vec<String>| match items.len() {
                1 => items[0].clone(),
                _ => format!("({})", items.join(", ")),
            };
            let brackets = |(names, _): &(Vec<String>, &str)| format!("[{}]", names.join(", "));
            let types = |(names, number): &(Vec<String>, &str)| format!("[{number}; {}]", names.len());
            let mut params = text.params.clone();
            params.extend(inputs.iter().map(|input| format!("{}: {}", brackets(input), types(input))));
            let name = format!("{}_{part}_{place}", text.name);
            let call: Vec<String> =
                arguments.iter().map(|name| (*name).to_owned()).chain(inputs.iter().map(brackets)).collect();
            lines.push(format!(
                "let {} = {name}{turbofish}({});",
                tuple(outputs.iter().map(brackets).collect()),
                call.join(", ")
            ));
            text.parts.push(PartText {
                name,
                params,
                result: tuple(outputs.iter().map(types).collect()),
                body: chunk.iter().map(|line| statement(dialect, line)).collect(),
                results: tuple(outputs.iter().map(brackets).collect()),
            });
        }
        lines
    }

    fn wrapper(&self, generic: &str, name: String) -> WrapperText {
        let plain = Dialect { target: Target::Rust, rgb: false, half: false };
        let rgb = |text: String| text.replace('V', "[T; 3]");
        let params = self.built.code.params();
        let arguments: Vec<String> = params
            .iter()
            .map(|param| match param.kind {
                Kind::Scalar => param.name.to_owned(),
                Kind::Signal => format!("&{}.map(Channels)", param.name),
            })
            .collect();
        let (shape, kind) = self.built.code.result();
        let open = match shape {
            Shape::Scalar => ".0",
            _ => ".map(|v| v.0)",
        };
        WrapperText {
            name,
            params: params.iter().map(|param| rgb(plain.parameter(param))).collect(),
            result: rgb(plain.type_of(shape, kind)),
            call: format!("{generic}::<T, Channels<T, 3>>({}){open}", arguments.join(", ")),
        }
    }
}

impl Constants {
    fn text(&self, target: Target, half: bool) -> String {
        let name = self.name.to_uppercase();
        let doc = docs::wrap(&docs::ascii(&self.doc), 0).join(match target {
            Target::Rust => "\n/// ",
            _ => "\n// ",
        });
        let count = self.values.len();
        let number = |x: f64| dialect::shader_literal(x as f32);
        let float = if half { "f16" } else { "f32" };
        let row = |v: &[f64; 3]| match target {
            Target::Wgsl => format!("    vec3<{float}>({}, {}, {})", number(v[0]), number(v[1]), number(v[2])),
            Target::Glsl => format!("    vec3({}, {}, {})", number(v[0]), number(v[1]), number(v[2])),
            Target::Rust => format!("    [{}, {}, {}]", number(v[0]), number(v[1]), number(v[2])),
        };
        let rows: Vec<String> = self.values.iter().map(row).collect();
        let rows = rows.join(",\n");
        match target {
            Target::Wgsl => format!("// {doc}\nconst {name} = array<vec3<{float}>, {count}>(\n{rows}\n);"),
            Target::Glsl => format!("// {doc}\nconst vec3[{count}] {name} = vec3[{count}](\n{rows}\n);"),
            Target::Rust => format!("/// {doc}\npub const {name}: [[f32; 3]; {count}] = [\n{rows},\n];"),
        }
    }
}

impl Module {
    /// The module of one function.
    pub fn of(function: &Function) -> Self {
        Self {
            name: function.shader_name(),
            origin: format!("`{}`", function.spec),
            functions: vec![function.clone()],
            constants: vec![],
        }
    }

    /// The text of the module in a shader language.
    ///
    /// # Errors
    ///
    /// If a function is too long for the language's compilers.
    pub fn shader(&self, target: Target) -> Result<String, Limit> {
        let functions: Result<Vec<_>, _> = self.functions.iter().map(|function| function.shader(target)).collect();
        let mut context = Context::new();
        context.insert("head", &head(&self.origin));
        context.insert("guard", &format!("ZONAL_{}_GLSL", self.name.to_uppercase()));
        context.insert("half", &self.functions.iter().any(|function| function.spec.half));
        context.insert("tables", &self.tables(target));
        context.insert("functions", &functions?);
        Ok(render(target.name(), &context))
    }

    fn tables(&self, target: Target) -> Vec<String> {
        // Numbers for kernels of f16 alone are f16 themselves.
        let half = !self.functions.is_empty() && self.functions.iter().all(|function| function.spec.half);
        self.constants.iter().map(|constants| constants.text(target, half)).collect()
    }

    /// The Rust items of the module's functions and constants, without what they stand on.
    pub fn rust_items(&self) -> String {
        let mut functions: Vec<FunctionText> = Vec::new();
        for function in &self.functions {
            let (name, rgb) = function.rust_names();
            let at = functions.iter().position(|known| known.name == name).unwrap_or_else(|| {
                functions.push(function.rust(name.clone()));
                functions.len() - 1
            });
            if let Some(rgb) = rgb {
                functions[at].wrappers.push(function.wrapper(&name, rgb));
            }
        }
        let mut context = Context::new();
        context.insert("tables", &self.tables(Target::Rust));
        context.insert("functions", &functions);
        render("rust", &context)
    }

    /// A Rust file of the module's items that uses `real` from its parent.
    pub fn rust_file(&self) -> String {
        format!("{}\n{}", self.rust_head(), self.with_uses("super::real"))
    }

    /// The items under the `use` lines that they need.
    fn with_uses(&self, real: &str) -> String {
        let items = self.rust_items();
        let used: Vec<&str> = ["Channels", "Real", "Signal"].into_iter().filter(|name| items.contains(*name)).collect();
        match used.is_empty() {
            true => items,
            false => format!("use {real}::{{{}}};\n{items}", used.join(", ")),
        }
    }

    fn rust_head(&self) -> String {
        head(&self.origin).iter().map(|line| format!("// {line}\n")).collect()
    }

    /// Whether all functions can be printed as Rust.
    ///
    /// # Errors
    ///
    /// If one works in f16.
    pub fn check_rust(&self) -> Result<(), Limit> {
        self.functions.iter().try_for_each(|function| function.check_half(Target::Rust))
    }

    /// A Rust file that stands alone: `real`, then a module for each order, then the constants.
    pub fn rust_alone(&self) -> String {
        let mut text = format!(
            "{}\n/// What the kernels are generic over.\n#[allow(dead_code)]\npub mod real {{\n{}}}\n",
            self.rust_head(),
            support::real(support::Std::Always)
        );
        let orders: BTreeSet<usize> = self.functions.iter().map(|function| function.spec.order).collect();
        for order in orders {
            let module = Self {
                functions: self.functions.iter().filter(|function| function.spec.order == order).cloned().collect(),
                ..Self::default()
            };
            text += &format!(
                "\n/// Kernels of order {order}.\n#[allow(dead_code)]\npub mod sh{order} {{\n{}}}\n",
                module.with_uses("super::real")
            );
        }
        for table in self.tables(Target::Rust) {
            text += &format!("\n{table}\n");
        }
        text
    }
}

fn render(template: &str, context: &Context) -> String {
    let text = templates().render(template, context).expect("the context has what the template names");
    // Templates leave blank lines where an optional part is missing.
    let mut out = String::with_capacity(text.len());
    let mut blank = true;
    for line in text.lines().map(str::trim_end) {
        if !(line.is_empty() && blank) {
            out.push_str(line);
            out.push('\n');
        }
        blank = line.is_empty();
    }
    out
}
