//! The extremes: what the kernels do where numbers get hard. High orders, poles, tiny angles, quaternions that are none,
//! rotations without end, coefficients at the ends of f32, ill-conditioned lobes. `tests/stability` asserts what the
//! report promises.

pub mod basis;
pub mod chain;
pub mod euler;
pub mod lobes;
pub mod recursion;
pub mod report;
pub mod rotation;
pub mod special;
pub mod truth;

use crate::Progress;
use serde::{Deserialize, Serialize};

/// All of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// The basis.
    pub basis: Vec<basis::Curve>,
    /// Rotations to order 64.
    pub rotation: Vec<rotation::Curve>,
    /// The derivative form of the recursion.
    pub derivatives: Vec<recursion::Derivatives>,
    /// The three angles of a rotation.
    pub euler: Vec<euler::Row>,
    /// The multiples of an angle.
    pub multiples: Vec<euler::Multiples>,
    /// Rotations in a row.
    pub chain: Vec<chain::Drift>,
    /// Special coefficients.
    pub special: Vec<special::Outcome>,
    /// Quaternions that are none.
    pub bent: Vec<special::Bent>,
    /// Lobe sets.
    pub lobes: Vec<lobes::Set>,
}

impl Stability {
    /// Measures.
    pub fn measure(progress: &dyn Progress) -> Self {
        let (special, bent) = special::measure(progress);
        Self {
            basis: basis::measure(progress),
            rotation: rotation::measure(progress),
            derivatives: recursion::measure(progress, &truth::sampled(1..=rotation::ORDER - 1)),
            euler: euler::measure(progress),
            multiples: euler::multiples(progress),
            chain: chain::measure(progress),
            special,
            bent,
            lobes: lobes::measure(progress),
        }
    }
}
