//! The generated kernels over many blocks: each order's set-up once a block, then band after band, so that what lives at once
//! fits into registers. A macro ties them together; the mathematics is all in the generated functions.

use core::hint::black_box;
use core::mem::MaybeUninit;
use core::ops::Range;
use core::ptr;

use super::pass::{Aside, Pass, blocks_ahead};
use super::registers::{BLOCK, Register};
use crate::pieces::{sink, source};

/// The most registers that a line takes: sixteen f64 in pairs.
const MOST_PARTS: usize = 8;

/// A kernel for a register.
pub trait Kernel {
    /// Runs it over a pass.
    ///
    /// # Safety
    ///
    /// All lines that the pass speaks of are there, those of results nobody else's, and the function around it is compiled for
    /// the unit of the register, which the processor has.
    unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>);
}

/// Which of so many set-ups is a round's.
#[inline(always)]
fn place(round: usize, of: usize) -> usize {
    round % of
}

/// The first number of an array that is not written yet.
#[inline(always)]
fn first_of<A, T>(array: &mut MaybeUninit<A>) -> *mut T {
    array.as_mut_ptr().cast()
}

/// Writes lines past the caches.
///
/// # Safety
///
/// As [`Kernel::run`]; the lines are there.
#[inline(always)]
unsafe fn stream<R: Register>(from: *const R::Number, to: *mut R::Number, lines: Range<usize>) {
    // A loop, since as straight lines its instructions leave no room for the kernel's where a processor keeps them decoded.
    let lines = black_box(lines);
    for place in lines.start * R::PARTS..lines.end * R::PARTS {
        // SAFETY: the caller's.
        unsafe { R::load(from.add(place * R::LANES)).stream(to.add(place * R::LANES)) }
    }
}

/// How many bytes a page of memory has at least.
const PAGE: usize = 4096;

/// Has the address of each page looked up to which so many numbers will be streamed, since nothing else can be written while one
/// is: what is written past the caches is not asked for ahead by itself.
#[inline(always)]
pub fn look_up<R: Register>(to: *mut R::Number, numbers: usize) {
    for byte in (0..numbers * size_of::<R::Number>()).step_by(PAGE) {
        R::prefetch(to.wrapping_byte_add(byte));
    }
}

/// Copies the line of band 0, which no rotation changes.
///
/// # Safety
///
/// As [`Kernel::run`]; the lines are there.
#[inline(always)]
unsafe fn copy<R: Register>(from: *const R::Number, to: *mut R::Number) {
    for part in 0..R::PARTS {
        // SAFETY: the caller's.
        unsafe { R::load(from.add(part * R::LANES)).store(to.add(part * R::LANES)) }
    }
}

/// The bands of a block in every channel, of set-ups that lie a part of the lines each.
macro_rules! bands {
    ($register:ident, $pass:ident, $block:ident, $of:ty, $set_up:expr, $module:ident, $count:literal, [$($l:literal $band:ident)*]) => {
        for channel in 0..$pass.channels {
            let (from, to) = ($pass.from.block(channel, $block), $pass.to.block(channel, $block));
            let ahead = $pass.ahead.block(channel, $block);
            let mut lines = Aside::<[[<$register as Register>::Number; BLOCK]; $count]>::new();
            let aside: *mut <$register as Register>::Number = lines.first();
            let into = if $pass.streams { aside } else { to };
            // SAFETY: the caller's; a kernel reads what it overwrites before, and writes every line of its band.
            unsafe {
                $register::prefetch(ahead);
                if $pass.streams {
                    look_up::<$register>($pass.to.block(channel, $block + 2), $count * BLOCK);
                }
                copy::<$register>(from, into);
                if $pass.streams {
                    stream::<$register>(into, to, 0..1);
                }
                $(
                    for line in $l * $l..($l + 1) * ($l + 1) {
                        $register::prefetch(ahead.wrapping_add(line * BLOCK));
                    }
                    for part in 0..$register::PARTS {
                        let [from, into] = [from, into].map(|at| at.add($l * $l * BLOCK + part * $register::LANES));
                        zonal_kernels::batch::$module::$band::<$of, $register>(
                            $set_up(part),
                            &source(#[inline(always)] |i| $register::load(from.add(i * BLOCK))),
                            &mut sink(#[inline(always)] |i, x: $register| x.store(into.add(i * BLOCK))),
                        );
                    }
                    if $pass.streams {
                        stream::<$register>(into, to, $l * $l..($l + 1) * ($l + 1));
                    }
                )*
            }
        }
    };
}

/// A kernel in pieces with a set-up for each signal.
macro_rules! each {
    ($kernel:ident: $about:literal, $module:ident, $count:literal, $ahead:literal, $set_up:ident($($param:literal)*), $bands:tt) => {
        #[doc = $about]
        pub struct $kernel;
        impl Kernel for $kernel {
            #[inline(always)]
            unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                // A set-up that is one long chain is done a block ahead, beside bands that do not wait for it; which of the two
                // it is, is an index and not a choice, so that the compiler leaves them in memory.
                let mut set_ups = [const { [const { MaybeUninit::uninit() }; MOST_PARTS] }; 1 + $ahead];
                pass.begin();
                for ahead in 0..pass.blocks + $ahead {
                    let (next, now) = (place(ahead, 1 + $ahead), place(ahead + $ahead, 1 + $ahead));
                    if let Some(block) = ahead.checked_sub($ahead) {
                        pass.pass_by(block);
                    }
                    if ahead < pass.blocks {
                        for part in 0..R::PARTS {
                            let params = pass.params.block(0, ahead).wrapping_add(part * R::LANES);
                            // SAFETY: the caller's; the set-up writes every number of its array.
                            unsafe {
                                let params = [$(R::load(params.add($param * BLOCK))),*];
                                let first = first_of::<_, R>(&mut set_ups[next][part]);
                                zonal_kernels::batch::$module::$set_up::<R>(
                                    params,
                                    &mut sink(#[inline(always)] |i, x| first.add(i).write(x)),
                                );
                            }
                        }
                    }
                    let Some(block) = ahead.checked_sub($ahead) else { continue };
                    // SAFETY: the set-ups of all parts of this block are written.
                    let set_up = source(#[inline(always)] |part: usize| unsafe { set_ups[now][part].assume_init_ref() });
                    bands!(R, pass, block, R, set_up, $module, $count, $bands);
                }
                pass.end();
                if pass.streams {
                    R::fence();
                }
            }
        }
    };
}

/// A kernel in pieces with one set-up for all signals.
macro_rules! all {
    ($kernel:ident: $about:literal, $module:ident, $count:literal, $set_up:ident($($param:literal)*), $bands:tt) => {
        #[doc = $about]
        pub struct $kernel;
        impl Kernel for $kernel {
            #[inline(always)]
            unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                let mut set_up = MaybeUninit::uninit();
                // SAFETY: the caller's; the parameters are a number each, and the set-up writes every number of its array.
                unsafe {
                    let params = [$(*pass.params.at[0].add($param)),*];
                    let first = first_of::<_, R::Number>(&mut set_up);
                    zonal_kernels::batch::$module::$set_up::<R::Number>(
                        params,
                        &mut sink(#[inline(always)] |i, x| first.add(i).write(x)),
                    );
                }
                // SAFETY: it is written above.
                let set_up = source(#[inline(always)] |_: usize| unsafe { set_up.assume_init_ref() });
                pass.begin();
                for block in 0..pass.blocks {
                    pass.pass_by(block);
                    bands!(R, pass, block, R::Number, set_up, $module, $count, $bands);
                }
                pass.end();
                if pass.streams {
                    R::fence();
                }
            }
        }
    };
}

/// Whether so little is done with signals of so many lines, one register a line, that what the second cache has is asked for too.
const fn is_brief<R: Register>(lines: usize) -> bool {
    R::PARTS == 1 && R::COUNT == 1 && lines <= 9
}

/// The three lines of directions.
///
/// # Safety
///
/// As [`Kernel::run`]; the lines are there.
#[inline(always)]
unsafe fn direction<R: Register>(first: *const R::Number) -> [R; 3] {
    // SAFETY: the caller's.
    unsafe { [R::load(first), R::load(first.add(BLOCK)), R::load(first.add(2 * BLOCK))] }
}

/// The kernels of an order that go by directions: the basis and sums over it.
macro_rules! directions {
    ($basis:ident $eval:ident $eval_all:ident: $module:ident, $count:literal) => {
        /// The basis at a direction of each.
        pub struct $basis;
        impl Kernel for $basis {
            #[inline(always)]
            unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                pass.each(
                    #[inline(always)]
                    |place| {
                        let to = pass.to.of(0, place);
                        if pass.streams {
                            look_up::<R>(to.wrapping_add(2 * pass.to.step), $count * BLOCK);
                        }
                        let mut lines = Aside::<[[R::Number; BLOCK]; $count]>::new();
                        let aside: *mut R::Number = lines.first();
                        // A line that one register fills is streamed at once, another when it is whole.
                        let is_aside = pass.streams && R::PARTS > 1;
                        let into = if is_aside { aside } else { to };
                        for part in 0..R::PARTS {
                            let params = pass.params.of(0, place).wrapping_add(part * R::LANES);
                            let into = into.wrapping_add(part * R::LANES);
                            // SAFETY: the caller's.
                            unsafe {
                                let params = direction::<R>(params);
                                if pass.streams && R::PARTS == 1 {
                                    zonal_kernels::batch::$module::basis::<R>(
                                        params,
                                        &mut sink(
                                            #[inline(always)]
                                            |i, x: R| x.stream(into.add(i * BLOCK)),
                                        ),
                                    );
                                } else {
                                    zonal_kernels::batch::$module::basis::<R>(
                                        params,
                                        &mut sink(
                                            #[inline(always)]
                                            |i, x: R| x.store(into.add(i * BLOCK)),
                                        ),
                                    );
                                }
                            }
                        }
                        if is_aside {
                            // SAFETY: every line is written above.
                            unsafe { stream::<R>(aside, to, 0..$count) }
                        }
                    },
                );
                if pass.streams {
                    R::fence();
                }
            }
        }

        /// The value of each signal in a direction of its own.
        pub struct $eval;
        impl Kernel for $eval {
            #[inline(always)]
            unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                pass.each_of_channels(
                    #[inline(always)]
                    |place, channels| {
                        if pass.is_far || is_brief::<R>($count) {
                            for channel in 0..channels {
                                let ahead = pass.ahead.of(channel, place);
                                (0..$count).for_each(|line| R::prefetch(ahead.wrapping_add(line * BLOCK)));
                            }
                            let ahead = pass.params.of(0, place).wrapping_add(blocks_ahead($count) * pass.params.step);
                            (0..3).for_each(|line| R::prefetch(ahead.wrapping_add(line * BLOCK)));
                        }
                        for part in 0..R::PARTS {
                            // SAFETY: the caller's.
                            unsafe {
                                let params = direction::<R>(pass.params.of(0, place).add(part * R::LANES));
                                for channel in 0..channels {
                                    let from = pass.from.of(channel, place).add(part * R::LANES);
                                    let value = zonal_kernels::batch::$module::eval::<R, R>(
                                        params,
                                        &source(
                                            #[inline(always)]
                                            |i| R::load(from.add(i * BLOCK)),
                                        ),
                                    );
                                    value.store(pass.to.of(channel, place).add(part * R::LANES));
                                }
                            }
                        }
                    },
                );
            }
        }

        /// The value of one signal in each direction.
        pub struct $eval_all;
        impl Kernel for $eval_all {
            #[inline(always)]
            unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                pass.each_of_channels(
                    #[inline(always)]
                    |place, channels| {
                        for part in 0..R::PARTS {
                            // SAFETY: the caller's; a channel's signal is a number a line.
                            unsafe {
                                let params = direction::<R>(pass.params.of(0, place).add(part * R::LANES));
                                for channel in 0..channels {
                                    let (signal, one) = (pass.from.at[channel], R::lit(1.0));
                                    let value = zonal_kernels::batch::$module::eval::<R, R>(
                                        params,
                                        &source(
                                            #[inline(always)]
                                            |i| one * *signal.add(i),
                                        ),
                                    );
                                    value.store(pass.to.of(channel, place).add(part * R::LANES));
                                }
                            }
                        }
                    },
                );
            }
        }
    };
}

/// Copies `lines` lines of each block and channel: what changes where numbers lie and nothing else.
///
/// # Safety
///
/// All lines that the pass speaks of are there, those of results nobody else's.
pub unsafe fn copy_lines<T>(pass: &Pass<'_, T>, lines: usize) {
    pass.each(|place| {
        for channel in 0..pass.channels {
            // SAFETY: the caller's.
            unsafe { ptr::copy(pass.from.of(channel, place), pass.to.of(channel, place), lines * BLOCK) }
        }
    });
}

/// The kernels of an order.
macro_rules! orders {
    ($(
        $feature:literal $module:ident, $count:literal:
        each $rotate_set_up:ident $rotate_bands:tt,
        all $all_set_up:ident $all_bands:tt,
        tilt $tilt_bands:tt
        $(, product $product:ident)?;
    )*) => { $(
        /// The kernels of an order.
        #[cfg(feature = $feature)]
        pub mod $module {
            use crate::batch::kernels::*;
            each!(Rotate: "Each by a quaternion of its own.", $module, $count, 1, $rotate_set_up(0 1 2 3), $rotate_bands);
            all!(RotateAll: "All by one quaternion.", $module, $count, $all_set_up(0 1 2 3), $all_bands);
            each!(Tilt: "Each to a normal of its own.", $module, $count, 0, tilt_setup(0 1 2), $tilt_bands);
            directions!(Basis Eval EvalAll: $module, $count);
            $(
                /// The product of each two signals.
                pub struct $product;
                impl Kernel for $product {
                    #[inline(always)]
                    unsafe fn run<R: Register>(pass: &Pass<'_, R::Number>) {
                        pass.each(
                            #[inline(always)]
                            |place| {
                                for channel in 0..pass.channels {
                                    for part in 0..R::PARTS {
                                        let [a, b, into] = [&pass.from, &pass.other, &pass.to]
                                            .map(|lines| lines.of(channel, place).wrapping_add(part * R::LANES));
                                        // SAFETY: the caller's.
                                        unsafe {
                                            zonal_kernels::batch::$module::product::<R, R>(
                                                &source(
                                                    #[inline(always)]
                                                    |i| R::load(a.add(i * BLOCK)),
                                                ),
                                                &source(
                                                    #[inline(always)]
                                                    |i| R::load(b.add(i * BLOCK)),
                                                ),
                                                &mut sink(
                                                    #[inline(always)]
                                                    |i, x: R| x.store(into.add(i * BLOCK)),
                                                ),
                                            );
                                        }
                                    }
                                }
                            },
                        );
                    }
                }
            )?
        }
    )* };
}

crate::pieces::table!(orders);
