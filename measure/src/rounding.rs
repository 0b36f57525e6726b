//! The rounding error of each kernel in f16, f32 and f64: the largest error of any band, relative to the band's norm,
//! over seeded inputs, the extremes among them, with products fused and not. f64 is measured against pairs of doubles.

use crate::numbers::Twin;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::families::Spec;
use zonal_codegen::families::family::Measure;
// Names a family: weights and samples of lobes are no signal whose bands could be compared.
use zonal_codegen::families::zhf::{ZHF_TAILORED, ZHF_WEIGHTS};
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::half::Half;
use zonal_codegen::promise::samples;

/// How many inputs a kernel is run on.
pub const SAMPLES: usize = 400;
const SEED: u64 = 0x0e55;

/// The rounding errors of a kernel; none where a result is no number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rounding {
    /// The spec.
    pub spec: String,
    /// The order.
    pub order: usize,
    /// In f16, every operation rounded.
    pub f16: Option<f64>,
    /// In f32.
    pub f32: Option<f64>,
    /// In f64.
    pub f64: Option<f64>,
}

/// The largest error of `Narrow` against `Wide`, on inputs that `Narrow` holds exactly.
fn worst<Narrow: Number, Wide: Number>(spec: &Spec, listing: &Listing) -> Option<f64> {
    let (narrow, wide) = (Program::<Narrow>::new(listing), Program::<Wide>::new(listing));
    let norm = |list: &[Wide]| list.iter().map(|x| x.to_f64() * x.to_f64()).sum::<f64>().sqrt();
    let mut worst = 0.0f64;
    for input in samples::inputs(&listing.params, SEED, SAMPLES, None) {
        let narrow_input: Vec<Vec<Narrow>> =
            input.iter().map(|list| list.iter().map(|&x| Narrow::from_f64(x)).collect()).collect();
        let wide_input: Vec<Vec<Wide>> =
            narrow_input.iter().map(|list| list.iter().map(|x| Wide::from_f64(x.to_f64())).collect()).collect();
        let wide_input: Vec<&[Wide]> = wide_input.iter().map(Vec::as_slice).collect();
        let narrow_input: Vec<&[Narrow]> = narrow_input.iter().map(Vec::as_slice).collect();
        let want = wide.run(&wide_input, Contraction::Fused);
        for contraction in [Contraction::Fused, Contraction::Separate] {
            let got = narrow.run(&narrow_input, contraction);
            let error: Vec<Wide> = got.iter().zip(&want).map(|(a, b)| Wide::from_f64(a.to_f64()) - *b).collect();
            for l in 0..spec.order {
                let band = l * l..(l + 1) * (l + 1);
                let relative = norm(&error[band.clone()]) / norm(&want[band]);
                if !relative.is_finite() {
                    return None;
                }
                worst = worst.max(relative);
            }
        }
    }
    Some(significant(worst))
}

fn of(spec: &Spec) -> Rounding {
    let listing = Listing::new(&spec.kernel());
    Rounding {
        spec: spec.to_string(),
        order: spec.order,
        f16: worst::<Half, f64>(spec, &listing),
        f32: worst::<f32, f64>(spec, &listing),
        f64: worst::<f64, Twin>(spec, &listing),
    }
}

/// The kernels whose result is a signal of n² coefficients, of what [`crate::costs`] has.
pub fn specs() -> Vec<Spec> {
    // Names a family: weights and samples of lobes are no signal whose bands could be compared.
    let is_signal = |spec: &Spec| ![&ZHF_WEIGHTS, &ZHF_TAILORED].contains(&spec.family);
    let whole = |spec: &Spec| spec.is_whole() && !matches!(spec.family.measure, Measure::Through(_)) && is_signal(spec);
    crate::costs::specs().into_iter().filter(whole).collect()
}

/// Every kernel of [`specs`].
pub fn measure(progress: &dyn Progress) -> Vec<Rounding> {
    each(progress, "rounding", &specs(), of)
}
