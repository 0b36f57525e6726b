//! A unit quaternion (x, y, z, w) as what turns vectors.

use crate::families::parts::sums::cross;
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// The rows of a unit quaternion's matrix: 17 operations.
pub fn matrix_of_quaternion(g: &mut Graph, q: &[Id]) -> [[Id; 3]; 3] {
    let [x, y, z, w] = [q[0], q[1], q[2], q[3]];
    let [x2, y2, z2] = [x, y, z].map(|v| g.scale(&Exact::int(2), v));
    let one = g.constant(Exact::one());
    let (xx, yy, zz) = (g.mul(x, x2), g.mul(y, y2), g.mul(z, z2));
    let no_z = g.sub(one, zz);
    let no_x = g.sub(one, xx);
    let (xy, xz, yz) = (g.mul(x, y2), g.mul(x, z2), g.mul(y, z2));
    let (wx, wy, wz) = (g.mul(w, x2), g.mul(w, y2), g.mul(w, z2));
    [
        [g.sub(no_z, yy), g.sub(xy, wz), g.add(xz, wy)],
        [g.add(xy, wz), g.sub(no_z, xx), g.sub(yz, wx)],
        [g.sub(xz, wy), g.add(yz, wx), g.sub(no_x, yy)],
    ]
}

/// Returns the vector `v` turned: v + w t + q × t with t = 2 q × v, 18 operations.
pub fn turned(g: &mut Graph, q: &[Id], v: [Id; 3]) -> [Id; 3] {
    let axis = [q[0], q[1], q[2]];
    let twice = axis.map(|a| g.scale(&Exact::int(2), a));
    let t = cross(g, twice, v);
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sum = g.mul_add(t[i], q[3], v[i]);
        let sum = g.mul_add(t[k], axis[j], sum);
        let minus = g.mul(t[j], axis[k]);
        g.sub(sum, minus)
    })
}
