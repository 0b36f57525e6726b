//! Hemispherical harmonics (Gautron et al. 2004): the basis and sums over it, conversions from and to the sphere's, rotations.
//! docs/MATH.md#hemispherical-harmonics has the formulas, docs/MATH.md#rotation-on-the-hemisphere what a rotation may mean.

pub mod convert;
pub mod evaluate;
pub mod gradient;
pub mod methods;
pub mod rotate;
pub mod shears;
pub mod table;

use crate::families::family::{Family, Group};
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Shape};
use crate::math::hemisphere::{Below, HIGHEST_ORDER};

/// What the families of this folder have in common.
const COMMON: Family = Family {
    group: Group::Hemisphere,
    orders: 2..=HIGHEST_ORDER,
    outside: |order| {
        let help = format!("hemispherical harmonics have orders 2 to {HIGHEST_ORDER}");
        [format!("order {order} is too long for the hemisphere"), help]
    },
    half: false,
    ..Family::PLAIN
};

/// Declares the signal `c` of n² hemispherical coefficients.
fn signal(builder: &mut Builder, order: usize) -> Vec<Id> {
    builder.param("c", Shape::Array(order * order), Domain::Signal, "the hemispherical coefficients, index l(l+1)+m")
}

/// What a function is below the horizon, in a sentence's words.
fn in_words(below: Below) -> &'static str {
    match below {
        Below::Zero => "a lobe, which vanishes below the horizon",
        Below::GoesOn => "a record of radiance, which goes on below the horizon",
    }
}
