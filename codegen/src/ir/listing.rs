//! A kernel laid out: the operations in the order in which they are done, products fused into the sums that use them,
//! what is used twice named. The interpreter runs a listing and the printers print it, so both do the same.

use crate::ir::graph::{Done, Graph, Id, Kind, Node};
use crate::ir::kernel::{Kernel, Param, Shape};
pub use crate::ir::op::Sign;
use crate::ir::op::{self, Price};
use crate::math::exact::Exact;
use std::collections::{HashMap, HashSet};

/// An operand of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operand {
    /// The result of an earlier step.
    Step(usize),
    /// A constant of the listing.
    Const(usize),
    /// The smallest number that matters; see [`Node::Tiny`].
    Tiny,
    /// A component of a parameter.
    Input {
        /// Which parameter.
        param: usize,
        /// Which component, in flat order.
        index: usize,
    },
}

/// An operation of a listing.
pub type Op = op::Op<Operand>;

/// A step: an operation, the kind of its value, and how often it is used.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// What is done.
    pub op: Op,
    /// One number, or one a channel.
    pub kind: Kind,
    /// How many later steps and outputs use it.
    pub uses: usize,
}

/// What a kernel costs. A multiplication, an addition, a fused multiply-add or a choice of two numbers is one operation
/// each; a negation and an absolute value are free; reciprocals, roots, powers and logarithms are counted apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Cost {
    /// Multiplications that are not fused.
    pub mul: usize,
    /// Additions and subtractions that are not fused.
    pub add: usize,
    /// Fused multiply-adds.
    pub fma: usize,
    /// Minima, maxima and selections.
    pub choice: usize,
    /// Reciprocals, roots, powers and logarithms.
    pub special: usize,
    /// mul + add + fma + choice.
    pub total: usize,
}

impl std::ops::Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            mul: self.mul + other.mul,
            add: self.add + other.add,
            fma: self.fma + other.fma,
            choice: self.choice + other.choice,
            special: self.special + other.special,
            total: self.total + other.total,
        }
    }
}

/// What a kernel needs besides operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Footprint {
    /// Distinct constants, their signs left out.
    pub constants: usize,
    /// The most values that are alive at once, inputs not counted.
    pub live: usize,
    /// The same where a number of the result is handed over as soon as it is known, and no longer counts.
    pub passing: usize,
}

/// A kernel laid out.
#[derive(Clone, Debug)]
pub struct Listing {
    /// The parameters, in order.
    pub params: Vec<Param>,
    /// The constants, none of them negative unless it is an output or an operand of what is no sum and no product.
    pub constants: Vec<Exact>,
    /// The steps, in order.
    pub steps: Vec<Step>,
    /// One operand a number of the result.
    pub outputs: Vec<Operand>,
    /// Where a proof may cut, in order, signs left out; see [`Graph::stage`].
    pub stages: Vec<Vec<Operand>>,
    /// What is known to be a turned direction, signs left out; see [`Graph::direction`].
    pub directions: Vec<[Operand; 3]>,
    /// The shape of the result.
    pub result: Shape,
    /// Whether the result is linear in the signal, or in each of two.
    pub result_kind: Kind,
    /// What the result holds.
    pub result_doc: String,
}

struct Layout<'a> {
    graph: &'a Graph,
    order: Vec<Id>,
    users: HashMap<Id, Vec<Id>>,
    /// The values whose sign nothing else can carry: outputs, and operands of what is no sum.
    signed: HashSet<Id>,
}

/// The node below a negation, and whether there was one.
fn unsigned(graph: &Graph, id: Id) -> (Id, bool) {
    match *graph.node(id) {
        Node::Op(op::Op::Neg(inner)) => (inner, true),
        _ => (id, false),
    }
}

/// What these nodes need and they themselves, depth first; each is shown with its operands when it is first met.
fn depth_first(graph: &Graph, outputs: &[Id], mut met: impl FnMut(Id, &[Id])) -> Vec<Id> {
    let (mut order, mut seen) = (Vec::new(), HashSet::new());
    let mut stack: Vec<(Id, bool)> = outputs.iter().rev().map(|&id| (id, false)).collect();
    while let Some((id, ready)) = stack.pop() {
        if ready {
            order.push(id);
            continue;
        }
        if !seen.insert(id) {
            continue;
        }
        stack.push((id, true));
        let operands: Vec<Id> = match *graph.node(id) {
            Node::Const(_) | Node::Tiny | Node::Input { .. } => vec![],
            Node::Op(op) => op.operands().collect(),
        };
        stack.extend(operands.iter().rev().map(|&operand| (operand, false)));
        met(id, &operands);
    }
    order
}

impl<'a> Layout<'a> {
    /// Depth first from the outputs, or as the graph was made; who uses each node, negations looked through.
    fn new(kernel: &'a Kernel) -> Self {
        let graph = &kernel.graph;
        let signed = kernel.outputs.iter().copied().collect();
        let mut layout = Self { graph, order: Vec::new(), users: HashMap::new(), signed };
        let first = graph.laid_out_first().iter().filter(|id| kernel.outputs.contains(id));
        let outputs: Vec<Id> = first.chain(&kernel.outputs).copied().collect();
        layout.order = depth_first(graph, &outputs, |id, operands| {
            if !matches!(graph.node(id), Node::Op(op::Op::Neg(_))) {
                for &operand in operands {
                    layout.users.entry(unsigned(graph, operand).0).or_default().push(id);
                }
                if !matches!(graph.node(id), Node::Op(op::Op::Add(..))) {
                    layout.signed.extend(operands);
                }
            }
        });
        if graph.is_laid_out_as_made() {
            // What a node uses was made before it.
            layout.order.sort_unstable();
        }
        layout
    }

    /// The nodes in the order in which they are done.
    fn done(&self, outputs: &[Id]) -> Vec<Id> {
        let mut order = self.order.clone();
        match self.graph.done() {
            None => {}
            Some(Done::AsMade) => order.sort_unstable(),
            Some(Done::By(results)) => {
                let all: Vec<Id> = results.iter().chain(outputs).copied().collect();
                order = depth_first(self.graph, &all, |_, _| ());
            }
        }
        order
    }

    /// For each sum, the product that is fused into it. A product is fused when every use of it is a sum that has no
    /// other product yet, for then the product itself vanishes; those with the fewest uses go first.
    fn fuse(&self, outputs: &[Id]) -> HashMap<Id, Id> {
        let place: HashMap<Id, usize> = self.order.iter().enumerate().map(|(i, &id)| (id, i)).collect();
        let kept: HashSet<Id> = outputs.iter().map(|&id| unsigned(self.graph, id).0).collect();
        let mut products: Vec<Id> = self
            .order
            .iter()
            .copied()
            .filter(|id| {
                matches!(self.graph.node(*id), Node::Op(op::Op::Mul(..)))
                    && !kept.contains(id)
                    && place.contains_key(id)
            })
            .collect();
        products.sort_by_key(|id| self.users[id].len());
        let mut fused: HashMap<Id, Id> = HashMap::new();
        for product in products {
            let users = &self.users[&product];
            let free = users.iter().enumerate().all(|(i, user)| {
                matches!(self.graph.node(*user), Node::Op(op::Op::Add(..)))
                    && !fused.contains_key(user)
                    && !users[..i].contains(user)
            });
            if free {
                fused.extend(users.iter().map(|&user| (user, product)));
            }
        }
        fused
    }
}

/// The products of a kernel that vanish in the sums that use them.
pub(crate) fn fused_products(kernel: &Kernel) -> HashSet<Id> {
    Layout::new(kernel).fuse(&kernel.outputs).into_values().collect()
}

impl Listing {
    /// Lays a kernel out.
    pub fn new(kernel: &Kernel) -> Self {
        let graph = &kernel.graph;
        let layout = Layout::new(kernel);
        let fused = layout.fuse(&kernel.outputs);
        let vanished: HashSet<Id> = fused.values().copied().collect();
        let mut listing = Self {
            params: kernel.params.clone(),
            constants: Vec::new(),
            steps: Vec::new(),
            outputs: Vec::new(),
            stages: Vec::new(),
            directions: Vec::new(),
            result: kernel.result,
            result_kind: kernel.result_kind,
            result_doc: kernel.result_doc.clone(),
        };
        let mut operands: HashMap<Id, Operand> = HashMap::new();
        let mut constants: HashMap<Exact, usize> = HashMap::new();
        for id in layout.done(&kernel.outputs) {
            if vanished.contains(&id) {
                continue;
            }
            let operand = match graph.node(id) {
                Node::Const(value) => {
                    let next = constants.len();
                    let place = *constants.entry(value.clone()).or_insert(next);
                    if place == next {
                        listing.constants.push(value.clone());
                    }
                    Operand::Const(place)
                }
                Node::Tiny => Operand::Tiny,
                &Node::Input { param, index } => Operand::Input { param: param as usize, index: index as usize },
                Node::Op(op::Op::Neg(_)) if !layout.signed.contains(&id) => continue,
                Node::Op(op) => {
                    let op = match *op {
                        op::Op::Add(a, b) => Self::sum(graph, &operands, fused.get(&id).copied(), a, b),
                        op => op.map(|id| operands[&id]),
                    };
                    listing.steps.push(Step { op, kind: graph.kind(id), uses: 0 });
                    Operand::Step(listing.steps.len() - 1)
                }
            };
            operands.insert(id, operand);
        }
        listing.outputs = kernel.outputs.iter().map(|id| operands[id]).collect();
        let known = |&id: &Id| operands.get(&unsigned(graph, id).0).copied();
        listing.stages = graph.stages().iter().filter_map(|ids| ids.iter().map(known).collect()).collect();
        let direction = |[x, y, z]: &[Id; 3]| Some([known(x)?, known(y)?, known(z)?]);
        listing.directions = graph.directions().iter().filter_map(direction).collect();
        listing.count_uses();
        listing
    }

    fn sum(graph: &Graph, operands: &HashMap<Id, Operand>, product: Option<Id>, a: Id, b: Id) -> Op {
        let ((x, x_minus), (y, y_minus)) = (unsigned(graph, a), unsigned(graph, b));
        debug_assert!(!x_minus, "the first summand carries no sign");
        let Some(product) = product else {
            return match y_minus {
                false => Op::Add(operands[&x], operands[&y]),
                true => Op::Sub(operands[&x], operands[&y]),
            };
        };
        let &Node::Op(op::Op::Mul(p, q)) = graph.node(product) else {
            unreachable!("only products are fused");
        };
        let (p, q) = (operands[&p], operands[&q]);
        match (x == product, y_minus) {
            (true, false) => Op::Fma(p, q, operands[&y], Sign::Plus),
            (true, true) => Op::Fma(p, q, operands[&y], Sign::MinusAddend),
            (false, false) => Op::Fma(p, q, operands[&x], Sign::Plus),
            (false, true) => Op::Fma(p, q, operands[&x], Sign::MinusProduct),
        }
    }

    pub(crate) fn count_uses(&mut self) {
        let mut uses = vec![0; self.steps.len()];
        for operand in self.steps.iter().flat_map(|step| step.op.operands()).chain(self.outputs.iter().copied()) {
            if let Operand::Step(step) = operand {
                uses[step] += 1;
            }
        }
        for (step, uses) in self.steps.iter_mut().zip(uses) {
            step.uses = uses;
        }
    }

    /// What it costs for a signal of so many channels.
    pub fn cost(&self, channels: usize) -> Cost {
        let mut cost = Cost::default();
        for step in &self.steps {
            let times = step.kind.numbers(channels);
            match step.op.price() {
                Price::Free => {}
                Price::Add => cost.add += times,
                Price::Mul => cost.mul += times,
                Price::Fma => cost.fma += times,
                Price::Choice => cost.choice += times,
                Price::Special => cost.special += times,
            }
        }
        cost.total = cost.mul + cost.add + cost.fma + cost.choice;
        cost
    }

    /// What it needs besides operations.
    pub fn footprint(&self) -> Footprint {
        let passing = self.most_alive(&self.last_uses(), 1);
        Footprint { constants: self.constants.len(), live: self.alive(1), passing }
    }

    /// The most numbers that are alive at once for a signal of so many channels, inputs not counted.
    pub fn alive(&self, channels: usize) -> usize {
        let mut last = self.last_uses();
        for operand in &self.outputs {
            if let Operand::Step(used) = *operand {
                last[used] = self.steps.len();
            }
        }
        self.most_alive(&last, channels)
    }

    /// The step that uses each last, or it itself.
    fn last_uses(&self) -> Vec<usize> {
        let mut last: Vec<usize> = (0..self.steps.len()).collect();
        for (place, step) in self.steps.iter().enumerate() {
            for operand in step.op.operands() {
                if let Operand::Step(used) = operand {
                    last[used] = place;
                }
            }
        }
        last
    }

    /// How many numbers are alive at once, at the most, of steps that are each last used at a place.
    fn most_alive(&self, last: &[usize], channels: usize) -> usize {
        let mut ends = vec![0; self.steps.len() + 1];
        let (mut alive, mut most) = (0, 0);
        for (place, (&end, step)) in last.iter().zip(&self.steps).enumerate() {
            let numbers = step.kind.numbers(channels);
            alive -= ends[place];
            alive += numbers;
            most = most.max(alive);
            match end > place {
                true => ends[end] += numbers,
                false => alive -= numbers,
            }
        }
        most
    }
}
