//! The unit phases of a kernel: which pairs of scalars are e^{ikθ}, and how far their f32 values are off as complex
//! numbers. Componentwise a chain of complex products would seem to lose half a bit a step; as complex numbers errors add
//! (docs/MATH.md#planes-as-complex-products).
//!
//! A complex product is off by K u of its size at most: K = √5 for separate arithmetic (Brent, Percival and Zimmermann
//! 2007), 2 for fused (Jeannerod, Kornerup, Louvet and Muller 2017; whichever products are rounded, one of each part, they
//! share a factor, so that what they lose is u |a| |cos + i sin| at most, and the sums lose as much again). The set-ups
//! are recognised by their operations, which says which values are phases, and bounded over [`boxes`]. By hand the phases
//! of a quaternion are off by (5.5 + K) u at most, as A = w² + z² and B = x² + y² are by 2 u relatively, AB by 5 u, its
//! inverse root by 4.5 u and (w, z) times that by 5.5 u: 7.74 u where nothing is fused, where the boxes find some 7.9, and
//! 7.5 u where products are, where the boxes find some 7.2. The smaller one counts. So it is with cos β = A − B, off by
//! 2 u + u |cos β|, and sin β = 2 √(AB), by 5.5 u sin β: as one vector 5.87 u; and with a normal's x² + y², off by 2 u,
//! which leaves its inverse root by 3 u and (x, y) or x² + y² times that by 4 u.

use crate::ir::kernel::POLAR;
use crate::ir::listing::{Listing, Op, Operand, Sign};
use crate::promise::bound::boxes;
use crate::promise::bound::roundoff::{Both, INPUT, U};
use std::collections::HashMap;

/// What is left out of the boxes: underflow, and the tiny number.
const REST: f64 = 1e-12;

/// A complex number of unit size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Its real part.
    pub cos: Operand,
    /// Its imaginary part.
    pub sin: Operand,
    /// Which angle it is a multiple of.
    pub circle: usize,
    /// Which multiple.
    pub multiple: usize,
    /// Its exact size is from 1 − this to 1 + this.
    pub defect: f64,
    /// Its f32 value is so far from the exact one, as a complex number.
    pub error: Both,
}

impl Phase {
    /// The size that it may have.
    pub fn size(&self) -> f64 {
        1.0 + self.defect
    }
}

/// Two products and their signs: ±ab ± cd.
#[derive(Clone, Copy, Debug)]
struct Pair {
    first: [Operand; 2],
    second: [Operand; 2],
    plus: [bool; 2],
    /// Whether it is a fused operation.
    fused: bool,
}

fn order(operand: Operand) -> (usize, usize, usize) {
    match operand {
        Operand::Step(step) => (0, step, 0),
        Operand::Const(place) => (1, place, 0),
        Operand::Tiny => (2, 0, 0),
        Operand::Input { param, index } => (3, param, index),
    }
}

fn sorted(mut product: [Operand; 2]) -> [Operand; 2] {
    product.sort_by_key(|&operand| order(operand));
    product
}

/// The step that a value is, negations looked through.
fn step(listing: &Listing, mut operand: Operand) -> Option<Op> {
    while let Operand::Step(place) = operand {
        match listing.steps[place].op {
            Op::Neg(inner) => operand = inner,
            op => return Some(op),
        }
    }
    None
}

fn product(listing: &Listing, operand: Operand) -> Option<[Operand; 2]> {
    match operand {
        Operand::Step(place) => match listing.steps[place].op {
            Op::Mul(a, b) => Some([a, b]),
            _ => None,
        },
        _ => None,
    }
}

fn pair(listing: &Listing, op: Op) -> Option<Pair> {
    let (first, second, plus, fused) = match op {
        Op::Fma(a, b, c, sign) => {
            let plus = match sign {
                Sign::Plus => [true, true],
                Sign::MinusAddend => [true, false],
                Sign::MinusProduct => [false, true],
            };
            ([a, b], product(listing, c)?, plus, true)
        }
        Op::Add(a, b) => (product(listing, a)?, product(listing, b)?, [true, true], false),
        Op::Sub(a, b) => (product(listing, a)?, product(listing, b)?, [true, false], false),
        _ => return None,
    };
    Some(Pair { first: sorted(first), second: sorted(second), plus, fused })
}

impl Pair {
    /// Whether it is ±ab ± cd for these products, with their signs in this order.
    fn is_of(&self, one: [Operand; 2], other: [Operand; 2]) -> Option<[bool; 2]> {
        let (one, other) = (sorted(one), sorted(other));
        if (self.first, self.second) == (one, other) {
            Some(self.plus)
        } else if (self.first, self.second) == (other, one) {
            Some([self.plus[1], self.plus[0]])
        } else {
            None
        }
    }
}

/// How far a complex product made of these two sums is off, relative to its size.
fn complex_product(real: &Pair, imaginary: &Pair) -> Both {
    let fused = match (real.fused, imaginary.fused) {
        (true, true) => 2.0,
        (false, false) => 5f64.sqrt(),
        // At most u(|ac| + |bd| + |real|) and the same for the other part.
        _ => 1.0 + 2f64.sqrt(),
    };
    [5f64.sqrt() * U, fused * U].map(|error| error * (1.0 + 1e-6))
}

/// Whether (real, imaginary) is the complex product of (a, b) and (c, d) but for signs that change no size; if so, how
/// far it is off relative to its size.
pub fn turn(
    listing: &Listing,
    real: Operand,
    imaginary: Operand,
    [a, b]: [Operand; 2],
    [c, d]: [Operand; 2],
) -> Option<Both> {
    let (real, imaginary) = (pair(listing, step(listing, real)?)?, pair(listing, step(listing, imaginary)?)?);
    let (p, q) = (real.is_of([a, c], [b, d])?, imaginary.is_of([a, d], [b, c])?);
    // |±ac ± bd|² + |±ad ± bc|² is |ab|²|cd|² where the cross terms cancel: where the signs' product is −1.
    let minus = [p, q].as_flattened().iter().filter(|plus| !**plus).count();
    (minus % 2 == 1).then(|| complex_product(&real, &imaginary))
}

/// The known phases of a listing.
#[derive(Clone, Debug, Default)]
pub struct Phases {
    all: Vec<Phase>,
    parts: HashMap<Operand, (usize, bool)>,
}

impl Phases {
    /// Those that are made from `roots` by complex products.
    pub fn new(listing: &Listing, roots: Vec<Phase>) -> Self {
        let mut sums: HashMap<[[Operand; 2]; 2], Vec<usize>> = HashMap::new();
        let mut doubles: HashMap<[Operand; 2], usize> = HashMap::new();
        for (place, step) in listing.steps.iter().enumerate() {
            if let Some(pair) = pair(listing, step.op) {
                sums.entry([pair.first, pair.second]).or_default().push(place);
            }
            if let Op::Mul(a, b) = step.op {
                let doubled = if is_two(listing, a) { product(listing, b) } else { None };
                doubled.into_iter().for_each(|product| {
                    doubles.insert(sorted(product), place);
                });
            }
        }
        let find = |one: [Operand; 2], other: [Operand; 2]| -> Vec<usize> {
            let (one, other) = (sorted(one), sorted(other));
            let of = |key| sums.get(&key).cloned().unwrap_or_default();
            [of([one, other]), if one == other { vec![] } else { of([other, one]) }].concat()
        };
        let mut known = Self::only(roots);
        let mut next = 0;
        while next < known.all.len() {
            for other in 0..=next {
                let (p, q) = (known.all[next], known.all[other]);
                if p.circle != q.circle {
                    continue;
                }
                for cos in find([p.cos, q.cos], [p.sin, q.sin]) {
                    let difference = pair(listing, listing.steps[cos].op).expect("is a sum of two products");
                    if difference.is_of([p.cos, q.cos], [p.sin, q.sin]) != Some([true, false]) {
                        continue;
                    }
                    // Twice a product is the sum of the two equal products, rounded once less.
                    let double = (next == other).then(|| doubles.get(&sorted([p.cos, p.sin])).copied()).flatten();
                    let sine = find([p.cos, q.sin], [p.sin, q.cos]).into_iter().find_map(|sin| {
                        let sum = pair(listing, listing.steps[sin].op).expect("is a sum of two products");
                        (sum.plus == [true, true]).then_some((sin, sum.fused))
                    });
                    let Some((sin, fused)) = sine.or(double.map(|sin| (sin, difference.fused))) else {
                        continue;
                    };
                    let own = complex_product(&difference, &Pair { fused, ..difference });
                    let size = p.size() * q.size();
                    let error = std::array::from_fn(|i| {
                        (p.size() + p.error[i]) * (q.size() + q.error[i]) * (1.0 + own[i]) - size
                    });
                    known.add(Phase {
                        cos: Operand::Step(cos),
                        sin: Operand::Step(sin),
                        circle: p.circle,
                        multiple: p.multiple + q.multiple,
                        defect: (size - 1.0) * (1.0 + 1e-6),
                        error,
                    });
                }
            }
            next += 1;
        }
        known
    }

    /// These alone.
    pub fn only(roots: Vec<Phase>) -> Self {
        let mut known = Self::default();
        roots.into_iter().for_each(|root| known.add(root));
        known
    }

    fn add(&mut self, phase: Phase) {
        if self.parts.contains_key(&phase.cos) || self.parts.contains_key(&phase.sin) {
            return;
        }
        self.parts.insert(phase.cos, (self.all.len(), false));
        self.parts.insert(phase.sin, (self.all.len(), true));
        self.all.push(phase);
    }

    /// All of them.
    pub fn all(&self) -> &[Phase] {
        &self.all
    }

    /// The phase that a value is part of, and whether it is the sine.
    pub fn of(&self, operand: Operand) -> Option<(&Phase, bool)> {
        self.parts.get(&operand).map(|&(place, sine)| (&self.all[place], sine))
    }
}

/// A phase that is an f32 input.
pub fn given(param: usize, pair: usize, circle: usize, multiple: usize) -> Phase {
    let part = |index| Operand::Input { param, index: 2 * pair + index };
    Phase { cos: part(0), sin: part(1), circle, multiple, defect: INPUT, error: [0.0; 2] }
}

fn is_two(listing: &Listing, operand: Operand) -> bool {
    matches!(operand, Operand::Const(place) if listing.constants[place].to_f64() == 2.0)
}

/// What a value is two times, if it is made so.
pub fn doubled(listing: &Listing, value: Operand) -> Option<Operand> {
    match step(listing, value)? {
        Op::Mul(k, x) if is_two(listing, k) => Some(x),
        _ => None,
    }
}

fn steps(listing: &Listing) -> impl Iterator<Item = (Operand, Op)> + '_ {
    listing.steps.iter().enumerate().map(|(place, step)| (Operand::Step(place), step.op))
}

fn find(listing: &Listing, wanted: impl Fn(Op) -> bool) -> Option<Operand> {
    steps(listing).find(|(_, op)| wanted(*op)).map(|(operand, _)| operand)
}

fn find_product(listing: &Listing, a: Operand, b: Operand) -> Option<Operand> {
    find(listing, |op| matches!(op, Op::Mul(x, y) if sorted([x, y]) == sorted([a, b])))
}

/// A component of the first parameter, with the tiny number added.
fn nudged(listing: &Listing, index: usize) -> Option<Operand> {
    let input = Operand::Input { param: 0, index };
    find(listing, |op| matches!(op, Op::Add(a, b) if sorted([a, b]) == sorted([input, Operand::Tiny])))
}

fn sum_of_squares(listing: &Listing, a: Operand, b: Operand) -> Option<Operand> {
    find(listing, |op| pair(listing, op).and_then(|pair| pair.is_of([a, a], [b, b])) == Some([true, true]))
}

/// What the angles of a quaternion are made of: (w, z), (y, x), the sums of their squares, the product of those, and its
/// inverse root.
struct Halves {
    pairs: [[Operand; 2]; 2],
    a: Operand,
    b: Operand,
    ab: Operand,
    r: Operand,
}

impl Halves {
    fn of(listing: &Listing) -> Option<Self> {
        let input = |index| Operand::Input { param: 0, index };
        let (x, z, y, w) = (input(0), input(2), nudged(listing, 1)?, nudged(listing, 3)?);
        let (a, b) = (sum_of_squares(listing, w, z)?, sum_of_squares(listing, x, y)?);
        let ab = find_product(listing, a, b)?;
        let r = find(listing, |op| op == Op::Rsqrt(ab))?;
        Some(Self { pairs: [[w, z], [y, x]], a, b, ab, r })
    }
}

/// tan(β/2) that a kernel makes of a quaternion, and how far it is off relative to it.
pub fn half_tangent(listing: &Listing) -> Option<(Operand, Both)> {
    let Halves { pairs, b, r, .. } = Halves::of(listing)?;
    let tangent = find_product(listing, b, r)?;
    Some((tangent, boxes::error(listing, &pairs, &[tangent])?.map(|error| error + REST)))
}

/// Whether a value is `addend` ± the product of `factors`; if so, with which sign.
fn is_added(listing: &Listing, value: Operand, addend: Operand, factors: [Operand; 2]) -> Option<bool> {
    let is_product = |operand| product(listing, operand).map(sorted) == Some(sorted(factors));
    match step(listing, value)? {
        Op::Fma(a, b, c, sign) if c == addend && sorted([a, b]) == sorted(factors) => match sign {
            Sign::Plus => Some(true),
            Sign::MinusProduct => Some(false),
            Sign::MinusAddend => None,
        },
        Op::Add(a, b) if (a == addend && is_product(b)) || (b == addend && is_product(a)) => Some(true),
        Op::Sub(a, b) if a == addend && is_product(b) => Some(false),
        _ => None,
    }
}

/// tan(kβ/2) for k from 1 to `count`, which a kernel makes of `half`, tan(β/2), and of the phases of β: of jβ alone for
/// k = 2j, of it and `half` for k = 2j + 1.
pub fn tangents(listing: &Listing, known: &Phases, half: Operand, count: usize) -> Option<Vec<Operand>> {
    let of = |k: usize| {
        let phase = known.all().iter().find(|phase| (phase.circle, phase.multiple) == (POLAR, k / 2))?;
        let is_quotient = |over: Operand, under: Operand| match k % 2 {
            0 => (over, under) == (phase.sin, phase.cos),
            _ => {
                is_added(listing, over, phase.sin, [phase.cos, half]) == Some(true)
                    && is_added(listing, under, phase.cos, [phase.sin, half]) == Some(false)
            }
        };
        let inverted = |operand: Operand| match step(listing, operand) {
            Some(Op::Recip(under)) => Some(under),
            _ => None,
        };
        find(listing, |op| match op {
            Op::Mul(a, b) => [(a, b), (b, a)]
                .into_iter()
                .any(|(over, inverse)| inverted(inverse).is_some_and(|under| is_quotient(over, under))),
            _ => false,
        })
    };
    (1..=count).map(|k| if k == 1 { Some(half) } else { of(k) }).collect()
}

/// sin kβ, where cos kβ is perhaps not computed.
pub fn sine(listing: &Listing, known: &Phases, k: usize) -> Option<Operand> {
    let polar = || known.all().iter().filter(|phase| phase.circle == POLAR);
    let whole = polar().find(|phase| phase.multiple == k).map(|phase| phase.sin);
    let of_two = |p: &Phase, q: &Phase| {
        find(listing, |op| {
            pair(listing, op).and_then(|sum| sum.is_of([p.cos, q.sin], [p.sin, q.cos])) == Some([true, true])
        })
    };
    let pairs = || polar().flat_map(|p| polar().map(move |q| (p, q))).filter(|(p, q)| p.multiple + q.multiple == k);
    whole.or_else(|| pairs().find_map(|(p, q)| of_two(p, q)))
}

/// The phases of α, β and γ that a kernel makes of a unit quaternion. The rounding of adding the tiny number is left out:
/// it turns α and γ, but hardly the rotation that they make together.
pub fn of_quaternion(listing: &Listing) -> Option<Vec<Phase>> {
    let Halves { pairs, a, b, ab, r } = Halves::of(listing)?;
    let [[w, z], [y, x]] = pairs;
    let (wr, zr) = (find_product(listing, w, r)?, find_product(listing, z, r)?);
    // Two phases, α and γ: the same products with other signs.
    let part = |one: [Operand; 2], other: [Operand; 2]| -> Vec<(Operand, Pair)> {
        let is_one = |op| pair(listing, op).filter(|pair| pair.is_of(one, other).is_some());
        steps(listing).filter_map(|(operand, op)| is_one(op).map(|pair| (operand, pair))).collect()
    };
    let (real, imaginary) = (part([wr, y], [zr, x]), part([zr, y], [wr, x]));
    let mut phases = Vec::new();
    for (cos, p) in &real {
        let opposite = |q: &Pair| (p.plus[0] == p.plus[1]) != (q.plus[0] == q.plus[1]);
        let (sin, q) = imaginary.iter().find(|(_, q)| opposite(q))?;
        let (boxes, own) = (boxes::error(listing, &pairs, &[*cos, *sin])?, complex_product(p, q));
        let error = std::array::from_fn(|mode| boxes[mode].min(5.5 * U + own[mode]) + REST);
        phases.push(Phase { cos: *cos, sin: *sin, circle: phases.len(), multiple: 1, defect: 0.0, error });
    }
    let [_, _] = phases[..] else { return None };
    let root = find_product(listing, ab, r)?;
    let sin = find(listing, |op| matches!(op, Op::Mul(k, x) if is_two(listing, k) && x == root))?;
    let cos = find(listing, |op| op == Op::Sub(a, b))?;
    let part = |value| boxes::error(listing, &pairs, &[value]);
    let polar = boxes::polar(part(a)?, part(b)?, part(sin)?.map(|error| error / 2.0));
    let error = polar.map(|boxes| boxes.min(5.87 * U) + REST);
    phases.push(Phase { cos, sin, circle: POLAR, multiple: 1, defect: 2.0 * INPUT + REST, error });
    Some(phases)
}

/// The phases of φ and θ that `align` makes of a unit normal.
pub fn of_normal(listing: &Listing) -> Option<Vec<Phase>> {
    let input = |index| Operand::Input { param: 0, index };
    let (x, y, z) = (nudged(listing, 0)?, input(1), input(2));
    let squares = sum_of_squares(listing, x, y)?;
    let r = find(listing, |op| op == Op::Rsqrt(squares))?;
    let (cos, sin) = (find_product(listing, x, r)?, find_product(listing, y, r)?);
    let height = find_product(listing, squares, r)?;
    // Adding the tiny number to x turns φ by less than u where x or y is above 2e-8.
    let part = |values: &[Operand]| boxes::error(listing, &[[x, y]], values);
    let error = part(&[cos, sin])?.map(|boxes| boxes.min(4.0 * U) + U + REST);
    let phi = Phase { cos, sin, circle: 0, multiple: 1, defect: 0.0, error };
    let error = part(&[height])?.map(|boxes| boxes.min(4.0 * U) + REST);
    let theta = Phase { cos: z, sin: height, circle: 1, multiple: 1, defect: INPUT + REST, error };
    Some(vec![phi, theta])
}
