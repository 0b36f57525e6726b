//! One rotation of many rows of order 4, as splats have them: the bands 1 to 3 of a channel are fifteen numbers side by side, one
//! register of AVX-512 or two of AVX2, and the rotation's matrix is seven diagonals of its blocks, so that six permutations and
//! seven multiply-adds turn a channel of one row without a transposition. A block is a cycle of permutations: diagonal d takes
//! number i + d of the band, counted around.

use super::numbers::Number;
use super::pass::{Aside, MOST_CHANNELS};
use super::registers::BLOCK;
use super::rows::Row;
use super::signals::{Places, View};
use super::units::{Unit, fence};
use crate::coefficients::Coefficients;
use crate::pieces::source;
use crate::rotation::Rotation;
use core::arch::x86_64::*;

/// The numbers of the bands 1 to 3.
const COUNT: usize = 15;
/// The diagonals of the largest block.
const DIAGONALS: usize = 7;
/// The numbers that a register of AVX-512 holds of a row.
const MASK: __mmask16 = (1 << COUNT) - 1;
/// The numbers of the bands 1 and 2, which are a register of AVX2; band 3 is in another, behind the last number of these.
const LOW: usize = 8;

/// A rotation as diagonals, and the rows that it turns.
pub struct Diagonals {
    unit: Unit,
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
        if unit == Unit::Base || from.plane_count != to.plane_count {
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
            unit,
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
    /// The views' memory is borrowed, nobody else touches these rows of the results, and the processor has the unit.
    pub unsafe fn over(&self, blocks: core::ops::Range<usize>) {
        // SAFETY: the caller's.
        unsafe {
            match self.unit {
                Unit::Avx512 => self.over_avx512(blocks),
                _ => self.over_avx2(blocks),
            }
        }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
    unsafe fn over_avx512(&self, blocks: core::ops::Range<usize>) {
        let (mut places, mut factors) = ([_mm512_setzero_si512(); DIAGONALS], [_mm512_setzero_ps(); DIAGONALS]);
        for d in 0..DIAGONALS {
            // SAFETY: the arrays are as long as a register.
            unsafe {
                places[d] = _mm512_loadu_si512(self.places[d].as_ptr().cast());
                factors[d] = _mm512_loadu_ps(self.factors[d].as_ptr());
            }
        }
        let turn = of_rows(
            #[inline(always)]
            |from: *const f32, to: *mut f32| {
                // SAFETY: what is masked out is not touched.
                let x = unsafe { _mm512_maskz_loadu_ps(MASK, from) };
                let term = source(
                    #[inline(always)]
                    |d: usize| _mm512_permutexvar_ps(places[d], x),
                );
                // Two sums, so that one does not wait for the other.
                let mut even = _mm512_mul_ps(x, factors[0]);
                let mut odd = _mm512_mul_ps(term(1), factors[1]);
                even = _mm512_fmadd_ps(term(2), factors[2], even);
                odd = _mm512_fmadd_ps(term(3), factors[3], odd);
                even = _mm512_fmadd_ps(term(4), factors[4], even);
                odd = _mm512_fmadd_ps(term(5), factors[5], odd);
                even = _mm512_fmadd_ps(term(6), factors[6], even);
                // SAFETY: as above.
                unsafe { _mm512_mask_storeu_ps(to, MASK, _mm512_add_ps(even, odd)) }
            },
        );
        // SAFETY: the caller's.
        unsafe { self.each(blocks, turn, |_, _| ()) }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[target_feature(enable = "avx2,fma")]
    unsafe fn over_avx2(&self, blocks: core::ops::Range<usize>) {
        let (mut places, mut factors) =
            ([[_mm256_setzero_si256(); DIAGONALS]; 2], [[_mm256_setzero_ps(); DIAGONALS]; 2]);
        for d in 0..DIAGONALS {
            // The higher register begins with the last number of the lower one, which stays as it is there.
            let (mut high_places, mut high_factors) = ([0; LOW], [0.0; LOW]);
            for i in 1..LOW {
                high_places[i] = self.places[d][i + LOW - 1] - (LOW as i32 - 1);
                high_factors[i] = self.factors[d][i + LOW - 1];
            }
            // SAFETY: the arrays are as long as a register.
            unsafe {
                places[0][d] = _mm256_loadu_si256(self.places[d].as_ptr().cast());
                factors[0][d] = _mm256_loadu_ps(self.factors[d].as_ptr());
                places[1][d] = _mm256_loadu_si256(high_places.as_ptr().cast());
                factors[1][d] = _mm256_loadu_ps(high_factors.as_ptr());
            }
        }
        let low = of_rows(
            #[inline(always)]
            |from: *const f32, to: *mut f32| {
                // SAFETY: there are fifteen numbers.
                let x = unsafe { _mm256_loadu_ps(from) };
                let term = source(
                    #[inline(always)]
                    |d: usize| _mm256_permutevar8x32_ps(x, places[0][d]),
                );
                let mut even = _mm256_mul_ps(x, factors[0][0]);
                let mut odd = _mm256_mul_ps(term(1), factors[0][1]);
                even = _mm256_fmadd_ps(term(2), factors[0][2], even);
                odd = _mm256_fmadd_ps(term(3), factors[0][3], odd);
                even = _mm256_fmadd_ps(term(4), factors[0][4], even);
                // SAFETY: as above.
                unsafe { _mm256_storeu_ps(to, _mm256_add_ps(even, odd)) }
            },
        );
        let high = of_rows(
            #[inline(always)]
            |from: *const f32, to: *mut f32| {
                // SAFETY: there are fifteen numbers, of which these are the last eight.
                let x = unsafe { _mm256_loadu_ps(from.add(LOW - 1)) };
                let term = source(
                    #[inline(always)]
                    |d: usize| _mm256_permutevar8x32_ps(x, places[1][d]),
                );
                let mut even = _mm256_mul_ps(x, factors[1][0]);
                let mut odd = _mm256_mul_ps(term(1), factors[1][1]);
                even = _mm256_fmadd_ps(term(2), factors[1][2], even);
                odd = _mm256_fmadd_ps(term(3), factors[1][3], odd);
                even = _mm256_fmadd_ps(term(4), factors[1][4], even);
                odd = _mm256_fmadd_ps(term(5), factors[1][5], odd);
                even = _mm256_fmadd_ps(term(6), factors[1][6], even);
                // SAFETY: as above.
                unsafe {
                    let to = to.add(LOW - 1);
                    let done = _mm256_castps128_ps256(_mm_load_ss(to));
                    _mm256_storeu_ps(to, _mm256_blend_ps::<1>(_mm256_add_ps(even, odd), done));
                }
            },
        );
        // SAFETY: the caller's.
        unsafe { self.each(blocks, low, high) }
    }

    /// Turns the rows of some blocks by two functions of where the bands 1 to 3 of a channel are read and written: the first of all
    /// rows of a block, then the second, so that what each needs stays in registers.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(always)]
    unsafe fn each(
        &self,
        blocks: core::ops::Range<usize>,
        turn: impl Fn(*const f32, *mut f32),
        then: impl Fn(*const f32, *mut f32),
    ) {
        // SAFETY: the caller's.
        unsafe {
            match self.rows[0].channels {
                1 => self.each_of::<1>(blocks, turn, then),
                3 => self.each_of::<3>(blocks, turn, then),
                2 => self.each_of::<2>(blocks, turn, then),
                _ => self.each_of::<MOST_CHANNELS>(blocks, turn, then),
            }
        }
    }

    /// [`each`](Self::each) of so many channels.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(always)]
    unsafe fn each_of<const CHANNELS: usize>(
        &self,
        blocks: core::ops::Range<usize>,
        turn: impl Fn(*const f32, *mut f32),
        then: impl Fn(*const f32, *mut f32),
    ) {
        let [from_stride, to_stride] = self.strides;
        let places =
            |row: &Row, i: usize| core::array::from_fn::<_, MOST_CHANNELS, _>(|channel| row.column(channel, i));
        let [from_constants, to_constants] = self.rows.each_ref().map(|row| places(row, 0));
        let [from_rest, to_rest] = self.rows.each_ref().map(|row| places(row, 1));
        let stream = f32::stream(self.unit);
        // Two, so that what was just written is not read at once; between them room, since a processor takes addresses that are a
        // multiple of a page apart for the same at first.
        const ASIDE: usize = MOST_CHANNELS * (COUNT + 1) * BLOCK + 2 * BLOCK;
        let mut both = Aside::<[f32; 2 * ASIDE]>::new();
        let first_aside: *mut f32 = both.first();
        let aside = |block: usize| first_aside.wrapping_add(block % 2 * ASIDE);
        let mut waiting: Option<(usize, *mut f32)> = None;
        for block in blocks {
            let first = block * BLOCK;
            let count = BLOCK.min(self.from.signals - first);
            for plane in 0..self.from.plane_count {
                let from = self.from.planes[plane].wrapping_add(first * from_stride).cast_const();
                let to = self.to.planes[plane].wrapping_add(first * to_stride);
                let streams = self.streams && count == BLOCK;
                let into = if streams { aside(block) } else { to };
                // SAFETY: the caller's.
                unsafe {
                    for k in 0..count {
                        let (from, into) = (from.add(k * from_stride), into.add(k * to_stride));
                        let ahead = from.wrapping_add(BLOCK * from_stride);
                        for line in (0..from_stride.min(64)).step_by(BLOCK) {
                            _mm_prefetch::<_MM_HINT_T0>(ahead.wrapping_add(line).cast());
                        }
                        for channel in 0..CHANNELS {
                            into.add(to_constants[channel]).write(*from.add(from_constants[channel]));
                            turn(from.add(from_rest[channel]), into.add(to_rest[channel]));
                        }
                    }
                    for k in 0..count {
                        let (from, into) = (from.add(k * from_stride), into.add(k * to_stride));
                        for channel in 0..CHANNELS {
                            then(from.add(from_rest[channel]), into.add(to_rest[channel]));
                        }
                    }
                    if let Some((block, to)) = waiting.take() {
                        stream(aside(block), to, BLOCK * to_stride);
                    }
                }
                waiting = streams.then_some((block, to));
            }
        }
        if let Some((block, to)) = waiting {
            // SAFETY: the caller's.
            unsafe { stream(aside(block), to, BLOCK * to_stride) }
            fence();
        }
    }
}

/// A function of where a row is read and written, always inlined: only so is it compiled for the unit of the function around it.
#[inline(always)]
fn of_rows<F: Fn(*const f32, *mut f32)>(of: F) -> F {
    of
}
