//! The expression graph: nodes that are simplified and shared as they are made, so that a kernel is never larger than
//! its recurrence asks. It knows arithmetic and nothing of harmonics, text or targets.

pub use crate::ir::op::Kind;
use crate::ir::op::Op;
use crate::math::exact::Exact;
use std::cmp::Ordering;
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
    /// An operation on nodes; of the factors of a product that of the higher degree comes first, of two scalars a constant.
    Op(Op<Id>),
}

/// A set of nodes in which equal nodes are one node.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    kinds: Vec<Kind>,
    known: HashMap<Node, Id>,
    stages: Vec<Vec<Id>>,
    directions: Vec<[Id; 3]>,
    as_made: bool,
    first: Vec<Id>,
    done: Option<Done>,
}

/// The order in which a kernel's operations are done, where it is not that of its layout. Which products are fused does not
/// depend on it, so that it changes no bit of the results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Done {
    /// As they were made.
    AsMade,
    /// Result by result in this order, each with all that it needs.
    By(Vec<Id>),
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

    /// Notes that these three scalars are a direction that the kernel's rotation turns a given one to. It changes no
    /// operation: [`crate::promise::bound`] may let the direction be any, and knows that it is of unit length.
    pub fn direction(&mut self, xyz: [Id; 3]) {
        self.directions.push(xyz);
    }

    /// The noted directions, in order.
    pub fn directions(&self) -> &[[Id; 3]] {
        &self.directions
    }

    /// Notes that the nodes are to be laid out in the order in which they were made, not each result with all that it
    /// needs: fewer values live at once where many sums grow side by side.
    pub fn lay_out_as_made(&mut self) {
        self.as_made = true;
    }

    /// Whether the nodes are to be laid out in the order in which they were made.
    pub fn is_laid_out_as_made(&self) -> bool {
        self.as_made
    }

    /// Notes the order in which results are laid out, each with all that it needs: that in which fewest values live at once.
    /// What is no result is not laid out for it.
    pub fn lay_out_in(&mut self, results: Vec<Id>) {
        self.first = results;
    }

    /// Notes the order in which operations are done.
    pub fn do_in(&mut self, done: Done) {
        self.done = Some(done);
    }

    /// The order in which operations are done, if it is noted.
    pub fn done(&self) -> Option<&Done> {
        self.done.as_ref()
    }

    /// The results that are laid out before others, in order.
    pub fn laid_out_first(&self) -> &[Id] {
        &self.first
    }

    /// Returns what these nodes need that depends on a signal, themselves among it, in the order in which it was made.
    pub fn linear(&self, outputs: &[Id]) -> Vec<Id> {
        self.needed(outputs, |id| !self.kind(id).is_scalar())
    }

    /// Returns what these nodes need, themselves among it, in the order in which it is first met depth first, as a layout
    /// goes.
    pub fn met(&self, outputs: &[Id]) -> Vec<Id> {
        let mut is_met = vec![false; self.nodes.len()];
        let (mut order, mut stack) = (Vec::new(), outputs.iter().rev().copied().collect::<Vec<_>>());
        while let Some(id) = stack.pop() {
            if std::mem::replace(&mut is_met[id.0 as usize], true) {
                continue;
            }
            order.push(id);
            if let Node::Op(op) = self.node(id) {
                let mut operands = op.into_operands();
                operands.reverse();
                stack.extend(operands);
            }
        }
        order
    }

    /// Nodes that satisfy a condition, from these on through operands that do.
    fn needed(&self, outputs: &[Id], counts: impl Fn(Id) -> bool) -> Vec<Id> {
        let mut is_needed = vec![false; self.nodes.len()];
        outputs.iter().filter(|&&id| counts(id)).for_each(|id| is_needed[id.0 as usize] = true);
        // An operand was made before what it is an operand of.
        for place in (0..self.nodes.len()).rev() {
            if let (true, Node::Op(op)) = (is_needed[place], &self.nodes[place]) {
                op.operands().filter(|&id| counts(id)).for_each(|id| is_needed[id.0 as usize] = true);
            }
        }
        (0..self.nodes.len() as u32).map(Id).filter(|id| is_needed[id.0 as usize]).collect()
    }

    /// Takes the part of another graph that these nodes need, operation by operation, and returns where they are here. What
    /// `leaf` gives stands for a node and all that it needs.
    pub fn take(&mut self, from: &Self, outputs: &[Id], leaf: impl Fn(Id, &Node) -> Option<Id>) -> Vec<Id> {
        let mut here: HashMap<Id, Id> = HashMap::new();
        for id in from.needed(outputs, |_| true) {
            let node = from.node(id);
            let taken = match (leaf(id, node), node) {
                (Some(given), _) => Some(given),
                (None, Node::Op(op)) => {
                    let known = op.operands().all(|operand| here.contains_key(&operand));
                    known.then(|| self.apply(op.map(|operand| here[&operand])))
                }
                (None, Node::Input { .. }) => None,
                (None, leaf) => Some(self.push(leaf.clone(), Kind::Scalar)),
            };
            taken.map(|taken| here.insert(id, taken));
        }
        self.as_made = from.as_made;
        outputs.iter().map(|id| here[id]).collect()
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
    ///
    /// # Panics
    ///
    /// If they are of two kinds: a signal and a product of signals, or a signal and a scalar that is not zero.
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

    /// a · b, of two signals their product channel by channel.
    ///
    /// # Panics
    ///
    /// If a factor is a product of signals and the other one is not a scalar.
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
                let (first, second) = match self.kind(a).cmp(&self.kind(b)) {
                    Ordering::Greater => (a, b),
                    Ordering::Less => (b, a),
                    Ordering::Equal => (a.min(b), a.max(b)),
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
        match self.kind(a).is_scalar() {
            true => self.apply(Op::Mul(constant, a)),
            false => self.apply(Op::Mul(a, constant)),
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

    /// √a; not a number where a is negative.
    pub fn sqrt(&mut self, a: Id) -> Id {
        match self.exact(a).filter(|value| value.signum() >= 0).map(Exact::sqrt) {
            Some(root) => self.constant(root),
            None => self.apply(Op::Sqrt(a)),
        }
    }

    /// 2 to the power a.
    pub fn exp2(&mut self, a: Id) -> Id {
        self.apply(Op::Exp2(a))
    }

    /// The logarithm of a to the base 2; −∞ for zero, not a number where a is negative.
    pub fn log2(&mut self, a: Id) -> Id {
        self.apply(Op::Log2(a))
    }

    /// |a|.
    pub fn abs(&mut self, a: Id) -> Id {
        match self.node(a).clone() {
            Node::Const(value) => self.constant(value.abs()),
            Node::Op(Op::Neg(inner)) => self.abs(inner),
            Node::Op(Op::Abs(_)) => a,
            _ => self.apply(Op::Abs(a)),
        }
    }

    /// The smaller of a and b; a where neither is smaller.
    pub fn min(&mut self, a: Id, b: Id) -> Id {
        self.choose([b, a], [b, a], Op::Min(a, b), |g, y, x| g.max(x, y))
    }

    /// The larger of a and b; a where neither is larger.
    pub fn max(&mut self, a: Id, b: Id) -> Id {
        self.choose([a, b], [b, a], Op::Max(a, b), |g, y, x| g.min(x, y))
    }

    /// a, or what is nearest to it from low to high.
    pub fn clamp(&mut self, a: Id, low: Id, high: Id) -> Id {
        let above = self.max(a, low);
        self.min(above, high)
    }

    /// c where a < b, else d; c and d may be signals.
    ///
    /// # Panics
    ///
    /// If a or b is no scalar, or c and d are of two kinds.
    pub fn select_less(&mut self, a: Id, b: Id, c: Id, d: Id) -> Id {
        if c == d {
            return c;
        }
        self.choose([a, b], [c, d], Op::Select(a, b, c, d), |g, x, y| g.select_less(a, b, x, y))
    }

    /// c where a ≤ b, else d: d where b < a, else c.
    ///
    /// # Panics
    ///
    /// As [`Graph::select_less`].
    pub fn select_at_most(&mut self, a: Id, b: Id, c: Id, d: Id) -> Id {
        self.select_less(b, a, d, c)
    }

    /// `p` where a < b, else `q`, if that is known; of two negations the negation of what `opposite` makes of what they
    /// negate; else the operation.
    fn choose(
        &mut self,
        [a, b]: [Id; 2],
        [p, q]: [Id; 2],
        op: Op<Id>,
        opposite: impl FnOnce(&mut Self, Id, Id) -> Id,
    ) -> Id {
        match (self.is_less(a, b), self.node(p), self.node(q)) {
            (Some(true), ..) => p,
            (Some(false), ..) => q,
            (None, &Node::Op(Op::Neg(x)), &Node::Op(Op::Neg(y))) => {
                let chosen = opposite(self, x, y);
                self.neg(chosen)
            }
            _ => self.apply(op),
        }
    }

    /// Whether a < b, where that is known: of constants, and of a node and itself.
    fn is_less(&self, a: Id, b: Id) -> Option<bool> {
        match (self.exact(a), self.exact(b)) {
            _ if a == b => Some(false),
            (Some(x), Some(y)) => Some((x - y).signum() < 0),
            _ => None,
        }
    }
}
