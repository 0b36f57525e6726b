//! Where the energy of a map is: whether a few texels, a sun or lamps, hold nearly all of it, which no low order can show
//! as they are. Texels are counted by the octave of their energy while a map is read, so that any size takes the same
//! memory.

use super::spectrum::Parts;
use serde::Serialize;
use std::f64::consts::PI;

/// The number of octaves of an f64.
const OCTAVES: usize = 1 << 11;

/// What is called nearly all of the energy.
const NEARLY_ALL: f64 = 0.9;

/// How much of the sphere a small light covers at most: a twentieth of the first that has bands enough for it.
const SMALL: f64 = 0.005;

/// Texels whose energy a steradian lies within an octave.
#[derive(Clone, Copy, Default)]
struct Octave {
    texels: usize,
    energy: f64,
    solid_angle: f64,
    /// The radiance of R, G and B times the solid angle.
    flux: [f64; 3],
    /// The sum of their directions, each times its energy.
    towards: [f64; 3],
}

/// The texels of a map, or of a part of it, by the octave of their energy.
pub(super) struct Octaves(Vec<Octave>);

impl Octaves {
    pub fn new() -> Self {
        Self(vec![Octave::default(); OCTAVES])
    }

    /// Adds a texel by its radiance, its solid angle and its direction.
    pub fn add(&mut self, [red, green, blue]: [f64; 3], solid_angle: f64, [x, y, z]: [f64; 3]) {
        let square = red * red + green * green + blue * blue;
        // The exponent, since no square has a sign.
        let octave = &mut self.0[(square.to_bits() >> 52) as usize % OCTAVES];
        let energy = square * solid_angle;
        octave.texels += 1;
        octave.energy += energy;
        octave.solid_angle += solid_angle;
        octave.flux[0] += solid_angle * red;
        octave.flux[1] += solid_angle * green;
        octave.flux[2] += solid_angle * blue;
        octave.towards[0] += energy * x;
        octave.towards[1] += energy * y;
        octave.towards[2] += energy * z;
    }

    /// Adds the texels of another part.
    pub fn join(&mut self, other: &Self) {
        for (octave, other) in self.0.iter_mut().zip(&other.0).filter(|(_, other)| other.texels > 0) {
            octave.texels += other.texels;
            octave.energy += other.energy;
            octave.solid_angle += other.solid_angle;
            for i in 0..3 {
                octave.flux[i] += other.flux[i];
                octave.towards[i] += other.towards[i];
            }
        }
    }

    /// Those that are not empty, the brightest first.
    fn used(&self) -> impl Iterator<Item = &Octave> {
        self.0.iter().rev().filter(|octave| octave.texels > 0)
    }

    /// The map in two parts, in as many ways as there are octaves, and whole.
    pub fn parts(&self) -> Vec<Parts> {
        let mut flux = [0.0; 3];
        let mut others: f64 = self.used().map(|octave| octave.energy).sum();
        let mut ways = vec![];
        for octave in self.used() {
            (0..3).for_each(|i| flux[i] += octave.flux[i]);
            others = (others - octave.energy).max(0.0);
            ways.push(Parts { uniform: flux.iter().map(|x| x * x).sum::<f64>() / (4.0 * PI), others });
        }
        // Of the last nothing is left but rounding.
        if let Some(whole) = ways.last_mut() {
            whole.others = 0.0;
        }
        ways
    }

    /// The brightest octaves that hold nearly all of the energy.
    pub fn brightest(&self) -> Lamps {
        let all: f64 = self.0.iter().map(|octave| octave.energy).sum();
        let sphere: f64 = self.0.iter().map(|octave| octave.solid_angle).sum();
        let mut lamps = Lamps {
            texels: 0,
            of: self.0.iter().map(|octave| octave.texels).sum(),
            area: 0.0,
            share: 0.0,
            spread: 0.0,
        };
        let mut towards = [0.0; 3];
        for octave in self.used() {
            if lamps.share >= NEARLY_ALL {
                break;
            }
            lamps.texels += octave.texels;
            lamps.area += octave.solid_angle / sphere;
            lamps.share += octave.energy / all;
            (0..3).for_each(|i| towards[i] += octave.towards[i] / all);
        }
        let length = towards.iter().map(|x| x * x).sum::<f64>().sqrt();
        lamps.spread = 1.0 - length / lamps.share;
        lamps
    }
}

/// The brightest texels of a map that together hold nearly all of its energy, which is its squared radiance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lamps {
    /// How many they are.
    pub texels: usize,
    /// How many texels the map has.
    pub of: usize,
    /// The share of the sphere that they cover.
    pub area: f64,
    /// The share of the energy that they hold, at least nine tenths.
    pub share: f64,
    /// 0 if all lie in one direction, 1 if all around.
    pub spread: f64,
}

impl Lamps {
    /// Whether they are so small that a low order cannot show them as they are.
    pub fn are_small(&self) -> bool {
        self.area < SMALL
    }

    /// Whether they are one light, within some ten degrees.
    pub fn are_one(&self) -> bool {
        self.spread < 0.015
    }
}
