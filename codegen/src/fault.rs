//! What is wrong with something, and what to do about it: the two halves of what a person is told. It knows neither what
//! was at fault nor how it is shown.

use std::fmt;

/// A fault in two sentences without their stops. As text it is one line, the two joined by a semicolon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong.
    pub message: String,
    /// What to do; empty if there is nothing to say.
    pub help: String,
}

impl Fault {
    /// A fault and its remedy.
    pub fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { message: message.into(), help: help.into() }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match self.help.is_empty() {
            true => Ok(()),
            false => write!(f, "; {}", self.help),
        }
    }
}

impl std::error::Error for Fault {}
