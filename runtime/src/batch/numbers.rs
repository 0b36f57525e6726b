//! The numbers that batches know: what they are kept as and what they are worked on as.

use core::fmt;

use super::units::{self, Kernels, Moves, Unit};

/// What a number is kept as: `f32`, `f64`, and with the feature `half` `half::f16`, which is worked on as `f32`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no number that batches know",
    note = "numbers are `f32`, `f64` or, with zonal's feature `half`, `half::f16`"
)]
pub trait Storage: Copy + Default + Send + Sync + fmt::Debug + 'static + sealed::Sealed {
    /// What it is worked on as.
    type Number: Number;
    /// Whether that is itself.
    #[doc(hidden)]
    const IS_NUMBER: bool;
    #[doc(hidden)]
    fn widen(from: &[Self], to: &mut [Self::Number]);
    #[doc(hidden)]
    fn narrow(from: &[Self::Number], to: &mut [Self]);
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! storages {
    ($($number:ident)*) => { $(
        impl sealed::Sealed for $number {}
        impl Storage for $number {
            type Number = Self;
            const IS_NUMBER: bool = true;
            #[inline]
            fn widen(from: &[Self], to: &mut [Self]) {
                to.copy_from_slice(from);
            }
            #[inline]
            fn narrow(from: &[Self], to: &mut [Self]) {
                to.copy_from_slice(from);
            }
        }
    )* };
}

storages!(f32 f64);

#[cfg(feature = "half")]
impl sealed::Sealed for half::f16 {}
#[cfg(feature = "half")]
impl Storage for half::f16 {
    type Number = f32;
    const IS_NUMBER: bool = false;
    #[inline]
    fn widen(from: &[Self], to: &mut [f32]) {
        half::slice::HalfFloatSliceExt::convert_to_f32_slice(from, to);
    }
    #[inline]
    fn narrow(from: &[f32], to: &mut [Self]) {
        half::slice::HalfFloatSliceExt::convert_from_f32_slice(to, from);
    }
}

/// A precision that batches work in: `f32` or `f64`.
pub trait Number: zonal_kernels::real::Real + Storage<Number = Self> + Into<f64> {
    /// Returns the kernels of an order for a unit, if the order is compiled.
    #[doc(hidden)]
    fn kernels(unit: Unit, order: usize) -> Option<Kernels<Self>>;
    /// Returns how rows are read and written, if a unit does it.
    #[doc(hidden)]
    fn moves(unit: Unit) -> Option<Moves<Self>>;
    /// Returns how arrays of so many numbers are read and written, without tiles, if a unit does it.
    #[doc(hidden)]
    fn arrays(unit: Unit, count: usize) -> Option<Moves<Self>>;
    /// Returns what writes so many numbers past the caches; a [`fence`] makes them seen.
    #[doc(hidden)]
    fn stream(unit: Unit) -> unsafe fn(*const Self, *mut Self, usize);
}

impl Number for f32 {
    fn kernels(unit: Unit, order: usize) -> Option<Kernels<Self>> {
        units::singles(unit, order)
    }
    fn moves(unit: Unit) -> Option<Moves<Self>> {
        Some(units::moves(unit))
    }
    fn arrays(unit: Unit, count: usize) -> Option<Moves<Self>> {
        units::arrays(unit, count)
    }
    fn stream(unit: Unit) -> unsafe fn(*const Self, *mut Self, usize) {
        units::stream_single(unit)
    }
}

impl Number for f64 {
    fn kernels(unit: Unit, order: usize) -> Option<Kernels<Self>> {
        units::doubles(unit, order)
    }
    fn moves(_: Unit) -> Option<Moves<Self>> {
        None
    }
    fn arrays(_: Unit, _: usize) -> Option<Moves<Self>> {
        None
    }
    fn stream(unit: Unit) -> unsafe fn(*const Self, *mut Self, usize) {
        units::stream_double(unit)
    }
}
