//! A rotation made ready for many signals: the set-up that every signal shares is done once.

use crate::coefficients::{Coefficients, Scalar};

/// A rotation of one order and precision with its set-up done: the multiples of its three angles.
///
/// `C` names the order and the precision; how many channels a signal has is open until [`apply`](Self::apply).
/// Making it costs what `angles:n` costs in [`costs`](crate::costs), applying it what `rotate:n:angles` does: less than
/// [`rotate`](crate::rotate), the more so the lower the order.
///
/// ```
/// use glam::{Quat, Vec3};
///
/// let turn = zonal::Rotation::<[f32; 25]>::new(Quat::from_rotation_x(0.3));
/// let visibility = turn.apply(&[1.0_f32; 25]);
/// let radiance = turn.apply(&[Vec3::ONE; 25]);
/// assert_eq!(visibility, radiance.map(|c| c.x));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation<C: Coefficients> {
    angles: C::Angles,
}

impl<C: Coefficients> Rotation<C> {
    /// The rotation of a unit quaternion; see the [crate](crate#input-that-is-not-unit) for one that is not.
    #[inline]
    pub fn new(q: C::Quat) -> Self {
        Self { angles: C::angles(C::Scalar::quaternion(q)) }
    }

    /// The rotation of a rotation matrix, by way of its quaternion.
    #[inline]
    pub fn from_matrix(m: C::Mat3) -> Self {
        Self::new(C::Scalar::of_matrix(m))
    }

    /// Rotates a signal of this order and precision, of any number of channels: the result at R ω is `c` at ω.
    #[inline]
    pub fn apply<D: Coefficients<Angles = C::Angles>>(&self, c: &D) -> D {
        D::rotate_angles(&self.angles, c)
    }
}
