//! How the coefficients of a record change where it is moved in its tangent plane, by the exact derivative and not by a
//! difference (docs/MATH.md#translational-gradients). The basis's own kernel makes both derivatives of any basis and order at
//! once; what a shader takes for hemispherical harmonics, `hsh_gradient`, is one direction of the same.

use crate::dual::Dual;
// Names a family: hits are seen as grazing as its kernel takes them, and the tests hold this to it.
use zonal_codegen::families::hemisphere::gradient::GRAZING;
use zonal_picture::vector::dot;

/// What a sample adds for each unit of its radiance and of its solid angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share<const C: usize> {
    /// The harmonics.
    pub values: [f64; C],
    /// Their derivatives along x and y of the frame, the solid angle's included.
    pub slopes: [[f64; C]; 2],
}

/// Returns what a sample adds: `direction` is its direction in the frame, `distance` how far what is hit is away, `normal` its
/// unit normal in the frame, on the side that is seen, `harmonics` the kernel of the basis.
///
/// Of a point in its frame, moved by e, the direction ω to what is hit moves by −(e − (ω·e) ω)/r, and the solid angle grows by
/// (3 ω·e + m·e / cos ξ)/r: ∂λ = ∫ L (−∇H·e/r + H (3 ω·e + m·e / cos ξ)/r) dω.
pub fn share<const C: usize>(
    harmonics: fn([Dual; 3]) -> [Dual; C],
    direction: [f64; 3],
    distance: f64,
    normal: [f64; 3],
) -> Share<C> {
    let [least, of] = GRAZING;
    let cosine = (-dot(normal, direction)).max(least as f64 / of as f64);
    let moved = |k: usize, e: usize| {
        let along = if k == e { 1.0 } else { 0.0 };
        (direction[e] * direction[k] - along) / distance
    };
    let seen = std::array::from_fn(|k| Dual { value: direction[k], slopes: [moved(k, 0), moved(k, 1)] });
    let found = harmonics(seen);
    let angle = [0, 1].map(|e| (3.0 * direction[e] + normal[e] / cosine) / distance);
    Share { values: found.map(|h| h.value), slopes: [0, 1].map(|e| found.map(|h| h.slopes[e] + h.value * angle[e])) }
}
