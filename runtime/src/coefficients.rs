//! What the functions of this crate are generic over: arrays of coefficients, whose length says the order and whose
//! element says the precision and the number of channels. One macro ties each length to its generated module; it holds
//! no mathematics.

use core::borrow::Borrow;
use core::fmt::Debug;

use crate::error::Error;
use crate::scalar::sealed::Sealed;
use crate::scalar::{Element, Scalar};
use zonal_kernels::real::Signal;

/// What a [`Rotation`](crate::Rotation) of an order holds: its pairs of a cosine and a sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles<const ORDER: usize, P>(pub(crate) P);

/// The coefficients of a signal: `[E; 4]`, `[E; 9]`, … `[E; 100]` for the orders 2 to 10, index l(l+1)+m.
///
/// An order n has the bands 0 to n − 1, which is n² coefficients. The array's length says the order, its [`Element`]
/// the precision and the channels: `[f32; 25]` is a signal of order 5, `[Vec3; 25]` or `[[f32; 3]; 25]` an RGB one,
/// `[f64; 25]` one in double precision. Each order is a feature; there is no order 1, whose one coefficient is a constant
/// times 2√π that no rotation changes.
///
/// What is generic over the order takes coefficients as a slice, and makes them from a function of the index. A bound
/// says the precision, `Coefficients<Scalar = f32>` of any channels, or with it the element:
///
/// ```
/// use zonal::Coefficients;
///
/// /// The energy of each band.
/// fn energies<C: Coefficients<Element = f32, Scalar = f32>>(c: &C) -> Vec<f32> {
///     c.bands().map(|band| band.iter().map(|x| x * x).sum()).collect()
/// }
/// /// The mean of a signal and its mirror image, up side down.
/// fn without_height<C: Coefficients<Scalar = f32>>(c: &C) -> C {
///     let [x, y] = [zonal::conventions::Axis::X, zonal::conventions::Axis::Y];
///     let mirrored = zonal::to_axes(c, [x, y, zonal::conventions::Axis::MinusZ]).expect("three axes");
///     zonal::lerp(c, &mirrored, 0.5)
/// }
/// /// A signal that is weaker from coefficient to coefficient.
/// fn falling<C: Coefficients<Element = f32, Scalar = f32>>() -> C {
///     C::from_fn(|i| 1.0 / (1.0 + i as f32))
/// }
///
/// let c: [f32; 9] = falling();
/// assert_eq!(energies(&c).len(), 3);
/// assert_eq!(without_height(&c)[2], 0.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no array of coefficients of an order that zonal was compiled with",
    label = "not `[E; n²]` for an order n whose feature is on",
    note = "order n is an array of n² coefficients: `[E; 4]` is order 2, `[E; 9]` order 3, and so on to `[E; 100]`, order 10",
    note = "each order is a feature of zonal, `order2` to `order10`; those above `order5` are off by default",
    note = "a slice becomes an array by `Coefficients::from_slice`"
)]
pub trait Coefficients:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + AsRef<[<Self as Coefficients>::Element]>
    + AsMut<[<Self as Coefficients>::Element]>
    + Sealed
{
    /// The order n.
    const ORDER: usize;
    /// How many coefficients there are, n².
    const COUNT: usize;
    /// One coefficient.
    type Element: Element<Scalar = Self::Scalar>;
    /// The precision.
    type Scalar: Scalar;
    /// One number a harmonic: `[f32; 25]` at order 5, whatever the channels.
    type Basis: Coefficients<Element = Self::Scalar, Scalar = Self::Scalar>;
    /// The (cosine, sine) pairs that a [`Rotation`](crate::Rotation) holds.
    type Angles: Copy + Debug + PartialEq;

    /// Returns the coefficients that are `value(i)` at index i = l(l+1)+m.
    fn from_fn(value: impl FnMut(usize) -> Self::Element) -> Self;

    /// Returns coefficients that are all zero.
    #[inline]
    fn zero() -> Self {
        Self::from_fn(|_| Self::Element::element(Signal::zero()))
    }

    /// Returns the coefficients in a slice, of which there are n².
    ///
    /// # Errors
    ///
    /// If there are more or fewer; the error says how many.
    ///
    /// ```
    /// use zonal::Coefficients;
    ///
    /// let read = vec![[0.25_f32; 3]; 9];
    /// assert_eq!(<[[f32; 3]; 9]>::from_slice(&read), Ok([[0.25; 3]; 9]));
    /// let error = <[[f32; 3]; 16]>::from_slice(&read).unwrap_err();
    /// assert_eq!(error.to_string(), "9 coefficients, but order 4 is 16");
    /// ```
    fn from_slice(coefficients: &[Self::Element]) -> Result<Self, Error> {
        match coefficients.len() == Self::COUNT {
            true => Ok(Self::from_fn(|i| coefficients[i])),
            false => Err(Error::Coefficients { found: coefficients.len(), order: Self::ORDER }),
        }
    }

    /// Returns the coefficients whose numbers are in a slice, those of the channels of one coefficient side by side.
    ///
    /// # Errors
    ///
    /// If there are not n² times the channels; the error says how many.
    ///
    /// ```
    /// use zonal::Coefficients;
    ///
    /// let error = <[[f32; 3]; 9]>::from_numbers(&[0.0; 9]).unwrap_err();
    /// assert_eq!(error.to_string(), "9 numbers, but order 3 in RGB is 9 of 3, which makes 27");
    /// ```
    fn from_numbers(numbers: &[Self::Scalar]) -> Result<Self, Error> {
        let channels = Self::Element::CHANNELS;
        match numbers.len() == Self::COUNT * channels {
            true => Ok(Self::from_fn(|i| Self::Element::from_channels(|channel| numbers[i * channels + channel]))),
            false => Err(Error::Numbers { found: numbers.len(), order: Self::ORDER, channels }),
        }
    }

    /// Returns the bands, ascending: band l has 2l + 1 coefficients, m from −l to l.
    #[inline]
    fn bands(&self) -> impl Iterator<Item = &[Self::Element]> {
        let mut rest = self.as_ref();
        (0..Self::ORDER).map(move |l| {
            let (band, above) = rest.split_at(2 * l + 1);
            rest = above;
            band
        })
    }

    /// Returns the bands to be changed, as [`bands`](Self::bands) orders them.
    #[inline]
    fn bands_mut(&mut self) -> impl Iterator<Item = &mut [Self::Element]> {
        let mut rest = self.as_mut();
        (0..Self::ORDER).map(move |l| {
            let (band, above) = core::mem::take(&mut rest).split_at_mut(2 * l + 1);
            rest = above;
            band
        })
    }

    #[doc(hidden)]
    fn basis(dir: [Self::Scalar; 3]) -> Self::Basis;
    #[doc(hidden)]
    fn hemisphere_basis(dir: [Self::Scalar; 3]) -> Self::Basis;
    #[doc(hidden)]
    fn eval(dir: [Self::Scalar; 3], c: &Self) -> Self::Element;
    #[doc(hidden)]
    fn rotate(q: [Self::Scalar; 4], c: &Self) -> Self;
    #[doc(hidden)]
    fn basis_into(dir: [Self::Scalar; 3], to: &mut Self::Basis);
    #[doc(hidden)]
    fn rotate_into(q: [Self::Scalar; 4], c: &Self, to: &mut Self);
    #[doc(hidden)]
    fn tilt_into(n: [Self::Scalar; 3], c: &Self, to: &mut Self);
    #[doc(hidden)]
    fn rotate_matrix(columns: [[Self::Scalar; 3]; 3], c: &Self) -> Self;
    #[doc(hidden)]
    fn rotate_y(cs: [Self::Scalar; 2], c: &Self) -> Self;
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
    #[doc(hidden)]
    fn minimum(channel: &Self::Basis) -> Option<Self::Scalar>;
}

/// A zonal signal, which is symmetric about z: `[E; 2]` to `[E; 10]`, one coefficient a band, that of m = 0.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no zonal signal of an order that zonal was compiled with",
    label = "not `[E; n]` for an order n whose feature is on",
    note = "a zonal signal of order n is an array of n coefficients, one a band",
    note = "each order is a feature of zonal, `order2` to `order10`; those above `order5` are off by default"
)]
pub trait Zonal: AsRef<[<<Self as Zonal>::Coefficients as Coefficients>::Element]> + Sealed {
    /// The coefficients of the same order without the symmetry.
    type Coefficients: Coefficients;
    #[doc(hidden)]
    fn rotate_zonal(dir: [<Self::Coefficients as Coefficients>::Scalar; 3], g: &Self) -> Self::Coefficients;
}

macro_rules! orders {
    ($($feature:literal $module:ident: $order:literal, $count:literal, $pairs:literal, $one:ident, $many:ident, $matrix:tt, $least:tt;)*) => { $(
        #[cfg(feature = $feature)]
        impl<E: Element> Coefficients for [E; $count] {
            const ORDER: usize = $order;
            const COUNT: usize = $count;
            type Element = E;
            type Scalar = E::Scalar;
            type Basis = [E::Scalar; $count];
            type Angles = Angles<$order, [[E::Scalar; 2]; $pairs]>;

            #[inline]
            fn from_fn(value: impl FnMut(usize) -> E) -> Self {
                core::array::from_fn(value)
            }
            #[inline]
            fn basis(dir: [E::Scalar; 3]) -> Self::Basis {
                zonal_kernels::$module::basis(dir)
            }
            #[inline]
            fn hemisphere_basis(dir: [E::Scalar; 3]) -> Self::Basis {
                zonal_kernels::$module::hsh_basis(dir)
            }
            #[inline]
            fn eval(dir: [E::Scalar; 3], c: &Self) -> E {
                E::element(zonal_kernels::$module::eval(dir, E::signals(c).borrow()))
            }
            #[inline]
            fn rotate(q: [E::Scalar; 4], c: &Self) -> Self {
                let c = E::signals(c);
                E::elements(match E::CHANNELS {
                    1 => zonal_kernels::$module::$one(q, c.borrow()),
                    _ => zonal_kernels::$module::$many(q, c.borrow()),
                })
            }
            #[inline]
            fn basis_into(dir: [E::Scalar; 3], to: &mut Self::Basis) {
                crate::pieces::$module::basis(dir, to);
            }
            #[inline]
            fn rotate_into(q: [E::Scalar; 4], c: &Self, to: &mut Self) {
                match E::CHANNELS {
                    1 => crate::pieces::$module::$one(q, c, to),
                    _ => crate::pieces::$module::$many(q, c, to),
                }
            }
            #[inline]
            fn tilt_into(n: [E::Scalar; 3], c: &Self, to: &mut Self) {
                crate::pieces::$module::tilt(n, c, to);
            }
            #[inline]
            fn rotate_matrix(columns: [[E::Scalar; 3]; 3], c: &Self) -> Self {
                orders!(@ $matrix $module columns c E)
            }
            #[inline]
            fn rotate_y(cs: [E::Scalar; 2], c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_y(cs, E::signals(c).borrow()))
            }
            #[inline]
            fn rotate_z(cs: [E::Scalar; 2], c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_z(cs, E::signals(c).borrow()))
            }
            #[inline]
            fn rotate_x_plus_90(c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_x_plus_90deg(E::signals(c).borrow()))
            }
            #[inline]
            fn rotate_x_minus_90(c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_x_minus_90deg(E::signals(c).borrow()))
            }
            #[inline]
            fn swap_yz(c: &Self) -> Self {
                E::elements(zonal_kernels::$module::swap_yz(E::signals(c).borrow()))
            }
            #[inline]
            fn tilt(n: [E::Scalar; 3], c: &Self) -> Self {
                E::elements(zonal_kernels::$module::tilt(n, E::signals(c).borrow()))
            }
            #[inline]
            fn align(n: [E::Scalar; 3], c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_align(n, E::signals(c).borrow()))
            }
            #[inline]
            fn angles(q: [E::Scalar; 4]) -> Self::Angles {
                Angles(zonal_kernels::$module::angles(q))
            }
            #[inline]
            fn rotate_angles(angles: &Self::Angles, c: &Self) -> Self {
                E::elements(zonal_kernels::$module::rotate_angles(&angles.0, E::signals(c).borrow()))
            }
            #[inline]
            fn minimum(channel: &Self::Basis) -> Option<E::Scalar> {
                orders!(@ $least $module channel)
            }
        }
        #[cfg(feature = $feature)]
        impl<E: Element> Zonal for [E; $order] {
            type Coefficients = [E; $count];
            #[inline]
            fn rotate_zonal(dir: [E::Scalar; 3], g: &Self) -> [E; $count] {
                E::elements(zonal_kernels::$module::rotate_zonal(dir, E::signals(g).borrow()))
            }
        }
    )* };
    (@ direct $module:ident $columns:ident $c:ident $element:ident) => {
        $element::elements(zonal_kernels::$module::rotate_matrix(&$columns, $element::signals($c).borrow()))
    };
    (@ quaternion $module:ident $columns:ident $c:ident $element:ident) => {
        Self::rotate(crate::matrix::quaternion($columns), $c)
    };
    (@ minimum $module:ident $channel:ident) => {
        Some(zonal_kernels::$module::minimum($channel)[0])
    };
    (@ sampled $module:ident $channel:ident) => {{
        let _ = $channel;
        None
    }};
}

// The feature, the module, the order, its coefficients, the pairs of `angles`, `rotate` of one channel and of several, and
// whether a matrix serves as it is, how the least value is found.
orders! {
    "order2" sh2: 2, 4, 4, rotate, rotate, direct, sampled;
    "order3" sh3: 3, 9, 7, rotate, rotate_zyz, direct, minimum;
    "order4" sh4: 4, 16, 10, rotate, rotate, quaternion, sampled;
    "order5" sh5: 5, 25, 13, rotate, rotate, quaternion, sampled;
    "order6" sh6: 6, 36, 16, rotate, rotate, quaternion, sampled;
    "order7" sh7: 7, 49, 19, rotate, rotate, quaternion, sampled;
    "order8" sh8: 8, 64, 22, rotate, rotate, quaternion, sampled;
    "order9" sh9: 9, 81, 25, rotate, rotate, quaternion, sampled;
    "order10" sh10: 10, 100, 28, rotate, rotate, quaternion, sampled;
}
