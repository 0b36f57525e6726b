//! What a kernel works on: where the lines of many blocks lie, in memory or for a while on the stack, and what puts rows there.

use core::mem::MaybeUninit;
use core::ops::Range;

/// The most channels that share a set-up.
pub const MOST_CHANNELS: usize = 4;

/// Where the lines of many blocks lie: each a number of each of sixteen signals, the lines of a channel one after the other.
#[derive(Clone, Copy)]
pub struct Lines<P> {
    /// The first line of each channel.
    pub at: [P; MOST_CHANNELS],
    /// How many numbers lie from a block to the next.
    pub step: usize,
    /// Which bits of a block's number say where it lies: all, or the lowest where blocks share places.
    pub mask: usize,
}

/// How many groups of blocks have places: one is worked on, and the next is read.
pub const GROUPS: usize = 2;

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
    pub params: Lines<*const T>,
    /// The signals.
    pub from: Lines<*const T>,
    /// The other factor of a product.
    pub other: Lines<*const T>,
    /// Where results go. It may be where the signals are.
    pub to: Lines<*mut T>,
    /// Whether signals are asked for ahead where a kernel does so little with them that it pays only for what is in no near cache.
    pub is_far: bool,
    /// Whether results go past the caches; then they begin at multiples of 64 bytes.
    pub streams: bool,
}

impl<T> Pass<'_, T> {
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

impl<T> Lines<*const T> {
    /// Where a block's lines are.
    #[inline(always)]
    pub fn block(&self, channel: usize, block: usize) -> *const T {
        self.at[channel].wrapping_add((block & self.mask) * self.step)
    }
}

impl<T> Lines<*mut T> {
    /// Where a block's lines go.
    #[inline(always)]
    pub fn block(&self, channel: usize, block: usize) -> *mut T {
        self.at[channel].wrapping_add((block & self.mask) * self.step)
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
