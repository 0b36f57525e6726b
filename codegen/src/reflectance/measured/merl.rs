//! MERL's layout of isotropic reflectances (Matusik et al. 2003, the files `.binary`): three int32, 90, 90 and 180, then as
//! many doubles for red, as many for green and for blue, little endian, each channel to be scaled by 1/1500, 1.15/1500 and
//! 1.66/1500. Entry (i, j, k), k fastest, is of
//!
//! * θ_h = (i/90)² 90°, the angle from the normal to the half vector h,
//! * θ_d = j°, that from h to the light,
//! * φ_d = k°, the azimuth of the light about h, from the plane of the normal and h on. Since light and view change places,
//!   φ_d + 180° is φ_d.
//!
//! It is linear between the entries. What is mirrored at the plane of h has 180° − φ_d; of a measurement's two halves the mean
//! is taken.

use crate::environment::harmonics::{basis, turn_about_z};
use crate::fault::Fault;
use crate::math::index::band_degree;
use crate::math::quadrature::gauss_legendre;
use crate::reflectance::measured::entries::{Missing, between, checked, filled, refused};
use std::f64::consts::{FRAC_PI_2, PI};

/// Entries along θ_h, θ_d and φ_d.
pub const SIZE: [usize; 3] = [90, 90, 180];
/// What the doubles of each channel are multiplied by.
pub const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// Elevations of the view, in a quarter turn, between which the table is as good as linear.
pub const STEPS: usize = 90;
/// Nodes a step of θ_h and around half of the normal, by which slices are integrated.
const NODES: [usize; 2] = [2, 96];

/// The entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Merl(Vec<[f32; 3]>);

/// The directions of view and light, the half vector in the plane of x and z.
fn directions(theta_h: f64, theta_d: f64, phi_d: f64) -> [[f64; 3]; 2] {
    let ((sin_h, cos_h), (sin_d, cos_d)) = (theta_h.sin_cos(), theta_d.sin_cos());
    let (sin, cos) = phi_d.sin_cos();
    // The light in the frame of h; the view is opposite about h.
    let of = |x: f64, y: f64| [cos_h * x + sin_h * cos_d, y, cos_h * cos_d - sin_h * x];
    [of(-sin_d * cos, -sin_d * sin), of(sin_d * cos, sin_d * sin)]
}

/// View and light of an entry, as unit vectors.
fn entry(i: usize, j: usize, k: usize) -> [[f64; 3]; 2] {
    let share = i as f64 / SIZE[0] as f64;
    let degrees = |count: usize, of: f64| of * count as f64;
    directions(share * share * FRAC_PI_2, degrees(j, FRAC_PI_2 / SIZE[1] as f64), degrees(k, PI / SIZE[2] as f64))
}

fn int(bytes: &[u8], at: usize) -> i32 {
    let mut word = [0; 4];
    word.copy_from_slice(&bytes[4 * at..4 * at + 4]);
    i32::from_le_bytes(word)
}

impl Merl {
    /// Reads the bytes of a file.
    pub(super) fn read(name: &str, bytes: &[u8]) -> Result<(Self, Missing), Fault> {
        let help = "name a file of MERL's (.binary), an OpenEXR image or an array of NumPy (.npy): docs/SCENE.md has the \
                    layouts";
        if bytes.len() < 12 {
            return Err(refused(
                name,
                format!("it is no tabulated reflectance, its {} bytes are too few", bytes.len()),
                help,
            ));
        }
        let size = [0, 1, 2].map(|at| int(bytes, at));
        if size != SIZE.map(|side| side as i32) {
            let message = format!(
                "it is no tabulated reflectance: neither OpenEXR nor an array of NumPy, and for MERL's layout it begins with {}, \
                 {} and {} instead of 90, 90 and 180",
                size[0], size[1], size[2]
            );
            return Err(refused(name, message, help));
        }
        let count: usize = SIZE.iter().product();
        let wanted = 12 + 24 * count;
        if bytes.len() != wanted {
            let what = if bytes.len() < wanted { "ends too early" } else { "goes on too long" };
            let message =
                format!("it {what}: it has {} bytes, 90 × 90 × 180 entries in RGB take {wanted}", bytes.len());
            return Err(refused(name, message, "take the file from its source again"));
        }
        let (numbers, _) = bytes[12..].as_chunks::<8>();
        let channel = |channel: usize, at: usize| f64::from_le_bytes(numbers[channel * count + at]) * SCALE[channel];
        let values: Vec<[f64; 3]> = (0..count).map(|at| [0, 1, 2].map(|c| channel(c, at))).collect();
        let place = |at: usize| {
            let [_, differences, azimuths] = SIZE;
            let (i, rest) = (at / (differences * azimuths), at % (differences * azimuths));
            format!("half angle {i}, difference angle {}, azimuth {}", rest / azimuths, rest % azimuths)
        };
        Ok(Self::of(checked(name, place, &values)?))
    }

    /// Fills what is missing, then makes the table its own mirror image.
    fn of(mut entries: Vec<[f32; 3]>) -> (Self, Missing) {
        let [halves, differences, azimuths] = SIZE;
        let mut missing = Missing::default();
        let mut line = vec![[0.0; 3]; differences];
        for i in 0..halves {
            for k in 0..azimuths {
                let place = |j: usize| (i * differences + j) * azimuths + k;
                let mut lack = 0;
                for (j, value) in line.iter_mut().enumerate() {
                    *value = entries[place(j)];
                    let is_above = entry(i, j, k).iter().all(|direction| direction[2] > 0.0);
                    missing.of += usize::from(is_above);
                    lack += usize::from(is_above && value.iter().any(|x| *x < 0.0));
                }
                missing.filled += lack;
                if filled(&mut line) {
                    missing.black += lack;
                }
                (0..differences).for_each(|j| entries[place(j)] = line[j]);
            }
        }
        for row in entries.chunks_exact_mut(azimuths) {
            for k in 1..azimuths / 2 {
                let mean = [0, 1, 2].map(|c| 0.5 * (row[k][c] + row[azimuths - k][c]));
                (row[k], row[azimuths - k]) = (mean, mean);
            }
        }
        (Self(entries), missing)
    }

    pub(super) fn entries(&self) -> &[[f32; 3]] {
        &self.0
    }

    /// At θ_h as a share of the table's first side, and at θ_d and φ_d in radians.
    fn interpolated(&self, half: f64, theta_d: f64, phi_d: f64) -> [f64; 3] {
        let [halves, differences, azimuths] = SIZE;
        let (i, up) = between(half * halves as f64, halves - 1);
        let (j, aside) = between(theta_d / FRAC_PI_2 * differences as f64, differences - 1);
        let turn = (phi_d / PI).rem_euclid(1.0) * azimuths as f64;
        let (k, around) = between(turn, azimuths);
        let mut sum = [0.0; 3];
        for (i, a) in [(i, 1.0 - up), (i + 1, up)] {
            for (j, b) in [(j, 1.0 - aside), (j + 1, aside)] {
                for (k, c) in [(k, 1.0 - around), ((k + 1) % azimuths, around)] {
                    let entry = self.0[(i * differences + j) * azimuths + k];
                    (0..3).for_each(|channel| sum[channel] += a * b * c * f64::from(entry[channel]));
                }
            }
        }
        sum
    }

    pub(super) fn at(&self, view: [f64; 3], light: [f64; 3]) -> [f64; 3] {
        let sum = [0, 1, 2].map(|i| view[i] + light[i]);
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            return [0.0; 3];
        }
        let half = sum.map(|x| x / length);
        let sine = half[0].hypot(half[1]);
        let (cos, sin) = if sine > 0.0 { (half[0] / sine, half[1] / sine) } else { (1.0, 0.0) };
        // The light, the half vector turned into the plane of x and z, then to z.
        let [x, y] = [cos * light[0] + sin * light[1], cos * light[1] - sin * light[0]];
        let local = [half[2] * x - sine * light[2], y, sine * x + half[2] * light[2]];
        let theta_d = local[0].hypot(local[1]).atan2(local[2]);
        let share = (sine.atan2(half[2]) / FRAC_PI_2).sqrt();
        self.interpolated(share, theta_d, local[1].atan2(local[0]))
    }

    /// By half vectors, whose grid is the table's own: dl = 4 (v·h) dh. The table is its own mirror image, so that half of the
    /// azimuths are enough.
    pub(super) fn coefficients(&self, view: [f64; 3], order: usize, shown: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        let [sine, up] = [view[0].hypot(view[1]), view[2].max(0.0)];
        let mut sums = vec![0.0; order * order];
        let mut values = vec![0.0; order * order];
        let steps = SIZE[0];
        for step in 0..steps {
            let [from, to] = [step, step + 1].map(|mark| mark as f64 / steps as f64);
            for (share, weight) in gauss_legendre(NODES[0], from, to) {
                let (sin, cos) = (share * share * FRAC_PI_2).sin_cos();
                // sin θ dθ dφ, with θ = (π/2) t² for the share t; twice for the other half.
                let weight = 2.0 * weight * PI * share * sin * PI / NODES[1] as f64;
                for i in 0..NODES[1] {
                    let (y, x) = (PI * (i as f64 + 0.5) / NODES[1] as f64).sin_cos();
                    let half = [sin * x, sin * y, cos];
                    let along = sine * half[0] + up * half[2];
                    let light = [2.0 * along * half[0] - sine, 2.0 * along * half[1], 2.0 * along * half[2] - up];
                    if along > 0.0 && light[2] > 0.0 {
                        let value = shown(self.at([sine, 0.0, up], light)) * light[2] * 4.0 * along * weight;
                        basis(order, light, &mut values);
                        sums.iter_mut().zip(&values).for_each(|(sum, y)| *sum += value * y);
                    }
                }
            }
        }
        sums.iter_mut().enumerate().filter(|(i, _)| band_degree(*i).1 < 0).for_each(|(_, sum)| *sum = 0.0);
        turn_about_z(order, view[1].atan2(view[0]), &mut sums);
        sums
    }
}
