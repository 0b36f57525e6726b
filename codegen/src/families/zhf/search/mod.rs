//! The search for lobe directions that make Â sparse (Nowrouzezahrai et al. 2012, section 5): simulated annealing over
//! directions at the roots of Legendre functions and at fractions of a turn (docs/MATH.md#the-search-for-lobes).
//!
//! A search is a sequence of tries that know nothing of each other: a try's number and the seed decide all that it does,
//! with neither a transcendental function nor the order of threads in it. So a search gives the same sets on every
//! machine, and one that was interrupted ends as if it had not been. A try is guided by f64, where a zero can only be
//! guessed; what it finds is kept by what exact numbers say of it ([`Record::new`]), never by the guess.

mod anneal;
mod grid;
mod task;

pub use task::{SearchError, Task};

use crate::families::zhf::lobes::{Mode, Record, RecordError};
use crate::threads;
use anneal::attempt;
use grid::Grid;
use serde::{Deserialize, Serialize};
use task::SLACK;

/// A search and how far it got.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Search {
    /// What is searched.
    pub task: Task,
    /// How many tries were made.
    pub tries: usize,
    /// The sets that no other found beats in both non-zeros and condition, the sparsest first.
    #[serde(default)]
    pub found: Vec<Record>,
    #[serde(skip)]
    grid: Option<Grid>,
}

impl Search {
    /// A search that has made no try.
    ///
    /// # Errors
    ///
    /// If there is no such set.
    pub fn new(task: Task) -> Result<Self, SearchError> {
        task.check()?;
        Ok(Self { task, tries: 0, found: Vec::new(), grid: None })
    }

    /// Makes so many more tries in parallel; says when each is done.
    pub fn advance(&mut self, tries: usize, done: impl Fn() + Sync) {
        let task = self.task;
        let grid = self.grid.get_or_insert_with(|| Grid::new(&task));
        let numbers = self.tries..self.tries + tries;
        let guesses = threads::map(numbers.clone(), |number| {
            let found = attempt(grid, &task, number);
            done();
            found
        });
        for (number, guess) in
            numbers.zip(guesses).flat_map(|(number, list)| list.into_iter().map(move |g| (number, g)))
        {
            if !beaten(&self.found, guess.nonzeros, guess.condition) {
                let lobes = guess.pool.iter().map(|direction| grid.name(direction)).collect();
                let subsets = if task.mode == Mode::Free { guess.members } else { Vec::new() };
                // What the exact numbers refuse was no set: its guess is dropped.
                if let Ok(record) = Record::new(task.mode, task.size, (task.seed, number), lobes, subsets)
                    && record.condition <= task.max_condition
                {
                    keep(&mut self.found, record);
                }
            }
        }
        self.tries += tries;
    }

    /// The sparsest set found, of equally sparse ones the best conditioned.
    pub fn best(&self) -> Option<&Record> {
        self.found.first()
    }
}

/// Whether one of the sets has no more non-zeros and no larger condition.
fn beaten(front: &[Record], nonzeros: usize, condition: f64) -> bool {
    front.iter().any(|record| record.total() <= nonzeros && record.condition <= condition)
}

/// Adds a set to a front, unless it is beaten, and drops what it beats and what is far from the sparsest.
pub fn keep(front: &mut Vec<Record>, record: Record) {
    let same = |other: &Record| (other.mode, other.size) == (record.mode, record.size);
    let (mut own, others): (Vec<Record>, Vec<Record>) = std::mem::take(front).into_iter().partition(same);
    if !beaten(&own, record.total(), record.condition) {
        own.retain(|other| other.total() < record.total() || other.condition < record.condition);
        own.push(record);
        own.sort_by(|a, b| a.total().cmp(&b.total()).then(a.condition.total_cmp(&b.condition)));
        let most = own[0].total() as f64 * SLACK;
        own.retain(|other| other.total() as f64 <= most);
    }
    *front = others;
    front.append(&mut own);
    front.sort_by_key(|record| (record.mode, record.size));
}

/// The state of a list of searches as a file holds it.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    search: Vec<Search>,
}

/// The text of a state file.
pub fn state_text(searches: &[Search]) -> String {
    let state = State { search: searches.to_vec() };
    toml::to_string(&state).expect("a state has names for its fields")
}

/// Reads a state file and checks that it is of these searches and that its sets are what it says.
///
/// # Errors
///
/// If it is no state, one of other searches or one that was changed.
pub fn resume(text: &str, tasks: &[Task]) -> Result<Vec<Search>, SearchError> {
    let state: State = toml::from_str(text).map_err(|error| SearchError::State(error.message().to_owned()))?;
    let list = |tasks: &mut dyn Iterator<Item = &Task>| tasks.map(Task::to_string).collect::<Vec<_>>().join("; ");
    if !state.search.iter().map(|search| &search.task).eq(tasks) {
        let found = list(&mut state.search.iter().map(|search| &search.task));
        return Err(SearchError::Other { found, wanted: list(&mut tasks.iter()) });
    }
    for search in &state.search {
        search.task.check()?;
        let checked = threads::map(&search.found, |record| {
            let fault = |why: String| SearchError::Set { attempt: record.attempt, why };
            let task = &search.task;
            if (record.mode, record.size, record.seed) != (task.mode, task.size, task.seed) {
                return Err(fault("it is of another search".to_owned()));
            }
            match record.counted() {
                Ok(counted) if counted == (record.nonzeros.clone(), record.condition) => Ok(()),
                Ok((nonzeros, condition)) => {
                    Err(fault(format!("its non-zeros are {nonzeros:?}, its condition {condition}")))
                }
                Err(error) => Err(fault(RecordError::to_string(&error))),
            }
        });
        checked.into_iter().collect::<Result<(), SearchError>>()?;
    }
    Ok(state.search)
}
