//! Arrays of a signal each with nothing between them: how many columns there are is known when it is compiled, so that they are read
//! and written as straight lines, without tiles.

use super::registers::{BLOCK, Quads};
use super::rows::Rows;
use super::squares::{read_four, read_square, worth_a_square, write_four, write_square};
use crate::pieces::source;

/// Where the columns begin that are left over of so many: a square's, or those of four each.
const fn left_over(count: usize, is_wide: bool) -> (Option<usize>, usize) {
    match count % BLOCK {
        rest if count > BLOCK && rest >= worth_a_square(is_wide) => (Some(count - BLOCK), count),
        rest => (None, count - rest),
    }
}

/// Reads blocks of arrays of `N` numbers, at least four, to lines; see [`Tiles::gather`](super::rows::Tiles::gather).
///
/// # Safety
///
/// As that.
#[inline(always)]
pub unsafe fn gather<R: Quads, const N: usize>(rows: Rows<R::Number>, lines: *mut R::Number, step: usize) {
    let (square, fours) = const { left_over(N, R::IS_WIDE) };
    for block in 0..rows.blocks {
        let lines = lines.wrapping_add(block * step);
        let first = rows.block::<R>(block);
        let line = source(
            #[inline(always)]
            |i: usize| lines.wrapping_add(i * BLOCK),
        );
        // SAFETY: the caller's.
        unsafe {
            for x in (0..N / BLOCK * BLOCK).step_by(BLOCK) {
                read_square::<R>(
                    first.add(x),
                    N,
                    #[inline(always)]
                    |i| line(x + i),
                );
            }
            if let Some(x) = square {
                read_square::<R>(
                    first.add(x),
                    N,
                    #[inline(always)]
                    |i| line(x + i),
                );
            }
            for x in (fours..N).step_by(4) {
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
    let (square, fours) = const { left_over(N, R::IS_WIDE) };
    for block in 0..rows.blocks {
        let lines = lines.wrapping_add(block * step);
        let first = rows.first.wrapping_add(block * BLOCK * N);
        let line = source(
            #[inline(always)]
            |i: usize| lines.wrapping_add(i * BLOCK),
        );
        // SAFETY: the caller's.
        unsafe {
            for x in (0..N / BLOCK * BLOCK).step_by(BLOCK) {
                write_square::<R>(
                    #[inline(always)]
                    |i| line(x + i),
                    first.add(x),
                    N,
                );
            }
            if let Some(x) = square {
                write_square::<R>(
                    #[inline(always)]
                    |i| line(x + i),
                    first.add(x),
                    N,
                );
            }
            for x in (fours..N).step_by(4) {
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
