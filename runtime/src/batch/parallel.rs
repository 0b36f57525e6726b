//! The same functions over the threads of rayon, in runs of whole blocks: where the signals lie in a cache they gain as many times as
//! there are cores, and from memory as much as a copy gains. Below some thousand signals one thread is faster. With the features
//! `batch` and `rayon`.

use super::*;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// How many blocks a thread takes at once: a thousand signals.
const AT_ONCE: usize = 64;

/// Runs a task over all its blocks, on all threads.
fn threads<S: Storage, D: Storage<Number = S::Number>>(task: &Task<'_, S, D>) -> Result<(), Error> {
    task.check()?;
    let mut rooms = task::rooms();
    let moves = task.moves(&mut rooms);
    let blocks = task.to.block_count();
    (0..blocks.div_ceil(AT_ONCE)).into_par_iter().for_each(|run| {
        let first = run * AT_ONCE;
        // SAFETY: it is checked, what made the views is borrowed by the function that calls, and no two runs share a block.
        unsafe { task.over(&moves, first..(first + AT_ONCE).min(blocks)) }
    });
    Ok(())
}

functions!(threads);
