//! What a loop does, as straight lines would do it: without products by zero and sums with them, and with every sign in
//! the sum that takes it. For finite numbers nothing else is rounded, and no value but a zero changes its sign.

use crate::ir::listing::{Listing, Op, Operand, Sign, Step};
use crate::math::exact::Exact;

/// A value: nothing where it is zero, else an operand and whether its negation is meant.
type Signed = Option<(Operand, bool)>;

/// Returns a listing that computes what the given one does, but for the signs of its results; nothing where it does more
/// than arithmetic.
pub fn plain(listing: &Listing) -> Option<Listing> {
    let mut steps: Vec<Step> = Vec::new();
    let mut known: Vec<Signed> = Vec::new();
    for step in &listing.steps {
        let of = |operand: Operand| -> Signed {
            match operand {
                Operand::Step(place) => known[place],
                Operand::Const(place) if listing.constants[place].is_zero() => None,
                _ => Some((operand, false)),
            }
        };
        let mut push = |op, minus| {
            steps.push(Step { op, ..*step });
            Some((Operand::Step(steps.len() - 1), minus))
        };
        let negated = |value: Signed| value.map(|(operand, minus)| (operand, !minus));
        let mut sum = |a: Signed, b: Signed| match (a, b) {
            (None, other) | (other, None) => other,
            (Some((a, false)), Some((b, true))) => push(Op::Sub(a, b), false),
            (Some((a, true)), Some((b, false))) => push(Op::Sub(b, a), false),
            (Some((a, minus)), Some((b, _))) => push(Op::Add(a, b), minus),
        };
        let next = match step.op {
            Op::Neg(a) => negated(of(a)),
            Op::Add(a, b) => sum(of(a), of(b)),
            Op::Sub(a, b) => sum(of(a), negated(of(b))),
            Op::Mul(a, b) => of(a).zip(of(b)).and_then(|((a, p), (b, q))| push(Op::Mul(a, b), p != q)),
            Op::Fma(a, b, c, sign) => {
                let addend = if sign == Sign::MinusAddend { negated(of(c)) } else { of(c) };
                match (of(a).zip(of(b)), addend) {
                    (None, addend) => addend,
                    (Some(((a, p), (b, q))), addend) => {
                        let minus = (p != q) != (sign == Sign::MinusProduct);
                        match (minus, addend) {
                            (_, None) => push(Op::Mul(a, b), minus),
                            (false, Some((c, true))) => push(Op::Fma(a, b, c, Sign::MinusAddend), false),
                            (true, Some((c, false))) => push(Op::Fma(a, b, c, Sign::MinusProduct), false),
                            (_, Some((c, _))) => push(Op::Fma(a, b, c, Sign::Plus), minus),
                        }
                    }
                }
            }
            Op::Recip(a) => of(a).and_then(|(a, minus)| push(Op::Recip(a), minus)),
            Op::Rsqrt(a) => of(a).and_then(|(a, _)| push(Op::Rsqrt(a), false)),
            _ => return None,
        };
        known.push(next);
    }
    let zero = Operand::Const(listing.constants.len());
    let value = |operand: &Operand| match operand {
        Operand::Step(place) => known[*place].map_or(zero, |(operand, _)| operand),
        _ => *operand,
    };
    let all = |operands: &Vec<Operand>| operands.iter().map(value).collect();
    let (outputs, stages) = (all(&listing.outputs), listing.stages.iter().map(all).collect());
    let directions = listing.directions.iter().map(|xyz| xyz.each_ref().map(value)).collect();
    let constants = [&listing.constants[..], &[Exact::zero()]].concat();
    Some(Listing { steps, outputs, stages, directions, constants, ..listing.clone() })
}
