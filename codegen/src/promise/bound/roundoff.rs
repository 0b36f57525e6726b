//! The numbers that a proof is made of: f32's unit roundoff, what an input is off by, and bounds in both contractions.

use crate::ir::eval::Number;

/// f32's unit roundoff.
pub const U: f64 = f32::UNIT_ROUNDOFF;
/// An f32 input may differ from a unit phase's, vector's or quaternion's component by so much, relative to it.
pub const INPUT: f64 = U * 1.001;

/// A bound for each [`crate::ir::eval::Contraction`]: separate, fused.
pub type Both = [f64; 2];

/// The larger of two bounds; what is not a number is no bound.
pub fn larger_of(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The larger of each.
pub fn larger(a: Both, b: Both) -> Both {
    [larger_of(a[0], b[0]), larger_of(a[1], b[1])]
}
