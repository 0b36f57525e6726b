//! A listing's lines in one language: what is used once is written where it is used, what is used twice is named. The
//! text keeps the listing's order of operations exactly.

use crate::emit::dialect::Dialect;
use crate::emit::language::expression::{Binding, Text};
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::listing::{Listing, Operand};
use crate::ir::op::Op;
use std::collections::{BTreeMap, BTreeSet};

/// What the result is called, or the function that it is handed to.
pub const RESULT: &str = "result";

/// An expression longer than this is given a name.
const WIDTH: usize = 88;

/// An expression and the named values that it mentions.
type Named = (Text, Vec<usize>);

/// What a line is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// It names a value.
    Name,
    /// It hands over a number of the result.
    Result(usize, Shape),
}

/// A named value, or a number of the result that is handed over.
#[derive(Clone, Debug)]
pub struct Line {
    purpose: Purpose,
    /// Its place among the lines; a value is called `t<number>`.
    pub number: usize,
    /// One number or one a channel.
    pub kind: Kind,
    /// What it is.
    pub text: String,
    /// The named values that it mentions.
    pub names: Vec<usize>,
}

impl Line {
    /// Returns the statement that names the value, or hands it over.
    pub fn statement(&self, dialect: Dialect) -> String {
        if let Purpose::Result(place, shape) = self.purpose {
            return dialect.hand_over(RESULT, shape, self.kind, place, &self.text);
        }
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
    /// One expression a number of the result, with the named values that it mentions; nothing where the lines hand it over.
    pub results: Vec<(String, Vec<usize>)>,
}

struct Printer<'a> {
    listing: &'a Listing,
    dialect: Dialect,
    texts: Vec<Named>,
    lines: Vec<Line>,
    /// The numbers that functions give, by parameter and index.
    asked: BTreeMap<(usize, usize), Asked>,
}

/// A number that a function gives.
#[derive(Clone, Copy, Debug, Default)]
struct Asked {
    /// How often it is used.
    uses: usize,
    /// How many of them are still to come.
    left: usize,
    /// The number of its name, if it has one.
    name: Option<usize>,
}

impl Printer<'_> {
    /// Adds a line; returns its number.
    fn line(&mut self, purpose: Purpose, kind: Kind, (text, names): (String, Vec<usize>)) -> usize {
        let number = self.lines.len();
        self.lines.push(Line { purpose, number, kind, text, names });
        number
    }

    /// Names what a function gives before it is used: what is used more than once is asked for once, and where results are
    /// handed over, nothing is asked for later than it stands here.
    fn ask(&mut self, operand: Operand) {
        let Operand::Input { param, index } = operand else { return };
        let Some(asked) = self.asked.get_mut(&(param, index)) else { return };
        asked.left = asked.left.saturating_sub(1);
        if asked.uses > 1 || self.dialect.is_handed_over(self.listing.result) {
            self.name(param, index);
        }
    }

    fn name(&mut self, param: usize, index: usize) {
        if self.asked[&(param, index)].name.is_none() {
            let (text, names) = self.operand(Operand::Input { param, index });
            let name = self.line(Purpose::Name, self.listing.params[param].kind, (text.text, names));
            self.asked.entry((param, index)).and_modify(|asked| asked.name = Some(name));
        }
    }

    /// Hands over the numbers of the result that are this operand.
    fn hand_over(&mut self, operand: Operand) {
        let listing = self.listing;
        if !self.dialect.is_handed_over(listing.result) {
            return;
        }
        for (place, _) in listing.outputs.iter().enumerate().filter(|(_, output)| **output == operand) {
            // What lies where the result may go is taken from there first.
            for param in 0..listing.params.len() {
                if self.asked.get(&(param, place)).is_some_and(|asked| asked.left > 0) {
                    self.name(param, place);
                }
            }
            let result = self.result(operand);
            self.line(Purpose::Result(place, listing.result), listing.result_kind, result);
        }
    }

    fn result(&self, operand: Operand) -> (String, Vec<usize>) {
        match operand {
            // A result that is linear in a signal is no constant but zero.
            Operand::Const(_) if !self.listing.result_kind.is_scalar() => {
                (self.dialect.zero(self.listing.result_kind), vec![])
            }
            _ => {
                let (text, names) = self.operand(operand);
                (text.text, names)
            }
        }
    }

    fn operand(&self, operand: Operand) -> Named {
        let text = match operand {
            Operand::Step(place) => return self.texts[place].clone(),
            Operand::Const(place) => Text::literal(self.dialect.literal(&self.listing.constants[place])),
            Operand::Tiny => Text::literal(self.dialect.tiny().to_owned()),
            Operand::Input { param, index } => {
                if let Some(Asked { name: Some(number), .. }) = self.asked.get(&(param, index)) {
                    return (Text::atom(format!("t{number}"), self.listing.params[param].kind), vec![*number]);
                }
                let param = &self.listing.params[param];
                Text::atom(self.dialect.component(param.name, param.shape, param.kind, index), param.kind)
            }
        };
        (text, vec![])
    }

    fn step(&mut self, place: usize) {
        let step = self.listing.steps[place];
        step.op.operands().for_each(|operand| self.ask(operand));
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
        let named = if inline {
            (text, names)
        } else {
            let number = self.line(Purpose::Name, step.kind, (text.text, names));
            (Text::atom(format!("t{number}"), step.kind), vec![number])
        };
        self.texts.push(named);
        self.hand_over(Operand::Step(place));
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
        let mut printer =
            Printer { listing, dialect, texts: Vec::new(), lines: Vec::new(), asked: asked(listing, dialect) };
        let is_step = |operand: &Operand| matches!(operand, Operand::Step(_));
        let given: BTreeSet<Operand> = listing.outputs.iter().copied().filter(|operand| !is_step(operand)).collect();
        for operand in given {
            printer.ask(operand);
            printer.hand_over(operand);
        }
        for place in 0..listing.steps.len() {
            printer.step(place);
        }
        let results = match dialect.is_handed_over(listing.result) {
            true => vec![],
            false => listing.outputs.iter().map(|&operand| printer.result(operand)).collect(),
        };
        Self { lines: printer.lines, results }
    }
}

/// The numbers of signals that functions give, and how often each is used. What is no signal lies where no result is put,
/// and is asked for each time.
fn asked(listing: &Listing, dialect: Dialect) -> BTreeMap<(usize, usize), Asked> {
    let mut asked: BTreeMap<_, Asked> = BTreeMap::new();
    for operand in listing.steps.iter().flat_map(|step| step.op.operands()).chain(listing.outputs.iter().copied()) {
        if let Operand::Input { param, index } = operand
            && dialect.is_asked_for(listing.params[param].shape, listing.params[param].kind)
            && !listing.params[param].kind.is_scalar()
        {
            let asked = asked.entry((param, index)).or_default();
            (asked.uses, asked.left) = (asked.uses + 1, asked.left + 1);
        }
    }
    asked
}
