//! A spec's kernel: built, laid out, counted and measured, once for all languages.

use crate::families::family::Spec;
use crate::ir::code::Code;
use crate::promise::accuracy::{Accuracy, round_up};
use crate::promise::proofs;

/// A kernel that is ready to print.
#[derive(Clone, Debug)]
pub struct Built {
    /// What was asked for.
    pub spec: Spec,
    /// Its operations.
    pub code: Code,
    /// How exact it is.
    pub accuracy: Accuracy,
}

impl Built {
    /// Builds, lays out and measures.
    pub fn new(spec: &Spec) -> Self {
        let code = spec.code();
        let accuracy = Accuracy::of(spec, &code);
        Self { spec: spec.clone(), code, accuracy }
    }

    /// Builds and lays out a piece of a kernel, which is as exact as the whole: together they do the same operations.
    pub fn piece(spec: &Spec, whole: &Self) -> Self {
        Self { spec: spec.clone(), code: spec.code(), accuracy: whole.accuracy.clone() }
    }

    /// What rounding may add up to an angle in radians; for a small rotation in f32 that is less than the head says, which
    /// is for the method's whole domain.
    pub fn rounding_within(&self, max_angle: f64) -> f64 {
        let whole = self.accuracy.rounding_f32;
        match self.spec.max_angle() {
            Some(limit) if !self.spec.half => {
                let within = proofs::bound_within(&self.spec, &self.code, Some(limit.min(max_angle)));
                within.map_or(whole, |bound| round_up(bound.value()))
            }
            _ => whole,
        }
    }
}
