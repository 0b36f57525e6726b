//! What the bench measured of one text in one column, as a line that the tests read back.

use std::fmt;
use std::str::FromStr;

/// What was measured of one text in one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The spec.
    pub spec: String,
    /// The driver and the language.
    pub column: String,
    /// What is other about the text than in the catalogue: what was corrupted, or how arrays are passed.
    pub change: String,
    /// The largest error.
    pub error: f64,
    /// What it may be.
    pub tolerance: f64,
    /// How long it took, the comparison included.
    pub seconds: f64,
}

impl Row {
    /// Whether the driver computes what the interpreter does.
    pub fn agrees(&self) -> bool {
        self.error <= self.tolerance
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { spec, column, change, error, tolerance, seconds } = self;
        write!(f, "{spec}\t{column}\t{change}\t{error:e}\t{tolerance:e}\t{seconds:.3}")
    }
}

impl FromStr for Row {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<f64>().map_err(|error| format!("{text}: {error}"));
        match line.split('\t').collect::<Vec<_>>()[..] {
            [spec, column, change, error, tolerance, seconds] => Ok(Self {
                spec: spec.to_owned(),
                column: column.to_owned(),
                change: change.to_owned(),
                error: number(error)?,
                tolerance: number(tolerance)?,
                seconds: number(seconds)?,
            }),
            _ => Err(format!("no row: {line}")),
        }
    }
}
