//! The expression graph: nodes that are simplified and shared as they are made, so that a kernel is never larger than
//! its recurrence asks. It knows arithmetic and nothing of harmonics, text or targets.

pub use crate::ir::op::Kind;
use crate::ir::op::Op;
use crate::math::exact::Exact;
use std::collections::HashMap;

/// The place of a node in its [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(u32);

/// A leaf, or one operation. Signs stand outside of products: a negation is never a factor, and of two summands at most
/// the second is one. Neither a difference nor a multiply-add is ever made here.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant, exact until it is printed.
    Const(Exact),
    /// A number so small that it changes nothing but a zero: 1e-15 in f32, 1e-30 in f64.
    Tiny,
    /// Component `index` of parameter `param`.
    Input {
        /// Which parameter.
        param: u32,
        /// Which of its components, in flat order.
        index: u32,
    },
    /// An operation on nodes; of the factors of a product a signal, if there is one, comes first, else a constant.
    Op(Op<Id>),
}

/// A set of nodes in which equal nodes are one node.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    kinds: Vec<Kind>,
    known: HashMap<Node, Id>,
    stages: Vec<Vec<Id>>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The node at `id`.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The kind of the node at `id`.
    pub fn kind(&self, id: Id) -> Kind {
        self.kinds[id.0 as usize]
    }

    /// The number of nodes made so far, those that no output needs among them.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the graph has no node.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Notes that what follows in a band, or in an invariant part of it, depends on the signal through these values
    /// alone. It changes no operation: [`crate::promise::bound`] may cut here, with a close bound if what follows is orthogonal.
    pub fn stage(&mut self, values: &[Id]) {
        self.stages.push(values.to_vec());
    }

    /// The noted stages, in order.
    pub fn stages(&self) -> &[Vec<Id>] {
        &self.stages
    }

    fn push(&mut self, node: Node, kind: Kind) -> Id {
        if let Some(&id) = self.known.get(&node) {
            return id;
        }
        let id = Id(u32::try_from(self.nodes.len()).expect("fewer than 2^32 nodes"));
        self.known.insert(node.clone(), id);
        self.nodes.push(node);
        self.kinds.push(kind);
        id
    }

    /// # Panics
    ///
    /// If the operation does not take operands of these kinds.
    fn apply(&mut self, op: Op<Id>) -> Id {
        let kind = op.map(|id| self.kind(id)).kind().unwrap_or_else(|fault| panic!("{fault}"));
        self.push(Node::Op(op), kind)
    }

    fn exact(&self, id: Id) -> Option<&Exact> {
        match self.node(id) {
            Node::Const(value) => Some(value),
            _ => None,
        }
    }

    /// A constant.
    pub fn constant(&mut self, value: Exact) -> Id {
        self.push(Node::Const(value), Kind::Scalar)
    }

    /// The constant that only keeps a zero from being one; see [`Node::Tiny`].
    pub fn tiny(&mut self) -> Id {
        self.push(Node::Tiny, Kind::Scalar)
    }

    /// A component of a parameter.
    pub fn input(&mut self, param: u32, index: u32, kind: Kind) -> Id {
        self.push(Node::Input { param, index }, kind)
    }

    /// −a.
    pub fn neg(&mut self, a: Id) -> Id {
        match self.node(a) {
            Node::Op(Op::Neg(inner)) => *inner,
            Node::Const(value) => {
                let value = -value.clone();
                self.constant(value)
            }
            _ => self.apply(Op::Neg(a)),
        }
    }

    /// A negative constant as a summand: its magnitude, subtracted.
    fn summand(&mut self, a: Id) -> Id {
        match self.exact(a) {
            Some(value) if value.signum() < 0 => {
                let magnitude = self.constant(value.abs());
                self.apply(Op::Neg(magnitude))
            }
            _ => a,
        }
    }

    /// a + b.
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        match (self.exact(a), self.exact(b)) {
            (Some(x), Some(y)) => {
                let sum = x + y;
                return self.constant(sum);
            }
            (Some(x), None) if x.is_zero() => return b,
            (None, Some(y)) if y.is_zero() => return a,
            _ => {}
        }
        let (a, b) = (self.summand(a), self.summand(b));
        match (self.node(a), self.node(b)) {
            (&Node::Op(Op::Neg(x)), &Node::Op(Op::Neg(y))) => {
                let sum = self.add(x, y);
                self.neg(sum)
            }
            (Node::Op(Op::Neg(_)), _) => self.apply(Op::Add(b, a)),
            (_, Node::Op(Op::Neg(_))) => self.apply(Op::Add(a, b)),
            _ => self.apply(Op::Add(a.min(b), a.max(b))),
        }
    }

    /// a − b.
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        let minus = self.neg(b);
        self.add(a, minus)
    }

    /// a · b.
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        if let Node::Op(Op::Neg(inner)) = *self.node(a) {
            let product = self.mul(inner, b);
            return self.neg(product);
        }
        if let Node::Op(Op::Neg(inner)) = *self.node(b) {
            let product = self.mul(a, inner);
            return self.neg(product);
        }
        match (self.exact(a).cloned(), self.exact(b).cloned()) {
            (Some(x), Some(y)) => self.constant(&x * &y),
            (Some(x), None) => self.scale(&x, b),
            (None, Some(y)) => self.scale(&y, a),
            (None, None) => {
                let (first, second) = match (self.kind(a), self.kind(b)) {
                    (Kind::Signal, _) => (a, b),
                    (_, Kind::Signal) => (b, a),
                    _ => (a.min(b), a.max(b)),
                };
                self.apply(Op::Mul(first, second))
            }
        }
    }

    /// factor · a.
    pub fn scale(&mut self, factor: &Exact, a: Id) -> Id {
        if factor.is_zero() {
            return self.constant(Exact::zero());
        }
        if factor.signum() < 0 {
            let product = self.scale(&factor.abs(), a);
            return self.neg(product);
        }
        if factor.is_one() {
            return a;
        }
        match self.node(a).clone() {
            Node::Const(value) => self.constant(factor * &value),
            Node::Op(Op::Neg(inner)) => {
                let product = self.scale(factor, inner);
                self.neg(product)
            }
            Node::Op(Op::Mul(x, y)) => {
                let (constant, other) = match (self.exact(x), self.exact(y)) {
                    (Some(value), None) => (value.clone(), y),
                    (None, Some(value)) => (value.clone(), x),
                    _ => return self.scaled(factor, a),
                };
                self.scale(&(factor * &constant), other)
            }
            _ => self.scaled(factor, a),
        }
    }

    fn scaled(&mut self, factor: &Exact, a: Id) -> Id {
        let constant = self.constant(factor.clone());
        match self.kind(a) {
            Kind::Signal => self.apply(Op::Mul(a, constant)),
            Kind::Scalar => self.apply(Op::Mul(constant, a)),
        }
    }

    /// a · b + c, three nodes at most; whether it is one operation is decided when the kernel is laid out.
    pub fn mul_add(&mut self, a: Id, b: Id, c: Id) -> Id {
        let product = self.mul(a, b);
        self.add(c, product)
    }

    /// factor · a + c.
    pub fn scale_add(&mut self, factor: &Exact, a: Id, c: Id) -> Id {
        let product = self.scale(factor, a);
        self.add(c, product)
    }

    /// factor · a + offset.
    pub fn affine(&mut self, factor: &Exact, a: Id, offset: &Exact) -> Id {
        let offset = self.constant(offset.clone());
        self.scale_add(factor, a, offset)
    }

    /// Σ factorᵢ · aᵢ, left to right; zero factors vanish.
    pub fn dot(&mut self, factors: &[Exact], values: &[Id]) -> Id {
        let mut sum = self.constant(Exact::zero());
        for (factor, &value) in factors.iter().zip(values) {
            sum = self.scale_add(factor, value, sum);
        }
        sum
    }

    /// 1 / a.
    pub fn recip(&mut self, a: Id) -> Id {
        if let Node::Op(Op::Neg(inner)) = *self.node(a) {
            let positive = self.recip(inner);
            return self.neg(positive);
        }
        self.apply(Op::Recip(a))
    }

    /// 1 / √a.
    pub fn rsqrt(&mut self, a: Id) -> Id {
        self.apply(Op::Rsqrt(a))
    }
}
