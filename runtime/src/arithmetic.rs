//! Sums, multiples and mixtures of signals, and what changes their order. It knows storage, and nothing of the sphere.

use zonal_kernels::real::Signal;

use crate::coefficients::Coefficients;
use crate::scalar::Element;

type Of<C> = <<C as Coefficients>::Element as Element>::Signal;

/// Returns the coefficients of two signals, put together one by one.
#[inline]
fn each<C: Coefficients>(a: &C, b: &C, f: impl Fn(Of<C>, Of<C>) -> Of<C>) -> C {
    let (a, b) = (a.as_ref(), b.as_ref());
    C::from_fn(|i| C::Element::element(f(a[i].signal(), b[i].signal())))
}

/// Returns the sum of two signals.
#[inline]
pub fn add<C: Coefficients>(a: &C, b: &C) -> C {
    each(a, b, |a, b| a + b)
}

/// Returns a signal times a number.
#[inline]
pub fn scale<C: Coefficients>(c: &C, factor: C::Scalar) -> C {
    C::from_fn(|i| C::Element::element(c.as_ref()[i].signal() * factor))
}

/// Returns the mixture (1 − t) a + t b of two signals: `a` at t = 0, `b` but for rounding at t = 1. Any other t is taken
/// as it is.
///
/// ```
/// // A point between two probes.
/// let [left, right] = [[1.0_f32; 9], [3.0_f32; 9]];
/// assert_eq!(zonal::lerp(&left, &right, 0.25), [1.5; 9]);
/// ```
#[inline]
pub fn lerp<C: Coefficients>(a: &C, b: &C, t: C::Scalar) -> C {
    each(a, b, |a, b| (b - a).fma(t, a))
}

/// Returns the sum of the products of the coefficients of two signals, channel by channel: the integral of the product
/// of both over the sphere.
///
/// ```
/// // Light times what a surface lets through, both in RGB.
/// let [light, transfer] = [[[1.0_f32, 0.5, 0.25]; 9], [[0.5_f32; 3]; 9]];
/// assert_eq!(zonal::dot(&light, &transfer), [4.5, 2.25, 1.125]);
/// ```
#[inline]
pub fn dot<C: Coefficients>(a: &C, b: &C) -> C::Element {
    let pairs = a.as_ref().iter().zip(b.as_ref());
    C::Element::element(pairs.fold(Signal::zero(), |sum, (a, b)| a.signal().times_fma(b.signal(), sum)))
}

/// Returns the sum of the coefficients of a signal of any number of channels, each times a number: what
/// [`dot`] is for two signals of one channel, and for light in RGB with a transfer that is grey.
///
/// ```
/// let transfer: [f32; 9] = zonal::evaluate_basis([0.0, 0.6, 0.8]);
/// let light = [[1.0_f32, 0.5, 0.25]; 9];
/// let by_hand = zonal::evaluate([0.0, 0.6, 0.8], &light);
/// assert!((zonal::weigh(&transfer, &light)[0] - by_hand[0]).abs() < 1e-6);
/// ```
#[inline]
pub fn weigh<C: Coefficients>(weights: &C::Basis, c: &C) -> C::Element {
    let terms = weights.as_ref().iter().zip(c.as_ref());
    C::Element::element(terms.fold(Signal::zero(), |sum, (weight, c)| c.signal().fma(*weight, sum)))
}

/// Returns a signal in another order: the bands that both have, and zeros above them.
///
/// ```
/// let c = [1.0_f32; 16];
/// let lower: [f32; 9] = zonal::resize(&c);
/// let higher: [f32; 25] = zonal::resize(&lower);
/// assert_eq!((higher[8], higher[9]), (1.0, 0.0));
/// ```
#[inline]
pub fn resize<C: Coefficients, D: Coefficients<Element = C::Element>>(c: &C) -> D {
    let mut resized = D::zero();
    for (to, from) in resized.as_mut().iter_mut().zip(c.as_ref()) {
        *to = *from;
    }
    resized
}

/// Returns a signal whose band l is multiplied by `factor(l)`: what a convolution, a window and a blur are.
///
/// ```
/// let c = [1.0_f32; 9];
/// let blurred = zonal::scale_bands(&c, |l| 1.0 / (1.0 + l as f32));
/// assert_eq!(blurred, [1.0, 0.5, 0.5, 0.5, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]);
/// ```
#[inline]
pub fn scale_bands<C: Coefficients>(c: &C, mut factor: impl FnMut(usize) -> C::Scalar) -> C {
    let mut scaled = *c;
    for (l, band) in scaled.bands_mut().enumerate() {
        let factor = factor(l);
        for c in band {
            *c = C::Element::element(c.signal() * factor);
        }
    }
    scaled
}
