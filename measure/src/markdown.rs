//! Pages, tables and numbers as Markdown has them.

use crate::File;

const HEAD: &str = "<!-- Written by `cargo measure`; do not edit. -->";

/// Three significant digits.
pub(crate) fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-2..1e4).contains(&size) {
        let text = format!("{value:.1e}");
        return text.replace(".0e", "e");
    }
    let decimals = (2 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A share as a percentage.
pub(crate) fn percent(share: f64) -> String {
    short(100.0 * share)
}

pub(crate) fn perhaps(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), short)
}

/// A table with its rows.
pub(crate) fn table(columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut text = format!("| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
    for row in rows {
        text += &format!("| {} |\n", row.join(" | "));
    }
    text
}

pub(crate) fn file(name: &str, title: &str, parts: &[String]) -> File {
    let body: Vec<&str> = parts.iter().map(|part| part.trim_end()).collect();
    File { name: format!("{name}.md"), text: format!("{HEAD}\n\n# {title}\n\n{}\n", body.join("\n\n")) }
}
