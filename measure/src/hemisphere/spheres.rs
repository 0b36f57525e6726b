//! Figure 4 of Habel and Wimmer 2010: one irradiance with the sun at a grazing angle in every basis, and what each is off by,
//! as spheres seen from above.

use super::bases::{Basis, H, HALF_LIFE, HSH, SH, ZERNIKE};
use super::grid::{global, hemisphere};
use super::matrix::Matrix;
use crate::raster::Raster;
use crate::significant;
use serde::{Deserialize, Serialize};
use zonal_codegen::environment::map::Map;
use zonal_picture::vector::{across, cross};

/// The name of the picture.
pub const NAME: &str = "irradiance_spheres.png";
/// How much larger differences are drawn.
pub const LARGER: f64 = 4.0;
/// The angle between the sun and the normal in degrees.
pub const SUN: f64 = 80.0;

/// The bases from left to right, after the truth.
const BASES: [(&str, &Basis, usize); 9] = [
    ("SH, order 3", &SH, 3),
    ("H6", &H, 3),
    ("Zernike, degrees to 2", &ZERNIKE, 3),
    ("HSH, order 3", &HSH, 3),
    ("SH, order 2", &SH, 2),
    ("H4", &H, 2),
    ("HSH, order 2", &HSH, 2),
    ("Zernike, degrees to 1", &ZERNIKE, 2),
    ("Half-Life 2", &HALF_LIFE, 1),
];
const BANDS: usize = 32;
const TILE: usize = 96;

/// What a basis errs by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sphere {
    /// The basis; spherical harmonics are the least-squares fit above the horizon.
    pub basis: String,
    /// Its number of coefficients.
    pub coefficients: usize,
    /// The root mean square of the error over the hemisphere, relative to the irradiance's, of all channels.
    pub rms: f64,
}

/// The coefficients of the best fit above the horizon, and the squares of its error and of the function.
fn fitted(basis: &Basis, order: usize, values: &[([f64; 3], f64, [f64; 3])]) -> ([Vec<f64>; 3], [f64; 2]) {
    let count = (basis.count)(order);
    let at: Vec<Vec<f64>> = values.iter().map(|(direction, _, _)| basis.at(order, *direction)).collect();
    let sum = |of: &dyn Fn(usize) -> f64| (0..values.len()).map(|node| values[node].1 * of(node)).sum::<f64>();
    let gram = Matrix::from_fn(count, count, |i, j| sum(&|node| at[node][i] * at[node][j]));
    let products = Matrix::from_fn(3, count, |channel, i| sum(&|node| values[node].2[channel] * at[node][i]));
    let fitted = products.over(&gram);
    let channels = [0, 1, 2].map(|channel| fitted.row(channel).to_vec());
    let value =
        |node: usize, channel: usize| -> f64 { at[node].iter().zip(&channels[channel]).map(|(b, c)| b * c).sum() };
    let squares = |of: &dyn Fn(usize, usize) -> f64| (0..3).map(|channel| sum(&|node| of(node, channel).powi(2))).sum();
    let error = squares(&|node, channel| value(node, channel) - values[node].2[channel]);
    let whole = squares(&|node, channel| values[node].2[channel]);
    (channels, [error, whole])
}

/// The figures and the picture, for a map whose brightest texel is its sun.
pub fn measure(map: &Map) -> (Vec<Sphere>, Raster) {
    let brightest = (0..map.texels.len())
        .max_by(|a, b| map.texels[*a].iter().sum::<f64>().total_cmp(&map.texels[*b].iter().sum()))
        .expect("a map has a texel");
    let sun = map.direction(brightest % map.width, brightest / map.width);
    // The normal leans from the sun towards the zenith; the sun stands over x.
    let (sin, cos) = SUN.to_radians().sin_cos();
    let up = across([0.0, 0.0, 1.0], sun);
    let normal = std::array::from_fn(|i| cos * sun[i] + sin * up[i]);
    let x = across(sun, normal);
    let frame = [x, cross(normal, x), normal];

    let light = map.project(BANDS).irradiance();
    let truth = |direction: [f64; 3]| light.evaluate(global(&frame, direction));
    let values: Vec<([f64; 3], f64, [f64; 3])> =
        hemisphere(24).into_iter().map(|(direction, weight)| (direction, weight, truth(direction))).collect();
    let fits = BASES.map(|(_, basis, order)| fitted(basis, order, &values));
    let spheres = BASES.iter().zip(&fits).map(|((name, basis, order), (_, [error, whole]))| Sphere {
        basis: (*name).to_owned(),
        coefficients: (basis.count)(*order),
        rms: significant((error / whole).sqrt()),
    });

    // White is the brightest irradiance.
    let white = values.iter().flat_map(|(_, _, value)| *value).fold(0.0, f64::max);
    let mut raster = Raster::new(NAME, [(BASES.len() + 1) * TILE, 2 * TILE]);
    for row in 0..TILE {
        for column in 0..TILE {
            let place = |i: usize| (2.0 * (i as f64 + 0.5) / TILE as f64 - 1.0) * 1.06;
            let (x, y) = (place(column), -place(row));
            if x * x + y * y >= 1.0 {
                continue;
            }
            let direction = [x, y, (1.0 - x * x - y * y).sqrt()];
            let want = truth(direction).map(|value| value / white);
            raster.set([column, row], want);
            for (i, ((_, basis, order), (channels, _))) in BASES.iter().zip(&fits).enumerate() {
                let at = basis.at(*order, direction);
                let got = channels.each_ref().map(|c| at.iter().zip(c).map(|(b, c)| b * c).sum::<f64>() / white);
                let left = (i + 1) * TILE + column;
                raster.set([left, row], got);
                raster.set([left, TILE + row], std::array::from_fn(|k| LARGER * (got[k] - want[k]).abs()));
            }
        }
    }
    (spheres.collect(), raster)
}
