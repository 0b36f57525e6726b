//! Two registers as one number of a kernel: what goes by directions has many constants and few values at once, so that each
//! constant is read once for both, and one works while the other waits.

use super::Register;
use core::ops::{Add, Mul, Neg, Sub};
use zonal_kernels::real::{Real, Signal};

/// Two registers side by side.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct Pair<R>([R; 2]);

impl<R: Copy> Pair<R> {
    #[inline(always)]
    fn both(of: R) -> Self {
        Self([of, of])
    }
}

/// Operations of one, two and three pairs, half by half.
macro_rules! halves {
    ($of:path, $a:expr) => {
        Pair([$of($a.0[0]), $of($a.0[1])])
    };
    ($of:path, $a:expr, $b:expr) => {
        Pair([$of($a.0[0], $b.0[0]), $of($a.0[1], $b.0[1])])
    };
    ($of:path, $a:expr, $b:expr, $c:expr) => {
        Pair([$of($a.0[0], $b.0[0], $c.0[0]), $of($a.0[1], $b.0[1], $c.0[1])])
    };
}

impl<R: Register> Add for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        halves!(Add::add, self, other)
    }
}

impl<R: Register> Sub for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        halves!(Sub::sub, self, other)
    }
}

impl<R: Register> Neg for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        halves!(Neg::neg, self)
    }
}

impl<R: Register> Mul for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        halves!(Mul::mul, self, other)
    }
}

impl<R: Register> Signal<Self> for Pair<R> {
    #[inline(always)]
    fn zero() -> Self {
        Self::both(<R as Signal<R>>::zero())
    }
    #[inline(always)]
    fn fma(self, t: Self, c: Self) -> Self {
        halves!(Signal::<R>::fma, self, t, c)
    }
    #[inline(always)]
    fn fms(self, t: Self, c: Self) -> Self {
        halves!(Signal::<R>::fms, self, t, c)
    }
    #[inline(always)]
    fn fnma(self, t: Self, c: Self) -> Self {
        halves!(Signal::<R>::fnma, self, t, c)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn times_fma(self, other: Self, c: Self) -> Self {
        self.fma(other, c)
    }
    #[inline(always)]
    fn times_fms(self, other: Self, c: Self) -> Self {
        self.fms(other, c)
    }
    #[inline(always)]
    fn times_fnma(self, other: Self, c: Self) -> Self {
        self.fnma(other, c)
    }
    #[inline(always)]
    fn choose(a: Self, b: Self, c: Self, d: Self) -> Self {
        let half = |i: usize| <R as Signal<R>>::choose(a.0[i], b.0[i], c.0[i], d.0[i]);
        Self([half(0), half(1)])
    }
}

/// What a pair does with single numbers of a kind.
macro_rules! numbers {
    ($($number:ident)*) => { $(
        impl<R: Register<Number = $number>> Mul<$number> for Pair<R> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: $number) -> Self {
                Self([self.0[0] * other, self.0[1] * other])
            }
        }
        impl<R: Register<Number = $number>> Signal<$number> for Pair<R> {
            #[inline(always)]
            fn zero() -> Self {
                <Self as Signal<Self>>::zero()
            }
            #[inline(always)]
            fn fma(self, t: $number, c: Self) -> Self {
                Self([self.0[0].fma(t, c.0[0]), self.0[1].fma(t, c.0[1])])
            }
            #[inline(always)]
            fn fms(self, t: $number, c: Self) -> Self {
                Self([self.0[0].fms(t, c.0[0]), self.0[1].fms(t, c.0[1])])
            }
            #[inline(always)]
            fn fnma(self, t: $number, c: Self) -> Self {
                Self([self.0[0].fnma(t, c.0[0]), self.0[1].fnma(t, c.0[1])])
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn times_fma(self, other: Self, c: Self) -> Self {
                <Self as Signal<Self>>::fma(self, other, c)
            }
            #[inline(always)]
            fn times_fms(self, other: Self, c: Self) -> Self {
                <Self as Signal<Self>>::fms(self, other, c)
            }
            #[inline(always)]
            fn times_fnma(self, other: Self, c: Self) -> Self {
                <Self as Signal<Self>>::fnma(self, other, c)
            }
            #[inline(always)]
            fn choose(a: $number, b: $number, c: Self, d: Self) -> Self {
                if a < b { c } else { d }
            }
        }
    )* };
}

numbers!(f32 f64);

impl<R: Register> Register for Pair<R>
where
    Self: Signal<R::Number>,
{
    type Number = R::Number;
    const LANES: usize = 2 * R::LANES;
    const COUNT: usize = 2 * R::COUNT;
    #[inline(always)]
    unsafe fn load(from: *const R::Number) -> Self {
        // SAFETY: the caller knows that the numbers and the unit are there.
        unsafe { Self([R::load(from), R::load(from.add(R::LANES))]) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut R::Number) {
        // SAFETY: the caller knows that there is room.
        unsafe {
            self.0[0].store(to);
            self.0[1].store(to.add(R::LANES));
        }
    }
    #[inline(always)]
    unsafe fn stream(self, to: *mut R::Number) {
        // SAFETY: the caller knows that there is room and where it begins.
        unsafe {
            self.0[0].stream(to);
            self.0[1].stream(to.add(R::LANES));
        }
    }
    #[inline(always)]
    fn fence() {
        R::fence();
    }
    #[inline(always)]
    fn prefetch(from: *const R::Number) {
        R::prefetch(from);
    }
}

impl<R: Register> Real for Pair<R> {
    const TINY: Self = Self([R::TINY; 2]);
    #[inline(always)]
    fn lit(value: f64) -> Self {
        Self::both(R::lit(value))
    }
    #[inline(always)]
    fn lit2(narrow: f32, wide: f64) -> Self {
        Self::both(R::lit2(narrow, wide))
    }
    #[inline(always)]
    fn root(self) -> Self {
        halves!(Real::root, self)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        halves!(Real::recip, self)
    }
    #[inline(always)]
    fn at_most(self, limit: Self) -> bool {
        self.0[0].at_most(limit.0[0]) && self.0[1].at_most(limit.0[1])
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        halves!(Real::exp2, self)
    }
    #[inline(always)]
    fn log2(self) -> Self {
        halves!(Real::log2, self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        halves!(Real::abs, self)
    }
}
