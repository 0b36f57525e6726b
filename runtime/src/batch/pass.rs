//! What a kernel works on: where the lines of many blocks lie, in memory or for a while on the stack, and what puts rows there.

use core::mem::MaybeUninit;
use core::ops::Range;
use core::ptr;

/// The most channels that share a set-up.
pub const MOST_CHANNELS: usize = 4;

/// Where the lines of many blocks lie: each a number of each of sixteen signals, the lines of a channel one after the other.
#[derive(Clone, Copy)]
pub struct Lines<T> {
    /// The first line of each channel; what lies there is written only where results go.
    pub at: [*mut T; MOST_CHANNELS],
    /// How many numbers lie from a block to the next.
    pub step: usize,
    /// Which bits of a block's number say where it lies: all, or the lowest where blocks share places.
    pub mask: usize,
}

/// How many blocks ahead those of so many lines are asked for where they lie: memory is so far, and more has no room beside what is
/// worked on.
#[inline(always)]
pub fn blocks_ahead(lines: usize) -> usize {
    (144 / lines.max(1)).max(1)
}

/// How many groups of blocks have places: one is worked on, and the next is read.
pub const GROUPS: usize = 2;

/// A block, by the first one of its group, behind which those of the group lie one after the other.
#[derive(Clone, Copy)]
pub struct Place {
    first: usize,
    after: usize,
}

/// What a kernel works on.
#[derive(Clone, Copy)]
pub struct Pass<'a, T> {
    /// What puts blocks that lie in rows into their lines, a group at a time.
    pub read: Option<&'a dyn Fn(Range<usize>)>,
    /// What makes rows of a group's results.
    pub write: Option<&'a dyn Fn(Range<usize>)>,
    /// How many blocks are a group.
    pub group: usize,
    /// Which bits of a block's number are its place in the group; all, where there are no groups.
    pub within: usize,
    /// How many blocks.
    pub blocks: usize,
    /// How many channels share the parameters.
    pub channels: usize,
    /// The parameters, which channels share.
    pub params: Lines<T>,
    /// The signals.
    pub from: Lines<T>,
    /// What will be read a while later, as many lines a block as it has: what a kernel asks for ahead.
    pub ahead: Lines<T>,
    /// The other factor of a product.
    pub other: Lines<T>,
    /// Where results go. It may be where the signals are.
    pub to: Lines<T>,
    /// Whether signals are asked for ahead where a kernel does so little with them that it pays only for what is in no near cache.
    pub is_far: bool,
    /// Whether results go past the caches; then they begin at multiples of 64 bytes.
    pub streams: bool,
}

impl<T> Pass<'_, T> {
    /// Returns a pass over nothing.
    #[inline(always)]
    pub const fn nowhere() -> Self {
        Self {
            read: None,
            write: None,
            group: 1,
            within: usize::MAX,
            blocks: 0,
            channels: 0,
            params: Lines::NONE,
            from: Lines::NONE,
            ahead: Lines::NONE,
            other: Lines::NONE,
            to: Lines::NONE,
            is_far: false,
            streams: false,
        }
    }

    /// Before a block is worked on that begins a group: makes rows of the group before it and reads the one behind it, if they are
    /// rows, so that neither waits for what is worked on.
    #[inline(always)]
    pub fn pass_by(&self, block: usize) {
        if block & self.within == 0 {
            if let Some(write) = self.write.filter(|_| block > 0) {
                write(block - self.group..block);
            }
            if let Some(read) = self.read.filter(|_| block + self.group < self.blocks) {
                read(block + self.group..(block + 2 * self.group).min(self.blocks));
            }
        }
    }

    /// Does something to every block, in the order of the groups.
    #[inline(always)]
    pub fn each(&self, mut of: impl FnMut(Place)) {
        self.begin();
        let mut first = 0;
        while first < self.blocks {
            self.pass_by(first);
            let end = self.blocks.min(first.saturating_add(self.group));
            for after in 0..end - first {
                of(Place { first, after });
            }
            first = end;
        }
        self.end();
    }

    /// As [`each`](Self::each), with how many channels there are. One alone is no loop, for which all that channels share would be
    /// kept in memory.
    #[inline(always)]
    pub fn each_of_channels(&self, of: impl Fn(Place, usize)) {
        if self.channels == 1 {
            self.each(
                #[inline(always)]
                |place| of(place, 1),
            );
        } else {
            self.each(
                #[inline(always)]
                |place| of(place, self.channels),
            );
        }
    }

    /// Reads the first group, if it lies in rows.
    #[inline(always)]
    pub fn begin(&self) {
        if let Some(read) = self.read {
            read(0..self.group.min(self.blocks));
        }
    }

    /// Makes rows of the last group, if they are rows.
    #[inline(always)]
    pub fn end(&self) {
        if let Some(write) = self.write {
            write((self.blocks - 1) / self.group * self.group..self.blocks);
        }
    }
}

impl<T> Lines<T> {
    /// Lines that are nowhere.
    pub const NONE: Self = Self { at: [ptr::null_mut(); MOST_CHANNELS], step: 0, mask: 0 };

    /// The lines of as many blocks later.
    pub fn later(self, blocks: usize) -> Self {
        Self { at: self.at.map(|at| at.wrapping_add(blocks * self.step)), ..self }
    }

    /// Where a block's lines are.
    #[inline(always)]
    pub fn block(&self, channel: usize, block: usize) -> *mut T {
        self.at[channel].wrapping_add((block & self.mask) * self.step)
    }

    /// The same of a block in a group: as addresses that grow by a step each.
    #[inline(always)]
    pub fn of(&self, channel: usize, place: Place) -> *mut T {
        self.block(channel, place.first).wrapping_add(place.after * self.step)
    }
}

/// Lines on the stack, from a multiple of 64 bytes on. A function that has them keeps its registers in such places too: where
/// they lie across two lines of the cache, a kernel takes half as long again.
#[repr(C, align(64))]
pub struct Aside<A>(MaybeUninit<A>);

impl<A> Aside<A> {
    /// Returns lines of no meaning.
    #[inline(always)]
    pub const fn new() -> Self {
        Self(MaybeUninit::uninit())
    }

    /// The first number.
    #[inline(always)]
    pub fn first<T>(&mut self) -> *mut T {
        self.0.as_mut_ptr().cast()
    }
}

/// Lets the function that this is inlined into begin its stack at a multiple of 64 bytes, as [`Aside`] says.
#[inline(always)]
pub fn align_stack() {
    core::hint::black_box(Aside::<u8>::new().first::<u8>());
}
