//! Rows: where the numbers of a signal lie in memory that is not made of blocks, and how sixteen rows become lines of a block
//! and back, four columns at a time.

use super::kernels::MOST_CHANNELS;
use super::registers::{BLOCK, Quads, source};

/// The most coefficients of a channel: order 10.
pub const MOST_COUNT: usize = 100;

/// The most lines that a block has in all its channels, and one for what is of no meaning.
pub const MOST_LINES: usize = MOST_CHANNELS * MOST_COUNT + 1;

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

    /// Returns rows as most programs hold splats: the constants of red, green and blue, then each other coefficient in RGB,
    /// which is [`interleaved`](Self::interleaved); with the constants apart, as the numbers between them say.
    #[must_use]
    pub const fn at(self, offset: usize) -> Self {
        self.apart(offset, offset)
    }

    /// Returns the same rows with the constants moved by one number of places and the other coefficients by another.
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

    /// Returns how many numbers a row has at least.
    #[must_use]
    pub fn width(&self) -> usize {
        let last = |channel| self.column(channel, 0).max(self.column(channel, self.count.saturating_sub(1)));
        (0..self.channels).map(last).max().map_or(0, |last| last + 1)
    }
}

/// Four columns side by side and the line of each.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tile {
    column: u32,
    lines: [u16; 4],
}

/// The columns of a row, four at a time where four lie side by side.
pub struct Tiles {
    tiles: [Tile; MOST_COUNT + 8],
    tile_count: usize,
    /// Columns that lie alone, each with its line.
    alone: [(u32, u16); MOST_LINES],
    alone_count: usize,
    /// How many numbers of a row tiles touch; it may be more than the row has.
    pub touched: usize,
}

impl Tiles {
    /// Returns the columns of a row. Where `over` is so, fewer than four columns side by side are a tile too, which touches what
    /// lies behind them.
    pub fn new(row: &Row, over: bool) -> Self {
        let mut columns = [(0_u32, 0_u16); MOST_LINES];
        let mut known = 0;
        for channel in 0..row.channels {
            for i in 0..row.count {
                columns[known] = (row.column(channel, i) as u32, (channel * row.count + i) as u16);
                known += 1;
            }
        }
        let columns = &mut columns[..known];
        columns.sort_unstable();
        let mut tiles = Self {
            tiles: [Tile::default(); MOST_COUNT + 8],
            tile_count: 0,
            alone: [(0, 0); MOST_LINES],
            alone_count: 0,
            touched: 0,
        };
        let mut at = 0;
        while at < columns.len() {
            let is_next = |i: &usize| columns[*i].0 as usize == columns[at].0 as usize + (i - at);
            let end = (at + 1..columns.len()).take_while(is_next).last().map_or(at + 1, |last| last + 1);
            tiles.add(&columns[at..end], over);
            at = end;
        }
        tiles
    }

    /// Adds columns side by side.
    fn add(&mut self, run: &[(u32, u16)], over: bool) {
        let is_full = self.tile_count + run.len().div_ceil(4) > self.tiles.len();
        if is_full || run.len() < 4 && !(over && run.len() > 1) {
            for &column in run {
                self.alone[self.alone_count] = column;
                self.alone_count += 1;
            }
            return;
        }
        for start in (0..run.len()).step_by(4) {
            // The last tile begins where it ends with the run.
            let start = start.min(run.len().saturating_sub(4));
            let line = |i: usize| run.get(start + i).map_or(MOST_LINES as u16 - 1, |column| column.1);
            self.tiles[self.tile_count] = Tile { column: run[start].0, lines: [0, 1, 2, 3].map(line) };
            self.touched = self.touched.max(run[start].0 as usize + 4);
            self.tile_count += 1;
        }
    }

    /// The tiles.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles[..self.tile_count]
    }

    /// The columns that lie alone, each with its line.
    pub fn alone(&self) -> &[(u32, u16)] {
        &self.alone[..self.alone_count]
    }

    /// Reads sixteen rows to lines.
    ///
    /// # Safety
    ///
    /// The rows are there as far as the tiles touch them, and so are [`MOST_LINES`] lines; the function around is compiled for
    /// the unit of the register, which the processor has.
    #[inline(always)]
    pub unsafe fn gather<R: Quads>(rows: *const R::Number, stride: usize, tiles: &[Tile], lines: *mut R::Number) {
        for part in 0..R::PARTS {
            for tile in tiles {
                let first = part * R::LANES * stride + tile.column as usize;
                // SAFETY: the caller's.
                unsafe {
                    let row = source(#[inline(always)] |i: usize| R::gather(rows.add(first + i * stride), 4 * stride));
                    let columns = R::transpose([row(0), row(1), row(2), row(3)]);
                    for (line, column) in tile.lines.iter().zip(columns) {
                        column.store(lines.add(*line as usize * BLOCK + part * R::LANES));
                    }
                }
            }
        }
    }

    /// Writes lines to sixteen rows.
    ///
    /// # Safety
    ///
    /// As [`gather`](Self::gather), and the rows are nobody else's.
    #[inline(always)]
    pub unsafe fn scatter<R: Quads>(lines: *const R::Number, tiles: &[Tile], rows: *mut R::Number, stride: usize) {
        for part in 0..R::PARTS {
            for tile in tiles {
                let first = part * R::LANES * stride + tile.column as usize;
                // SAFETY: the caller's.
                unsafe {
                    let line = source(#[inline(always)] |i: usize| R::load(lines.add(tile.lines[i] as usize * BLOCK + part * R::LANES)));
                    let quads = R::transpose([line(0), line(1), line(2), line(3)]);
                    for (i, quad) in quads.into_iter().enumerate() {
                        quad.scatter(rows.add(first + i * stride), 4 * stride);
                    }
                }
            }
        }
    }
}
