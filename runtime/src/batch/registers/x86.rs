//! The registers of x86-64: SSE2, which every processor has, AVX2 with FMA, AVX-512.

use super::{Quads, Register, of_two};
use crate::pieces::source;
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Neg, Sub};
use zonal_kernels::real::{Real, Signal};

register! {
    /// Sixteen f32 of AVX-512.
    F32x16(__m512): f32, 16, tiny 1e-15;
    splat |x| _mm512_set1_ps(x);
    load |p| _mm512_loadu_ps(p);
    store |p, x| _mm512_storeu_ps(p, x);
    stream |p, x| _mm512_stream_ps(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm512_add_ps(a, b);
    sub |a, b| _mm512_sub_ps(a, b);
    mul |a, b| _mm512_mul_ps(a, b);
    neg |x| _mm512_xor_ps(x, _mm512_set1_ps(-0.0));
    abs |x| _mm512_abs_ps(x);
    div |a, b| _mm512_div_ps(a, b);
    sqrt |x| _mm512_sqrt_ps(x);
    fma |a, b, c| _mm512_fmadd_ps(a, b, c);
    fms |a, b, c| _mm512_fmsub_ps(a, b, c);
    fnma |a, b, c| _mm512_fnmadd_ps(a, b, c);
    choose |a, b, c, d| _mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b), d, c);
}

register! {
    /// Eight f64 of AVX-512.
    F64x8(__m512d): f64, 8, tiny 1e-30;
    splat |x| _mm512_set1_pd(x);
    load |p| _mm512_loadu_pd(p);
    store |p, x| _mm512_storeu_pd(p, x);
    stream |p, x| _mm512_stream_pd(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm512_add_pd(a, b);
    sub |a, b| _mm512_sub_pd(a, b);
    mul |a, b| _mm512_mul_pd(a, b);
    neg |x| _mm512_xor_pd(x, _mm512_set1_pd(-0.0));
    abs |x| _mm512_abs_pd(x);
    div |a, b| _mm512_div_pd(a, b);
    sqrt |x| _mm512_sqrt_pd(x);
    fma |a, b, c| _mm512_fmadd_pd(a, b, c);
    fms |a, b, c| _mm512_fmsub_pd(a, b, c);
    fnma |a, b, c| _mm512_fnmadd_pd(a, b, c);
    choose |a, b, c, d| _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b), d, c);
}

register! {
    /// Eight f32 of AVX2 with FMA.
    F32x8(__m256): f32, 8, tiny 1e-15;
    splat |x| _mm256_set1_ps(x);
    load |p| _mm256_loadu_ps(p);
    store |p, x| _mm256_storeu_ps(p, x);
    stream |p, x| _mm256_stream_ps(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm256_add_ps(a, b);
    sub |a, b| _mm256_sub_ps(a, b);
    mul |a, b| _mm256_mul_ps(a, b);
    neg |x| _mm256_xor_ps(x, _mm256_set1_ps(-0.0));
    abs |x| _mm256_andnot_ps(_mm256_set1_ps(-0.0), x);
    div |a, b| _mm256_div_ps(a, b);
    sqrt |x| _mm256_sqrt_ps(x);
    fma |a, b, c| _mm256_fmadd_ps(a, b, c);
    fms |a, b, c| _mm256_fmsub_ps(a, b, c);
    fnma |a, b, c| _mm256_fnmadd_ps(a, b, c);
    choose |a, b, c, d| _mm256_blendv_ps(d, c, _mm256_cmp_ps::<_CMP_LT_OQ>(a, b));
}

register! {
    /// Four f64 of AVX2 with FMA.
    F64x4(__m256d): f64, 4, tiny 1e-30;
    splat |x| _mm256_set1_pd(x);
    load |p| _mm256_loadu_pd(p);
    store |p, x| _mm256_storeu_pd(p, x);
    stream |p, x| _mm256_stream_pd(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm256_add_pd(a, b);
    sub |a, b| _mm256_sub_pd(a, b);
    mul |a, b| _mm256_mul_pd(a, b);
    neg |x| _mm256_xor_pd(x, _mm256_set1_pd(-0.0));
    abs |x| _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
    div |a, b| _mm256_div_pd(a, b);
    sqrt |x| _mm256_sqrt_pd(x);
    fma |a, b, c| _mm256_fmadd_pd(a, b, c);
    fms |a, b, c| _mm256_fmsub_pd(a, b, c);
    fnma |a, b, c| _mm256_fnmadd_pd(a, b, c);
    choose |a, b, c, d| _mm256_blendv_pd(d, c, _mm256_cmp_pd::<_CMP_LT_OQ>(a, b));
}

register! {
    /// Four f32 of SSE2, which fuses nothing.
    F32x4(__m128): f32, 4, tiny 1e-15;
    splat |x| _mm_set1_ps(x);
    load |p| _mm_loadu_ps(p);
    store |p, x| _mm_storeu_ps(p, x);
    stream |p, x| _mm_stream_ps(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm_add_ps(a, b);
    sub |a, b| _mm_sub_ps(a, b);
    mul |a, b| _mm_mul_ps(a, b);
    neg |x| _mm_xor_ps(x, _mm_set1_ps(-0.0));
    abs |x| _mm_andnot_ps(_mm_set1_ps(-0.0), x);
    div |a, b| _mm_div_ps(a, b);
    sqrt |x| _mm_sqrt_ps(x);
    fma |a, b, c| _mm_add_ps(_mm_mul_ps(a, b), c);
    fms |a, b, c| _mm_sub_ps(_mm_mul_ps(a, b), c);
    fnma |a, b, c| _mm_sub_ps(c, _mm_mul_ps(a, b));
    choose |a, b, c, d| {
        let less = _mm_cmplt_ps(a, b);
        _mm_or_ps(_mm_and_ps(less, c), _mm_andnot_ps(less, d))
    };
}

register! {
    /// Two f64 of SSE2, which fuses nothing.
    F64x2(__m128d): f64, 2, tiny 1e-30;
    splat |x| _mm_set1_pd(x);
    load |p| _mm_loadu_pd(p);
    store |p, x| _mm_storeu_pd(p, x);
    stream |p, x| _mm_stream_pd(p, x);
    fence _mm_sfence();
    prefetch |p| _mm_prefetch::<_MM_HINT_T0>(p.cast());
    add |a, b| _mm_add_pd(a, b);
    sub |a, b| _mm_sub_pd(a, b);
    mul |a, b| _mm_mul_pd(a, b);
    neg |x| _mm_xor_pd(x, _mm_set1_pd(-0.0));
    abs |x| _mm_andnot_pd(_mm_set1_pd(-0.0), x);
    div |a, b| _mm_div_pd(a, b);
    sqrt |x| _mm_sqrt_pd(x);
    fma |a, b, c| _mm_add_pd(_mm_mul_pd(a, b), c);
    fms |a, b, c| _mm_sub_pd(_mm_mul_pd(a, b), c);
    fnma |a, b, c| _mm_sub_pd(c, _mm_mul_pd(a, b));
    choose |a, b, c, d| {
        let less = _mm_cmplt_pd(a, b);
        _mm_or_pd(_mm_and_pd(less, c), _mm_andnot_pd(less, d))
    };
}

quads! {
    F32x16;
    gather |p, step| {
        let quad = source(#[inline(always)] |i: usize| _mm_loadu_ps(p.add(i * step)));
        let low = _mm512_insertf32x4::<1>(_mm512_castps128_ps512(quad(0)), quad(1));
        _mm512_insertf32x4::<3>(_mm512_insertf32x4::<2>(low, quad(2)), quad(3))
    };
    scatter |p, step, x| {
        _mm_storeu_ps(p, _mm512_castps512_ps128(x));
        _mm_storeu_ps(p.add(step), _mm512_extractf32x4_ps::<1>(x));
        _mm_storeu_ps(p.add(2 * step), _mm512_extractf32x4_ps::<2>(x));
        _mm_storeu_ps(p.add(3 * step), _mm512_extractf32x4_ps::<3>(x));
    };
    interleave |a, b| _mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b);
    halves |a, b| _mm512_shuffle_ps::<0x44>(a, b), _mm512_shuffle_ps::<0xEE>(a, b);
    cross |a, b| _mm512_shuffle_f32x4::<0x44>(a, b), _mm512_shuffle_f32x4::<0xEE>(a, b),
        _mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xDD>(a, b);
}

quads! {
    F32x8;
    gather |p, step| {
        _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p.add(step)))
    };
    scatter |p, step, x| {
        _mm_storeu_ps(p, _mm256_castps256_ps128(x));
        _mm_storeu_ps(p.add(step), _mm256_extractf128_ps::<1>(x));
    };
    interleave |a, b| _mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b);
    halves |a, b| _mm256_shuffle_ps::<0x44>(a, b), _mm256_shuffle_ps::<0xEE>(a, b);
}

quads! {
    F32x4;
    gather |p, _step| _mm_loadu_ps(p);
    scatter |p, _step, x| _mm_storeu_ps(p, x);
    interleave |a, b| _mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b);
    halves |a, b| _mm_movelh_ps(a, b), _mm_movehl_ps(b, a);
}
