//! Precisions, and what one coefficient may be: a number, an array of them, or a vector of glam or mint, each version of
//! glam by a feature of its own. It knows no order.

use core::borrow::Borrow;
use core::fmt::Debug;

use zonal_kernels::real::{Channels, Real, Signal};

pub(crate) mod sealed {
    /// What this crate alone implements its traits for.
    pub trait Sealed {}
}
use sealed::Sealed;

/// A precision: `f32` or `f64`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no precision that zonal has",
    label = "neither `f32` nor `f64`",
    note = "numbers of other widths are converted before and after; the kernels of `zonal::sh5` and so on also take `Lanes`"
)]
pub trait Scalar: Real + Element<Scalar = Self> + PartialOrd + Into<f64> {
    #[doc(hidden)]
    fn sin_cos(self) -> (Self, Self);
}

/// What one coefficient is: a number, or one number a channel, as `[f32; 3]` and glam's `Vec3` are for RGB.
///
/// `f32`, `f64` and arrays of them always are; glam's vectors with the feature of their version, `glam034` by default;
/// mint's with the feature `mint`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no coefficient that zonal knows",
    label = "neither a number nor one number a channel",
    note = "a coefficient is `f32`, `f64` or an array of them, such as `[f32; 3]` for RGB",
    note = "vectors of glam are coefficients with the feature of zonal that names glam's version, `glam030` to `glam034`, and vectors of mint with the feature `mint`"
)]
pub trait Element: Copy + Debug + PartialEq + Send + Sync + 'static + Sealed {
    /// The precision.
    type Scalar: Scalar;
    /// How many channels it has.
    const CHANNELS: usize;
    #[doc(hidden)]
    type Signal: Signal<Self::Scalar>;

    /// Returns the coefficient that has `value(i)` in channel i, for i from 0 to [`CHANNELS`](Self::CHANNELS) − 1.
    ///
    /// ```
    /// use zonal::{Coefficients, Element};
    ///
    /// // An array a channel, as DirectXMath has them, and back.
    /// let [red, green, blue] = [[0.25_f32; 9], [0.5; 9], [1.0; 9]];
    /// let planes = [red, green, blue];
    /// let rgb = <[[f32; 3]; 9]>::from_fn(|i| Element::from_channels(|channel| planes[channel][i]));
    /// assert_eq!([0, 1, 2].map(|channel| rgb.map(|c| c.channels()[channel])), planes);
    /// ```
    fn from_channels(value: impl FnMut(usize) -> Self::Scalar) -> Self;

    /// Returns its numbers, one a channel.
    fn channels(&self) -> &[Self::Scalar];

    #[doc(hidden)]
    fn signal(self) -> Self::Signal;
    #[doc(hidden)]
    fn element(signal: Self::Signal) -> Self;
    /// What a kernel reads: of numbers these coefficients themselves, since a copy takes a short kernel's time again.
    #[doc(hidden)]
    #[inline]
    fn signals<const N: usize>(c: &[Self; N]) -> impl Borrow<[Self::Signal; N]> {
        c.map(Self::signal)
    }
    /// What a kernel gives, as coefficients.
    #[doc(hidden)]
    #[inline]
    fn elements<const N: usize>(signals: [Self::Signal; N]) -> [Self; N] {
        signals.map(Self::element)
    }
}

/// Functions of numbers from `std`, or from `libm` where there is none.
macro_rules! scalars {
    ($($scalar:ident, $sin_cos:ident;)*) => { $(
        impl Sealed for $scalar {}
        impl Scalar for $scalar {
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                #[cfg(feature = "std")]
                let both = $scalar::sin_cos(self);
                #[cfg(all(not(feature = "std"), feature = "libm"))]
                let both = libm::$sin_cos(self);
                #[cfg(not(any(feature = "std", feature = "libm")))]
                let both = (self, self);
                both
            }
        }
        impl Element for $scalar {
            type Scalar = Self;
            const CHANNELS: usize = 1;
            type Signal = Self;
            #[inline]
            fn from_channels(mut value: impl FnMut(usize) -> Self) -> Self {
                value(0)
            }
            #[inline]
            fn channels(&self) -> &[Self] {
                core::slice::from_ref(self)
            }
            #[inline]
            fn signal(self) -> Self {
                self
            }
            #[inline]
            fn element(signal: Self) -> Self {
                signal
            }
            #[inline]
            fn signals<const N: usize>(c: &[Self; N]) -> impl Borrow<[Self; N]> {
                c
            }
            #[inline]
            fn elements<const N: usize>(signals: [Self; N]) -> [Self; N] {
                signals
            }
        }
    )* };
}

scalars! {
    f32, sincosf;
    f64, sincos;
}

/// Returns the angle of (x, y) from x towards y.
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    #[cfg(feature = "std")]
    let angle = y.atan2(x);
    #[cfg(all(not(feature = "std"), feature = "libm"))]
    let angle = libm::atan2(y, x);
    #[cfg(not(any(feature = "std", feature = "libm")))]
    let angle = y + x;
    angle
}

impl<E: Element, const N: usize> Sealed for [E; N] {}
impl<T: Scalar, const N: usize> Element for [T; N] {
    type Scalar = T;
    const CHANNELS: usize = N;
    type Signal = Channels<T, N>;
    #[inline]
    fn from_channels(value: impl FnMut(usize) -> T) -> Self {
        core::array::from_fn(value)
    }
    #[inline]
    fn channels(&self) -> &[T] {
        self
    }
    #[inline]
    fn signal(self) -> Self::Signal {
        Channels(self)
    }
    #[inline]
    fn element(signal: Self::Signal) -> Self {
        signal.0
    }
}

/// Vectors of other crates, which are arrays with names.
#[allow(unused_macros)]
macro_rules! vectors {
    ($feature:literal: $($vector:ty: $scalar:ident, $channels:literal;)*) => { $(
        #[cfg(feature = $feature)]
        impl Sealed for $vector {}
        #[cfg(feature = $feature)]
        impl Element for $vector {
            type Scalar = $scalar;
            const CHANNELS: usize = $channels;
            type Signal = Channels<$scalar, $channels>;
            #[inline]
            fn from_channels(value: impl FnMut(usize) -> $scalar) -> Self {
                Self::from(core::array::from_fn::<$scalar, $channels, _>(value))
            }
            #[inline]
            fn channels(&self) -> &[$scalar] {
                AsRef::<[$scalar; $channels]>::as_ref(self)
            }
            #[inline]
            fn signal(self) -> Self::Signal {
                Channels(self.into())
            }
            #[inline]
            fn element(signal: Self::Signal) -> Self {
                Self::from(signal.0)
            }
        }
    )* };
}

macro_rules! glams {
    ($($glam:ident, $feature:literal;)*) => { $(
        vectors! {
            $feature:
            $glam::Vec2: f32, 2;
            $glam::Vec3: f32, 3;
            $glam::Vec3A: f32, 3;
            $glam::Vec4: f32, 4;
            $glam::DVec2: f64, 2;
            $glam::DVec3: f64, 3;
            $glam::DVec4: f64, 4;
        }
    )* };
}

glams! {
    glam030, "glam030";
    glam031, "glam031";
    glam032, "glam032";
    glam033, "glam033";
    glam, "glam034";
}

vectors! {
    "mint":
    mint::Vector2<f32>: f32, 2;
    mint::Vector3<f32>: f32, 3;
    mint::Vector4<f32>: f32, 4;
    mint::Vector2<f64>: f64, 2;
    mint::Vector3<f64>: f64, 3;
    mint::Vector4<f64>: f64, 4;
}
