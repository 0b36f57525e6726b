//! A map as lights in fixed directions, and what a surface reflects of them: brute force, with no harmonics, no tables and no
//! kernels. Many lights can be gathered into few that light nearly as they do.

use crate::vector::{add, dot, length, unit};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use zonal_codegen::environment::Map;
use zonal_codegen::reflectance::brdf::Brdf;

/// A distant light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The unit direction in which it is.
    pub direction: [f64; 3],
    /// Its radiance times its solid angle, in R, G and B.
    pub power: [f64; 3],
}

impl Light {
    /// What it weighs among others: its power in all channels.
    fn weight(&self) -> f64 {
        self.power.iter().sum()
    }
}

/// Lights around a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Lights(pub Vec<Light>);

impl Lights {
    /// One light a texel, in the direction of its centre.
    pub fn of(map: &Map) -> Self {
        let light = |(i, texel): (usize, &[f64; 3])| {
            let (x, y) = (i % map.width, i / map.width);
            let solid_angle = map.solid_angle(x, y);
            Light { direction: map.direction(x, y), power: texel.map(|v| v * solid_angle) }
        };
        Self(map.texels.iter().enumerate().map(light).collect())
    }

    /// At most so many lights: one a texel, or one for a square block of texels, in the middle of its light.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and has fewer texels than its size says.
    pub fn at_most(map: &Map, count: usize) -> Self {
        let side = (1..).find(|side| (map.width / side + 1) * (map.height / side + 1) <= count).unwrap_or(1);
        if map.texels.len() <= count {
            return Self::of(map);
        }
        // A block of a cube must not reach over the edge of a face.
        let face = if map.is_cube() { map.width } else { map.height };
        let bands = (0..map.height / face).flat_map(|i| (0..face).step_by(side).map(move |y| (i * face, y)));
        let mut lights = Vec::new();
        for (first, y) in bands {
            for x in (0..map.width).step_by(side) {
                let mut block = Gathered::default();
                for (x, y) in
                    (y..(y + side).min(face)).flat_map(|y| (x..(x + side).min(map.width)).map(move |x| (x, y)))
                {
                    let (row, solid_angle) = (first + y, map.solid_angle(x, first + y));
                    let power = map.texels[row * map.width + x].map(|v| v * solid_angle);
                    block.add(&Light { direction: map.direction(x, row), power });
                }
                lights.extend(block.light());
            }
        }
        Self(lights)
    }

    /// Returns at most so many lights that light as these do, for reflectances that are wide beside the distance of what is
    /// gathered: always those are parted whose power times the variance of their directions is the largest. A light is
    /// where the middle of the power is that it stands for, so that what it errs by grows with that variance alone.
    #[must_use]
    pub fn gathered(&self, count: usize) -> Self {
        let mut lights: Vec<Light> = self.0.iter().copied().filter(|light| light.weight() > 0.0).collect();
        let mut groups = BinaryHeap::from([Group::new(0, &lights)]);
        while groups.len() < count {
            let Some(group) = groups.peek().filter(|group| group.spread > 0.0) else { break };
            let (start, end) = (group.start, group.start + group.length);
            let at = start + parted(&mut lights[start..end]);
            if at == start || at == end {
                // All lie in one direction but for rounding.
                if let Some(mut group) = groups.pop() {
                    group.spread = 0.0;
                    groups.push(group);
                }
                continue;
            }
            groups.pop();
            groups.extend([(start, at), (at, end)].map(|(from, to)| Group::new(from, &lights[from..to])));
        }
        let mut groups = groups.into_vec();
        groups.sort_by_key(|group| group.start);
        let light = |group: &Group| {
            let mut sum = Gathered::default();
            lights[group.start..group.start + group.length].iter().for_each(|light| sum.add(light));
            sum.light()
        };
        Self(groups.iter().filter_map(light).collect())
    }

    /// The radiance that a point of a surface sends to the eye: `axes` are those of its frame in the world, z its normal;
    /// `view` is the unit direction to the eye in that frame.
    pub fn radiance(&self, brdf: &Brdf, [x, y, z]: [[f64; 3]; 3], view: [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for Light { direction, power } in &self.0 {
            let up = dot(*direction, z);
            if up > 0.0 {
                let values = brdf.values(view, [dot(*direction, x), dot(*direction, y), up]);
                (0..3).for_each(|channel| sum[channel] += values[channel] * power[channel]);
            }
        }
        sum
    }
}

/// The sum of some lights.
#[derive(Default)]
struct Gathered {
    weight: f64,
    towards: [f64; 3],
    power: [f64; 3],
}

impl Gathered {
    fn add(&mut self, light: &Light) {
        let weight = light.weight();
        self.weight += weight;
        self.towards = add(self.towards, weight, light.direction);
        self.power = add(self.power, 1.0, light.power);
    }

    fn light(&self) -> Option<Light> {
        unit(self.towards).filter(|_| self.weight > 0.0).map(|direction| Light { direction, power: self.power })
    }
}

/// Neighbours in a list of lights that become one.
struct Group {
    start: usize,
    length: usize,
    /// Half the power times the variance of the directions.
    spread: f64,
}

impl Group {
    fn new(start: usize, lights: &[Light]) -> Self {
        let mut sum = Gathered::default();
        lights.iter().for_each(|light| sum.add(light));
        let spread = if lights.len() > 1 { (sum.weight - length(sum.towards)).max(0.0) } else { 0.0 };
        Self { start, length: lights.len(), spread }
    }
}

impl PartialEq for Group {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Group {}

impl PartialOrd for Group {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Group {
    fn cmp(&self, other: &Self) -> Ordering {
        self.spread.total_cmp(&other.spread).then(other.start.cmp(&self.start))
    }
}

/// Brings the lights that are before the middle of their power, along the axis on which they vary most, before the others,
/// and returns how many those are.
fn parted(lights: &mut [Light]) -> usize {
    let weight: f64 = lights.iter().map(Light::weight).sum();
    let mean = |axis: usize| lights.iter().map(|light| light.weight() * light.direction[axis]).sum::<f64>() / weight;
    let middle = [0, 1, 2].map(mean);
    let variance = |axis: usize| -> f64 {
        lights.iter().map(|light| light.weight() * (light.direction[axis] - middle[axis]).powi(2)).sum()
    };
    let variances = [0, 1, 2].map(variance);
    let axis = (0..3).max_by(|&a, &b| variances[a].total_cmp(&variances[b])).unwrap_or(0);
    let mut before = 0;
    for i in 0..lights.len() {
        if lights[i].direction[axis] < middle[axis] {
            lights.swap(i, before);
            before += 1;
        }
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{across, cross};
    use zonal_codegen::promise::samples::Random;

    fn carried(name: &str) -> Map {
        let path = zonal_scenes::below("maps").find(|path| path.contains(name)).expect("a map of that name");
        Map::from_bytes(path, zonal_scenes::embedded(path).expect("embedded")).expect("a map")
    }

    #[test]
    fn gathering_keeps_the_power_and_its_middle() {
        let lights = Lights::of(&carried("city"));
        let sum = |lights: &Lights| {
            let mut sum = Gathered::default();
            lights.0.iter().for_each(|light| sum.add(light));
            sum
        };
        let all = sum(&lights);
        for count in [1, 7, 300] {
            let few = lights.gathered(count);
            assert_eq!(few.0.len(), count);
            let found = sum(&few);
            assert!((found.weight / all.weight - 1.0).abs() < 1e-12);
            // Each is at the middle of its own, but for what a direction of length one loses.
            let apart = length(add(unit(found.towards).expect("light"), -1.0, unit(all.towards).expect("light")));
            assert!(apart < 0.3 / count as f64 + 1e-9, "{count}: {apart}");
        }
        let three = Lights(lights.0[100..103].to_vec());
        assert_eq!(three.gathered(50).0.len(), 3);
        assert_eq!(Lights(vec![lights.0[5]; 4]).gathered(3).0.len(), 1);
    }

    #[test]
    fn four_thousand_lights_light_as_all_texels_do() {
        let mut random = Random::new(2);
        let mut worst: f64 = 0.0;
        for name in ["city", "sunrise", "interior"] {
            let lights = Lights::of(&carried(name));
            let few = lights.gathered(4096);
            for brdf in ["lambert", "phong:30", "ward:0.2:0.6"].map(|text| text.parse::<Brdf>().expect("a reflectance"))
            {
                let (mut apart, mut mean) = (0.0, 0.0);
                for _ in 0..24 {
                    let z = random.unit::<3>();
                    let x = across(random.unit(), z);
                    let [a, b, c] = random.unit::<3>();
                    let at = |lights: &Lights| lights.radiance(&brdf, [x, cross(z, x), z], [a, b, c.abs()]);
                    let (found, wanted) = (at(&few), at(&lights));
                    apart += length(add(found, -1.0, wanted));
                    mean += length(wanted);
                }
                println!("{name}, {brdf}: {:.2e}", apart / mean);
                worst = worst.max(apart / mean);
            }
        }
        // What the explorer promises of its picture of all bands.
        assert!(worst < 0.01, "{worst}");
    }

    #[test]
    fn blocks_of_texels_are_lights_of_their_power() {
        let map = carried("night");
        let cube = Map { width: 60, height: 360, texels: (0..60 * 360).map(|i| [i as f64; 3]).collect() };
        for map in [map, cube] {
            let (all, few) = (Lights::of(&map), Lights::at_most(&map, 2000));
            assert!(few.0.len() <= 2000 && few.0.len() > 400, "{}", few.0.len());
            let power = |lights: &Lights| lights.0.iter().map(Light::weight).sum::<f64>();
            assert!((power(&few) / power(&all) - 1.0).abs() < 1e-12);
            assert_eq!(Lights::at_most(&map, 1 << 20), all);
        }
    }
}
