//! The vector units: which there are, which the processor has, and each kernel compiled for each of them, once in this crate
//! however many programs use it.

use core::fmt;
use core::sync::atomic::{AtomicU8, Ordering};

use super::arrays;
use super::kernels::{self, Kernel};
use super::pass::{Pass, align_stack};
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use super::registers::pair::Pair;
use super::registers::{Quads, Register};
use super::rows::{Rows, Tiles};

/// A vector unit, by what it needs of the processor; later ones are wider.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Unit {
    /// What every processor of its kind has: SSE2 on x86-64, NEON on aarch64, elsewhere what the compiler makes of arrays.
    Base,
    /// AVX2 with FMA, on x86-64.
    Avx2,
    /// AVX-512 (F, DQ and VL), on x86-64.
    Avx512,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Base if cfg!(target_arch = "x86_64") => "SSE2",
            Self::Base if cfg!(target_arch = "aarch64") => "NEON",
            Self::Base => "none",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        })
    }
}

/// The widest unit that may be used.
static WIDEST: AtomicU8 = AtomicU8::new(Unit::Avx512 as u8);

impl Unit {
    /// All of them, from the narrowest to the widest.
    pub const ALL: [Self; 3] = [Self::Base, Self::Avx2, Self::Avx512];

    /// Returns whether the processor has it.
    pub fn is_there(self) -> bool {
        match self {
            Self::Base => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_there()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Returns the one that batches use: the widest that the processor has, and no wider than [`at_most`](Self::at_most) said.
    pub fn used() -> Self {
        let most = WIDEST.load(Ordering::Relaxed);
        let may = |unit: &&Self| **unit as u8 <= most && unit.is_there();
        Self::ALL.iter().rev().find(may).copied().unwrap_or(Self::Base)
    }

    /// Lets batches of the whole program use no wider unit from now on: for processors that clock down for one, and to compare.
    /// Results of a unit that fuses a product and a sum differ in the last digits from those of one that does not.
    pub fn at_most(self) {
        WIDEST.store(self as u8, Ordering::Relaxed);
    }
}

/// A kernel as it is called: over a pass whose lines are there, on a processor that has the unit.
pub type Run<T> = unsafe fn(&Pass<'_, T>);

/// The kernels of an order and a unit.
pub struct Kernels<T> {
    /// Rotates each by a quaternion of its own.
    pub rotate: Run<T>,
    /// Rotates all by one quaternion.
    pub rotate_all: Run<T>,
    /// Tilts each to a normal of its own.
    pub tilt: Run<T>,
    /// The basis at each direction.
    pub basis: Run<T>,
    /// The value of each in a direction of its own.
    pub eval: Run<T>,
    /// The value of one in each direction.
    pub eval_all: Run<T>,
    /// The product of each two, up to order 6.
    pub product: Option<Run<T>>,
}

/// How rows are read to lines and written from them, tiles of four columns at a time.
#[derive(Clone, Copy)]
pub struct Moves<T> {
    /// Reads rows.
    pub gather: unsafe fn(tiles: &Tiles, rows: Rows<T>, lines: *mut T, step: usize),
    /// Writes rows.
    pub scatter: unsafe fn(tiles: &Tiles, lines: *const T, step: usize, rows: Rows<T>),
    /// Whether sixteen columns are a square of registers, and not four times four columns.
    pub is_wide: bool,
}

/// A unit: every kernel and every move compiled for it.
macro_rules! unit {
    ($unit:ident, $single:ty, $double:ty, $singles:ty, $doubles:ty $(, #[$features:meta])?) => {
        mod $unit {
            use crate::batch::units::*;

            /// # Safety
            ///
            /// As [`Kernel::run`]; the processor has the unit.
            $(#[$features])?
            unsafe fn run<K: Kernel, R: Register>(pass: &Pass<'_, R::Number>) {
                align_stack();
                // Its own copy, which nothing that a kernel writes can change.
                let pass = *pass;
                // SAFETY: the caller's, and this function is compiled for the unit.
                unsafe { K::run::<R>(&pass) }
            }

            /// # Safety
            ///
            /// As [`Tiles::gather`]; the processor has the unit.
            $(#[$features])?
            unsafe fn gather<R: Quads>(tiles: &Tiles, rows: Rows<R::Number>, lines: *mut R::Number, step: usize) {
                // SAFETY: the caller's, and this function is compiled for the unit.
                unsafe { tiles.gather::<R>(rows, lines, step) }
            }

            /// # Safety
            ///
            /// As [`Tiles::scatter`]; the processor has the unit.
            $(#[$features])?
            unsafe fn scatter<R: Quads>(tiles: &Tiles, lines: *const R::Number, step: usize, rows: Rows<R::Number>) {
                // SAFETY: the caller's, and this function is compiled for the unit.
                unsafe { tiles.scatter::<R>(lines, step, rows) }
            }

            /// # Safety
            ///
            /// As [`Tiles::gather`]; the processor has the unit.
            $(#[$features])?
            unsafe fn gather_arrays<R: Quads, const N: usize>(_: &Tiles, rows: Rows<R::Number>, lines: *mut R::Number, step: usize) {
                // SAFETY: the caller's, and this function is compiled for the unit.
                unsafe { arrays::gather::<R, N>(rows, lines, step) }
            }

            /// # Safety
            ///
            /// As [`Tiles::scatter`]; the processor has the unit.
            $(#[$features])?
            unsafe fn scatter_arrays<R: Quads, const N: usize>(_: &Tiles, lines: *const R::Number, step: usize, rows: Rows<R::Number>) {
                // SAFETY: the caller's, and this function is compiled for the unit.
                unsafe { arrays::scatter::<R, N>(lines, step, rows) }
            }

            /// # Safety
            ///
            /// There are so many numbers, and room for them; the processor has the unit.
            $(#[$features])?
            unsafe fn stream<R: Register>(from: *const R::Number, to: *mut R::Number, count: usize) {
                // What lies in a line of the cache that is not all of it is stored: another block has the rest.
                let before = to.align_offset(64).min(count);
                let lines = (count - before) / R::LANES * R::LANES;
                // SAFETY: the caller's.
                unsafe {
                    kernels::look_up::<R>(to.wrapping_add(2 * count), count);
                    from.copy_to_nonoverlapping(to, before);
                    for i in (before..before + lines).step_by(R::LANES) {
                        R::load(from.add(i)).stream(to.add(i));
                    }
                    let done = before + lines;
                    from.add(done).copy_to_nonoverlapping(to.add(done), count - done);
                }
            }

            pub const MOVES: Moves<f32> = Moves {
                gather: gather::<$single>,
                scatter: scatter::<$single>,
                is_wide: <$single as Quads>::IS_WIDE,
            };

            /// The same of arrays of so many numbers, if they are an order's that is compiled.
            pub fn arrays(count: usize) -> Option<Moves<f32>> {
                unit!(@ arrays $single, count, "order2" 4, "order3" 9, "order4" 16, "order5" 25, "order6" 36, "order7" 49, "order8" 64,
                    "order9" 81, "order10" 100)
            }
            pub const STREAM_SINGLE: unsafe fn(*const f32, *mut f32, usize) = stream::<$single>;
            pub const STREAM_DOUBLE: unsafe fn(*const f64, *mut f64, usize) = stream::<$double>;

            unit!(@ kernels single f32 $single, $singles);
            unit!(@ kernels double f64 $double, $doubles);
        }
    };
    (@ kernels $name:ident $number:ident $register:ty, $several:ty) => {
        /// The kernels of an order.
        pub fn $name(order: usize) -> Option<Kernels<$number>> {
            unit!(@ orders $register, $several, order,
                "order2" 2 sh2 product, "order3" 3 sh3 product, "order4" 4 sh4 product,
                "order5" 5 sh5 product, "order6" 6 sh6 product, "order7" 7 sh7 none,
                "order8" 8 sh8 none, "order9" 9 sh9 none, "order10" 10 sh10 none)
        }
    };
    (@ orders $register:ty, $several:ty, $order:ident, $($feature:literal $number:literal $module:ident $product:ident),*) => {
        match $order {
            $(
                #[cfg(feature = $feature)]
                $number => Some(Kernels {
                    rotate: run::<kernels::$module::Rotate, $register>,
                    rotate_all: run::<kernels::$module::RotateAll, $register>,
                    tilt: run::<kernels::$module::Tilt, $register>,
                    basis: run::<kernels::$module::Basis, $several>,
                    eval: run::<kernels::$module::Eval, $several>,
                    eval_all: run::<kernels::$module::EvalAll, $several>,
                    product: unit!(@ $product $module $register),
                }),
            )*
            _ => None,
        }
    };
    (@ arrays $register:ty, $count:ident, $($feature:literal $number:literal),*) => {
        match $count {
            $(
                #[cfg(feature = $feature)]
                $number => Some(Moves {
                    gather: gather_arrays::<$register, $number>,
                    scatter: scatter_arrays::<$register, $number>,
                    ..MOVES
                }),
            )*
            _ => None,
        }
    };
    (@ product $module:ident $register:ty) => { Some(run::<kernels::$module::Product, $register>) };
    (@ none $module:ident $register:ty) => { None };
}

#[cfg(target_arch = "x86_64")]
use super::registers::x86::*;
#[cfg(target_arch = "x86_64")]
unit!(avx512, F32x16, F64x8, F32x16, Pair<F64x8>, #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]);
#[cfg(target_arch = "x86_64")]
unit!(avx2, F32x8, F64x4, Pair<F32x8>, Pair<F64x4>, #[target_feature(enable = "avx2,fma")]);

#[cfg(target_arch = "aarch64")]
use super::registers::neon::*;
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
use super::registers::plain::*;

// NEON has as many registers as AVX-512.
#[cfg(target_arch = "aarch64")]
unit!(base, F32x4, F64x2, Pair<F32x4>, Pair<F64x2>);
#[cfg(not(target_arch = "aarch64"))]
unit!(base, F32x4, F64x2, F32x4, F64x2);

/// Takes what a unit has.
macro_rules! of {
    ($unit:expr, $what:ident $(($order:expr))?) => {
        match $unit {
            #[cfg(target_arch = "x86_64")]
            Unit::Avx512 => avx512::$what $(($order))?,
            #[cfg(target_arch = "x86_64")]
            Unit::Avx2 => avx2::$what $(($order))?,
            _ => base::$what $(($order))?,
        }
    };
}

/// Makes what was written past the caches visible to other threads before what is written after.
pub fn fence() {
    F32x4::fence();
}

/// The kernels of an order for f32, if the order is compiled.
pub fn singles(unit: Unit, order: usize) -> Option<Kernels<f32>> {
    of!(unit, single(order))
}

/// The kernels of an order for f64, if the order is compiled.
pub fn doubles(unit: Unit, order: usize) -> Option<Kernels<f64>> {
    of!(unit, double(order))
}

/// How rows of f32 are read and written.
pub fn moves(unit: Unit) -> Moves<f32> {
    of!(unit, MOVES)
}

/// How arrays of so many f32 are read and written, without tiles, if an order that is compiled has so many.
pub fn arrays(unit: Unit, count: usize) -> Option<Moves<f32>> {
    of!(unit, arrays(count))
}

/// What writes so many f32 past the caches; a [`fence`] makes them seen.
pub fn stream_single(unit: Unit) -> unsafe fn(*const f32, *mut f32, usize) {
    of!(unit, STREAM_SINGLE)
}

/// What writes so many f64 past the caches; a [`fence`] makes them seen.
pub fn stream_double(unit: Unit) -> unsafe fn(*const f64, *mut f64, usize) {
    of!(unit, STREAM_DOUBLE)
}
