//! Rotations on the hemisphere by way of the sphere: up to more spherical bands, an exact rotation there, and back (the first
//! method of Gautron et al. 2004); or as on the sphere that the hemisphere is stretched to, which takes the pole alone where
//! it should go (their equation 13). docs/MATH.md#rotation-on-the-hemisphere has what each errs by.

use crate::families::hemisphere::convert::{to_hemisphere, to_sphere};
use crate::families::hemisphere::evaluate::stretch;
use crate::families::parts::bands::{each_band, y_band, z_band};
use crate::families::parts::phases::{Phase, multiples, y_phases};
use crate::ir::graph::{Graph, Id};
use crate::math::hemisphere::Below;

/// About y, exactly, in spherical harmonics of an order.
pub fn by_the_sphere(g: &mut Graph, c: &[Id], spherical: usize, below: Below, beta: Phase) -> Vec<Id> {
    let lifted = to_sphere(g, c, spherical, below);
    let turned = about_y(g, &lifted, beta);
    to_hemisphere(g, &turned, c.len().isqrt())
}

/// About y, exactly, as if the coefficients were the sphere's.
pub fn about_y(g: &mut Graph, c: &[Id], beta: Phase) -> Vec<Id> {
    let order = c.len().isqrt();
    let beta = y_phases(g, beta, order - 1);
    each_band(g, c, order, |g, _, band| y_band(g, band, &beta))
}

/// Rz(α), a rotation about y, Rz(γ).
pub fn between_z(
    g: &mut Graph,
    c: &[Id],
    [alpha, gamma]: [Phase; 2],
    y: impl FnOnce(&mut Graph, &[Id]) -> Vec<Id>,
) -> Vec<Id> {
    let order = c.len().isqrt();
    let (alpha, gamma) = (multiples(g, alpha, order - 1), multiples(g, gamma, order - 1));
    let turned = each_band(g, c, order, |g, _, band| z_band(g, band, &gamma));
    let turned = y(g, &turned);
    each_band(g, &turned, order, |g, _, band| z_band(g, band, &alpha))
}

/// The angle acos(2 cos β − 1) by which the pole moves on the stretched sphere; its cosine is −1 from a right angle on.
pub fn stretched_angle(g: &mut Graph, beta: Phase) -> Phase {
    let [k, cos] = stretch(g, beta.cos);
    Phase { cos, sin: g.mul(k, beta.sin) }
}
