//! Light of environment maps in hemispherical harmonics of order n, made from N bands of the sphere by C: how far it is from
//! the coefficients of the map's own texels above the horizon, in seeded frames.

use super::bases::{HSH, SH};
use super::grid::{frames, local};
use super::matrix::{Matrix, relative};
use super::rotation::FRAMES;
use super::turn::conversion;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::environment::map::Map;

/// The hemispherical orders.
pub const ORDERS: [usize; 7] = [2, 3, 4, 5, 6, 8, 10];
/// A number of bands of the sphere by the hemispherical order, as it is written and as it is.
pub type Bands = (&'static str, fn(order: usize) -> usize);
/// The numbers of bands of the sphere that an order is made from.
pub const SPHERES: [Bands; 3] = [("n", |n| n), ("n + 2", |n| n + 2), ("2n", |n| 2 * n)];

const LARGEST: [usize; 2] = [10, 20];
const SEED: u64 = 0x11e7;

/// The errors at an order from a number of bands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// The hemispherical order.
    pub order: usize,
    /// The spherical order.
    pub sphere: usize,
    /// For each map, in the order of their names, the root of the summed squares of the errors in its frames, relative to
    /// that of the light's.
    pub maps: Vec<f64>,
}

impl Light {
    /// The mean over the maps.
    pub fn mean(&self) -> f64 {
        self.maps.iter().sum::<f64>() / self.maps.len() as f64
    }
}

/// A map's luminance in a frame: in harmonics of the sphere, and of the hemisphere by its texels.
fn seen(map: &Map, frame: &[[f64; 3]; 3]) -> [Vec<f64>; 2] {
    let mut sums = LARGEST.map(|order| vec![0.0; order * order]);
    let mut values = LARGEST.map(|order| vec![0.0; order * order]);
    for y in 0..map.height {
        for x in 0..map.width {
            let [red, green, blue] = map.texels[y * map.width + x];
            let light = map.solid_angle(x, y) * (0.2126 * red + 0.7152 * green + 0.0722 * blue);
            let direction = local(frame, map.direction(x, y));
            for (place, basis) in [&HSH, &SH].into_iter().enumerate() {
                if place == 0 && direction[2] <= 0.0 {
                    continue;
                }
                (basis.values)(LARGEST[place], direction, &mut values[place]);
                sums[place].iter_mut().zip(&values[place]).for_each(|(sum, value)| *sum += light * value);
            }
        }
    }
    let [hemisphere, sphere] = sums;
    [sphere, hemisphere]
}

/// Every order from every number of bands.
pub fn measure(progress: &dyn Progress, maps: &[Map]) -> Vec<Light> {
    let tasks: Vec<(usize, [[f64; 3]; 3])> = (0..maps.len())
        .flat_map(|map| frames(SEED + map as u64, FRAMES[0]).into_iter().map(move |frame| (map, frame)))
        .collect();
    let lights = each(progress, "light on the hemisphere", &tasks, |(map, frame)| seen(&maps[*map], frame));
    let pairs = ORDERS.into_iter().flat_map(|order| SPHERES.map(|(_, of)| (order, of(order))));
    pairs
        .map(|(order, sphere)| {
            let conversion: Matrix = conversion(order, sphere);
            let of = |[whole, truth]: &[Vec<f64>; 2]| {
                (conversion.apply(&whole[..sphere * sphere]), truth[..order * order].to_vec())
            };
            let error = |lights: &[[Vec<f64>; 2]]| {
                let (got, want): (Vec<_>, Vec<_>) = lights.iter().map(of).unzip();
                significant(relative(&got.concat(), &want.concat()))
            };
            Light { order, sphere, maps: lights.chunks(FRAMES[0]).map(error).collect() }
        })
        .collect()
}
