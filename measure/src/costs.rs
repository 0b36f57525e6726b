//! What each rotation kernel costs: operations, constants, live values, bytes of shader text.

use crate::{Progress, each};
use serde::{Deserialize, Serialize};
use zonal_codegen::catalog;
use zonal_codegen::emit::Module;
// Names a language: bytes are counted of these.
use zonal_codegen::emit::language::{GLSL, WGSL};
// Names a family: these neither turn a signal nor serve one that does.
use zonal_codegen::families::axis::SWAP_YZ;
use zonal_codegen::families::basis::{EVAL, EVAL_ONCE};
use zonal_codegen::families::family::Measure;
use zonal_codegen::families::monomial::{EVAL_MONOMIAL, TO_MONOMIAL};
use zonal_codegen::families::tilt::{TILT_SCALE, TILT_UNSCALE};
use zonal_codegen::families::{Family, Form, Group, Spec};
use zonal_codegen::generate;
use zonal_codegen::ir::listing::{Cost, Listing};

/// What a kernel costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// The spec.
    pub spec: String,
    /// The order.
    pub order: usize,
    /// Multiplications, additions and multiply-adds for one channel.
    pub operations: usize,
    /// Multiplications, additions and multiply-adds for three channels.
    pub operations_rgb: usize,
    /// Multiplications and multiply-adds for one channel: what Nowrouzezahrai et al. 2012 count.
    pub products: usize,
    /// Inverse square roots and reciprocals.
    pub special: usize,
    /// Distinct constants.
    pub constants: usize,
    /// The most values that are alive at once.
    pub live: usize,
    /// Bytes of its WGSL file.
    pub wgsl: usize,
    /// Bytes of its GLSL file.
    pub glsl: usize,
}

/// The kernels that turn a signal, in the order of the catalogue.
pub fn specs() -> Vec<Spec> {
    const OTHERS: [&Family; 7] =
        [&EVAL, &EVAL_ONCE, &SWAP_YZ, &EVAL_MONOMIAL, &TO_MONOMIAL, &TILT_SCALE, &TILT_UNSCALE];
    const TURNING: [Group; 6] =
        [Group::Evaluate, Group::Rotate, Group::Tilt, Group::SmallAngle, Group::Factorise, Group::Piece];
    let is_other = |spec: &Spec| {
        !TURNING.contains(&spec.family.group) || matches!(spec.family.measure, Measure::Product | Measure::Whole)
    };
    let turns = |spec: &Spec| !OTHERS.contains(&spec.family) && !is_other(spec);
    catalog::standard().into_iter().filter(|spec| !spec.rgb && spec.form == Form::Unrolled && turns(spec)).collect()
}

fn of(spec: &Spec) -> Costs {
    let function = generate::build(std::slice::from_ref(spec)).remove(0);
    let listing = Listing::new(&spec.kernel());
    let Cost { mul, fma, special, total, .. } = listing.cost(1);
    let footprint = listing.footprint();
    let module = Module::of(function);
    let bytes = |target| module.text(target).map_or(0, |text| text.len());
    Costs {
        spec: spec.to_string(),
        order: spec.order,
        operations: total,
        operations_rgb: listing.cost(3).total,
        products: mul + fma,
        special,
        constants: footprint.constants,
        live: footprint.live,
        wgsl: bytes(&WGSL),
        glsl: bytes(&GLSL),
    }
}

/// Every kernel of [`specs`].
pub fn measure(progress: &dyn Progress) -> Vec<Costs> {
    each(progress, "costs", &specs(), of)
}
