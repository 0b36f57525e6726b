//! The registers of aarch64: NEON, which every processor has.

use super::{Quads, Register, of_two};
use core::arch::aarch64::*;
use core::ops::{Add, Mul, Neg, Sub};
use zonal_kernels::real::{Real, Signal};

register! {
    /// Four f32.
    F32x4(float32x4_t): f32, 4, tiny 1e-15;
    splat |x| vdupq_n_f32(x);
    load |p| vld1q_f32(p);
    store |p, x| vst1q_f32(p, x);
    stream |p, x| vst1q_f32(p, x);
    fence {};
    prefetch |p| {};
    add |a, b| vaddq_f32(a, b);
    sub |a, b| vsubq_f32(a, b);
    mul |a, b| vmulq_f32(a, b);
    neg |x| vnegq_f32(x);
    abs |x| vabsq_f32(x);
    div |a, b| vdivq_f32(a, b);
    sqrt |x| vsqrtq_f32(x);
    fma |a, b, c| vfmaq_f32(c, a, b);
    fms |a, b, c| vnegq_f32(vfmsq_f32(c, a, b));
    fnma |a, b, c| vfmsq_f32(c, a, b);
    choose |a, b, c, d| vbslq_f32(vcltq_f32(a, b), c, d);
}

register! {
    /// Two f64.
    F64x2(float64x2_t): f64, 2, tiny 1e-30;
    splat |x| vdupq_n_f64(x);
    load |p| vld1q_f64(p);
    store |p, x| vst1q_f64(p, x);
    stream |p, x| vst1q_f64(p, x);
    fence {};
    prefetch |p| {};
    add |a, b| vaddq_f64(a, b);
    sub |a, b| vsubq_f64(a, b);
    mul |a, b| vmulq_f64(a, b);
    neg |x| vnegq_f64(x);
    abs |x| vabsq_f64(x);
    div |a, b| vdivq_f64(a, b);
    sqrt |x| vsqrtq_f64(x);
    fma |a, b, c| vfmaq_f64(c, a, b);
    fms |a, b, c| vnegq_f64(vfmsq_f64(c, a, b));
    fnma |a, b, c| vfmsq_f64(c, a, b);
    choose |a, b, c, d| vbslq_f64(vcltq_f64(a, b), c, d);
}

quads! {
    F32x4;
    gather |p, _step| vld1q_f32(p);
    scatter |p, _step, x| vst1q_f32(p, x);
    interleave |a, b| vzip1q_f32(a, b), vzip2q_f32(a, b);
    halves |a, b| vcombine_f32(vget_low_f32(a), vget_low_f32(b)), vcombine_f32(vget_high_f32(a), vget_high_f32(b));
}
