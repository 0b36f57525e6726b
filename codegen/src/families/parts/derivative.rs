//! Derivatives of values of a graph along a direction in which some of its nodes move.

use crate::ir::graph::{Graph, Id, Node};
use crate::ir::op::Op;
use crate::math::exact::Exact;
use std::collections::HashMap;

/// Returns the derivatives of `values`, which are sums of products of constants and of nodes that each move as `moved` says
/// beside it; every other leaf stands still.
///
/// # Panics
///
/// If a value takes any other operation than a negation, a sum or a product.
pub fn derivatives(g: &mut Graph, values: &[Id], moved: &[[Id; 2]]) -> Vec<Id> {
    let mut known: HashMap<Id, Id> = moved.iter().map(|&[node, derivative]| (node, derivative)).collect();
    values.iter().map(|&value| derivative(g, value, &mut known)).collect()
}

fn derivative(g: &mut Graph, value: Id, known: &mut HashMap<Id, Id>) -> Id {
    if let Some(&found) = known.get(&value) {
        return found;
    }
    let found = match *g.node(value) {
        Node::Const(_) | Node::Tiny | Node::Input { .. } => g.constant(Exact::zero()),
        Node::Op(Op::Neg(a)) => {
            let a = derivative(g, a, known);
            g.neg(a)
        }
        Node::Op(Op::Add(a, b)) => {
            let (a, b) = (derivative(g, a, known), derivative(g, b, known));
            g.add(a, b)
        }
        Node::Op(Op::Mul(a, b)) => {
            let (a_moves, b_moves) = (derivative(g, a, known), derivative(g, b, known));
            let first = g.mul(a_moves, b);
            g.mul_add(b_moves, a, first)
        }
        Node::Op(op) => panic!("{op:?} has no derivative here"),
    };
    known.insert(value, found);
    found
}
