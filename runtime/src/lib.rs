//! Spherical harmonics for engines: evaluate, rotate, tilt, project and convert signals of order 2 to 10, plain arrays in and
//! out. The kernels are generated; this crate gives them one function each, whatever the order, the precision and the
//! channels, all of which the array of [`Coefficients`] says.
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
//! # Directions, quaternions, vectors
//!
//! Every function takes what converts into `[f32; 3]` or `[f32; 4]`, or into these of f64: arrays, and the vectors and
//! quaternions of every version of glam, of mint, cgmath and others. Quaternions are (x, y, z, w). A matrix is three
//! columns, `m.to_cols_array_2d()` of glam's. For vectors *as coefficients*, `[Vec3; 9]`, turn on the feature of your
//! glam: `glam034` is on by default.
//!
//! # Convention
//!
//! Real orthonormal harmonics with the Condon-Shortley phase, so that band 1 is −y, z, −x; index l(l+1)+m; *order n*
//! means the bands 0 to n − 1, which is n² coefficients. Rotating a signal by R moves its features with R: the rotated
//! signal has at R ω the value that the signal has at ω. For the signs, factors and axes of three.js, Unity, Unreal, glTF and
//! others there are [`to_convention`] and [`from_convention`] with the table [`conventions`], for a frame of your own
//! [`to_axes`] and [`from_axes`].
//!
//! # Which rotation?
//!
//! | what is given | function | exact | costs |
//! |---|---|---|---|
//! | a quaternion | [`rotate`], for one signal at a time [`rotate_into`] | yes | most |
//! | one quaternion for many signals | [`Rotation`] | yes | from the second signal on less than [`rotate`] |
//! | a matrix | [`rotate_matrix`] | yes | no more at the orders 2 and 3, a root more above |
//! | an angle about z or y | [`rotate_z`], [`rotate_y`] | yes | less |
//! | 90 degrees about x | [`rotate_x_plus_90`], [`rotate_x_minus_90`] | yes | less |
//! | a normal that z goes to by the shortest way, and leans little | [`tilt`] | to band 2 | less; no trigonometry |
//! | a normal that z goes to by the shortest way, anywhere | [`rotate`] by that arc's quaternion | yes | most |
//! | a normal that z goes to, however it spins | [`align`] | yes | less |
//! | a lobe that is symmetric about z | [`rotate_zonal`] | yes | least |
//! | other axes, or a mirror image | [`to_axes`], [`swap_yz`] | yes | least |
//!
//! # Light
//!
//! [`project`] makes coefficients of samples, functions, images and cubemaps. [`irradiance`] makes what a surface gets of the
//! radiance around it, [`convolve`] the same for another lobe; [`hann`] and [`lanczos`] window, [`least`] and
//! [`negative_share`] say how much rings. [`add`], [`scale`], [`lerp`], [`dot`], [`weigh`], [`resize`] and [`scale_bands`] are
//! for any signal; [`Coefficients`] shows how to be generic over the order.
//!
//! For lightmaps, [`project::in_frame`] and [`project::in_frames`] project samples in the [`Frame`] of a surface, as harmonics
//! of radiance, of which [`h4`], [`h6`], `hl2` and [`irradiance`] are made, and [`project::on_hemisphere`] on hemispherical
//! harmonics. `h4_at`, `h6_at` and `hl2_at` are what a shader does.
//!
//! # Many signals at once
//!
//! `batch`, with the feature of its name, rotates, tilts, evaluates and multiplies thousands of signals at the speed of memory, in the
//! layouts that programs have them in: SSE2, AVX2, AVX-512 and NEON, found when it runs. A plain loop over arrays is
//! slower by far, and slower still from memory if all is compiled for the processor at hand (`-C target-cpu=native`), since
//! the compiler then gathers numbers one by one; `docs/measure/timing.md` and `docs/BATCHES.md` have the figures.
//!
//! # What it costs, and how exact it is
//!
//! [`costs`] lists every kernel's operations and its bound on rounding in `f32`; each generated function repeats its
//! own, with the domain and, if it approximates, the error of the method. In `f64` rounding is smaller by 2²⁹. A
//! function below names the kernel that it calls, so that its cost is one look away.
//!
//! # What it is compiled for
//!
//! `f32` and `f64` are fused where the target has the instruction ([`real::FUSED`]): with `-C target-cpu=native`, or
//! `-C target-feature=+fma`, a single call takes a quarter to a third less, and errs by no more than is proven. On aarch64 it
//! is so without a flag.
//!
//! The same flag makes *plain loops* over arrays of signals slower, up to two and a half times in a cache and several times
//! outside of one: the compiler works on as many signals at once as its vectors are wide, and gathers and scatters their
//! numbers one by one. `docs/measure/peers.md` of the repository has the figures, by function and order. Whoever turns many
//! signals at once and compiles for this processor keeps single calls apart, in a function that is `#[inline(never)]`.
//!
//! On x86-64 without the flag, the compiler packs the numbers of one signal into vectors where it had better not, and a
//! result that is returned by value to a function that stores it is copied once more. [`rotate_into`], [`tilt_into`] and
//! [`evaluate_basis_into`] write each number where it belongs before the next is computed, which keeps the compiler from both:
//! [`rotate_into`] takes a quarter less than [`rotate`] at the orders 3 to 5. They keep it too from doing several signals of
//! a loop at once: they are for one signal at a time.
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
//! The modules `sh2` to `sh10` hold all kernels of an order, more than the functions below: methods to compare,
//! small-angle rotations, sparse zonal factorisation. They are generic over [`real::Real`] and [`real::Signal`], so that
//! one kernel serves `f32`, `f64`, [`real::Channels`] and [`real::Lanes`]. A signal of `Channels<f32, N>` may be rotated
//! by a quaternion of f64: then no angle is rounded to f32, and a band errs by no more at a high order than at a low one.
//! They are always inlined, however long, so that one that works on `Lanes` is compiled for the vectors of the function
//! that it stands in (`#[target_feature]`): a rotation of order 6 of 16 lanes takes a quarter of the time there. Who calls
//! one in many places had better put it into a function.
//!
//! ```
//! use zonal::real::Lanes;
//!
//! // Sixteen signals of order 3, each in a lane, and a rotation for each: about z by angles of 0, 0.1, 0.2 and so on.
//! let half = std::array::from_fn(|lane| 0.05 * lane as f32);
//! let q = [Lanes([0.0; 16]), Lanes([0.0; 16]), Lanes(half.map(f32::sin)), Lanes(half.map(f32::cos))];
//! let c = [Lanes([1.0_f32; 16]); 9];
//! let turned = zonal::sh3::rotate(q, &c);
//! let alone = zonal::sh3::rotate([0.0, 0.0, half[7].sin(), half[7].cos()], &[1.0; 9]);
//! assert_eq!(turned.map(|lanes| lanes.0[7]), alone);
//! ```
//!
//! `shaders` holds their WGSL and GLSL.
//!
//! # Features
//!
//! * `std` (default): square roots, sines and cosines from the standard library.
//! * `libm`: the same from the crate libm, for targets without `std`; turn the default features off.
//! * `order2` to `order10`, or `all-orders`: the kernels of an order. `order2` to `order5` are on by default. All of them
//!   are four megabytes of source; each order takes as long to compile as those below it together.
//! * `glam034` (default), `glam030` to `glam033`, `mint`: their vectors as coefficients.
//! * `batch`: the module `batch`, which takes a minute to compile for all orders. `half`: `f16` in batches.
//! * `rayon`: `project::parallel` and `batch::parallel`.
//! * `serde`: the module `serde`, for coefficients of every order in fields. `bytemuck`: coefficients of vectors, and
//!   [`real::Channels`], as bytes.
//! * `shaders`: the module `shaders`.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("zonal needs square roots: turn on its feature `std`, or `libm` where there is no standard library");

mod arithmetic;
#[cfg(feature = "batch")]
pub mod batch;
mod coefficients;
mod convention;
mod error;
mod grid;
mod light;
mod matrix;
mod pieces;
pub mod project;
mod rotation;
mod scalar;
#[cfg(feature = "serde")]
pub mod serde;
mod surface;

pub use arithmetic::{add, dot, lerp, resize, scale, scale_bands, weigh};
pub use coefficients::{Angles, Coefficients, Zonal};
pub use convention::{from_axes, from_convention, to_axes, to_convention};
pub use error::Error;
pub use light::{convolve, cosine_factor, hann, irradiance, irradiance_at, lanczos, least, negative_share};
pub use rotation::Rotation;
pub use scalar::{Element, Scalar};
pub use surface::{Frame, Lightmap, h4, h6};
#[cfg(feature = "order2")]
pub use surface::{h4_at, hl2_at};
#[cfg(feature = "order3")]
pub use surface::{h6_at, hl2};
#[cfg(feature = "shaders")]
pub use zonal_kernels::shaders;
pub use zonal_kernels::{conventions, costs, real};

/// Modules of this crate, so that rustc knows of those that are left out, and by which feature.
macro_rules! kernels {
    ($($feature:literal $module:ident: $about:literal;)*) => { $(
        #[doc = $about]
        #[cfg(feature = $feature)]
        pub mod $module {
            #[doc(inline)]
            pub use zonal_kernels::$module::*;
        }
    )* };
}

kernels! {
    "order2" sh2: "Kernels of order 2: bands 0 to 1, 4 coefficients.";
    "order3" sh3: "Kernels of order 3: bands 0 to 2, 9 coefficients.";
    "order4" sh4: "Kernels of order 4: bands 0 to 3, 16 coefficients.";
    "order5" sh5: "Kernels of order 5: bands 0 to 4, 25 coefficients.";
    "order6" sh6: "Kernels of order 6: bands 0 to 5, 36 coefficients.";
    "order7" sh7: "Kernels of order 7: bands 0 to 6, 49 coefficients.";
    "order8" sh8: "Kernels of order 8: bands 0 to 7, 64 coefficients.";
    "order9" sh9: "Kernels of order 9: bands 0 to 8, 81 coefficients.";
    "order10" sh10: "Kernels of order 10: bands 0 to 9, 100 coefficients.";
}

/// Returns all n² harmonics at a direction of unit length, bands ascending, m from −l to l.
///
/// Accurate at the poles too. The kernel is `basis:n`, `sh5::basis` at order 5.
///
/// ```
/// let y = zonal::evaluate_basis::<[f32; 9]>([0.0, 0.0, 1.0]);
/// assert!((y[2] - 0.488_602_5).abs() < 1e-7);
/// ```
#[inline]
pub fn evaluate_basis<C: Coefficients<Basis = C>>(dir: impl Into<[C::Scalar; 3]>) -> C {
    C::basis(dir.into())
}

/// Writes all n² harmonics at a direction of unit length, as [`evaluate_basis`] returns them, bit for bit.
///
/// For one direction at a time; see [what it is compiled for](crate#what-it-is-compiled-for).
///
/// ```
/// let mut y = [0.0_f32; 9];
/// zonal::evaluate_basis_into([0.0, 0.6, 0.8], &mut y);
/// assert_eq!(y, zonal::evaluate_basis::<[f32; 9]>([0.0, 0.6, 0.8]));
/// ```
#[inline]
pub fn evaluate_basis_into<C: Coefficients<Basis = C>>(dir: impl Into<[C::Scalar; 3]>, to: &mut C) {
    C::basis_into(dir.into(), to);
}

/// Returns the value of a signal in a direction of unit length: Σ c_i y_i(dir), one number a channel.
///
/// The basis is never stored. The kernel is `eval:n`, `sh5::eval` at order 5.
///
/// ```
/// let mut c = [[0.0_f32; 3]; 9];
/// c[0] = [1.0, 2.0, 4.0];
/// assert_eq!(zonal::evaluate([0.0, 0.6, 0.8], &c), [0.282_094_8, 0.564_189_6, 1.128_379_2]);
/// ```
#[inline]
pub fn evaluate<C: Coefficients>(dir: impl Into<[C::Scalar; 3]>, c: &C) -> C::Element {
    C::eval(dir.into(), c)
}

/// Rotates a signal by a unit quaternion, exactly and at every angle, without trigonometry and without a branch.
///
/// The kernel is `rotate:n`, `sh5::rotate` at order 5: for one channel of the orders 2 and 3 products and sums, else
/// z, y, z. For many signals by one rotation, see [`Rotation`].
#[inline]
pub fn rotate<C: Coefficients>(q: impl Into<[C::Scalar; 4]>, c: &C) -> C {
    C::rotate(q.into(), c)
}

/// Writes a signal rotated by a unit quaternion, as [`rotate`] returns it, bit for bit.
///
/// For one signal at a time: the fastest single call, of several channels too. The kernel is `rotate:n:pieces`. In a loop over many
/// signals [`rotate`] may become one of vectors, and `batch` is faster than both; see
/// [what it is compiled for](crate#what-it-is-compiled-for).
///
/// ```
/// let c = [[1.0_f32, 0.5, 0.25]; 25];
/// let mut turned = [[0.0; 3]; 25];
/// zonal::rotate_into([0.28, 0.0, 0.0, 0.96], &c, &mut turned);
/// assert_eq!(turned, zonal::rotate([0.28, 0.0, 0.0, 0.96], &c));
/// ```
#[inline]
pub fn rotate_into<C: Coefficients>(q: impl Into<[C::Scalar; 4]>, c: &C, to: &mut C) {
    C::rotate_into(q.into(), c, to);
}

/// Rotates a signal by a rotation matrix, given by its columns, exactly.
///
/// The orders 2 and 3 take the matrix as it is, by `rotate:n:matrix`, `sh3::rotate_matrix` at order 3. From order 4
/// on it is turned into a quaternion first, with a branch and a square root, and [`rotate`] does the rest: who has a
/// quaternion had better pass that. A matrix that mirrors or scales has no meaning here.
///
/// ```
/// use glam::{Mat3, Vec3};
///
/// let m = Mat3::from_rotation_x(0.5);
/// let turned = zonal::rotate_matrix(m.to_cols_array_2d(), &zonal::evaluate_basis::<[f32; 9]>(Vec3::Z));
/// assert!((zonal::evaluate(m * Vec3::Z, &turned) - 0.716_197_2).abs() < 1e-6);
/// ```
#[inline]
pub fn rotate_matrix<C: Coefficients>(columns: impl Into<[[C::Scalar; 3]; 3]>, c: &C) -> C {
    C::rotate_matrix(columns.into(), c)
}

/// Rotates a signal about y by an angle in radians, counterclockwise as seen from +y: z goes towards x.
///
/// One sine and one cosine, then `rotate_y:n`, `sh5::rotate_y` at order 5, which takes the two as they are.
///
/// ```
/// let lobe: [f32; 9] = zonal::evaluate_basis([0.0, 0.0, 1.0]);
/// let turned = zonal::rotate_y(core::f32::consts::FRAC_PI_2, &lobe);
/// assert!((zonal::evaluate([1.0, 0.0, 0.0], &turned) - zonal::evaluate([0.0, 0.0, 1.0], &lobe)).abs() < 1e-6);
/// ```
#[inline]
pub fn rotate_y<C: Coefficients>(angle: C::Scalar, c: &C) -> C {
    C::rotate_y(turn(angle), c)
}

/// Rotates a signal about z by an angle in radians, counterclockwise as seen from +z: x goes towards y.
///
/// One sine and one cosine, then `rotate_z:n`, `sh5::rotate_z` at order 5, which takes the two as they are.
#[inline]
pub fn rotate_z<C: Coefficients>(angle: C::Scalar, c: &C) -> C {
    C::rotate_z(turn(angle), c)
}

/// The cosine and the sine of an angle.
fn turn<T: Scalar>(angle: T) -> [T; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos, sin]
}

/// Rotates a signal about x by +90 degrees, which takes y to z: a sparse constant matrix.
///
/// The kernel is `rotate_x_plus_90:n`, `sh5::rotate_x_plus_90deg` at order 5.
#[inline]
pub fn rotate_x_plus_90<C: Coefficients>(c: &C) -> C {
    C::rotate_x_plus_90(c)
}

/// Rotates a signal about x by −90 degrees, which takes z to y: a sparse constant matrix.
///
/// The kernel is `rotate_x_minus_90:n`, `sh5::rotate_x_minus_90deg` at order 5.
#[inline]
pub fn rotate_x_minus_90<C: Coefficients>(c: &C) -> C {
    C::rotate_x_minus_90(c)
}

/// Exchanges y and z: the reflection that goes between a right-handed frame and a left-handed one with another axis up, its
/// own inverse. Between frames of one hand, and for mirror images, take [`to_axes`].
///
/// The kernel is `swap_yz:n`, `sh5::swap_yz` at order 5.
#[inline]
pub fn swap_yz<C: Coefficients>(c: &C) -> C {
    C::swap_yz(c)
}

/// Tilts a signal by the shortest rotation from z to a unit normal, as a normal map asks; from (x, y, z) alone, without
/// trigonometry.
///
/// Bands 1 and 2 are exact for every normal but −z, at which they are NaN or infinite; the bands from 3 on are
/// approximate and meant for small tilts: `sh5::tilt`, the kernel `tilt:n`, says the error at some angles and the
/// largest angle that it is for. Beyond, or where the error is too much, take [`rotate`] with `Quat::from_rotation_arc(Vec3::Z, normal)`.
#[inline]
pub fn tilt<C: Coefficients>(normal: impl Into<[C::Scalar; 3]>, c: &C) -> C {
    C::tilt(normal.into(), c)
}

/// Writes a signal tilted to a unit normal, as [`tilt`] returns it, bit for bit.
///
/// For one signal at a time; see [what it is compiled for](crate#what-it-is-compiled-for).
#[inline]
pub fn tilt_into<C: Coefficients>(normal: impl Into<[C::Scalar; 3]>, c: &C, to: &mut C) {
    C::tilt_into(normal.into(), c, to);
}

/// Rotates a signal exactly so that z goes to a unit normal, wherever that points; the spin about the normal is left
/// open. For signals that are symmetric about z or whose spin is of no interest.
///
/// The kernel is `rotate:n:align`, `sh5::rotate_align` at order 5, cheaper than [`rotate`].
#[inline]
pub fn align<C: Coefficients>(normal: impl Into<[C::Scalar; 3]>, c: &C) -> C {
    C::align(normal.into(), c)
}

type Rotated<Z> = <Z as Zonal>::Coefficients;

/// Rotates a zonal signal, given by the coefficient of m = 0 of each band, so that its axis goes from z to a direction
/// of unit length: n coefficients in, n² out.
///
/// The kernel is `rotate:n:zonal`, `sh5::rotate_zonal` at order 5.
///
/// ```
/// // The clamped cosine about a direction, order 3.
/// let cosine = [0.8862269_f32, 1.0233267, 0.4954159];
/// let c = zonal::rotate_zonal([1.0, 0.0, 0.0], &cosine);
/// assert_eq!(c.len(), 9);
/// assert!((zonal::evaluate([1.0, 0.0, 0.0], &c) - 1.0625).abs() < 1e-6);
/// ```
#[inline]
pub fn rotate_zonal<Z: Zonal>(dir: impl Into<[<Rotated<Z> as Coefficients>::Scalar; 3]>, g: &Z) -> Rotated<Z> {
    Z::rotate_zonal(dir.into(), g)
}

/// The README, whose code runs.
#[cfg(all(doctest, feature = "glam034"))]
#[doc = include_str!("../README.md")]
mod readme {}
