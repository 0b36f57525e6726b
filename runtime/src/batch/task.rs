//! A kernel over many signals in any layouts: blocks are worked on where they lie, rows sixteen at a time through lines on the
//! stack. Sizes are checked before anything is touched.

use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};

use super::moving::{Moving, Room, narrow, read};
use super::numbers::Storage;
use super::pass::{Aside, GROUPS, Lines, MOST_CHANNELS, Pass, blocks_ahead};
use super::registers::BLOCK;
use super::room::{FEW_LINES, MOST_GROUP, Needs, ROOM_LINES, aside};
use super::rows::MOST_LINES;
use super::signals::{Places, View};
use super::units::{Run, Unit, fence};
use crate::error::Error;

/// From how many bytes of signals and results on results are written past the caches.
static STREAMS_FROM: AtomicUsize = AtomicUsize::new(16 << 20);

/// From how many bytes of signals and results on signals lie in no cache of the core's own.
const FAR_FROM: usize = 1 << 20;

/// Writes results past the caches where a call's signals and results take so many bytes or more, for all of the program: half of the
/// last cache is a good value, and 16 MiB what is used if nothing is said. Only blocks, and rows without gaps, can be written so.
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

impl<T> Params<'_, T> {
    /// Where each signal's own are, if it has any.
    fn view(&self) -> Option<&View<T>> {
        if let Self::Each(view) = self { Some(view) } else { None }
    }
}

impl<S: Storage> Input<S> {
    /// Where the signals are, if there is one for each result.
    fn view(&self) -> Option<&View<S>> {
        if let Self::Each(view) = self { Some(view) } else { None }
    }
}

/// What reads and writes rows for a task, where it has any.
pub(super) struct Moved<'t, S: Storage, D: Storage<Number = S::Number>> {
    params: Option<Moving<'t, S::Number>>,
    from: Option<Moving<'t, S>>,
    other: Option<Moving<'t, S>>,
    to: Option<Moving<'t, D>>,
    /// What turns rows as they are.
    #[cfg(all(target_arch = "x86_64", feature = "order4"))]
    diagonals: Option<super::diagonals::Diagonals>,
}

/// Room for the tiles of all rows of a task.
pub(super) type Rooms = [Room; 4];

/// Returns room that nothing is written to.
#[inline(always)]
pub(super) const fn rooms() -> Rooms {
    [const { Room::uninit() }; 4]
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

/// Room for the lines of a block in all its channels.
type LinesAside<S> = Aside<[[<S as Storage>::Number; BLOCK]; MOST_LINES]>;

/// How many parameters a signal has at most.
const MOST_PARAMS: usize = 4;

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
    let mut rooms = rooms();
    let Moved { from: from_rows, to: to_rows, .. } = task.moves(&mut rooms);
    let (mut given, mut made) = (LinesAside::<S>::new(), LinesAside::<S>::new());
    for block in 0..to.block_count() {
        let (given, made): (*mut S::Number, *mut S::Number) = (given.first(), made.first());
        // SAFETY: sizes are checked and what made the views is borrowed by the function that calls; every line is written before
        // it is read.
        unsafe {
            read(from, &from_rows, block..block + 1, given, 0);
            for channel in 0..to.channels {
                of(given.add(channel * from.count * BLOCK), made.add(channel * to.count * BLOCK));
            }
            match &to_rows {
                Some(rows) => rows.write(block..block + 1, made, 0),
                None => narrow(to, block, made),
            }
        }
    }
    Ok(())
}

/// Says where a view's blocks lie, if a kernel may work on them there.
#[inline]
fn direct<S: Storage>(view: &View<S>, blocks: &Range<usize>, lines: &mut Lines<S::Number>) -> bool {
    let is_whole = view.signals.is_multiple_of(BLOCK) || blocks.end < view.block_count();
    let is_there = S::IS_NUMBER && view.is_lines() && is_whole;
    if is_there {
        for channel in 0..view.channels.min(MOST_CHANNELS) {
            lines.at[channel] = view.line(channel, blocks.start).cast();
        }
        (lines.step, lines.mask) = (view.step(), usize::MAX);
    }
    is_there
}

/// What of a task lies in lines, so that a kernel may work on it where it lies.
#[derive(Clone, Copy)]
struct There {
    params: bool,
    from: bool,
    other: bool,
    to: bool,
}

impl There {
    fn is_all(self) -> bool {
        self.params && self.from && self.other && self.to
    }
}

/// Whether lines may be written past the caches.
fn are_aligned<T>(lines: &Lines<T>) -> bool {
    lines.at.iter().all(|at| at.is_null() || at.align_offset(64) == 0)
}

/// How many signals a view has, if they are not as many as there are results: blocks may have some too many.
fn misfit<T, D>(view: Option<&View<T>>, to: &View<D>) -> Option<usize> {
    let view = view?;
    let are_blocks = matches!((&view.places, &to.places), (Places::Blocks, _) | (_, Places::Blocks));
    let fits = if are_blocks { view.block_count() == to.block_count() } else { view.signals == to.signals };
    (!fits).then_some(view.signals)
}

impl<S: Storage, D: Storage<Number = S::Number>> Task<'_, S, D> {
    /// Checks that there are as many of everything.
    ///
    /// # Errors
    ///
    /// If there are not.
    pub fn check(&self) -> Result<(), Error> {
        let are_even = self.from.view().is_none_or(View::is_even)
            && self.other.as_ref().is_none_or(View::is_even)
            && self.to.is_even();
        if !are_even {
            return Err(Error::Planes);
        }
        let to = &self.to;
        let misfit = misfit(self.params.view(), to)
            .or_else(|| misfit(self.from.view(), to))
            .or_else(|| misfit(self.other.as_ref(), to));
        misfit.map_or(Ok(()), |found| Err(Error::Batch { found, results: to.signals }))
    }

    /// Returns the rotation of all rows as diagonals, if it is one and they are rows for it.
    #[cfg(all(target_arch = "x86_64", feature = "order4"))]
    fn diagonals(&self) -> Option<super::diagonals::Diagonals> {
        let (Params::Shared(quaternion), Input::Each(from)) = (&self.params, &self.from) else { return None };
        let (from, to) = (from.singles()?, self.to.singles()?);
        let q = <[S::Number; 4]>::try_from(*quaternion).ok()?.map(|x| x.into() as f32);
        super::diagonals::Diagonals::new(self.unit, q, &from, &to, self.streams(self.bytes()))
    }

    /// How many bytes signals and results are.
    fn bytes(&self) -> usize {
        self.from.view().map_or(0, View::bytes) + self.to.bytes()
    }

    /// Whether results are written past the caches, where they can be: there are many bytes, and they do not lie where the signals
    /// were just read.
    fn streams(&self, bytes: usize) -> bool {
        let view = self.from.view();
        let is_in_place = view.is_some_and(|view| view.planes[0].cast::<D>() == self.to.planes[0]);
        bytes >= STREAMS_FROM.load(Ordering::Relaxed) && !is_in_place
    }

    /// Returns what reads and writes rows, for all of the blocks.
    pub fn moves<'t>(&'t self, [params, from, other, to]: &'t mut Rooms) -> Moved<'t, S, D> {
        #[cfg(all(target_arch = "x86_64", feature = "order4"))]
        if let Some(diagonals) = self.diagonals() {
            return Moved { params: None, from: None, other: None, to: None, diagonals: Some(diagonals) };
        }
        let (unit, is_far) = (self.unit, self.bytes() >= FAR_FROM);
        Moved {
            params: self.params.view().and_then(|view| Moving::new(params, view, unit, true, is_far)),
            from: self.from.view().and_then(|view| Moving::new(from, view, unit, true, is_far)),
            other: self.other.as_ref().and_then(|view| Moving::new(other, view, unit, true, is_far)),
            to: Moving::new(to, &self.to, unit, false, is_far),
            #[cfg(all(target_arch = "x86_64", feature = "order4"))]
            diagonals: None,
        }
    }

    /// Runs the kernel over all blocks.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    pub unsafe fn all(&self) {
        let blocks = 0..self.to.block_count();
        // SAFETY: the caller's. What lies in lines needs none of the tables for rows.
        unsafe {
            let mut pass = self.pass(&blocks);
            match self.place(&mut pass, &blocks).is_all() {
                true => self.call(&pass),
                false => self.all_over(blocks),
            }
        }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(never)]
    unsafe fn all_over(&self, blocks: Range<usize>) {
        // SAFETY: the caller's.
        unsafe { self.over(&self.moves(&mut rooms()), blocks) }
    }

    /// Runs the kernel over some of the blocks.
    ///
    /// # Safety
    ///
    /// [`check`](Self::check) has passed, the views' memory is borrowed, and nobody else touches these blocks of the results.
    pub unsafe fn over(&self, moves: &Moved<'_, S, D>, blocks: Range<usize>) {
        if blocks.is_empty() {
            return;
        }
        #[cfg(all(target_arch = "x86_64", feature = "order4"))]
        if let Some(diagonals) = &moves.diagonals {
            // SAFETY: the caller's; they are there where the processor has the unit.
            unsafe { diagonals.over(blocks) }
            return;
        }
        // A last block that is not full is worked on by itself.
        let views = [self.to.signals].into_iter().chain(self.signals());
        let is_full = views.into_iter().all(|signals| signals.is_multiple_of(BLOCK));
        let last = self.to.block_count().saturating_sub(1);
        let middle = if is_full { blocks.end } else { blocks.end.min(last).max(blocks.start) };
        for part in [blocks.start..middle, middle..blocks.end] {
            if !part.is_empty() {
                // SAFETY: the caller's.
                unsafe { self.part(moves, part) }
            }
        }
    }

    /// How many signals and parameters there are.
    fn signals(&self) -> impl Iterator<Item = usize> {
        let params = self.params.view().map(|view| view.signals);
        params.into_iter().chain(self.from.view().into_iter().chain(&self.other).map(|view| view.signals))
    }

    /// Returns a pass over some blocks, of which nothing has a place.
    fn pass(&self, blocks: &Range<usize>) -> Pass<'static, S::Number> {
        let (count, bytes) = (blocks.len(), self.bytes());
        let (is_far, streams) = (bytes >= FAR_FROM, self.streams(bytes));
        Pass { blocks: count, group: count, channels: self.to.channels, is_far, streams, ..Pass::nowhere() }
    }

    /// Places what lies in lines. What all blocks share is lines wherever it is, and so is what there is none of.
    fn place(&self, pass: &mut Pass<'_, S::Number>, blocks: &Range<usize>) -> There {
        let there = There {
            params: match &self.params {
                Params::None => true,
                Params::Shared(numbers) => {
                    pass.params.at[0] = numbers.as_ptr().cast_mut();
                    true
                }
                Params::Each(view) => direct(view, blocks, &mut pass.params),
            },
            from: match &self.from {
                Input::None => true,
                Input::Shared(at) => {
                    pass.from.at = at.map(<*const S::Number>::cast_mut);
                    true
                }
                Input::Each(view) => direct(view, blocks, &mut pass.from),
            },
            other: self.other.as_ref().is_none_or(|view| direct(view, blocks, &mut pass.other)),
            to: direct(&self.to, blocks, &mut pass.to),
        };
        pass.ahead = pass.from.later(blocks_ahead(self.from.view().map_or(1, |view| view.count)));
        pass.streams &= there.to && are_aligned(&pass.to);
        there
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    unsafe fn part(&self, moves: &Moved<'_, S, D>, blocks: Range<usize>) {
        // SAFETY: the caller's.
        unsafe {
            let mut pass = self.pass(&blocks);
            let there = self.place(&mut pass, &blocks);
            if there.is_all() {
                self.call(&pass);
            } else if self.needs(there).lines(1) <= FEW_LINES {
                self.through_lines::<FEW_LINES>(moves, blocks, &pass, there);
            } else {
                self.through_lines::<ROOM_LINES>(moves, blocks, &pass, there);
            }
        }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over), and the pass is over its blocks.
    unsafe fn call(&self, pass: &Pass<'_, S::Number>) {
        // SAFETY: the caller's.
        unsafe {
            match self.run {
                Some(run) => run(pass),
                None => super::kernels::copy_lines(pass, self.to.count),
            }
        }
    }

    /// Returns the lines that a block needs on the stack.
    fn needs(&self, there: There) -> Needs {
        let lines = |view: Option<&View<S>>, is_there: bool| {
            view.filter(|_| !is_there).map_or(0, |view| view.count * view.channels)
        };
        let from = lines(self.from.view(), there.from);
        let other = lines(self.other.as_ref(), there.other);
        let to = if there.to { 0 } else { self.to.count * self.to.channels };
        // A kernel of one signal to one may write where it reads.
        Needs { from, other, to, is_in_place: from == to && self.other.is_none() }
    }

    /// Works on blocks that do not all lie in lines: each is read to lines on the stack while another is worked on.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(never)]
    unsafe fn through_lines<const LINES: usize>(
        &self,
        moves: &Moved<'_, S, D>,
        blocks: Range<usize>,
        placed: &Pass<'_, S::Number>,
        there: There,
    ) {
        let (unit, start, count) = (self.unit, blocks.start, self.to.count);
        let Moved { params: param_rows, from: from_rows, other: other_rows, to: to_rows, .. } = moves;
        let mut params_room = Aside::<[[S::Number; BLOCK]; GROUPS * MOST_GROUP * MOST_PARAMS]>::new();
        let mut room = Aside::<[[S::Number; BLOCK]; LINES]>::new();
        let params_first: *mut S::Number = params_room.first();
        let needs = self.needs(there);
        let is_large = self.streams(self.bytes());
        // What goes to memory goes evenly.
        let group = if is_large { 1 } else { needs.group(LINES) };
        let first: *mut S::Number = room.first();
        let [from_first, other_first, to_first, together] =
            needs.places(group).map(|line| first.wrapping_add(line * BLOCK));

        // What is no lines is read to some.
        let params_read = self.params.view().filter(|_| !there.params);
        let from_read = self.from.view().filter(|_| !there.from);
        let other_read = self.other.as_ref().filter(|_| !there.other);
        let step = |view: &View<S>| view.count * view.channels * BLOCK;
        let read_to = |first: *mut S::Number, view: Option<&View<S>>| {
            let (count, step) = view.map_or((0, 0), |view| (view.count, step(view)));
            aside(first, count, step, group)
        };
        let read = |blocks: Range<usize>| {
            let (place, blocks) = (blocks.start % (GROUPS * group), start + blocks.start..start + blocks.end);
            // SAFETY: the caller's; what lies aside has room for the lines of as many blocks as have a place.
            unsafe {
                if let Some(view) = params_read {
                    let step = MOST_PARAMS * BLOCK;
                    read(view, param_rows, blocks.clone(), params_first.wrapping_add(place * step), step);
                }
                for (view, rows, first) in [(from_read, from_rows, from_first), (other_read, other_rows, other_first)] {
                    if let Some(view) = view {
                        read(view, rows, blocks.clone(), first.wrapping_add(place * step(view)), step(view));
                    }
                }
            }
        };

        let to_step = count * self.to.channels * BLOCK;
        let to_aside = aside(to_first, count, to_step, group);
        let write = |blocks: Range<usize>| {
            let (lines, blocks) = (to_aside.block(0, blocks.start), start + blocks.start..start + blocks.end);
            let line = |block: usize| lines.wrapping_add((block - blocks.start) * to_step).cast_const();
            // SAFETY: the caller's; the kernel has written the lines.
            unsafe {
                match to_rows {
                    Some(rows) if is_large && rows.streams(blocks.end - 1) => {
                        blocks.clone().for_each(|block| rows.stream(unit, block, line(block), together));
                    }
                    Some(rows) => rows.write(blocks, lines, to_step),
                    None => blocks.clone().for_each(|block| narrow(&self.to, block, line(block))),
                }
            }
        };
        let mut pass = Pass {
            read: (params_read.is_some() || from_read.is_some() || other_read.is_some()).then_some(&read),
            write: (!there.to).then_some(&write),
            group,
            within: group - 1,
            is_far: false,
            ..*placed
        };
        if !there.params {
            pass.params = aside(params_first, 0, MOST_PARAMS * BLOCK, group);
        }
        if !there.from {
            pass.from = read_to(from_first, from_read);
            // What is read next is in the nearest cache by then, or on its way.
            pass.ahead = from_rows.as_ref().map_or(pass.from, |rows| rows.ahead(start + GROUPS * group));
        }
        if !there.other {
            pass.other = read_to(other_first, other_read);
        }
        if !there.to {
            pass.to = to_aside;
        }
        // SAFETY: the caller's.
        unsafe { self.call(&pass) }
        if is_large {
            fence();
        }
    }
}
