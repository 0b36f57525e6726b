//! An irradiance probe: the light of a sky is summed into nine coefficients a channel, becomes irradiance, is turned into
//! the frame of an object, and is looked up at the object's normals.
//!
//! `cargo run -p zonal --example irradiance_probe`

use std::f32::consts::PI;

use zonal::glam::{Quat, Vec3};

/// The radiance of the zenith.
const ZENITH: Vec3 = Vec3::new(0.6, 0.8, 1.0);
/// What the ground reflects of the light that it gets.
const ALBEDO: Vec3 = Vec3::new(0.3, 0.2, 0.1);
/// How many directions are summed.
const COUNT: usize = 20_000;

/// An overcast sky (Moon and Spencer 1942), three times as bright at the zenith as at the horizon, which lights the ground
/// with 7π/9 of the zenith's radiance.
fn radiance(dir: Vec3) -> Vec3 {
    match dir.z > 0.0 {
        true => ZENITH * (1.0 + 2.0 * dir.z) / 3.0,
        false => ZENITH * ALBEDO * 7.0 / 9.0,
    }
}

/// Directions spread evenly over the sphere, on a spiral.
fn directions() -> impl Iterator<Item = Vec3> {
    (0..COUNT).map(|i| {
        let z = 1.0 - (2 * i + 1) as f32 / COUNT as f32;
        let azimuth = (i as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt())).rem_euclid(std::f64::consts::TAU) as f32;
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
    })
}

fn main() {
    // Each direction adds its radiance times the harmonics there, times its share of the sphere.
    let mut light = [Vec3::ZERO; 9];
    for dir in directions() {
        let harmonics: [f32; 9] = zonal::evaluate_basis(dir);
        let seen = radiance(dir) * (4.0 * PI / COUNT as f32);
        for (sum, harmonic) in light.iter_mut().zip(harmonics) {
            *sum += seen * harmonic;
        }
    }

    // A surface sums light over the hemisphere times the cosine: π, 2π/3 and π/4 times the bands 0, 1 and 2.
    let mut irradiance = light;
    for (place, sum) in irradiance.iter_mut().enumerate() {
        *sum *= [PI, 2.0 * PI / 3.0, PI / 4.0][place.isqrt()];
    }

    // In the frame of an object that was turned by `turn` the world is turned back.
    let turn = Quat::from_rotation_x(1.0) * Quat::from_rotation_z(0.5);
    let own = zonal::rotate(turn.inverse(), &irradiance);

    println!("normal in the world    irradiance               in the frame of the object");
    for normal in [Vec3::Z, Vec3::X, Vec3::new(0.0, 0.6, 0.8), Vec3::NEG_Z] {
        let (world, object) = (zonal::evaluate(normal, &irradiance), zonal::evaluate(turn.inverse() * normal, &own));
        let row = |v: Vec3| format!("{:7.4} {:7.4} {:7.4}", v.x, v.y, v.z);
        println!("{:4.1} {:4.1} {:4.1}     {}  {}", normal.x, normal.y, normal.z, row(world), row(object));
    }
}
