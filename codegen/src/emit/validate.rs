//! The gate: text that a language's own check does not accept is never written. It sees text and nothing else, and stands
//! open where this crate is built without its feature `check`.

use crate::emit::language::Target;

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

/// Parses and validates a file; without the feature `check` it accepts every text.
///
/// # Errors
///
/// What the validator says, with its place in the text.
pub fn validate(target: Target, file: &str, text: &str) -> Result<(), Invalid> {
    (target.check)(text).map_err(|reason| Invalid { target, file: file.to_owned(), reason })
}
