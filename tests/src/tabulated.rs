//! Files of tabulated reflectances, written by what their layouts say and by nothing that reads them.

use exr::prelude::*;
use std::f64::consts::{PI, TAU};
use std::io::Cursor;

/// Entries of MERL's layout along half angle, difference angle and azimuth.
pub const SIZE: [usize; 3] = [90, 90, 180];

fn turned_about_y([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [cos * x + sin * z, y, cos * z - sin * x]
}

fn polar(angle: f64, azimuth: f64) -> [f64; 3] {
    [angle.sin() * azimuth.cos(), angle.sin() * azimuth.sin(), angle.cos()]
}

/// A file in MERL's layout of what a function says of view and light in R, G and B; directions below the horizon are missing.
pub fn merl(of: impl Fn([f64; 3], [f64; 3]) -> [f64; 3]) -> Vec<u8> {
    let [halves, differences, azimuths] = SIZE;
    let mut values = Vec::new();
    for i in 0..halves * differences * azimuths {
        let share = (i / (differences * azimuths)) as f64 / 90.0;
        let half_angle = PI / 2.0 * share * share;
        let light = polar(((i / azimuths % differences) as f64).to_radians(), ((i % azimuths) as f64).to_radians());
        let light = turned_about_y(light, half_angle);
        // The view is the light mirrored at the half vector.
        let half = polar(half_angle, 0.0);
        let along: f64 = 2.0 * (0..3).map(|k| half[k] * light[k]).sum::<f64>();
        let view = [0, 1, 2].map(|k| along * half[k] - light[k]);
        values.push(if view[2] > 0.0 && light[2] > 0.0 { of(view, light) } else { [-1.0; 3] });
    }
    let mut bytes = SIZE.map(|side| (side as i32).to_le_bytes()).concat();
    for (channel, scale) in [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0].into_iter().enumerate() {
        bytes.extend(values.iter().flat_map(|value| (value[channel] / scale).to_le_bytes()));
    }
    bytes
}

/// The directions of a grid: elevations from the normal to the horizon, azimuths from x towards y, the azimuths fastest.
pub fn grid(elevations: usize, azimuths: usize) -> Vec<[f64; 3]> {
    let elevation = |e: usize| PI / 2.0 * e as f64 / (elevations - 1) as f64;
    let of = |e: usize| (0..azimuths).map(move |a| polar(elevation(e), TAU * a as f64 / azimuths as f64));
    (0..elevations).flat_map(of).collect()
}

/// An image of pairs of directions of what a function says of view and light.
pub fn pairs(elevations: usize, of: impl Fn([f64; 3], [f64; 3]) -> [f64; 3] + Sync) -> Vec<u8> {
    let directions = grid(elevations, 4 * (elevations - 1));
    let side = directions.len();
    let channels = SpecificChannels::rgb(|place: Vec2<usize>| {
        let [r, g, b] = of(directions[place.y()], directions[place.x()]).map(|x| x as f32);
        (r, g, b)
    });
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_encoded_channels((side, side), Encoding::UNCOMPRESSED, channels);
    image.write().to_buffered(&mut bytes).expect("memory takes any image");
    bytes.into_inner()
}

/// An array of f32 as NumPy saves it.
pub fn array(shape: &[usize], values: &[f32]) -> Vec<u8> {
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    let head = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}\n", sides.join(", "));
    let length = (head.len() as u16).to_le_bytes();
    let mut bytes = [&b"\x93NUMPY\x01\x00"[..], &length, head.as_bytes()].concat();
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}
