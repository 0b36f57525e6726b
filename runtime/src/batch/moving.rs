//! Rows read to lines and written from them, block after block: by tiles where the unit has them and a block is full, else number by
//! number. Blocks of another precision are lines already, of other numbers.

use core::mem::MaybeUninit;
use core::ops::Range;

use super::numbers::{Number, Storage};
use super::pass::Lines;
use super::registers::BLOCK;
use super::rows::{MOST_LINES, Row, Rows, Tiles};
use super::signals::{Places, View};
use super::units::{Moves, Unit};

/// Room for the tiles of rows: thousands of bytes, which are written where they stay.
pub type Room = MaybeUninit<Tiles>;

/// Rows that are read or written.
pub struct Moving<'t, S: Storage> {
    view: &'t View<S>,
    row: &'t Row,
    stride: usize,
    is_far: bool,
    /// How many blocks are full, and so is what tiles touch of them.
    readable: usize,
    /// How many blocks are full.
    writable: usize,
    tiles: Option<(&'t Tiles, Moves<S::Number>)>,
}

impl<'t, S: Storage> Moving<'t, S> {
    /// Returns the rows of a view, if it is made of rows.
    pub fn new(room: &'t mut Room, view: &'t View<S>, unit: Unit, over: bool, is_far: bool) -> Option<Self> {
        let Places::Rows { stride, row } = &view.places else { return None };
        let stride = *stride;
        let array = row.is_array(stride).then_some(stride);
        let arrays = array.and_then(|count| <S::Number as Number>::arrays(unit, count));
        let tiles = match arrays {
            Some(moves) if S::IS_NUMBER => Some((&*Tiles::none(room), moves)),
            _ => {
                let moves = <S::Number as Number>::moves(unit).filter(|_| S::IS_NUMBER);
                moves.map(|moves| (Tiles::fill(room, row, over, moves.is_wide), moves))
            }
        };
        let touched = tiles.as_ref().map_or(0, |(tiles, _)| tiles.touched);
        let rows = |length: &usize| length.checked_sub(touched).map_or(0, |rest| rest / stride.max(1) + 1);
        let rows = view.lengths[..view.plane_count].iter().map(rows).min().unwrap_or(0);
        let (readable, writable) = (rows.min(view.signals) / BLOCK, view.signals / BLOCK);
        Some(Self { view, row, stride, is_far, readable, writable, tiles })
    }

    /// How many signals of a block there are.
    pub fn filled(&self, block: usize) -> usize {
        (self.view.signals - block * BLOCK).min(BLOCK)
    }

    /// The first row of a block, in a plane.
    fn first(&self, plane: usize, block: usize) -> *mut S {
        self.view.planes[plane].wrapping_add(block * BLOCK * self.stride)
    }

    /// The rows of blocks in a plane.
    fn rows<N>(&self, plane: usize, blocks: &Range<usize>) -> Rows<N> {
        Rows {
            first: self.first(plane, blocks.start).cast(),
            stride: self.stride,
            blocks: blocks.len(),
            is_far: self.is_far,
        }
    }

    /// The rows from a block on, as lines of which a block has as many as of its own: as far as rows have nothing else, all of them.
    pub fn ahead(&self, block: usize) -> Lines<S::Number> {
        let mut lines = Lines::NONE;
        let of_plane = self.row.channels.max(1);
        for (channel, at) in lines.at.iter_mut().enumerate().take(self.view.channels) {
            let first: *mut S::Number = self.first(channel / of_plane, block).cast();
            *at = first.wrapping_add(channel % of_plane * self.row.count * BLOCK);
        }
        Lines { step: self.stride * BLOCK * size_of::<S>() / size_of::<S::Number>(), mask: usize::MAX, ..lines }
    }

    /// Reads blocks, each to lines of `step` numbers.
    ///
    /// # Safety
    ///
    /// The view's memory may be read, and there is room for the lines.
    pub unsafe fn read(&self, blocks: Range<usize>, lines: *mut S::Number, step: usize) {
        for plane in 0..self.view.plane_count {
            let lines = lines.wrapping_add(plane * self.row.channels * self.row.count * BLOCK);
            // SAFETY: the caller's; tiles are read where the last row still has what they touch.
            unsafe {
                match &self.tiles {
                    Some((tiles, moves)) if blocks.end <= self.readable => {
                        let rows = self.rows::<S::Number>(plane, &blocks);
                        (moves.gather)(tiles, rows, lines, step);
                        for k in 0..if tiles.alone().is_empty() { 0 } else { blocks.len() * BLOCK } {
                            for &(column, line) in tiles.alone() {
                                let number = rows.first.add(k * rows.stride + column as usize).read();
                                lines.add(k / BLOCK * step + line as usize * BLOCK + k % BLOCK).write(number);
                            }
                        }
                    }
                    _ => {
                        for (place, block) in blocks.clone().enumerate() {
                            self.read_plainly(plane, block, lines.wrapping_add(place * step));
                        }
                    }
                }
            }
        }
    }

    /// Reads a block number by number: one that is not full, or of another precision.
    ///
    /// # Safety
    ///
    /// As [`read`](Self::read).
    #[inline(never)]
    unsafe fn read_plainly(&self, plane: usize, block: usize, lines: *mut S::Number) {
        let (rows, filled) = (self.first(plane, block), self.filled(block));
        let mut row = [S::Number::default(); MOST_LINES];
        for k in 0..BLOCK {
            // What a block has too much is like the last that is there.
            let first = rows.wrapping_add(k.min(filled - 1) * self.stride);
            self.each_run(|column, line, count| {
                // SAFETY: the caller's.
                unsafe {
                    S::widen(core::slice::from_raw_parts(first.add(column), count), &mut row[..count]);
                    for (i, number) in row[..count].iter().enumerate() {
                        lines.add((line + i) * BLOCK + k).write(*number);
                    }
                }
            });
        }
    }

    /// Writes blocks, each of lines of `step` numbers.
    ///
    /// # Safety
    ///
    /// The view's memory may be written, and there are lines.
    pub unsafe fn write(&self, blocks: Range<usize>, lines: *const S::Number, step: usize) {
        for plane in 0..self.view.plane_count {
            let lines = lines.wrapping_add(plane * self.row.channels * self.row.count * BLOCK);
            // SAFETY: the caller's; tiles touch what they write alone.
            unsafe {
                match &self.tiles {
                    Some((tiles, moves)) if blocks.end <= self.writable => {
                        let rows = self.rows::<S::Number>(plane, &blocks);
                        (moves.scatter)(tiles, lines, step, rows);
                        for k in 0..if tiles.alone().is_empty() { 0 } else { blocks.len() * BLOCK } {
                            for &(column, line) in tiles.alone() {
                                let number = lines.add(k / BLOCK * step + line as usize * BLOCK + k % BLOCK).read();
                                rows.first.add(k * rows.stride + column as usize).write(number);
                            }
                        }
                    }
                    _ => {
                        for (place, block) in blocks.clone().enumerate() {
                            self.write_plainly(plane, block, lines.wrapping_add(place * step));
                        }
                    }
                }
            }
        }
    }

    /// Writes a block number by number: one that is not full, or of another precision.
    ///
    /// # Safety
    ///
    /// As [`write`](Self::write).
    #[inline(never)]
    unsafe fn write_plainly(&self, plane: usize, block: usize, lines: *const S::Number) {
        let rows = self.first(plane, block);
        let mut row = [S::Number::default(); MOST_LINES];
        for k in 0..self.filled(block) {
            let first = rows.wrapping_add(k * self.stride);
            self.each_run(|column, line, count| {
                // SAFETY: the caller's.
                unsafe {
                    for (i, number) in row[..count].iter_mut().enumerate() {
                        *number = lines.add((line + i) * BLOCK + k).read();
                    }
                    S::narrow(&row[..count], core::slice::from_raw_parts_mut(first.add(column), count));
                }
            });
        }
    }

    /// Writes a block of rows that have no gaps past the caches.
    ///
    /// # Safety
    ///
    /// As [`write`](Self::write); the rows have no gaps and are sixteen.
    pub unsafe fn stream(&self, unit: Unit, block: usize, lines: *const S::Number, aside: *mut S::Number) {
        let Some((tiles, moves)) = &self.tiles else { return };
        let to: *mut S::Number = self.first(0, block).cast();
        // SAFETY: the caller's; all columns are in tiles, since they lie side by side.
        unsafe {
            (moves.scatter)(tiles, lines, 0, Rows { first: aside, stride: self.stride, blocks: 1, is_far: false });
            S::Number::stream(unit)(aside, to, BLOCK * self.stride);
        }
    }

    /// Whether rows are written past the caches up to a block, where that is asked for.
    pub fn streams(&self, last: usize) -> bool {
        let has_no_gaps = self.stride == self.row.count * self.row.channels && self.view.plane_count == 1;
        let is_in_tiles = |(tiles, _): &(&Tiles, _)| tiles.alone().is_empty();
        last < self.writable && has_no_gaps && self.tiles.as_ref().is_some_and(is_in_tiles)
    }

    /// Columns side by side that are lines one after the other: the first of both, and how many.
    #[inline(always)]
    fn each_run(&self, mut run: impl FnMut(usize, usize, usize)) {
        let (row, count) = (self.row, self.row.count);
        for channel in 0..row.channels {
            let is_dense = count < 3 || row.column(channel, 2) == row.column(channel, 1) + 1;
            for i in 0..if is_dense { 1 } else { count } {
                run(row.column(channel, i), channel * count + i, 1);
            }
            if is_dense && count > 1 {
                run(row.column(channel, 1), channel * count + 1, count - 1);
            }
        }
    }
}

/// Reads a block's lines of another precision.
///
/// # Safety
///
/// The view is made of blocks that may be read, and there are [`MOST_LINES`] lines.
pub unsafe fn widen<S: Storage>(view: &View<S>, block: usize, lines: *mut S::Number) {
    for channel in 0..view.channels {
        let count = view.count * BLOCK;
        // SAFETY: the caller's.
        unsafe {
            let from = core::slice::from_raw_parts(view.line(channel, block).cast_const(), count);
            S::widen(from, core::slice::from_raw_parts_mut(lines.add(channel * count), count));
        }
    }
}

/// Reads blocks, each to lines of `step` numbers.
///
/// # Safety
///
/// The view may be read, and there are lines for all that the blocks have.
pub unsafe fn read<S: Storage>(
    view: &View<S>,
    rows: &Option<Moving<'_, S>>,
    blocks: Range<usize>,
    first: *mut S::Number,
    step: usize,
) {
    // SAFETY: the caller's.
    unsafe {
        match rows {
            Some(rows) => rows.read(blocks, first, step),
            None => blocks.enumerate().for_each(|(place, block)| widen(view, block, first.wrapping_add(place * step))),
        }
    }
}

/// Writes a block's lines in another precision.
///
/// # Safety
///
/// The view is made of blocks that may be written, and there are as many lines.
pub unsafe fn narrow<S: Storage>(view: &View<S>, block: usize, lines: *const S::Number) {
    for channel in 0..view.channels {
        let count = view.count * BLOCK;
        // SAFETY: the caller's.
        unsafe {
            let to = core::slice::from_raw_parts_mut(view.line(channel, block), count);
            S::narrow(core::slice::from_raw_parts(lines.add(channel * count), count), to);
        }
    }
}
