//! A rotation made ready for many signals: the set-up that every signal shares is done once.

use crate::coefficients::Coefficients;
use crate::matrix::quaternion;

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
