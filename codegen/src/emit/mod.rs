//! Text: a module of functions in one language. Templates lay out what people read and hold no mathematics; the lines of
//! the bodies come finished from the listing. What a language is stands in its own file below `language`.

pub mod bands;
pub mod body;
pub mod dialect;
pub mod docs;
mod function;
mod generic;
pub mod language;
pub mod loop_body;
pub mod module;
pub mod names;
mod parts;
mod plain;
pub mod support;
pub mod validate;

pub use crate::emit::module::{Constants, Function, Limit, Module};

use crate::emit::language::Target;

impl Module {
    /// Returns the text of the module as one file that stands alone.
    ///
    /// # Errors
    ///
    /// If a function is too long for the language's compilers, or the language cannot do what is asked of it.
    pub fn text(&self, target: Target) -> Result<String, Limit> {
        match target.generic {
            Some(_) => self.rust_alone(),
            None => self.plain(target),
        }
    }
}
