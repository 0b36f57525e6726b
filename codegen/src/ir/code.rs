//! The operations of a kernel in either form, straight lines or a loop: what both can be asked and how both are run.

use crate::ir::eval::{Contraction, Number, Program};
use crate::ir::graph::Kind;
use crate::ir::kernel::{Param, Shape};
use crate::ir::listing::{Cost, Footprint, Listing};
use crate::ir::op::Price;
use crate::ir::program::{LoopKernel, Stmt};

/// The operations of a kernel.
#[derive(Clone, Debug)]
pub enum Code {
    /// Straight lines.
    Straight(Listing),
    /// Tables and a loop.
    Loop(LoopKernel),
    /// One of two listings.
    Branch(Box<Branch>),
}

/// Two listings of the same parameters and results, and what decides between them.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Two scalars.
    pub condition: Listing,
    /// What is done where the first of them is at most the second.
    pub below: Listing,
    /// What is done elsewhere.
    pub above: Listing,
}

impl Code {
    /// The parameters, in order.
    pub fn params(&self) -> &[Param] {
        match self {
            Self::Straight(listing) => &listing.params,
            Self::Loop(kernel) => &kernel.params,
            Self::Branch(branch) => &branch.above.params,
        }
    }

    /// The shape and the kind of the result.
    pub fn result(&self) -> (Shape, Kind) {
        match self {
            Self::Straight(listing) => (listing.result, listing.result_kind),
            Self::Loop(kernel) => (kernel.result, kernel.result_kind),
            Self::Branch(branch) => (branch.above.result, branch.above.result_kind),
        }
    }

    /// What the result holds.
    pub fn result_doc(&self) -> &str {
        match self {
            Self::Straight(listing) => &listing.result_doc,
            Self::Loop(kernel) => &kernel.result_doc,
            Self::Branch(branch) => &branch.above.result_doc,
        }
    }

    /// What it costs for so many channels, at most.
    pub fn cost(&self, channels: usize) -> Cost {
        match self {
            Self::Straight(listing) => listing.cost(channels),
            Self::Loop(kernel) => Listing::from(kernel).cost(channels),
            Self::Branch(branch) => branch.costs(channels)[1],
        }
    }

    /// How many numbers it is given besides the signal, each of which a caller has to bring, from memory as a rule.
    pub fn reads(&self) -> usize {
        self.params().iter().filter(|param| param.kind.is_scalar()).map(|param| param.shape.len()).sum()
    }

    /// The names of the operations of a price that it does, each once, in the order in which they are first done.
    pub fn names(&self, price: Price) -> Vec<&'static str> {
        let of = |listing: &Listing| -> Vec<&'static str> {
            listing.steps.iter().filter(|step| step.op.price() == price).map(|step| step.op.name()).collect()
        };
        let all = match self {
            Self::Straight(listing) => of(listing),
            Self::Loop(kernel) => of(&Listing::from(kernel)),
            Self::Branch(branch) => [&branch.condition, &branch.below, &branch.above].map(of).concat(),
        };
        let mut names = Vec::new();
        all.into_iter().for_each(|name| {
            if !names.contains(&name) {
                names.push(name)
            }
        });
        names
    }

    /// What it needs besides operations; a loop's constants are its tables', its live values those of its arrays.
    pub fn footprint(&self) -> Footprint {
        match self {
            Self::Straight(listing) => listing.footprint(),
            Self::Loop(kernel) => {
                let constants = kernel.tables.iter().map(|table| table.values.len()).sum();
                let live = array_items(&kernel.body);
                Footprint { constants, live, passing: live }
            }
            Self::Branch(branch) => branch.footprint(),
        }
    }

    /// The most numbers that it holds at once for a signal of so many channels: all that it is given, and what is alive of
    /// what it computes.
    pub fn held(&self, channels: usize) -> usize {
        let given: usize = self.params().iter().map(|param| param.shape.len() * param.kind.numbers(channels)).sum();
        let alive = match self {
            Self::Straight(listing) => listing.alive(channels),
            Self::Loop(_) => self.footprint().live * channels,
            Self::Branch(branch) => branch.below.alive(channels).max(branch.above.alive(channels)),
        };
        given + alive
    }

    /// The operations with constants rounded to `T`, ready to run.
    pub fn runner<T: Number>(&self) -> Runner<T> {
        match self {
            Self::Straight(listing) => Runner::Straight(Box::new(Program::new(listing))),
            Self::Loop(kernel) => Runner::Straight(Box::new(Program::new(&Listing::from(kernel)))),
            Self::Branch(branch) => {
                Runner::Branch(Box::new([&branch.condition, &branch.below, &branch.above].map(Program::new)))
            }
        }
    }
}

impl Branch {
    /// What both ways cost for so many channels, the condition included: the cheaper one first.
    pub fn costs(&self, channels: usize) -> [Cost; 2] {
        let condition = self.condition.cost(channels);
        let mut both = [&self.below, &self.above].map(|listing| listing.cost(channels) + condition);
        both.sort_by_key(|cost| cost.total);
        both
    }

    /// What both ways and the condition cost together for so many channels.
    pub fn both(&self, channels: usize) -> Cost {
        [&self.condition, &self.below, &self.above]
            .into_iter()
            .map(|listing| listing.cost(channels))
            .fold(Cost::default(), std::ops::Add::add)
    }

    fn footprint(&self) -> Footprint {
        let [below, above] = [&self.below, &self.above].map(Listing::footprint);
        let mut constants: Vec<_> = [&self.below, &self.above].iter().flat_map(|listing| &listing.constants).collect();
        constants.sort();
        constants.dedup();
        Footprint {
            constants: constants.len(),
            live: below.live.max(above.live),
            passing: below.passing.max(above.passing),
        }
    }
}

fn array_items(body: &[Stmt]) -> usize {
    body.iter()
        .map(|statement| match statement {
            Stmt::Array(_, length, _) => *length,
            Stmt::For { body, .. } => array_items(body),
            _ => 0,
        })
        .sum()
}

/// A kernel that can be run again and again in `T`.
#[derive(Clone, Debug)]
pub enum Runner<T> {
    /// Straight lines, or what a loop does.
    Straight(Box<Program<T>>),
    /// One of two: the condition's two scalars, what is done where the first is at most the second, and elsewhere.
    Branch(Box<[Program<T>; 3]>),
}

impl<T: Number> Runner<T> {
    /// Runs it for one channel. `inputs` holds one slice a parameter, of as many numbers as its shape says.
    ///
    /// # Panics
    ///
    /// If a slice is shorter than its parameter's shape.
    pub fn run(&self, inputs: &[&[T]], contraction: Contraction) -> Vec<T> {
        match self {
            Self::Straight(program) => program.run(inputs, contraction),
            Self::Branch(programs) => {
                let [condition, below, above] = &**programs;
                let sides = condition.run(inputs, contraction);
                let program = if sides[0] <= sides[1] { below } else { above };
                program.run(inputs, contraction)
            }
        }
    }
}
