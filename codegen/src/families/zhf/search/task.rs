//! What is searched for, and why it is not.

use crate::families::zhf::lobes::{HIGHEST_SIZE, Mode};
use serde::{Deserialize, Serialize};

/// Sets with more than this much more non-zeros than the sparsest are dropped from a front.
pub const SLACK: f64 = 1.25;

/// What is searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// How the bands share directions.
    pub mode: Mode,
    /// The order; for [`Mode::Band`] the band.
    pub size: usize,
    /// The seed.
    pub seed: u32,
    /// The largest condition number of any band's Y.
    pub max_condition: f64,
}

/// Why there is nothing to search, or nothing to go on with.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SearchError {
    /// A size out of range.
    #[error("there is no set of size {size} to search for: orders and bands are {from} to {HIGHEST_SIZE}", from = 2)]
    Size {
        /// The size.
        size: usize,
    },
    /// A condition that nothing has.
    #[error("no set has a condition below one; the sparsest have 2 to 100")]
    Condition,
    /// A state that is none.
    #[error("it is no state of a search: {0}")]
    State(String),
    /// A set of a state that is not what the state says.
    #[error("its set of try {attempt} is not what it says: {why}")]
    Set {
        /// Which try.
        attempt: usize,
        /// What is wrong.
        why: String,
    },
    /// The state of another search.
    #[error("it is of another search: {found}, not {wanted}")]
    Other {
        /// The searches of the state.
        found: String,
        /// The searches that were asked for.
        wanted: String,
    },
}

impl Task {
    pub(super) fn check(&self) -> Result<(), SearchError> {
        if !(2..=HIGHEST_SIZE).contains(&self.size) {
            return Err(SearchError::Size { size: self.size });
        }
        match self.max_condition >= 1.0 {
            true => Ok(()),
            false => Err(SearchError::Condition),
        }
    }
}

impl std::fmt::Display for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mode, size, seed, max_condition } = self;
        write!(f, "{} {size} from seed {seed}, condition to {max_condition}", mode.name())
    }
}
