//! What light needs of coefficients: irradiance (docs/MATH.md#the-clamped-cosine), convolution with zonal functions
//! (docs/MATH.md#zonal-functions), windows against ringing (docs/MATH.md#ringing), and how negative a signal is.

use core::f64::consts::PI;

use zonal_kernels::real::{Real, Signal};

use crate::arithmetic::scale_bands;
use crate::coefficients::{Coefficients, Zonal};
use crate::grid;
use crate::scalar::{Element, Scalar};

/// Returns the factor A_l by which band l of radiance gives irradiance: π, 2π/3, π/4, 0, −π/24, 0, π/64, …, exactly 0 for
/// odd l above 1 (Ramamoorthi and Hanrahan 2001).
///
/// ```
/// use core::f64::consts::PI;
///
/// assert_eq!([0, 1, 2, 3].map(zonal::cosine_factor), [PI, 2.0 * PI / 3.0, PI / 4.0, 0.0]);
/// ```
pub fn cosine_factor(l: usize) -> f64 {
    match l {
        1 => 2.0 * PI / 3.0,
        _ if l % 2 == 1 => 0.0,
        // From band to band the integral of the cosine times a Legendre polynomial changes by −(l − 1)/(l + 4).
        _ => (0..l / 2).fold(PI, |factor, half| {
            let below = 2.0 * half as f64;
            factor * (1.0 - below) / (below + 4.0)
        }),
    }
}

/// Returns the irradiance by the surface's normal of light whose radiance is given: the convolution with the cosine that
/// is clamped below the horizon, band l times [`cosine_factor`]`(l)`.
///
/// What a white diffuse surface sends out is 1/π of it: uniform radiance 1 is irradiance π, and is seen as 1. Programs
/// that keep coefficients *over π* mean that: see [`to_convention`](crate::to_convention).
///
/// ```
/// use core::f32::consts::{FRAC_1_PI, PI};
///
/// // Uniform radiance 1: the constant is 2√π times the harmonic of band 0.
/// let mut radiance = [0.0_f32; 9];
/// radiance[0] = 2.0 * PI.sqrt();
/// let irradiance = zonal::irradiance(&radiance);
/// assert!((zonal::evaluate([0.0, 0.6, 0.8], &irradiance) - PI).abs() < 1e-6);
/// let sent_out = zonal::scale(&irradiance, FRAC_1_PI);
/// assert!((zonal::evaluate([0.0, 0.6, 0.8], &sent_out) - 1.0).abs() < 1e-6);
/// ```
#[inline]
pub fn irradiance<C: Coefficients>(radiance: &C) -> C {
    scale_bands(radiance, |l| C::Scalar::lit(cosine_factor(l)))
}

/// Returns the irradiance of a surface with a unit normal, of light whose radiance is given: [`irradiance`] and
/// [`evaluate`](crate::evaluate) in one, for a normal or two. For many normals make the coefficients of irradiance once.
#[inline]
pub fn irradiance_at<C: Coefficients>(normal: impl Into<[C::Scalar; 3]>, radiance: &C) -> C::Element {
    C::eval(normal.into(), &irradiance(radiance))
}

/// Returns the convolution of a signal with a zonal function about z: what is seen in a direction is the signal around
/// that direction, weighed by the function. Band l is multiplied by √(4π/(2l+1)) g_l (Funk and Hecke 1916).
///
/// ```
/// // Irradiance is the convolution with the clamped cosine.
/// let cosine = [0.886_226_9_f32, 1.023_326_7, 0.495_415_9];
/// let radiance = [1.0_f32; 9];
/// let [a, b] = [zonal::convolve(&radiance, &cosine), zonal::irradiance(&radiance)];
/// assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6));
/// ```
#[inline]
pub fn convolve<C: Coefficients, Z: Zonal<Coefficients = C::Basis>>(c: &C, g: &Z) -> C {
    scale_bands(c, |l| C::Scalar::lit((4.0 * PI / (2 * l + 1) as f64).root()) * g.as_ref()[l])
}

/// Returns the factor of band l of Hann's window, (1 + cos(πl/width))/2: 1 at band 0, 0 from band `width` on.
///
/// A window takes from the upper bands, so that a signal that was cut after them rings less and blurs more (Sloan 2008).
/// A width of the order or one above is mild.
///
/// ```
/// let c = [1.0_f32; 9];
/// let smooth = zonal::scale_bands(&c, |l| zonal::hann(l, 4.0));
/// assert!((smooth[8] - 0.5).abs() < 1e-6);
/// ```
pub fn hann<T: Scalar>(l: usize, width: T) -> T {
    match share_of(l, width) {
        Some(share) => (T::lit(1.0) + (share * T::lit(PI)).sin_cos().1) * T::lit(0.5),
        None => T::zero(),
    }
}

/// Returns the factor of band l of Lanczos' window, sin(πl/width)/(πl/width): 1 at band 0, 0 from band `width` on. It takes
/// less than [`hann`] from the lower bands.
pub fn lanczos<T: Scalar>(l: usize, width: T) -> T {
    match share_of(l, width) {
        Some(_) if l == 0 => T::lit(1.0),
        Some(share) => (share * T::lit(PI)).sin_cos().0 * (share * T::lit(PI)).recip(),
        None => T::zero(),
    }
}

/// Returns l / width below the width of a window, and nothing from there on; 0 for band 0 whatever the width.
fn share_of<T: Scalar>(l: usize, width: T) -> Option<T> {
    let place = T::lit(l as f64);
    match l {
        0 => Some(T::zero()),
        _ if place < width => Some(place * width.recip()),
        _ => None,
    }
}

/// How many rows of directions an order is looked at in, and half as many columns.
const ROWS: usize = 16;

/// Returns the values of a signal in directions that lie close, with the share of the sphere that each stands for.
fn values<C: Coefficients>(c: &C) -> impl Iterator<Item = (C::Element, f64)> {
    let rows = ROWS * C::ORDER;
    (0..rows).flat_map(move |row| {
        let share = grid::solid_angle(rows, 2 * rows, row) / (4.0 * PI);
        let directions = (0..2 * rows).map(move |column| grid::direction(rows, 2 * rows, row, column));
        directions.map(move |direction| (C::eval(direction.map(C::Scalar::lit), c), share))
    })
}

/// Returns the least value of a signal, channel by channel: below 0 where light rings. A kernel that shows such light
/// clamps it.
///
/// At order 3 it is the least of all, by `sh3::minimum`, to rounding. At other orders it is the least of 512 n² values and lies above the least of all by at most one
/// hundredth of the greatest magnitude, and takes as long as so many calls of [`evaluate`](crate::evaluate).
pub fn least<C: Coefficients>(c: &C) -> C::Element {
    if C::minimum(&C::Basis::zero()).is_some() {
        let of = |channel: usize| C::Basis::from_fn(|i| c.as_ref()[i].channels()[channel]);
        return C::Element::from_channels(|channel| exact_least::<C>(&of(channel)));
    }
    let infinite = C::Element::from_channels(|_| C::Scalar::lit(f64::INFINITY));
    values(c).fold(infinite, |least, (value, _)| {
        let [least, value] = [least.channels(), value.channels()];
        C::Element::from_channels(|channel| least[channel].min(value[channel]))
    })
}

/// The least value of one channel, by the kernel, which is for coefficients of a size of about one.
fn exact_least<C: Coefficients>(channel: &C::Basis) -> C::Scalar {
    let zero = C::Scalar::zero();
    let size = channel.as_ref().iter().fold(zero, |most, &c| {
        let size = if c < zero { -c } else { c };
        if size > most { size } else { most }
    });
    let inverse = size.recip();
    let is_usual = size > zero && inverse < C::Scalar::lit(f64::INFINITY);
    let (unit, back) = if is_usual { (inverse, size) } else { (C::Scalar::lit(1.0), C::Scalar::lit(1.0)) };
    let scaled = C::Basis::from_fn(|i| channel.as_ref()[i] * unit);
    C::minimum(&scaled).map_or(zero, |least| least * back)
}

/// Returns the share of all directions, from 0 to 1, in which a signal is negative, channel by channel. It is counted in
/// as many directions as [`least`] looks at.
///
/// ```
/// // A lobe of order 3 is negative around its waist.
/// let lobe: [f32; 9] = zonal::evaluate_basis([0.0, 0.0, 1.0]);
/// assert!(zonal::least(&lobe) < -0.1);
/// assert!((zonal::negative_share(&lobe) - 0.49).abs() < 0.01);
/// // Hann's window leaves a sixth of that.
/// let smooth = zonal::scale_bands(&lobe, |l| zonal::hann(l, 3.0));
/// assert!(zonal::least(&smooth) > 0.17 * zonal::least(&lobe));
/// ```
pub fn negative_share<C: Coefficients>(c: &C) -> C::Element {
    let none = C::Element::element(Signal::zero());
    values(c).fold(none, |sum, (value, share)| {
        let [sum, value] = [sum.channels(), value.channels()];
        let more = |channel: usize| if value[channel] < C::Scalar::zero() { share } else { 0.0 };
        C::Element::from_channels(|channel| sum[channel] + C::Scalar::lit(more(channel)))
    })
}
