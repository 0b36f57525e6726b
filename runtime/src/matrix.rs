//! The quaternion of a rotation matrix, for kernels that take no matrix.

use crate::scalar::Scalar;

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
