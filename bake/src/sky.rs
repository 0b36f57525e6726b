//! Light from an environment map, by rays that go where it is bright: texels are picked by their power, and a ray goes
//! anywhere in its texel (docs/MATH.md#light-by-rays). A sky that is the same all around is looked at in directions that are
//! spread evenly. It knows nothing of surfaces.

use crate::alias::Alias;
use std::f64::consts::PI;
use zonal_codegen::environment::Map;
use zonal_codegen::promise::samples::{Random, matrix_of};
use zonal_picture::lights::Light;
use zonal_picture::vector::dot;

/// A map with the table by which its texels are picked.
#[derive(Clone, Debug)]
pub struct Sky {
    map: Map,
    table: Alias,
    /// Whether it is one in all directions.
    is_even: bool,
}

impl Sky {
    /// Returns the sky of a map; none if it was made by hand and is black or holds what is no radiance.
    pub fn new(map: Map) -> Option<Self> {
        let power =
            |(i, texel): (usize, &[f64; 3])| texel.iter().sum::<f64>() * map.solid_angle(i % map.width, i / map.width);
        let weights: Vec<f64> = map.texels.iter().enumerate().map(power).collect();
        Some(Self { table: Alias::new(&weights)?, map, is_even: false })
    }

    /// A sky that is one in all directions: what of it reaches a point is whether it is seen.
    pub fn even() -> Self {
        let map = Map { width: 2, height: 1, texels: vec![[1.0; 3]; 2] };
        Self { is_even: true, ..Self::new(map).expect("it is bright") }
    }

    /// The map.
    pub fn map(&self) -> &Map {
        &self.map
    }

    /// Returns so many rays of light, by which sums estimate integrals over the whole sphere: Σ f(direction) power has the
    /// mean ∫ f L. Each is picked by a number of its own part of 0 to 1, so that parts of the map get their share but for
    /// one ray each; all by the seed alone. Of a sky that is one all around they are a spiral, which the seed turns: as even as
    /// points can be, and each ray is an equal share of the sphere.
    pub fn rays(&self, count: usize, seed: u64) -> impl Iterator<Item = Light> {
        let mut random = Random::new(seed);
        let turn = if self.is_even { matrix_of(random.unit()) } else { [0.0; 9] };
        // The golden angle: no two windings come near to each other.
        let golden = PI * (3.0 - 5f64.sqrt());
        (0..count).map(move |i| {
            if self.is_even {
                let z = 1.0 - (2 * i + 1) as f64 / count as f64;
                let ((sin, cos), radius) = ((golden * i as f64).sin_cos(), (1.0 - z * z).sqrt());
                let v = [radius * cos, radius * sin, z];
                let direction = std::array::from_fn(|k| dot([turn[k], turn[3 + k], turn[6 + k]], v));
                return Light { direction, power: [4.0 * PI / count as f64; 3] };
            }
            let mut share = || 0.5 * (random.signed() + 1.0);
            let texel = self.table.pick((i as f64 + share()) / count as f64);
            let (x, y) = (texel % self.map.width, texel / self.map.width);
            let (direction, solid_angle) = self.map.inside(x, y, [share(), share()]);
            let weight = solid_angle / (self.table.share(texel) * count as f64);
            Light { direction, power: self.map.texels[texel].map(|v| v * weight) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::environment::harmonics::basis;

    fn carried(name: &str) -> Map {
        let path = zonal_scenes::below("maps").find(|path| path.contains(name)).expect("a map of that name");
        Map::from_bytes(path, zonal_scenes::embedded(path).expect("embedded")).expect("a map")
    }

    #[test]
    fn rays_sum_to_the_projection_of_the_map() {
        let cube = |map: &Map| {
            let mut cube = Map { width: 8, height: 48, texels: vec![[0.0; 3]; 8 * 48] };
            for i in 0..cube.texels.len() {
                cube.texels[i] = map.radiance(cube.direction(i % 8, i / 8));
            }
            cube
        };
        for map in [carried("city"), carried("courtyard"), cube(&carried("courtyard"))] {
            let sky = Sky::new(map).expect("light");
            let wanted = sky.map().project(3).coefficients;
            let whole: f64 = wanted[0].iter().sum();
            let count = 1 << 16;
            let mut found = [[0.0; 3]; 9];
            let mut values = [0.0; 9];
            for ray in sky.rays(count, 5) {
                basis(3, ray.direction, &mut values);
                for (sum, y) in found.iter_mut().zip(values) {
                    (0..3).for_each(|channel| sum[channel] += y * ray.power[channel]);
                }
            }
            for (found, wanted) in found.iter().zip(&wanted) {
                for channel in 0..3 {
                    // A ray has the map's power to within its colour, and a harmonic of order 3 varies by one: the standard
                    // error is below one in 256 of all, of which four are allowed.
                    let error = (found[channel] - wanted[channel]).abs() / whole;
                    assert!(error < 4.0 / 256.0, "{found:?} {wanted:?}");
                }
            }
        }
    }

    #[test]
    fn a_ray_of_every_part_is_drawn_and_the_seed_says_which() {
        // One texel has half of the light: it gets half of the rays but for one.
        let mut map = Map { width: 16, height: 8, texels: vec![[1.0; 3]; 128] };
        let rest: f64 = (0..128).filter(|&i| i != 40).map(|i| map.solid_angle(i % 16, i / 16)).sum();
        map.texels[40] = [rest / map.solid_angle(8, 2); 3];
        let sky = Sky::new(map.clone()).expect("light");
        let inside = |light: &Light| map.radiance(light.direction) == map.texels[40];
        for seed in 0..8 {
            let hits = sky.rays(256, seed).filter(inside).count();
            // A column of the table is split at most once, and 128 columns take two rays each.
            assert!(hits.abs_diff(128) <= 12, "{hits}");
        }
        let all = |seed| sky.rays(64, seed).collect::<Vec<_>>();
        assert!(all(3) == all(3) && all(3) != all(4));
    }

    #[test]
    fn an_even_sky_is_looked_at_evenly() {
        let sky = Sky::even();
        for seed in [1, 2] {
            let mut sums = [0.0; 36];
            let mut values = [0.0; 36];
            for ray in sky.rays(2000, seed) {
                basis(6, ray.direction, &mut values);
                sums.iter_mut().zip(values).for_each(|(sum, y)| *sum += y * ray.power[1]);
            }
            assert!((sums[0] - (4.0 * PI).sqrt()).abs() < 1e-12);
            // Independent rays would err by 4π over the root of their number: 0.28.
            assert!(sums[1..].iter().all(|sum| sum.abs() < 2e-3), "{sums:?}");
        }
        let all = |seed| sky.rays(64, seed).collect::<Vec<_>>();
        assert!(all(3) == all(3) && all(3) != all(4));
    }

    #[test]
    fn no_light_is_no_sky() {
        assert!(Sky::new(Map { width: 2, height: 1, texels: vec![[0.0; 3]; 2] }).is_none());
    }
}
