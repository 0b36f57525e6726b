//! Arrays of a signal each with nothing between them: how many columns there are is known when it is compiled, so that they are read
//! and written as straight lines, without tiles.

use super::registers::{BLOCK, Quads};
use super::rows::Rows;
use super::squares::{read_four, read_square, worth_a_square, write_four, write_square};
use crate::pieces::source;

/// How many columns of so many are read as squares; the others, fours each, are behind them. What is left over and worth a square
/// or four begins with columns that are done already.
const fn in_squares(count: usize, is_wide: bool) -> usize {
    match count % BLOCK {
        rest if count > BLOCK && rest >= worth_a_square(is_wide) => count,
        rest => count - rest,
    }
}

/// Reads blocks of arrays of `N` numbers, at least four, to lines; see [`Tiles::gather`](super::rows::Tiles::gather).
///
/// # Safety
///
/// As that.
#[inline(always)]
pub unsafe fn gather<R: Quads, const N: usize>(rows: Rows<R::Number>, lines: *mut R::Number, step: usize) {
    let squares = const { in_squares(N, R::IS_WIDE) };
    for block in 0..rows.blocks {
        let lines = lines.wrapping_add(block * step);
        let first = rows.block::<R>(block);
        let line = source(
            #[inline(always)]
            |i: usize| lines.wrapping_add(i * BLOCK),
        );
        // SAFETY: the caller's.
        unsafe {
            for x in (0..squares).step_by(BLOCK) {
                let x = x.min(N.saturating_sub(BLOCK));
                read_square::<R>(
                    first.add(x),
                    N,
                    #[inline(always)]
                    |i| line(x + i),
                );
            }
            for x in (squares..N).step_by(4) {
                let x = x.min(N - 4);
                read_four::<R>(
                    first.add(x),
                    N,
                    #[inline(always)]
                    |i| line(x + i),
                );
            }
        }
    }
}

/// Writes lines to blocks of arrays of `N` numbers, at least four; see [`Tiles::scatter`](super::rows::Tiles::scatter).
///
/// # Safety
///
/// As that.
#[inline(always)]
pub unsafe fn scatter<R: Quads, const N: usize>(lines: *const R::Number, step: usize, rows: Rows<R::Number>) {
    let squares = const { in_squares(N, R::IS_WIDE) };
    for block in 0..rows.blocks {
        let lines = lines.wrapping_add(block * step);
        let first = rows.first.wrapping_add(block * BLOCK * N);
        let line = source(
            #[inline(always)]
            |i: usize| lines.wrapping_add(i * BLOCK),
        );
        // SAFETY: the caller's.
        unsafe {
            for x in (0..squares).step_by(BLOCK) {
                let x = x.min(N.saturating_sub(BLOCK));
                write_square::<R>(
                    #[inline(always)]
                    |i| line(x + i),
                    first.add(x),
                    N,
                );
            }
            for x in (squares..N).step_by(4) {
                let x = x.min(N - 4);
                write_four::<R>(
                    #[inline(always)]
                    |i| line(x + i),
                    first.add(x),
                    N,
                );
            }
        }
    }
}
