//! The traits and small types that generated Rust stands on, from a template.

use serde::Serialize;
use tera::{Context, Tera};

/// Where generated Rust runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Std {
    /// In a crate that has `std`.
    Always,
    /// In a crate whose feature `std` says so, and which else has `libm`.
    ByFeature,
}

/// The functions that are taken from `std` or `libm`, which have a name of their own for f32.
const FUNCTIONS: [Taken; 3] =
    [Taken { name: "root", of: "sqrt" }, Taken { name: "exp2", of: "exp2" }, Taken { name: "log2", of: "log2" }];

/// Where a multiply-add of numbers is one instruction: on x86-64 if it is asked for, on aarch64 always.
const FUSED: &str = "any(target_feature = \"fma\", all(target_arch = \"aarch64\", target_feature = \"neon\"))";

/// A function of `Real` and what it is called where it is taken from.
#[derive(Serialize)]
struct Taken {
    name: &'static str,
    of: &'static str,
}

/// Returns the text of the module `real`.
///
/// # Panics
///
/// If the template is at fault, which a test would have found.
pub fn real(std: Std) -> String {
    let mut context = Context::new();
    context.insert("by_feature", &(std == Std::ByFeature));
    // `core` has no multiply-add of numbers, and that of `libm` is a call.
    let fused = match std {
        Std::Always => FUSED.to_owned(),
        Std::ByFeature => format!("all(feature = \"std\", {FUSED})"),
    };
    context.insert("fused", &fused);
    context.insert("functions", &FUNCTIONS);
    let text = Tera::default().render_str(zonal_templates::REAL, &context, false);
    text.unwrap_or_else(|error| panic!("the template of `real` is at fault: {error}"))
}
