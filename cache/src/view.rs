//! What a camera sees of a scene, and pictures of it: from a cache, and by brute force.

use crate::cache::{Cache, Count};
use crate::gloss::{Gloss, Slices};
use crate::methods::Method;
use crate::place::Place;
use crate::scene::{Material, Scene, Seen, sobol};
use cpu_time::{ProcessTime, ThreadTime};
use rayon::prelude::*;
use zonal_picture::camera::{Camera, View as _};
use zonal_picture::vector::{add, dot};

/// A pixel that shows something glossy.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Its number in the picture, row by row.
    pub number: usize,
    /// What it shows.
    pub place: Place,
    /// Its gloss.
    pub gloss: Gloss,
    /// The unit direction to the camera, in the world.
    pub view: [f64; 3],
}

/// What a camera sees.
pub struct View {
    /// The pixels along a side.
    pub side: usize,
    /// What the lamp itself lights: the radiance of all pixels, row by row from the top.
    pub direct: Vec<[f64; 3]>,
    /// The pixels that show something glossy.
    pub glossy: Vec<Pixel>,
}

/// What glossy pixels show besides the lamp's light.
pub struct Shown {
    /// The radiance of each.
    pub radiance: Vec<[f64; 3]>,
    /// The rotations.
    pub count: Count,
    /// The processor time that it took, in seconds.
    pub seconds: f64,
}

impl View {
    /// Returns what a camera sees in a square picture.
    pub fn new(scene: &Scene, camera: &Camera, side: usize) -> Self {
        let one = |number: usize| -> ([f64; 3], Option<Pixel>) {
            let [x, y] = [number % side, number / side].map(|k| (2 * k + 1) as f64 / side as f64 - 1.0);
            let direction = camera.direction(x, -y, 1.0);
            let Some(seen) = scene.look(camera.eye(), direction) else { return ([0.0; 3], None) };
            let view = direction.map(|x| -x);
            let Seen { place, material, .. } = seen;
            let pixel = match material {
                Material::Glossy(gloss) => Some(Pixel { number, place, gloss, view }),
                _ => None,
            };
            (scene.direct(&seen, view, 8), pixel)
        };
        let (direct, glossy): (Vec<_>, Vec<_>) = (0..side * side).into_par_iter().map(one).unzip();
        Self { side, direct, glossy: glossy.into_iter().flatten().collect() }
    }

    /// Returns the places of the glossy pixels, first those of a wide grid, then those between: records lie evenly so.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        let grade = |pixel: &Pixel| {
            let both = (pixel.number % self.side) | (pixel.number / self.side);
            both.trailing_zeros().min(4)
        };
        let of = move |wanted: u32| self.glossy.iter().filter(move |pixel| grade(pixel) == wanted);
        (0..=4).rev().flat_map(of).map(|pixel| pixel.place)
    }

    /// Returns what the glossy pixels show from a cache, on one thread: all are of one gloss, whose slices are given.
    pub fn cached<const C: usize>(
        &self,
        cache: &Cache<C>,
        slices: &Slices<C>,
        method: &Method<C>,
        limit: f32,
    ) -> Shown {
        let start = ThreadTime::now();
        let mut count = Count::default();
        let radiance = self.glossy.iter().map(|pixel| {
            let Some(light) = cache.light(&pixel.place, method, limit, &mut count) else { return [0.0; 3] };
            let slice = slices.at(pixel.place.point.local(pixel.view));
            let mut sum = [0.0f32; 3];
            for (share, light) in slice.iter().zip(&light) {
                (0..3).for_each(|k| sum[k] += share * light[k]);
            }
            std::array::from_fn(|k| f64::from(sum[k]) * pixel.gloss.colour[k])
        });
        let radiance = radiance.collect();
        Shown { radiance, count, seconds: start.elapsed().as_secs_f64() }
    }

    /// Returns what the glossy pixels show by so many rays a pixel, dealt as the lobe is high, on all threads.
    pub fn brute_force(&self, scene: &Scene, rays: usize, seed: u32, tick: impl Fn() + Sync) -> Shown {
        let start = ProcessTime::now();
        let one = |pixel: &Pixel| {
            let own = seed ^ (pixel.number as u32 + 1).wrapping_mul(0x85eb_ca6b);
            let (normal, origin) = (pixel.place.normal(), pixel.place.point.origin());
            let mut sum = [0.0; 3];
            for i in 0..rays {
                let [u, v, s, t] = sobol(i, own);
                let Some((direction, share)) = pixel.gloss.deal(normal, pixel.view, [u, v]) else { continue };
                if dot(direction, pixel.place.point.face) <= 0.0 {
                    continue;
                }
                if let Some(seen) = scene.look(origin, direction) {
                    let sent = scene.sent(&seen, direction.map(|x| -x), [s, t]);
                    sum = add(sum, 1.0 / rays as f64, std::array::from_fn(|k| share[k] * sent[k]));
                }
            }
            tick();
            sum
        };
        let radiance = self.glossy.par_iter().map(one).collect();
        Shown { radiance, count: Count::default(), seconds: start.elapsed().as_secs_f64() }
    }

    /// Returns the picture with what glossy pixels show besides the lamp's light added.
    pub fn with(&self, shown: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut all = self.direct.clone();
        self.glossy
            .iter()
            .zip(shown)
            .for_each(|(pixel, shown)| all[pixel.number] = add(all[pixel.number], 1.0, *shown));
        all
    }
}

/// Returns the root mean square of the difference of two lists of radiance, as a share of the mean of the second; the
/// radiance of a pixel is the norm of R, G and B.
pub fn rms(shown: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let square = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
    let count = truth.len().max(1) as f64;
    let sum: f64 = shown.iter().zip(truth).map(|(a, b)| square(add(*a, -1.0, *b))).sum();
    let mean = truth.iter().map(|v| square(*v).sqrt()).sum::<f64>() / count;
    (sum / count).sqrt() / mean
}
