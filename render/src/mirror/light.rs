//! Light of some bands for a mirror: in one direction, averaged with a Gaussian, and as a table for very many directions.

use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use zonal_codegen::environment::Projection;
use zonal_codegen::environment::harmonics::basis;

/// The rows of a table.
const HEIGHT: usize = 1024;

/// The light of some bands.
pub struct Banded {
    /// The coefficients.
    pub light: Projection,
    /// A latitude-longitude map of what they add up to, twice as wide as high.
    texels: Vec<[f32; 3]>,
    height: usize,
}

impl Banded {
    /// The light of a projection, with a table of so many rows: at 1024 a linear read errs by less than 1 % of band 63, and by the
    /// square less of lower ones.
    pub fn new(light: Projection) -> Self {
        Self::with_rows(light, HEIGHT)
    }

    fn with_rows(light: Projection, height: usize) -> Self {
        let width = 2 * height;
        let order = light.order;
        let waves: Vec<[f32; 2]> = (0..width)
            .map(|x| {
                let (sin, cos) = (TAU * x as f64 / width as f64).sin_cos();
                [cos as f32, sin as f32]
            })
            .collect();
        let row = |y: usize| {
            let (sin, cos) = (PI * (y as f64 + 0.5) / height as f64).sin_cos();
            let mut values = vec![0.0; order * order];
            basis(order, [sin, 0.0, cos], &mut values);
            // For each m what multiplies cos mφ and sin mφ.
            let mut factors = vec![[[0.0f32; 3]; 2]; order];
            for l in 0..order {
                for m in 0..=l {
                    let (plus, minus) = (l * (l + 1) + m, l * (l + 1) - m);
                    for k in 0..3 {
                        factors[m][0][k] += (values[plus] * light.coefficients[plus][k]) as f32;
                        if m > 0 {
                            factors[m][1][k] += (values[plus] * light.coefficients[minus][k]) as f32;
                        }
                    }
                }
            }
            let texel = |x: usize| {
                let mut sum = [0.0f32; 3];
                for (m, [even, odd]) in factors.iter().enumerate() {
                    let [cos, sin] = waves[m * x % width];
                    (0..3).for_each(|k| sum[k] += even[k] * cos + odd[k] * sin);
                }
                sum
            };
            (0..width).map(texel).collect::<Vec<_>>()
        };
        let texels = (0..height).into_par_iter().map(row).collect::<Vec<_>>().concat();
        Self { light, texels, height }
    }

    /// Returns the table's value in a unit direction, linear between its texels.
    pub fn read(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let width = 2 * self.height;
        let column = y.atan2(x) / std::f32::consts::TAU * width as f32;
        let row = (z.clamp(-1.0, 1.0).acos() / std::f32::consts::PI * self.height as f32 - 0.5)
            .clamp(0.0, (self.height - 1) as f32);
        let (left, top) = (column.floor(), (row as usize).min(self.height - 2));
        let (right, down) = (column - left, row - top as f32);
        let left = (left as isize).rem_euclid(width as isize) as usize;
        let next = if left + 1 == width { 0 } else { left + 1 };
        let [a, b, c, d] =
            [(left, top), (next, top), (left, top + 1), (next, top + 1)].map(|(x, y)| self.texels[y * width + x]);
        std::array::from_fn(|k| (a[k] + right * (b[k] - a[k])) * (1.0 - down) + (c[k] + right * (d[k] - c[k])) * down)
    }

    /// Returns the light in a direction, each band times its factor: equation 29.
    pub fn blurred(&self, direction: [f64; 3], factors: &[f64]) -> [f64; 3] {
        let order = self.light.order;
        let mut values = vec![0.0; order * order];
        basis(order, direction, &mut values);
        let mut sum = [0.0; 3];
        for (l, factor) in factors.iter().enumerate() {
            for place in l * l..(l + 1) * (l + 1) {
                let value = factor * values[place];
                (0..3).for_each(|k| sum[k] += value * self.light.coefficients[place][k]);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;

    #[test]
    fn the_table_has_the_light_of_the_bands() {
        let mut random = Random::new(8);
        let order = 9;
        let coefficients = (0..order * order).map(|_| [(); 3].map(|()| random.signed())).collect();
        let banded = Banded::with_rows(Projection { order, coefficients, beyond: 0.0 }, 512);
        for direction in
            [[-1.0, 1e-9, 0.0], [-1.0, -1e-9, 0.0], [0.0, 0.6, 0.8]].into_iter().chain((0..200).map(|_| random.unit()))
        {
            let (found, want) = (banded.read(direction.map(|x| x as f32)), banded.light.evaluate(direction));
            let exact = banded.blurred(direction, &vec![1.0; order]);
            for k in 0..3 {
                // l² h² / 4 for h = π / 512 and band 8, of values of a few units.
                assert!((f64::from(found[k]) - want[k]).abs() < 5e-3, "{direction:?}: {found:?} {want:?}");
                assert!((exact[k] - want[k]).abs() < 1e-12);
            }
        }
    }
}
