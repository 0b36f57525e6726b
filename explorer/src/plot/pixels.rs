//! The pictures of a plot: a map, the series of its first bands, and the spheres that both light, summed up by brute force.
//! Where a value is negative a pixel is magenta.

use super::sheet::Picture;
use rayon::prelude::*;
use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_picture::lights::{Light, Lights};
use zonal_picture::tone;
use zonal_picture::vector::{across, add, cross, dot};

/// The columns and rows of a map's picture.
const MAP: [usize; 2] = [256, 128];
/// The columns and rows of a sphere's picture.
const SPHERE: usize = 128;
/// How many lights stand for a map, and the rows of those that stand for a series.
const LIGHTS: usize = 1024;
const ROWS: usize = 32;
/// From how many lights at most those are gathered.
const GATHERED_FROM: usize = 1 << 15;
/// What a negative value is shown as.
const NEGATIVE: [u8; 3] = [214, 0, 147];

/// What is opaque, as radiance.
type Radiance = Vec<Option<[f64; 3]>>;

fn picture(size: [usize; 2], radiance: &Radiance, exposure: f64) -> Picture {
    let pixel = |radiance: &Option<[f64; 3]>| match radiance {
        None => [0; 4],
        Some(rgb) if rgb.iter().any(|&c| c < 0.0) => [NEGATIVE[0], NEGATIVE[1], NEGATIVE[2], 255],
        Some(rgb) => {
            let [r, g, b] = tone::mapped(rgb.map(|c| exposure * c)).map(tone::encoded);
            [r, g, b, 255]
        }
    };
    Picture { size, pixels: radiance.iter().map(pixel).collect() }
}

fn exposure(radiance: &Radiance) -> f64 {
    tone::exposure(radiance.iter().flatten().copied())
}

/// The first bands of a projection.
fn cut(projection: &Projection, order: usize) -> Projection {
    Projection { order, coefficients: projection.coefficients[..order * order].to_vec(), beyond: 0.0 }
}

/// A map and the series of its first bands, exposed alike.
pub fn maps(map: &Map, projection: &Projection, order: usize) -> [Picture; 2] {
    let grid = Map { width: MAP[0], height: MAP[1], texels: vec![] };
    let series = cut(projection, order);
    let direction = |i: usize| grid.direction(i % MAP[0], i / MAP[0]);
    let all = |value: &(dyn Fn([f64; 3]) -> [f64; 3] + Sync)| -> Radiance {
        (0..MAP[0] * MAP[1]).into_par_iter().map(|i| Some(value(direction(i)))).collect()
    };
    let both = [all(&|direction| map.radiance(direction)), all(&|direction| series.evaluate(direction))];
    let exposure = exposure(&both[0]);
    both.map(|radiance| picture(MAP, &radiance, exposure))
}

/// A sphere under a map and under the series of its first bands, exposed alike, seen from the side that is lit.
pub fn spheres(map: &Map, projection: &Projection, order: usize, brdf: &Brdf) -> [Picture; 2] {
    let grid = Map { width: 2 * ROWS, height: ROWS, texels: vec![] };
    let series = cut(projection, order);
    let lights = (0..2 * ROWS * ROWS).map(|i| {
        let (x, y) = (i % grid.width, i / grid.width);
        let (direction, solid_angle) = (grid.direction(x, y), grid.solid_angle(x, y));
        Light { direction, power: series.evaluate(direction).map(|c| solid_angle * c) }
    });
    let sets = [Lights::at_most(map, GATHERED_FROM).gathered(LIGHTS), Lights(lights.collect())];
    // The light comes from where band 1 points; the eye is a quarter of the way around from there.
    let coefficient = |i: usize| projection.coefficients.get(i).map_or(0.0, |rgb| rgb.iter().sum::<f64>());
    let azimuth = (-coefficient(1)).atan2(-coefficient(3)) + 0.8;
    let (eye, up) = ([azimuth.cos(), azimuth.sin(), 0.0], [0.0, 0.0, 1.0]);
    let right = cross(up, eye);
    let both = sets.map(|set| -> Radiance {
        let pixel = |i: usize| {
            let at = |i: usize| (2 * i + 1) as f64 / SPHERE as f64 - 1.0;
            let (x, y) = (at(i % SPHERE), -at(i / SPHERE));
            let depth = 1.0 - x * x - y * y;
            (depth > 0.0).then(|| {
                let normal = add(add(right.map(|c| x * c), y, up), depth.sqrt(), eye);
                let along = across(cross(up, normal), normal);
                let axes = [along, cross(normal, along), normal];
                set.radiance(brdf, axes, axes.map(|axis| dot(axis, eye)))
            })
        };
        (0..SPHERE * SPHERE).into_par_iter().map(pixel).collect()
    });
    let exposure = exposure(&both[0]);
    both.map(|radiance| picture([SPHERE, SPHERE], &radiance, exposure))
}
