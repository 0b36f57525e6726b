//! Where a coefficient lies: band l, degree m in -l..=l, at index l(l+1)+m. An order n has the bands 0..n-1 and n²
//! coefficients.

use std::ops::{Range, RangeInclusive};

/// The index l(l+1)+m of degree `m` in band `l`, -l ≤ m ≤ l.
///
/// ```
/// assert_eq!(zonal_codegen::math::index::index(2, -2), 4);
/// ```
pub fn index(l: usize, m: isize) -> usize {
    debug_assert!(m.unsigned_abs() <= l, "degree {m} in band {l}");
    (l * (l + 1)).wrapping_add_signed(m)
}

/// The band and the degree of an index: the inverse of [`index`].
pub fn band_degree(i: usize) -> (usize, isize) {
    let l = i.isqrt();
    (l, i as isize - (l * (l + 1)) as isize)
}

/// The degrees of band `l`, rising.
pub fn degrees(l: usize) -> RangeInclusive<isize> {
    -(l as isize)..=l as isize
}

/// The indices of band `l`.
pub fn band(l: usize) -> Range<usize> {
    l * l..(l + 1) * (l + 1)
}

/// Every (band, degree) of an order, by index.
pub fn coefficients(order: usize) -> impl Iterator<Item = (usize, isize)> {
    (0..order).flat_map(|l| degrees(l).map(move |m| (l, m)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_up() {
        for (i, (l, m)) in coefficients(12).enumerate() {
            assert_eq!(index(l, m), i);
            assert_eq!(band_degree(i), (l, m));
            assert!(band(l).contains(&i));
        }
        assert_eq!(coefficients(12).count(), 144);
    }
}
