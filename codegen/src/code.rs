//! The operations of a kernel in either form, straight lines or a loop: what both can be asked and how both are run.

use crate::eval::{Contraction, Number, Program};
use crate::graph::Kind;
use crate::kernel::{Param, Shape};
use crate::listing::{Cost, Footprint, Listing};
use crate::program::{LoopKernel, LoopProgram, Stmt};

/// The operations of a kernel.
#[derive(Clone, Debug)]
pub enum Code {
    /// Straight lines.
    Straight(Listing),
    /// Tables and a loop.
    Loop(LoopKernel),
}

impl Code {
    /// The parameters, in order.
    pub fn params(&self) -> &[Param] {
        match self {
            Self::Straight(listing) => &listing.params,
            Self::Loop(kernel) => &kernel.params,
        }
    }

    /// The shape and the kind of the result.
    pub fn result(&self) -> (Shape, Kind) {
        match self {
            Self::Straight(listing) => (listing.result, listing.result_kind),
            Self::Loop(kernel) => (kernel.result, kernel.result_kind),
        }
    }

    /// What the result holds.
    pub fn result_doc(&self) -> &str {
        match self {
            Self::Straight(listing) => &listing.result_doc,
            Self::Loop(kernel) => &kernel.result_doc,
        }
    }

    /// What it costs for so many channels.
    pub fn cost(&self, channels: usize) -> Cost {
        match self {
            Self::Straight(listing) => listing.cost(channels),
            Self::Loop(kernel) => kernel.cost(channels),
        }
    }

    /// What it needs besides operations; a loop's constants are its tables', its live values those of its arrays.
    pub fn footprint(&self) -> Footprint {
        match self {
            Self::Straight(listing) => listing.footprint(),
            Self::Loop(kernel) => Footprint {
                constants: kernel.tables.iter().map(|table| table.values.len()).sum(),
                live: array_items(&kernel.body),
            },
        }
    }

    /// The operations with constants rounded to `T`, ready to run.
    pub fn runner<T: Number>(&self) -> Runner<T> {
        match self {
            Self::Straight(listing) => Runner::Straight(Program::new(listing)),
            Self::Loop(kernel) => Runner::Loop(LoopProgram::new(kernel)),
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
    /// Straight lines.
    Straight(Program<T>),
    /// Tables and a loop.
    Loop(LoopProgram<T>),
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
            Self::Loop(program) => program.run(inputs, contraction),
        }
    }
}
