//! Numbers and tables as a plan prints them.

use crate::promise::accuracy::round_up;

/// An error with two digits, rounded up.
pub fn short(error: f64) -> String {
    match error {
        _ if error < 1e-12 => "0".to_owned(),
        _ if (1e-3..1e3).contains(&error) => format!("{}", round_up(error)),
        _ => format!("{:e}", round_up(error)),
    }
}

/// A share in percent.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        p if p < 0.001 => "< 0.001 %".to_owned(),
        p if p < 0.1 => format!("{p:.3} %"),
        p if p < 10.0 => format!("{p:.2} %"),
        p if p > 99.9 && p < 100.0 => format!("{:.2} %", (100.0 * p).floor() / 100.0),
        p => format!("{p:.1} %"),
    }
}

/// A text with a capital first letter.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Rows as a Markdown table with aligned columns, the first row its head; columns of numbers are set right.
pub fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let cell = |row: &Vec<String>, i: usize| row.get(i).cloned().unwrap_or_default();
    let widths: Vec<usize> =
        (0..columns).map(|i| rows.iter().map(|row| cell(row, i).chars().count()).max().unwrap_or(0).max(2)).collect();
    let is_number = |i: usize| {
        rows[1..]
            .iter()
            .all(|row| cell(row, i).starts_with(|c: char| c.is_ascii_digit() || matches!(c, '<' | '>' | '-')))
    };
    let mut text = String::new();
    for (line, row) in rows.iter().enumerate() {
        for (i, &width) in widths.iter().enumerate() {
            text += &match is_number(i) {
                true => format!("| {:>width$} ", cell(row, i)),
                false => format!("| {:<width$} ", cell(row, i)),
            };
        }
        text += "|\n";
        if line == 0 {
            for (i, &width) in widths.iter().enumerate() {
                text += &match is_number(i) {
                    true => format!("|{}:", "-".repeat(width + 1)),
                    false => format!("|{}", "-".repeat(width + 2)),
                };
            }
            text += "|\n";
        }
    }
    text
}

/// A row of a table.
pub(super) fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}
