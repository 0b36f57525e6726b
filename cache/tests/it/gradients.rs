//! The derivatives of a record: none for constant radiance on a closed surface, and those of central differences.

use std::f64::consts::PI;
use zonal_cache::basis::{Basis, HSH6, HSH10, SH6, SH10};
use zonal_cache::gradient::share;
use zonal_cache::record::Sums;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_picture::vector::{add, dot, length};

/// Half of the hemisphere's axes of the ellipsoid around the point.
const AXES: [f64; 3] = [2.0, 1.5, 1.2];

/// Where a ray leaves the ellipsoid: how far, and the normal there, inwards.
fn wall(from: [f64; 3], direction: [f64; 3]) -> (f64, [f64; 3]) {
    let scaled = |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| v[k] / AXES[k]) };
    let (p, d) = (scaled(from), scaled(direction));
    let (a, b, c) = (dot(d, d), dot(p, d), dot(p, p) - 1.0);
    let distance = (-b + (b * b - a * c).sqrt()) / a;
    let at = scaled(scaled(add(from, distance, direction)));
    let size = length(at);
    (distance, at.map(|x| -x / size))
}

/// A record at a point whose frame is the world's, by quadrature; the square of a variable for the height keeps odd orders of
/// hemispherical harmonics smooth at the horizon.
fn record<const C: usize>(basis: &Basis<C>, from: [f64; 3], radiance: fn([f64; 3]) -> [f64; 3]) -> Sums<C> {
    const AZIMUTHS: usize = 96;
    let mut sums = Sums::default();
    for (t, weight) in gauss_legendre(48, 0.0, 1.0) {
        let z = t * t;
        let radius = (1.0 - z * z).sqrt();
        for k in 0..AZIMUTHS {
            let (y, x) = (2.0 * PI * k as f64 / AZIMUTHS as f64).sin_cos();
            let direction = [radius * x, radius * y, z];
            let (distance, normal) = wall(from, direction);
            let share = weight * 2.0 * t * 2.0 * PI / AZIMUTHS as f64;
            let light = radiance(add(from, distance, direction)).map(|x| x * share);
            sums.sample(basis, direction, distance, normal, light);
        }
    }
    sums
}

fn differ<const C: usize>(basis: &Basis<C>) {
    let light = |p: [f64; 3]| [1.0 + 0.4 * p[0] + 0.3 * p[1] * p[2], 0.5 + 0.2 * p[2] * p[0], p[2] + 0.1 * p[1]];
    let (from, h) = ([0.4, -0.3, 0.1], 1e-3);
    let found = record(basis, from, light);
    for e in 0..2 {
        let moved = |s: f64| {
            let mut at = from;
            at[e] += s * h;
            record(basis, at, light).light
        };
        let at = [-2.0, -1.0, 1.0, 2.0].map(moved);
        for i in 0..C {
            for k in 0..3 {
                // Five points: what is left is h⁴ times the fifth derivative, some thousands.
                let [a, b, c, d] = [0, 1, 2, 3].map(|j| at[j][k][i]);
                let wanted = (8.0 * (c - b) - (d - a)) / (12.0 * h);
                let slope = found.slopes[e][k][i];
                assert!((slope - wanted).abs() < 1e-6, "{}{} {i} {e}: {slope} {wanted}", basis.name, basis.order);
            }
        }
    }
    // It is not zero everywhere.
    assert!(found.slopes[0].as_flattened().iter().any(|x| x.abs() > 0.1));
}

fn close<const C: usize>(basis: &Basis<C>) {
    let found = record(basis, [0.4, -0.3, 0.1], |_| [1.0; 3]);
    for slope in found.slopes.as_flattened().as_flattened() {
        // What the quadrature errs by; the terms that cancel are of the size of one.
        assert!(slope.abs() < 1e-6, "{}{}: {slope}", basis.name, basis.order);
    }
    assert!(found.light[0][0] > 1.0);
}

#[test]
fn derivatives_are_those_of_central_differences() {
    differ(&SH6);
    differ(&HSH6);
    differ(&SH10);
    differ(&HSH10);
}

#[test]
fn constant_radiance_on_a_closed_surface_does_not_change() {
    close(&SH6);
    close(&HSH6);
    close(&SH10);
    close(&HSH10);
}

/// `hsh_gradient`, which is written by hand, and the derivative of the basis by itself are one, at grazing hits too.
#[test]
fn what_a_basis_makes_of_itself_is_what_its_kernel_says() {
    let mut random = Random::new(9);
    for i in 0..200 {
        let [x, y, z] = random.unit::<3>();
        let (direction, distance) = ([x, y, z.abs()], 0.5 + f64::from(i) / 20.0);
        let normal = random.unit::<3>();
        let share = share(HSH6.moving, direction, distance, normal);
        for (e, along) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].into_iter().enumerate() {
            let kernel = zonal::sh6::hsh_gradient(direction, along, distance, normal, 1.0);
            for (found, wanted) in share.slopes[e].iter().zip(kernel) {
                // Some hundred roundings of numbers up to some hundreds.
                assert!((found - wanted).abs() < 1e-11, "{direction:?} {normal:?}: {found} {wanted}");
            }
        }
    }
}
