//! Filtering of tabulated reflectances in both directions (Soler et al. 2015, equations 30 to 32): what a separable kernel
//! exp(κ cos) makes of sparse and noisy pairs of directions, and which of the two things that the paper claims of it hold
//! (docs/MATH.md#filtering-in-both-directions).

use crate::markdown::{file, percent, short, table as rows_of};
use crate::raster::Raster;
use crate::sphere::{Axes, Tile, heat};
use crate::svg::{self, Axis, Panel, Picture, Series, Stroke, key};
use crate::{File, Progress, each, significant};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_picture::lights::{Light, Lights};
use zonal_picture::tone;
use zonal_picture::vector::dot;

/// The bands in each direction.
pub const ORDER: usize = 8;
/// How many coefficients a direction has.
const COUNT: usize = ORDER * ORDER;
/// The sharpnesses of the kernel.
pub const SHARPNESSES: [f64; 6] = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
/// The reflectance.
const ROUGHNESS: [f64; 2] = [0.25, 0.6];
/// The share of pairs that are measured.
pub const SHARE: f64 = 0.1;
/// The standard deviation of what a measurement errs by, relative to its value.
pub const NOISE: f64 = 0.3;
/// Elevations, by the rule of Gauss over the cosine, and azimuths of the directions: those that errors are taken at, which are
/// a fine table's too, and those of a coarse table.
const NODES: [[usize; 2]; 2] = [[16, 32], [8, 16]];
/// The views whose albedo is told, in degrees from the normal.
const VIEWS: [f64; 3] = [0.0, 45.0, 75.0];
/// Pixels along a side of a picture's tile, and lights.
const TILE: usize = 112;
const LIGHTS: usize = 256;
/// A change as small as this is what sums round off, on any machine.
const ROUNDING: f64 = 1e-14;
/// The name of the picture.
pub const NAME: &str = "filtering.png";
/// The difference that is white in the picture, relative to the brightest pixel.
const WHITE: f64 = 0.3;

/// What is filtered: the table of which nodes, the share of pairs that are known, the noise.
const DATA: [([usize; 2], f64, f64); 4] =
    [(NODES[0], 1.0, 0.0), (NODES[1], 1.0, NOISE), (NODES[0], SHARE, NOISE), (NODES[1], SHARE, NOISE)];
/// What they are called.
const NAMES: [&str; 4] =
    ["fine table, exact", "coarse table, noisy", "fine table, noisy, one in ten", "coarse table, noisy, one in ten"];

/// What one kernel does; without a sharpness, the bands as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Filtered {
    /// The sharpness.
    pub sharpness: Option<f64>,
    /// The root mean square error against the reflectance, relative to it, of each kind of data.
    pub errors: [f64; 4],
    /// All light that leaves the surface for directions above it, of light from above, relative to the reflectance's own; of
    /// exact data.
    pub above: f64,
    /// The same with what comes from and goes to directions below the horizon.
    pub everywhere: f64,
    /// The albedo of each view, of light from above alone.
    pub albedos: [f64; 3],
    /// The albedo of each view, of light from everywhere.
    pub whole: [f64; 3],
}

/// All that is measured of filtering.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Filtering {
    /// The kernels, the one without a sharpness first.
    pub kernels: Vec<Filtered>,
    /// The albedo of each view without harmonics.
    pub albedos: [f64; 3],
    /// By how much the value changes as view and light change places, at most, relative to the largest value: of sparse data,
    /// projected as they are, before and after the filter; of the same with both directions treated alike.
    pub reciprocity: [[f64; 2]; 2],
    /// The sharpness of the pictures, the best for sparse data.
    pub shown: f64,
    /// The root mean square error of the pictures before and after, relative to the first.
    pub pictures: [f64; 2],
}

/// Returns the factors π_l k_l of a kernel in every band: one in band 0.
pub fn factors(sharpness: f64) -> Vec<f64> {
    // Names a family: the kernel is a Gaussian of the sphere, whose coefficients it makes.
    let spec: Spec = format!("gaussian:{ORDER}").parse().unwrap_or_else(|error| panic!("{error}"));
    let bands = Program::<f64>::new(&Listing::new(&spec.kernel())).run(&[&[sharpness]], Contraction::Separate);
    let pi = |l: usize| (4.0 * PI / (2 * l + 1) as f64).sqrt();
    // √K makes its integral one, which is π_0 k_0.
    bands.iter().enumerate().map(|(l, band)| pi(l) * band / (pi(0) * bands[0])).collect()
}

/// Rows of the view, columns of the light.
type Coefficients = Vec<[f64; COUNT]>;

/// The directions above the surface, with what is known at each.
struct Grid {
    directions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    basis: Vec<[f64; COUNT]>,
}

impl Grid {
    fn new([elevations, azimuths]: [usize; 2]) -> Self {
        let mut grid = Self { directions: vec![], weights: vec![], basis: vec![] };
        for (z, weight) in gauss_legendre(elevations, 0.0, 1.0) {
            for i in 0..azimuths {
                let (y, x) = (TAU * (i as f64 + 0.5) / azimuths as f64).sin_cos();
                let rim = (1.0 - z * z).sqrt();
                grid.directions.push([rim * x, rim * y, z]);
                grid.weights.push(weight * TAU / azimuths as f64);
            }
        }
        grid.basis = grid.directions.iter().map(|&direction| harmonics(direction)).collect();
        grid
    }

    /// The reflectance times both cosines, for each view and light.
    fn reflectance(&self) -> Vec<Vec<f64>> {
        let row = |&view: &[f64; 3]| self.directions.iter().map(|&light| value(view, light)).collect();
        self.directions.par_iter().map(row).collect()
    }

    /// The integrals of what is known times the harmonics of view and light; a pair that is not known is nothing.
    fn projected(&self, known: &[Vec<f64>]) -> Coefficients {
        let mut sums = vec![[0.0; COUNT]; COUNT];
        for (v, row) in known.iter().enumerate() {
            let mut slice = [0.0; COUNT];
            for (l, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                let value = value * self.weights[l];
                slice.iter_mut().zip(&self.basis[l]).for_each(|(sum, y)| *sum += value * y);
            }
            for (sums, y) in sums.iter_mut().zip(&self.basis[v]) {
                let weight = self.weights[v] * y;
                sums.iter_mut().zip(&slice).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        sums
    }

    /// The squared error of coefficients against values, relative to those.
    fn error(&self, coefficients: &Coefficients, truth: &[Vec<f64>]) -> f64 {
        let row = |v: usize| {
            let slice = slice(coefficients, &self.basis[v]);
            let mut sums = [0.0; 2];
            for l in 0..self.directions.len() {
                let (wanted, weight) = (truth[v][l], self.weights[v] * self.weights[l]);
                let error = inner(&slice, &self.basis[l]) - wanted;
                sums = [sums[0] + weight * error * error, sums[1] + weight * wanted * wanted];
            }
            sums
        };
        let rows: Vec<[f64; 2]> = (0..self.directions.len()).into_par_iter().map(row).collect();
        let sum = |part: usize| rows.iter().map(|sums| sums[part]).sum::<f64>();
        (sum(0) / sum(1)).sqrt()
    }

    /// The integral over the directions above, which one slice sends.
    fn above(&self, slice: &[f64; COUNT]) -> f64 {
        self.basis.iter().zip(&self.weights).map(|(y, weight)| weight * inner(slice, y)).sum()
    }
}

fn harmonics(direction: [f64; 3]) -> [f64; COUNT] {
    let mut values = [0.0; COUNT];
    basis(ORDER, direction, &mut values);
    values
}

fn inner(a: &[f64; COUNT], b: &[f64; COUNT]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The reflectance times both cosines: what changes places, and is bounded at the horizon.
fn value(view: [f64; 3], light: [f64; 3]) -> f64 {
    Brdf::Ward { alpha: ROUGHNESS }.value(view, light) * view[2].max(0.0)
}

/// The coefficients of the light for a view whose harmonics are given.
fn slice(coefficients: &Coefficients, view: &[f64; COUNT]) -> [f64; COUNT] {
    let mut sums = [0.0; COUNT];
    for (row, y) in coefficients.iter().zip(view) {
        sums.iter_mut().zip(row).for_each(|(sum, c)| *sum += y * c);
    }
    sums
}

/// Both directions treated alike: the mean of the coefficients and of those with view and light exchanged.
fn alike(coefficients: &Coefficients) -> Coefficients {
    (0..COUNT).map(|a| std::array::from_fn(|b| 0.5 * (coefficients[a][b] + coefficients[b][a]))).collect()
}

/// Every coefficient times the factors of its two bands.
fn filtered(coefficients: &Coefficients, factors: &[f64]) -> Coefficients {
    let of = |a: usize, b: usize| factors[a.isqrt()] * factors[b.isqrt()] * coefficients[a][b];
    (0..COUNT).map(|a| std::array::from_fn(|b| of(a, b))).collect()
}

/// What is measured of each pair: its value with noise, over the share of pairs that are known, so that the mean of what is
/// known is the mean of all; nothing where it is not known.
fn measured(truth: &[Vec<f64>], share: f64, noise: f64) -> Vec<Vec<f64>> {
    let mut random = Random::new(11);
    // Twelve even numbers have the variance of a normal one.
    let mut normal = || (0..12).map(|_| 0.5 * random.signed()).sum::<f64>();
    let mut chance = Random::new(12);
    let mut of = |&value: &f64| {
        let noisy = value * (1.0 + noise * normal());
        let is_known = 0.5 * (chance.signed() + 1.0) < share;
        if is_known { noisy / share } else { 0.0 }
    };
    truth.iter().map(|row| row.iter().map(&mut of).collect()).collect()
}

/// The largest difference between a value and the one with view and light exchanged, over seeded pairs, relative to the
/// largest value.
fn exchanged(coefficients: &Coefficients) -> f64 {
    let mut random = Random::new(13);
    let (mut apart, mut size) = (0.0f64, 0.0f64);
    for _ in 0..500 {
        let [view, light] = [harmonics(random.unit()), harmonics(random.unit())];
        let (there, back) = (inner(&slice(coefficients, &view), &light), inner(&slice(coefficients, &light), &view));
        apart = apart.max((there - back).abs());
        size = size.max(there.abs());
    }
    apart / size
}

fn view_at(degrees: f64) -> [f64; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [sin, 0.0, cos]
}

/// Measures filtering and draws its picture.
pub fn measure(progress: &dyn Progress) -> (Filtering, Raster) {
    let grid = Grid::new(NODES[0]);
    let truth = grid.reflectance();
    let data: Vec<Coefficients> = DATA
        .iter()
        .map(|&(nodes, share, noise)| {
            let grid = Grid::new(nodes);
            grid.projected(&measured(&grid.reflectance(), share, noise))
        })
        .collect();
    let even: Vec<Coefficients> = data.iter().map(alike).collect();
    let sparse = &even[even.len() - 1];
    let all = |of: &dyn Fn(usize) -> f64| (0..grid.directions.len()).map(|v| grid.weights[v] * of(v)).sum::<f64>();
    let total = all(&|v| truth[v].iter().zip(&grid.weights).map(|(value, weight)| weight * value).sum());
    let kernels: Vec<Option<f64>> = std::iter::once(None).chain(SHARPNESSES.map(Some)).collect();
    let kernels = each(progress, "filtering", &kernels, |&sharpness| {
        let factors = sharpness.map_or_else(|| vec![1.0; ORDER], factors);
        let all_filtered: Vec<Coefficients> = even.iter().map(|data| filtered(data, &factors)).collect();
        let exact = &all_filtered[0];
        let slice_at = |degrees: f64| slice(exact, &harmonics(view_at(degrees)));
        let cosine = |degrees: f64| degrees.to_radians().cos();
        Filtered {
            sharpness,
            errors: [0, 1, 2, 3].map(|i| significant(grid.error(&all_filtered[i], &truth))),
            above: significant(all(&|v| grid.above(&slice(exact, &grid.basis[v]))) / total),
            everywhere: significant(4.0 * PI * exact[0][0] / total),
            albedos: VIEWS.map(|degrees| significant(grid.above(&slice_at(degrees)) / cosine(degrees))),
            whole: VIEWS.map(|degrees| significant((4.0 * PI).sqrt() * slice_at(degrees)[0] / cosine(degrees))),
        }
    });
    let best = kernels.iter().skip(1).min_by(|a, b| a.errors[3].total_cmp(&b.errors[3]));
    let shown = best.and_then(|best| best.sharpness).unwrap_or(SHARPNESSES[0]);
    let after = filtered(sparse, &factors(shown));
    let albedo = |degrees: f64| {
        let view = view_at(degrees);
        let light: f64 = grid.directions.iter().zip(&grid.weights).map(|(&l, weight)| weight * value(view, l)).sum();
        significant(light / degrees.to_radians().cos())
    };
    let pair = |coefficients: &Coefficients| {
        [coefficients.clone(), filtered(coefficients, &factors(shown))]
            .map(|c| significant(exchanged(&c)).max(ROUNDING))
    };
    let reciprocity = [pair(&data[data.len() - 1]), pair(sparse)];
    let (pictures, raster) = draw(sparse, &after);
    (Filtering { kernels, albedos: VIEWS.map(albedo), reciprocity, shown, pictures }, raster)
}

/// Light in the direction of the eye times its cosine.
fn shaded(lights: &Lights, axes: Axes, mut of: impl FnMut([f64; 3]) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for Light { direction, power } in &lights.0 {
        let value = of(axes.map(|axis| dot(axis, *direction)));
        (0..3).for_each(|channel| sum[channel] += value * power[channel]);
    }
    sum
}

/// The reflectance, what was measured before and after the filter, and what those miss.
fn draw(before: &Coefficients, after: &Coefficients) -> ([f64; 2], Raster) {
    let maps = crate::hemisphere::maps();
    let (_, map) = maps.iter().find(|(name, _)| *name == "city").unwrap_or(&maps[0]);
    let lights = Lights::of(map).gathered(LIGHTS);
    let pixel = |i: usize| {
        let (axes, view) = Tile { side: TILE }.surface(i % TILE, i / TILE)?;
        let y = harmonics(view);
        let truth = shaded(&lights, axes, |light| value(view, light));
        let [before, after] = [before, after].map(|coefficients| {
            let slice = slice(coefficients, &y);
            shaded(&lights, axes, |light| inner(&slice, &harmonics(light)))
        });
        Some([truth, before, after])
    };
    let pixels: Vec<Option<[[f64; 3]; 3]>> = (0..TILE * TILE).into_par_iter().map(pixel).collect();
    let exposure = tone::exposure(pixels.iter().flatten().map(|shown| shown[0]));
    let most = pixels.iter().flatten().map(|shown| tone::luminance(shown[0])).fold(0.0, f64::max);
    let mut raster = Raster::new(NAME, [5 * TILE, TILE]);
    let mut sums = [0.0; 3];
    for (i, shown) in pixels.iter().enumerate().filter_map(|(i, shown)| Some((i, shown.as_ref()?))) {
        let place = |tile: usize| [tile * TILE + i % TILE, i / TILE];
        for (tile, &radiance) in shown.iter().enumerate() {
            let exposed = radiance.map(|c| exposure * c);
            raster.set(place(tile), if exposed.iter().any(|c| *c < 0.0) { exposed } else { tone::mapped(exposed) });
        }
        for part in [1, 2] {
            let error = (0..3).map(|c| (shown[part][c] - shown[0][c]).powi(2)).sum::<f64>();
            sums[part] += error;
            raster.set(place(2 + part), heat((error / 3.0).sqrt() / (WHITE * most)));
        }
        sums[0] += shown[0].iter().map(|c| c * c).sum::<f64>();
    }
    ([1, 2].map(|part| significant((sums[part] / sums[0]).sqrt())), raster)
}

/// The page.
pub fn table(filtering: &Filtering) -> File {
    let named = |sharpness: Option<f64>| sharpness.map_or("none".to_owned(), |sharpness| sharpness.to_string());
    let list = |values: &[f64]| values.iter().map(|value| short(*value)).collect::<Vec<_>>().join(" / ");
    let errors = filtering.kernels.iter().map(|row| {
        let mut cells = vec![named(row.sharpness)];
        cells.extend(row.errors.map(percent));
        cells
    });
    let energy = filtering.kernels.iter().map(|row| {
        vec![named(row.sharpness), short(row.everywhere), short(row.above), list(&row.albedos), list(&row.whole)]
    });
    let pairs = |[elevations, azimuths]: [usize; 2]| (elevations * azimuths).pow(2);
    let unfiltered = |data: usize| filtering.kernels.first().map_or(0.0, |row| row.errors[data]);
    let best = |data: usize| filtering.kernels.iter().skip(1).map(|row| row.errors[data]).fold(f64::INFINITY, f64::min);
    let [bands, widest] =
        [0, 1].map(|i| filtering.kernels.get(i).map_or([[0.0; 3]; 2], |row| [row.albedos, row.whole]));
    let [uneven, even] = filtering.reciprocity;
    let [before, after] = filtering.pictures.map(percent);
    let parts = [
        format!(
            "Equations 30 to 32 of Soler et al. 2015: a table of pairs of directions, projected on {ORDER} bands of the view and \
             {ORDER} of the light, {} numbers a channel, each times the factors π_l k_l of its two bands. (The paper divides by π_l \
             and prints 1/√K for √K, both of which the convolution theorem refuses; so multiplied, the factor of band 0 is one.) \
             The table is Ward's reflectance of roughness {} and {} times both cosines, which view and light may exchange and \
             which is bounded at the horizon, where the reflectance alone is not. A fine table has {} pairs, a coarse one {}; of \
             these one in {} is measured, each with a noise of {} % of its value, seeded.",
            COUNT * COUNT,
            ROUGHNESS[0],
            ROUGHNESS[1],
            pairs(NODES[0]),
            pairs(NODES[1]),
            (1.0 / SHARE).round(),
            percent(NOISE),
        ),
        format!(
            "## Error\n\nThe root mean square error against the reflectance, over all pairs above the horizon, in per cent. Without a \
             kernel it is that of the bands alone. Missing pairs count as nothing, known ones for ten. The projection is a mean over \
             all pairs and takes most of the noise by itself where there are many: one in ten of the fine table is {} % off before \
             and {} % after the best kernel. Where fewer pairs are known than there are coefficients, as of the coarse one, the \
             filter pays: {} % and {} %. What it costs is the first column: every kernel blurs what is exact.\n\n\
             ![The error over the sharpness](filtering.svg)",
            percent(unfiltered(2)),
            percent(best(2)),
            percent(unfiltered(3)),
            percent(best(3)),
        ),
        rows_of(&["κ"].into_iter().chain(NAMES).collect::<Vec<_>>(), errors),
        format!(
            "![Sphere: the reflectance, before, after, what both miss]({NAME})\n\nFigure 11 of the paper, on a sphere under the map \
             *city*: the reflectance, one pair in ten of the coarse table before the filter, after that of κ = {}, and what both miss, \
             white from {} % of the brightest pixel on. Each pixel is the light times the cosine of the view. What is negative is \
             blue. Before, the picture is {before} % off in the root mean square, after {after} %.",
            filtering.shown,
            percent(WHITE),
        ),
        format!(
            "## Reciprocity\n\nIt holds if the projection treats both directions alike, as here by taking the mean of the \
             coefficients and of those exchanged: view and light exchanged change the value by {} of the largest at most before the \
             filter and by {} after it. The filter keeps it since its factors are the same in both directions; it does not make \
             it: of the same pairs as they were measured the value changes by {} before and {} after.",
            short(even[0]),
            short(even[1]),
            short(uneven[0]),
            short(uneven[1]),
        ),
        format!(
            "## Energy\n\nThe paper says that the filter keeps energy conservation. Over the whole sphere it does, exactly: band 0 is \
             times one. But the kernel also carries light across the horizon, where none is reflected. *Everywhere*: all that the \
             exact table sends, from and to all directions of the sphere, relative to the reflectance; *above*: what of it comes \
             from above the horizon and stays there; then the albedo of views at {} degrees, from above, and from everywhere, \
             as a sum over all coefficients gives it. Without harmonics the albedos are {}. So the claim does not hold view by view: \
             the kernel of κ = {} takes the albedo of the steepest of these views from {} to {}, that of the lowest, with all that \
             the sum holds, from {} to {}.",
            VIEWS.map(|degrees| degrees.to_string()).join(", "),
            list(&filtering.albedos),
            SHARPNESSES[0],
            short(bands[0][0]),
            short(widest[0][0]),
            short(bands[1][2]),
            short(widest[1][2]),
        ),
        rows_of(&["κ", "everywhere", "above", "albedo from above", "albedo from everywhere"], energy),
    ];
    file("filtering", "Filtering a tabulated reflectance", &parts)
}

/// The plot of the errors.
pub fn plot(filtering: &Filtering) -> File {
    let series = |data: usize, dashed: bool| {
        let of = |row: &Filtered| Some((row.sharpness?, row.errors[data]));
        let points: Vec<(f64, f64)> = filtering.kernels.iter().filter_map(of).collect();
        let ends = [SHARPNESSES[0], SHARPNESSES[SHARPNESSES.len() - 1]];
        let flat = filtering.kernels.first().map_or(0.0, |row| row.errors[data]);
        match dashed {
            true => Series { colour: data, stroke: Stroke::Dashed, points: ends.map(|x| (x, flat)).to_vec() },
            false => Series { colour: data, stroke: Stroke::Dotted, points },
        }
    };
    let picture = Picture {
        title: "Filtering in both directions".to_owned(),
        subtitle: "Dashed: the bands without a filter".to_owned(),
        size: [560.0, 360.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::logarithmic("sharpness of the kernel", 5.0, 200.0, &SHARPNESSES),
            y: Axis::decades("relative rms error", 0.1, 1.0),
            series: (0..4).flat_map(|data| [series(data, false), series(data, true)]).collect(),
        }],
        keys: NAMES.iter().enumerate().map(|(i, name)| key(name, i, Stroke::Dotted)).collect(),
    };
    svg::file("filtering", &picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition of the factors by quadrature: π_l ∫ √K exp(κ z) y_l^0.
    #[test]
    fn factors_are_the_integrals_of_the_kernel() {
        for sharpness in SHARPNESSES {
            let root = sharpness / (2.0 * TAU * sharpness.sinh());
            for (l, factor) in factors(sharpness).into_iter().enumerate() {
                let norm = ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
                let kernel = |z: f64| {
                    root * (sharpness * z).exp() * norm * zonal_codegen::families::isd::directions::legendre(l, z)[0]
                };
                let integral: f64 = gauss_legendre(200, -1.0, 1.0).map(|(z, weight)| TAU * weight * kernel(z)).sum();
                let wanted = (4.0 * PI / (2 * l + 1) as f64).sqrt() * integral;
                // A rule of 200 nodes is exact to rounding up to a sharpness of 200.
                assert!((factor - wanted).abs() < 1e-12, "{sharpness}, band {l}: {factor}, {wanted}");
            }
        }
    }

    /// A filtered function is the convolution: integrals over both directions, at a few pairs.
    #[test]
    fn filtering_is_a_convolution_in_both_directions() {
        let mut random = Random::new(5);
        let coefficients: Coefficients = (0..COUNT).map(|_| std::array::from_fn(|_| random.signed())).collect();
        let (sharpness, root) = (10.0f64, 10.0 / (2.0 * TAU * 10f64.sinh()));
        let wanted = filtered(&coefficients, &factors(sharpness));
        for _ in 0..2 {
            let ends: [[f64; 3]; 2] = [random.unit(), random.unit()];
            let sums = ends.map(|end| {
                let mut sum = [0.0; COUNT];
                for (z, weight) in gauss_legendre(40, -1.0, 1.0) {
                    for i in 0..64 {
                        let (y, x) = (TAU * f64::from(i) / 64.0).sin_cos();
                        let rim = (1.0 - z * z).sqrt();
                        let direction = [rim * x, rim * y, z];
                        let kernel = root * (sharpness * dot(direction, end)).exp() * weight * TAU / 64.0;
                        sum.iter_mut().zip(harmonics(direction)).for_each(|(sum, y)| *sum += kernel * y);
                    }
                }
                sum
            });
            let found = inner(&slice(&coefficients, &sums[0]), &sums[1]);
            let value = inner(&slice(&wanted, &harmonics(ends[0])), &harmonics(ends[1]));
            assert!((found - value).abs() < 1e-9 * (1.0 + value.abs()), "{found}, {value}");
        }
    }
}
