//! Maps of which the projection is known, and files that are none.

use super::harmonics::basis;
use super::{Map, MapError, Projection, cosine_lobe};
use crate::math::quadrature::gauss_legendre_5;
use crate::promise::samples::Random;
use std::f64::consts::PI;

/// A map whose texels hold the value of `radiance`, by column, row and direction, in all channels.
fn map(height: usize, mut radiance: impl FnMut(usize, usize, [f64; 3]) -> f64) -> Map {
    let mut map = Map { width: 2 * height, height, texels: Vec::new() };
    for (x, y) in (0..height).flat_map(|y| (0..2 * height).map(move |x| (x, y))) {
        map.texels.push([radiance(x, y, map.direction(x, y)); 3]);
    }
    map
}

fn distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

fn legendre(l: usize, z: f64) -> f64 {
    let mut pair = (0.0, 1.0);
    for k in 0..l {
        let k = k as f64;
        pair = (pair.1, ((2.0 * k + 1.0) * z * pair.1 - k * pair.0) / (k + 1.0));
    }
    pair.1
}

#[cfg(feature = "exr")]
fn exr(width: usize, height: usize, texels: &[f32]) -> Vec<u8> {
    use exr::prelude::*;
    let texel = |place: Vec2<usize>| {
        let i = 3 * (place.y() * width + place.x());
        (texels[i], texels[i + 1], texels[i + 2])
    };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = Image::from_channels((width, height), SpecificChannels::rgb(texel));
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// An HDR file of 16 columns and `rows` rows, each run-length encoded in the old way.
fn hdr(rows: &[u8]) -> Vec<u8> {
    [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n", rows].concat()
}

#[test]
fn basis_is_orthonormal_with_condon_shortley_phase() {
    let nu = (3.0 / (4.0 * PI)).sqrt();
    let mut random = Random::new(1);
    let mut directions = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]];
    for _ in 0..20 {
        let [x, y, z] = [random.signed(), random.signed(), random.signed()];
        let length = (x * x + y * y + z * z).sqrt();
        directions.push([x / length, y / length, z / length]);
    }
    for [x, y, z] in directions {
        let mut values = vec![f64::NAN; 20 * 20];
        basis(20, [x, y, z], &mut values);
        let expected = [
            0.5 / PI.sqrt(),
            -nu * y,
            nu * z,
            -nu * x,
            nu * 5.0f64.sqrt() * x * y,
            -nu * 5.0f64.sqrt() * y * z,
            (5.0 / (16.0 * PI)).sqrt() * (3.0 * z * z - 1.0),
            -nu * 5.0f64.sqrt() * x * z,
            nu * 1.25f64.sqrt() * (x * x - y * y),
        ];
        for (value, expected) in values.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-15, "{value} is not {expected}");
        }
        for l in 0..20 {
            let sum: f64 = values[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum();
            let expected = (2 * l + 1) as f64 / (4.0 * PI);
            assert!((sum / expected - 1.0).abs() < 1e-13, "band {l}");
        }
    }
}

#[test]
fn cosine_lobe_is_the_integral_of_the_clamped_cosine() {
    for l in 0..40 {
        let steps = 200;
        let mut integral = 0.0;
        for i in 0..steps {
            for (node, weight) in gauss_legendre_5() {
                let z = (i as f64 + 0.5 + 0.5 * node) / steps as f64;
                integral += PI / steps as f64 * weight * z * legendre(l, z);
            }
        }
        assert!((cosine_lobe(l) - integral).abs() < 1e-14, "band {l}");
    }
    assert_eq!(cosine_lobe(0), PI);
    assert!((cosine_lobe(4) + PI / 24.0).abs() < 1e-16);
    assert!((3..100).step_by(2).all(|l| cosine_lobe(l) == 0.0));
}

#[test]
fn directions_follow_the_documented_layout() {
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02);
    let map = map(128, |_, _, _| 1.0);
    assert!(close(map.direction(128, 64), [1.0, 0.0, 0.0]));
    assert!(close(map.direction(192, 64), [0.0, -1.0, 0.0]));
    assert!(close(map.direction(64, 64), [0.0, 1.0, 0.0]));
    assert!(close(map.direction(0, 64), [-1.0, 0.0, 0.0]));
    assert!(close(map.direction(17, 0), [0.0, 0.0, 1.0]));
    assert!(close(map.direction(17, 127), [0.0, 0.0, -1.0]));
    let sphere: f64 = (0..128).map(|y| 256.0 * map.solid_angle(0, y)).sum();
    assert!((sphere - 4.0 * PI).abs() < 1e-13);
}

#[test]
fn a_bright_texel_is_found_where_its_direction_says() {
    for (x, y) in [(0, 0), (3, 1), (9, 4), (15, 7), (8, 3)] {
        let map = map(8, |i, j, _| f64::from((i, j) == (x, y)));
        let c = map.project(2).coefficients;
        let vector = [-c[3][0], -c[1][0], c[2][0]];
        let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
        let cos: f64 = vector.iter().zip(map.direction(x, y)).map(|(a, b)| a * b / length).sum();
        assert!(cos > 0.98, "column {x}, row {y}: cosine {cos}");
    }
}

#[test]
fn a_uniform_map_of_any_size_is_band_0_alone() {
    for height in [1, 2, 3, 16, 128] {
        let map = map(height, |_, _, _| 2.5);
        let projection = map.project(10);
        let mut expected = vec![[0.0; 3]; 100];
        expected[0] = [2.0 * PI.sqrt() * 2.5; 3];
        assert!(distance(&projection.coefficients, &expected) < 1e-12);
        assert!((projection.energy() / map.energy() - 1.0).abs() < 1e-14);
        assert_eq!(projection.smallest_order(1e-6), Some(1));
        assert!((1..10).all(|l| projection.vanishes(l)) && !projection.vanishes(0));
        let [e, ..] = projection.irradiance().evaluate([0.6, 0.0, 0.8]);
        assert!((e / (2.5 * PI) - 1.0).abs() < 1e-13);
    }
}

#[test]
fn a_bright_hemisphere_is_projected_exactly() {
    // The texels' edges are the hemisphere's, so that rounding alone is left.
    for height in [2, 6, 128] {
        let c = map(height, |_, _, d| f64::from(d[2] > 0.0)).project(8).coefficients;
        for l in 0..8 {
            // The integral of P_l from 0 to 1.
            let integral = match l {
                0 => 1.0,
                _ => (legendre(l - 1, 0.0) - legendre(l + 1, 0.0)) / (2 * l + 1) as f64,
            };
            let expected = ((2 * l + 1) as f64 * PI).sqrt() * integral;
            assert!((c[l * (l + 1)][0] - expected).abs() < 1e-13, "height {height}, band {l}");
        }
        let c = map(height, |_, _, d| f64::from(d[1] > 0.0)).project(8).coefficients;
        assert!((c[1][0] + (3.0 * PI).sqrt() / 2.0).abs() < 1e-13, "height {height}");
        assert!(c[2][0].abs() < 1e-13 && c[3][0].abs() < 1e-13);
    }
}

#[test]
fn a_clamped_cosine_has_the_coefficients_of_the_lobe() {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    let dot = |d: [f64; 3]| d.iter().zip(axis).map(|(a, b)| a * b).sum::<f64>();
    let projection = map(128, |_, _, d| dot(d).max(0.0)).project(8);
    let mut expected = vec![0.0; 64];
    basis(8, axis, &mut expected);
    for l in 0..8 {
        for i in l * l..(l + 1) * (l + 1) {
            expected[i] *= cosine_lobe(l);
        }
    }
    let expected: Vec<_> = expected.iter().map(|&v| [v; 3]).collect();
    // Texels of width Δ = π/128 change band l by l(l+1) Δ²/24 at first order: 7·8 · 2.5e-5 at most.
    assert!(distance(&projection.coefficients, &expected) < 1.4e-3 * expected[0][0]);
}

#[test]
fn a_sampled_series_comes_back() {
    let mut random = Random::new(1);
    let coefficients = (0..25).map(|_| [random.signed(), random.signed(), random.signed()]).collect();
    let series = Projection { order: 5, coefficients, beyond: 0.0 };
    let error = |height: usize| {
        let mut map = map(height, |_, _, _| 0.0);
        for i in 0..map.texels.len() {
            map.texels[i] = series.evaluate(map.direction(i % map.width, i / map.width));
        }
        let back = map.project(5).coefficients;
        distance(&back, &series.coefficients) / series.energy().sqrt()
    };
    // A texel holds the series at its centre. Averaging a harmonic over a texel of width Δ changes it by
    // l(l+1) Δ²/24 at first order: 20 · 2.5e-5 for band 4 of 256×128. Less for the lower bands.
    let (coarse, fine) = (error(64), error(128));
    assert!(fine < 5e-4, "{fine}");
    assert!((coarse / fine - 4.0).abs() < 0.05, "{coarse} {fine}");
}

#[test]
fn every_width_is_folded_to_the_sums_over_its_texels() {
    let mut random = Random::new(2);
    for height in [1, 2, 3, 6, 10, 16] {
        let map = map(height, |_, _, _| random.signed());
        let order = 9;
        let found = map.project(order).coefficients;
        // The integral of a texel, by the mean value of the waves and five nodes in every 32nd of a row.
        let mut expected = vec![[0.0; 3]; order * order];
        for (x, y) in (0..height).flat_map(|y| (0..2 * height).map(move |x| (x, y))) {
            let azimuth = PI - 2.0 * PI * (x as f64 + 0.5) / map.width as f64;
            for (i, (node, weight)) in (0..32).flat_map(|i| gauss_legendre_5().map(|node| (i, node))) {
                let step = PI / (32 * height) as f64;
                let (sin, cos) = (step * ((32 * y + i) as f64 + 0.5 + 0.5 * node)).sin_cos();
                let mut values = vec![0.0; order * order];
                basis(order, [sin * azimuth.cos(), sin * azimuth.sin(), cos], &mut values);
                for (place, sum) in expected.iter_mut().enumerate() {
                    let m = crate::math::index::band_degree(place).1.unsigned_abs();
                    let half = PI * m as f64 / map.width as f64;
                    let width = if m == 0 { 2.0 * PI / map.width as f64 } else { 2.0 * half.sin() / m as f64 };
                    let texel = map.texels[y * map.width + x];
                    (0..3).for_each(|c| sum[c] += 0.5 * step * weight * sin * width * values[place] * texel[c]);
                }
            }
        }
        assert!(distance(&found, &expected) < 1e-12, "height {height}");
    }
}

#[test]
fn a_file_is_projected_as_the_map_that_it_holds() {
    let mut random = Random::new(3);
    let (width, height) = (80, 40);
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for _ in 0..height {
        bytes.extend([2, 2, 0, width as u8]);
        for channel in 0..4 {
            // A run of thirty, and as many bytes as are left.
            let mut byte = || {
                if channel == 3 {
                    (126.0 + 2.0 * random.signed()) as u8
                } else {
                    (127.0 * (1.0 + random.signed())) as u8
                }
            };
            bytes.extend([128 + 30, byte(), width as u8 - 30]);
            bytes.extend((0..width - 30).map(|_| byte()));
        }
    }
    let map = Map::from_bytes("a.hdr", &bytes).unwrap();
    assert_eq!((map.width, map.height), (width, height));
    let (projection, size) = Projection::from_bytes("a.hdr", &bytes, 12).unwrap();
    assert_eq!((projection, size), (map.project(12), [width, height]));
    let black = hdr(&[0, 0, 0, 200].repeat(16 * 8));
    assert!(matches!(Projection::from_bytes("a.hdr", &black, 2), Err(MapError::Black { .. })));
    assert!(matches!(Map::from_bytes("a.hdr", &black), Err(MapError::Black { .. })));
}

#[test]
fn old_runs_repeat_the_texel_before_them() {
    let [a, b] = [[128, 64, 32, 129], [1, 1, 2, 136]];
    let run = |count: u8| [1, 1, 1, count];
    let first = [a, run(10), run(1), b, run(244)];
    // One texel, 255 more, and 256 times 1 more.
    let rest = [b, run(255), run(1)].as_flattened().repeat(255);
    let bytes = [b"#?RADIANCE\n\n-Y 256 +X 512\n", first.as_flattened(), &rest].concat();
    let map = Map::from_bytes("a.hdr", &bytes).unwrap();
    let (head, tail) = map.texels.split_at(1 + 10 + 256);
    assert!(head.iter().all(|texel| *texel == [1.0, 0.5, 0.25]) && tail.iter().all(|texel| *texel == [1.0, 1.0, 2.0]));
    assert_eq!(Projection::from_bytes("a.hdr", &bytes, 4).unwrap(), (map.project(4), [512, 256]));
    let begins = [&b"#?RADIANCE\n\n-Y 256 +X 512\n"[..], &run(1)].concat();
    assert!(Map::from_bytes("a.hdr", &begins).unwrap_err().to_string().contains("a row begins with a run"));
}

#[test]
fn shifting_columns_turns_the_series_about_z() {
    let mut random = Random::new(1);
    let texels = (0..16 * 8).map(|_| [random.signed(), random.signed(), random.signed()]).collect();
    let map = Map { width: 16, height: 8, texels };
    let mut turned = map.clone();
    turned.texels.chunks_exact_mut(16).for_each(|row| row.rotate_left(3));
    let angle = 3.0 * 2.0 * PI / 16.0;
    let mut expected = map.project(7).coefficients;
    for (l, m) in (0..7).flat_map(|l| (1..=l).map(move |m| (l, m))) {
        let (sin, cos) = (m as f64 * angle).sin_cos();
        for channel in 0..3 {
            let (plus, minus) = (l * (l + 1) + m, l * (l + 1) - m);
            let (a, b) = (expected[plus][channel], expected[minus][channel]);
            expected[plus][channel] = cos * a - sin * b;
            expected[minus][channel] = sin * a + cos * b;
        }
    }
    assert!(distance(&turned.project(7).coefficients, &expected) < 1e-13);
}

#[test]
fn energies_obey_parseval_even_for_orders_beyond_the_map() {
    let mut random = Random::new(1);
    let texels = (0..8 * 4).map(|_| [random.signed().abs(), random.signed().abs(), random.signed().abs()]).collect();
    let map = Map { width: 8, height: 4, texels };
    let whole = map.project(60);
    assert!((whole.energy() / map.energy() - 1.0).abs() < 1e-14);
    let errors = whole.errors();
    assert!(errors.windows(2).all(|e| e[0] >= e[1]) && errors[59] > 0.0);
    let bands = whole.band_energy();
    for order in [0, 1, 4, 20] {
        let part = map.project(order);
        assert_eq!(part.coefficients.len(), order * order);
        let beyond = whole.beyond + bands[order..].iter().sum::<f64>();
        assert!((part.beyond / beyond - 1.0).abs() < 1e-12);
    }
}

#[test]
fn orders_of_irradiance_are_chosen_by_a_bound_that_holds() {
    // A single bright texel is the hardest case: nearly all of its radiance lies beyond any order.
    let map = map(64, |x, y, _| if (x, y) == (40, 30) { 1e6 } else { 1.0 });
    let truth = map.project(128).irradiance();
    assert!(truth.beyond < 1e-6 * truth.energy());
    for (order, promised) in [(10, 0.032), (32, 0.0053), (64, 0.0019)] {
        let judged = map.project(order).irradiance();
        assert!(judged.beyond >= truth.beyond + truth.band_energy()[order..].iter().sum::<f64>());
        for (judged, truth) in judged.errors().iter().zip(truth.errors()) {
            assert!(*judged >= truth && judged * judged < truth * truth + promised * promised);
        }
    }
    let errors = truth.errors();
    assert_eq!(errors[2], errors[3]);
    assert!(truth.vanishes(3) && truth.vanishes(5) && !truth.vanishes(4));
    assert_eq!(truth.smallest_order(errors[3]), Some(3));
    assert_eq!(truth.smallest_order(0.0), None);
    assert_eq!(truth.smallest_order(f64::NAN), None);
}

#[test]
fn formats_are_told_apart_by_content() {
    let found = |bytes: &[u8]| match Map::from_bytes("a.hdr", bytes) {
        Err(MapError::Format { found, .. }) => found,
        other => panic!("{other:?}"),
    };
    assert_eq!(found(b""), "nothing");
    assert_eq!(found(b"A text.\n"), "unknown data");
    assert_eq!(found(b"\xff\xd8\xff\xe0"), "a Jpeg image");
    let texel = [128, 64, 32, 129];
    let read = |bytes: &[u8]| Map::from_bytes("a.exr", bytes).unwrap().texels[0];
    assert_eq!(read(&hdr(&texel.repeat(16 * 8))), [1.0, 0.5, 0.25]);
    let old = [b"#?RGBE\n", &hdr(&texel.repeat(16 * 8))[11..]].concat();
    assert_eq!(read(&old), [1.0, 0.5, 0.25]);
    #[cfg(feature = "exr")]
    assert_eq!(read(&exr(2, 1, &[1.0, 0.5, 0.25, 0.0, 0.0, 0.0])), [1.0, 0.5, 0.25]);
    #[cfg(not(feature = "exr"))]
    assert!(matches!(Map::from_bytes("a.exr", b"v/1\x01"), Err(MapError::Unsupported { .. })));
}

#[test]
fn what_is_no_radiance_is_refused() {
    let message = |width: usize, height: usize, change: &[(usize, f32)]| {
        let mut texels = vec![1.0; 3 * width * height];
        change.iter().for_each(|&(i, v)| texels[i] = v);
        #[cfg(feature = "exr")]
        let read = Map::from_bytes("a.exr", &exr(width, height, &texels));
        #[cfg(not(feature = "exr"))]
        let read = {
            let texels = texels.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]].map(f64::from)).collect();
            Map { width, height, texels }.checked("a.exr")
        };
        read.unwrap_err().to_string()
    };
    assert_eq!(
        message(4, 2, &[(10, f32::NAN), (23, f32::INFINITY), (0, -1.0)]),
        "a.exr: 2 of its texels are not finite, the first at column 3, row 0 (NaN); \
         replace them by radiance and save the map again"
    );
    assert_eq!(
        message(4, 2, &[(12, -0.5), (13, -2.0), (20, -0.25)]),
        "a.exr: 2 of its texels hold negative radiance, down to -2, the first at \
         column 0, row 1; clamp the map to 0 and save it again"
    );
    assert_eq!(
        message(4, 4, &[]),
        "a.exr: is 4×4 texels, the size of no map; a map is twice as wide as high, or a cubemap in a strip (6:1, 1:6) or a \
         cross (4:3, 3:4); if this is one of six faces, name the folder that holds them all"
    );
    let black: Vec<_> = (0..6).map(|i| (i, 0.0)).collect();
    assert_eq!(message(2, 1, &black), "a.exr: is black all over; check how it was exported");
    let sized = |size: &str| {
        let file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        Map::from_bytes("a.hdr", file.as_bytes()).unwrap_err()
    };
    assert!(matches!(sized("-Y 0 +X 0"), MapError::Empty { .. }));
    assert!(matches!(sized("-Y 8192 +X 16384"), MapError::TooLarge { width: 16384, .. }));
    assert!(matches!(sized("-Y 100000 +X 100000"), MapError::Shape { .. }));
    assert!(matches!(sized("+Y 8 +Y 16"), MapError::Malformed { .. }));
    let short = Map { width: 2, height: 1, texels: vec![[1.0; 3]] };
    assert!(matches!(short.checked("short"), Err(MapError::Malformed { .. })));
}

#[test]
fn no_bytes_make_it_panic() {
    let error = |bytes: &[u8]| match Map::from_bytes("a", bytes) {
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    };
    let good_hdr = hdr(&[128, 64, 32, 129].repeat(16 * 8));
    #[cfg(feature = "exr")]
    let good_exr = exr(4, 2, &[1.0; 24]);
    #[cfg(not(feature = "exr"))]
    let good_exr = b"v/1\x01\x02\0\0\0".to_vec();
    assert_eq!(error(&good_hdr), "");
    for length in 1..good_hdr.len() {
        assert_ne!(error(&good_hdr[..length]), "");
    }
    for length in 1..good_exr.len() {
        assert_ne!(error(&good_exr[..length]), "");
    }
    assert!(error(&good_hdr[..300]).contains("it ends too early"));
    // Runs of length 0 multiply the decoder's counter until it overflows.
    let overflow = [[9, 9, 9, 9].as_slice(), &[1, 1, 1, 0].repeat(40)].concat();
    assert!(error(&hdr(&overflow)).contains("cannot be decoded"));
    let mut random = Random::new(1);
    for good in [&good_hdr, &good_exr] {
        for _ in 0..2000 {
            let mut bytes = good.clone();
            for _ in 0..3 {
                let i = (random.signed().abs() * bytes.len() as f64) as usize;
                bytes[i] = (random.signed() * 128.0) as i8 as u8;
            }
            let message = error(&bytes);
            assert!(!message.contains('\n'), "{message}");
        }
    }
}
