//! A listing's lines in one language: what is used once is written where it is used, what is used twice is named. The
//! text keeps the listing's order of operations exactly.

use crate::emit::dialect::Dialect;
use crate::emit::dialect::Target;
use crate::ir::graph::Kind;
use crate::ir::listing::{Listing, Op, Operand, Sign};

/// An expression longer than this is given a name.
const WIDTH: usize = 88;
/// A Rust function holds at most so many lines: rustc's stack does not take thousands of nested bindings.
pub const CHUNK: usize = 400;

/// How tightly an expression binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

#[derive(Clone, Debug)]
struct Text {
    text: String,
    binding: Binding,
    /// The named values that it mentions.
    names: Vec<usize>,
}

impl Text {
    fn at_least(&self, binding: Binding) -> String {
        match self.binding >= binding {
            true => self.text.clone(),
            false => format!("({})", self.text),
        }
    }
}

/// A named value.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its number: `t<number>`.
    pub number: usize,
    /// One number or one a channel.
    pub kind: Kind,
    /// What it is.
    pub text: String,
    /// The named values that it mentions.
    pub names: Vec<usize>,
}

/// The lines of a function and its results.
#[derive(Clone, Debug)]
pub struct Body {
    /// The named values, in order.
    pub lines: Vec<Line>,
    /// One expression a number of the result, with the named values that it mentions.
    pub results: Vec<(String, Vec<usize>)>,
}

struct Printer<'a> {
    listing: &'a Listing,
    dialect: Dialect,
    texts: Vec<Option<Text>>,
    lines: Vec<Line>,
}

impl Printer<'_> {
    fn operand(&self, operand: Operand) -> Text {
        let atom = |text: String| Text { text, binding: Binding::Atom, names: vec![] };
        match operand {
            Operand::Step(place) => self.texts[place].clone().expect("steps come before their uses"),
            Operand::Const(place) => {
                let value = &self.listing.constants[place];
                let text = self.dialect.literal(value);
                match value.signum() < 0 && self.dialect.target != Target::Rust {
                    true => Text { text, binding: Binding::Product, names: vec![] },
                    false => atom(text),
                }
            }
            Operand::Tiny => atom(self.dialect.tiny().to_owned()),
            Operand::Input { param, index } => {
                let param = &self.listing.params[param];
                atom(self.dialect.component(param.name, param.shape, index))
            }
        }
    }

    fn infix(&self, op: Op) -> (String, Binding) {
        let get = |operand: Operand| self.operand(operand);
        let product = |a: Operand, b: Operand| {
            let (a, b) = (get(a), get(b));
            let literal = matches!(b.text.chars().next(), Some('0'..='9'));
            let (a, b) = if literal { (b, a) } else { (a, b) };
            format!("{} * {}", a.at_least(Binding::Product), b.at_least(Binding::Atom))
        };
        match op {
            Op::Neg(a) => (format!("-{}", get(a).at_least(Binding::Atom)), Binding::Product),
            Op::Add(a, b) => {
                // A sum on the right would need parentheses; addition commutes to the last bit.
                let (a, b) = (get(a), get(b));
                let (a, b) = if b.binding == Binding::Sum && a.binding != Binding::Sum { (b, a) } else { (a, b) };
                (format!("{} + {}", a.text, b.at_least(Binding::Product)), Binding::Sum)
            }
            Op::Sub(a, b) => (format!("{} - {}", get(a).text, get(b).at_least(Binding::Product)), Binding::Sum),
            Op::Mul(a, b) => (product(a, b), Binding::Product),
            Op::Fma(a, b, c, sign) => {
                let (ab, c) = (product(a, b), get(c));
                let text = match sign {
                    Sign::Plus => format!("{} + {ab}", c.text),
                    Sign::MinusProduct => format!("{} - {ab}", c.text),
                    Sign::MinusAddend => format!("{ab} - {}", c.at_least(Binding::Product)),
                };
                (text, Binding::Sum)
            }
            Op::Recip(a) => (self.dialect.recip(&get(a).text), Binding::Product),
            Op::Rsqrt(a) => (self.dialect.rsqrt(&get(a).text), Binding::Atom),
        }
    }

    /// Rust says where a product and a sum are one operation; a signal comes first.
    fn rust(&self, op: Op) -> (String, Binding) {
        let get = |operand: Operand| self.operand(operand);
        match op {
            Op::Fma(a, b, c, sign) => {
                let method = match sign {
                    Sign::Plus => "fma",
                    Sign::MinusAddend => "fms",
                    Sign::MinusProduct => "fnma",
                };
                let (a, b, c) = (get(a).at_least(Binding::Atom), get(b).text, get(c).text);
                (format!("{a}.{method}({b}, {c})"), Binding::Atom)
            }
            Op::Mul(a, b) => {
                let (a, b) = (get(a), get(b));
                (format!("{} * {}", a.at_least(Binding::Product), b.at_least(Binding::Atom)), Binding::Product)
            }
            Op::Recip(_) => (self.infix(op).0, Binding::Atom),
            _ => self.infix(op),
        }
    }

    fn step(&mut self, place: usize) {
        let step = self.listing.steps[place];
        let (text, binding) = match self.dialect.target {
            Target::Rust => self.rust(step.op),
            _ => self.infix(step.op),
        };
        let mut names: Vec<usize> = Vec::new();
        for operand in step.op.operands() {
            for name in self.operand(operand).names {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        let inline = step.uses == 1 && text.len() <= WIDTH;
        self.texts[place] = Some(if inline {
            Text { text, binding, names }
        } else {
            let number = self.lines.len();
            self.lines.push(Line { number, kind: step.kind, text, names });
            Text { text: format!("t{number}"), binding: Binding::Atom, names: vec![number] }
        });
    }
}

impl Body {
    /// The lines of a listing in a dialect.
    pub fn new(listing: &Listing, dialect: Dialect) -> Self {
        let mut printer = Printer { listing, dialect, texts: vec![None; listing.steps.len()], lines: Vec::new() };
        for place in 0..listing.steps.len() {
            printer.step(place);
        }
        let results = listing
            .outputs
            .iter()
            .map(|&operand| {
                let text = printer.operand(operand);
                (text.text, text.names)
            })
            .collect();
        Self { lines: printer.lines, results }
    }
}
