//! A part of a listing, run on enclosures: every scalar is an interval with a bound of its f32 error, every number that is
//! linear in the signal an interval and an error weight for each number of the signal that it depends on. Both ways of
//! contraction are bounded at once. docs/MATH.md#enclosures-with-error-weights has the rules.

mod depth;
mod toward;

use crate::ir::eval::Number;
use crate::ir::graph::Kind;
use crate::ir::listing::{Listing, Op, Operand, Sign};
use crate::promise::bound::norm::{Matrix, SLACK};
use crate::promise::bound::region::{Degree, Enclosure, Region, Root};
use crate::promise::bound::roundoff::Both;
use crate::promise::bound::value::{EPSILON, Value};
use std::collections::HashMap;

/// Why an operation is not met after [`Section::new`].
pub(super) const REFUSED: &str = "refused when the section was made";

/// What a section starts from: a root of its domain, with the error that it comes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// What it is exactly.
    pub root: Root,
    /// Its exact value may differ from that by so much, relative to it: an input that was rounded to f32.
    pub spread: f64,
    /// Its f32 value may differ from its exact value by so much.
    pub error: Both,
}

/// What a slot holds.
#[derive(Clone, Debug, PartialEq)]
enum Slot {
    Constant {
        value: [u64; 2],
        power: bool,
    },
    Start(usize),
    Signal(usize),
    /// An operation on slots.
    Step(Op),
}

/// A part of a listing between values that are given and values that are wanted.
#[derive(Clone, Debug)]
pub struct Section {
    slots: Vec<Slot>,
    kinds: Vec<Kind>,
    starts: Vec<Start>,
    outputs: Vec<usize>,
    columns: usize,
    degrees: Vec<Degree>,
    /// For each slot of a signal the columns that it depends on and where its entries begin.
    support: Vec<Vec<u16>>,
    offset: Vec<usize>,
    /// The steps of the signal by depth.
    levels: Vec<Vec<usize>>,
    /// For each entry of a step the entries of its first and of its last signal operand; 0 is an entry of zero.
    from: Vec<[u32; 2]>,
    /// The scalars that are wanted or that the signal is multiplied by, each with what it is made of, last step first.
    cones: Vec<(usize, Vec<usize>)>,
    /// The sums of both squares of a pair: exactly one.
    ones: Vec<usize>,
}

/// The exact map of a section and the weights of its error.
#[derive(Clone, Debug, Default)]
pub struct Run {
    mid: Vec<f64>,
    radius: Vec<f64>,
    weight: [Vec<f64>; 2],
    scalars: Vec<Value>,
    /// For each scalar the derivative of what is wanted, as a midpoint and a radius.
    derivative: Vec<Enclosure>,
}

fn is_power_of_two(value: f64) -> bool {
    value != 0.0 && value.to_bits() << 12 == 0
}

impl Section {
    /// The part of `listing` that computes `outputs` from the signal values `inputs` and whatever `start` knows. None if
    /// it needs another signal value, an unknown parameter, or divides by what an angle changes.
    pub fn new(
        listing: &Listing,
        domain: Region,
        inputs: &[Operand],
        outputs: &[Operand],
        start: impl Fn(Operand) -> Option<Start>,
    ) -> Option<Self> {
        let mut section = Self {
            slots: vec![],
            kinds: vec![],
            starts: vec![],
            outputs: vec![],
            columns: inputs.len(),
            degrees: vec![],
            support: vec![],
            offset: vec![],
            levels: vec![],
            from: vec![[0, 0]],
            cones: vec![],
            ones: vec![],
        };
        let mut known: HashMap<Operand, usize> = HashMap::new();
        for (column, &input) in inputs.iter().enumerate() {
            let next = section.push(Slot::Signal(column), Kind::Signal, [0; 3], vec![column as u16], vec![[0, 0]]);
            known.entry(input).or_insert(next);
        }
        let mut stack: Vec<(Operand, bool)> = outputs.iter().rev().map(|&output| (output, false)).collect();
        while let Some((operand, ready)) = stack.pop() {
            if known.contains_key(&operand) {
                continue;
            }
            let place = match operand {
                Operand::Const(place) => {
                    let value = listing.constants[place].to_f64();
                    let error = (f64::from(listing.constants[place].to_f32()) - value).abs();
                    section.constant(value, error + value.abs() * EPSILON)
                }
                Operand::Tiny => section.constant(f32::TINY.into(), 0.0),
                operand if start(operand).is_some() => {
                    let start = start(operand)?;
                    section.starts.push(start);
                    let place = section.starts.len() - 1;
                    section.push(Slot::Start(place), Kind::Scalar, domain.degree(start.root), vec![], vec![])
                }
                Operand::Input { .. } => return None,
                Operand::Step(step) if !ready => {
                    stack.push((operand, true));
                    stack.extend(listing.steps[step].op.operands().map(|operand| (operand, false)));
                    continue;
                }
                Operand::Step(step) => section.step(listing.steps[step].op, listing.steps[step].kind, &known)?,
            };
            known.insert(operand, place);
        }
        section.outputs = outputs.iter().map(|output| known[output]).collect();
        if domain == Region::Pairs {
            section.ones = (0..section.slots.len()).filter(|&slot| section.is_one(slot)).collect();
        }
        section.sort_by_depth();
        section.cones = section.wanted().into_iter().map(|slot| (slot, section.cone(&[slot]))).collect();
        Some(section)
    }

    /// Whether it is x² + y² of a pair (x, y).
    fn is_one(&self, slot: usize) -> bool {
        let square = |a: Operand, b: Operand| match self.slots[place(a)] {
            Slot::Start(start) if a == b => match self.starts[start].root {
                Root::Component(component) => Some(component),
                _ => None,
            },
            _ => None,
        };
        let product = |operand: Operand| match self.slots[place(operand)] {
            Slot::Step(Op::Mul(a, b)) => square(a, b),
            _ => None,
        };
        let both = match self.slots[slot] {
            Slot::Step(Op::Fma(a, b, c, Sign::Plus)) => square(a, b).zip(product(c)),
            Slot::Step(Op::Add(a, b)) => product(a).zip(product(b)),
            _ => None,
        };
        both.is_some_and(|(a, b)| a != b && a / 2 == b / 2)
    }

    fn push(&mut self, slot: Slot, kind: Kind, degree: Degree, support: Vec<u16>, from: Vec<[u32; 2]>) -> usize {
        self.offset.push(self.from.len());
        self.slots.push(slot);
        self.kinds.push(kind);
        self.degrees.push(degree);
        self.support.push(support);
        self.from.extend(from);
        self.slots.len() - 1
    }

    fn constant(&mut self, value: f64, error: f64) -> usize {
        let slot = Slot::Constant { value: [value.to_bits(), error.to_bits()], power: is_power_of_two(value) };
        self.push(slot, Kind::Scalar, [0; 3], vec![], vec![])
    }

    fn step(&mut self, op: Op, kind: Kind, known: &HashMap<Operand, usize>) -> Option<usize> {
        let slot = |operand: Operand| Operand::Step(known[&operand]);
        let op = op.map(slot);
        let of = |operand: Operand| self.degrees[place(operand)];
        let product = |a: Degree, b: Degree| std::array::from_fn(|i| a[i] + b[i]);
        let sum = |a: Degree, b: Degree| std::array::from_fn(|i| a[i].max(b[i]));
        let degree: Degree = match op {
            Op::Neg(a) => of(a),
            Op::Add(a, b) | Op::Sub(a, b) => sum(of(a), of(b)),
            Op::Mul(a, b) => product(of(a), of(b)),
            Op::Fma(a, b, c, _) => sum(product(of(a), of(b)), of(c)),
            Op::Recip(a) | Op::Rsqrt(a) => (of(a) == [0; 3]).then_some([0; 3])?,
            // Of what is not listed here nothing is known.
            _ => return None,
        };
        if kind == Kind::Scalar {
            return Some(self.push(Slot::Step(op), kind, degree, vec![], vec![]));
        }
        if matches!(op, Op::Recip(_) | Op::Rsqrt(_)) {
            return None;
        }
        let (first, last) = ends(op);
        if std::iter::once(first).chain(last).any(|slot| self.kinds[slot] == Kind::Scalar) {
            return None;
        }
        let entries = |slot: usize| (&self.support[slot], self.offset[slot]);
        let mut support: Vec<u16> = entries(first).0.clone();
        support.extend(last.iter().flat_map(|&last| entries(last).0));
        support.sort_unstable();
        support.dedup();
        let entry = |slot: usize, column: u16| {
            let (columns, offset) = entries(slot);
            columns.binary_search(&column).map_or(0, |at| (offset + at) as u32)
        };
        let from =
            support.iter().map(|&column| [entry(first, column), last.map_or(0, |last| entry(last, column))]).collect();
        Some(self.push(Slot::Step(op), kind, degree, support, from))
    }

    fn sort_by_depth(&mut self) {
        let mut depth = vec![0; self.slots.len()];
        for (at, slot) in self.slots.iter().enumerate() {
            if let (Slot::Step(op), Kind::Signal) = (slot, self.kinds[at]) {
                depth[at] = 1 + op.operands().map(|operand| depth[place(operand)]).max().unwrap_or(0);
                self.levels.resize(self.levels.len().max(depth[at]), vec![]);
                self.levels[depth[at] - 1].push(at);
            }
        }
    }

    /// The numbers that it starts from.
    pub fn starts(&self) -> &[Start] {
        &self.starts
    }

    /// The largest degree of any output in each angle of the domain.
    pub fn degree(&self) -> Degree {
        let all = self.outputs.iter().map(|&output| self.degrees[output]);
        all.fold([0; 3], |a, b| std::array::from_fn(|i| a[i].max(b[i])))
    }

    /// Whether every number that the signal is multiplied by is a constant or one of the roots, and none is multiplied
    /// by another: the map is then affine in the roots.
    pub fn is_affine(&self) -> bool {
        let mut depth = vec![0usize; self.slots.len()];
        for (at, slot) in self.slots.iter().enumerate() {
            let of = |operand: Operand| depth[place(operand)];
            depth[at] = match slot {
                Slot::Constant { .. } | Slot::Signal(_) => 0,
                Slot::Start(_) => 1,
                Slot::Step(_) if self.kinds[at] == Kind::Scalar => 2,
                Slot::Step(Op::Neg(a)) => of(*a),
                Slot::Step(Op::Add(a, b) | Op::Sub(a, b)) => of(*a).max(of(*b)),
                Slot::Step(Op::Mul(a, b)) => of(*a) + of(*b),
                Slot::Step(Op::Fma(a, b, c, _)) => (of(*a) + of(*b)).max(of(*c)),
                Slot::Step(_) => 2,
            };
        }
        self.outputs.iter().all(|&output| depth[output] <= 1)
    }

    /// Runs it with the roots' values; `roundoff` is [`U`](crate::promise::bound::roundoff::U), or 0 to have errors only from the roots' own errors.
    pub fn run(&self, values: &[Enclosure], starts: &[Start], roundoff: f64, run: &mut Run) {
        let entries = self.from.len();
        for list in [&mut run.mid, &mut run.radius].into_iter().chain(&mut run.weight) {
            list.clear();
            list.resize(entries, 0.0);
        }
        run.scalars.clear();
        run.scalars.resize(self.slots.len(), Value::default());
        run.derivative.clear();
        run.derivative.resize(self.slots.len(), (0.0, 0.0));
        // Slots are in order: all that a slot needs comes before it.
        let mut cones = self.cones.iter().peekable();
        for (at, slot) in self.slots.iter().enumerate() {
            match slot {
                &Slot::Constant { value: [value, error], .. } => {
                    let (mid, error) = (f64::from_bits(value), f64::from_bits(error));
                    let error = if roundoff == 0.0 { 0.0 } else { error };
                    run.scalars[at] = Value { mid, radius: mid.abs() * EPSILON, error: [error; 2] };
                }
                &Slot::Start(place) => {
                    let ((mid, radius), Start { spread, error, .. }) = (values[place], starts[place]);
                    run.scalars[at] = Value { mid, radius: radius + (mid.abs() + radius) * spread, error };
                }
                Slot::Signal(_) => run.mid[self.offset[at]] = 1.0,
                Slot::Step(op) if self.kinds[at] == Kind::Scalar => {
                    run.scalars[at] = self.scalar(*op, &run.scalars, roundoff);
                    if self.ones.contains(&at) {
                        let known = &mut run.scalars[at];
                        (known.mid, known.radius) = (1.0, 0.0);
                    }
                }
                Slot::Step(op) => self.signal(at, *op, roundoff, run),
            }
            if let Some((slot, cone)) = cones.next_if(|(slot, _)| *slot == at) {
                let error = self.toward(&[(*slot, 1.0)], cone, roundoff, run);
                let known = &mut run.scalars[at].error;
                *known = [known[0].min(error[0]), known[1].min(error[1])];
            }
        }
    }

    fn is_power(&self, slot: usize) -> bool {
        matches!(self.slots[slot], Slot::Constant { power: true, .. })
    }

    fn scalar(&self, op: Op, values: &[Value], roundoff: f64) -> Value {
        let of = |operand: Operand| values[place(operand)];
        let exact = |a: Operand, b: Operand| self.is_power(place(a)) || self.is_power(place(b));
        match op {
            Op::Neg(a) => of(a).negated(),
            Op::Add(a, b) => of(a).plus(of(b)).rounded(roundoff, [true; 2]),
            Op::Sub(a, b) => of(a).plus(of(b).negated()).rounded(roundoff, [true; 2]),
            Op::Mul(a, b) => of(a).times(of(b)).rounded(roundoff, [!exact(a, b); 2]),
            Op::Fma(a, b, c, sign) => {
                let product = of(a).times(of(b)).rounded(roundoff, [!exact(a, b), false]);
                let sum = match sign {
                    Sign::Plus => product.plus(of(c)),
                    Sign::MinusAddend => product.plus(of(c).negated()),
                    Sign::MinusProduct => of(c).plus(product.negated()),
                };
                sum.rounded(roundoff, [true; 2])
            }
            Op::Recip(a) => of(a).falling(|x| 1.0 / x, roundoff, 1),
            Op::Rsqrt(a) => of(a).falling(|x| 1.0 / x.sqrt(), roundoff, 2),
            _ => unreachable!("{REFUSED}"),
        }
    }

    /// A step of the signal as ±(factor · first) ± last: the factor, whether its product and the sum are rounded where
    /// nothing is fused, and the signs.
    fn form(&self, op: Op, scalars: &[Value]) -> (Value, [bool; 2], [f64; 2]) {
        let one = Value { mid: 1.0, ..Value::default() };
        let factor = |operand: Operand| (scalars[place(operand)], !self.is_power(place(operand)));
        match op {
            Op::Neg(_) => (one, [false, false], [-1.0, 0.0]),
            Op::Add(..) => (one, [false, true], [1.0, 1.0]),
            Op::Sub(..) => (one, [false, true], [1.0, -1.0]),
            Op::Mul(_, b) => (factor(b).0, [factor(b).1, false], [1.0, 0.0]),
            Op::Fma(_, b, _, sign) => {
                let signs = match sign {
                    Sign::Plus => [1.0, 1.0],
                    Sign::MinusAddend => [1.0, -1.0],
                    Sign::MinusProduct => [-1.0, 1.0],
                };
                (factor(b).0, [factor(b).1, true], signs)
            }
            _ => unreachable!("{REFUSED}"),
        }
    }

    fn signal(&self, at: usize, op: Op, roundoff: f64, run: &mut Run) {
        let (factor, rounds, [plus, minus]) = self.form(op, &run.scalars);
        // A product alone is rounded in both modes, one that is fused only where it is not.
        let product_rounds = [rounds[0], rounds[0] && !rounds[1]];
        let size = factor.magnitude();
        for entry in self.offset[at]..self.offset[at] + self.support[at].len() {
            let [a, c] = self.from[entry].map(|entry| entry as usize);
            let product = run.mid[a] * factor.mid;
            let given = run.mid[a].abs() + run.radius[a];
            let mut radius = run.mid[a].abs() * factor.radius + run.radius[a] * size + product.abs() * EPSILON;
            let product_size = product.abs() + radius;
            let mid = plus * product + minus * run.mid[c];
            radius += run.radius[c] + mid.abs() * EPSILON;
            for mode in 0..2 {
                let weight = run.weight[mode][a];
                let mut error = size * weight + factor.error[mode] * (given + weight);
                if product_rounds[mode] {
                    error += roundoff * (product_size + error);
                }
                error += run.weight[mode][c];
                if rounds[1] {
                    error += roundoff * (mid.abs() + radius + error);
                }
                run.weight[mode][entry] = error;
            }
            run.mid[entry] = mid;
            run.radius[entry] = radius;
        }
    }

    fn matrix(&self, values: &[f64]) -> Matrix {
        let mut entries = vec![0.0; self.outputs.len() * self.columns];
        for (row, &output) in self.outputs.iter().enumerate() {
            for (at, &column) in self.support[output].iter().enumerate() {
                entries[row * self.columns + column as usize] = values[self.offset[output] + at];
            }
        }
        Matrix { columns: self.columns, entries }
    }

    /// The error's weights, a row an output.
    pub fn weights(&self, run: &Run, mode: usize) -> Matrix {
        self.matrix(&run.weight[mode])
    }

    /// The exact map's midpoints and radii, a row an output.
    pub fn map(&self, run: &Run) -> [Matrix; 2] {
        [self.matrix(&run.mid), self.matrix(&run.radius)]
    }

    /// The errors of outputs that are scalars.
    pub fn errors(&self, run: &Run) -> Vec<Both> {
        self.outputs.iter().map(|&output| run.scalars[output].error.map(|error| error * SLACK)).collect()
    }

    /// What tells sections apart whose bounds differ.
    pub fn key(&self) -> String {
        format!("{:?} {:?} {:?} {:?}", self.slots, self.kinds, self.starts, self.outputs)
    }
}

fn place(slot: Operand) -> usize {
    match slot {
        Operand::Step(place) => place,
        _ => unreachable!("the operands of a section are slots"),
    }
}

/// The signal operands of a step: the one in its product, or its first, and the one that is added.
fn ends(op: Op) -> (usize, Option<usize>) {
    match op {
        Op::Neg(a) | Op::Mul(a, _) => (place(a), None),
        Op::Add(a, b) | Op::Sub(a, b) => (place(a), Some(place(b))),
        Op::Fma(a, _, c, _) => (place(a), Some(place(c))),
        _ => unreachable!("{REFUSED}"),
    }
}
