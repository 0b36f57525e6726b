//! Projections against functions whose coefficients are known: signals, which come back; images by latitude and longitude,
//! which err by the square of their texels; cubemaps, filled through the table by which OpenGL samples them.

use super::{direction, signal, wide};
use glam::DVec3;
use std::f64::consts::PI;
use zonal::project::{self, parallel};
use zonal::{Coefficients, Error};
use zonal_codegen::environment::Map;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{band_error, repository};

fn difference<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_function_of_bands_that_the_grid_holds_is_projected_exactly() {
    let mut random = Random::new(73);
    every_order!(N, {
        let order = N.isqrt();
        let c = signal::<N>(&mut random);
        for rows in [0, order, order + 3, 40] {
            let got: [f64; N] = project::function(rows, |dir: [f64; 3]| zonal::evaluate(dir, &c));
            assert!(difference(&got, &c) < 1e-13, "order {order} by {rows} rows");
        }
        // In f32, by what 2 n² products of numbers up to 10 round.
        let rgb = c.map(|c| [c as f32, -c as f32]);
        let got: [[f32; 2]; N] = project::function(order, |dir: [f32; 3]| zonal::evaluate(dir, &rgb));
        for channel in 0..2 {
            let [got, want] = [got, rgb].map(|c| wide(&c.map(|c| c[channel])));
            assert!(band_error(&got, &want) < 1e-5, "order {order} in f32");
        }
    });
    // Order 3 on r rows: bands to 2 r − 3 leave nothing, one more does.
    let all: [f64; 100] = signal(&mut random);
    for rows in 3..=6 {
        let beyond = |from: usize, to: usize| -> f64 {
            let only: [f64; 100] = std::array::from_fn(|i| if (from..=to).contains(&i.isqrt()) { all[i] } else { 0.0 });
            let got: [f64; 9] = project::function(rows, |dir: [f64; 3]| zonal::evaluate(dir, &only));
            difference(&got, &[0.0; 9])
        };
        assert!(beyond(3, 2 * rows - 3) < 1e-13, "{rows} rows");
        if 2 * rows - 2 < 10 {
            assert!(beyond(2 * rows - 2, 2 * rows - 2) > 1e-3, "{rows} rows are said to hold less than they do");
        }
    }
}

#[test]
fn the_upper_half_of_the_sphere_has_the_coefficients_of_its_integrals() {
    // ∫ P_l over the upper half: 1, 1/2, 0, −1/8.
    let want = [1.0, 0.5, 0.0, -0.125];
    let c: [f64; 16] = project::function(200, |dir: [f64; 3]| if dir[2] > 0.0 { 1.0 } else { 0.0 });
    for (l, want) in want.iter().enumerate() {
        let want = 2.0 * PI * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * want;
        // The error of a step between two rows falls with their square.
        assert!((c[l * (l + 1)] - want).abs() < 1e-4, "band {l}: {}, not {want}", c[l * (l + 1)]);
    }
}

#[test]
fn samples_are_summed_by_their_solid_angles() {
    let mut random = Random::new(79);
    // The corners of a cube and the middles of its faces integrate what has bands up to 5 together.
    let corners =
        (0..8).map(|i| DVec3::from_array([1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 })).normalize());
    let middles = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let corners = corners.map(|dir| (dir, 4.0 * PI * 3.0 / 40.0));
    let design: Vec<(DVec3, f64)> = corners.chain(middles.map(|dir| (dir, 4.0 * PI / 15.0))).collect();
    let whole: f64 = design.iter().map(|(_, weight)| weight).sum();
    assert!((whole - 4.0 * PI).abs() < 1e-12, "{whole}");
    let c = signal::<9>(&mut random);
    let got: [f64; 9] = project::samples(design.iter().map(|&(dir, weight)| (dir, zonal::evaluate(dir, &c), weight)));
    assert!(difference(&got, &c) < 1e-14, "{got:?}");

    // Random ones come to it by the root of their number.
    let count = 40_000;
    let got: [f64; 9] = project::samples((0..count).map(|_| {
        let dir = direction(&mut random);
        (dir, zonal::evaluate(dir, &c), 4.0 * PI / f64::from(count))
    }));
    assert!(difference(&got, &c) < 6.0 * 4.0 * PI / f64::from(count).sqrt() / 4.0, "{got:?}");
}

#[test]
fn a_million_samples_round_as_few_do() {
    let count = 1_000_000;
    let weight = (4.0 * PI / f64::from(count)) as f32;
    let c: [f32; 4] = project::samples((0..count).map(|_| ([0.0_f32, 0.0, 1.0], 1.0_f32, weight)));
    let want = f64::from(weight) * f64::from(count) / (2.0 * PI.sqrt());
    // A run of 64 terms, each a product of two roundings: 64 u would be the worst.
    let error = (f64::from(c[0]) - want).abs() / want;
    assert!(error < 16.0 * f64::from(f32::EPSILON), "{error}");
}

/// An image of a signal by latitude and longitude, by the formula of the documentation.
fn image<C: Coefficients<Element = f64, Scalar = f64>>(c: &C, width: usize, height: usize) -> Vec<f64> {
    let texel = |row: usize, column: usize| {
        let (elevation, azimuth) =
            (PI / 2.0 - PI * (row as f64 + 0.5) / height as f64, PI - 2.0 * PI * (column as f64 + 0.5) / width as f64);
        let dir = [elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin()];
        zonal::evaluate(dir, c)
    };
    (0..height)
        .flat_map(|row| (0..width).map(move |column| (row, column)))
        .map(|(row, column)| texel(row, column))
        .collect()
}

#[test]
fn an_image_errs_by_the_square_of_its_texels() {
    let mut random = Random::new(83);
    every_order!(N, {
        let c = signal::<N>(&mut random);
        let error = |height: usize| {
            let got: [f64; N] =
                project::lat_long(&image(&c, 2 * height, height), 2 * height, height).expect("an image");
            difference(&got, &c)
        };
        let (coarse, fine) = (error(40), error(80));
        assert!(fine < 1e-2 && (3.5..4.5).contains(&(coarse / fine)), "order {}: {coarse}, {fine}", N.isqrt());
        // No harm is done by an image that is no twice as wide as high.
        let got: [f64; N] = project::lat_long(&image(&c, 60, 80), 60, 80).expect("an image");
        assert!(difference(&got, &c) < 1.1 * fine, "order {}", N.isqrt());
    });
}

#[test]
fn an_image_lies_as_zonal_has_it() {
    // One texel is light; band 1 is −y, z, −x.
    for (row, column, towards) in
        [(8, 16, DVec3::X), (8, 24, DVec3::NEG_Y), (8, 8, DVec3::Y), (0, 16, DVec3::Z), (15, 16, DVec3::NEG_Z)]
    {
        let mut texels = [0.0; 16 * 32];
        texels[row * 32 + column] = 1.0;
        let c: [f64; 4] = project::lat_long(&texels, 32, 16).expect("an image");
        let lies = DVec3::new(-c[3], -c[1], c[2]).normalize();
        assert!(lies.dot(towards) > 0.98, "{lies}, not {towards}");
    }
}

#[test]
fn a_map_is_what_the_generator_makes_of_it() {
    let map = Map::read(&repository("scenes/maps/studio_256x128.hdr")).expect("a map");
    let want = map.project(5);
    let got: [[f64; 3]; 25] = project::lat_long(&map.texels, map.width, map.height).expect("an image");
    let scale = want.coefficients[0][1];
    for (got, want) in got.iter().zip(&want.coefficients) {
        // The generator integrates the waves over a texel, which the runtime takes at its middle: (π/128)² 4² / 24.
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-3 * scale), "{got:?}, not {want:?}");
    }
    let narrow: Vec<[f32; 3]> = map.texels.iter().map(|texel| texel.map(|x| x as f32)).collect();
    let in_f32: [[f32; 3]; 25] = project::lat_long(&narrow, map.width, map.height).expect("an image");
    let off = in_f32.iter().flatten().zip(got.iter().flatten()).map(|(a, b)| (f64::from(*a) - b).abs());
    let worst = off.fold(0.0, f64::max) / scale;
    assert!(worst < 2e-6, "{worst}");
}

/// The face and the place on it from 0 to 1 by which a direction is sampled, from the table of OpenGL 4.6, 8.13.
fn sampled(d: DVec3) -> (usize, f64, f64) {
    let a = d.abs();
    let (face, s, t, major) = match (a.max_element() == a.x, a.max_element() == a.y) {
        (true, _) if d.x > 0.0 => (0, -d.z, -d.y, a.x),
        (true, _) => (1, d.z, -d.y, a.x),
        (_, true) if d.y > 0.0 => (2, d.x, d.z, a.y),
        (_, true) => (3, d.x, -d.z, a.y),
        _ if d.z > 0.0 => (4, d.x, -d.y, a.z),
        _ => (5, -d.x, -d.y, a.z),
    };
    (face, 0.5 * (s / major + 1.0), 0.5 * (t / major + 1.0))
}

/// A cubemap each texel of which is the mean of a signal over many directions that are sampled there.
fn cubemap<C: Coefficients<Element = f64, Scalar = f64>>(c: &C, size: usize) -> [Vec<f64>; 6] {
    let mut sums = [(); 6].map(|()| vec![(0.0, 0.0); size * size]);
    let count = 600 * size * size;
    for i in 0..count {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let azimuth = i as f64 * PI * (3.0 - 5f64.sqrt());
        let radius = (1.0 - z * z).sqrt();
        let dir = DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z);
        let (face, s, t) = sampled(dir);
        let place = |x: f64| ((x * size as f64) as usize).min(size - 1);
        let (sum, weight) = &mut sums[face][place(t) * size + place(s)];
        (*sum, *weight) = (*sum + zonal::evaluate(dir, c), *weight + 1.0);
    }
    sums.map(|face| face.into_iter().map(|(sum, weight)| sum / weight).collect())
}

fn slices(faces: &[Vec<f64>; 6]) -> [&[f64]; 6] {
    faces.each_ref().map(Vec::as_slice)
}

#[test]
fn a_cubemap_is_projected_as_it_is_sampled() {
    let mut random = Random::new(89);
    for _ in 0..3 {
        let c = signal::<9>(&mut random);
        let error = |size: usize| {
            let faces = cubemap(&c, size);
            difference(&project::cubemap(slices(&faces), size).expect("six faces"), &c)
        };
        // What a texel's mean and its middle differ by falls with the square; the directions leave some tenth of it.
        let (coarse, fine) = (error(8), error(16));
        assert!(fine < 5e-3 && coarse / fine > 3.0, "{coarse}, {fine}");
    }
}

#[test]
fn the_texels_of_a_cubemap_are_the_whole_sphere() {
    for size in [1, 2, 3, 16, 255] {
        let faces = [(); 6].map(|()| vec![1.0; size * size]);
        let c: [f64; 16] = project::cubemap(slices(&faces), size).expect("six faces");
        assert!((c[0] - 2.0 * PI.sqrt()).abs() < 1e-10, "{size}: {}", c[0]);
        // A cube has no harmonics of the bands 1 to 3.
        assert!(c[1..].iter().all(|c| c.abs() < 1e-10), "{size}: {c:?}");
    }
}

#[test]
fn threads_give_the_same_to_the_last_bit() {
    let mut random = Random::new(97);
    let (width, height, size) = (97, 41, 37);
    let mut texel = || std::array::from_fn::<f32, 3, _>(|_| random.signed() as f32);
    let image: Vec<[f32; 3]> = (0..width * height).map(|_| texel()).collect();
    let faces: [Vec<[f32; 3]>; 6] = std::array::from_fn(|_| (0..size * size).map(|_| texel()).collect());
    let faces = faces.each_ref().map(Vec::as_slice);
    type Rgb = [[f32; 3]; 36];
    assert_eq!(parallel::lat_long::<Rgb>(&image, width, height), project::lat_long(&image, width, height));
    assert_eq!(parallel::cubemap::<Rgb>(faces, size), project::cubemap(faces, size));
    let f = |dir: [f32; 3]| dir.map(|x| x * x * x + dir[1]);
    assert_eq!(parallel::function::<Rgb>(57, f), project::function::<Rgb>(57, f));
    assert_eq!(parallel::function::<Rgb>(0, f), project::function::<Rgb>(0, f));
    assert_eq!(parallel::lat_long::<Rgb>(&image, 1, 1), project::lat_long(&image, 1, 1));
    assert_eq!(parallel::cubemap::<Rgb>(faces, 1), project::cubemap(faces, 1));
}

#[test]
fn images_of_other_sizes_are_refused_in_words() {
    let texels = [0.0_f32; 12];
    let words = |result: Result<[f32; 4], Error>| result.expect_err("a wrong size").to_string();
    assert_eq!(words(project::lat_long(&texels, 4, 2)), "12 texels, but an image of 4 × 2 has 8");
    assert_eq!(words(project::lat_long(&texels[..0], 0, 2)), "an image of 0 × 2 has no texels, but 0 were given");
    assert!(project::lat_long::<[f32; 4]>(&texels, usize::MAX, usize::MAX).is_err());
    let mut faces = [&texels[..4]; 6];
    assert!(project::cubemap::<[f32; 4]>(faces, 2).is_ok());
    faces[4] = &texels[..3];
    assert_eq!(words(project::cubemap(faces, 2)), "3 texels in face 4, but a cubemap of size 2 has 4 in each");
    assert_eq!(words(project::cubemap([&[]; 6], 0)), "face 0 of a cubemap of size 0 has no texels");
    assert!(project::cubemap::<[f32; 4]>(faces, usize::MAX).is_err());
}
