//! What a vector unit multiplies at the most: chains of multiply-adds that do not wait for each other, in registers alone.

use std::hint::black_box;
use std::time::Instant;
use zonal::batch::Unit;

/// How many chains there are, and how often each is gone through.
const CHAINS: usize = 12;
const STEPS: usize = 1 << 20;

/// A function that goes through the chains with a unit's registers; it returns how many numbers a register has.
macro_rules! chains {
    ($name:ident, $features:literal, $lanes:literal, $splat:ident, |$x:ident, $y:ident, $z:ident| $step:expr, $first:ident) => {
        /// # Safety
        ///
        /// The processor has the unit.
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = $features)]
        unsafe fn $name(a: f32, b: f32) -> (f32, usize) {
            use std::arch::x86_64::*;
            let ($y, $z) = ($splat(a), $splat(b));
            let mut sums = [$z; CHAINS];
            for _ in 0..STEPS {
                // A chain stays in a register only where nothing is called in between.
                for sum in &mut sums {
                    let $x = *sum;
                    *sum = $step;
                }
            }
            let mut all = 0.0;
            for sum in sums {
                all += $first(sum);
            }
            (all, $lanes)
        }
    };
}

chains!(
    avx512,
    "avx512f,avx512dq,avx512vl,avx2,fma",
    16,
    _mm512_set1_ps,
    |x, a, b| _mm512_fmadd_ps(x, a, b),
    _mm512_cvtss_f32
);
chains!(avx2, "avx2,fma", 8, _mm256_set1_ps, |x, a, b| _mm256_fmadd_ps(x, a, b), _mm256_cvtss_f32);
chains!(sse2, "sse2", 4, _mm_set1_ps, |x, a, b| _mm_add_ps(_mm_mul_ps(x, a), b), _mm_cvtss_f32);

fn run(unit: Unit) -> usize {
    let (a, b) = (black_box(0.5_f32), black_box(1.0_f32));
    // SAFETY: a unit is asked for that the processor has.
    #[cfg(target_arch = "x86_64")]
    let (sum, lanes) = unsafe {
        match unit {
            Unit::Avx512 => avx512(a, b),
            Unit::Avx2 => avx2(a, b),
            Unit::Base => sse2(a, b),
        }
    };
    #[cfg(not(target_arch = "x86_64"))]
    let (sum, lanes) = {
        let _ = unit;
        let mut sums = [[b; 4]; CHAINS];
        for _ in 0..STEPS {
            sums = sums.map(|sum| sum.map(|x| x * a + b));
        }
        (sums.iter().map(|sum| sum[0]).sum::<f32>(), 4)
    };
    black_box(sum);
    lanes
}

/// Returns how many multiplications of f32, each with an addition, a unit does in a nanosecond.
pub fn multiplications(unit: Unit) -> f64 {
    let mut best = 0.0_f64;
    for _ in 0..9 {
        let start = Instant::now();
        let lanes = run(unit);
        let nanoseconds = start.elapsed().as_secs_f64() * 1e9;
        best = best.max((CHAINS * STEPS * lanes) as f64 / nanoseconds);
    }
    best
}
