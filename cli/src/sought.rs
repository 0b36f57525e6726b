//! What the commands that search have in common: ranges of sizes, files to which finds are added, a bar.

use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::Duration;
use zonal_cli::terminal::Failure;
use zonal_codegen::files::{self, Replace};
use zonal_codegen::input;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// A number or a range as in `2-6`, within `allowed`; `what` are the numbers, in messages.
pub fn range(text: &str, allowed: RangeInclusive<usize>, what: &str) -> Result<RangeInclusive<usize>, String> {
    let (from, to) = text.split_once('-').unwrap_or((text, text));
    let number = |text: &str| text.parse::<usize>().map_err(|_| format!("`{text}` is no number; write it as 5 or 2-6"));
    let (from, to) = (number(from)?, number(to)?);
    match *allowed.start() <= from && from <= to && to <= *allowed.end() {
        true => Ok(from..=to),
        false => Err(format!("{what} are {} to {}, the smaller first", allowed.start(), allowed.end())),
    }
}

/// The text of a file of so many bytes at most, or none if there is no such file.
pub fn read(path: &Path, max_bytes: usize) -> Result<Option<String>, Failure> {
    match input::read_text(path, max_bytes) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => {
            Err(Diagnostic::nowhere(format!("{}: cannot be read ({error})", path.display()), "check the path").into())
        }
    }
}

/// What a file of finds holds, which are called `what`; nothing if there is no such file.
pub fn known<T, E: Display>(
    path: &Path,
    max_bytes: usize,
    what: &str,
    parse: impl Fn(&str) -> Result<Vec<T>, E>,
) -> Result<Vec<T>, Failure> {
    let Some(text) = read(path, max_bytes)? else { return Ok(Vec::new()) };
    parse(&text).map_err(|error| {
        let message = format!("{}: holds no {what}: {error}", path.display());
        Diagnostic::nowhere(message, "name a file that `--out` wrote, or a new one").into()
    })
}

/// Refuses files that may not be written, which is better known before a search than after it.
pub fn check<'a>(paths: impl IntoIterator<Item = &'a PathBuf>, head: &str, replace: Replace) -> Result<(), Failure> {
    for path in paths {
        let (folder, name) = files::split(path);
        files::check(folder, &[(&name, head.as_bytes())], replace)?;
    }
    Ok(())
}

/// Writes finds, which are called `what`, under their head.
pub fn write(
    path: &Path,
    head: &str,
    what: &str,
    finds: &impl serde::Serialize,
    replace: Replace,
) -> Result<(), Failure> {
    let text =
        toml::to_string(finds).map_err(|error| Diagnostic::nowhere(format!("cannot write the {what}: {error}"), ""))?;
    files::write_text(path, &format!("{head}\n{text}"), replace)?;
    Ok(())
}

/// A bar of so many tries, its message `width` wide.
pub fn bar(steps: usize, width: usize) -> ProgressBar {
    let template = format!("{{msg:{width}}} [{{bar:40}}] {{pos}}/{{len}} {{elapsed}}");
    let style = ProgressStyle::with_template(&template).expect("is a template");
    let bar = ProgressBar::new(steps as u64).with_style(style.progress_chars("=> "));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
