//! The traits and small types that generated Rust stands on, from a template.

use tera::{Context, Tera};

/// Where generated Rust runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Std {
    /// In a crate that has `std`.
    Always,
    /// In a crate whose feature `std` says so, and which else has `libm`.
    ByFeature,
}

/// Returns the text of the module `real`.
///
/// # Panics
///
/// If the template is at fault, which a test would have found.
pub fn real(std: Std) -> String {
    let mut context = Context::new();
    context.insert("by_feature", &(std == Std::ByFeature));
    let text = Tera::default().render_str(zonal_templates::REAL, &context, false);
    text.unwrap_or_else(|error| panic!("the template of `real` is at fault: {error}"))
}
