//! Which of the exact rotations from a quaternion is the cheapest: the one that `rotate` means.

use crate::families::family::{Does, Job};

/// What the cheapest exact rotation from a quaternion is taken for.
pub const FROM_QUATERNION: [Does; 3] =
    [Does::otherwise(Job::Tilt), Does::otherwise(Job::Zyz), Does::job(Job::Quaternion)];

/// Whether it is vector and tensor, for one channel or three; else it is z, y, z.
pub fn is_tensor(order: usize, rgb: bool) -> bool {
    order == 2 || (order == 3 && !rgb)
}
