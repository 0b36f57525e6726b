//! Rows: where the numbers of a signal lie in memory that is not made of blocks, and how sixteen rows become lines of a block
//! and back, four columns at a time.

use core::mem::MaybeUninit;

use super::pass::MOST_CHANNELS;
use super::registers::{BLOCK, Quads, Register};
use super::squares::{read_four, read_square, worth_a_square, write_four, write_square};
use crate::pieces::source;

/// The most coefficients of a channel: order 10.
pub const MOST_COUNT: usize = 100;

/// The most lines that a block has in all its channels.
pub const MOST_LINES: usize = MOST_CHANNELS * MOST_COUNT;

/// Where in a row each coefficient of each channel lies: coefficient 0 of channel c at `first[0] + c first[1]`, coefficient i
/// above at `rest[0] + c rest[1] + (i − 1) rest[2]`, counted in numbers from the row's beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    pub(super) count: usize,
    pub(super) channels: usize,
    first: [usize; 2],
    rest: [usize; 3],
}

impl Row {
    /// Returns rows of one number a coefficient, in each of so many channels that lie side by side: RGB, RGB, RGB.
    #[must_use]
    pub const fn interleaved(count: usize, channels: usize) -> Self {
        Self { count, channels, first: [0, 1], rest: [channels, 1, channels] }
    }

    /// Returns rows of one channel after the other: all of red, all of green, all of blue.
    #[must_use]
    pub const fn planar(count: usize, channels: usize) -> Self {
        Self { count, channels, first: [0, count], rest: [1, count, 1] }
    }

    /// Returns rows as files of splats have them: the constants of red, green and blue, then the other coefficients of red, of
    /// green and of blue, `count` n² of each with its constant: 3 + 15 + 15 + 15 at order 4, which splats call degree 3.
    #[must_use]
    pub const fn splat(count: usize) -> Self {
        Self { count, channels: 3, first: [0, 1], rest: [3, count.saturating_sub(1), 1] }
    }

    /// Returns the same rows, in which the signal begins so many numbers later: behind what else a splat has.
    #[must_use]
    pub const fn at(self, offset: usize) -> Self {
        self.apart(offset, offset)
    }

    /// Returns the same rows, in which the constants begin so many numbers later and the other coefficients so many: where something
    /// stands between them.
    #[must_use]
    pub const fn apart(self, constants: usize, others: usize) -> Self {
        let (first, rest) = (self.first, self.rest);
        Self { first: [first[0] + constants, first[1]], rest: [rest[0] + others, rest[1], rest[2]], ..self }
    }

    /// Returns where a coefficient of a channel lies.
    #[must_use]
    pub const fn column(&self, channel: usize, coefficient: usize) -> usize {
        match coefficient.checked_sub(1) {
            None => self.first[0] + channel * self.first[1],
            Some(above) => self.rest[0] + channel * self.rest[1] + above * self.rest[2],
        }
    }

    /// Whether rows of so many numbers are the signal and nothing else, one number after the other.
    pub(super) const fn is_array(&self, stride: usize) -> bool {
        let is_dense = self.count == 1 || self.rest[0] == 1 && self.rest[2] == 1;
        self.count == stride && self.channels == 1 && self.first[0] == 0 && is_dense
    }

    /// Returns how many numbers a row has at least.
    #[must_use]
    pub fn width(&self) -> usize {
        let last = |channel| self.column(channel, 0).max(self.column(channel, self.count.saturating_sub(1)));
        (0..self.channels).map(last).max().map_or(0, |last| last + 1)
    }
}

/// Columns side by side: the first one's number, and the line of each.
#[derive(Clone, Copy, Debug)]
pub struct Tile<const N: usize> {
    column: u32,
    lines: [u16; N],
    /// Whether the lines lie one after the other.
    is_dense: bool,
}

/// Items on the stack, so many of which there are.
struct Few<T, const N: usize> {
    items: [MaybeUninit<T>; N],
    count: usize,
}

impl<T: Copy, const N: usize> Few<T, N> {
    const fn new() -> Self {
        Self { items: [const { MaybeUninit::uninit() }; N], count: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.count].write(item);
        self.count += 1;
    }

    /// As many items more, all of which are to be written.
    fn more(&mut self, count: usize) -> &mut [MaybeUninit<T>] {
        let first = self.count;
        self.count += count;
        &mut self.items[first..self.count]
    }

    fn all(&mut self) -> &mut [T] {
        // SAFETY: so many are written.
        unsafe { core::slice::from_raw_parts_mut(self.items.as_mut_ptr().cast(), self.count) }
    }

    fn get(&self) -> &[T] {
        // SAFETY: so many are written.
        unsafe { core::slice::from_raw_parts(self.items.as_ptr().cast(), self.count) }
    }
}

/// Columns side by side, of one channel or of each channel in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    column: u32,
    /// The line of the first.
    line: u16,
    count: u16,
    /// How many channels lie in turn.
    channels: u16,
}

/// The most pieces of a row: constants and the rest of each channel.
const MOST_PIECES: usize = 2 * MOST_CHANNELS;

/// The columns of a row: sixteen at a time, then four, where as many lie side by side. It is made for each call, so that it is small.
pub struct Tiles {
    wide: Few<Tile<BLOCK>, { MOST_LINES / BLOCK + MOST_PIECES }>,
    tiles: Few<Tile<4>, { 4 * MOST_PIECES }>,
    /// Columns that lie alone, each with its line.
    alone: Few<(u32, u16), { 3 * MOST_PIECES }>,
    /// How many numbers of a row tiles touch; it may be more than the row has.
    pub touched: usize,
}

impl<const N: usize> Tile<N> {
    /// Columns from one on.
    fn new(column: u32, lines: [u16; N]) -> Self {
        let is_next = |(i, line): (usize, &u16)| *line == lines[0] + i as u16;
        // All are asked, so that many are at once.
        let is_dense = lines.iter().enumerate().fold(true, |all, line| all & is_next(line));
        Self { column, lines, is_dense }
    }
}

impl Row {
    /// The pieces of the row, in the order of their columns.
    fn pieces(&self) -> Few<Piece, MOST_PIECES> {
        let mut pieces = Few::new();
        let (count, channels) = (self.count as u16, self.channels as u16);
        let mut add = |coefficient: usize, many: u16, [apart, within]: [usize; 2]| {
            // Channels in turn are one piece, a channel that lies side by side is one each.
            let in_turn = apart == 1 && (many == 1 || within == self.channels);
            for channel in 0..if in_turn { 1 } else { channels } {
                let column = self.column(channel as usize, coefficient) as u32;
                let line = channel * count + coefficient as u16;
                let [many, channels] = if in_turn { [many * channels, channels] } else { [many, 1] };
                pieces.push(Piece { column, line, count: many, channels });
            }
        };
        if count > 0 {
            add(0, 1, [self.first[1], 0]);
        }
        if count > 1 {
            add(1, count - 1, [self.rest[1], self.rest[2]]);
        }
        pieces.all().sort_unstable();
        pieces
    }
}

impl Tiles {
    /// Puts no columns there.
    pub fn none(at: &mut MaybeUninit<Self>) -> &mut Self {
        let at = at.as_mut_ptr();
        // SAFETY: what is not written may be without meaning; thousands of bytes are not copied.
        unsafe {
            (&raw mut (*at).wide.count).write(0);
            (&raw mut (*at).tiles.count).write(0);
            (&raw mut (*at).alone.count).write(0);
            (&raw mut (*at).touched).write(0);
            &mut *at
        }
    }

    /// Puts the columns of a row there, for a unit that is wide or not. Where `over` is so, fewer than four columns side by side are
    /// a tile too, which touches what lies behind them.
    pub fn fill<'t>(at: &'t mut MaybeUninit<Self>, row: &Row, over: bool, is_wide: bool) -> &'t Self {
        let tiles = Self::none(at);
        let mut lines = Few::<u16, MOST_LINES>::new();
        let pieces = row.pieces();
        let mut first = 0;
        for piece in pieces.get() {
            if lines.count > 0 && piece.column != first + lines.count as u32 {
                tiles.add(first, lines.get(), over, is_wide);
                lines.count = 0;
            }
            if lines.count == 0 {
                first = piece.column;
            }
            let of_piece = lines.more(piece.count as usize);
            if piece.channels == 1 {
                of_piece.iter_mut().enumerate().for_each(|(i, line)| {
                    line.write(piece.line + i as u16);
                });
            } else {
                for (i, in_turn) in of_piece.chunks_mut(piece.channels as usize).enumerate() {
                    let lines = in_turn.iter_mut().enumerate();
                    lines.for_each(|(channel, line)| {
                        line.write(piece.line + (channel * row.count + i) as u16);
                    });
                }
            }
        }
        tiles.add(first, lines.get(), over, is_wide);
        tiles
    }

    /// Adds columns side by side, with their lines.
    fn add(&mut self, first: u32, lines: &[u16], over: bool, is_wide: bool) {
        let count = lines.len();
        if count < 4 && !(over && count > 1) {
            (0..count).for_each(|i| self.alone.push((first + i as u32, lines[i])));
            return;
        }
        let (squares, rest) = lines.as_chunks::<BLOCK>();
        for (i, lines) in squares.iter().enumerate() {
            self.wide.push(Tile::new(first + (i * BLOCK) as u32, *lines));
        }
        self.touched = self.touched.max(first as usize + count.max(4));
        if let Some(lines) = lines.last_chunk::<BLOCK>().filter(|_| rest.len() >= worth_a_square(is_wide)) {
            self.wide.push(Tile::new(first + (count - BLOCK) as u32, *lines));
            return;
        }
        // What is left over begins with columns that are done already, if there are too few; what is no column goes to the line of
        // the first, before that does.
        for start in (count - rest.len()..count).step_by(4) {
            let start = start.min(count.saturating_sub(4));
            let line = |i: usize| lines.get(start + i).copied().unwrap_or(lines[start]);
            self.tiles.push(Tile::new(first + start as u32, core::array::from_fn(line)));
        }
    }

    /// The columns that lie alone, each with its line.
    pub fn alone(&self) -> &[(u32, u16)] {
        self.alone.get()
    }

    /// Reads the rows of some blocks to lines, of which a block has `step` numbers.
    ///
    /// # Safety
    ///
    /// The rows are there as far as the tiles touch them, and so is room for the lines; the function around is compiled for the
    /// unit of the register, which the processor has.
    #[inline(always)]
    pub unsafe fn gather<R: Quads>(&self, rows: Rows<R::Number>, lines: *mut R::Number, step: usize) {
        for block in 0..rows.blocks {
            let (lines, stride) = (lines.wrapping_add(block * step), rows.stride);
            let first = rows.block::<R>(block);
            let line = |lines_of: &[u16], i: usize| lines.wrapping_add(lines_of[i] as usize * BLOCK);
            for wide in self.wide.get() {
                let column = first.wrapping_add(wide.column as usize);
                // SAFETY: the caller's.
                unsafe {
                    if wide.is_dense {
                        let lines = line(&wide.lines, 0);
                        let dense = source(
                            #[inline(always)]
                            |i: usize| lines.wrapping_add(i * BLOCK),
                        );
                        read_square::<R>(column, stride, dense);
                    } else {
                        let apart = source(
                            #[inline(always)]
                            |i: usize| line(&wide.lines, i),
                        );
                        read_square::<R>(column, stride, apart);
                    }
                }
            }
            for tile in self.tiles.get() {
                let apart = source(
                    #[inline(always)]
                    |i: usize| line(&tile.lines, i),
                );
                // SAFETY: the caller's.
                unsafe { read_four::<R>(first.wrapping_add(tile.column as usize), stride, apart) }
            }
        }
    }

    /// Writes lines to the rows of some blocks.
    ///
    /// # Safety
    ///
    /// As [`gather`](Self::gather), and the rows are nobody else's.
    #[inline(always)]
    pub unsafe fn scatter<R: Quads>(&self, lines: *const R::Number, step: usize, rows: Rows<R::Number>) {
        for block in 0..rows.blocks {
            let (lines, stride) = (lines.wrapping_add(block * step), rows.stride);
            let first = rows.first.wrapping_add(block * BLOCK * stride);
            let line = |lines_of: &[u16], i: usize| lines.wrapping_add(lines_of[i] as usize * BLOCK);
            for wide in self.wide.get() {
                let column = first.wrapping_add(wide.column as usize);
                // SAFETY: the caller's.
                unsafe {
                    if wide.is_dense {
                        let lines = line(&wide.lines, 0);
                        let dense = source(
                            #[inline(always)]
                            |i: usize| lines.wrapping_add(i * BLOCK),
                        );
                        write_square::<R>(dense, column, stride);
                    } else {
                        let apart = source(
                            #[inline(always)]
                            |i: usize| line(&wide.lines, i),
                        );
                        write_square::<R>(apart, column, stride);
                    }
                }
            }
            for tile in self.tiles.get() {
                let apart = source(
                    #[inline(always)]
                    |i: usize| line(&tile.lines, i),
                );
                // SAFETY: the caller's.
                unsafe { write_four::<R>(apart, first.wrapping_add(tile.column as usize), stride) }
            }
        }
    }
}

/// The rows of some blocks.
#[derive(Clone, Copy)]
pub struct Rows<T> {
    /// The first row.
    pub first: *mut T,
    /// How many numbers a row has.
    pub stride: usize,
    /// How many blocks of sixteen rows.
    pub blocks: usize,
    /// Whether rows are asked for ahead, since they lie in no near cache.
    pub is_far: bool,
}

impl<T> Rows<T> {
    /// The first row of a block that is read now; what is read next is asked for, if it is far.
    #[inline(always)]
    pub fn block<R: Register<Number = T>>(&self, block: usize) -> *const T {
        let of_block = BLOCK * self.stride;
        let first = self.first.wrapping_add(block * of_block).cast_const();
        if self.is_far {
            // Far enough for memory.
            let ahead = first.wrapping_add((self.blocks + 1) * of_block);
            for at in (0..BLOCK * self.stride.min(MOST_LINES)).step_by(BLOCK) {
                R::prefetch(ahead.wrapping_add(at));
            }
        }
        first
    }
}
