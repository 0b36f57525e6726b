//! What the entries of every layout have in common: which numbers are refused, what is missing and how it is filled, and places
//! between them. It knows no layout.

use crate::fault::Fault;

/// The largest reflectance that is read, per steradian: what is above belongs to no surface.
pub const MAX_VALUE: f64 = 1e9;

/// The entries that a file lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Missing {
    /// How many entries there are of directions above the horizon.
    pub of: usize,
    /// How many of them had a channel below zero.
    pub filled: usize,
    /// How many of those have no other entry on their line, and are black.
    pub black: usize,
}

pub(super) fn refused(name: &str, message: impl std::fmt::Display, help: &str) -> Fault {
    Fault::new(format!("{name}: {message}"), help)
}

/// Checks the entries that were read, by rows of three channels: none is NaN, infinite or above [`MAX_VALUE`], and one at
/// least is above zero.
pub(super) fn checked(
    name: &str,
    place: impl Fn(usize) -> String,
    values: &[[f64; 3]],
) -> Result<Vec<[f32; 3]>, Fault> {
    let is_bad = |value: &[f64; 3]| value.iter().any(|x| !x.is_finite() || *x > MAX_VALUE);
    if let Some(at) = values.iter().position(is_bad) {
        let count = values.iter().filter(|value| is_bad(value)).count();
        let value = values[at].iter().find(|x| !x.is_finite() || **x > MAX_VALUE).copied().unwrap_or(f64::NAN);
        let message =
            format!("{count} of its {} entries are no reflectance, the first {value} at {}", values.len(), place(at));
        return Err(refused(name, message, "write finite numbers up to 1e9, and a negative one for what is missing"));
    }
    if !values.iter().flatten().any(|x| *x > 0.0) {
        return Err(refused(name, "no entry is above zero", "a surface that reflects nothing shows no light"));
    }
    Ok(values.iter().map(|value| value.map(|x| x as f32)).collect())
}

/// Gives what is missing on a line, the negative channels, the value of the nearest entry before it, else of the nearest behind
/// it; returns whether a channel had none at all, which is black then.
pub(super) fn filled(line: &mut [[f32; 3]]) -> bool {
    let mut is_empty = false;
    for channel in 0..3 {
        let Some(first) = line.iter().map(|entry| entry[channel]).find(|x| *x >= 0.0) else {
            line.iter_mut().for_each(|entry| entry[channel] = 0.0);
            is_empty = true;
            continue;
        };
        let mut last = first;
        for entry in line.iter_mut() {
            match entry[channel] >= 0.0 {
                true => last = entry[channel],
                false => entry[channel] = last,
            }
        }
    }
    is_empty
}

/// The place of a number between even marks: the mark below it, not the last, and how far it is from it, 0 to 1.
pub(super) fn between(place: f64, last: usize) -> (usize, f64) {
    let place = place.clamp(0.0, last as f64);
    let low = (place as usize).min(last.saturating_sub(1));
    (low, place - low as f64)
}
