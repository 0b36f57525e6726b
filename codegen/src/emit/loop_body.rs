//! A loop kernel's tables and statements in one language. The text keeps the kernel's order of operations exactly; a
//! template lays its lines out.

use crate::emit::dialect::Dialect;
use crate::emit::language::expression::Text;
use crate::emit::language::record::{Language, Numbers};
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::program::{Int, IntOp, LoopKernel, Name, Num, Stmt, Table};
use std::collections::HashMap;

/// The columns that a table's lines are wrapped at.
const WIDTH: usize = 100;

/// A loop kernel's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopText {
    /// One declaration a table, of several lines each, for the file and not for the function.
    pub tables: Vec<String>,
    /// The statements, one a line, what stands in a loop indented by four spaces a level.
    pub lines: Vec<String>,
    /// The expression of the result, if it is not written to a parameter.
    pub result: String,
}

/// Returns the first table that is too long for a language, if there is one.
pub fn too_long<'a>(kernel: &'a LoopKernel, language: &Language) -> Option<&'a Table> {
    kernel.tables.iter().find(|table| table.values.len() > language.max_table)
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
        result: if dialect.is_written(kernel.result) { String::new() } else { kernel.output.to_owned() },
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
        let (shape, language) = (Shape::Array(len), self.dialect.language);
        let of = match &language.generic {
            Some(generic) => {
                let number = generic.table.number.to_owned();
                language.type_of(&Numbers { scalar: number.clone(), signal: number }, shape, Kind::Scalar)
            }
            None => self.dialect.type_of(shape, Kind::Scalar),
        };
        let (open, close) = (language.table)(&name, &of);
        let mut lines: Vec<String> = table.doc.lines().map(|line| format!("// {line}")).collect();
        lines.push(open);
        lines.push("   ".to_owned());
        for (i, value) in table.values.iter().enumerate() {
            let value = match &language.generic {
                Some(generic) => (generic.table.literal)(value),
                None => self.dialect.literal(value),
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
            Stmt::Int(name, value) => self.declare(self.dialect.language.statements.int, name, false, self.int(value)),
            Stmt::Counter(name, value) => {
                self.declare(self.dialect.language.statements.int, name, true, self.int(value));
            }
            Stmt::Advance(name) => self.line(&format!("{name} += 1;")),
            Stmt::Let(name, value) | Stmt::Var(name, value) => {
                let value = self.num(value);
                self.kinds.insert(name, value.kind);
                self.declare(&self.dialect.number(value.kind), name, matches!(stmt, Stmt::Var(..)), value);
            }
            Stmt::Set(name, value) => self.line(&format!("{name} = {};", self.num(value).text)),
            Stmt::Array(name, len, kind) => {
                self.kinds.insert(name, *kind);
                let shape = Shape::Array(*len);
                let of = match *name == self.kernel.output {
                    true if self.dialect.is_written(self.kernel.result) => return,
                    true => self.dialect.passed(shape, *kind),
                    false => self.dialect.type_of(shape, *kind),
                };
                self.line(&(self.dialect.language.statements.variable)(&of, name));
            }
            Stmt::Store(name, index, value) => {
                let (array, value) = (self.array(name), self.num(value));
                let is_padded = *name == self.kernel.output && !self.dialect.within(value.kind).is_empty();
                let value = if is_padded { self.dialect.padded(value.kind, &[value.text]) } else { value.text };
                self.line(&format!("{array}[{}] = {value};", self.int(index).text));
            }
            Stmt::Stage(..) => {}
            Stmt::For { name, from, to, step, body } => {
                let (from, to) = (self.int(from).text, self.int(to).text);
                self.line(&(self.dialect.language.statements.each)(name, &from, &to, *step));
                self.indent += 1;
                self.block(body);
                self.indent -= 1;
                self.line("}");
            }
        }
    }

    fn declare(&mut self, of: &str, name: Name, mutable: bool, value: Text) {
        let start = (self.dialect.language.statements.declare)(of, name, mutable);
        self.line(&format!("{start} = {};", value.text));
    }

    /// What is indexed of a parameter, of the result or of an array in between.
    fn array(&self, name: Name) -> String {
        let param = self.kernel.params.iter().find(|param| param.name == name).map(|param| param.shape);
        match param.or((name == self.kernel.output).then_some(self.kernel.result)) {
            Some(shape) => self.dialect.items(name, shape),
            None => name.to_owned(),
        }
    }

    fn int(&self, value: &Int) -> Text {
        match value {
            Int::Literal(value) => Text::atom(value.to_string(), Kind::Scalar),
            Int::Name(name) => Text::atom(*name, Kind::Scalar),
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
        let place = format!("[{}]", self.int(index).text);
        if self.kernel.tables.iter().any(|table| table.name == name) {
            let item = format!("{}_{name}{place}", self.prefix);
            return match &self.dialect.language.generic {
                Some(generic) => (generic.table.convert)(&item),
                None => item,
            };
        }
        let param = self.kernel.params.iter().find(|param| param.name == name);
        match (param, index) {
            (Some(param), &Int::Literal(index)) => self.dialect.component(name, param.shape, param.kind, index),
            _ => {
                let is_passed = param.is_some() || name == self.kernel.output;
                let within = if is_passed { self.dialect.within(self.kinds[name]) } else { "" };
                format!("{}{place}{within}", self.array(name))
            }
        }
    }

    fn num(&self, value: &Num) -> Text {
        match value {
            Num::Const(value) => Text::literal(self.dialect.literal(value)),
            Num::Tiny => Text::literal(self.dialect.tiny().to_owned()),
            Num::Name(name) => Text::atom(*name, self.kinds[name]),
            Num::Item(name, index) => Text::atom(self.item(name, index), self.kinds[name]),
            Num::Op(op) => self.dialect.operation(op.each().map(|arg| self.num(arg))),
        }
    }
}
