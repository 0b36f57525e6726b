//! A kernel over many signals in any layouts: blocks are worked on where they lie, rows sixteen at a time through lines on the
//! stack. Sizes are checked before anything is touched.

use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};

use super::kernels::{Aside, Lines, MOST_CHANNELS, Pass};
use super::moving::{Moving, Room, narrow, read};
use super::numbers::Storage;
use super::registers::BLOCK;
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

/// Room for the lines of a block in all its channels, or of several blocks.
type LinesAside<S> = Aside<[[<S as Storage>::Number; BLOCK]; MOST_LINES]>;

/// How many blocks are read at once at most, so that the processor works on one while it waits for another.
const MOST_AT_ONCE: usize = 8;

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

/// Whether lines may be written past the caches.
fn are_aligned<T>(lines: &Lines<*mut T>) -> bool {
    lines.at.iter().all(|at| at.is_null() || at.align_offset(64) == 0)
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
        let of_from = self.from.view();
        let are_even = of_from.is_none_or(is_even)
            && self.other.as_ref().is_none_or(is_even)
            && planes(&self.to.lengths[..self.to.plane_count]);
        if !are_even {
            return Err(Error::Planes);
        }
        let is_blocks = |places: &Places| *places == Places::Blocks;
        let fits = |places: &Places, found: usize| match is_blocks(places) || is_blocks(&self.to.places) {
            true => found.div_ceil(BLOCK) == self.to.block_count(),
            false => found == self.to.signals,
        };
        let params = self.params.view().map(|view| (&view.places, view.signals));
        let signals = of_from.into_iter().chain(&self.other).map(|view| (&view.places, view.signals));
        match params.into_iter().chain(signals).find(|(places, found)| !fits(places, *found)) {
            Some((_, found)) => Err(Error::Batch { found, results: self.to.signals }),
            None => Ok(()),
        }
    }

    /// Returns the rotation of all rows as diagonals, if it is one and they are rows for it.
    #[cfg(all(target_arch = "x86_64", feature = "order4"))]
    fn diagonals(&self) -> Option<super::diagonals::Diagonals> {
        let (Params::Shared(quaternion), Input::Each(from)) = (&self.params, &self.from) else { return None };
        let (from, to) = (from.singles()?, self.to.singles()?);
        let q = <[S::Number; 4]>::try_from(*quaternion).ok()?.map(|x| x.into() as f32);
        super::diagonals::Diagonals::new(self.unit, q, &from, &to, self.streams())
    }

    /// How many bytes signals and results are.
    fn bytes(&self) -> usize {
        self.from.view().map_or(0, View::bytes) + self.to.bytes()
    }

    /// Whether results are written past the caches, where they can be: there are many bytes, and they do not lie where the signals
    /// were just read.
    fn streams(&self) -> bool {
        let view = self.from.view();
        let is_in_place = view.is_some_and(|view| view.planes[0].cast::<D>() == self.to.planes[0]);
        !is_in_place && self.bytes() >= STREAMS_FROM.load(Ordering::Relaxed)
    }

    /// Returns what reads and writes rows, for all of the blocks.
    pub fn moves<'t>(&self, [params, from, other, to]: &'t mut Rooms) -> Moved<'t, S, D> {
        #[cfg(all(target_arch = "x86_64", feature = "order4"))]
        if let Some(diagonals) = self.diagonals() {
            return Moved { params: None, from: None, other: None, to: None, diagonals: Some(diagonals) };
        }
        let (unit, is_far) = (self.unit, self.bytes() >= FAR_FROM);
        Moved {
            params: self.params.view().and_then(|view| Moving::new(params, *view, unit, true, is_far)),
            from: self.from.view().and_then(|view| Moving::new(from, *view, unit, true, is_far)),
            other: self.other.and_then(|view| Moving::new(other, view, unit, true, is_far)),
            to: Moving::new(to, self.to, unit, false, is_far),
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
            match self.in_lines(&blocks) {
                Some(pass) => self.call(&pass),
                None => self.all_over(blocks),
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

    /// Returns the pass over blocks all of which lie in lines, if they do.
    fn in_lines(&self, blocks: &Range<usize>) -> Option<Pass<S::Number>> {
        let params = match &self.params {
            Params::None => nowhere(),
            Params::Shared(numbers) => Lines { at: [numbers.as_ptr(); MOST_CHANNELS], step: 0 },
            Params::Each(view) => shared(&direct(view, blocks)?),
        };
        let from = match &self.from {
            Input::None => nowhere(),
            Input::Shared(at) => Lines { at: *at, step: 0 },
            Input::Each(view) => shared(&direct(view, blocks)?),
        };
        let other = match &self.other {
            None => nowhere(),
            Some(view) => shared(&direct(view, blocks)?),
        };
        let to = direct(&self.to, blocks)?;
        let streams = self.streams() && are_aligned(&to);
        Some(Pass { blocks: blocks.len(), channels: self.to.channels, params, from, other, to, is_far: self.bytes() >= FAR_FROM, streams })
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    unsafe fn part(&self, moves: &Moved<'_, S, D>, blocks: Range<usize>) {
        // SAFETY: the caller's.
        unsafe {
            match self.in_lines(&blocks) {
                Some(pass) => self.call(&pass),
                None => self.through_lines(moves, blocks),
            }
        }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over), and the pass is over its blocks.
    unsafe fn call(&self, pass: &Pass<S::Number>) {
        // SAFETY: the caller's.
        unsafe {
            match self.run {
                Some(run) => run(pass),
                None => super::kernels::copy_lines(pass, self.to.count),
            }
        }
    }

    /// Works on some blocks at a time, what is no lines by way of lines on the stack.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(never)]
    unsafe fn through_lines(&self, moves: &Moved<'_, S, D>, blocks: Range<usize>) {
        let unit = self.unit;
        let as_lines = self.from.view().and_then(|view| direct(view, &blocks));
        let other_lines = self.other.as_ref().and_then(|view| direct(view, &blocks));
        let to_lines = direct(&self.to, &blocks);
        let lines_of = |view: &View<S>, is_there: bool| if is_there { 0 } else { view.count * view.channels };
        let of_from = self.from.view().map_or(0, |view| lines_of(view, as_lines.is_some()));
        let of_other = self.other.as_ref().map_or(0, |view| lines_of(view, other_lines.is_some()));
        let of_to = if to_lines.is_some() { 0 } else { self.to.count * self.to.channels };
        let most = of_from.max(of_other).max(of_to);
        let at_once = (MOST_LINES / most.max(1)).clamp(1, MOST_AT_ONCE);
        let param_lines = self.params.view().and_then(|view| direct(view, &blocks));
        let Moved { params: param_rows, from: from_rows, other: other_rows, to: to_rows, .. } = moves;
        let is_large = self.streams();
        let streams = is_large && to_lines.as_ref().is_some_and(are_aligned);
        let (mut params_aside, mut from_aside, mut other_aside, mut to_aside) =
            (LinesAside::<S>::new(), LinesAside::<S>::new(), LinesAside::<S>::new(), LinesAside::<S>::new());
        let mut start = blocks.start;
        while start < blocks.end {
            let end = (start + at_once).min(blocks.end);
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
                        let (first, step) = (params_aside.first(), MOST_PARAMS * BLOCK);
                        read(view, param_rows, start..end, first, step);
                        shared(&aside(first, 0, step))
                    }
                };
                let mut taken = None;
                let from = match (&self.from, &as_lines) {
                    (Input::None, _) => nowhere(),
                    (Input::Shared(at), _) => Lines { at: *at, step: 0 },
                    (Input::Each(_), Some(lines)) => shared(&forward(lines)),
                    (Input::Each(view), None) => {
                        let (first, step) = (from_aside.first(), of_from * BLOCK);
                        read(view, from_rows, start..end, first, step);
                        taken = Some(first);
                        shared(&aside(first, view.count, step))
                    }
                };
                let other = match (&self.other, &other_lines) {
                    (None, _) => nowhere(),
                    (Some(_), Some(lines)) => shared(&forward(lines)),
                    (Some(view), None) => {
                        let (first, step) = (other_aside.first(), of_other * BLOCK);
                        read(view, other_rows, start..end, first, step);
                        shared(&aside(first, view.count, step))
                    }
                };
                // A kernel of one signal to one may write where it reads.
                let is_one_to_one = self.from.view().is_some_and(|view| view.count == self.to.count);
                let first = match taken.filter(|_| is_one_to_one && self.other.is_none()) {
                    Some(first) => first,
                    None => to_aside.first(),
                };
                let step = of_to * BLOCK;
                let to = match &to_lines {
                    Some(lines) => forward(lines),
                    None => aside(first, self.to.count, step),
                };
                let pass = Pass { blocks: end - start, channels: self.to.channels, params, from, other, to, is_far: false, streams };
                self.call(&pass);
                if to_lines.is_none() {
                    let lines = |block: usize| first.add((block - start) * step);
                    match to_rows {
                        Some(rows) if is_large && rows.streams() && rows.filled(end - 1) == BLOCK => {
                            (start..end).for_each(|block| rows.stream(unit, block, lines(block), other_aside.first()));
                        }
                        Some(rows) => rows.write(start..end, first, step),
                        None => (start..end).for_each(|block| narrow(&self.to, block, lines(block))),
                    }
                }
            }
            start = end;
        }
        if is_large {
            fence();
        }
    }
}
