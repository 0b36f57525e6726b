//! The error of a section's scalars by the derivatives of what is wanted, which keeps the signs that bounds of single steps
//! lose.

use super::{REFUSED, Run, Section, Slot, place};
use crate::ir::graph::Kind;
use crate::ir::listing::{Op, Operand, Sign};
use crate::promise::bound::norm::SLACK;
use crate::promise::bound::roundoff::{Both, larger};
use crate::promise::bound::value::{EPSILON, UNDERFLOW};

impl Section {
    /// The scalars that are outputs or factors of the signal, but for those that are made in one step: their errors are
    /// what [`Section::run`] first finds.
    pub(super) fn wanted(&self) -> Vec<usize> {
        let is_made = |slot: usize| matches!(self.slots[slot], Slot::Step(_)) && self.kinds[slot] == Kind::Scalar;
        let mut wanted = self.outputs.clone();
        for (at, slot) in self.slots.iter().enumerate() {
            if let (Slot::Step(op), Kind::Signal) = (slot, self.kinds[at]) {
                wanted.extend(op.operands().map(place));
            }
        }
        wanted.sort_unstable();
        wanted.dedup();
        wanted.retain(|&slot| match self.slots[slot] {
            Slot::Step(op) => is_made(slot) && op.operands().any(|operand| is_made(place(operand))),
            _ => false,
        });
        wanted
    }

    /// What some scalars are made of, themselves among it, last step first.
    pub(super) fn cone(&self, slots: &[usize]) -> Vec<usize> {
        let mut cone: Vec<usize> = Vec::new();
        let mut stack = slots.to_vec();
        while let Some(slot) = stack.pop() {
            if !cone.contains(&slot) {
                cone.push(slot);
                if let Slot::Step(op) = self.slots[slot] {
                    stack.extend(op.operands().map(place));
                }
            }
        }
        cone.sort_unstable_by(|a, b| b.cmp(a));
        cone
    }

    /// The error of a sum of scalars, each times a number, by what every step rounds times the sum's derivative by it.
    /// Errors on the way keep their signs, so that what cancels does; what errors do to each other is bounded by the
    /// scalars' own bounds. `cone` is what the scalars are made of.
    pub(super) fn toward(&self, sum: &[(usize, f64)], cone: &[usize], roundoff: f64, run: &mut Run) -> Both {
        let Run { scalars, derivative, .. } = run;
        for &(slot, factor) in sum {
            derivative[slot].0 += factor;
        }
        let mut total = [0.0; 2];
        for &at in cone {
            let (mid, radius) = std::mem::take(&mut derivative[at]);
            let size = mid.abs() + radius;
            if size == 0.0 {
                continue;
            }
            let of = |operand: Operand| scalars[place(operand)];
            let value = scalars[at];
            let mut pass = |to: Operand, by: f64, loose: f64| {
                let (m, r) = &mut derivative[place(to)];
                let change = mid * by;
                *m += change;
                *r += mid.abs() * loose + radius * (by.abs() + loose) + (change.abs() + m.abs()) * EPSILON;
            };
            // What rounding once adds in each mode, besides the product of errors.
            // The value before it was rounded is at most as much larger than what it is rounded to.
            let unit = roundoff * (1.0 + 4.0 * roundoff);
            let once = |mode: usize| unit * (value.magnitude() + value.error[mode]) + UNDERFLOW;
            let mut fresh = [0.0; 2];
            match self.slots[at] {
                Slot::Constant { .. } | Slot::Start(_) => fresh = value.error,
                Slot::Signal(_) => return [f64::INFINITY; 2],
                Slot::Step(op) => match op {
                    Op::Neg(a) => pass(a, -1.0, 0.0),
                    Op::Add(a, b) | Op::Sub(a, b) => {
                        pass(a, 1.0, 0.0);
                        pass(b, if matches!(op, Op::Sub(..)) { -1.0 } else { 1.0 }, 0.0);
                        fresh = [once(0), once(1)];
                    }
                    Op::Mul(a, b) | Op::Fma(a, b, _, _) => {
                        let (x, y) = (of(a), of(b));
                        let (sign, fused) = match op {
                            Op::Fma(_, _, c, sign) => {
                                pass(c, if sign == Sign::MinusAddend { -1.0 } else { 1.0 }, 0.0);
                                (if sign == Sign::MinusProduct { -1.0 } else { 1.0 }, true)
                            }
                            _ => (1.0, false),
                        };
                        pass(a, sign * y.mid, y.radius);
                        pass(b, sign * x.mid, x.radius);
                        let exact = self.is_power(place(a)) || self.is_power(place(b));
                        let product = x.times(y);
                        for mode in 0..2 {
                            fresh[mode] = x.error[mode] * y.error[mode];
                            if !exact && (!fused || mode == 0) {
                                fresh[mode] += roundoff * (product.magnitude() + product.error[mode]) + UNDERFLOW;
                            }
                            if fused {
                                fresh[mode] += once(mode);
                            }
                        }
                    }
                    Op::Recip(a) => {
                        let (slope, loose, rest) = of(a).slope(1.0);
                        pass(a, slope, loose);
                        fresh = std::array::from_fn(|mode| rest[mode] + once(mode));
                    }
                    Op::Rsqrt(a) => {
                        let (slope, loose, rest) = of(a).slope(0.5);
                        pass(a, slope, loose);
                        fresh = std::array::from_fn(|mode| rest[mode] + (2.0 + 8.0 * roundoff) * once(mode));
                    }
                    _ => unreachable!("{REFUSED}"),
                },
            }
            for mode in 0..2 {
                total[mode] += size * fresh[mode];
            }
        }
        total.map(|error| error * SLACK)
    }

    /// The largest error of one or two outputs, which are scalars, taken together as one vector.
    pub fn error_together(&self, run: &mut Run, roundoff: f64) -> Both {
        const DIRECTIONS: usize = 16;
        let [x, y] = match self.outputs[..] {
            [x] => return self.toward(&[(x, 1.0)], &self.cone(&[x]), roundoff, run),
            [x, y] => [x, y],
            _ => return [f64::INFINITY; 2],
        };
        let cone = self.cone(&[x, y]);
        let mut worst = [0.0; 2];
        for i in 0..DIRECTIONS {
            let (sin, cos) = (std::f64::consts::PI * i as f64 / DIRECTIONS as f64).sin_cos();
            worst = larger(worst, self.toward(&[(x, cos), (y, sin)], &cone, roundoff, run));
        }
        // Between two directions a vector's longest component is at most that much longer.
        worst.map(|error| error / (std::f64::consts::PI / (2 * DIRECTIONS) as f64).cos() * SLACK)
    }
}
