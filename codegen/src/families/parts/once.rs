//! A sum over the harmonics of order 2 or 3 at one direction, for one channel and with nothing prepared: 5 and 16 operations
//! (docs/MATH.md#evaluation-at-the-floor). Every operation is of the signal, so that channels would share none.

use crate::families::parts::columns::BandScale;
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// Returns Σ c_i y_i(dir) over 4 or 9 harmonics, each band of y scaled.
///
/// # Panics
///
/// If there are neither 4 nor 9 coefficients.
pub fn once(g: &mut Graph, [x, y, z]: [Id; 3], c: &[Id], scale: BandScale) -> Id {
    let factor = |l: usize, p: i64, q: i64| &(Exact::sqrt_ratio(p, q) * Exact::pi_sqrt_power(-1)) * &scale(l);
    let [up, x_part, y_part] = [(z, c[2]), (x, c[3]), (y, c[1])].map(|(axis, c)| (axis, c));
    let slope = g.mul(up.1, up.0);
    let slope = [x_part, y_part].into_iter().fold(slope, |sum, (axis, c)| {
        let product = g.mul(c, axis);
        g.sub(sum, product)
    });
    let flat = g.scale(&factor(0, 1, 4), c[0]);
    let linear = g.scale_add(&factor(1, 3, 4), slope, flat);
    match c.len() {
        4 => linear,
        9 => {
            let minus = |g: &mut Graph, sum: Id, axis: Id, c: Id| {
                let product = g.mul(c, axis);
                g.sub(sum, product)
            };
            // y (x c4 − z c5 − y c8) + z (z (√3/2 c6 − h) − x c7) + h − √3/6 c6, where h is half of c8.
            let half = g.scale(&Exact::ratio(1, 2), c[8]);
            let of_y = g.mul(c[4], x);
            let of_y = minus(g, of_y, z, c[5]);
            let of_y = minus(g, of_y, y, c[8]);
            let bend = g.neg(half);
            let bend = g.scale_add(&Exact::sqrt_ratio(3, 4), c[6], bend);
            let of_z = g.mul(bend, z);
            let of_z = minus(g, of_z, x, c[7]);
            let rest = g.scale_add(&-Exact::sqrt_ratio(1, 12), c[6], half);
            let rest = g.mul_add(of_z, z, rest);
            let quadratic = g.mul_add(of_y, y, rest);
            g.scale_add(&factor(2, 15, 4), quadratic, linear)
        }
        count => panic!("{count} coefficients are of neither order 2 nor 3"),
    }
}
