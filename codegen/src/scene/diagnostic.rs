//! What is wrong with something a person wrote, where it stands and what to do. It knows texts and places, nothing of
//! kernels; the command line draws it with a caret, a build script gets it as one line.

use crate::families::text::SpecError;
use crate::fault::Fault;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A text that a person wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// What errors call it: a path, or where an argument came from.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// Some bytes of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The text.
    pub source: Arc<Source>,
    /// The bytes; within the text.
    pub span: Range<usize>,
}

impl Place {
    /// The whole of a short text, as an argument is.
    pub fn whole(name: &str, text: &str) -> Self {
        let source = Source { name: name.to_owned(), text: text.to_owned() };
        Self { span: 0..text.len(), source: Arc::new(source) }
    }

    /// The text of the place.
    pub fn text(&self) -> &str {
        self.source.text.get(self.span.clone()).unwrap_or("")
    }

    /// Bytes of the string that stands at this place, quoted or not; the whole place if it is written with escapes.
    #[must_use]
    pub fn within(&self, value: &str, at: Range<usize>) -> Self {
        let start = match self.text() {
            text if text == value => 0,
            text if text.len() == value.len() + 2 && &text[1..text.len() - 1] == value => 1,
            _ => return self.clone(),
        };
        let span = self.span.start + start + at.start..self.span.start + start + at.end;
        Self { source: Arc::clone(&self.source), span }
    }

    /// The line and the column where the place starts, both from 1, columns counted in characters.
    pub fn line_column(&self) -> (usize, usize) {
        let text = &self.source.text;
        let mut start = self.span.start.min(text.len());
        while !text.is_char_boundary(start) {
            start -= 1;
        }
        let before = &text[..start];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        (line, column)
    }
}

/// What is wrong, where, and what to do.
#[derive(Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Where it stands, if it stands in a text.
    pub place: Option<Place>,
}

impl Diagnostic {
    /// A fault at a place.
    pub fn at(place: &Place, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { place: Some(place.clone()), ..Self::nowhere(message, help) }
    }

    /// A fault in a spec that stands alone, as an argument does. `name` is what errors call it.
    pub fn of_spec(name: &str, text: &str, error: SpecError) -> Self {
        let place = Place::whole(name, text);
        Self::at(&place.within(text, error.at), error.message, error.help)
    }

    /// What was found wrong with what a place names, as with a file.
    pub fn of(place: &Place, fault: impl Into<Fault>) -> Self {
        Self { place: Some(place.clone()), ..fault.into().into() }
    }

    /// A fault that stands in no text.
    pub fn nowhere(message: impl Into<String>, help: impl Into<String>) -> Self {
        Fault::new(message, help).into()
    }
}

/// The most characters of a message: what was found may be quoted in it, and may be of any length.
const MAX_MESSAGE: usize = 500;

/// The beginning and the end of a text that is too long to be read.
fn shortened(text: String) -> String {
    let count = text.chars().count();
    if count <= MAX_MESSAGE {
        return text;
    }
    let part = MAX_MESSAGE / 2;
    let begin: String = text.chars().take(part).collect();
    let end: String = text.chars().skip(count - part).collect();
    format!("{begin} ... {end}")
}

impl From<Fault> for Diagnostic {
    fn from(Fault { message, help }: Fault) -> Self {
        Self { message: shortened(message), help, place: None }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            let (line, column) = place.line_column();
            write!(f, "{}:{line}:{column}: ", place.source.name)?;
        }
        f.write_str(&self.message)?;
        match self.help.is_empty() {
            true => Ok(()),
            false => write!(f, "; {}", self.help),
        }
    }
}

/// As [`Display`](fmt::Display) writes it, since this is what a build script that returns the error shows.
impl fmt::Debug for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_in_characters_from_one() {
        let source = Arc::new(Source { name: "a.toml".to_owned(), text: "x = 1\nβ = \"ab\"\n".to_owned() });
        let place = Place { source, span: 11..15 };
        assert_eq!(place.text(), "\"ab\"");
        assert_eq!(place.line_column(), (2, 5));
        let inner = place.within("ab", 1..2);
        assert_eq!((inner.text(), inner.line_column()), ("b", (2, 7)));
        assert_eq!(place.within("a\tb", 0..1), place);
        let error = Diagnostic::at(&inner, "`b` is no letter", "write `a`");
        assert_eq!(format!("{error:?}"), "a.toml:2:7: `b` is no letter; write `a`");
    }

    #[test]
    fn messages_stay_readable() {
        let long = Diagnostic::nowhere(format!("`{}` is no name", "β".repeat(100_000)), "").to_string();
        assert!(long.chars().count() == MAX_MESSAGE + 5 && long.ends_with("ββ` is no name"), "{long}");
        let short = "β".repeat(MAX_MESSAGE);
        assert_eq!(Diagnostic::nowhere(short.clone(), "").to_string(), short);
    }
}
