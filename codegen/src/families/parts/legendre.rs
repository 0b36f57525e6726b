//! Legendre polynomials of one value, each divided by its leading coefficient, which saves an operation a band.

use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// Returns P_l(x) / [`leading`] for l below `order`: p_(l+1) = x p_l − l² / (4l² − 1) p_(l−1), two operations each from p_3 on.
pub fn monic(g: &mut Graph, x: Id, order: usize) -> Vec<Id> {
    let one = g.constant(Exact::one());
    let mut all = vec![one, x];
    for l in 1..order as i64 - 1 {
        let place = l as usize;
        let back = g.scale(&-Exact::ratio(l * l, 4 * l * l - 1), all[place - 1]);
        all.push(g.mul_add(x, all[place], back));
    }
    all.truncate(order);
    all
}

/// Returns the leading coefficient of P_l.
pub fn leading(l: usize) -> Exact {
    (0..l as i64).fold(Exact::one(), |product, k| product * Exact::ratio(2 * k + 1, k + 1))
}
