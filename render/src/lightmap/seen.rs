//! What pixels show: by brute force over lights that nothing hides, and by each way, from the lightmap and from what is known
//! at the pixel itself.

use crate::lightmap::room::{Baked, Place, REPEATS, Room};
use crate::lightmap::ways::Way;
use rayon::prelude::*;
use zonal_bake::point::Point;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::camera::View;
use zonal_picture::lights::{Light, Lights};
use zonal_picture::normal_map::NormalMap;
use zonal_picture::vector::{add, dot, length, unit};

/// The bands of radiance that ways are made of.
const ORDER: usize = 5;
/// The coarsest level of the normal map that a pixel takes.
const MAX_LEVEL: u32 = 5;
/// The least z of the normals of a range.
const LEAST_Z: [f64; 4] = [0.0, 0.5, 0.8, 0.95];
/// How many normals a place is looked at with.
const NORMALS: usize = 16;

/// The relief of the room.
pub struct Relief {
    /// The map.
    pub normals: NormalMap,
    /// What its slopes are multiplied with.
    pub strength: f64,
}

/// The normals that a pixel covers.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// Each, of length one.
    pub normals: Vec<[f64; 3]>,
    /// Their mean, which is shorter.
    pub mean: [f64; 3],
}

impl Footprint {
    /// Returns the mean of the irradiance at the normals by brute force.
    fn irradiance(&self, lights: &[Light]) -> [f64; 3] {
        let sum = self.normals.iter().fold([0.0; 3], |sum, normal| add(sum, 1.0, irradiance(lights, *normal)));
        sum.map(|v| v / self.normals.len() as f64)
    }
}

impl Relief {
    /// Returns the normals of the texel of a level of the map that a place lies in: two by two of the level below, down to
    /// those of the file. What a texture of means would hold there is their mean.
    pub fn footprint(&self, uv: [f64; 2], level: u32) -> Footprint {
        let (sides, block) = ([self.normals.width, self.normals.height], 1usize << level);
        let corner: [usize; 2] = std::array::from_fn(|k| {
            let texel = ((uv[k] - uv[k].floor()) * sides[k] as f64) as usize;
            texel.min(sides[k] - 1) / block * block
        });
        let normal = |i: usize| {
            let (x, y) = (corner[0] + i % block, corner[1] + i / block);
            let found = self.normals.normals[(y % sides[1]) * sides[0] + x % sides[0]];
            let [x, y, z] = found.map(f64::from);
            unit([self.strength * x, self.strength * y, z]).unwrap_or([0.0, 0.0, 1.0])
        };
        let normals: Vec<[f64; 3]> = (0..block * block).map(normal).collect();
        let sum = normals.iter().fold([0.0; 3], |sum, normal| add(sum, 1.0, *normal));
        Footprint { mean: sum.map(|x| x / normals.len() as f64), normals }
    }
}

/// Returns the lights that a point sees, in its frame.
pub fn lit(room: &Room, lights: &Lights, point: &Point) -> Vec<Light> {
    let origin = point.origin();
    let seen = |light: &Light| {
        let direction = point.local(light.direction);
        let is_seen = direction[2] > 0.0 && room.occluders.sees(origin, light.direction);
        is_seen.then_some(Light { direction, power: light.power })
    };
    lights.0.iter().filter_map(seen).collect()
}

/// Returns the irradiance at a normal by brute force.
pub fn irradiance(lights: &[Light], normal: [f64; 3]) -> [f64; 3] {
    lights.iter().fold([0.0; 3], |sum, light| add(sum, dot(light.direction, normal).max(0.0), light.power))
}

/// Returns the radiance of lights in five bands.
pub fn projected(lights: &[Light]) -> Vec<[f64; 3]> {
    let (mut sums, mut values) = (vec![[0.0; 3]; ORDER * ORDER], [0.0; ORDER * ORDER]);
    for light in lights {
        basis(ORDER, light.direction, &mut values);
        sums.iter_mut().zip(values).for_each(|(sum, y)| *sum = add(*sum, y, light.power));
    }
    sums
}

/// A pixel.
#[derive(Clone, Debug)]
pub struct Pixel {
    /// By brute force: the mean over all normals that it covers.
    pub truth: [f64; 3],
    /// By each way, from what is baked.
    pub baked: Vec<[f64; 3]>,
    /// By each way, from what reaches the pixel.
    pub own: Vec<[f64; 3]>,
}

/// Returns the directions in which the pixels of a picture look, row by row from the top.
pub fn directions(camera: &Camera, [width, height]: [usize; 2]) -> Vec<[f64; 3]> {
    let place = |i: usize, side: usize| (2 * i + 1) as f64 / side as f64 - 1.0;
    let aspect = width as f64 / height as f64;
    (0..width * height).map(|i| camera.direction(place(i % width, width), -place(i / width, height), aspect)).collect()
}

/// Returns the level of the normal map that a pixel takes: the finest whose texels are as large as it, looked at straight.
fn level(camera: &Camera, size: [usize; 2], place: &Place, relief: &Relief) -> u32 {
    let distance = length(add(place.point.position, -1.0, camera.eye()));
    let pixel = 2.0 * distance * (0.5 * camera.field.to_radians()).tan() / size[1] as f64;
    let texels = pixel * REPEATS * relief.normals.width as f64;
    (texels.max(1.0).log2().round() as u32).min(MAX_LEVEL)
}

/// What is looked at, and how.
pub struct Setup<'a> {
    /// The room.
    pub room: &'a Room,
    /// Its baked light.
    pub baked: &'a Baked,
    /// The same light for brute force.
    pub lights: &'a Lights,
    /// The relief of all.
    pub relief: &'a Relief,
    /// The ways to see it.
    pub ways: &'a [Way],
    /// Where from.
    pub camera: &'a Camera,
}

/// Returns what a picture shows; `tick` is called after each pixel that shows something.
pub fn picture(setup: &Setup, size: [usize; 2], tick: impl Fn() + Sync) -> Vec<Option<Pixel>> {
    let Setup { room, baked, lights, relief, ways, camera } = *setup;
    let places = room.places(baked, camera.eye(), &directions(camera, size));
    let pixel = |place: &Option<Place>| {
        let place = place.as_ref()?;
        let footprint = relief.footprint(place.uv, level(camera, size, place, relief));
        let seen = lit(room, lights, &place.point);
        let own = projected(&seen);
        let by =
            |radiance: &[[f64; 3]]| ways.iter().map(|way| way.irradiance(radiance, footprint.mean, false)).collect();
        tick();
        Some(Pixel { truth: footprint.irradiance(&seen), baked: by(&place.baked), own: by(&own) })
    };
    places.par_iter().map(pixel).collect()
}

/// Places that are seen, spread over a picture.
fn some_places(setup: &Setup, count: usize) -> Vec<Place> {
    let Setup { room, baked, camera, .. } = *setup;
    let all = room.places(baked, camera.eye(), &directions(camera, [120, 100]));
    let all: Vec<Place> = all.into_iter().flatten().collect();
    let step = (all.len() / count).max(1);
    all.into_iter().step_by(step).take(count).collect()
}

fn square(v: [f64; 3]) -> f64 {
    dot(v, v)
}

/// How far each way is from the mean of brute force over the normals of a texel, level by level.
#[derive(Clone, Debug)]
pub struct Level {
    /// The level: a texel is the mean of 4 to this power.
    pub level: u32,
    /// The mean length of the means.
    pub length: f64,
    /// The relative rms error of each way with the mean as it is.
    pub as_it_is: Vec<f64>,
    /// The same with the mean at length one.
    pub normalised: Vec<f64>,
}

/// Returns the errors of the levels 0 to 5 at places of a picture, so many of them. Light is what reaches the place, in five
/// bands, so that what a lightmap errs by is in no figure.
pub fn levels(setup: &Setup, count: usize) -> Vec<Level> {
    let Setup { room, lights, relief, ways, .. } = *setup;
    let few = some_places(setup, count);
    // Of each place and level: the square of the truth, the length, and each way's two squared errors.
    type Found = (f64, f64, Vec<[f64; 2]>);
    let of_place = |place: &Place| -> Vec<Found> {
        let seen = lit(room, lights, &place.point);
        let own = projected(&seen);
        let of_level = |level: u32| {
            let footprint = relief.footprint(place.uv, level);
            let (truth, mean) = (footprint.irradiance(&seen), footprint.mean);
            let error = |way: &Way, is_unit| square(add(way.irradiance(&own, mean, is_unit), -1.0, truth));
            (square(truth), length(mean), ways.iter().map(|way| [error(way, false), error(way, true)]).collect())
        };
        (0..=MAX_LEVEL).map(of_level).collect()
    };
    let found: Vec<Vec<Found>> = few.par_iter().map(of_place).collect();
    let level = |level: usize| {
        let truth: f64 = found.iter().map(|place| place[level].0).sum();
        let rms = |way: usize, which: usize| {
            (found.iter().map(|place| place[level].2[way][which]).sum::<f64>() / truth).sqrt()
        };
        Level {
            level: level as u32,
            length: found.iter().map(|place| place[level].1).sum::<f64>() / found.len() as f64,
            as_it_is: (0..ways.len()).map(|way| rms(way, 0)).collect(),
            normalised: (0..ways.len()).map(|way| rms(way, 1)).collect(),
        }
    };
    (0..=MAX_LEVEL as usize).map(level).collect()
}

/// How far each way is from brute force at normals that lean no further than some angle.
#[derive(Clone, Debug)]
pub struct Lean {
    /// The angle from the surface's normal, in degrees.
    pub degrees: f64,
    /// The relative rms error of each way.
    pub errors: Vec<f64>,
}

/// Returns the errors at normals that are spread evenly over 90, 60, 37 and 18 degrees around the surface's, at places of a
/// picture, so many of them; light as in [`levels`].
pub fn leans(setup: &Setup, count: usize) -> Vec<Lean> {
    let ways = setup.ways;
    let found: Vec<Vec<Vec<f64>>> = some_places(setup, count)
        .par_iter()
        .enumerate()
        .map(|(number, place)| {
            let seen = lit(setup.room, setup.lights, &place.point);
            let own = projected(&seen);
            let mut random = Random::new(number as u64);
            // The sums of the squares: of each way's errors, then of the truth.
            let of_range = |least: &f64| {
                let mut sums = vec![0.0; ways.len() + 1];
                for _ in 0..NORMALS {
                    let z = least + (1.0 - least) * 0.5 * (random.signed() + 1.0);
                    let [x, y] = random.unit::<2>().map(|x| x * (1.0 - z * z).sqrt());
                    let truth = irradiance(&seen, [x, y, z]);
                    for (sum, way) in sums.iter_mut().zip(ways) {
                        *sum += square(add(way.irradiance(&own, [x, y, z], false), -1.0, truth));
                    }
                    sums[ways.len()] += square(truth);
                }
                sums
            };
            LEAST_Z.iter().map(of_range).collect()
        })
        .collect();
    let of_range = |range: usize| {
        let sum = |i: usize| found.iter().map(|place| place[range][i]).sum::<f64>();
        let errors = (0..ways.len()).map(|way| (sum(way) / sum(ways.len())).sqrt()).collect();
        Lean { degrees: LEAST_Z[range].acos().to_degrees(), errors }
    };
    (0..LEAST_Z.len()).map(of_range).collect()
}
