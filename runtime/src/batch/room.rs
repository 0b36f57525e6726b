//! Where blocks that lie in rows have their lines for a while: on the stack, two groups of them, of which one is worked on and the
//! next is read.

use super::pass::{GROUPS, Lines};
use super::registers::BLOCK;
use super::rows::MOST_LINES;

/// The lines of blocks on the stack, in the places of some groups.
pub fn aside<T>(first: *mut T, count: usize, step: usize, group: usize) -> Lines<T> {
    let at = [0, 1, 2, 3].map(|channel| first.wrapping_add(channel * count * BLOCK));
    Lines { at, step, mask: GROUPS * group - 1 }
}

/// The most blocks of a group.
pub const MOST_GROUP: usize = 8;

/// The most lines of blocks in all their channels that are on the stack at once: signals of [`GROUPS`] blocks and what is written past
/// the caches.
pub const ROOM_LINES: usize = (GROUPS + 1) * MOST_LINES;

/// Lines that suffice but for many channels of high orders; they stay in the nearest cache, and a call goes through fewer pages.
pub const FEW_LINES: usize = 512;

/// The lines that a block needs on the stack.
#[derive(Clone, Copy)]
pub struct Needs {
    /// Those of its signals.
    pub from: usize,
    /// Those of other factors.
    pub other: usize,
    /// Those of its results.
    pub to: usize,
    /// Whether results are put where the signals were.
    pub is_in_place: bool,
}

impl Needs {
    /// How many lines groups of so many blocks need.
    pub fn lines(&self, group: usize) -> usize {
        let Self { from, other, to, is_in_place } = *self;
        GROUPS * group * (from + other + if is_in_place { 0 } else { to }) + to
    }

    /// How many blocks a group has, so that all have room.
    pub fn group(&self, lines: usize) -> usize {
        let mut group = MOST_GROUP;
        while group > 1 && self.lines(group) > lines {
            group /= 2;
        }
        group
    }

    /// The first lines of signals, of other factors, of results and of what is streamed.
    pub fn places(&self, group: usize) -> [usize; 4] {
        let blocks = GROUPS * group;
        let (other, end) = (blocks * self.from, blocks * (self.from + self.other));
        if self.is_in_place { [0, other, 0, end] } else { [0, other, end, end + blocks * self.to] }
    }
}
