//! A kernel over many signals in any layouts: blocks are worked on where they lie, rows sixteen at a time through lines on the
//! stack. Sizes are checked before anything is touched.

use core::mem::MaybeUninit;
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};

use super::kernels::{Lines, MOST_CHANNELS, Pass};
use super::registers::BLOCK;
use super::rows::{MOST_LINES, Row, Tiles};
use super::signals::{Places, Storage, View};
use super::units::{Moves, Number, Run, Unit};
use crate::error::Error;

/// From how many bytes of results on they are written past the caches.
static STREAMS_FROM: AtomicUsize = AtomicUsize::new(16 << 20);

/// Writes results past the caches from so many bytes a call on, for all of the program: half of the last cache is a good value, and
/// 16 MiB what is used if nothing is said. Only blocks, and rows without gaps, can be written so.
pub fn stream_from(bytes: usize) {
    STREAMS_FROM.store(bytes, Ordering::Relaxed);
}

/// The parameters of a kernel.
pub(super) enum Params<'a, T> {
    /// There are none.
    None,
    /// The same for every signal.
    Shared(&'a [T]),
    /// Each signal has its own.
    Each(View<T>),
}

/// The signals of a kernel.
pub(super) enum Input<S: Storage> {
    /// There are none.
    None,
    /// The same for every result: numbers of each channel.
    Shared([*const S::Number; MOST_CHANNELS]),
    /// A result each.
    Each(View<S>),
}

/// A kernel and all that it works on.
pub(super) struct Task<'a, S: Storage, D: Storage<Number = S::Number>> {
    /// The kernel; without one, signals are copied.
    pub run: Option<Run<S::Number>>,
    pub unit: Unit,
    pub params: Params<'a, S::Number>,
    pub from: Input<S>,
    pub other: Option<View<S>>,
    pub to: View<D>,
}

// SAFETY: what it points to is borrowed for as long as it is there, and threads write to different blocks.
unsafe impl<S: Storage, D: Storage<Number = S::Number>> Sync for Task<'_, S, D> {}

/// Lines on the stack: those of a block, in all its channels.
#[repr(C, align(64))]
struct Aside<T>(MaybeUninit<[[T; BLOCK]; MOST_LINES]>);

impl<T> Aside<T> {
    fn new() -> Self {
        Self(MaybeUninit::uninit())
    }

    fn first(&mut self) -> *mut T {
        self.0.as_mut_ptr().cast()
    }
}

/// How many blocks' parameters are read at once: four lines each.
const READ_AT_ONCE: usize = 8;

/// How many parameters a signal has at most.
const MOST_PARAMS: usize = 4;

/// Rows that are read or written.
struct Rows<S: Storage> {
    view: View<S>,
    stride: usize,
    row: Row,
    tiles: Option<(Tiles, Moves<S::Number>)>,
}

impl<S: Storage> Rows<S> {
    /// The rows of a view, if it is made of rows that are no lines.
    fn of(view: View<S>, unit: Unit, over: bool) -> Option<Self> {
        let Places::Rows { stride, row } = view.places else { return None };
        let moves = <S::Number as Number>::moves(unit).filter(|_| S::IS_NUMBER);
        Some(Self { view, stride, row, tiles: moves.map(|moves| (Tiles::new(&row, over), moves)) })
    }

    /// How many signals of a block there are.
    fn filled(&self, block: usize) -> usize {
        (self.view.signals - block * BLOCK).min(BLOCK)
    }

    /// The first row of a block, in a plane.
    fn first(&self, plane: usize, block: usize) -> *mut S {
        self.view.planes[plane].wrapping_add(block * BLOCK * self.stride)
    }

    /// Reads a block.
    ///
    /// # Safety
    ///
    /// The view's memory may be read, and there are [`MOST_LINES`] lines.
    unsafe fn read(&self, block: usize, lines: *mut S::Number) {
        let filled = self.filled(block);
        for plane in 0..self.view.plane_count {
            let rows = self.first(plane, block);
            let lines = lines.wrapping_add(plane * self.row.channels * self.row.count * BLOCK);
            // SAFETY: the caller's; a tile is read where the last row still has what it touches.
            unsafe {
                if let Some((tiles, moves)) = &self.tiles {
                    let end = (block * BLOCK + BLOCK - 1) * self.stride + tiles.touched;
                    if filled == BLOCK && end <= self.view.lengths[plane] {
                        (moves.gather)(rows.cast_const().cast(), self.stride, tiles.tiles(), lines);
                        for &(column, line) in tiles.alone() {
                            for k in 0..BLOCK {
                                let number = rows.add(k * self.stride + column as usize).cast::<S::Number>().read();
                                lines.add(line as usize * BLOCK + k).write(number);
                            }
                        }
                        continue;
                    }
                }
                let mut row = [S::Number::default(); MOST_LINES];
                for k in 0..BLOCK {
                    // What a block has too much is like the last that is there.
                    let first = rows.add(k.min(filled - 1) * self.stride);
                    self.each_run(|column, line, count| {
                        S::widen(core::slice::from_raw_parts(first.add(column), count), &mut row[..count]);
                        for (i, number) in row[..count].iter().enumerate() {
                            lines.add(line(i) * BLOCK + k).write(*number);
                        }
                    });
                }
            }
        }
    }

    /// Writes a block.
    ///
    /// # Safety
    ///
    /// The view's memory may be written, and there are as many lines as it has numbers.
    unsafe fn write(&self, block: usize, lines: *const S::Number) {
        let filled = self.filled(block);
        for plane in 0..self.view.plane_count {
            let rows = self.first(plane, block);
            let lines = lines.wrapping_add(plane * self.row.channels * self.row.count * BLOCK);
            // SAFETY: the caller's; tiles touch what they write alone.
            unsafe {
                if let Some((tiles, moves)) = self.tiles.as_ref().filter(|_| filled == BLOCK) {
                    (moves.scatter)(lines, tiles.tiles(), rows.cast(), self.stride);
                    for &(column, line) in tiles.alone() {
                        for k in 0..BLOCK {
                            let number = lines.add(line as usize * BLOCK + k).read();
                            rows.add(k * self.stride + column as usize).cast::<S::Number>().write(number);
                        }
                    }
                    continue;
                }
                let mut row = [S::Number::default(); MOST_LINES];
                for k in 0..filled {
                    let first = rows.add(k * self.stride);
                    self.each_run(|column, line, count| {
                        for (i, number) in row[..count].iter_mut().enumerate() {
                            *number = lines.add(line(i) * BLOCK + k).read();
                        }
                        S::narrow(&row[..count], core::slice::from_raw_parts_mut(first.add(column), count));
                    });
                }
            }
        }
    }

    /// Writes a block of rows that have no gaps past the caches.
    ///
    /// # Safety
    ///
    /// As [`write`](Self::write); the rows have no gaps, are sixteen, and begin at a multiple of 16 bytes.
    unsafe fn stream(&self, unit: Unit, block: usize, lines: *const S::Number, aside: *mut S::Number) {
        let Some((tiles, moves)) = &self.tiles else { return };
        let to: *mut S::Number = self.first(0, block).cast();
        let unit = if to.align_offset(64) == 0 { unit } else { Unit::Base };
        // SAFETY: the caller's; all columns are in tiles, since they lie side by side.
        unsafe {
            (moves.scatter)(lines, tiles.tiles(), aside, self.stride);
            S::Number::stream(unit)(aside, to, BLOCK * self.stride);
        }
    }

    /// Whether rows are written past the caches.
    fn streams(&self) -> bool {
        let has_no_gaps = self.stride == self.row.count * self.row.channels && self.view.plane_count == 1;
        let is_in_tiles = |(tiles, _): &(Tiles, _)| tiles.alone().is_empty();
        let is_aligned = self.view.planes[0].align_offset(16) == 0 && (self.stride * size_of::<S>()).is_multiple_of(4);
        has_no_gaps && is_aligned && self.tiles.as_ref().is_some_and(is_in_tiles)
    }

    /// Columns side by side that are lines one after the other, or all of one number: the first column, the line of each, how many.
    #[inline(always)]
    fn each_run(&self, mut run: impl FnMut(usize, &dyn Fn(usize) -> usize, usize)) {
        let (row, count) = (&self.row, self.row.count);
        for channel in 0..row.channels {
            let is_dense = count < 3 || row.column(channel, 2) == row.column(channel, 1) + 1;
            let start = if is_dense { 1 } else { count };
            for i in 0..start.min(count) {
                run(row.column(channel, i), &|_| channel * count + i, 1);
            }
            if is_dense && count > 1 {
                run(row.column(channel, 1), &|i| channel * count + 1 + i, count - 1);
            }
        }
    }
}

/// Reads a block's lines of another precision.
///
/// # Safety
///
/// The view is made of blocks that may be read, and there are [`MOST_LINES`] lines.
unsafe fn widen<S: Storage>(view: &View<S>, block: usize, lines: *mut S::Number) {
    for channel in 0..view.channels {
        let count = view.count * BLOCK;
        // SAFETY: the caller's.
        unsafe {
            let from = core::slice::from_raw_parts(view.line(channel, block).cast_const(), count);
            S::widen(from, core::slice::from_raw_parts_mut(lines.add(channel * count), count));
        }
    }
}

/// Writes a block's lines in another precision.
///
/// # Safety
///
/// The view is made of blocks that may be written, and there are as many lines.
unsafe fn narrow<S: Storage>(view: &View<S>, block: usize, lines: *const S::Number) {
    for channel in 0..view.channels {
        let count = view.count * BLOCK;
        // SAFETY: the caller's.
        unsafe {
            let to = core::slice::from_raw_parts_mut(view.line(channel, block), count);
            S::narrow(core::slice::from_raw_parts(lines.add(channel * count), count), to);
        }
    }
}

/// Makes of each block's lines others by a function of every channel.
///
/// # Errors
///
/// If there are not as many results as signals.
pub(super) fn map<S: Storage, D: Storage<Number = S::Number>>(
    from: &View<S>,
    to: &View<D>,
    of: impl Fn(*const S::Number, *mut S::Number),
) -> Result<(), Error> {
    let unit = Unit::used();
    let task = Task { run: None, unit, params: Params::None, from: Input::Each(*from), other: None, to: *to };
    task.check()?;
    let (from_rows, to_rows) = (Rows::of(*from, unit, true), Rows::of(*to, unit, false));
    let (mut given, mut made) = (Aside::<S::Number>::new(), Aside::new());
    for block in 0..to.block_count() {
        let (given, made): (*mut S::Number, *mut S::Number) = (given.first(), made.first());
        // SAFETY: sizes are checked and what made the views is borrowed by the function that calls; every line is written before
        // it is read.
        unsafe {
            match &from_rows {
                Some(rows) => rows.read(block, given),
                None => widen(from, block, given),
            }
            for channel in 0..to.channels {
                of(given.add(channel * from.count * BLOCK), made.add(channel * to.count * BLOCK));
            }
            match &to_rows {
                Some(rows) => rows.write(block, made),
                None => narrow(to, block, made),
            }
        }
    }
    Ok(())
}

/// Where a view's blocks lie, if a kernel may work on them there.
fn direct<S: Storage>(view: &View<S>, blocks: &Range<usize>) -> Option<Lines<*mut S::Number>> {
    let is_whole = view.signals.is_multiple_of(BLOCK) || blocks.end < view.block_count();
    (S::IS_NUMBER && view.is_lines() && is_whole).then(|| {
        let mut at = [core::ptr::null_mut(); MOST_CHANNELS];
        for (channel, at) in at.iter_mut().enumerate().take(view.channels) {
            *at = view.line(channel, blocks.start).cast();
        }
        Lines { at, step: view.step() }
    })
}

/// The lines of a block on the stack.
fn aside<T>(first: *mut T, count: usize, step: usize) -> Lines<*mut T> {
    Lines { at: [0, 1, 2, 3].map(|channel| first.wrapping_add(channel * count * BLOCK)), step }
}

fn shared<T>(lines: &Lines<*mut T>) -> Lines<*const T> {
    Lines { at: lines.at.map(<*mut T>::cast_const), step: lines.step }
}

fn nowhere<T>() -> Lines<*const T> {
    Lines { at: [core::ptr::null(); MOST_CHANNELS], step: 0 }
}

impl<S: Storage, D: Storage<Number = S::Number>> Task<'_, S, D> {
    /// Checks that there are as many of everything.
    ///
    /// # Errors
    ///
    /// If there are not.
    pub fn check(&self) -> Result<(), Error> {
        let planes = |lengths: &[usize]| lengths.windows(2).all(|pair| pair[0] == pair[1]);
        let is_even = |view: &View<S>| planes(&view.lengths[..view.plane_count]);
        let of_from = if let Input::Each(view) = &self.from { Some(view) } else { None };
        let are_even = of_from.is_none_or(is_even)
            && self.other.as_ref().is_none_or(is_even)
            && planes(&self.to.lengths[..self.to.plane_count]);
        if !are_even {
            return Err(Error::Planes);
        }
        let fits = |blocks: bool, found: usize| match blocks || matches!(self.to.places, Places::Blocks) {
            true => found.div_ceil(BLOCK) == self.to.block_count(),
            false => found == self.to.signals,
        };
        let is_blocks = |places: &Places| *places == Places::Blocks;
        if let Params::Each(view) = &self.params
            && !fits(is_blocks(&view.places), view.signals)
        {
            return Err(Error::Batch { found: view.signals, results: self.to.signals });
        }
        for view in of_from.into_iter().chain(&self.other) {
            if !fits(is_blocks(&view.places), view.signals) {
                return Err(Error::Batch { found: view.signals, results: self.to.signals });
            }
        }
        Ok(())
    }

    /// Runs the kernel over some of the blocks.
    ///
    /// # Safety
    ///
    /// [`check`](Self::check) has passed, the views' memory is borrowed, and nobody else touches these blocks of the results.
    pub unsafe fn over(&self, blocks: Range<usize>) {
        if blocks.is_empty() {
            return;
        }
        // The last block may be half empty, so that it is worked on by itself.
        let last = self.to.block_count() - 1;
        if blocks.end > last && blocks.start < last {
            // SAFETY: the caller's.
            unsafe {
                self.part(blocks.start..last);
                self.part(last..blocks.end);
            }
            return;
        }
        // SAFETY: the caller's.
        unsafe { self.part(blocks) }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    unsafe fn part(&self, blocks: Range<usize>) {
        let unit = self.unit;
        let as_lines = if let Input::Each(view) = &self.from { direct(view, &blocks) } else { None };
        let other_lines = self.other.as_ref().and_then(|view| direct(view, &blocks));
        let to_lines = direct(&self.to, &blocks);
        let is_plain = |lines: &Option<Lines<_>>, is_there: bool| lines.is_some() || !is_there;
        let at_once = match is_plain(&as_lines, matches!(self.from, Input::Each(_)))
            && is_plain(&other_lines, self.other.is_some())
            && to_lines.is_some()
        {
            true => READ_AT_ONCE,
            false => 1,
        };
        let param_rows = if let Params::Each(view) = &self.params { Rows::of(*view, unit, true) } else { None };
        let param_lines = if let Params::Each(view) = &self.params { direct(view, &blocks) } else { None };
        let from_rows = if let Input::Each(view) = &self.from { Rows::of(*view, unit, true) } else { None };
        let other_rows = self.other.and_then(|view| Rows::of(view, unit, true));
        let to_rows = Rows::of(self.to, unit, false);
        let is_in_place = matches!(&self.from, Input::Each(view) if view.planes[0].cast::<D>() == self.to.planes[0]);
        let is_large = self.to.bytes() >= STREAMS_FROM.load(Ordering::Relaxed) && !is_in_place;
        let is_aligned = |at: &*mut S::Number| at.is_null() || at.align_offset(64) == 0;
        let streams = is_large && to_lines.as_ref().is_some_and(|lines| lines.at.iter().all(is_aligned));
        let (mut params_aside, mut from_aside, mut other_aside, mut to_aside) =
            (Aside::<S::Number>::new(), Aside::new(), Aside::new(), Aside::new());
        // Without parameters in rows nothing is read ahead, and one call does all that lies in lines.
        let is_whole = at_once > 1 && (param_lines.is_some() || !matches!(self.params, Params::Each(_)));
        let mut start = blocks.start;
        while start < blocks.end {
            let end = if is_whole { blocks.end } else { (start + at_once).min(blocks.end) };
            let within = start - blocks.start;
            let forward = |lines: &Lines<*mut S::Number>| Lines {
                at: lines.at.map(|at| at.wrapping_add(within * lines.step)),
                step: lines.step,
            };
            // SAFETY: the caller's; what lies aside has room for the lines of as many blocks as are read at once.
            unsafe {
                let params = match (&self.params, &param_lines) {
                    (Params::None, _) => nowhere(),
                    (Params::Shared(numbers), _) => Lines { at: [numbers.as_ptr(); MOST_CHANNELS], step: 0 },
                    (Params::Each(_), Some(lines)) => shared(&forward(lines)),
                    (Params::Each(view), None) => {
                        let first = params_aside.first();
                        for block in start..end {
                            let lines = first.add((block - start) * MOST_PARAMS * BLOCK);
                            match &param_rows {
                                Some(rows) => rows.read(block, lines),
                                None => widen(view, block, lines),
                            }
                        }
                        shared(&aside(first, 0, MOST_PARAMS * BLOCK))
                    }
                };
                let mut taken = None;
                let from = match (&self.from, &as_lines) {
                    (Input::None, _) => nowhere(),
                    (Input::Shared(at), _) => Lines { at: *at, step: 0 },
                    (Input::Each(_), Some(lines)) => shared(&forward(lines)),
                    (Input::Each(view), None) => {
                        let first = from_aside.first();
                        match &from_rows {
                            Some(rows) => rows.read(start, first),
                            None => widen(view, start, first),
                        }
                        taken = Some(first);
                        shared(&aside(first, view.count, 0))
                    }
                };
                let other = match (&self.other, &other_lines) {
                    (None, _) => nowhere(),
                    (Some(_), Some(lines)) => shared(&forward(lines)),
                    (Some(view), None) => {
                        let first = other_aside.first();
                        match &other_rows {
                            Some(rows) => rows.read(start, first),
                            None => widen(view, start, first),
                        }
                        shared(&aside(first, view.count, 0))
                    }
                };
                // A kernel of one signal to one may write where it reads.
                let is_one_to_one = matches!(&self.from, Input::Each(view) if view.count == self.to.count);
                let first = match taken.filter(|_| is_one_to_one && self.other.is_none()) {
                    Some(first) => first,
                    None => to_aside.first(),
                };
                let to = match &to_lines {
                    Some(lines) => forward(lines),
                    None => aside(first, self.to.count, 0),
                };
                let pass = Pass { blocks: end - start, channels: self.to.channels, params, from, other, to, streams };
                match self.run {
                    Some(run) => run(&pass),
                    None => super::kernels::copy_lines(&pass, self.to.count),
                }
                if to_lines.is_none() {
                    match &to_rows {
                        Some(rows) if is_large && rows.streams() && rows.filled(start) == BLOCK => {
                            rows.stream(unit, start, first, other_aside.first());
                        }
                        Some(rows) => rows.write(start, first),
                        None => narrow(&self.to, start, first),
                    }
                }
            }
            start = end;
        }
    }
}
