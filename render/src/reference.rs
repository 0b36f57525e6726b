//! The truth, by brute force: for each point of a surface the sum over all texels of the map, and over many directions to
//! each sphere that shines, of their radiance times the reflectance, in f64. No harmonics, no tables, no kernels.
//!
//! A texel counts with its radiance in the direction of its centre, times its solid angle. Of a function that a texel of
//! width Δ sees as flat this is exact; band l is off by about l(l+1) Δ²/24 of itself, which for 256×128 texels is 0.3 %
//! of band 10.

use crate::frame::{Frame, Surface};
use rayon::prelude::*;
use std::f64::consts::TAU;
use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::SphereLight;
use zonal_picture::lights::{self, Light};
use zonal_picture::vector::{across, add, cross};

/// How many rings of directions a sphere is summed over, by the rule of Gauss and Legendre.
const RINGS: usize = 8;
/// How many directions a ring has.
const SPOKES: usize = 32;

/// A map as lights in fixed directions.
#[derive(Clone, Debug)]
pub struct Lights(lights::Lights);

impl Lights {
    /// One light a texel.
    pub fn of(map: &Map) -> Self {
        Self(lights::Lights::of(map))
    }

    /// Spheres alone, as directions to each from where they are seen.
    pub fn of_spheres(spheres: &[SphereLight]) -> lights::Lights {
        Self(lights::Lights(vec![])).with(spheres).0
    }

    /// What a map with so many rows holds of the first bands only, ringing and all.
    pub fn of_bands(projection: &Projection, height: usize) -> Self {
        let mut map = Map { width: 2 * height, height, texels: vec![[0.0; 3]; 2 * height * height] };
        let place = map.clone();
        map.texels.par_iter_mut().enumerate().for_each(|(i, texel)| {
            *texel = projection.evaluate(place.direction(i % place.width, i / place.width));
        });
        Self::of(&map)
    }

    /// These lights and spheres, each as 8 rings of 32 directions to it from the middle of the object, which
    /// is where the map is seen from too.
    #[must_use]
    pub fn with(mut self, spheres: &[SphereLight]) -> Self {
        for sphere in spheres {
            let (z, s) = (sphere.direction(), sphere.squared_sine());
            let x = across([1.0, 0.0, 0.0], z);
            let y = cross(z, x);
            // By what the cosine is short of one, so that small spheres have all their digits.
            for (short, weight) in gauss_legendre(RINGS, 0.0, s / (1.0 + (1.0 - s).sqrt())) {
                let (sin, solid) = ((short * (2.0 - short)).sqrt(), weight * TAU / SPOKES as f64);
                for spoke in 0..SPOKES {
                    let (b, a) = (TAU * (spoke as f64 + 0.5) / SPOKES as f64).sin_cos();
                    let direction = add(add(z.map(|c| c * (1.0 - short)), sin * a, x), sin * b, y);
                    self.0.0.push(Light { direction, power: sphere.radiance.map(|c| c * solid) });
                }
            }
        }
        self
    }

    /// The radiance that a point of a surface sends to the eye.
    pub fn radiance(&self, brdf: &Brdf, surface: &Surface) -> [f64; 3] {
        let (axes, view) = surface.modulated();
        self.0.radiance(brdf, axes, view)
    }

    /// The radiance of every `step`-th of the points that there are, the first among them; `tick` is called after each.
    pub fn frame(
        &self,
        brdf: &Brdf,
        size: [usize; 2],
        surfaces: &[Option<Surface>],
        step: usize,
        tick: impl Fn() + Sync,
    ) -> Frame {
        let mut count = 0..;
        let mut wanted =
            |surface: &Option<Surface>| surface.filter(|_| count.next().is_some_and(|i: usize| i.is_multiple_of(step)));
        let wanted: Vec<Option<Surface>> = surfaces.iter().map(&mut wanted).collect();
        let radiance = |surface: &Option<Surface>| {
            let radiance = self.radiance(brdf, surface.as_ref()?);
            tick();
            Some(radiance)
        };
        Frame { size, pixels: wanted.par_iter().map(radiance).collect(), milliseconds: 0.0 }
    }
}

/// For the orders 1 to `bands` − 1, the root of the mean square of the radiance that the bands from there on add, if
/// every rotation of the reflectance against the light is as likely as any other: then the mean square over rotations of
/// Σ b_lm L_lm in band l is |b_l|² |L_l|² / (2l+1). It leaves out what lies beyond `bands`.
pub fn expected(brdf: &Brdf, views: &[[f64; 3]], light: &Projection, bands: usize) -> Vec<f64> {
    let energy = light.band_energy();
    let band = |b: &[f64], l: usize| b[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum::<f64>();
    let of_view = |view: &[f64; 3]| -> Vec<f64> {
        let b = brdf.coefficients(*view, bands);
        (0..bands).map(|l| band(&b, l) * energy[l] / (2 * l + 1) as f64).collect()
    };
    let all: Vec<Vec<f64>> = views.par_iter().map(of_view).collect();
    let mean = |l: usize| all.iter().map(|bands| bands[l]).sum::<f64>() / all.len() as f64;
    let mut left = 0.0;
    let mut errors: Vec<f64> = (1..bands)
        .rev()
        .map(|l| {
            left += mean(l);
            f64::sqrt(left)
        })
        .collect();
    errors.reverse();
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use zonal_codegen::promise::samples::Random;
    use zonal_picture::vector::dot;

    fn surface(random: &mut Random) -> Surface {
        let [x, y, z] = random.unit::<3>();
        let view = random.unit::<3>();
        Surface { frame: random.unit(), normal: [x, y, z.abs()], view: [view[0], view[1], view[2].abs()] }
    }

    #[test]
    fn a_lambertian_surface_gets_the_irradiance_of_the_map() {
        let mut random = Random::new(4);
        let texels = (0..64 * 32).map(|_| [1.0 + random.signed(), 1.0, 1.0 + random.signed()]).collect();
        let map = Map { width: 64, height: 32, texels };
        let irradiance = map.project(64).irradiance();
        let lights = Lights::of(&map);
        for _ in 0..20 {
            let surface = surface(&mut random);
            let found = lights.radiance(&Brdf::Lambert, &surface);
            let expected = irradiance.evaluate(surface.modulated().0[2]).map(|v| v / PI);
            // Texels of 5.6 degrees at their centres change band 2 by 0.2 %; noise lies in all bands.
            assert!((0..3).all(|i| (found[i] / expected[i] - 1.0).abs() < 5e-3), "{found:?} {expected:?}");
        }
    }

    /// A white surface that faces a sphere gets π s of its radiance; one that it stands sideways of, nothing from behind.
    #[test]
    fn a_sphere_gives_its_irradiance() {
        let dark = Map { width: 64, height: 32, texels: vec![[0.0; 3]; 64 * 32] };
        for (position, radius) in [([0.0, 0.0, 5.0], 1.5), ([0.0, 0.0, 1e5], 1.0), ([0.0, 0.0, 1.0], 0.999)] {
            let sphere = SphereLight { position, radius, radiance: [1.0, 2.0, 0.0] };
            let surface = Surface { frame: [0.0, 0.0, 0.0, 1.0], normal: [0.0, 0.0, 1.0], view: [0.0, 0.0, 1.0] };
            let [r, g, b] = Lights::of(&dark).with(&[sphere]).radiance(&Brdf::Lambert, &surface);
            let want = sphere.squared_sine();
            assert!((r / want - 1.0).abs() <= 1e-12 && (g / r - 2.0).abs() <= 1e-12 && b == 0.0, "{r}, not {want}");
        }
    }

    #[test]
    fn one_texel_gives_the_reflectance_itself() {
        let mut random = Random::new(5);
        let mut map = Map { width: 64, height: 32, texels: vec![[0.0; 3]; 64 * 32] };
        map.texels[5 * 64 + 40] = [1.0, 2.0, 0.0];
        let lights = Lights::of(&map);
        let brdf = Brdf::Ward { alpha: [0.3, 0.6] };
        for _ in 0..50 {
            let surface = surface(&mut random);
            let (axes, view) = surface.modulated();
            let light = axes.map(|axis| dot(axis, map.direction(40, 5)));
            let expected = brdf.value(view, light) * map.solid_angle(40, 5);
            let [r, g, b] = lights.radiance(&brdf, &surface);
            assert!((r - expected).abs() <= 1e-12 * expected && (g - 2.0 * r).abs() <= 1e-12 * r && b == 0.0);
        }
    }
}
