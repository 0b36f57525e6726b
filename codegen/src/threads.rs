//! Work shared between the processors. It knows nothing of what is done, and imports nothing.

use std::panic::resume_unwind;
use std::sync::Mutex;
use std::thread;

/// Returns what `work` makes of each item, in the order of the items. As many threads as there are processors take the
/// items one after another, so that an iterator that reads a file is read in order, by one thread at a time.
///
/// # Panics
///
/// If `work` or the iterator does, with what it says.
pub fn map<T, R: Send>(items: impl IntoIterator<Item = T, IntoIter: Send>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let items = items.into_iter();
    let most = items.size_hint().1.unwrap_or(usize::MAX);
    let count = thread::available_parallelism().map_or(1, usize::from).min(most);
    if count < 2 {
        return items.map(work).collect();
    }
    let items = Mutex::new(items.enumerate());
    let some = || {
        let mut done = Vec::new();
        loop {
            // Held while an item is taken, not while it is worked on. After a panic nobody takes another.
            let next = items.lock().ok().and_then(|mut items| items.next());
            let Some((place, item)) = next else { return done };
            done.push((place, work(item)));
        }
    };
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let others: Vec<_> = (1..count).map(|_| scope.spawn(some)).collect();
        let own = some();
        let others = others.into_iter().flat_map(|other| other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        own.into_iter().chain(others).collect()
    });
    done.sort_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, made)| made).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_where_their_items_stood() {
        for count in [0, 1, 2, 1000] {
            let squares: Vec<usize> = (0..count).map(|i| i * i).collect();
            assert_eq!(map(0..count, |i| i * i), squares);
        }
    }

    #[test]
    fn what_panics_is_heard() {
        for panicking in 0..8 {
            let heard = std::panic::catch_unwind(|| map(0..8, |i| assert!(i != panicking, "item {i}")));
            let words = heard.expect_err("one of them panicked");
            assert_eq!(words.downcast_ref::<String>(), Some(&format!("item {panicking}")));
        }
    }
}
