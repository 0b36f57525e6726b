//! How a diagnostic is drawn for the person in front of a terminal: the message, the line at fault underlined, what to
//! do.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::{Error, Files, SimpleFile};
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{Chars, Config, Styles, StylesWriter, emit_to_write_style};
use std::io::{self, IsTerminal};
use std::ops::Range;
use zonal_codegen::scene::diagnostic::{Diagnostic, Place};

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
    // Of a fault that spans lines the first is enough.
    let first = |place: &Place| place.span.start..place.span.start + place.text().lines().next().unwrap_or("").len();
    let cut = Cut::new(name, text, diagnostic.place.as_ref().map_or(0..0, first));
    let labels = diagnostic.place.iter().map(|_| Label::primary((), cut.span.clone()));
    let help = (!diagnostic.help.is_empty()).then(|| format!("help: {}", diagnostic.help));
    let report = Report::error()
        .with_message(&diagnostic.message)
        .with_labels(labels.collect())
        .with_notes(help.into_iter().collect());
    let styles = Styles::default();
    let mut stream = StandardStream::stderr(choice);
    let mut writer = StylesWriter::new(&mut stream, &styles);
    emit_to_write_style(&mut writer, &Config { chars, ..Config::default() }, &cut, &report)
}

/// How many characters of a line are shown before a fault and after its beginning, where the line is longer.
const SHOWN: usize = 100;
/// What stands for the others.
const DOTS: &str = "...";

/// A text whose line at fault is cut to what can be read; columns are still those of the whole line.
struct Cut<'a> {
    file: SimpleFile<&'a str, String>,
    /// What is at fault, in the text that is cut.
    span: Range<usize>,
    /// How many characters are missing before it, but for the dots that stand for them.
    missing: isize,
}

impl<'a> Cut<'a> {
    fn new(name: &'a str, text: &str, span: Range<usize>) -> Self {
        let is_within = text.is_char_boundary(span.start) && text.is_char_boundary(span.end);
        let (before, after) = if is_within { text.split_at(span.start) } else { return Self::whole(name, text, span) };
        let begin = before.rfind('\n').map_or(0, |at| at + 1);
        let rest = after.find('\n').unwrap_or(after.len());
        let kept_before = before[begin..].char_indices().rev().nth(SHOWN - 1).map_or(begin, |(at, _)| begin + at);
        let kept_after = after[..rest].char_indices().nth(SHOWN).map_or(rest, |(at, _)| at);
        let dots = |is_cut: bool| if is_cut { DOTS } else { "" };
        let head = dots(kept_before > begin);
        let cut = format!(
            "{}{head}{}{}{}{}",
            &text[..begin],
            &text[kept_before..span.start],
            &after[..kept_after],
            dots(kept_after < rest),
            &after[rest..]
        );
        let start = begin + head.len() + span.start - kept_before;
        let missing = text[begin..kept_before].chars().count() as isize - head.len() as isize;
        let span = start..start + (span.end - span.start).min(kept_after);
        Self { file: SimpleFile::new(name, cut), span, missing }
    }

    fn whole(name: &'a str, text: &str, span: Range<usize>) -> Self {
        Self { file: SimpleFile::new(name, text.to_owned()), span, missing: 0 }
    }
}

impl<'a> Files<'a> for Cut<'_> {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(self.file.name())
    }

    fn source(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(self.file.source())
    }

    fn line_index(&'a self, (): (), byte: usize) -> Result<usize, Error> {
        self.file.line_index((), byte)
    }

    fn line_range(&'a self, (): (), line: usize) -> Result<Range<usize>, Error> {
        self.file.line_range((), line)
    }

    fn column_number(&'a self, (): (), line: usize, byte: usize) -> Result<usize, Error> {
        let missing = if byte == self.span.start { self.missing } else { 0 };
        Ok(self.file.column_number((), line, byte)?.saturating_add_signed(missing))
    }
}
