//! The plan that a kernel is made from: one that is kept, or, where none is, what a brief search finds.

use crate::families::product::plan::{Plan, Record, Task, kept};
use crate::families::product::search;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Plans that were read or searched for in this process.
static KNOWN: LazyLock<Mutex<HashMap<Task, Arc<Plan>>>> = LazyLock::new(Mutex::default);

/// Returns the plan of a task; the search for one that is not kept finds the same every time.
///
/// # Panics
///
/// If a plan that is kept is none: a fault of zonal.
pub fn plan(task: Task) -> Arc<Plan> {
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(plan) = known().get(&task) {
        return plan.clone();
    }
    let read = |record: &Record| record.plan().unwrap_or_else(|error| panic!("data/products.toml: {error}"));
    let plan = match kept().iter().find(|record| record.task() == task) {
        Some(record) => read(record),
        None => search::brief(task),
    };
    known().entry(task).or_insert_with(|| Arc::new(plan)).clone()
}
