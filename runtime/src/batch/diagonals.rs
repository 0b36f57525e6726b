//! One rotation of many rows of order 4, as splats have them: the bands 1 to 3 of a channel are fifteen numbers side by side, one
//! register of AVX-512, and the rotation's matrix is seven diagonals of its blocks, so that seven permutations and
//! multiply-adds turn a channel of one row without a transposition. A block is a cycle of permutations: diagonal d takes number
//! i + d of the band, counted around.

use super::numbers::Number;
use super::registers::BLOCK;
use super::rows::Row;
use super::signals::{Places, View};
use super::units::{Unit, fence};
use crate::coefficients::Coefficients;
use crate::rotation::Rotation;
use core::arch::x86_64::*;

/// The numbers of the bands 1 to 3.
const COUNT: usize = 15;
/// The diagonals of the largest block.
const DIAGONALS: usize = 7;
/// The numbers that a register holds of a row.
const MASK: __mmask16 = (1 << COUNT) - 1;

/// A rotation as diagonals, and the rows that it turns.
pub struct Diagonals {
    places: [[i32; BLOCK]; DIAGONALS],
    factors: [[f32; BLOCK]; DIAGONALS],
    from: View<f32>,
    to: View<f32>,
    strides: [usize; 2],
    rows: [Row; 2],
    streams: bool,
}

/// The rows of a view, if they are of order 4 and the bands 1 to 3 of a channel lie side by side.
fn rows(view: &View<f32>) -> Option<(usize, Row)> {
    let Places::Rows { stride, row } = view.places else { return None };
    let is_dense = row.count == COUNT + 1 && row.column(0, COUNT) == row.column(0, 1) + COUNT - 1;
    is_dense.then_some((stride, row))
}

impl Diagonals {
    /// Returns the rotation of a quaternion for rows that it can turn on this unit.
    pub fn new(unit: Unit, quaternion: [f32; 4], from: &View<f32>, to: &View<f32>, streams: bool) -> Option<Self> {
        if unit != Unit::Avx512 || from.plane_count != to.plane_count {
            return None;
        }
        let ((from_stride, from_row), (to_stride, to_row)) = (rows(from)?, rows(to)?);
        let (mut places, mut factors) = ([[0; BLOCK]; DIAGONALS], [[0.0; BLOCK]; DIAGONALS]);
        // Columns of the matrix, in f64: what is rounded is each number once.
        let turn = Rotation::<[f64; COUNT + 1]>::new(quaternion.map(f64::from));
        let column = |j: usize| turn.apply(&<[f64; COUNT + 1]>::from_fn(|i| f64::from(u8::from(i == j))));
        let columns: [_; COUNT + 1] = core::array::from_fn(column);
        for l in 1..4 {
            let (start, size) = (l * l, 2 * l + 1);
            for d in 0..DIAGONALS {
                for i in 0..size {
                    let j = start + (i + d) % size;
                    places[d][start + i - 1] = j as i32 - 1;
                    factors[d][start + i - 1] = if d < size { columns[j][start + i] as f32 } else { 0.0 };
                }
            }
        }
        let has_no_gaps = to_stride == to_row.count * to_row.channels && to.plane_count == 1;
        Some(Self {
            places,
            factors,
            from: *from,
            to: *to,
            strides: [from_stride, to_stride],
            rows: [from_row, to_row],
            streams: streams && has_no_gaps,
        })
    }

    /// Turns the rows of some blocks.
    ///
    /// # Safety
    ///
    /// The views' memory is borrowed, nobody else touches these rows of the results, and the processor has AVX-512.
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
    pub unsafe fn over(&self, blocks: core::ops::Range<usize>) {
        let [from_row, to_row] = &self.rows;
        let [from_stride, to_stride] = self.strides;
        // Two, so that what was just written is not read at once.
        let mut aside = [[0.0_f32; 4 * (COUNT + 1) * BLOCK]; 2];
        let mut waiting: Option<(usize, *mut f32)> = None;
        let (mut places, mut factors) = ([_mm512_setzero_si512(); DIAGONALS], [_mm512_setzero_ps(); DIAGONALS]);
        for d in 0..DIAGONALS {
            // SAFETY: the arrays are as long as a register.
            unsafe {
                places[d] = _mm512_loadu_si512(self.places[d].as_ptr().cast());
                factors[d] = _mm512_loadu_ps(self.factors[d].as_ptr());
            }
        }
        for block in blocks {
            let first = block * BLOCK;
            let count = BLOCK.min(self.from.signals - first);
            for plane in 0..self.from.plane_count {
                let from = self.from.planes[plane].wrapping_add(first * from_stride).cast_const();
                let to = self.to.planes[plane].wrapping_add(first * to_stride);
                let streams = self.streams && count == BLOCK;
                let into = if streams { aside[block % 2].as_mut_ptr() } else { to };
                // SAFETY: the caller's; what is masked out is not touched.
                unsafe {
                    for k in 0..count {
                        let (from, into) = (from.add(k * from_stride), into.add(k * to_stride));
                        let ahead = from.wrapping_add(BLOCK * from_stride);
                        for line in (0..from_stride.min(64)).step_by(BLOCK) {
                            _mm_prefetch::<_MM_HINT_T0>(ahead.wrapping_add(line).cast());
                        }
                        for channel in 0..from_row.channels {
                            into.add(to_row.column(channel, 0)).write(*from.add(from_row.column(channel, 0)));
                            let x = _mm512_maskz_loadu_ps(MASK, from.add(from_row.column(channel, 1)));
                            let term = |d: usize| _mm512_permutexvar_ps(places[d], x);
                            // Two sums, so that one does not wait for the other.
                            let mut even = _mm512_mul_ps(term(0), factors[0]);
                            let mut odd = _mm512_mul_ps(term(1), factors[1]);
                            even = _mm512_fmadd_ps(term(2), factors[2], even);
                            odd = _mm512_fmadd_ps(term(3), factors[3], odd);
                            even = _mm512_fmadd_ps(term(4), factors[4], even);
                            odd = _mm512_fmadd_ps(term(5), factors[5], odd);
                            even = _mm512_fmadd_ps(term(6), factors[6], even);
                            let y = _mm512_add_ps(even, odd);
                            _mm512_mask_storeu_ps(into.add(to_row.column(channel, 1)), MASK, y);
                        }
                    }
                    if let Some((block, to)) = waiting.take() {
                        f32::stream(Unit::Avx512)(aside[block % 2].as_ptr(), to, BLOCK * to_stride);
                    }
                }
                waiting = streams.then_some((block, to));
            }
        }
        if let Some((block, to)) = waiting {
            // SAFETY: the caller's.
            unsafe { f32::stream(Unit::Avx512)(aside[block % 2].as_ptr(), to, BLOCK * to_stride) }
            fence();
        }
    }
}
