//! The gate: text that naga or syn does not accept is never written. It sees text and nothing else.

use crate::emit::dialect::Target;

/// Why a text was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the generated {target} of `{file}` is refused, which is a fault of zonal: {reason}")]
pub struct Invalid {
    /// The language.
    pub target: Target,
    /// The file.
    pub file: String,
    /// What the validator says.
    pub reason: String,
}

/// Parses and validates a file.
///
/// # Errors
///
/// What the validator says, with its place in the text.
pub fn validate(target: Target, file: &str, text: &str) -> Result<(), Invalid> {
    let reason = match target {
        Target::Wgsl => wgsl(text),
        Target::Glsl => glsl(text),
        Target::Rust => syn::parse_file(text).map(|_| ()).map_err(|error| {
            let start = error.span().start();
            format!("{error} at line {}, column {}", start.line, start.column + 1)
        }),
    };
    reason.map_err(|reason| Invalid { target, file: file.to_owned(), reason })
}

fn check(module: &naga::Module, text: &str) -> Result<(), String> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16)
        .validate(module)
        .map(|_| ())
        .map_err(|error| error.emit_to_string(text))
}

fn wgsl(text: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    check(&module, text)
}

/// A drop-in carries neither a version nor an entry point: both are added here.
fn glsl(text: &str) -> Result<(), String> {
    let whole = format!("#version 450\n{text}\nvoid main() {{}}\n");
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    let module =
        naga::front::glsl::Frontend::default().parse(&options, &whole).map_err(|error| error.emit_to_string(&whole))?;
    check(&module, &whole)
}
