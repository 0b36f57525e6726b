//! A kernel that leaves bands apart, in pieces: a set-up of the numbers that several bands are made with, and a kernel a
//! band, which makes what it alone takes. Where nothing is made for several bands and arrays are given, of which a band
//! takes a few numbers, there is no set-up, and bands take the parameters themselves. Their operations together are the
//! kernel's, and so are their results, bit for bit; but what lives at once is one band, so that registers suffice where
//! those of the whole spill (docs/GPU.md says by how much).

use crate::ir::graph::{Done, Id, Kind, Node};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::ir::listing::{Listing, fused_products};
use crate::ir::op::Op;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// What the set-up's result is called where a band takes it.
pub const SET_UP: &str = "s";

/// A kernel whose results in a band depend on the signal in that band alone.
#[derive(Debug)]
pub struct Pieces {
    kernel: Kernel,
    order: usize,
    /// What several bands take that depends on no signal, and parameters, in the order in which the whole meets it, so that
    /// the set-up is laid out, and its products are fused, as they are there; nothing if it would copy arrays alone.
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
        let takes_another = |l: usize| {
            let inputs = graph.linear(&kernel.outputs[band(l)]).into_iter();
            inputs
                .filter_map(|id| match graph.node(id) {
                    Node::Input { index, .. } => Some(*index as usize),
                    _ => None,
                })
                .any(|index| !band(l).contains(&index))
        };
        if (0..order).any(takes_another) {
            return None;
        }
        let shared = shared(&kernel, order);
        Some(Self { kernel, order, shared })
    }

    /// Returns the bands that are not merely copied.
    pub fn changed(&self) -> Vec<usize> {
        let is_changed =
            |&l: &usize| band(l).any(|i| !matches!(self.kernel.graph.node(self.kernel.outputs[i]), Node::Input { .. }));
        (0..self.order).filter(is_changed).collect()
    }

    /// Returns the kernel that makes what bands take; none if they take what is given alone.
    pub fn set_up(&self) -> Option<Kernel> {
        let mut params = self.kernel.params.clone();
        params.pop();
        let kernel = || Kernel {
            params,
            graph: self.kernel.graph.clone(),
            outputs: self.shared.clone(),
            result: Shape::Array(self.shared.len()),
            result_kind: Kind::Scalar,
            result_doc: format!("the {} numbers that each band takes", self.shared.len()),
        };
        (!self.shared.is_empty()).then(|| roomy(kernel(), Done::AsMade))
    }

    /// Returns the kernel of a band: what the set-up returned, or those parameters that it takes if there is none, and 2l + 1
    /// coefficients to as many.
    ///
    /// # Panics
    ///
    /// If there is no such band.
    pub fn band(&self, l: usize) -> Kernel {
        assert!(l < self.order, "band {l} of order {}", self.order);
        let outputs = &self.kernel.outputs[band(l)];
        let (signal, others) = self.kernel.params.split_last().expect("a signal is last");
        let mut builder = Builder::new();
        let mut given: HashMap<Id, Id> = HashMap::new();
        if self.shared.is_empty() {
            let inputs = self.inputs(outputs);
            let taken =
                others.iter().enumerate().filter(|(place, _)| inputs.iter().any(|(_, param, _)| param == place));
            for (place, param) in taken {
                let numbers = builder.param(param.name, param.shape, param.domain, param.doc.clone());
                given.extend(inputs.iter().filter(|input| input.1 == place).map(|&(id, _, at)| (id, numbers[at])));
            }
        } else {
            let shape = Shape::Array(self.shared.len());
            let made = builder.param(SET_UP, shape, Domain::SetUp, "what the set-up returns");
            given.extend(self.shared.iter().copied().zip(made));
        }
        let doc = format!("the coefficients of band {l}, m from −{l} to {l}");
        let c = builder.param(signal.name, Shape::Array(2 * l + 1), signal.domain, doc);
        let leaf = |id: Id, node: &Node| match node {
            Node::Input { index, .. } if self.kernel.graph.kind(id) == Kind::Signal => {
                Some(c[*index as usize - band(l).start])
            }
            _ => given.get(&id).copied(),
        };
        let outputs = builder.graph.take(&self.kernel.graph, outputs, leaf);
        // The orders m and −m of a band have factors in common.
        let pairs = (1..=l).flat_map(|m| [l - m, l + m]).map(|place| outputs[place]);
        let pairs = std::iter::once(outputs[l]).chain(pairs).collect();
        let doc = format!("band {l} of the result, m from −{l} to {l}");
        roomy(builder.finish(outputs, Shape::Array(2 * l + 1), doc), Done::By(pairs))
    }

    /// The numbers of parameters that these outputs need, each with its parameter and its place there.
    fn inputs(&self, outputs: &[Id]) -> Vec<(Id, usize, usize)> {
        let of = |id: Id| match self.kernel.graph.node(id) {
            Node::Input { param, index } => Some((id, *param as usize, *index as usize)),
            _ => None,
        };
        self.kernel.graph.met(outputs).into_iter().filter_map(of).collect()
    }
}

/// The numbers that live at once beyond which operations are done in the order in which fewer do.
const MANY: usize = 64;

/// The kernel with its operations done in this order, if many numbers live at once and fewer do so; else as it is.
fn roomy(kernel: Kernel, done: Done) -> Kernel {
    let passing = |kernel: &Kernel| Listing::new(kernel).footprint().passing;
    let alive = passing(&kernel);
    if alive <= MANY {
        return kernel;
    }
    let mut other = kernel.clone();
    other.graph.do_in(done);
    if passing(&other) < alive { other } else { kernel }
}

/// What the set-up makes: numbers that several bands need, as far as a band uses them, and parameters that any does. A
/// product that vanishes in the sums that use it vanishes in each band too, so that its factors are what is shared.
fn shared(kernel: &Kernel, order: usize) -> Vec<Id> {
    let graph = &kernel.graph;
    let vanishing = fused_products(kernel);
    let mut bands: HashMap<Id, usize> = HashMap::new();
    for l in 0..order {
        graph.met(&kernel.outputs[band(l)]).into_iter().for_each(|id| *bands.entry(id).or_default() += 1);
    }
    let is_made_in_bands = |id: Id| matches!(graph.node(id), Node::Op(Op::Neg(_))) || vanishing.contains(&id);
    let is_shared = |id: Id| match graph.node(id) {
        Node::Const(_) | Node::Tiny => false,
        _ if !graph.kind(id).is_scalar() => false,
        Node::Input { .. } => true,
        Node::Op(_) => bands[&id] > 1 && !is_made_in_bands(id),
    };
    let (mut shared, mut seen) = (HashSet::new(), HashSet::new());
    let mut stack = kernel.outputs.clone();
    while let Some(id) = stack.pop() {
        if !seen.insert(id) {
            continue;
        }
        if is_shared(id) {
            shared.insert(id);
        } else if let Node::Op(op) = graph.node(id) {
            stack.extend(op.operands());
        }
    }
    let is_made = |id: &Id| matches!(graph.node(*id), Node::Op(_));
    let takes_arrays = kernel.params.iter().any(|param| param.kind.is_scalar() && param.shape.is_array());
    if takes_arrays && !shared.iter().any(is_made) {
        return vec![];
    }
    graph.met(&kernel.outputs).into_iter().filter(|id| shared.contains(id)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three bands, of which two are turned by a square, and the last by its square too.
    fn kernel(mixes: bool) -> Kernel {
        let mut builder = Builder::new();
        let x = builder.param("x", Shape::Scalar, Domain::Between(0.0, 1.0), "a number")[0];
        let c = builder.param("c", Shape::Array(9), Domain::Signal, "the coefficients");
        let g = &mut builder.graph;
        let square = g.mul(x, x);
        let fourth = g.mul(square, square);
        let last = g.mul(c[3], square);
        let sum = g.add(if mixes { c[0] } else { c[1] }, last);
        let (higher, highest) = (g.mul(c[4], square), g.mul(c[8], fourth));
        let out = vec![c[0], sum, c[2], last, higher, c[5], c[6], c[7], highest];
        builder.finish(out, Shape::Array(9), "the result")
    }

    #[test]
    fn what_several_bands_take_is_set_up() {
        let pieces = Pieces::new(kernel(false), 3).expect("it leaves bands apart");
        assert_eq!(pieces.changed(), [1, 2]);
        let set_up = pieces.set_up().expect("the square");
        assert_eq!((set_up.params.len(), set_up.result), (1, Shape::Array(1)));
        let band = pieces.band(1);
        assert_eq!((band.params.len(), band.params[1].shape, band.result), (2, Shape::Array(3), Shape::Array(3)));
        let products = |kernel: Kernel| Listing::new(&kernel).cost(1).mul;
        assert_eq!(
            [products(set_up), products(band), products(pieces.band(2))],
            [1, 1, 3],
            "its square is band 2's own"
        );
        assert!(Pieces::new(kernel(true), 3).is_none(), "band 1 takes from band 0");
    }
}
