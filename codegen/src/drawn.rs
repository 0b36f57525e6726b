//! How a diagnostic is drawn for the person in front of a terminal.

use crate::scene::diagnostic::Diagnostic;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use std::fmt;
use std::io::{self, IsTerminal};

/// A diagnostic as miette draws it.
struct Drawn<'a> {
    diagnostic: &'a Diagnostic,
    source: Option<NamedSource<String>>,
}

impl<'a> Drawn<'a> {
    fn new(diagnostic: &'a Diagnostic) -> Self {
        let source =
            diagnostic.place.as_ref().map(|place| NamedSource::new(&place.source.name, place.source.text.clone()));
        Self { diagnostic, source }
    }
}

impl fmt::Display for Drawn<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl fmt::Debug for Drawn<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Drawn<'_> {}

impl miette::Diagnostic for Drawn<'_> {
    fn help(&self) -> Option<Box<dyn fmt::Display + '_>> {
        (!self.diagnostic.help.is_empty()).then(|| Box::new(&self.diagnostic.help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let place = self.diagnostic.place.as_ref()?;
        // Of a fault that spans lines the first is enough.
        let line = place.text().lines().next().unwrap_or("").len();
        let label = LabeledSpan::underline((place.span.start, line));
        Some(Box::new(std::iter::once(label)))
    }
}

/// A diagnostic as a terminal shows it: the message, the line at fault underlined, what to do.
pub fn draw(diagnostic: &Diagnostic) -> String {
    let mut theme = match io::stderr().is_terminal() {
        true => GraphicalTheme::default(),
        false => GraphicalTheme::none(),
    };
    (theme.characters.underline, theme.characters.underbar) = ('^', '^');
    let handler = GraphicalReportHandler::new_themed(theme).with_wrap_lines(false).with_links(false);
    let mut text = String::new();
    match handler.render_report(&mut text, &Drawn::new(diagnostic)) {
        Ok(()) => text,
        Err(_) => format!("{diagnostic}\n"),
    }
}
