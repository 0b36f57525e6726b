//! The order that a scene gets is the smallest that keeps its budget, by a truth that knows no harmonics of a reflectance:
//! what a surface reflects of the map and of what an order leaves of it, texel by texel, in many frames.

use rayon::prelude::*;
use std::f64::consts::PI;
use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::plan::Plan;
use zonal_codegen::plan::environment::EnvironmentPlan;
use zonal_codegen::plan::order::weights;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::reflectance::seen;
use zonal_codegen::scene::{Light, Maps, Scene};
use zonal_tests::command::Folder;
use zonal_tests::repository;

const MAPS: [&str; 8] = ["city", "courtyard", "forest", "interior", "night", "studio", "sunrise", "sunset"];
const BRDFS: [&str; 4] = ["lambert", "phong:5", "phong:20", "ward:0.3:0.6"];
const BUDGETS: [f64; 3] = [0.1, 0.05, 0.02];
const MAX_ORDER: usize = 12;
/// How many frames a truth is measured in.
const FRAMES: usize = 1000;
/// Of how many views they are.
const VIEWS: usize = 250;
/// How many of its standard errors a truth may be off by.
const SIGMAS: f64 = 3.0;

/// A map of half as many columns and rows, each texel the mean of four, as the bytes of an uncompressed Radiance HDR.
fn halved(name: &str) -> Vec<u8> {
    let map = Map::read(&repository(&format!("scenes/maps/{name}_256x128.hdr"))).expect("is a map");
    let (width, height) = (map.width / 2, map.height / 2);
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let mut mean = [0.0; 3];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let texel = map.texels[(2 * y + dy) * map.width + 2 * x + dx];
            (0..3).for_each(|c| mean[c] += 0.25 * texel[c]);
        }
        let largest = mean.into_iter().fold(0.0, f64::max);
        let exponent = if largest > 0.0 { largest.log2().floor() as i32 + 1 } else { -128 };
        let mantissas = mean.map(|v| (v * 2f64.powi(8 - exponent)) as u8);
        bytes.extend(mantissas.into_iter().chain([(exponent + 128) as u8]));
    }
    bytes
}

fn planned(folder: &Folder, name: &str, brdf: &str, budget: f64) -> EnvironmentPlan {
    let numbers: Vec<&str> = brdf.split(':').collect();
    let brdf = match numbers[..] {
        ["phong", s] => format!("kind = \"phong\"\nexponent = {s}"),
        ["ward", a] => format!("kind = \"ward\"\nalpha = {a}"),
        ["ward", a, b] => format!("kind = \"ward\"\nalpha = [{a}, {b}]"),
        _ => "kind = \"lambert\"".to_owned(),
    };
    let text = format!(
        "name = \"a\"\n[environment]\nmap = \"{name}.hdr\"\nsignal = \"radiance\"\nmax_order = {MAX_ORDER}\nbudget = {budget}\n\
         [brdf]\n{brdf}\n"
    );
    let scene = Scene::parse("a.toml", &text, Maps::Folder(folder.path(""))).unwrap_or_else(|error| panic!("{error}"));
    Plan::new(&scene).unwrap_or_else(|error| panic!("{error}")).environment.expect("has one")
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Texels as points: the direction of each, and for the map and for what each of some series leaves of it the radiance times
/// the solid angle of R, G and B, side by side.
struct Points {
    directions: Vec<[f64; 3]>,
    /// The map first, then one of each series, at last how likely it is that the texel is drawn.
    values: Vec<Vec<[f64; 3]>>,
    /// How likely it is that a texel up to this one is drawn.
    sums: Vec<f64>,
}

impl Points {
    fn new(map: &Map, all: &[Projection]) -> Self {
        let directions: Vec<[f64; 3]> =
            (0..map.texels.len()).map(|i| map.direction(i % map.width, i / map.width)).collect();
        let solid_angle = |i: usize| map.solid_angle(i % map.width, i / map.width);
        let power = |i: usize| map.texels[i].iter().sum::<f64>() * solid_angle(i);
        let energy = |i: usize| dot(map.texels[i], map.texels[i]) * solid_angle(i);
        let all_of = |of: &dyn Fn(usize) -> f64| (0..map.texels.len()).map(of).sum::<f64>();
        let (whole_power, whole_energy) = (all_of(&power), all_of(&energy));
        let mut sums = Vec::new();
        let mut values = Vec::new();
        for (i, texel) in map.texels.iter().enumerate() {
            let mut row = vec![texel.map(|v| v * solid_angle(i))];
            for series in all {
                let value = series.evaluate(directions[i]);
                row.push([0, 1, 2].map(|c| (texel[c] - value[c]) * solid_angle(i)));
            }
            // Half by its power, half by its energy, since a small light may have little of the first and most of the second.
            let likely = 0.5 * (power(i) / whole_power + energy(i) / whole_energy);
            row.push([likely, 0.0, 0.0]);
            sums.push(sums.last().unwrap_or(&0.0) + likely);
            values.push(row);
        }
        Self { directions, values, sums }
    }

    /// What a surface reflects of each, in a frame: the axes of the surface, its normal last.
    fn reflected(&self, brdf: &Brdf, view: [f64; 3], [x, y, z]: [[f64; 3]; 3]) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.values[0].len()];
        for (&direction, row) in self.directions.iter().zip(&self.values) {
            let up = dot(direction, z);
            if up <= 0.0 {
                continue;
            }
            let value = brdf.value(view, [dot(direction, x), dot(direction, y), up]);
            for (sum, own) in sums.iter_mut().zip(row) {
                (0..3).for_each(|c| sum[c] += value * own[c]);
            }
        }
        sums
    }
}

/// The first bands of a map.
fn series(map: &Map, order: usize) -> Projection {
    Projection { beyond: 0.0, ..map.project(order) }
}

/// Two unit vectors at right angles to a unit vector and to each other, turned about it at random.
fn about(axis: [f64; 3], random: &mut Random) -> [[f64; 3]; 2] {
    loop {
        let other = cross(axis, random.unit::<3>());
        let length = dot(other, other).sqrt();
        if length > 0.1 {
            let side = other.map(|x| x / length);
            return [side, cross(axis, side)];
        }
    }
}

/// A light above a surface, drawn by how much of it is reflected to a view.
fn drawn(brdf: &Brdf, view: [f64; 3], most: f64, random: &mut Random) -> [f64; 3] {
    loop {
        let [x, y, z] = random.unit::<3>();
        let light = [x, y, z.abs()];
        if 0.5 * (1.0 + random.signed()) * most < brdf.value(view, light) {
            return light;
        }
    }
}

/// At least the largest value of a reflectance for a view, but for what a grid around the mirrored view misses.
fn largest(brdf: &Brdf, view: [f64; 3]) -> f64 {
    let mirrored = (-view[1]).atan2(-view[0]);
    let light = |i: usize, j: usize| {
        // Closer near the horizon and near the plane of the view.
        let cos = ((i as f64 + 1.0) / 128.0).powi(2);
        let offset = (j as f64 / 8.0 - 1.0).powi(3);
        let (sin, (y, x)) = ((1.0 - cos * cos).sqrt(), (mirrored + offset).sin_cos());
        brdf.value(view, [sin * x, sin * y, cos])
    };
    1.2 * (0..128).flat_map(|i| (0..17).map(move |j| light(i, j))).fold(0.0, f64::max)
}

/// The relative rms errors of series, each with its standard error: over frames of which half are any, and half such that
/// much of the map is reflected, so that small lights are met often; each counts by how rarely it is met. Views are spread
/// over the cosine of their angle to the normal, and weigh by it.
fn errors(points: &Points, brdf: &Brdf) -> Vec<[f64; 2]> {
    let mut random = Random::new(0x0bde);
    // By view, the square of what is reflected of each.
    let mut squares: Vec<Vec<f64>> = Vec::new();
    for i in 0..VIEWS {
        let cos = (i as f64 + 0.5 * (1.0 + random.signed())) / VIEWS as f64;
        let azimuth = PI * random.signed();
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let view = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
        let most = largest(brdf, view);
        let albedo = brdf.coefficients(view, 1)[0] * (4.0 * PI).sqrt();
        let mut sums = vec![0.0; points.values[0].len() - 1];
        for i in 0..FRAMES / VIEWS {
            let frame = if i % 2 == 0 {
                let normal = random.unit::<3>();
                let [x, y] = about(normal, &mut random);
                [x, y, normal]
            } else {
                // The turn that takes a drawn light of the surface to a drawn texel.
                let light = drawn(brdf, view, most, &mut random);
                let sum = 0.5 * (1.0 + random.signed());
                let place = points.sums.partition_point(|known| *known < sum);
                let texel = points.directions[place.min(points.directions.len() - 1)];
                let own = about(light, &mut random);
                let there = about(texel, &mut random);
                let axis = |k: usize| {
                    [0, 1, 2].map(|j| light[k] * texel[j] + own[0][k] * there[0][j] + own[1][k] * there[1][j])
                };
                [axis(0), axis(1), axis(2)]
            };
            let found = points.reflected(brdf, view, frame);
            let [likely, ..] = found[found.len() - 1];
            let density = 0.5 + 0.5 * 4.0 * PI * likely / albedo;
            for (sum, rgb) in sums.iter_mut().zip(found) {
                *sum += cos * dot(rgb, rgb) / density;
            }
        }
        squares.push(sums);
    }
    let mean = |of: &dyn Fn(&Vec<f64>) -> f64| squares.iter().map(of).sum::<f64>() / VIEWS as f64;
    let whole = mean(&|row| row[0]);
    (1..squares[0].len())
        .map(|k| {
            let ratio = mean(&|row| row[k]) / whole;
            let variance = mean(&|row| ((row[k] - ratio * row[0]) / whole).powi(2)) / VIEWS as f64;
            [ratio.sqrt(), 0.5 * (variance / ratio).sqrt()]
        })
        .collect()
}

#[test]
fn the_order_is_the_smallest_that_keeps_the_budget() {
    let cases: Vec<(&str, &str)> = MAPS.iter().flat_map(|map| BRDFS.map(|brdf| (*map, brdf))).collect();
    let folder = Folder::new();
    for name in MAPS {
        folder.put(&format!("{name}.hdr"), halved(name));
    }
    let row = |(name, text): (&str, &str)| {
        let brdf: Brdf = text.parse().expect("is a reflectance");
        let map = Map::read(&folder.path(&format!("{name}.hdr"))).expect("is a map");
        let plans = BUDGETS.map(|budget| planned(&folder, name, text, budget));
        let mut orders: Vec<usize> = plans.iter().flat_map(|plan| [plan.order - 1, plan.order]).collect();
        orders.sort_unstable();
        orders.dedup();
        let all: Vec<Projection> = orders.iter().map(|&order| series(&map, order)).collect();
        let found = errors(&Points::new(&map, &all), &brdf);
        let error = |order: usize| found[orders.iter().position(|known| *known == order).expect("is measured")];
        plans.map(|plan| judged(name, text, &plan, error(plan.order), error(plan.order - 1)))
    };
    let rows: Vec<_> = cases.into_par_iter().map(row).collect();
    println!(
        "| map | reflectance | budget | order | error by the plan | measured | one order less, by the plan | measured |"
    );
    let (mut kept, mut faults) = (0, Vec::new());
    for (row, is_kept, fault) in rows.into_iter().flatten() {
        println!("{row}");
        kept += usize::from(is_kept);
        faults.extend(fault.then_some(row));
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(kept > 40 && kept < 96, "{kept} of 96 budgets are kept");
}

/// The row of a case, whether the budget is kept, and whether something about it is wrong.
fn judged(
    name: &str,
    brdf: &str,
    plan: &EnvironmentPlan,
    [error, sigma]: [f64; 2],
    [lower, lower_sigma]: [f64; 2],
) -> (String, bool, bool) {
    let percent = |x: f64| format!("{:.2} %", 100.0 * x);
    let row = format!(
        "| {name} | {brdf} | {} | {}{} | {} | {} ± {} | {} | {} ± {} |",
        percent(plan.budget),
        plan.order,
        if plan.kept { "" } else { ", not kept" },
        percent(plan.error()),
        percent(error),
        percent(sigma),
        percent(plan.errors[plan.order - 2]),
        percent(lower),
        percent(lower_sigma)
    );
    let over = error - SIGMAS * sigma > plan.budget;
    let lower_is_over = plan.order == 2 || lower + SIGMAS * lower_sigma > plan.budget;
    let is_right = match plan.kept {
        true => !over && lower_is_over,
        // The plan says so in words, and no lower order would do.
        false => {
            let says = plan.verdict().contains("does not keep the budget");
            says && error + SIGMAS * sigma > plan.budget && plan.order == MAX_ORDER
        }
    };
    // Both figures are what was measured, too, and the measure is a good one.
    let near = |plan: f64, measured: f64, sigma: f64| (plan - measured).abs() <= SIGMAS * sigma + 0.03 * measured;
    let agrees = near(plan.error(), error, sigma) && near(plan.errors[plan.order - 2], lower, lower_sigma);
    (row, plan.kept, !is_right || !agrees)
}

#[test]
fn what_may_go_besides_bands_errs_as_the_plan_says() {
    let folder = Folder::new();
    let mut tried = 0;
    for name in ["city", "night", "sunset"] {
        folder.put(&format!("{name}.hdr"), halved(name));
        let plan = planned(&folder, name, "lambert", 0.1);
        let required = plan.requirement.expect("has a reflectance");
        if required.channels == 3 || required.left.len() > 1 {
            continue;
        }
        let map = Map::read(&folder.path(&format!("{name}.hdr"))).expect("is a map");
        let mut grey = series(&map, plan.order);
        grey.coefficients.iter_mut().for_each(|rgb| *rgb = [rgb.iter().sum::<f64>() / 3.0; 3]);
        let [error, sigma] = errors(&Points::new(&map, &[grey]), &Brdf::Lambert)[0];
        let difference = (error - required.error).abs();
        assert!(difference < SIGMAS * sigma + 0.01 * error, "{name}: {error} ± {sigma}, not {}", required.error);
        tried += 1;
    }
    assert!(tried > 0, "no light may be grey");
}

#[test]
fn what_lies_beyond_is_within_its_bounds() {
    let folder = Folder::new();
    for name in ["city", "courtyard", "sunset"] {
        folder.put(&format!("{name}.hdr"), halved(name));
        let map = Map::read(&folder.path(&format!("{name}.hdr"))).expect("is a map");
        for brdf in [None, Some("phong:20"), Some("ward:0.4")] {
            let brdf: Option<Brdf> = brdf.map(|text| text.parse().expect("is a reflectance"));
            let light = if brdf.is_some() { Light::Radiance } else { Light::Irradiance };
            let seen = |depth: usize| {
                let survey = map.survey(depth);
                weights(light, brdf.as_ref(), depth).seen(&survey.projection.spectrum(), &survey.parts)
            };
            let (shallow, deep) = (seen(16), seen(128));
            let all = [shallow.least_errors(), deep.least_errors(), deep.errors(), shallow.errors()];
            for order in 0..16 {
                let [least, near_least, near_most, most] = all.each_ref().map(|errors| errors[order]);
                // Every figure is a bound, so that they lie in this order; grids and rounding change them by 1e-4.
                assert!(least <= near_least * 1.0001 && near_most <= most * 1.0001 + 1e-6, "{name}, {brdf:?}, {order}");
                // What is left in doubt at depth 128 is little.
                assert!(near_most - near_least < 0.03 * near_most + 1e-6, "{name}, {brdf:?}, {order}");
            }
        }
    }
}

#[test]
fn a_reflectance_weighs_bands_as_its_coefficients_do() {
    for text in ["phong:20", "ward:0.4", "ward:0.3:0.6"] {
        let brdf: Brdf = text.parse().expect("is a reflectance");
        let found = seen::weights(&brdf, 12).of_band;
        // The views of a sphere, evenly over the square of the sine, and over all azimuths.
        let mut wanted = vec![0.0; 12];
        for i in 0..256 {
            let square = (i as f64 + 0.5) / 256.0;
            let (sin, cos) = (PI * (7 * i) as f64 / 32.0).sin_cos();
            let view = [square.sqrt() * cos, square.sqrt() * sin, (1.0 - square).sqrt()];
            let coefficients = brdf.coefficients(view, 12);
            for (l, sum) in wanted.iter_mut().enumerate() {
                let band = &coefficients[l * l..(l + 1) * (l + 1)];
                *sum += band.iter().map(|x| x * x).sum::<f64>() / (2 * l + 1) as f64 / 256.0;
            }
        }
        let energy = |of: &[f64]| -> Vec<f64> { of.iter().zip(0..).map(|(w, l)| f64::from(2 * l + 1) * w).collect() };
        let (found, wanted) = (energy(&found), energy(&wanted));
        let whole: f64 = wanted.iter().sum();
        for (l, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            // So many views see grazing angles rarely, and the coefficients are off by 1e-3 of their norm.
            assert!((found - wanted).abs() < 2e-3 * whole, "{text}, band {l}: {found}, not {wanted}, of {whole}");
        }
    }
}
