//! What the functions of this crate are generic over: arrays of coefficients, whose length says the order and whose
//! element says the precision and the number of channels. One macro ties each length to its generated module; it holds
//! no mathematics.

use core::fmt::Debug;

use zonal_kernels::real::{Channels, Real, Signal};
use zonal_kernels::{sh2, sh3, sh4, sh5, sh6, sh7, sh8, sh9, sh10};

mod sealed {
    pub trait Sealed {}
}
use sealed::Sealed;

/// A precision: `f32` with glam's `Vec3`, `Quat` and `Mat3`, or `f64` with their `D` twins.
pub trait Scalar: Real + Element<Scalar = Self> + Debug + PartialEq {
    /// glam's vector of three.
    type Vec3: Copy;
    /// glam's quaternion.
    type Quat: Copy;
    /// glam's 3×3 matrix.
    type Mat3: Copy;
    #[doc(hidden)]
    fn vector(v: Self::Vec3) -> [Self; 3];
    #[doc(hidden)]
    fn quaternion(q: Self::Quat) -> [Self; 4];
    #[doc(hidden)]
    fn columns(m: Self::Mat3) -> [[Self; 3]; 3];
    #[doc(hidden)]
    fn of_matrix(m: Self::Mat3) -> Self::Quat;
    #[doc(hidden)]
    fn turn(angle: Self) -> [Self; 2];
}

/// What one coefficient is: a number, or one number a channel, as `[f32; 3]` and glam's `Vec3` are for RGB.
pub trait Element: Copy + Sealed {
    /// The precision.
    type Scalar: Scalar;
    /// How many channels it has.
    const CHANNELS: usize;
    #[doc(hidden)]
    type Signal: Signal<Self::Scalar>;
    #[doc(hidden)]
    fn signal(self) -> Self::Signal;
    #[doc(hidden)]
    fn element(signal: Self::Signal) -> Self;
}

macro_rules! scalars {
    ($($scalar:ident: $vec2:ident, $vec3:ident, $quat:ident, $mat3:ident;)*) => { $(
        impl Sealed for $scalar {}
        impl Scalar for $scalar {
            type Vec3 = glam::$vec3;
            type Quat = glam::$quat;
            type Mat3 = glam::$mat3;
            #[inline]
            fn vector(v: glam::$vec3) -> [Self; 3] {
                v.to_array()
            }
            #[inline]
            fn quaternion(q: glam::$quat) -> [Self; 4] {
                q.to_array()
            }
            #[inline]
            fn columns(m: glam::$mat3) -> [[Self; 3]; 3] {
                m.to_cols_array_2d()
            }
            #[inline]
            fn of_matrix(m: glam::$mat3) -> glam::$quat {
                glam::$quat::from_mat3(&m)
            }
            #[inline]
            fn turn(angle: Self) -> [Self; 2] {
                glam::$vec2::from_angle(angle).to_array()
            }
        }
        impl Element for $scalar {
            type Scalar = Self;
            const CHANNELS: usize = 1;
            type Signal = Self;
            #[inline]
            fn signal(self) -> Self {
                self
            }
            #[inline]
            fn element(signal: Self) -> Self {
                signal
            }
        }
        impl Sealed for glam::$vec3 {}
        impl Element for glam::$vec3 {
            type Scalar = $scalar;
            const CHANNELS: usize = 3;
            type Signal = Channels<$scalar, 3>;
            #[inline]
            fn signal(self) -> Self::Signal {
                Channels(self.to_array())
            }
            #[inline]
            fn element(signal: Self::Signal) -> Self {
                Self::from_array(signal.0)
            }
        }
    )* };
}

scalars! {
    f32: Vec2, Vec3, Quat, Mat3;
    f64: DVec2, DVec3, DQuat, DMat3;
}

impl<E: Element, const N: usize> Sealed for [E; N] {}
impl<T: Scalar, const N: usize> Element for [T; N] {
    type Scalar = T;
    const CHANNELS: usize = N;
    type Signal = Channels<T, N>;
    #[inline]
    fn signal(self) -> Self::Signal {
        Channels(self)
    }
    #[inline]
    fn element(signal: Self::Signal) -> Self {
        signal.0
    }
}

/// The coefficients of a signal: `[E; 4]`, `[E; 9]`, … `[E; 100]` for the orders 2 to 10, index l(l+1)+m.
///
/// An order n has the bands 0 to n − 1, which is n² coefficients. The array's length says the order, its [`Element`]
/// the precision and the channels: `[f32; 25]` is a signal of order 5, `[Vec3; 25]` or `[[f32; 3]; 25]` an RGB one,
/// `[f64; 25]` one in double precision.
pub trait Coefficients: Sized + Sealed {
    /// The order n.
    const ORDER: usize;
    /// One coefficient.
    type Element: Element<Scalar = Self::Scalar>;
    /// The precision.
    type Scalar: Scalar<Vec3 = Self::Vec3, Quat = Self::Quat, Mat3 = Self::Mat3>;
    /// glam's vector of three in this precision.
    type Vec3: Copy;
    /// glam's quaternion in this precision.
    type Quat: Copy;
    /// glam's 3×3 matrix in this precision.
    type Mat3: Copy;
    /// One number a harmonic: `[f32; 25]` at order 5, whatever the channels.
    type Basis;
    /// The (cosine, sine) pairs that a [`Rotation`](crate::Rotation) holds.
    type Angles: Copy + Debug + PartialEq;

    #[doc(hidden)]
    fn basis(dir: [Self::Scalar; 3]) -> Self::Basis;
    #[doc(hidden)]
    fn eval(dir: [Self::Scalar; 3], c: &Self) -> Self::Element;
    #[doc(hidden)]
    fn rotate(q: [Self::Scalar; 4], c: &Self) -> Self;
    #[doc(hidden)]
    fn rotate_matrix(m: Self::Mat3, c: &Self) -> Self;
    #[doc(hidden)]
    fn rotate_z(cs: [Self::Scalar; 2], c: &Self) -> Self;
    #[doc(hidden)]
    fn rotate_x_plus_90(c: &Self) -> Self;
    #[doc(hidden)]
    fn rotate_x_minus_90(c: &Self) -> Self;
    #[doc(hidden)]
    fn swap_yz(c: &Self) -> Self;
    #[doc(hidden)]
    fn tilt(n: [Self::Scalar; 3], c: &Self) -> Self;
    #[doc(hidden)]
    fn align(n: [Self::Scalar; 3], c: &Self) -> Self;
    #[doc(hidden)]
    fn angles(q: [Self::Scalar; 4]) -> Self::Angles;
    #[doc(hidden)]
    fn rotate_angles(angles: &Self::Angles, c: &Self) -> Self;
}

/// A zonal signal, which is symmetric about z: `[E; 2]` to `[E; 10]`, one coefficient a band, that of m = 0.
pub trait Zonal: Sealed {
    /// The coefficients of the same order without the symmetry.
    type Coefficients: Coefficients;
    #[doc(hidden)]
    fn rotate_zonal(dir: [<Self::Coefficients as Coefficients>::Scalar; 3], g: &Self) -> Self::Coefficients;
}

macro_rules! orders {
    ($($module:ident: $order:literal, $count:literal, $pairs:literal, $one:ident, $many:ident, $matrix:tt;)*) => { $(
        impl<E: Element> Coefficients for [E; $count] {
            const ORDER: usize = $order;
            type Element = E;
            type Scalar = E::Scalar;
            type Vec3 = <E::Scalar as Scalar>::Vec3;
            type Quat = <E::Scalar as Scalar>::Quat;
            type Mat3 = <E::Scalar as Scalar>::Mat3;
            type Basis = [E::Scalar; $count];
            type Angles = [[E::Scalar; 2]; $pairs];

            #[inline]
            fn basis(dir: [E::Scalar; 3]) -> Self::Basis {
                $module::basis(dir)
            }
            #[inline]
            fn eval(dir: [E::Scalar; 3], c: &Self) -> E {
                E::element($module::eval(dir, &c.map(E::signal)))
            }
            #[inline]
            fn rotate(q: [E::Scalar; 4], c: &Self) -> Self {
                let c = c.map(E::signal);
                match E::CHANNELS {
                    1 => $module::$one(q, &c),
                    _ => $module::$many(q, &c),
                }
                .map(E::element)
            }
            #[inline]
            fn rotate_matrix(m: Self::Mat3, c: &Self) -> Self {
                orders!(@ $matrix $module m c E)
            }
            #[inline]
            fn rotate_z(cs: [E::Scalar; 2], c: &Self) -> Self {
                $module::rotate_z(cs, &c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn rotate_x_plus_90(c: &Self) -> Self {
                $module::rotate_x_plus_90deg(&c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn rotate_x_minus_90(c: &Self) -> Self {
                $module::rotate_x_minus_90deg(&c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn swap_yz(c: &Self) -> Self {
                $module::swap_yz(&c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn tilt(n: [E::Scalar; 3], c: &Self) -> Self {
                $module::tilt(n, &c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn align(n: [E::Scalar; 3], c: &Self) -> Self {
                $module::rotate_align(n, &c.map(E::signal)).map(E::element)
            }
            #[inline]
            fn angles(q: [E::Scalar; 4]) -> Self::Angles {
                $module::angles(q)
            }
            #[inline]
            fn rotate_angles(angles: &Self::Angles, c: &Self) -> Self {
                $module::rotate_angles(angles, &c.map(E::signal)).map(E::element)
            }
        }
        impl<E: Element> Zonal for [E; $order] {
            type Coefficients = [E; $count];
            #[inline]
            fn rotate_zonal(dir: [E::Scalar; 3], g: &Self) -> [E; $count] {
                $module::rotate_zonal(dir, &g.map(E::signal)).map(E::element)
            }
        }
    )* };
    (@ direct $module:ident $m:ident $c:ident $element:ident) => {
        $module::rotate_matrix(&$element::Scalar::columns($m), &$c.map($element::signal)).map($element::element)
    };
    (@ quaternion $module:ident $m:ident $c:ident $element:ident) => {
        Self::rotate($element::Scalar::quaternion($element::Scalar::of_matrix($m)), $c)
    };
}

// The module, the order, its coefficients, the pairs of `angles`, `rotate` of one channel and of several, and whether
// a matrix serves as it is.
orders! {
    sh2: 2, 4, 4, rotate, rotate, direct;
    sh3: 3, 9, 7, rotate, rotate_zyz, direct;
    sh4: 4, 16, 10, rotate, rotate, quaternion;
    sh5: 5, 25, 13, rotate, rotate, quaternion;
    sh6: 6, 36, 16, rotate, rotate, quaternion;
    sh7: 7, 49, 19, rotate, rotate, quaternion;
    sh8: 8, 64, 22, rotate, rotate, quaternion;
    sh9: 9, 81, 25, rotate, rotate, quaternion;
    sh10: 10, 100, 28, rotate, rotate, quaternion;
}
