//! A kernel that leaves bands apart, in pieces: a set-up of the numbers that all bands are made with, and a kernel a band.
//! Their operations together are the kernel's, and so are their results, bit for bit; but what lives at once is one band,
//! so that registers suffice where those of the whole spill (docs/measure says by how much).

use crate::ir::graph::{Graph, Id, Kind, Node};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// What the set-up's result is called where a band takes it.
const SET_UP: &str = "s";

/// A kernel whose results in a band depend on the signal in that band alone.
#[derive(Debug)]
pub struct Pieces {
    kernel: Kernel,
    order: usize,
    /// What bands take that depends on no signal, in the order in which the whole meets it, so that the set-up is laid out, and
    /// its products are fused, as they are there.
    shared: Vec<Id>,
}

fn band(l: usize) -> Range<usize> {
    l * l..(l + 1) * (l + 1)
}

impl Pieces {
    /// Returns the pieces of a kernel of `order` bands; none if a band depends on another one's coefficients, if it takes or
    /// gives something else than the coefficients of all bands, or if another parameter follows the signal.
    pub fn new(kernel: Kernel, order: usize) -> Option<Self> {
        let coefficients = Shape::Array(order * order);
        let (signal, others) = kernel.params.split_last()?;
        let is_signal = signal.kind == Kind::Signal && signal.shape == coefficients;
        let is_alone = others.iter().all(|param| param.kind == Kind::Scalar);
        if !is_signal || !is_alone || kernel.result != coefficients || kernel.result_kind != Kind::Signal {
            return None;
        }
        let graph = &kernel.graph;
        let mut shared = BTreeSet::new();
        for l in 0..order {
            for id in graph.linear(&kernel.outputs[band(l)]) {
                match graph.node(id) {
                    Node::Input { index, .. } if !band(l).contains(&(*index as usize)) => return None,
                    Node::Op(op) => shared.extend(op.operands().filter(|&id| is_shared(graph, id))),
                    _ => {}
                }
            }
        }
        let shared = graph.met(&kernel.outputs).into_iter().filter(|id| shared.contains(id)).collect();
        Some(Self { kernel, order, shared })
    }

    /// Returns the bands that are not merely copied.
    pub fn changed(&self) -> Vec<usize> {
        let is_changed =
            |&l: &usize| band(l).any(|i| !matches!(self.kernel.graph.node(self.kernel.outputs[i]), Node::Input { .. }));
        (0..self.order).filter(is_changed).collect()
    }

    /// Returns the kernel that makes what every band takes; none if the bands take the coefficients alone.
    pub fn set_up(&self) -> Option<Kernel> {
        let mut params = self.kernel.params.clone();
        params.pop();
        (!self.shared.is_empty()).then(|| Kernel {
            params,
            graph: self.kernel.graph.clone(),
            outputs: self.shared.clone(),
            result: Shape::Array(self.shared.len()),
            result_kind: Kind::Scalar,
            result_doc: format!("the {} numbers that each band takes", self.shared.len()),
        })
    }

    /// Returns the kernel of a band: what the set-up returned and 2l + 1 coefficients to as many.
    ///
    /// # Panics
    ///
    /// If there is no such band.
    pub fn band(&self, l: usize) -> Kernel {
        assert!(l < self.order, "band {l} of order {}", self.order);
        let mut builder = Builder::new();
        let mut given = Vec::new();
        if !self.shared.is_empty() {
            let shape = Shape::Array(self.shared.len());
            given = builder.param(SET_UP, shape, Domain::SetUp, "what the set-up returns");
        }
        let signal = self.kernel.params.last().expect("a signal is last");
        let doc = format!("the coefficients of band {l}, m from −{l} to {l}");
        let c = builder.param(signal.name, Shape::Array(2 * l + 1), signal.domain, doc);
        let place: HashMap<Id, usize> = self.shared.iter().enumerate().map(|(place, &id)| (id, place)).collect();
        let leaf = |id: Id, node: &Node| match node {
            Node::Input { index, .. } if self.kernel.graph.kind(id) == Kind::Signal => {
                Some(c[*index as usize - band(l).start])
            }
            _ => place.get(&id).map(|&place| given[place]),
        };
        let outputs = builder.graph.take(&self.kernel.graph, &self.kernel.outputs[band(l)], leaf);
        builder.finish(outputs, Shape::Array(2 * l + 1), format!("band {l} of the result, m from −{l} to {l}"))
    }
}

/// Whether it is a number that a band cannot write itself.
fn is_shared(graph: &Graph, id: Id) -> bool {
    graph.kind(id).is_scalar() && !matches!(graph.node(id), Node::Const(_) | Node::Tiny)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two bands, of which the second is turned by a square that both halves share.
    fn kernel(mixes: bool) -> Kernel {
        let mut builder = Builder::new();
        let x = builder.param("x", Shape::Scalar, Domain::Between(0.0, 1.0), "a number")[0];
        let c = builder.param("c", Shape::Array(4), Domain::Signal, "the coefficients");
        let g = &mut builder.graph;
        let square = g.mul(x, x);
        let last = g.mul(c[3], square);
        let sum = g.add(if mixes { c[0] } else { c[1] }, last);
        builder.finish(vec![c[0], sum, c[2], last], Shape::Array(4), "the result")
    }

    #[test]
    fn what_no_signal_reaches_is_set_up() {
        let pieces = Pieces::new(kernel(false), 2).expect("it leaves bands apart");
        assert_eq!(pieces.changed(), [1]);
        let set_up = pieces.set_up().expect("the square");
        assert_eq!((set_up.params.len(), set_up.result), (1, Shape::Array(1)));
        let band = pieces.band(1);
        assert_eq!((band.params.len(), band.params[1].shape, band.result), (2, Shape::Array(3), Shape::Array(3)));
        assert!(Pieces::new(kernel(true), 2).is_none(), "band 1 takes from band 0");
    }
}
