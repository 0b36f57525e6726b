//! A loop kernel's tables and statements in one language. The text keeps the kernel's order of operations exactly; a
//! template lays its lines out.

use crate::emit::dialect::{Dialect, Target};
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::listing::Sign;
use crate::ir::program::{Int, IntOp, LoopKernel, Name, Num, NumOp, Stmt, Table};
use std::collections::HashMap;

/// The most values of a table in a shader: beyond it, compilers take long, and copies of constant arrays take more than
/// a thread has.
pub const MAX_TABLE: usize = 16384;

/// The columns that a table's lines are wrapped at.
const WIDTH: usize = 100;

/// A loop kernel's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopText {
    /// One declaration a table, of several lines each, for the file and not for the function.
    pub tables: Vec<String>,
    /// The statements, one a line, what stands in a loop indented by four spaces a level.
    pub lines: Vec<String>,
    /// The expression of the result.
    pub result: String,
}

/// The first table that is too long for a shader, if there is one.
pub fn too_long(kernel: &LoopKernel) -> Option<&Table> {
    kernel.tables.iter().find(|table| table.values.len() > MAX_TABLE)
}

/// Prints a kernel; `prefix` and an underscore stand before the name of each of its tables.
pub fn print(kernel: &LoopKernel, dialect: Dialect, prefix: &str) -> LoopText {
    let params = kernel.params.iter().map(|param| (param.name, param.kind));
    let tables = kernel.tables.iter().map(|table| (table.name, Kind::Scalar));
    let mut printer =
        Printer { kernel, dialect, prefix, kinds: params.chain(tables).collect(), lines: Vec::new(), indent: 0 };
    printer.block(&kernel.body);
    LoopText {
        tables: kernel.tables.iter().map(|table| printer.table(table)).collect(),
        lines: printer.lines,
        result: kernel.output.to_owned(),
    }
}

/// How tightly an expression binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

struct Text {
    text: String,
    binding: Binding,
}

impl Text {
    fn atom(text: String) -> Self {
        let binding = Binding::Atom;
        Self { text, binding }
    }

    fn at_least(&self, binding: Binding) -> String {
        match self.binding >= binding {
            true => self.text.clone(),
            false => format!("({})", self.text),
        }
    }

    /// An operator that groups from the left.
    fn infix(a: &Self, operator: &str, b: &Self) -> Self {
        let (binding, above) = match operator {
            "+" | "-" => (Binding::Sum, Binding::Product),
            _ => (Binding::Product, Binding::Atom),
        };
        let text = format!("{} {operator} {}", a.at_least(binding), b.at_least(above));
        Self { text, binding }
    }
}

struct Printer<'a> {
    kernel: &'a LoopKernel,
    dialect: Dialect,
    prefix: &'a str,
    kinds: HashMap<Name, Kind>,
    lines: Vec<String>,
    indent: usize,
}

impl Printer<'_> {
    fn table(&self, table: &Table) -> String {
        let (name, len) = (format!("{}_{}", self.prefix, table.name), table.values.len());
        let rust = self.dialect.target == Target::Rust;
        let (open, close) = match rust {
            // A constant would be copied wherever it is indexed.
            true => (format!("#[allow(clippy::approx_constant)]\nstatic {name}: [f64; {len}] = ["), "];"),
            false => self.dialect.table(&name, Shape::Array(len)),
        };
        let mut lines: Vec<String> = table.doc.lines().map(|line| format!("// {line}")).collect();
        lines.push(open);
        lines.push("   ".to_owned());
        for (i, value) in table.values.iter().enumerate() {
            let value = match rust {
                true => format!("{:?}", value.to_f64()),
                false => self.dialect.literal(value),
            };
            let comma = if i + 1 < len { "," } else { "" };
            let last = lines.last_mut().expect("holds one");
            if last.len() + 1 + value.len() + comma.len() <= WIDTH {
                *last += &format!(" {value}{comma}");
            } else {
                lines.push(format!("    {value}{comma}"));
            }
        }
        lines.push(close.to_owned());
        lines.join("\n")
    }

    fn line(&mut self, text: &str) {
        self.lines.push(format!("{:indent$}{text}", "", indent = 4 * self.indent));
    }

    fn block(&mut self, body: &[Stmt]) {
        for stmt in body {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match stmt {
            Stmt::Int(name, value) => self.declare("int", name, false, self.int(value)),
            Stmt::Counter(name, value) => self.declare("int", name, true, self.int(value)),
            Stmt::Advance(name) => self.line(&format!("{name} += 1;")),
            Stmt::Let(name, value) | Stmt::Var(name, value) => {
                let kind = self.kind(value);
                self.kinds.insert(name, kind);
                let mutable = matches!(stmt, Stmt::Var(..));
                self.declare(self.dialect.number(kind), name, mutable, self.num(value));
            }
            Stmt::Set(name, value) => self.line(&format!("{name} = {};", self.num(value).text)),
            Stmt::Array(name, len, kind) => {
                self.kinds.insert(name, *kind);
                let number = self.dialect.number(*kind);
                self.line(&match self.dialect.target {
                    Target::Wgsl => format!("var {name}: array<{number}, {len}>;"),
                    Target::Glsl => format!("{number} {name}[{len}];"),
                    Target::Rust => format!("let mut {name} = [{number}::zero(); {len}];"),
                });
            }
            Stmt::Store(name, index, value) => {
                self.line(&format!("{name}[{}] = {};", self.int(index).text, self.num(value).text));
            }
            Stmt::Stage(..) => {}
            Stmt::For { name, from, to, step, body } => {
                let (from, to) = (self.int(from).text, self.int(to).text);
                let variable = if self.dialect.target == Target::Wgsl { "var" } else { "int" };
                self.line(&match (self.dialect.target, step) {
                    (Target::Rust, 1) => format!("for {name} in {from}..{to} {{"),
                    (Target::Rust, _) => format!("for {name} in ({from}..{to}).step_by({step}) {{"),
                    _ => format!("for ({variable} {name} = {from}; {name} < {to}; {name} += {step}) {{"),
                });
                self.indent += 1;
                self.block(body);
                self.indent -= 1;
                self.line("}");
            }
        }
    }

    fn declare(&mut self, of: &str, name: Name, mutable: bool, value: Text) {
        let start = match (self.dialect.target, mutable) {
            (Target::Glsl, _) => of,
            (Target::Wgsl, true) => "var",
            (Target::Rust, true) => "let mut",
            (_, false) => "let",
        };
        self.line(&format!("{start} {name} = {};", value.text));
    }

    fn kind(&self, value: &Num) -> Kind {
        match value {
            Num::Const(_) | Num::Tiny => Kind::Scalar,
            Num::Name(name) | Num::Item(name, _) => self.kinds[name],
            Num::Op(_, args) => args.iter().map(|arg| self.kind(arg)).max().unwrap_or(Kind::Scalar),
        }
    }

    fn int(&self, value: &Int) -> Text {
        match value {
            Int::Literal(value) => Text::atom(value.to_string()),
            Int::Name(name) => Text::atom((*name).to_owned()),
            Int::Op(op, ab) => {
                let operator = match op {
                    IntOp::Add => "+",
                    IntOp::Sub => "-",
                    IntOp::Mul => "*",
                    IntOp::Div => "/",
                    IntOp::Rem => "%",
                };
                Text::infix(&self.int(&ab[0]), operator, &self.int(&ab[1]))
            }
        }
    }

    fn item(&self, name: Name, index: &Int) -> String {
        let rust = self.dialect.target == Target::Rust;
        let place = format!("[{}]", self.int(index).text);
        if self.kernel.tables.iter().any(|table| table.name == name) {
            let item = format!("{}_{name}{place}", self.prefix);
            return if rust { format!("T::lit({item})") } else { item };
        }
        let param = self.kernel.params.iter().find(|param| param.name == name);
        match (param, index) {
            (Some(param), &Int::Literal(index)) => self.dialect.component(name, param.shape, index),
            _ => format!("{name}{place}"),
        }
    }

    fn num(&self, value: &Num) -> Text {
        let (op, args) = match value {
            Num::Const(value) => {
                let text = self.dialect.literal(value);
                let binding = if text.starts_with('-') { Binding::Product } else { Binding::Atom };
                return Text { text, binding };
            }
            Num::Tiny => return Text::atom(self.dialect.tiny().to_owned()),
            Num::Name(name) => return Text::atom((*name).to_owned()),
            Num::Item(name, index) => return Text::atom(self.item(name, index)),
            Num::Op(op, args) => (*op, args),
        };
        let args: Vec<Text> = args.iter().map(|arg| self.num(arg)).collect();
        let rust = self.dialect.target == Target::Rust;
        match (op, &args[..]) {
            (NumOp::Neg, [a]) => Text { text: format!("-{}", a.at_least(Binding::Atom)), binding: Binding::Product },
            (NumOp::Add, [a, b]) => Text::infix(a, "+", b),
            (NumOp::Sub, [a, b]) => Text::infix(a, "-", b),
            (NumOp::Mul, [a, b]) => Text::infix(a, "*", b),
            (NumOp::Fma(sign), [a, b, c]) if rust => {
                let method = match sign {
                    Sign::Plus => "fma",
                    Sign::MinusAddend => "fms",
                    Sign::MinusProduct => "fnma",
                };
                Text::atom(format!("{}.{method}({}, {})", a.at_least(Binding::Atom), b.text, c.text))
            }
            (NumOp::Fma(sign), [a, b, c]) => {
                let product = Text::infix(a, "*", b);
                match sign {
                    Sign::Plus => Text::infix(c, "+", &product),
                    Sign::MinusAddend => Text::infix(&product, "-", c),
                    Sign::MinusProduct => Text::infix(c, "-", &product),
                }
            }
            (NumOp::Recip, [a]) => {
                Text { text: self.dialect.recip(&a.text), binding: if rust { Binding::Atom } else { Binding::Product } }
            }
            (NumOp::Rsqrt, [a]) => Text::atom(self.dialect.rsqrt(&a.text)),
            _ => unreachable!("{op:?} has other arguments than {}", args.len()),
        }
    }
}
