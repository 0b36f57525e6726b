//! Transfer: visibility times the reflectance times the cosine for one view, as coefficients in the frame of each point and in
//! the axes of the object. It knows no kernel.

use crate::field::ground::Ground;
use rayon::prelude::*;
use std::f64::consts::PI;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_picture::vector::{across, add, cross, dot};

/// How many azimuths are looked in.
const AZIMUTHS: usize = 32;
/// How many elevations, from the horizon up.
const ELEVATIONS: usize = 10;

/// The transfer of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// In the frame of the point, which the shortest rotation takes from the world's: n² numbers.
    pub local: Vec<f64>,
    /// In the axes of the object.
    pub object: Vec<f64>,
    /// The view's direction in the frame of the point.
    pub view: [f64; 3],
}

/// Returns the axes of the frame of a normal that is above the horizon: those to which the shortest rotation takes x, y and z.
pub fn axes(normal: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = normal;
    let mixed = -x * y / (1.0 + z);
    [[1.0 - x * x / (1.0 + z), mixed, -x], [mixed, 1.0 - y * y / (1.0 + z), -y], normal]
}

/// Returns the transfer of points of a field at an order, for a view from afar.
pub fn bake(ground: &Ground, points: &[usize], brdf: &Brdf, view: [f64; 3], order: usize) -> Vec<Transfer> {
    let count = order * order;
    let one = |&point: &usize| {
        let axes = axes(ground.normal(point));
        let inside = |v: [f64; 3]| axes.map(|axis| dot(axis, v));
        let seen = inside(view);
        let (mut local, mut object, mut values) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for k in 0..AZIMUTHS {
            let azimuth = 2.0 * PI * (k as f64 + 0.5) / AZIMUTHS as f64;
            let (sin, cos) = azimuth.sin_cos();
            for (z, weight) in gauss_legendre(ELEVATIONS, ground.horizon(point, azimuth), 1.0) {
                let radius = (1.0 - z * z).max(0.0).sqrt();
                let direction = [radius * cos, radius * sin, z];
                let own = inside(direction);
                let share = brdf.value(seen, own) * weight * 2.0 * PI / AZIMUTHS as f64;
                if share != 0.0 {
                    for (sums, direction) in [(&mut local, own), (&mut object, direction)] {
                        basis(order, direction, &mut values);
                        sums.iter_mut().zip(&values).for_each(|(sum, y)| *sum += share * y);
                    }
                }
            }
        }
        Transfer { local, object, view: seen }
    };
    points.par_iter().map(one).collect()
}

/// How little of a transfer is kept in the frame of the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// What is symmetric to the plane of normal and view: n (n + 1)/2 numbers.
    Symmetric,
    /// What is the same all around the normal: n numbers.
    Isotropic,
}

impl Transfer {
    /// Returns the transfer in the frame of the point with only a part kept.
    pub fn kept(&self, kept: Kept) -> Vec<f64> {
        let order = self.local.len().isqrt();
        let [x, y, _] = across(self.view, [0.0, 0.0, 1.0]);
        // The cosines and sines of multiples of the view's azimuth.
        let (mut cos, mut sin) = (1.0, 0.0);
        let mut out = self.local.clone();
        for m in 1..order {
            (cos, sin) = (cos * x - sin * y, sin * x + cos * y);
            for l in m..order {
                let (plus, minus) = (l * (l + 1) + m, l * (l + 1) - m);
                // Along the wave that is even about the view's azimuth.
                let even = match kept {
                    Kept::Symmetric => cos * out[plus] + sin * out[minus],
                    Kept::Isotropic => 0.0,
                };
                (out[plus], out[minus]) = (even * cos, even * sin);
            }
        }
        out
    }
}

/// Returns a direction of a frame in the world.
pub fn world(axes: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    add(add(axes[0].map(|x| x * v[0]), v[1], axes[1]), v[2], axes[2])
}

/// Returns whether axes are at right angles and right-handed, to rounding.
pub fn are_axes(axes: &[[f64; 3]; 3]) -> bool {
    let third = cross(axes[0], axes[1]);
    (0..3).all(|i| (third[i] - axes[2][i]).abs() < 1e-12) && (dot(axes[0], axes[0]) - 1.0).abs() < 1e-12
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_is_the_same_function_in_both_frames() {
        let ground = Ground::new(5, 32);
        let (brdf, order) = (Brdf::Phong { exponent: 8.0 }, 5);
        let points = [100, 400, 777];
        for (point, transfer) in points.into_iter().zip(bake(&ground, &points, &brdf, [0.28, -0.1, 0.95], order)) {
            let axes = axes(ground.normal(point));
            assert!(are_axes(&axes));
            let mut values = vec![0.0; order * order];
            let mut at = |c: &[f64], direction: [f64; 3]| {
                basis(order, direction, &mut values);
                values.iter().zip(c).map(|(y, c)| y * c).sum::<f64>()
            };
            for direction in [[0.6, 0.0, 0.8], [0.0, -0.8, 0.6], [0.48, 0.6, 0.64]] {
                let (own, object) = (at(&transfer.local, direction), at(&transfer.object, world(&axes, direction)));
                assert!((own - object).abs() < 1e-12, "{own} {object}");
            }
        }
    }

    #[test]
    fn a_reflectance_alone_is_symmetric_and_lamberts_is_isotropic() {
        // Flat ground hides nothing.
        let ground = Ground::new(1, 4).levelled();
        let view = [0.48, 0.36, 0.8];
        let of = |brdf: Brdf| bake(&ground, &[5], &brdf, view, 4).remove(0);
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let glossy = of(Brdf::Phong { exponent: 4.0 });
        // By 32 azimuths, which are not those of the view.
        assert!(apart(&glossy.kept(Kept::Symmetric), &glossy.local) < 1e-6);
        assert!(apart(&glossy.kept(Kept::Isotropic), &glossy.local) > 1e-2);
        let matte = of(Brdf::Lambert);
        assert!(apart(&matte.kept(Kept::Isotropic), &matte.local) < 1e-12);
    }
}
