//! Four numbers in an array, for processors whose vector units are not known here: what the compiler makes of them.

use super::{Quads, Register, of_two};
use core::ops::{Add, Mul, Neg, Sub};
use zonal_kernels::real::{Real, Signal};

/// Two arrays, number by number.
#[inline(always)]
fn zip<T: Copy, const N: usize>(a: [T; N], b: [T; N], of: impl Fn(T, T) -> T) -> [T; N] {
    core::array::from_fn(|i| of(a[i], b[i]))
}

macro_rules! plain {
    ($name:ident: $number:ident, $lanes:literal, $tiny:literal) => {
        register! {
            /// An array.
            $name([$number; $lanes]): $number, $lanes, tiny $tiny;
            splat |x| [x; $lanes];
            load |p| p.cast::<[$number; $lanes]>().read_unaligned();
            store |p, x| p.cast::<[$number; $lanes]>().write_unaligned(x);
            stream |p, x| p.cast::<[$number; $lanes]>().write_unaligned(x);
            fence {};
            prefetch |p| {};
            add |a, b| zip(a, b, |a, b| a + b);
            sub |a, b| zip(a, b, |a, b| a - b);
            mul |a, b| zip(a, b, |a, b| a * b);
            neg |x| x.map(|x| -x);
            abs |x| x.map(Real::abs);
            div |a, b| zip(a, b, |a, b| a / b);
            sqrt |x| x.map(Real::root);
            fma |a, b, c| zip(zip(a, b, |a, b| a * b), c, |a, b| a + b);
            fms |a, b, c| zip(zip(a, b, |a, b| a * b), c, |a, b| a - b);
            fnma |a, b, c| zip(c, zip(a, b, |a, b| a * b), |a, b| a - b);
            choose |a, b, c, d| core::array::from_fn(|i| if a[i] < b[i] { c[i] } else { d[i] });
        }
    };
}

plain!(F32x4: f32, 4, 1e-15);
plain!(F64x2: f64, 2, 1e-30);

quads! {
    F32x4;
    gather |p, _step| p.cast::<[f32; 4]>().read_unaligned();
    scatter |p, _step, x| p.cast::<[f32; 4]>().write_unaligned(x);
    interleave |a, b| [a[0], b[0], a[1], b[1]], [a[2], b[2], a[3], b[3]];
    halves |a, b| [a[0], a[1], b[0], b[1]], [a[2], a[3], b[2], b[3]];
}
