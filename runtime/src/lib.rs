//! Spherical harmonics for engines: evaluate, rotate and tilt signals of order 2 to 10, with glam's types in and plain
//! arrays in and out. The kernels are generated; this crate gives them one function each, whatever the order, the
//! precision and the channels, all of which the array of [`Coefficients`] says.
//!
//! ```
//! use glam::{Quat, Vec3};
//!
//! // Order 5, the bands 0 to 4: 25 coefficients, here of the lobe at +z.
//! let lobe: [f32; 25] = zonal::evaluate_basis(Vec3::Z);
//! let turned = zonal::rotate(Quat::from_rotation_x(0.5), &lobe);
//!
//! // What was at +z is now at R z, and RGB is the same call.
//! let towards = Quat::from_rotation_x(0.5) * Vec3::Z;
//! assert!((zonal::evaluate(towards, &turned) - zonal::evaluate(Vec3::Z, &lobe)).abs() < 1e-5);
//! let rgb = zonal::rotate(Quat::from_rotation_x(0.5), &lobe.map(|c| Vec3::new(c, 0.5 * c, 0.25 * c)));
//! assert!((rgb[20].x - turned[20]).abs() < 1e-6);
//! ```
//!
//! # Convention
//!
//! Real orthonormal harmonics with the Condon-Shortley phase, so that band 1 is −y, z, −x; index l(l+1)+m; *order n*
//! means the bands 0 to n − 1, which is n² coefficients. Rotating a signal by R moves its features with R: the rotated
//! signal has at R ω the value that the signal has at ω.
//!
//! # What it costs, and how exact it is
//!
//! [`costs`] lists every kernel's operations and its bound on rounding in `f32`; each generated function repeats its
//! own, with the domain and, if it approximates, the error of the method. In `f64` rounding is smaller by 2²⁹. A
//! function below names the kernel that it calls, so that its cost is one look away.
//!
//! # Input that is not unit
//!
//! Nothing is checked, nothing is normalised and nothing panics. Every kernel is a polynomial in its parameters, most
//! rotations after one inverse square root or reciprocal, computed as it stands. Hence:
//!
//! * A direction of length 1 + e, |e| ≤ 0.01, moves band l of [`evaluate_basis`] by l² |e| at most, and what band l adds
//!   to [`evaluate`] by that times the band's norm.
//! * A quaternion of length 1 + e, |e| ≤ 0.1, moves band l of [`rotate`] and [`Rotation`] by 5 l |e| of the band's norm
//!   at most, and of [`rotate`] at the orders 2 and 3 by 15 l |e|. What glam normalised has e of a few 10⁻⁸.
//! * A quaternion and its negative are the same rotation: the results differ by rounding alone.
//! * A quaternion of zeros is no rotation. In `f32` it makes every coefficient from band 1 on NaN in [`Rotation`] and in
//!   the kernels of [`rotate`] that are z, y, z; those that are products and sums alone leave the signal as it is.
//! * A NaN in a quaternion makes every coefficient from band 1 on NaN; band 0 passes through, since no rotation changes
//!   it. A NaN in a direction or a normal makes every coefficient NaN that depends on that component.
//! * Bands never mix: a NaN or an infinity among the coefficients stays in its band.
//!
//! # The kernels themselves
//!
//! The modules [`sh2`] to [`sh10`] hold all kernels of an order, more than the functions below: methods to compare,
//! small-angle rotations, sparse zonal factorisation. They are generic over [`real::Real`] and [`real::Signal`], so that
//! one kernel serves `f32`, `f64`, [`real::Channels`] and [`real::Lanes`]. A signal of `Channels<f32, N>` may be rotated
//! by a quaternion of f64: then no angle is rounded to f32, and a band errs by no more at a high order than at a low one.
//! `shaders` holds their WGSL and GLSL.
//!
//! # Features
//!
//! * `std` (default): square roots, sines and cosines from the standard library.
//! * `libm`: the same from the crate libm, for targets without `std`; turn the default features off.
//! * `shaders` (default): the module `shaders`.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("zonal needs square roots: turn on its feature `std`, or `libm` where there is no standard library");

mod coefficients;
mod rotation;

pub use coefficients::{Coefficients, Element, Scalar, Zonal};
pub use glam;
pub use rotation::Rotation;
pub use zonal_kernels::*;

/// All n² harmonics at a direction of unit length, bands ascending, m from −l to l.
///
/// Accurate at the poles too. The kernel is `basis:n`, [`sh5::basis`] at order 5.
///
/// ```
/// let y = zonal::evaluate_basis::<[f32; 9]>(glam::Vec3::Z);
/// assert!((y[2] - 0.488_602_5).abs() < 1e-7);
/// ```
#[inline]
pub fn evaluate_basis<C: Coefficients<Basis = C>>(dir: C::Vec3) -> C {
    C::basis(C::Scalar::vector(dir))
}

/// The value of a signal in a direction of unit length: Σ c_i y_i(dir), one number a channel.
///
/// The basis is never stored. The kernel is `eval:n`, [`sh5::eval`] at order 5.
#[inline]
pub fn evaluate<C: Coefficients>(dir: C::Vec3, c: &C) -> C::Element {
    C::eval(C::Scalar::vector(dir), c)
}

/// Rotates a signal by a unit quaternion, exactly and at every angle, without trigonometry and without a branch.
///
/// The kernel is `rotate:n`, [`sh5::rotate`] at order 5: for one channel of the orders 2 and 3 products and sums, else
/// z, y, z. For many signals by one rotation, see [`Rotation`].
#[inline]
pub fn rotate<C: Coefficients>(q: C::Quat, c: &C) -> C {
    C::rotate(C::Scalar::quaternion(q), c)
}

/// Rotates a signal by a rotation matrix, exactly.
///
/// The orders 2 and 3 take the matrix as it is, by `rotate:n:matrix`, [`sh3::rotate_matrix`] at order 3. From order 4
/// on it is turned into a quaternion first, with a branch and a square root, and [`rotate`] does the rest: who has a
/// quaternion had better pass that. A matrix that mirrors or scales has no meaning here.
#[inline]
pub fn rotate_matrix<C: Coefficients>(m: C::Mat3, c: &C) -> C {
    C::rotate_matrix(m, c)
}

/// Rotates a signal about z by an angle in radians, counterclockwise as seen from +z.
///
/// One sine and one cosine, then `rotate_z:n`, [`sh5::rotate_z`] at order 5, which takes the two as they are.
#[inline]
pub fn rotate_z<C: Coefficients>(angle: C::Scalar, c: &C) -> C {
    C::rotate_z(C::Scalar::turn(angle), c)
}

/// Rotates a signal about x by +90 degrees, which takes y to z: a sparse constant matrix.
///
/// The kernel is `rotate_x_plus_90:n`, [`sh5::rotate_x_plus_90deg`] at order 5.
#[inline]
pub fn rotate_x_plus_90<C: Coefficients>(c: &C) -> C {
    C::rotate_x_plus_90(c)
}

/// Rotates a signal about x by −90 degrees, which takes z to y: a sparse constant matrix.
///
/// The kernel is `rotate_x_minus_90:n`, [`sh5::rotate_x_minus_90deg`] at order 5.
#[inline]
pub fn rotate_x_minus_90<C: Coefficients>(c: &C) -> C {
    C::rotate_x_minus_90(c)
}

/// Exchanges y and z: the reflection that goes between z-up and y-up, its own inverse.
///
/// The kernel is `swap_yz:n`, [`sh5::swap_yz`] at order 5.
#[inline]
pub fn swap_yz<C: Coefficients>(c: &C) -> C {
    C::swap_yz(c)
}

/// Tilts a signal by the shortest rotation from z to a unit normal, as a normal map asks; from (x, y, z) alone, without
/// trigonometry.
///
/// Bands 1 and 2 are exact for every normal but −z, at which they are NaN or infinite; the bands from 3 on are
/// approximate and meant for small tilts: [`sh5::tilt`], the kernel `tilt:n`, says the error at some angles and the
/// largest angle that it is for. Beyond, or where the error is too much, take [`rotate`] with `Quat::from_rotation_arc(Vec3::Z, normal)`.
#[inline]
pub fn tilt<C: Coefficients>(normal: C::Vec3, c: &C) -> C {
    C::tilt(C::Scalar::vector(normal), c)
}

/// Rotates a signal exactly so that z goes to a unit normal, wherever that points; the spin about the normal is left
/// open. For signals that are symmetric about z or whose spin is of no interest.
///
/// The kernel is `rotate:n:align`, [`sh5::rotate_align`] at order 5, cheaper than [`rotate`].
#[inline]
pub fn align<C: Coefficients>(normal: C::Vec3, c: &C) -> C {
    C::align(C::Scalar::vector(normal), c)
}

type Rotated<Z> = <Z as Zonal>::Coefficients;

/// Rotates a zonal signal, given by the coefficient of m = 0 of each band, so that its axis goes from z to a direction
/// of unit length: n coefficients in, n² out.
///
/// The kernel is `rotate:n:zonal`, [`sh5::rotate_zonal`] at order 5.
///
/// ```
/// // The clamped cosine about a direction, order 3.
/// let cosine = [0.8862269_f32, 1.0233267, 0.4954159];
/// let c = zonal::rotate_zonal(glam::Vec3::X, &cosine);
/// assert_eq!(c.len(), 9);
/// assert!((zonal::evaluate(glam::Vec3::X, &c) - 1.0625).abs() < 1e-6);
/// ```
#[inline]
pub fn rotate_zonal<Z: Zonal>(dir: <Rotated<Z> as Coefficients>::Vec3, g: &Z) -> Rotated<Z> {
    Z::rotate_zonal(<Rotated<Z> as Coefficients>::Scalar::vector(dir), g)
}
