//! What each rotation kernel costs: operations, constants, live values, bytes of shader text.

use crate::{Progress, each};
use serde::{Deserialize, Serialize};
use zonal_codegen::catalog;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::dialect::Target;
use zonal_codegen::families::spec::{Family, Form, Spec};
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
    /// The same for three channels.
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
    let turns = |spec: &Spec| {
        let family = &spec.family;
        !matches!(family, Family::Eval | Family::SwapYz | Family::EvalMonomial | Family::ToMonomial)
            && !matches!(family, Family::TiltScale | Family::TiltUnscale)
    };
    catalog::standard().into_iter().filter(|spec| !spec.rgb && spec.form == Form::Unrolled && turns(spec)).collect()
}

fn of(spec: &Spec) -> Costs {
    let function = generate::build(std::slice::from_ref(spec)).remove(0);
    let listing = Listing::new(&zonal_codegen::promise::built::kernel(spec));
    let Cost { mul, fma, special, total, .. } = listing.cost(1);
    let footprint = listing.footprint();
    let module = Module {
        name: function.shader_name(),
        origin: format!("`{spec}`"),
        functions: vec![function],
        constants: vec![],
    };
    let bytes = |target| module.shader(target).map_or(0, |text| text.len());
    Costs {
        spec: spec.to_string(),
        order: spec.order,
        operations: total,
        operations_rgb: listing.cost(3).total,
        products: mul + fma,
        special,
        constants: footprint.constants,
        live: footprint.live,
        wgsl: bytes(Target::Wgsl),
        glsl: bytes(Target::Glsl),
    }
}

/// Every kernel of [`specs`].
pub fn measure(progress: &dyn Progress) -> Vec<Costs> {
    each(progress, "costs", &specs(), of)
}
