//! How a command talks to the person who started it: what it prints, what turns meanwhile, how it ends.

use crate::drawn::show;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Duration;
use zonal_codegen::builder::Error;
use zonal_codegen::fault::Fault;
use zonal_codegen::files::FileError;
use zonal_codegen::generate::GenerateError;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// Why a command ends early.
#[derive(Debug)]
pub enum Failure {
    /// Something is wrong, and this says what.
    Shown(Diagnostic),
    /// Another program told what is wrong, and ended with this code.
    Told(u8),
    /// Nobody reads the output any more.
    Closed,
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Shown(diagnostic)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Scene(diagnostic) => diagnostic.into(),
            Error::Files(error) => Fault::from(error).into(),
            other => Diagnostic::nowhere(other.to_string(), "").into(),
        }
    }
}

macro_rules! failure_from {
    ($($error:ty => $through:ident),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                $through::from(error).into()
            }
        })*
    };
}

failure_from!(Fault => Diagnostic, GenerateError => Error, FileError => Error);

/// Something that turns while a command works, on terminals only; it vanishes when it is dropped.
pub fn progress(message: &str) -> ProgressBar {
    let bar = ProgressBar::new_spinner().with_message(message.to_owned()).with_finish(ProgressFinish::AndClear);
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// A bar that grows while a command works, on terminals only; it vanishes when it is dropped.
pub fn bar(message: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:24} [{bar:40}] {pos}/{len} {elapsed}");
    let bar = ProgressBar::new(1).with_message(message.to_owned()).with_finish(ProgressFinish::AndClear);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// Prints to the standard output; a closed pipe ends the command in silence.
///
/// # Errors
///
/// If nobody reads, or it cannot be written.
pub fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::Closed,
        _ => Diagnostic::nowhere(format!("cannot print: {error}"), "").into(),
    })
}

/// Prints a value as JSON.
///
/// # Errors
///
/// As [`out`].
pub fn out_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Diagnostic::nowhere(format!("cannot print JSON: {error}"), ""))?;
    out(&(text + "\n"))
}

/// How a command ends: 0, or 1 for what went wrong, which is shown.
pub fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Told(code)) => ExitCode::from(code),
        Err(Failure::Shown(diagnostic)) => {
            show(&diagnostic);
            ExitCode::FAILURE
        }
    }
}
