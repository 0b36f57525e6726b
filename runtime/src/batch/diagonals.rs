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
/// The diagonals of band 2, the larger of those.
const LOW_DIAGONALS: usize = 5;

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

/// What the lower or the higher eight numbers need.
struct Half {
    places: [[i32; LOW]; DIAGONALS],
    factors: [[f32; LOW]; DIAGONALS],
}

impl Half {
    /// Returns what turns the eight numbers by the first so many diagonals. It is made anew for the rows of a block, so that all that
    /// it needs stays in registers for so long and no longer.
    #[inline(always)]
    fn turn<const COUNT: usize>(&self) -> impl Fn(__m256) -> __m256 {
        let half = core::hint::black_box(self);
        // SAFETY: the arrays are as long as a register; the function that this is inlined into is compiled for AVX2 and FMA.
        let (mut places, mut factors) = unsafe { ([_mm256_setzero_si256(); COUNT], [_mm256_setzero_ps(); COUNT]) };
        for d in 0..COUNT {
            // SAFETY: as above.
            unsafe {
                places[d] = _mm256_loadu_si256(half.places[d].as_ptr().cast());
                factors[d] = _mm256_loadu_ps(half.factors[d].as_ptr());
            }
        }
        of_eight(
            #[inline(always)]
            move |x| {
                // SAFETY: as above.
                unsafe {
                    let mut sum = _mm256_mul_ps(x, factors[0]);
                    for d in 1..COUNT {
                        sum = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(x, places[d]), factors[d], sum);
                    }
                    sum
                }
            },
        )
    }
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
        unsafe { self.each(blocks, || &turn, || |_: *const f32, _: *mut f32| ()) }
    }

    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[target_feature(enable = "avx2,fma")]
    unsafe fn over_avx2(&self, blocks: core::ops::Range<usize>) {
        // The higher eight numbers begin with the last of the lower ones.
        let half = |first: usize| Half {
            places: self.places.map(|places| core::array::from_fn(|i| places[first + i] - first as i32)),
            factors: self.factors.map(|factors| core::array::from_fn(|i| factors[first + i])),
        };
        let [low, high] = [half(0), half(LOW - 1)];
        let lower = of_block(
            #[inline(always)]
            || {
                let turn = low.turn::<LOW_DIAGONALS>();
                of_rows(
                    #[inline(always)]
                    move |from: *const f32, to: *mut f32| {
                        // SAFETY: there are fifteen numbers.
                        unsafe { _mm256_storeu_ps(to, turn(_mm256_loadu_ps(from))) }
                    },
                )
            },
        );
        let higher = of_block(
            #[inline(always)]
            || {
                let turn = high.turn::<DIAGONALS>();
                of_rows(
                    #[inline(always)]
                    move |from: *const f32, to: *mut f32| {
                        // SAFETY: there are fifteen numbers, of which these are the last eight. The first of them is written with
                        // the lower ones, for which it stays as it is where rows are turned in place.
                        unsafe {
                            let x = _mm256_loadu_ps(from.add(LOW - 1));
                            _mm256_storeu_ps(to.add(LOW - 1), _mm256_blend_ps::<1>(turn(x), x));
                        }
                    },
                )
            },
        );
        // SAFETY: the caller's.
        unsafe { self.each(blocks, higher, lower) }
    }

    /// Turns the rows of some blocks by two functions of where the bands 1 to 3 of a channel are read and written: the first of all
    /// rows of a block, then the second, so that what each needs stays in registers.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(always)]
    unsafe fn each<F: Fn(*const f32, *mut f32), G: Fn(*const f32, *mut f32)>(
        &self,
        blocks: core::ops::Range<usize>,
        turn: impl Fn() -> F,
        then: impl Fn() -> G,
    ) {
        // SAFETY: the caller's.
        unsafe {
            match self.rows[0].channels {
                1 => self.each_of::<1, F, G>(blocks, turn, then),
                3 => self.each_of::<3, F, G>(blocks, turn, then),
                2 => self.each_of::<2, F, G>(blocks, turn, then),
                _ => self.each_of::<MOST_CHANNELS, F, G>(blocks, turn, then),
            }
        }
    }

    /// [`each`](Self::each) of so many channels.
    ///
    /// # Safety
    ///
    /// As [`over`](Self::over).
    #[inline(always)]
    unsafe fn each_of<const CHANNELS: usize, F: Fn(*const f32, *mut f32), G: Fn(*const f32, *mut f32)>(
        &self,
        blocks: core::ops::Range<usize>,
        turn: impl Fn() -> F,
        then: impl Fn() -> G,
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
                    let turn = turn();
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
                    let then = then();
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

/// A function that gives one of rows for a block's.
#[inline(always)]
fn of_block<F: Fn() -> G, G: Fn(*const f32, *mut f32)>(of: F) -> F {
    of
}

/// A function of eight numbers.
#[inline(always)]
fn of_eight<F: Fn(__m256) -> __m256>(of: F) -> F {
    of
}
