//! Columns of sixteen rows to lines of a block and back: a square of sixteen columns, or four.

use super::registers::Quads;
use crate::pieces::{sink, source};

/// How many columns that are left over are worth a square, which begins with some that are done already.
#[inline(always)]
pub const fn worth_a_square(is_wide: bool) -> usize {
    if is_wide { 9 } else { 13 }
}

/// Reads sixteen columns of sixteen rows, each `stride` numbers behind the last, to a line each.
///
/// # Safety
///
/// The numbers are there, and room for the lines; the function around is compiled for the unit of the register, which the processor
/// has.
#[inline(always)]
pub unsafe fn read_square<R: Quads>(first: *const R::Number, stride: usize, line: impl Fn(usize) -> *mut R::Number) {
    // SAFETY: the caller's.
    unsafe {
        if R::IS_WIDE {
            let row = source(
                #[inline(always)]
                |i: usize| first.wrapping_add(i * stride),
            );
            return turn::<R>(row, line);
        }
        for x in [0, 4, 8, 12] {
            let line = source(
                #[inline(always)]
                |i: usize| line(x + i),
            );
            read_four::<R>(first.add(x), stride, line);
        }
    }
}

/// Writes sixteen lines to as many columns of sixteen rows; see [`read_square`].
///
/// # Safety
///
/// As [`read_square`]; the rows are nobody else's.
#[inline(always)]
pub unsafe fn write_square<R: Quads>(line: impl Fn(usize) -> *const R::Number, first: *mut R::Number, stride: usize) {
    // SAFETY: the caller's.
    unsafe {
        if R::IS_WIDE {
            let row = source(
                #[inline(always)]
                |i: usize| first.wrapping_add(i * stride),
            );
            return turn_in_order::<R>(line, row);
        }
        for x in [0, 4, 8, 12] {
            let line = source(
                #[inline(always)]
                |i: usize| line(x + i),
            );
            write_four::<R>(line, first.add(x), stride);
        }
    }
}

/// Reads four columns of sixteen rows to a line each, the last of them first.
///
/// # Safety
///
/// As [`read_square`].
#[inline(always)]
pub unsafe fn read_four<R: Quads>(first: *const R::Number, stride: usize, line: impl Fn(usize) -> *mut R::Number) {
    for part in 0..R::PARTS {
        // SAFETY: the caller's.
        unsafe {
            let first = first.add(part * R::LANES * stride);
            let row = source(
                #[inline(always)]
                |i: usize| R::gather(first.add(i * stride), 4 * stride),
            );
            let columns = R::transpose([row(0), row(1), row(2), row(3)]);
            for i in [3, 2, 1, 0] {
                columns[i].store(line(i).add(part * R::LANES));
            }
        }
    }
}

/// Writes four lines to as many columns of sixteen rows.
///
/// # Safety
///
/// As [`write_square`].
#[inline(always)]
pub unsafe fn write_four<R: Quads>(line: impl Fn(usize) -> *const R::Number, first: *mut R::Number, stride: usize) {
    for part in 0..R::PARTS {
        // SAFETY: the caller's.
        unsafe {
            let first = first.add(part * R::LANES * stride);
            let column = source(
                #[inline(always)]
                |i: usize| R::load(line(i).add(part * R::LANES)),
            );
            let quads = R::transpose([column(0), column(1), column(2), column(3)]);
            for i in 0..4 {
                quads[i].scatter(first.add(i * stride), 4 * stride);
            }
        }
    }
}

/// Exchanges rows and columns of sixteen by sixteen numbers, of which a register holds a row.
///
/// # Safety
///
/// There are sixteen numbers at each place that is read and room at each that is written; the function around is compiled for
/// the unit of the register, which the processor has.
#[inline(always)]
unsafe fn turn<R: Quads>(from: impl Fn(usize) -> *const R::Number, to: impl Fn(usize) -> *mut R::Number) {
    // SAFETY: the caller's. What is written out is not left to a loop, so that all of it stays in registers.
    unsafe {
        let four = source(
            #[inline(always)]
            |i: usize| {
                R::transpose([R::load(from(i)), R::load(from(i + 1)), R::load(from(i + 2)), R::load(from(i + 3))])
            },
        );
        let ([a0, a1, a2, a3], [b0, b1, b2, b3], [c0, c1, c2, c3], [d0, d1, d2, d3]) =
            (four(0), four(4), four(8), four(12));
        let mut store = sink(
            #[inline(always)]
            |x: usize, quads: [R; 4]| {
                let [p, q, r, s] = R::cross(quads);
                p.store(to(x));
                q.store(to(x + 4));
                r.store(to(x + 8));
                s.store(to(x + 12));
            },
        );
        store(0, [a0, b0, c0, d0]);
        store(1, [a1, b1, c1, d1]);
        store(2, [a2, b2, c2, d2]);
        store(3, [a3, b3, c3, d3]);
    }
}

/// As [`turn`], but what is written is written in its order: rows that share a line of the cache one after the other, which is worth
/// more than a few registers.
///
/// # Safety
///
/// As [`turn`].
#[inline(always)]
unsafe fn turn_in_order<R: Quads>(from: impl Fn(usize) -> *const R::Number, to: impl Fn(usize) -> *mut R::Number) {
    // SAFETY: the caller's.
    unsafe {
        let four = source(
            #[inline(always)]
            |i: usize| R::cross([R::load(from(i)), R::load(from(i + 4)), R::load(from(i + 8)), R::load(from(i + 12))]),
        );
        let ([a0, a1, a2, a3], [b0, b1, b2, b3], [c0, c1, c2, c3], [d0, d1, d2, d3]) =
            (four(0), four(1), four(2), four(3));
        let mut store = sink(
            #[inline(always)]
            |x: usize, quads: [R; 4]| {
                let [p, q, r, s] = R::transpose(quads);
                p.store(to(x));
                q.store(to(x + 1));
                r.store(to(x + 2));
                s.store(to(x + 3));
            },
        );
        store(0, [a0, b0, c0, d0]);
        store(4, [a1, b1, c1, d1]);
        store(8, [a2, b2, c2, d2]);
        store(12, [a3, b3, c3, d3]);
    }
}
