//! Directions of the texels of images, with the solid angles that they see, and a grid of directions that integrates
//! exactly (docs/MATH.md#grids-and-cubemaps). All in f64.

use core::f64::consts::PI;

use zonal_kernels::real::Real;

use crate::scalar::{Scalar, atan2};

/// The direction at a height and an azimuth, which runs from x to y.
fn at(z: f64, azimuth: f64) -> [f64; 3] {
    let (radius, (sin, cos)) = (((1.0 - z) * (1.0 + z)).root(), Scalar::sin_cos(azimuth));
    [radius * cos, radius * sin, z]
}

/// Returns the direction of the centre of a texel of a latitude-longitude image: z up, the centre of the image along x,
/// −y to the right of it.
pub(crate) fn direction(height: usize, width: usize, row: usize, column: usize) -> [f64; 3] {
    let (sin, z) = Scalar::sin_cos(PI * (row as f64 + 0.5) / height as f64);
    let (y, x) = Scalar::sin_cos(PI - 2.0 * PI * (column as f64 + 0.5) / width as f64);
    [sin * x, sin * y, z]
}

/// Returns the solid angle of a texel of a row of a latitude-longitude image; those of all texels are 4π.
pub(crate) fn solid_angle(height: usize, width: usize, row: usize) -> f64 {
    let half = PI / (2 * height) as f64;
    let (middle, half) = (Scalar::sin_cos((2 * row + 1) as f64 * half).0, Scalar::sin_cos(half).0);
    4.0 * PI / width as f64 * middle * half
}

/// Returns the direction of the centre of a texel of a cubemap, by which a shader samples it, and its solid angle. The
/// columns run to the right and the rows down, in the face as it lies in memory.
pub(crate) fn of_cube(face: usize, size: usize, row: usize, column: usize) -> ([f64; 3], f64) {
    let edge = |place: usize| 2.0 * place as f64 / size as f64 - 1.0;
    let centre = |place: usize| (2 * place + 1) as f64 / size as f64 - 1.0;
    let (s, t) = (centre(column), centre(row));
    let [x, y, z] = match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    };
    let scale = (x * x + y * y + z * z).rsqrt();
    // What is seen of a rectangle from the middle of the face to (x, y).
    let seen = |x: f64, y: f64| atan2(x * y, (x * x + y * y + 1.0).root());
    let [[left, right], [top, bottom]] = [column, row].map(|place| [edge(place), edge(place + 1)]);
    let angle = seen(left, top) - seen(left, bottom) - seen(right, top) + seen(right, bottom);
    ([x * scale, y * scale, z * scale], angle)
}

/// Returns a zero of the Legendre polynomial of degree `count`, the `place`-th from 1 down, and its weight; the weights of
/// all zeros are 2. Newton's method doubles the digits of an estimate that has three.
pub(crate) fn gauss(count: usize, place: usize) -> (f64, f64) {
    let mut z = Scalar::sin_cos(PI * (place as f64 + 0.75) / (count as f64 + 0.5)).1;
    let mut slope = 0.0;
    for _ in 0..5 {
        let (mut before, mut value) = (1.0, z);
        for l in 2..=count {
            let l = l as f64;
            (before, value) = (value, ((2.0 * l - 1.0) * z * value - (l - 1.0) * before) / l);
        }
        slope = count as f64 * (before - z * value) / ((1.0 - z) * (1.0 + z));
        z -= value / slope;
    }
    (z, 2.0 / ((1.0 - z) * (1.0 + z) * slope * slope))
}

/// Returns the directions of a row of the grid of `rows` rows and twice as many columns, and the weight of each; those of
/// all are 4π. The grid integrates all products of harmonics whose bands add up to less than twice its rows.
pub(crate) fn exact(rows: usize, row: usize) -> (impl Iterator<Item = [f64; 3]>, f64) {
    let ((z, weight), columns) = (gauss(rows, row), 2 * rows);
    let azimuth = move |column: usize| 2.0 * PI * (column as f64 + 0.5) / columns as f64;
    ((0..columns).map(move |column| at(z, azimuth(column))), weight * 2.0 * PI / columns as f64)
}
