//! Proven bounds of the f32 rounding error of a kernel, in the measure of [`crate::promise::accuracy`]
//! (docs/MATH.md#rounding-bounds). What is bounded is the distance between the kernel's f32 result and the same formula
//! in exact arithmetic on the same f32 inputs.
//!
//! The domain is the kernel's documented one: unit vectors, quaternions, (cos, sin) pairs and rotation matrices whose
//! components were rounded to f32; n.z ≥ 0 for an exact tilt; angles to [`Spec::max_angle`] for an approximate rotation and
//! for a lifted one, whose given couplings are those of an angle, rounded to f32.
//! Left out are signals so small that products underflow, and where adding the tiny number does not help: a quaternion
//! with w (or y) within 1e-16 of −1e-15 and z (or x) below 1e-16; for `align` a normal whose x and y are below 2e-8 and not
//! both zero, where the tiny number turns the spin, which is open.
//!
//! The arithmetic is IEEE's: 1/x is rounded once and 1/√x twice; a contraction is one of [`crate::ir::eval::Contraction`]'s.
//! A shader compiler that flushes, reorders or takes a less exact inverse root is outside of it.
//!
//! Method: a band is cut where the kernel notes a stage ([`crate::ir::graph::Graph::stage`]); errors of stages add, each
//! multiplied by the exact norm of what follows. A stage falls into parts that do not mix. A plane that a phase turns is
//! bounded as a complex product ([`phases`]); any other part is run on enclosures with error weights ([`section`]) over a
//! grid of its one to three angles ([`region`] says why a grid proves it). Whatever is not recognised has no bound: so
//! roots that are not inverted, powers, logarithms, choices and products of signals
//! (docs/MATH.md#what-nothing-is-proven-of).

pub mod boxes;
mod lobes;
pub mod norm;
pub mod phases;
pub mod plain;
mod prover;
pub mod region;
pub mod roundoff;
pub mod section;
mod sweep;
mod uncut;
mod value;

use crate::families::family::{Acts, MAX_ORDER, Measure, Proof, Spec};
use crate::ir::code::Code;
use crate::ir::graph::Kind;
use crate::ir::listing::Listing;
use plain::plain;
use prover::Prover;
use roundoff::{Both, larger};

/// A kernel's proven f32 rounding bound, in the measure of [`crate::promise::accuracy`].
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Bound {
    /// Where a multiply-add is rounded twice.
    pub separate: f64,
    /// Where a multiply-add is rounded once.
    pub fused: f64,
    /// For a kernel that is measured band by band, the larger of both for each band.
    pub bands: Vec<f64>,
}

impl Bound {
    /// The larger of both contractions.
    pub fn value(&self) -> f64 {
        self.separate.max(self.fused)
    }

    fn of(bands: &[Both], is_banded: bool) -> Option<Self> {
        let [separate, fused] = bands.iter().copied().fold([0.0; 2], larger);
        let bands = if is_banded { bands.iter().map(|both| both[0].max(both[1])).collect() } else { vec![] };
        (separate.is_finite() && fused.is_finite()).then_some(Self { separate, fused, bands })
    }
}

/// Returns the bound of a spec's kernel in any form.
pub fn of(spec: &Spec, code: &Code) -> Option<Bound> {
    within(spec, code, None)
}

/// Returns the bound of a spec's kernel in any form, for an approximate rotation by at most `max_angle` radians, which is at
/// most [`Spec::max_angle`]. None where the proof takes too long or does not know what it meets.
pub fn within(spec: &Spec, code: &Code, max_angle: Option<f64>) -> Option<Bound> {
    let prove = |spec: &Spec, listing: &Listing| prove_within(spec, listing, max_angle);
    match code {
        Code::Straight(listing) => prove(spec, listing),
        Code::Branch(branch) => {
            let [below, above] = [prove(spec, &branch.below)?, prove(spec, &branch.above)?];
            let larger = |a: &f64, b: &f64| a.max(*b);
            Some(Bound {
                separate: larger(&below.separate, &above.separate),
                fused: larger(&below.fused, &above.fused),
                bands: below.bands.iter().zip(&above.bands).map(|(a, b)| larger(a, b)).collect(),
            })
        }
        // Beyond these orders the proof over a sphere takes longer than a build may.
        Code::Loop(_) if matches!(spec.family.measure, Measure::Absolute) && spec.order > MAX_ORDER => None,
        Code::Loop(kernel) => prove(spec, &plain(&Listing::from(kernel))?),
    }
}

/// Returns the bound of a spec's kernel, laid out. None for a listing whose set-up is not recognised.
pub fn prove(spec: &Spec, listing: &Listing) -> Option<Bound> {
    prove_within(spec, listing, spec.max_angle())
}

fn prove_within(spec: &Spec, listing: &Listing, max_angle: Option<f64>) -> Option<Bound> {
    // Products of signals are no maps of one signal, which is all that is bounded.
    if listing.result_kind == Kind::Product {
        return None;
    }
    let prover = Prover::new(spec, listing, max_angle)?;
    match (spec.proof(), spec.family.measure) {
        (Proof::Nothing, _) => None,
        (Proof::Lobes, _) => Bound::of(&prover.turned_lobes()?, true),
        (Proof::Auto, Measure::Absolute) => prover.scalars(&listing.outputs).and_then(|both| Bound::of(&[both], false)),
        (Proof::Auto, Measure::Whole) => prover.sum(&spec.bands).and_then(|both| Bound::of(&[both], false)),
        (Proof::Auto, Measure::Norm) => prover.vector().and_then(|both| Bound::of(&[both], false)),
        (Proof::Auto, Measure::Through(rotation)) => {
            let rotation = Listing::new(&rotation(spec.order));
            Bound::of(&prover.rotating(&rotation)?.bands()?, true)
        }
        (Proof::Auto, Measure::Bands) if spec.family.acts == Acts::Mixes => Bound::of(&prover.mixed()?, true),
        (Proof::Auto, Measure::Bands) => Bound::of(&prover.bands()?, true),
        (Proof::Auto, Measure::Added) => Bound::of(&prover.added()?, true),
        (Proof::Auto, Measure::Product) => None,
    }
}
