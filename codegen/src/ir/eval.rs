//! The interpreter: runs a [`Listing`] in f16, f32 or f64, operation by operation, so that what the printers write can be
//! checked against it bit for bit.

use crate::ir::listing::{Listing, Operand};
use crate::ir::op::{Op, Sign};
use crate::math::exact::Exact;
use crate::math::half::Half;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating-point type that the interpreter runs in.
pub trait Number:
    Copy
    + Debug
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One.
    const ONE: Self;
    /// Zero.
    const ZERO: Self;
    /// What [`crate::ir::graph::Node::Tiny`] stands for.
    const TINY: Self;
    /// Half the distance from one to the next number: the unit roundoff.
    const UNIT_ROUNDOFF: f64;
    /// The number nearest to an exact value.
    fn nearest(value: &Exact) -> Self;
    /// The number nearest to an f64.
    fn from_f64(value: f64) -> Self;
    /// Returns the number as f64, which holds it exactly.
    fn to_f64(self) -> f64;
    /// √self.
    fn root(self) -> Self;
    /// self · b + c, rounded once.
    fn fused(self, b: Self, c: Self) -> Self;
    /// 2 to the power self, as exact as the platform's of f64 is, or that of f32 for an f32.
    fn exp2(self) -> Self {
        Self::from_f64(self.to_f64().exp2())
    }
    /// The logarithm to the base 2, as exact as the platform's of f64 is, or that of f32 for an f32.
    fn log2(self) -> Self {
        Self::from_f64(self.to_f64().log2())
    }
    /// `c` where `a` is less than `b`, else `d`, also where `a` or `b` is not a number.
    fn choose(a: Self, b: Self, c: Self, d: Self) -> Self {
        if a < b { c } else { d }
    }
    /// |self|.
    fn abs(self) -> Self {
        // The sum takes the sign off −0 and changes nothing else.
        Self::choose(self, Self::ZERO, -self, self + Self::ZERO)
    }
}

macro_rules! number {
    ($float:ident, $to:ident, $tiny:literal, $roundoff:expr) => {
        impl Number for $float {
            const ONE: Self = 1.0;
            const ZERO: Self = 0.0;
            const TINY: Self = $tiny;
            const UNIT_ROUNDOFF: f64 = $roundoff;
            fn nearest(value: &Exact) -> Self {
                value.$to()
            }
            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn root(self) -> Self {
                self.sqrt()
            }
            #[inline]
            fn fused(self, b: Self, c: Self) -> Self {
                self.mul_add(b, c)
            }
            #[inline]
            fn exp2(self) -> Self {
                self.exp2()
            }
            #[inline]
            fn log2(self) -> Self {
                self.log2()
            }
        }
    };
}

impl Number for Half {
    const ONE: Self = Self::ONE;
    const ZERO: Self = Self::ZERO;
    const TINY: Self = Self::ZERO;
    const UNIT_ROUNDOFF: f64 = 1.0 / 2048.0;
    fn nearest(value: &Exact) -> Self {
        Self::round(value.to_f64())
    }
    fn from_f64(value: f64) -> Self {
        Self::round(value)
    }
    fn to_f64(self) -> f64 {
        self.to_f64()
    }
    fn root(self) -> Self {
        Self::round(self.to_f64().sqrt())
    }
    fn fused(self, b: Self, c: Self) -> Self {
        Self::round(self.to_f64() * b.to_f64() + c.to_f64())
    }
}

number!(f32, to_f32, 1e-15, f32::EPSILON as f64 / 2.0);
number!(f64, to_f64, 1e-30, f64::EPSILON / 2.0);

/// Whether a multiply-add is rounded once or twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contraction {
    /// Once, as an fma instruction does.
    Fused,
    /// Twice: a product, then a sum.
    Separate,
}

/// A listing with its constants rounded to `T`.
#[derive(Clone, Debug)]
pub struct Program<T> {
    listing: Listing,
    constants: Vec<T>,
}

impl<T: Number> Program<T> {
    /// Rounds the constants of a listing.
    pub fn new(listing: &Listing) -> Self {
        Self { listing: listing.clone(), constants: listing.constants.iter().map(T::nearest).collect() }
    }

    /// The listing that is run.
    pub fn listing(&self) -> &Listing {
        &self.listing
    }

    /// Runs it for one channel. `inputs` holds one slice a parameter, of as many numbers as its shape says; the result
    /// has as many numbers as the kernel's.
    ///
    /// # Panics
    ///
    /// If a slice is shorter than its parameter's shape.
    pub fn run(&self, inputs: &[&[T]], contraction: Contraction) -> Vec<T> {
        let mut values: Vec<T> = Vec::with_capacity(self.listing.steps.len());
        for step in &self.listing.steps {
            let value = apply(step.op.map(|operand| self.get(operand, &values, inputs)), contraction);
            values.push(value);
        }
        self.listing.outputs.iter().map(|&operand| self.get(operand, &values, inputs)).collect()
    }

    fn get(&self, operand: Operand, values: &[T], inputs: &[&[T]]) -> T {
        match operand {
            Operand::Step(place) => values[place],
            Operand::Const(place) => self.constants[place],
            Operand::Tiny => T::TINY,
            Operand::Input { param, index } => inputs[param][index],
        }
    }
}

/// Does one operation.
fn apply<T: Number>(op: Op<T>, contraction: Contraction) -> T {
    match op {
        Op::Neg(a) => -a,
        Op::Add(a, b) => a + b,
        Op::Sub(a, b) => a - b,
        Op::Mul(a, b) => a * b,
        Op::Fma(a, b, c, sign) => match (contraction, sign) {
            (Contraction::Fused, Sign::Plus) => a.fused(b, c),
            (Contraction::Fused, Sign::MinusAddend) => a.fused(b, -c),
            (Contraction::Fused, Sign::MinusProduct) => (-a).fused(b, c),
            (Contraction::Separate, Sign::Plus) => a * b + c,
            (Contraction::Separate, Sign::MinusAddend) => a * b - c,
            (Contraction::Separate, Sign::MinusProduct) => c - a * b,
        },
        Op::Recip(a) => T::ONE / a,
        Op::Rsqrt(a) => T::ONE / a.root(),
        Op::Sqrt(a) => a.root(),
        Op::Exp2(a) => a.exp2(),
        Op::Log2(a) => a.log2(),
        Op::Abs(a) => a.abs(),
        Op::Min(a, b) => T::choose(b, a, b, a),
        Op::Max(a, b) => T::choose(a, b, b, a),
        Op::Select(a, b, c, d) => T::choose(a, b, c, d),
    }
}
