//! The ball: where a pixel's rays meet it, how its normals lean there, and where they are mirrored to.

use rayon::prelude::*;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::camera::View;
use zonal_picture::mirror::Footprint;
use zonal_picture::normal_map::NormalMap;
use zonal_picture::vector::{add, cross, dot, unit};

/// The standard deviation of a pixel's filter, in sides of the pixel.
pub const DEVIATION: f64 = 0.5;
/// How many rays a pixel has along each side where there are many.
pub const RAYS: usize = 16;
/// How far they reach to each side of the pixel's middle: three deviations.
const REACH: f64 = 3.0 * DEVIATION;

/// A ball of radius 1 in the middle of the world.
pub struct Ball {
    /// Its relief, once around it.
    pub normals: NormalMap,
    /// What the slopes of the relief are multiplied with.
    pub strength: f64,
    /// From where it is seen.
    pub camera: Camera,
}

/// What a pixel sees.
pub struct Pixel {
    /// In its middle, with the slopes that a shader has: differences between the pixels of a square of two by two.
    pub footprint: Footprint,
    /// Where its many rays are mirrored to, and the weight of each, together one.
    pub rays: Vec<([f32; 3], f32)>,
}

impl Ball {
    /// The direction of the ray at a place of a picture, in pixels from its left and its upper edge, and the normal where it meets
    /// the ball.
    fn at(&self, [x, y]: [f64; 2], size: usize) -> Option<[[f64; 3]; 2]> {
        let across = |v: f64| 2.0 * v / size as f64 - 1.0;
        let (eye, view) = (self.camera.eye(), self.camera.direction(across(x), -across(y), 1.0));
        let along = -dot(eye, view);
        let square = 1.0 - (dot(eye, eye) - along * along);
        let place = (square >= 0.0).then(|| add(eye, along - square.sqrt(), view))?;
        Some([view, self.normal(place)])
    }

    /// The normal of the relief at a place of the ball.
    fn normal(&self, place: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = place;
        let tangent = unit([-y, x, 0.0]).unwrap_or([0.0, 1.0, 0.0]);
        let bitangent = cross(place, tangent);
        let (width, height) = (self.normals.width, self.normals.height);
        let u = (0.5 + y.atan2(x) / std::f64::consts::TAU) * width as f64 - 0.5;
        // Half of the map from pole to pole, so that its texels are square at the equator.
        let v = (z.clamp(-1.0, 1.0).asin() / std::f64::consts::TAU + 0.25) * height as f64 - 0.5;
        let texel = |dx: usize, dy: usize| {
            let at =
                |v: f64, d: usize, side: usize| (v.floor() as isize + d as isize).rem_euclid(side as isize) as usize;
            self.normals.normals[at(v, dy, height) * width + at(u, dx, width)].map(f64::from)
        };
        let (right, up) = (u - u.floor(), v - v.floor());
        let mut lean = [0.0; 3];
        for (weight, texel) in [
            ((1.0 - right) * (1.0 - up), texel(0, 0)),
            (right * (1.0 - up), texel(1, 0)),
            ((1.0 - right) * up, texel(0, 1)),
            (right * up, texel(1, 1)),
        ] {
            lean = add(lean, weight, texel);
        }
        let across = add(tangent.map(|t| self.strength * lean[0] * t), self.strength * lean[1], bitangent);
        unit(add(across, lean[2], place)).unwrap_or(place)
    }

    /// The pixels of a square picture of the ball, row by row from the top; none where the middle's ray misses it.
    pub fn pixels(&self, size: usize) -> Vec<Option<Pixel>> {
        let middle = |x: usize, y: usize| self.at([x as f64 + 0.5, y as f64 + 0.5], size);
        let middles: Vec<Option<[[f64; 3]; 2]>> =
            (0..size * size).into_par_iter().map(|i| middle(i % size, i / size)).collect();
        let pixel = |i: usize| {
            let [view, normal] = middles[i]?;
            let (x, y) = (i % size, i / size);
            // The difference with the pixel beside it in the square, or on its other side where that one sees nothing.
            let slope = |at: usize, place: &dyn Fn(usize) -> usize| {
                let of = |first: usize| {
                    let found = (first + 1 < size).then(|| [middles[place(first)], middles[place(first + 1)]])?;
                    Some(add(found[1]?[1], -1.0, found[0]?[1]))
                };
                let first = at & !1;
                let other = if at == first { at.checked_sub(1) } else { Some(at) };
                of(first).or_else(|| of(other?)).unwrap_or([0.0; 3])
            };
            let slopes = [slope(x, &|x| y * size + x), slope(y, &|y| y * size + x)];
            Some(Pixel { footprint: Footprint::new(view, normal, slopes), rays: self.rays([x, y], size) })
        };
        (0..size * size).into_par_iter().map(pixel).collect()
    }

    fn rays(&self, [x, y]: [usize; 2], size: usize) -> Vec<([f32; 3], f32)> {
        let offset = |i: usize| REACH * ((2 * i + 1) as f64 / RAYS as f64 - 1.0);
        let mut rays = Vec::with_capacity(RAYS * RAYS);
        let mut whole = 0.0;
        for (i, j) in (0..RAYS).flat_map(|i| (0..RAYS).map(move |j| (i, j))) {
            let [right, down] = [offset(i), offset(j)];
            let place = [x as f64 + 0.5 + right, y as f64 + 0.5 + down];
            let Some([view, normal]) = self.at(place, size) else { continue };
            let weight = (-0.5 * (right * right + down * down) / (DEVIATION * DEVIATION)).exp();
            whole += weight;
            rays.push((add(view, -2.0 * dot(view, normal), normal).map(|v| v as f32), weight as f32));
        }
        rays.iter_mut().for_each(|(_, weight)| *weight /= whole as f32);
        rays
    }
}
