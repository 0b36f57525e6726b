//! A listing's lines in one language: what is used once is written where it is used, what is used twice is named. The
//! text keeps the listing's order of operations exactly.

use crate::emit::dialect::Dialect;
use crate::emit::language::expression::{Binding, Text};
use crate::ir::graph::Kind;
use crate::ir::listing::{Listing, Operand};
use crate::ir::op::Op;

/// An expression longer than this is given a name.
const WIDTH: usize = 88;

/// An expression and the named values that it mentions.
type Named = (Text, Vec<usize>);

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

impl Line {
    /// Returns the statement that names the value.
    pub fn statement(&self, dialect: Dialect) -> String {
        let declare = dialect.language.statements.declare;
        let start = declare(&dialect.number(self.kind), &format!("t{}", self.number), false);
        format!("{start} = {};", self.text)
    }
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
    texts: Vec<Named>,
    lines: Vec<Line>,
}

impl Printer<'_> {
    fn operand(&self, operand: Operand) -> Named {
        let text = match operand {
            Operand::Step(place) => return self.texts[place].clone(),
            Operand::Const(place) => Text::literal(self.dialect.literal(&self.listing.constants[place])),
            Operand::Tiny => Text::literal(self.dialect.tiny().to_owned()),
            Operand::Input { param, index } => {
                let param = &self.listing.params[param];
                Text::atom(self.dialect.component(param.name, param.shape, param.kind, index), param.kind)
            }
        };
        (text, vec![])
    }

    fn step(&mut self, place: usize) {
        let step = self.listing.steps[place];
        let mut names: Vec<usize> = Vec::new();
        let operands = step.op.map(|operand| {
            let (text, mentioned) = self.operand(operand);
            for name in mentioned {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
            text
        });
        let text = self.dialect.operation(readable(operands));
        let inline = step.uses == 1 && text.text.len() <= WIDTH;
        self.texts.push(if inline {
            (text, names)
        } else {
            let number = self.lines.len();
            self.lines.push(Line { number, kind: step.kind, text: text.text, names });
            (Text::atom(format!("t{number}"), step.kind), vec![number])
        });
    }
}

/// Exchanges operands that commute to the last bit where that reads better: a number is the first factor, and a sum on
/// the right would need parentheses.
fn readable(op: Op<Text>) -> Op<Text> {
    match op {
        Op::Mul(a, b) if b.begins_with_a_number() => Op::Mul(b, a),
        Op::Fma(a, b, c, sign) if b.begins_with_a_number() => Op::Fma(b, a, c, sign),
        Op::Add(a, b) if b.binding == Binding::Sum && a.binding != Binding::Sum => Op::Add(b, a),
        op => op,
    }
}

impl Body {
    /// Returns the lines of a listing in a dialect.
    pub fn new(listing: &Listing, dialect: Dialect) -> Self {
        let mut printer = Printer { listing, dialect, texts: Vec::new(), lines: Vec::new() };
        for place in 0..listing.steps.len() {
            printer.step(place);
        }
        let result = |&operand: &Operand| match operand {
            // A result that is linear in a signal is no constant but zero.
            Operand::Const(_) if !listing.result_kind.is_scalar() => (dialect.zero(listing.result_kind), vec![]),
            _ => {
                let (text, names) = printer.operand(operand);
                (text.text, names)
            }
        };
        let results = listing.outputs.iter().map(result).collect();
        Self { lines: printer.lines, results }
    }
}
