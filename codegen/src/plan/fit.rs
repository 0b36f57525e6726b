//! Kernels within the registers that a scene allows: whole, or in pieces, or in pieces a channel after the other. Without
//! such a limit a kernel stays whole, and what it lacks on RDNA 2 is said.

use crate::families::family::Spec;
use crate::promise::registers::{Called, MOST, Registers, registers};
use crate::scene::Located;
use crate::scene::diagnostic::Diagnostic;

/// The ways to call a kernel, from the simplest to the one that takes the fewest registers.
const WAYS: [Called; 3] = [Called::Whole, Called::Pieces, Called::Channels];

/// A kernel's registers, called in some way.
type Way = (Called, Registers);

fn number(found: Registers) -> String {
    let about = if found.measured { "" } else { "about " };
    format!("{about}{} registers", found.needed())
}

fn words((called, found): &Way) -> String {
    let number = number(*found);
    match called {
        Called::Whole => format!("whole {number}"),
        Called::Pieces => format!("in pieces {number}"),
        Called::Channels => format!("in pieces of one channel, called for a channel after the other, {number}"),
        Called::Memory => format!("in pieces of one channel with `arrays = \"memory\"` {number}"),
    }
}

/// Returns the simplest way to call a kernel that takes no more registers; all ways if none does.
pub(super) fn within(spec: &Spec, most: usize) -> Result<Way, Vec<Way>> {
    let mut tried = Vec::new();
    for called in WAYS {
        let Some(found) = registers(spec, called) else { continue };
        if found.needed() <= most {
            return Ok((called, found));
        }
        tried.push((called, found));
    }
    Err(tried)
}

/// Returns how many registers a kernel takes at least, called in any way, if that is more than so many.
pub(super) fn least_beyond(spec: &Spec, most: usize) -> Option<usize> {
    let tried = within(spec, most).err()?;
    tried.iter().map(|(_, found)| found.needed()).min()
}

/// The specs that a kernel is printed as within the registers that a scene allows, and why if that is not the kernel
/// itself.
///
/// # Errors
///
/// If it takes more registers, however it is called.
pub(super) fn fitted(spec: &Spec, most: &Located<usize>) -> Result<(Vec<Spec>, Option<String>), Diagnostic> {
    let (called, found) = within(spec, most.value).map_err(|tried| {
        let ways: Vec<String> = tried.iter().map(words).collect();
        let least = tried.iter().map(|(_, found)| found.needed()).min().unwrap_or_default();
        let message = format!("`{spec}` takes {}, and the scene allows {}", ways.join(", "), most.value);
        let help = match least <= MOST {
            true => format!("allow {least} at least, or take a lower order"),
            false => format!("take a lower order: RDNA 2 has no more than {MOST} for a thread"),
        };
        Diagnostic::at(&most.place, message, help)
    })?;
    let why = |whole: Registers| {
        let [whole, pieces] = [(Called::Whole, whole), (called, found)].map(|way| words(&way));
        format!(
            "a piece of `{spec}`, which takes {whole} on RDNA 2, where the scene allows {}, and {pieces}",
            most.value
        )
    };
    let why = registers(spec, Called::Whole).map(why);
    Ok(match called {
        Called::Whole => (vec![spec.clone()], None),
        Called::Pieces => (spec.in_pieces(), why),
        Called::Channels | Called::Memory => (spec.base().in_pieces(), why),
    })
}

/// Returns what a kernel lacks on RDNA 2 if it is called whole, and what to do, as the rest of a sentence.
pub(super) fn spilled(spec: &Spec) -> Option<String> {
    let whole = registers(spec, Called::Whole).filter(|whole| whole.spilled > 0)?;
    let about = if whole.measured { "" } else { "about " };
    let mut text = format!("on RDNA 2 memory stands in for {about}{} of its registers", whole.spilled);
    let mut others: Vec<Way> =
        WAYS[1..].iter().filter_map(|&called| Some((called, registers(spec, called)?))).collect();
    if others.iter().all(|(_, found)| found.spilled > 0) {
        others.extend(registers(spec, Called::Memory).map(|found| (Called::Memory, found)));
    }
    if !others.is_empty() {
        let ways: Vec<String> = others.iter().map(words).collect();
        text += &format!("; `{spec}:pieces`: {}", ways.join(", "));
    }
    Some(text)
}
