//! A kernel: named parameters, a graph, and the outputs that it computes. Families in `kernels/` build it through
//! [`Builder`]; the interpreter and the printers read it.

use crate::ir::domain::Domain;
use crate::ir::graph::{Graph, Id, Kind};

/// The shape of a parameter or a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One number.
    Scalar,
    /// Three numbers: x, y, z.
    Vec3,
    /// Four numbers: x, y, z, w.
    Vec4,
    /// Three columns of three numbers.
    Mat3,
    /// One (cosine, sine) pair.
    Pair,
    /// So many (cosine, sine) pairs.
    Pairs(usize),
    /// So many numbers.
    Array(usize),
    /// So many vectors of three numbers.
    Vectors(usize),
}

impl Shape {
    /// How many numbers it holds.
    pub fn len(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Pair => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            Self::Mat3 => 9,
            Self::Pairs(n) => 2 * n,
            Self::Array(n) => n,
            Self::Vectors(n) => 3 * n,
        }
    }

    /// Whether it holds no number.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// One parameter of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its name, the same in every language.
    pub name: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Whether it is the signal, which has one number a channel, or a number that all channels share.
    pub kind: Kind,
    /// What it may be.
    pub domain: Domain,
    /// What it holds, with its unit and range.
    pub doc: String,
}

impl Param {
    /// A parameter; it is the signal where its domain says so.
    pub fn new(name: &'static str, shape: Shape, domain: Domain, doc: impl Into<String>) -> Self {
        let kind = if domain.is_signal() { Kind::Signal } else { Kind::Scalar };
        Self { name, shape, kind, domain, doc: doc.into() }
    }
}

/// A straight-line kernel.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The parameters, in order.
    pub params: Vec<Param>,
    /// The graph that the outputs live in.
    pub graph: Graph,
    /// One node a number of the result.
    pub outputs: Vec<Id>,
    /// The shape of the result.
    pub result: Shape,
    /// Whether the result is linear in the signal.
    pub result_kind: Kind,
    /// What the result holds.
    pub result_doc: String,
}

/// Makes a [`Kernel`]: declare the parameters, compute on the graph, finish with the outputs.
#[derive(Debug, Default)]
pub struct Builder {
    /// The graph to compute on.
    pub graph: Graph,
    params: Vec<Param>,
}

impl Builder {
    /// A builder with no parameter.
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares a parameter and returns its components in flat order.
    pub fn param(&mut self, name: &'static str, shape: Shape, domain: Domain, doc: impl Into<String>) -> Vec<Id> {
        let (param, of) = (self.params.len() as u32, Param::new(name, shape, domain, doc));
        let kind = of.kind;
        self.params.push(of);
        (0..shape.len() as u32).map(|index| self.graph.input(param, index, kind)).collect()
    }

    /// The kernel with these outputs.
    pub fn finish(self, outputs: Vec<Id>, result: Shape, doc: impl Into<String>) -> Kernel {
        assert_eq!(outputs.len(), result.len(), "one output for each number of the result");
        let result_kind = outputs.iter().map(|&id| self.graph.kind(id)).max().unwrap_or(Kind::Scalar);
        Kernel { params: self.params, graph: self.graph, outputs, result, result_kind, result_doc: doc.into() }
    }
}
