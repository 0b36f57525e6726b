//! Light at a point of a surface: the frame in which a lightmap stores it, and the bases over the hemisphere of that frame
//! (docs/MATH.md#the-h-basis, docs/MATH.md#half-life-2).

use crate::coefficients::Coefficients;
#[cfg(any(feature = "order2", feature = "order3", feature = "order5"))]
use crate::scalar::Element;
use crate::scalar::Scalar;

/// The frame of a point of a surface: three unit vectors across each other, in the world. Its x is the tangent, along which a
/// normal map's first texture coordinate grows, its y the bitangent, its z the normal. Of a normal map that is mirrored it is
/// left-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<T> {
    /// The tangent.
    pub tangent: [T; 3],
    /// The bitangent.
    pub bitangent: [T; 3],
    /// The normal.
    pub normal: [T; 3],
}

fn dot<T: Scalar>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit<T: Scalar>(a: [T; 3]) -> [T; 3] {
    let scale = dot(a, a).rsqrt();
    a.map(|x| x * scale)
}

impl<T: Scalar> Frame<T> {
    /// Returns the frame of a normal and a tangent as vertices have them, interpolated or not: both are brought to length one,
    /// the tangent across the normal, and the bitangent is w · n × t, where the tangent's w is 1 or −1, as in glTF.
    ///
    /// A normal of length 0, or a tangent along it, has no frame: every number is NaN or infinite.
    ///
    /// ```
    /// let frame = zonal::Frame::<f32>::new([0.0, 0.0, 2.0], [1.0, 0.0, 0.5, -1.0]);
    /// assert_eq!((frame.tangent, frame.bitangent, frame.normal), ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]));
    /// ```
    pub fn new(normal: impl Into<[T; 3]>, tangent: impl Into<[T; 4]>) -> Self {
        let (n, [x, y, z, w]) = (unit(normal.into()), tangent.into());
        let along = dot([x, y, z], n);
        let t = unit([x - along * n[0], y - along * n[1], z - along * n[2]]);
        let across = [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]];
        Self { tangent: t, bitangent: across.map(|x| x * w), normal: n }
    }

    /// Returns a vector of the world in the frame.
    #[inline]
    pub fn to_local(&self, world: impl Into<[T; 3]>) -> [T; 3] {
        let world = world.into();
        [dot(world, self.tangent), dot(world, self.bitangent), dot(world, self.normal)]
    }

    /// Returns a vector of the frame in the world.
    #[inline]
    pub fn to_world(&self, local: impl Into<[T; 3]>) -> [T; 3] {
        let [x, y, z] = local.into();
        core::array::from_fn(|i| x * self.tangent[i] + y * self.bitangent[i] + z * self.normal[i])
    }
}

/// Radiance of an order of which the H-basis is made: order 3, or 5 for the band of the cosine that order 3 lacks.
#[diagnostic::on_unimplemented(
    message = "the H-basis is not made of `{Self}`",
    label = "neither order 3 nor order 5",
    note = "it is made of radiance of order 3, `[E; 9]`, or of order 5, `[E; 25]`, whose features `order3` and `order5` are on by default"
)]
pub trait Lightmap: Coefficients {
    #[doc(hidden)]
    fn h4(&self) -> [Self::Element; 4];
    #[doc(hidden)]
    fn h6(&self) -> [Self::Element; 6];
}

macro_rules! lightmaps {
    ($($feature:literal $module:ident: $count:literal, $h4:ident, $h6:ident;)*) => { $(
        #[cfg(feature = $feature)]
        impl<E: Element> Lightmap for [E; $count] {
            #[inline]
            fn h4(&self) -> [E; 4] {
                zonal_kernels::$module::$h4(&self.map(E::signal)).map(E::element)
            }
            #[inline]
            fn h6(&self) -> [E; 6] {
                zonal_kernels::$module::$h6(&self.map(E::signal)).map(E::element)
            }
        }
    )* };
}

lightmaps! {
    "order3" sh3: 9, sh3_to_h4_coefficients, sh3_to_h6_coefficients;
    "order5" sh5: 25, sh5_to_h4_coefficients, sh5_to_h6_coefficients;
}

/// Returns the irradiance over the upper hemisphere of normals, in the four functions of the H-basis (Habel and Wimmer 2010),
/// of radiance in the frame of a surface.
///
/// ```
/// // Radiance 1 all around is irradiance π whatever the normal.
/// let mut radiance = [0.0_f32; 9];
/// radiance[0] = 2.0 * core::f32::consts::PI.sqrt();
/// let c = zonal::h4(&radiance);
/// assert!((zonal::h4_at([0.36, 0.48, 0.8], &c) - core::f32::consts::PI).abs() < 1e-5);
/// ```
#[inline]
pub fn h4<C: Lightmap>(radiance: &C) -> [C::Element; 4] {
    radiance.h4()
}

/// Returns the irradiance over the upper hemisphere of normals, in the six functions of the H-basis (Habel and Wimmer 2010),
/// of radiance in the frame of a surface.
///
/// ```
/// let mut radiance = [[0.0_f32; 3]; 25];
/// radiance[0] = [1.0, 2.0, 4.0];
/// let c = zonal::h6(&radiance);
/// let [r, g, b] = zonal::h6_at([0.36, 0.48, 0.8], &c);
/// assert!((g / r - 2.0).abs() < 1e-5 && (b / r - 4.0).abs() < 1e-5);
/// ```
#[inline]
pub fn h6<C: Lightmap>(radiance: &C) -> [C::Element; 6] {
    radiance.h6()
}

/// Returns the irradiance over the upper hemisphere of normals, in the Half-Life 2 basis (McTaggart 2004), of radiance of
/// order 3 in the frame of a surface. It holds no constant: what it is best for leans towards the normal.
#[cfg(feature = "order3")]
#[inline]
pub fn hl2<E: Element>(radiance: &[E; 9]) -> [E; 3] {
    zonal_kernels::sh3::sh3_to_hl2_coefficients(&radiance.map(E::signal)).map(E::element)
}

/// Returns the irradiance at a normal of the frame, in the four functions of the H-basis. The normal may be the mean of many,
/// shorter than one: it gives the mean of their irradiance, and is not to be normalised.
#[cfg(feature = "order2")]
#[inline]
pub fn h4_at<E: Element>(normal: impl Into<[E::Scalar; 3]>, c: &[E; 4]) -> E {
    let c = c.map(E::signal);
    E::element(match E::CHANNELS {
        1 => zonal_kernels::sh2::h4_eval(normal.into(), &c),
        _ => zonal_kernels::sh2::h4_eval_shared(normal.into(), &c),
    })
}

/// Returns the irradiance at a normal of the frame, in the six functions of the H-basis. The normal may be the mean of many,
/// shorter than one: it gives nearly the mean of their irradiance, and is not to be normalised.
#[cfg(feature = "order3")]
#[inline]
pub fn h6_at<E: Element>(normal: impl Into<[E::Scalar; 3]>, c: &[E; 6]) -> E {
    let c = c.map(E::signal);
    E::element(match E::CHANNELS {
        1 => zonal_kernels::sh3::h6_eval(normal.into(), &c),
        _ => zonal_kernels::sh3::h6_eval_shared(normal.into(), &c),
    })
}

/// Returns the irradiance at a normal of the frame, in the Half-Life 2 basis, without a clamp of any cosine.
#[cfg(feature = "order2")]
#[inline]
pub fn hl2_at<E: Element>(normal: impl Into<[E::Scalar; 3]>, c: &[E; 3]) -> E {
    E::element(zonal_kernels::sh2::hl2_eval(normal.into(), &c.map(E::signal)))
}
