//! What a mirror shows over a pixel: how far the mirrored direction moves there, the Gaussian that its light is averaged with,
//! and what that does to harmonics (docs/MATH.md#antialiased-reflections; Soler et al. 2015, section 6.2). It knows neither
//! maps nor pictures.

use crate::vector::{across, add, cross, dot, unit};
use zonal_codegen::environment::harmonics::basis;
// Names a family: its coefficients are what a Gaussian does to the bands of a light.
use zonal_codegen::families::parts::zonal::Gaussian;
use zonal_codegen::families::zonal_functions::declared_gaussian;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::kernel::{Builder, Shape};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::quadrature::gauss_legendre;

/// The sharpness that stands for a flat mirror: at it band 63 loses 2e-5 of itself.
pub const SHARPEST: f64 = 1e8;

/// How the direction in which a mirror is looked at moves over a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// The mirrored direction, of length 1.
    pub direction: [f64; 3],
    /// By how much it moves for a step of a pixel to the right and for one down, across itself: the columns of D.
    pub moves: [[f64; 3]; 2],
}

/// A Gaussian over directions, of unit integral: a plane one, laid onto the sphere about its third axis without changing areas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The axis along which it is widest, that across it, and its middle, all of length 1 and at right angles.
    pub axes: [[f64; 3]; 3],
    /// The standard deviations along the first two, in radians.
    pub deviations: [f64; 2],
}

impl Footprint {
    /// The footprint of a pixel where the unit direction from the eye to the surface is `view`, the unit normal of the mirror
    /// `normal`, and its derivatives by the pixel's two directions `slopes`: D = −2 ((d·n) J + n (dᵀJ)).
    pub fn new(view: [f64; 3], normal: [f64; 3], slopes: [[f64; 3]; 2]) -> Self {
        let cosine = dot(view, normal);
        let moves = slopes.map(|slope| add(slope.map(|x| -2.0 * cosine * x), -2.0 * dot(view, slope), normal));
        Self { direction: add(view, -2.0 * cosine, normal), moves }
    }

    /// Returns the sharpness κ = 2 / (σ² tr D Dᵀ) of the Gaussian exp(κ (cos − 1)) that is as wide as what a pixel of the
    /// variance σ² (in squares of its side) sees, from 0, the mean of all directions, to [`SHARPEST`], a flat mirror. What is no
    /// number is taken for 0.
    pub fn sharpness(&self, variance: f64) -> f64 {
        let trace: f64 = self.moves.iter().map(|&step| dot(step, step)).sum();
        let sharpness = 2.0 / (variance * trace);
        if sharpness.is_nan() { 0.0 } else { sharpness.clamp(0.0, SHARPEST) }
    }

    /// Returns the Gaussian of the covariance σ² D Dᵀ, no narrower along either axis than `least` and no wider than `most`, which is
    /// what it has where D is no number.
    pub fn spread(&self, variance: f64, [least, most]: [f64; 2]) -> Spread {
        let middle = unit(self.direction).unwrap_or([0.0, 0.0, 1.0]);
        let x = across(self.moves[0].map(finite), middle);
        let y = cross(middle, x);
        // D in these axes, and the angle of the larger of its left singular vectors.
        let [[a, c], [b, d]] = self.moves.map(|step| [dot(step, x), dot(step, y)].map(finite));
        let (xx, xy, yy) = (a * a + b * b, a * c + b * d, c * c + d * d);
        let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
        let first = add(x.map(|v| cos * v), sin, y);
        let half = 0.5 * (xx - yy).hypot(2.0 * xy);
        let is_number = !self.moves.as_flattened().iter().any(|x| x.is_nan());
        let of = |sign: f64| (variance * (0.5 * (xx + yy) + sign * half).max(0.0)).sqrt().clamp(least, most);
        let wide = |sign: f64| if is_number { of(sign) } else { most };
        Spread { axes: [first, cross(middle, first), middle], deviations: [wide(1.0), wide(-1.0)] }
    }
}

/// A number in its place, whose square is one too.
fn finite(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x.clamp(-1e100, 1e100) }
}

impl Spread {
    /// Returns the direction that a place of the plane comes to, in units of the deviations; none beyond the sphere.
    pub fn direction(&self, [a, b]: [f64; 2]) -> Option<[f64; 3]> {
        let local = laid([a * self.deviations[0], b * self.deviations[1]])?;
        let [x, y, z] = self.axes;
        Some(add(add(x.map(|v| v * local[0]), local[1], y), local[2], z))
    }

    /// Returns the rotation that takes the world to the Gaussian's axes, a unit quaternion (x, y, z, w).
    pub fn to_local(&self) -> [f64; 4] {
        let [x, y, z] = self.axes;
        // Rows are the axes: the largest component first.
        let m = [x, y, z];
        let trace = m[0][0] + m[1][1] + m[2][2];
        let squares = [0, 1, 2].map(|i| 1.0 + 2.0 * m[i][i] - trace);
        let largest = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
        let q = if 1.0 + trace > squares[largest] {
            [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1.0 + trace]
        } else {
            let (i, j, k) = (largest, (largest + 1) % 3, (largest + 2) % 3);
            let mut q = [0.0; 4];
            q[i] = squares[i];
            q[j] = m[j][i] + m[i][j];
            q[k] = m[k][i] + m[i][k];
            q[3] = m[k][j] - m[j][k];
            q
        };
        let size = q.iter().map(|v| v * v).sum::<f64>().sqrt();
        q.map(|v| v / size)
    }
}

/// A place of the plane on the sphere, areas unchanged (Lambert): none beyond 2, where the opposite direction is.
fn laid([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    let square = x * x + y * y;
    let shrink = (1.0 - 0.25 * square).max(0.0).sqrt();
    (square <= 4.0).then_some([x * shrink, y * shrink, 1.0 - 0.5 * square])
}

/// Returns places of the plane that stand for a Gaussian of deviation one with the same weight each: `rings` of as many `spokes`.
pub fn places(rings: usize, spokes: usize) -> Vec<[f64; 2]> {
    let place = |i: usize| {
        let (ring, spoke) = (i / spokes, i % spokes);
        let radius = (-2.0 * (1.0 - (ring as f64 + 0.5) / rings as f64).ln()).sqrt();
        // Every other ring is turned by half a step.
        let angle = std::f64::consts::TAU * (spoke as f64 + 0.5 * (ring % 2) as f64) / spokes as f64;
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..rings * spokes).map(place).collect()
}

/// What Gaussians of every sharpness do to the bands of a light.
pub struct Attenuation {
    order: usize,
    kernel: Program<f64>,
}

impl Attenuation {
    /// For so many bands, to 64, by the coefficients of `gaussian`.
    pub fn new(order: usize) -> Self {
        let mut builder = Builder::new();
        let e = declared_gaussian(&mut builder, order, Gaussian::exact(order));
        let kernel = builder.finish(e, Shape::Array(order), "the zonal coefficients, one a band");
        Self { order, kernel: Program::new(&Listing::new(&kernel)) }
    }

    /// Returns the operations of the coefficients.
    pub fn operations(order: usize) -> usize {
        let mut builder = Builder::new();
        let e = declared_gaussian(&mut builder, order, Gaussian::exact(order));
        let kernel = builder.finish(e, Shape::Array(order), "the zonal coefficients, one a band");
        Listing::new(&kernel).cost(1).total
    }

    /// Returns β_l π_l of the Gaussian exp(κ (cos − 1)) brought to unit integral, by which convolution multiplies band l: one for
    /// band 0.
    pub fn factors(&self, kappa: f64) -> Vec<f64> {
        let e = self.kernel.run(&[&[kappa]], Contraction::Separate);
        (0..self.order).map(|l| e[l] / (e[0] * ((2 * l + 1) as f64).sqrt())).collect()
    }
}

/// The coefficients of an order of a [`Spread`] of some deviations, in its own axes: only those of even orders m ≥ 0 are not zero.
pub fn slice(deviations: [f64; 2], order: usize) -> Vec<f64> {
    const SPOKES: usize = 96;
    // To e⁻²⁰ of the middle, and no further than the sphere reaches.
    let farthest = 20f64;
    let (mut sums, mut values, mut whole) = (vec![0.0; order * order], vec![0.0; order * order], 0.0);
    for (depth, weight) in gauss_legendre(48, 0.0, farthest) {
        let (radius, weight) = ((2.0 * depth).sqrt(), weight * (-depth).exp());
        for spoke in 0..SPOKES {
            let (sin, cos) = (std::f64::consts::TAU * (spoke as f64 + 0.5) / SPOKES as f64).sin_cos();
            let Some(direction) = laid([radius * cos * deviations[0], radius * sin * deviations[1]]) else { continue };
            basis(order, direction, &mut values);
            whole += weight;
            sums.iter_mut().zip(&values).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    sums.iter().map(|sum| sum / whole).collect()
}

/// Slices of Gaussians over both deviations, to look up.
pub struct Slices {
    order: usize,
    least: f64,
    step: f64,
    /// By the logarithm of the first deviation, then of the second.
    entries: Vec<Vec<f64>>,
}

impl Slices {
    /// How many deviations a table has along each side.
    pub const SIDE: usize = 24;

    /// Those of an order from one deviation to another.
    pub fn new(order: usize, [least, most]: [f64; 2]) -> Self {
        let step = (most / least).ln() / (Self::SIDE - 1) as f64;
        let deviation = |i: usize| least * (step * i as f64).exp();
        let mut entries: Vec<Vec<f64>> = Vec::new();
        for (i, j) in (0..Self::SIDE).flat_map(|i| (0..Self::SIDE).map(move |j| (i, j))) {
            if i <= j {
                entries.push(slice([i, j].map(deviation), order));
                continue;
            }
            // A quarter turn about the middle.
            let turned = |(place, value): (usize, &f64)| {
                let l = place.isqrt();
                let m = place.abs_diff(l * (l + 1));
                if m % 4 == 2 { -value } else { *value }
            };
            entries.push(entries[j * Self::SIDE + i].iter().enumerate().map(turned).collect());
        }
        Self { order, least, step, entries }
    }

    /// Returns the coefficients for two deviations, interpolated by their logarithms; those beyond the table are taken for its
    /// ends.
    pub fn at(&self, deviations: [f64; 2]) -> Vec<f64> {
        let last = Self::SIDE - 1;
        let split = deviations.map(|deviation| {
            let place = ((deviation / self.least).ln() / self.step).clamp(0.0, last as f64);
            let low = (place as usize).min(last - 1);
            (low, place - low as f64)
        });
        let [(i, down), (j, along)] = split;
        let mut sum = vec![0.0; self.order * self.order];
        for (i, vertical) in [(i, 1.0 - down), (i + 1, down)] {
            for (j, horizontal) in [(j, 1.0 - along), (j + 1, along)] {
                let entry = &self.entries[i * Self::SIDE + j];
                sum.iter_mut().zip(entry).for_each(|(sum, value)| *sum += vertical * horizontal * value);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::length;
    use zonal_codegen::promise::samples::Random;

    fn mirrored(view: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
        add(view, -2.0 * dot(view, normal), normal)
    }

    fn footprint(random: &mut Random) -> (Footprint, [[f64; 3]; 3]) {
        let (view, normal) = (random.unit::<3>(), random.unit::<3>());
        let slopes = [(); 2].map(|()| cross(normal, random.unit::<3>()).map(|x| 0.3 * x));
        (Footprint::new(view, normal, slopes), [view, normal, slopes[0]])
    }

    #[test]
    fn the_direction_moves_as_differences_say() {
        let mut random = Random::new(5);
        for _ in 0..100 {
            let (found, [view, normal, slope]) = footprint(&mut random);
            let step = 1e-6;
            let at = |s: f64| mirrored(view, unit(add(normal, s, slope)).expect("a normal"));
            let want = add(at(step), -1.0, at(-step)).map(|x| x / (2.0 * step));
            // Differences err by the square of the step and by rounding over it.
            assert!(length(add(found.moves[0], -1.0, want)) < 1e-9, "{found:?} {want:?}");
            assert!(
                dot(found.moves[0], found.direction).abs() < 1e-12 && (length(found.direction) - 1.0).abs() < 1e-12
            );
        }
    }

    #[test]
    fn extremes_have_a_sharpness() {
        let flat = Footprint::new([0.0, 0.6, -0.8], [0.0, 0.0, 1.0], [[0.0; 3]; 2]);
        assert_eq!(flat.sharpness(0.25), SHARPEST);
        let spread = flat.spread(0.25, [0.01, 1.0]);
        assert_eq!(spread.deviations, [0.01; 2]);
        // At grazing d·n is zero: what turns the normal about the view moves nothing, what lifts it twice as much.
        let grazing = |slope: [f64; 3]| Footprint::new([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [slope, [0.0; 3]]);
        assert_eq!(grazing([0.0, 0.5, 0.0]).sharpness(1.0), SHARPEST);
        assert_eq!(grazing([0.5, 0.0, 0.0]).sharpness(1.0), 2.0);
        assert_eq!(flat.sharpness(0.0), SHARPEST, "no pixel at all");
        for huge in [1e30, 1e200, f64::MAX, f64::INFINITY, f64::NEG_INFINITY] {
            let found = Footprint::new([0.0, 0.6, -0.8], [0.0, 0.0, 1.0], [[huge, 0.0, 0.0], [0.0; 3]]);
            let sharpness = found.sharpness(0.25);
            assert!((0.0..1e-50).contains(&sharpness), "{huge}: {sharpness}");
            let spread = found.spread(0.25, [0.01, 1.0]);
            assert!(
                spread.deviations[0] == 1.0 && spread.axes.as_flattened().iter().all(|x| x.is_finite()),
                "{spread:?}"
            );
        }
        let none = Footprint::new([0.0, 0.6, -0.8], [0.0, 0.0, 1.0], [[f64::NAN; 3]; 2]);
        assert_eq!(none.sharpness(0.25), 0.0);
        assert!(none.spread(0.25, [0.01, 1.0]).axes.as_flattened().iter().all(|x| x.is_finite()));
    }

    #[test]
    fn a_spread_has_the_covariance_of_the_footprint() {
        let mut random = Random::new(6);
        for _ in 0..50 {
            let (found, _) = footprint(&mut random);
            let variance = 1e-4;
            let spread = found.spread(variance, [0.0, 10.0]);
            let [x, y, z] = spread.axes;
            assert!(length(add(cross(x, y), -1.0, z)) < 1e-12 && length(add(z, -1.0, found.direction)) < 1e-12);
            for u in [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8], random.unit::<3>()] {
                let want: f64 = found.moves.iter().map(|step| variance * dot(*step, u).powi(2)).sum();
                let [a, b] = spread.deviations;
                let got = (a * dot(x, u)).powi(2) + (b * dot(y, u)).powi(2);
                assert!((got - want).abs() < 1e-15 + 1e-9 * want, "{got} {want}");
            }
            // The isotropic one has the mean of both variances.
            let [a, b] = spread.deviations;
            let sharpness = found.sharpness(variance);
            assert!((sharpness * (a * a + b * b) / 2.0 - 1.0).abs() < 1e-9);
            let q = spread.to_local();
            let m = zonal_codegen::promise::samples::matrix_of(q);
            for (i, axis) in spread.axes.iter().enumerate() {
                let row: f64 = (0..3).map(|k| (m[3 * k + i] - axis[k]).abs()).sum();
                assert!(row < 1e-9, "{m:?} {:?}", spread.axes);
            }
        }
    }

    #[test]
    fn a_round_slice_is_the_zonal_gaussian() {
        let (order, all) = (12, Attenuation::new(12));
        for deviation in [0.05, 0.2, 0.3] {
            let factors = all.factors(1.0 / (deviation * deviation));
            let found = slice([deviation; 2], order);
            for l in 0..order {
                let want = factors[l] * ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
                for m in -(l as isize)..=l as isize {
                    let place = (l * (l + 1)).wrapping_add_signed(m);
                    let want = if m == 0 { want } else { 0.0 };
                    // Beyond e⁻²⁰ nothing is summed.
                    assert!((found[place] - want).abs() < 1e-7, "{deviation} {l} {m}: {} {want}", found[place]);
                }
            }
        }
        assert!(all.factors(0.0)[1..].iter().all(|factor| *factor == 0.0) && all.factors(0.0)[0] == 1.0);
        // e^(−l(l+1) / 2κ), to the first order in 1/κ.
        let sharp = all.factors(SHARPEST);
        assert!(
            (0..order).all(|l| (1.0 - sharp[l] - (l * (l + 1)) as f64 / (2.0 * SHARPEST)).abs() < 1e-12),
            "{sharp:?}"
        );
    }

    #[test]
    fn factors_of_many_bands_are_those_of_few() {
        let [few, many] = [16, 64].map(Attenuation::new);
        for kappa in [0.0, 1e-3, 0.7, 9.0, 30.0, 117.0, 119.0, 1e3, 1e6] {
            let (few, many) = (few.factors(kappa), many.factors(kappa));
            // What MATH says of both ways, in units of the first: 1.5e-14; divided by it twice that.
            assert!(few.iter().zip(&many).all(|(a, b)| (a - b).abs() < 1e-12), "{kappa}: {few:?} {many:?}");
            assert!(many.is_sorted_by(|a, b| *b <= *a + 1e-9) && many.iter().all(|f| *f > -1e-9), "{kappa}: {many:?}");
        }
    }

    #[test]
    fn slices_are_looked_up_as_they_are() {
        let table = Slices::new(6, [0.05, 0.6]);
        for deviations in [[0.05, 0.05], [0.3, 0.07], [0.6, 0.6], [0.21, 0.2]] {
            let (found, want) = (table.at(deviations), slice(deviations, 6));
            let size = want.iter().map(|x| x * x).sum::<f64>().sqrt();
            let error = found.iter().zip(&want).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            // A step of 11 % in the deviation, half of its square over eight, twice.
            assert!(error < 4e-3 * size, "{deviations:?}: {error} of {size}");
        }
        assert_eq!(table.at([1e-9, 1e9]), table.at([0.05, 0.6]));
    }

    #[test]
    fn places_have_a_deviation_of_one() {
        let all = places(12, 24);
        let mean = |f: fn(&[f64; 2]) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        assert!(mean(|p| p[0]).abs() < 1e-12 && mean(|p| p[0] * p[1]).abs() < 1e-12);
        // The outermost of twelve rings has half of a logarithm's end left out.
        assert!((mean(|p| p[0] * p[0]) - 1.0).abs() < 0.04 && (mean(|p| p[1] * p[1]) - 1.0).abs() < 0.04);
    }
}
