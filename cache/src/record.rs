//! A record of the cache: the light that arrives at a point, with its derivatives in the tangent plane.

use crate::basis::Basis;
use crate::gradient::share;
use crate::light::Light;
use crate::place::Place;
use crate::scene::{Scene, over_hemisphere, sobol};
use rayon::prelude::*;
use std::f64::consts::PI;
use zonal_picture::vector::dot;

/// The least radius of a record, in halves of the room's side.
const LEAST: f64 = 0.05;
/// The largest.
const MOST: f64 = 1.0;
/// How many rays are summed at once: always the same, so that sums do not depend on the number of threads.
const TOGETHER: usize = 128;

/// How records are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// How many rays a record casts over its hemisphere, at most 65536.
    pub rays: usize,
    /// Which rays.
    pub seed: u32,
}

/// The light that arrives at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Record<const C: usize> {
    /// Where, and the frame in which it is stored.
    pub place: Place,
    /// The harmonic mean of the distances to what is seen, or what the light is over its derivative if that is less, held
    /// between 0.05 and 1.
    pub radius: f64,
    /// The coefficients.
    pub light: Light<C>,
    /// Their derivatives along x and y of the frame.
    pub slopes: [Light<C>; 2],
}

/// Sums in f64.
#[derive(Clone)]
pub struct Sums<const C: usize> {
    /// The coefficients, a channel after the other.
    pub light: [[f64; C]; 3],
    /// Their derivatives.
    pub slopes: [[[f64; C]; 3]; 2],
    /// The inverse distances.
    inverse: f64,
    /// How many samples met something.
    met: usize,
}

impl<const C: usize> Default for Sums<C> {
    fn default() -> Self {
        Self { light: [[0.0; C]; 3], slopes: [[[0.0; C]; 3]; 2], inverse: 0.0, met: 0 }
    }
}

impl<const C: usize> Sums<C> {
    /// Adds a sample: a unit direction in the frame, the distance to what it meets with its unit normal in the frame, its
    /// radiance times the solid angle.
    pub fn sample(
        &mut self,
        basis: &Basis<C>,
        direction: [f64; 3],
        distance: f64,
        normal: [f64; 3],
        radiance: [f64; 3],
    ) {
        self.inverse += 1.0 / distance;
        self.met += 1;
        if radiance == [0.0; 3] {
            return;
        }
        let share = share(basis.moving, direction, distance, normal);
        for k in 0..3 {
            for i in 0..C {
                self.light[k][i] += share.values[i] * radiance[k];
                self.slopes[0][k][i] += share.slopes[0][i] * radiance[k];
                self.slopes[1][k][i] += share.slopes[1][i] * radiance[k];
            }
        }
    }

    fn add(&mut self, other: &Self) {
        let add = |a: &mut [[f64; C]; 3], b: &[[f64; C]; 3]| {
            a.as_flattened_mut().iter_mut().zip(b.as_flattened()).for_each(|(a, b)| *a += b);
        };
        add(&mut self.light, &other.light);
        (0..2).for_each(|e| add(&mut self.slopes[e], &other.slopes[e]));
        self.inverse += other.inverse;
        self.met += other.met;
    }
}

impl<const C: usize> Record<C> {
    /// Returns the record of a place of a scene; `number` tells its rays from those of other records.
    pub fn new(basis: &Basis<C>, scene: &Scene, place: Place, sampling: Sampling, number: usize) -> Self {
        let seed = sampling.seed ^ (number as u32).wrapping_mul(0x9e37_79b9);
        let weight = 2.0 * PI / sampling.rays as f64;
        let origin = place.point.origin();
        let part = |first: usize| {
            let mut sums = Sums::<C>::default();
            for i in first..(first + TOGETHER).min(sampling.rays) {
                let [u, v, s, t] = sobol(i, seed);
                let local = over_hemisphere([u, v]);
                let direction = place.point.world(local);
                // What lies behind the triangle, before the horizon of the interpolated normal, is the surface itself.
                if dot(direction, place.point.face) <= 0.0 {
                    continue;
                }
                let Some(seen) = scene.look(origin, direction) else { continue };
                let radiance = scene.sent(&seen, direction.map(|x| -x), [s, t]).map(|x| x * weight);
                sums.sample(basis, local, seen.distance.max(1e-3), place.point.local(seen.face), radiance);
            }
            sums
        };
        let firsts: Vec<usize> = (0..sampling.rays).step_by(TOGETHER).collect();
        let parts: Vec<Sums<C>> = firsts.into_par_iter().map(part).collect();
        let mut all = Sums::default();
        parts.iter().for_each(|part| all.add(part));
        Self::from_sums(place, &all)
    }

    /// Returns a record of a place with sums for its coefficients.
    pub fn from_sums(place: Place, sums: &Sums<C>) -> Self {
        let single = |c: &[[f64; C]; 3]| -> Light<C> { std::array::from_fn(|i| [0, 1, 2].map(|k| c[k][i] as f32)) };
        let mean = if sums.met > 0 { sums.met as f64 / sums.inverse } else { MOST };
        // Where the light changes fast, by a touching surface, its derivatives reach less far than that.
        let norm = |c: &[[f64; C]; 3]| c.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
        let slope = norm(&sums.slopes[0]).hypot(norm(&sums.slopes[1]));
        let reach = if slope > 0.0 { norm(&sums.light) / slope } else { MOST };
        let radius = mean.min(reach);
        let slopes = [single(&sums.slopes[0]), single(&sums.slopes[1])];
        Self { place, radius: radius.clamp(LEAST, MOST), light: single(&sums.light), slopes }
    }
}
