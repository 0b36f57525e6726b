//! What a vector register holds as one number of a kernel: a type for each vector unit and precision, all of them rows of
//! one macro. Nothing here is safe by itself: whoever makes or uses a register must know that the processor has the unit, and
//! that the functions around it were compiled for it (`batch/units.rs` sees to both).

use zonal_kernels::real::{Real, Signal};

/// How many signals a block has.
pub const BLOCK: usize = 16;

/// A function of two registers, always inlined as [`source`](crate::pieces::source) is.
#[inline(always)]
#[allow(dead_code)]
fn of_two<V, F: Fn(V, V) -> (V, V)>(of: F) -> F {
    of
}

/// A vector register: [`LANES`](Self::LANES) numbers of as many signals. A kernel's parameters may be registers too, or single
/// numbers that all lanes share.
pub trait Register: Real + Signal<Self::Number> {
    /// What a lane holds.
    type Number: Real;
    /// How many lanes there are.
    const LANES: usize;
    /// How many registers of the processor it is.
    const COUNT: usize = 1;
    /// How many of these a line of a block takes.
    const PARTS: usize = BLOCK / Self::LANES;

    /// Reads the lanes.
    ///
    /// # Safety
    ///
    /// There are as many numbers from there on, and the processor has the unit.
    unsafe fn load(from: *const Self::Number) -> Self;

    /// Writes the lanes.
    ///
    /// # Safety
    ///
    /// There is room for as many numbers, and the processor has the unit.
    unsafe fn store(self, to: *mut Self::Number);

    /// Writes the lanes past the caches where the unit can, else as [`store`](Self::store) does.
    ///
    /// # Safety
    ///
    /// There is room for as many numbers, which begin at a multiple of 64 bytes, and the processor has the unit.
    unsafe fn stream(self, to: *mut Self::Number);

    /// Makes what was streamed visible to other threads before what is stored after.
    fn fence();

    /// Asks for a line of the cache that will be read.
    fn prefetch(from: *const Self::Number);
}

/// A register whose lanes fall into quads of four numbers, as rows of four columns have them.
pub trait Quads: Register {
    /// Reads a quad at every `step` numbers.
    ///
    /// # Safety
    ///
    /// There are four numbers at each of these places, and the processor has the unit.
    unsafe fn gather(from: *const Self::Number, step: usize) -> Self;

    /// Writes a quad to every `step` numbers.
    ///
    /// # Safety
    ///
    /// There is room for four numbers at each of these places, and the processor has the unit.
    unsafe fn scatter(self, to: *mut Self::Number, step: usize);

    /// Exchanges rows and columns of the four by four numbers that the same quad of four registers holds.
    ///
    /// # Safety
    ///
    /// The processor has the unit.
    unsafe fn transpose(rows: [Self; 4]) -> [Self; 4];

    /// Whether a register has four quads, which [`cross`](Self::cross) exchanges.
    const IS_WIDE: bool = false;

    /// Exchanges rows and columns of the four by four quads that four registers of four quads hold.
    ///
    /// # Safety
    ///
    /// The processor has the unit.
    #[inline(always)]
    unsafe fn cross(quads: [Self; 4]) -> [Self; 4] {
        quads
    }
}

/// A register type: its operations, each an expression of the registers that it names. What is fused is one instruction; where a
/// unit has none it is two.
#[allow(unused_macros)]
macro_rules! register {
    (
        $(#[$about:meta])*
        $name:ident($inner:ty): $number:ident, $lanes:literal, tiny $tiny:literal;
        splat |$splat:ident| $splatted:expr;
        load |$load:ident| $loaded:expr;
        store |$store_to:ident, $store:ident| $stored:expr;
        stream |$stream_to:ident, $stream:ident| $streamed:expr;
        fence $fence:expr;
        prefetch |$prefetch:ident| $prefetched:expr;
        add |$add_a:ident, $add_b:ident| $added:expr;
        sub |$sub_a:ident, $sub_b:ident| $subtracted:expr;
        mul |$mul_a:ident, $mul_b:ident| $multiplied:expr;
        neg |$neg:ident| $negated:expr;
        abs |$abs:ident| $absolute:expr;
        div |$div_a:ident, $div_b:ident| $divided:expr;
        sqrt |$sqrt:ident| $root:expr;
        fma |$fma_a:ident, $fma_b:ident, $fma_c:ident| $fused:expr;
        fms |$fms_a:ident, $fms_b:ident, $fms_c:ident| $fused_minus:expr;
        fnma |$fnma_a:ident, $fnma_b:ident, $fnma_c:ident| $minus_fused:expr;
        choose |$a:ident, $b:ident, $c:ident, $d:ident| $chosen:expr;
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $name($inner);

        impl $name {
            /// The same number in every lane.
            #[inline(always)]
            fn splat($splat: $number) -> Self {
                // SAFETY: registers are made where the processor has the unit alone.
                Self(unsafe { $splatted })
            }

            /// A function of each lane, one after the other.
            #[inline(always)]
            fn each(self, of: impl Fn($number) -> $number) -> Self {
                let mut lanes = [0.0; $lanes];
                // SAFETY: there are as many lanes as numbers, and a register is there, so that the unit is too.
                unsafe {
                    self.store(lanes.as_mut_ptr());
                    Self::load(lanes.map(of).as_ptr())
                }
            }
        }

        impl Register for $name {
            type Number = $number;
            const LANES: usize = $lanes;
            #[inline(always)]
            unsafe fn load($load: *const $number) -> Self {
                // SAFETY: the caller knows that the numbers and the unit are there.
                Self(unsafe { $loaded })
            }
            #[inline(always)]
            unsafe fn store(self, $store_to: *mut $number) {
                let $store = self.0;
                // SAFETY: the caller knows that there is room; a register is there, so that the unit is too.
                unsafe { $stored }
            }
            #[inline(always)]
            unsafe fn stream(self, $stream_to: *mut $number) {
                let $stream = self.0;
                // SAFETY: the caller knows that there is room and where it begins.
                unsafe { $streamed }
            }
            #[inline(always)]
            #[allow(unused_unsafe)]
            fn fence() {
                // SAFETY: a fence reads and writes nothing.
                unsafe { $fence }
            }
            #[inline(always)]
            #[allow(unused_unsafe, unused_variables)]
            fn prefetch($prefetch: *const $number) {
                // SAFETY: what is asked for ahead need not be there.
                unsafe { $prefetched }
            }
        }

        // SAFETY of all that follows: a register is there, so that the unit is too, and its operations touch no memory.
        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                let ($add_a, $add_b) = (self.0, other.0);
                Self(unsafe { $added })
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                let ($sub_a, $sub_b) = (self.0, other.0);
                Self(unsafe { $subtracted })
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let $neg = self.0;
                Self(unsafe { $negated })
            }
        }
        impl Mul<$name> for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: $name) -> Self {
                let ($mul_a, $mul_b) = (self.0, other.0);
                Self(unsafe { $multiplied })
            }
        }
        impl Mul<$number> for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: $number) -> Self {
                self * Self::splat(other)
            }
        }
        impl Signal<$name> for $name {
            #[inline(always)]
            fn zero() -> Self {
                Self::splat(0.0)
            }
            #[inline(always)]
            fn fma(self, t: $name, c: Self) -> Self {
                let ($fma_a, $fma_b, $fma_c) = (self.0, t.0, c.0);
                Self(unsafe { $fused })
            }
            #[inline(always)]
            fn fms(self, t: $name, c: Self) -> Self {
                let ($fms_a, $fms_b, $fms_c) = (self.0, t.0, c.0);
                Self(unsafe { $fused_minus })
            }
            #[inline(always)]
            fn fnma(self, t: $name, c: Self) -> Self {
                let ($fnma_a, $fnma_b, $fnma_c) = (self.0, t.0, c.0);
                Self(unsafe { $minus_fused })
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn times_fma(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fma(self, other, c)
            }
            #[inline(always)]
            fn times_fms(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fms(self, other, c)
            }
            #[inline(always)]
            fn times_fnma(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fnma(self, other, c)
            }
            #[inline(always)]
            fn choose(a: Self, b: Self, c: Self, d: Self) -> Self {
                let ($a, $b, $c, $d) = (a.0, b.0, c.0, d.0);
                Self(unsafe { $chosen })
            }
        }
        impl Signal<$number> for $name {
            #[inline(always)]
            fn zero() -> Self {
                Self::splat(0.0)
            }
            #[inline(always)]
            fn fma(self, t: $number, c: Self) -> Self {
                self.fma(Self::splat(t), c)
            }
            #[inline(always)]
            fn fms(self, t: $number, c: Self) -> Self {
                self.fms(Self::splat(t), c)
            }
            #[inline(always)]
            fn fnma(self, t: $number, c: Self) -> Self {
                self.fnma(Self::splat(t), c)
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn times_fma(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fma(self, other, c)
            }
            #[inline(always)]
            fn times_fms(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fms(self, other, c)
            }
            #[inline(always)]
            fn times_fnma(self, other: Self, c: Self) -> Self {
                Signal::<$name>::fnma(self, other, c)
            }
            #[inline(always)]
            fn choose(a: $number, b: $number, c: Self, d: Self) -> Self {
                if a < b { c } else { d }
            }
        }
        impl Real for $name {
            // SAFETY: a register has as many bits as its lanes, all of which are numbers.
            const TINY: Self = Self(unsafe { core::mem::transmute::<[$number; $lanes], $inner>([$tiny; $lanes]) });
            #[inline(always)]
            fn lit(value: f64) -> Self {
                Self::splat(value as $number)
            }
            #[inline(always)]
            fn lit2(narrow: f32, wide: f64) -> Self {
                Self::splat($number::lit2(narrow, wide))
            }
            #[inline(always)]
            fn root(self) -> Self {
                let $sqrt = self.0;
                Self(unsafe { $root })
            }
            #[inline(always)]
            fn recip(self) -> Self {
                let ($div_a, $div_b) = (Self::splat(1.0).0, self.0);
                Self(unsafe { $divided })
            }
            #[inline(always)]
            fn at_most(self, limit: Self) -> bool {
                let mut pairs = [[0.0; $lanes]; 2];
                let [x, most] = &mut pairs;
                // SAFETY: there are as many lanes as numbers.
                unsafe {
                    self.store(x.as_mut_ptr());
                    limit.store(most.as_mut_ptr());
                }
                pairs[0].iter().zip(&pairs[1]).all(|(x, most)| x <= most)
            }
            #[inline(always)]
            fn exp2(self) -> Self {
                self.each(Real::exp2)
            }
            #[inline(always)]
            fn log2(self) -> Self {
                self.each(Real::log2)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                let $abs = self.0;
                Self(unsafe { $absolute })
            }
        }
    };
}

/// The quads of a register of f32.
#[allow(unused_macros)]
macro_rules! quads {
    (
        $name:ident;
        gather |$from:ident, $step:ident| $gathered:expr;
        scatter |$to:ident, $apart:ident, $quads:ident| $scattered:expr;
        interleave |$a:ident, $b:ident| $low:expr, $high:expr;
        halves |$c:ident, $d:ident| $lower:expr, $upper:expr;
        $(cross |$e:ident, $f:ident| $both_low:expr, $both_high:expr, $even:expr, $odd:expr;)?
    ) => {
        impl Quads for $name {
            #[inline(always)]
            unsafe fn gather($from: *const f32, $step: usize) -> Self {
                // SAFETY: the caller knows that the numbers and the unit are there.
                Self(unsafe { $gathered })
            }
            #[inline(always)]
            unsafe fn scatter(self, $to: *mut f32, $apart: usize) {
                let $quads = self.0;
                // SAFETY: the caller knows that there is room.
                unsafe { $scattered }
            }
            #[inline(always)]
            unsafe fn transpose([p, q, r, s]: [Self; 4]) -> [Self; 4] {
                // SAFETY: registers are there, so that the unit is too.
                unsafe {
                    let pair = of_two(#[inline(always)] |$a, $b| ($low, $high));
                    let join = of_two(#[inline(always)] |$c, $d| ($lower, $upper));
                    let ((pq, pq_high), (rs, rs_high)) = (pair(p.0, q.0), pair(r.0, s.0));
                    let ((x, y), (z, w)) = (join(pq, rs), join(pq_high, rs_high));
                    [Self(x), Self(y), Self(z), Self(w)]
                }
            }
            $(
                const IS_WIDE: bool = true;
                #[inline(always)]
                unsafe fn cross([p, q, r, s]: [Self; 4]) -> [Self; 4] {
                    // SAFETY: registers are there, so that the unit is too.
                    unsafe {
                        let split = of_two(#[inline(always)] |$e, $f| ($both_low, $both_high));
                        let pick = of_two(#[inline(always)] |$e, $f| ($even, $odd));
                        let ((pq, pq_high), (rs, rs_high)) = (split(p.0, q.0), split(r.0, s.0));
                        let ((x, y), (z, w)) = (pick(pq, rs), pick(pq_high, rs_high));
                        [Self(x), Self(y), Self(z), Self(w)]
                    }
                }
            )?
        }
    };
}

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub mod pair;

#[cfg(target_arch = "x86_64")]
pub mod x86;

#[cfg(target_arch = "aarch64")]
pub mod neon;

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
pub mod plain;
