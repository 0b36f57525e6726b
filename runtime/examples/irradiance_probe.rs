//! An irradiance probe: the light of a sky is projected on nine coefficients a channel, becomes irradiance, is turned into
//! the frame of an object, and is looked up at the object's normals.
//!
//! `cargo run -p zonal --example irradiance_probe`

use glam::{Quat, Vec3};

/// The radiance of the zenith.
const ZENITH: Vec3 = Vec3::new(0.6, 0.8, 1.0);
/// What the ground reflects of the light that it gets.
const ALBEDO: Vec3 = Vec3::new(0.3, 0.2, 0.1);
/// How many rows of directions are looked at: the horizon is sharp.
const ROWS: usize = 100;

/// An overcast sky (Moon and Spencer 1942), three times as bright at the zenith as at the horizon, which lights the ground
/// with 7π/9 of the zenith's radiance.
fn radiance(dir: Vec3) -> Vec3 {
    match dir.z > 0.0 {
        true => ZENITH * (1.0 + 2.0 * dir.z) / 3.0,
        false => ZENITH * ALBEDO * 7.0 / 9.0,
    }
}

fn main() {
    let light: [Vec3; 9] = zonal::project::function(ROWS, |dir| radiance(Vec3::from_array(dir)));
    // A surface sums light over the hemisphere times the cosine.
    let irradiance = zonal::irradiance(&light);

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
