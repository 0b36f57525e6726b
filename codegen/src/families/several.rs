//! A text that names several specs: `rotate:8:pieces` stands for the set-up of `rotate:8` and its bands.

use crate::families::family::Spec;
use crate::families::pieces::{NO_PIECES, PIECES};
use crate::families::text::SpecError;

/// Returns the specs that a text names: one, or with `pieces` those of a kernel that leaves bands apart.
///
/// # Errors
///
/// As a spec's, or if the kernel has no pieces.
pub fn several(text: &str) -> Result<Vec<Spec>, SpecError> {
    let option = format!(":{PIECES}");
    let found = text.match_indices(&option).map(|(at, _)| at..at + option.len());
    let Some(cut) = found.into_iter().find(|cut| matches!(text[cut.end..].chars().next(), None | Some(':'))) else {
        return Ok(vec![text.parse()?]);
    };
    let rest = [&text[..cut.start], &text[cut.end..]].concat();
    // What is wrong with the rest is said of the place where it stands.
    let moved = |at: usize| if at > cut.start { at + cut.len() } else { at };
    let spec: Spec = rest
        .parse()
        .map_err(|error: SpecError| SpecError { at: moved(error.at.start)..moved(error.at.end), ..error })?;
    let pieces = if spec.form.is_piece() { vec![] } else { spec.in_pieces() };
    let none = || SpecError {
        message: format!("`{rest}` has no pieces"),
        help: NO_PIECES.to_owned(),
        at: cut.start + 1..cut.end,
    };
    if pieces.is_empty() { Err(none()) } else { Ok(pieces) }
}
