//! The glossy surface: Phong's lobe, made to conserve energy; its slices as coefficients; the directions in which brute
//! force looks.

use crate::basis::Basis;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_picture::vector::{across, add, cross, dot};

/// A Phong lobe: colour (s + 2) / 2π cos^s of the angle to the mirrored direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// The share of R, G and B that is mirrored.
    pub colour: [f64; 3],
    /// The exponent s.
    pub exponent: f64,
}

/// How many slices there are from the normal to the horizon.
const SLICES: usize = 46;

/// The mirrored direction of one that looks away from the surface.
fn mirrored(normal: [f64; 3], view: [f64; 3]) -> [f64; 3] {
    add(view.map(|x| -x), 2.0 * dot(normal, view), normal)
}

impl Gloss {
    fn lobe(&self, cosine: f64) -> f64 {
        (self.exponent + 2.0) / (2.0 * PI) * cosine.max(0.0).powf(self.exponent)
    }

    /// Returns the reflectance for unit directions to the viewer and to the light.
    pub fn value(&self, normal: [f64; 3], view: [f64; 3], light: [f64; 3]) -> [f64; 3] {
        let lobe = self.lobe(dot(mirrored(normal, view), light));
        self.colour.map(|c| c * lobe)
    }

    /// Returns a unit direction about the mirrored one, dealt as the lobe is high, for two numbers from 0 to 1, and what
    /// radiance from there counts: reflectance times cosine over density, nothing below the horizon.
    pub fn deal(&self, normal: [f64; 3], view: [f64; 3], [u, v]: [f64; 2]) -> Option<([f64; 3], [f64; 3])> {
        let axis = mirrored(normal, view);
        let tangent = across([1.0, 0.0, 0.0], axis);
        let cosine = u.powf(1.0 / (self.exponent + 1.0));
        let radius = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = (2.0 * PI * v).sin_cos();
        let aside = add(tangent.map(|t| t * radius * cos), radius * sin, cross(axis, tangent));
        let direction = add(aside, cosine, axis);
        let height = dot(direction, normal);
        let share = (self.exponent + 2.0) / (self.exponent + 1.0) * height;
        (height > 0.0).then(|| (direction, self.colour.map(|c| c * share)))
    }
}

/// Coefficients of lobe times cosine over the hemisphere, for views in the plane of x and z.
pub struct Slices<const C: usize> {
    basis: Basis<C>,
    rows: Vec<[f32; C]>,
}

impl<const C: usize> Slices<C> {
    /// Returns the slices of a lobe, without its colour, in a basis.
    pub fn new(basis: Basis<C>, gloss: &Gloss) -> Self {
        const HEIGHTS: usize = 48;
        const AZIMUTHS: usize = 96;
        let heights: Vec<(f64, f64)> = gauss_legendre(HEIGHTS, 0.0, 1.0).collect();
        let row = |slice: usize| {
            let (sin, cos) = (FRAC_PI_2 * slice as f64 / (SLICES - 1) as f64).sin_cos();
            let axis = [-sin, 0.0, cos];
            let mut sums = [0.0; C];
            for &(z, weight) in &heights {
                let radius = (1.0 - z * z).sqrt();
                for k in 0..AZIMUTHS {
                    let (y, x) = (2.0 * PI * (k as f64 + 0.5) / AZIMUTHS as f64).sin_cos();
                    let direction = [radius * x, radius * y, z];
                    let share = gloss.lobe(dot(axis, direction)) * z * weight * 2.0 * PI / AZIMUTHS as f64;
                    if share > 0.0 {
                        let values = (basis.values)(direction);
                        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
                    }
                }
            }
            sums.map(|x| x as f32)
        };
        Self { basis, rows: (0..SLICES).into_par_iter().map(row).collect() }
    }

    /// Returns the coefficients for a unit direction to the viewer in the frame of the surface; from below the horizon, those
    /// at it.
    pub fn at(&self, view: [f64; 3]) -> [f32; C] {
        let place = view[2].clamp(0.0, 1.0).acos() / FRAC_PI_2 * (SLICES - 1) as f64;
        let below = (place as usize).min(SLICES - 2);
        let part = (place - below as f64) as f32;
        let (low, high) = (&self.rows[below], &self.rows[below + 1]);
        let slice = std::array::from_fn(|i| low[i] + part * (high[i] - low[i]));
        let radius = view[0].hypot(view[1]);
        let cs = if radius > 0.0 { [view[0] / radius, view[1] / radius] } else { [1.0, 0.0] };
        (self.basis.turned)(cs.map(|x| x as f32), &slice)
    }
}
