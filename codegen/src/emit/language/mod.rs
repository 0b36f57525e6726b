//! The languages that kernels are printed in, each in a file of its own, and the one list of them.

pub mod expression;
pub mod form;
pub mod glsl;
pub mod record;
pub mod rust;
pub mod shader;
pub mod wgsl;

pub use crate::emit::language::form::Form;
pub use crate::emit::language::glsl::GLSL;
pub use crate::emit::language::record::{Arrays, Language};
pub use crate::emit::language::rust::RUST;
pub use crate::emit::language::wgsl::WGSL;

/// A language that is asked for: one of [`ALL`], or one that a program brings along.
pub type Target = &'static Language;

/// The languages that zonal knows by name, in the order in which they are listed.
pub static ALL: [Target; 3] = [&WGSL, &GLSL, &RUST];

/// Returns the names of all languages.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|language| language.name).collect()
}

/// Returns the language of this name.
///
/// # Errors
///
/// If there is none: a sentence that lists those that there are.
pub fn named(name: &str) -> Result<Target, String> {
    let known = ALL.into_iter().find(|language| language.name == name);
    known.ok_or_else(|| format!("`{name}` is no target; known are {}", names().join(", ")))
}

/// Sorts languages as they are listed, those that are not known by name last, and leaves out what stands twice.
pub fn sort(targets: &mut Vec<Target>) {
    targets.sort_by_key(|target| (ALL.iter().position(|known| known == target).unwrap_or(ALL.len()), target.name));
    targets.dedup();
}

/// Returns the names of all forms of files, each once.
pub fn forms() -> Vec<&'static str> {
    let mut names: Vec<&str> = ALL.iter().flat_map(|language| language.forms).map(|form| form.name).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Returns the languages that have something, as the subject of a sentence: "only WGSL has", "only WGSL and GLSL have".
pub fn only(has: impl Fn(&Language) -> bool) -> String {
    let titles: Vec<&str> = ALL.iter().filter(|language| has(language)).map(|language| language.title).collect();
    match &titles[..] {
        [] => "no language has".to_owned(),
        [one] => format!("only {one} has"),
        [others @ .., last] => format!("only {} and {last} have", others.join(", ")),
    }
}
