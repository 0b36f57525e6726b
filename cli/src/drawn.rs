//! How a diagnostic is drawn for the person in front of a terminal: the message, the line at fault underlined, what to
//! do.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::{Error, SimpleFile};
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{Chars, Config, Styles, StylesWriter, emit_to_write_style};
use std::io::{self, IsTerminal};
use zonal_codegen::scene::diagnostic::Diagnostic;

/// Shows what is wrong on the standard error, in colours on a terminal, in ASCII elsewhere.
pub fn show(diagnostic: &Diagnostic) {
    if draw(diagnostic).is_err() {
        // If even this cannot be printed, the exit code still tells.
        let _ = io::Write::write_all(&mut io::stderr(), format!("{diagnostic}\n").as_bytes());
    }
}

fn draw(diagnostic: &Diagnostic) -> Result<(), Error> {
    let (choice, chars) = match io::stderr().is_terminal() {
        true => (ColorChoice::Auto, Chars::box_drawing()),
        false => (ColorChoice::Never, Chars::ascii()),
    };
    let (name, text) = match &diagnostic.place {
        Some(place) => (place.source.name.as_str(), place.source.text.as_str()),
        None => ("", ""),
    };
    let labels = diagnostic.place.iter().map(|place| {
        // Of a fault that spans lines the first is enough.
        let line = place.text().lines().next().unwrap_or("").len();
        Label::primary((), place.span.start..place.span.start + line)
    });
    let help = (!diagnostic.help.is_empty()).then(|| format!("help: {}", diagnostic.help));
    let report = Report::error()
        .with_message(&diagnostic.message)
        .with_labels(labels.collect())
        .with_notes(help.into_iter().collect());
    let styles = Styles::default();
    let mut stream = StandardStream::stderr(choice);
    let mut writer = StylesWriter::new(&mut stream, &styles);
    emit_to_write_style(&mut writer, &Config { chars, ..Config::default() }, &SimpleFile::new(name, text), &report)
}
