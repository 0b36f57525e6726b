//! Coefficients in the frames, with the signs and factors and at the places of other programs. What a program has is read
//! from the generated table; here is how a signed permutation of the axes acts on harmonics (docs/MATH.md#frames).

use zonal_kernels::conventions::{Axis, Convention};
use zonal_kernels::real::Real;

use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::scalar::Element;

/// Returns zonal's coefficients as a program has them: in its frame, with its signs and factors, at its places.
///
/// # Errors
///
/// If the program takes fewer bands: [`resize`](crate::resize) cuts them first.
///
/// ```
/// use zonal::conventions::{THREE_JS, UNITY};
///
/// let radiance: [[f32; 3]; 9] = [[1.0; 3]; 9];
/// let probe = zonal::to_convention(&radiance, &THREE_JS)?;
/// // Unity takes irradiance alone, and means it over π, which the factors hold.
/// assert!(UNITY.is_irradiance);
/// let ambient = zonal::to_convention(&zonal::irradiance(&radiance), &UNITY)?;
/// # assert!(probe != ambient);
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn to_convention<C: Coefficients>(c: &C, convention: &Convention) -> Result<C, Error> {
    let there = to_axes(c, convention.axes)?;
    let mut converted = C::zero();
    for (i, (place, factor)) in places::<C>(convention)?.enumerate() {
        converted.as_mut()[place] = times(there.as_ref()[i], C::Scalar::lit(factor));
    }
    Ok(converted)
}

/// Returns a program's coefficients as zonal has them: the inverse of [`to_convention`].
///
/// # Errors
///
/// If the program takes fewer bands.
///
/// ```
/// use zonal::conventions::THREE_JS;
///
/// let c: [f64; 9] = zonal::evaluate_basis([0.36, 0.48, 0.8]);
/// let back = zonal::from_convention(&zonal::to_convention(&c, &THREE_JS)?, &THREE_JS)?;
/// assert!(c.iter().zip(back).all(|(c, back)| (c - back).abs() < 1e-15));
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn from_convention<C: Coefficients>(c: &C, convention: &Convention) -> Result<C, Error> {
    let mut there = C::zero();
    for (i, (place, factor)) in places::<C>(convention)?.enumerate() {
        there.as_mut()[i] = times(c.as_ref()[place], C::Scalar::lit(1.0 / factor));
    }
    from_axes(&there, convention.axes)
}

/// Where a program has each coefficient, and what it multiplies it by.
fn places<C: Coefficients>(convention: &Convention) -> Result<impl Iterator<Item = (usize, f64)>, Error> {
    let Convention { name, max_order, places, factors, .. } = *convention;
    match C::ORDER <= max_order {
        true => Ok(places.iter().copied().zip(factors.iter().copied()).take(C::COUNT)),
        false => Err(Error::Bands { convention: name, most: max_order, order: C::ORDER }),
    }
}

fn times<E: Element>(element: E, factor: E::Scalar) -> E {
    E::element(element.signal() * factor)
}

/// Returns a signal of zonal's frame in another, whose `axes` are zonal's x, y and z: at a direction of that frame it has
/// the value that `c` has at the same direction of zonal's.
///
/// Exact but for the rounding of the exchange of y and z ([`swap_yz`](crate::swap_yz)); a left-handed frame is as good as a
/// right-handed one.
///
/// # Errors
///
/// If two of the axes are along one line.
///
/// ```
/// use zonal::conventions::Axis;
///
/// // A program that has y up and x as zonal has it: its −z is zonal's y, and its y is zonal's z.
/// let sky: [f32; 9] = zonal::evaluate_basis([0.0, 0.6, 0.8]);
/// let there = zonal::to_axes(&sky, [Axis::X, Axis::MinusZ, Axis::Y])?;
/// let [a, b] = [zonal::evaluate([0.0, 0.6, 0.8], &sky), zonal::evaluate([0.0, 0.8, -0.6], &there)];
/// assert!((a - b).abs() < 1e-6);
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn to_axes<C: Coefficients>(c: &C, axes: [Axis; 3]) -> Result<C, Error> {
    let parts = axes.map(parts);
    let [x, y, z] = parts.map(|(_, negative)| negative);
    let flipped = moved(c, |l, m| {
        let odd = m % 2 != 0;
        (m, (x && ((m < 0) != odd)) ^ (y && m < 0) ^ (z && (l % 2 == 0) == odd))
    });
    match parts.map(|(place, _)| place) {
        [0, 1, 2] => Ok(flipped),
        [1, 0, 2] => Ok(swap_xy(&flipped)),
        [0, 2, 1] => Ok(C::swap_yz(&flipped)),
        [2, 0, 1] => Ok(C::swap_yz(&swap_xy(&flipped))),
        [1, 2, 0] => Ok(swap_xy(&C::swap_yz(&flipped))),
        [2, 1, 0] => Ok(swap_xy(&C::swap_yz(&swap_xy(&flipped)))),
        _ => Err(Error::Axes(axes)),
    }
}

/// Returns a signal of another frame in zonal's: the inverse of [`to_axes`].
///
/// # Errors
///
/// As [`to_axes`].
pub fn from_axes<C: Coefficients>(c: &C, axes: [Axis; 3]) -> Result<C, Error> {
    let mut inverse = axes;
    for (at, axis) in axes.into_iter().enumerate() {
        let (place, negative) = parts(axis);
        inverse[place] = match (at, negative) {
            (0, false) => Axis::X,
            (1, false) => Axis::Y,
            (_, false) => Axis::Z,
            (0, true) => Axis::MinusX,
            (1, true) => Axis::MinusY,
            (_, true) => Axis::MinusZ,
        };
    }
    // Axes that are no frame have no inverse, and are refused as they are.
    match axes.map(|axis| parts(axis).0) {
        [a, b, c] if a == b || b == c || c == a => Err(Error::Axes(axes)),
        _ => to_axes(c, inverse),
    }
}

/// The place of an axis, and whether it is turned.
fn parts(axis: Axis) -> (usize, bool) {
    match axis {
        Axis::X => (0, false),
        Axis::Y => (1, false),
        Axis::Z => (2, false),
        Axis::MinusX => (0, true),
        Axis::MinusY => (1, true),
        Axis::MinusZ => (2, true),
    }
}

/// Exchanges x and y, which makes (x + iy)^m into i^m (x − iy)^m.
fn swap_xy<C: Coefficients>(c: &C) -> C {
    moved(c, |_, m| match m.rem_euclid(4) {
        0 => (m, m < 0),
        2 => (m, m > 0),
        _ => (-m, m.unsigned_abs() % 4 == 3),
    })
}

/// Returns coefficients each of which is another one of its band, negated or not.
fn moved<C: Coefficients>(c: &C, from: impl Fn(usize, isize) -> (isize, bool)) -> C {
    C::from_fn(|i| {
        let l = i.isqrt();
        let middle = l * (l + 1);
        let (m, negative) = from(l, i as isize - middle as isize);
        let there = c.as_ref()[middle.wrapping_add_signed(m)];
        if negative { C::Element::element(-there.signal()) } else { there }
    })
}
