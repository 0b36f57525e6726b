//! What is wrong with something, and what to do about it: the two halves of what a person is told. It knows neither what
//! was at fault nor how it is shown. And what was meant by a word that nobody knows.

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

fn suggest<'a>(got: &str, known: &[&'a str]) -> Option<&'a str> {
    let distance = |a: &str, b: &str| -> usize {
        let b: Vec<char> = b.chars().collect();
        let mut row: Vec<usize> = (0..=b.len()).collect();
        for (i, x) in a.chars().enumerate() {
            let mut before = row[0];
            row[0] = i + 1;
            for (j, y) in b.iter().enumerate() {
                let change = before + usize::from(x != *y);
                before = row[j + 1];
                row[j + 1] = change.min(row[j] + 1).min(before + 1);
            }
        }
        row[b.len()]
    };
    let best = known.iter().min_by_key(|name| distance(got, name))?;
    let longer = known.iter().find(|name| got.len() >= 3 && name.contains(got));
    let shorter = known.iter().filter(|name| name.len() >= 3 && got.starts_with(**name)).max_by_key(|name| name.len());
    match distance(got, best) {
        0 | 1 => Some(*best),
        // A word of which more than half is wrong was not mistyped.
        near @ (2 | 3) if near <= got.chars().count().div_ceil(2) => Some(*longer.unwrap_or(best)),
        _ => longer.or(shorter).copied(),
    }
}

/// "did you mean …", or the list of what is known.
pub(crate) fn hint(got: &str, known: &[&str]) -> String {
    match suggest(got, known) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("known are {}", known.join(", ")),
    }
}
