//! A rotation made ready for many signals: the set-up that every signal shares is done once. And the quaternion of a
//! rotation matrix.

use crate::coefficients::Coefficients;
use crate::scalar::Scalar;

/// A rotation of one order and precision with its set-up done: the multiples of its three angles.
///
/// `C` names the order and the precision; how many channels a signal has is open until [`apply`](Self::apply).
/// Making it costs what `angles:n` costs in [`costs`](crate::costs), applying it what `rotate:n:angles` does: less than
/// [`rotate`](crate::rotate), the more so the lower the order.
///
/// ```
/// let turn = zonal::Rotation::<[f32; 25]>::new([0.28, 0.0, 0.0, 0.96]);
/// let visibility = turn.apply(&[1.0_f32; 25]);
/// let radiance = turn.apply(&[[1.0_f32; 3]; 25]);
/// assert_eq!(visibility, radiance.map(|c| c[0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation<C: Coefficients> {
    angles: C::Angles,
}

impl<C: Coefficients> Rotation<C> {
    /// Returns the rotation of a unit quaternion (x, y, z, w); see the [crate](crate#input-that-is-not-unit) for one that
    /// is not.
    #[inline]
    pub fn new(q: impl Into<[C::Scalar; 4]>) -> Self {
        Self { angles: C::angles(q.into()) }
    }

    /// Returns the rotation of a rotation matrix, given by its columns, by way of its quaternion.
    #[inline]
    pub fn from_matrix(columns: impl Into<[[C::Scalar; 3]; 3]>) -> Self {
        Self::new(quaternion(columns.into()))
    }

    /// Rotates a signal of this order and precision, of any number of channels: the result at R ω is `c` at ω.
    #[inline]
    pub fn apply<D: Coefficients<Angles = C::Angles>>(&self, c: &D) -> D {
        D::rotate_angles(&self.angles, c)
    }
}

/// Returns the quaternion (x, y, z, w) of a rotation matrix of these columns: the largest of the four squares on the
/// diagonal is what the others are found from (Shepperd 1978).
pub(crate) fn quaternion<T: Scalar>([x, y, z]: [[T; 3]; 3]) -> [T; 4] {
    let one = T::lit(1.0);
    let squares =
        [one + x[0] - y[1] - z[2], one - x[0] + y[1] - z[2], one - x[0] - y[1] + z[2], one + x[0] + y[1] + z[2]];
    let [by_x, by_y, by_z] = [y[2] - z[1], z[0] - x[2], x[1] - y[0]];
    let [xy, yz, zx] = [y[0] + x[1], z[1] + y[2], x[2] + z[0]];
    let rows = [
        [squares[0], xy, zx, by_x],
        [xy, squares[1], yz, by_y],
        [zx, yz, squares[2], by_z],
        [by_x, by_y, by_z, squares[3]],
    ];
    let mut largest = 3;
    for place in 0..3 {
        if squares[place] > squares[largest] {
            largest = place;
        }
    }
    let scale = squares[largest].rsqrt() * T::lit(0.5);
    rows[largest].map(|number| number * scale)
}
