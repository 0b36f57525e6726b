//! Environment maps from their files to the order that a scene needs: real maps against figures found by another
//! program, the harmonics against their goldens, and files that are no maps.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use zonal_codegen::environment::{Map, MapError, Projection};

const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

fn path(relative: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(relative)
}

fn scene(name: &str) -> Map {
    Map::read(&path(&format!("../scenes/maps/{name}_256x128.hdr"))).unwrap()
}

/// Directions spread evenly over the sphere.
fn directions(count: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |i| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sin, cos) = (i as f64 * PI * (3.0 - 5.0f64.sqrt())).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        [radius * cos, radius * sin, z]
    })
}

/// The first bands of a projection, which claims to be all there is.
fn truncated(projection: &Projection, order: usize) -> Projection {
    let coefficients = projection.coefficients[..order * order].to_vec();
    Projection { order, coefficients, beyond: 0.0 }
}

/// The irradiance by its definition, from texels taken as points.
fn direct_irradiance(map: &Map, normal: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (y, row) in map.texels.chunks(map.width).enumerate() {
        for (x, texel) in row.iter().enumerate() {
            let cos: f64 = map.direction(x, y).iter().zip(normal).map(|(a, b)| a * b).sum();
            if cos > 0.0 {
                for channel in 0..3 {
                    sum[channel] += texel[channel] * cos * map.solid_angle(x, y);
                }
            }
        }
    }
    sum
}

#[test]
fn evaluation_agrees_with_the_golden_basis() {
    let golden = std::fs::read_to_string(path("golden/basis.json")).unwrap();
    let golden: serde_json::Value = serde_json::from_str(&golden).unwrap();
    for case in golden["cases"].as_array().unwrap() {
        let numbers =
            |key: &str| -> Vec<f64> { case[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect() };
        let direction = numbers("unit").try_into().unwrap();
        for (i, expected) in numbers("y").into_iter().enumerate().take(400) {
            if i >= 36 && i % 7 != 0 {
                continue;
            }
            let mut coefficients = vec![[0.0; 3]; 400];
            coefficients[i] = [1.0, 0.0, 2.0];
            let one = Projection { order: 20, coefficients, beyond: 0.0 };
            let [r, g, b] = one.evaluate(direction);
            assert!((r - expected).abs() < 1e-13, "coefficient {i} at {direction:?}");
            assert!(g == 0.0 && b == 2.0 * r);
        }
    }
}

#[test]
fn order_3_irradiance_errs_as_another_program_found() {
    // The rms of the error over the sphere and the channels, over the mean of the irradiance over both. The figures
    // have two digits; the maps' luminance alone gives 4.5, 8.0 and 9.7 %.
    for (name, expected, luminance) in [("city", 4.4, 4.49), ("studio", 8.2, 8.04), ("sunrise", 9.5, 9.71)] {
        let irradiance = scene(name).project(64).irradiance();
        let over_mean = |weights: &[[f64; 3]]| {
            let channel = |c: &[f64; 3], w: &[f64; 3]| c[0] * w[0] + c[1] * w[1] + c[2] * w[2];
            let (mut left, mut mean) = (0.0, 0.0);
            for w in weights {
                let rest = irradiance.coefficients[9..].iter();
                left += rest.map(|c| channel(c, w).powi(2)).sum::<f64>();
                mean += channel(&irradiance.coefficients[0], w);
            }
            100.0 * (left * weights.len() as f64).sqrt() / mean
        };
        let pooled = over_mean(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!((pooled - expected).abs() < 0.06, "{name}: {pooled} %, not {expected} %");
        let of_luminance = over_mean(&[LUMINANCE]);
        assert!((of_luminance - luminance).abs() < 0.01, "{name}: luminance {of_luminance} %");
    }
}

#[test]
fn order_3_irradiance_of_the_sunrise_is_negative_somewhere() {
    let map = scene("sunrise");
    let order_3 = truncated(&map.project(3).irradiance(), 3);
    let lowest = |values: [f64; 3]| values.into_iter().fold(f64::INFINITY, f64::min);
    let values: Vec<_> = directions(20_000).map(|d| lowest(order_3.evaluate(d))).collect();
    let negative = values.iter().filter(|&&v| v < 0.0).count() as f64 / values.len() as f64;
    assert!((negative - 0.028).abs() < 0.001, "{negative} of the normals");
    let minimum = values.into_iter().fold(f64::INFINITY, f64::min);
    assert!((minimum + 0.1).abs() < 0.003, "{minimum}");

    let truth = directions(500).map(|d| lowest(direct_irradiance(&map, d)));
    let minimum = truth.fold(f64::INFINITY, f64::min);
    assert!((minimum - 0.037).abs() < 0.001, "{minimum}");
}

#[test]
fn order_32_is_the_irradiance_of_its_definition() {
    let map = scene("studio");
    let irradiance = map.project(32).irradiance();
    let (mut squares, mut all) = (0.0, 0.0);
    for normal in directions(200) {
        let truth = direct_irradiance(&map, normal);
        for (value, truth) in irradiance.evaluate(normal).iter().zip(truth) {
            squares += (value - truth) * (value - truth);
            all += truth * truth;
        }
    }
    let error = (squares / all).sqrt();
    assert!(error < irradiance.errors()[31] && error < 2e-3, "{error}");
}

#[test]
fn energies_are_those_of_the_maps() {
    for name in ["city", "studio", "sunrise"] {
        let map = scene(name);
        let projection = map.project(10);
        let [total, bands] = [map.energy(), projection.band_energy().iter().sum()];
        assert!(projection.beyond > 0.0 && (projection.energy() / total - 1.0).abs() < 1e-14);

        // The energy left out, by quadrature of what is left of the map. Texels are taken as points, which changes a
        // product with band l by l(l+1) Δ²/24: 90 · 2.5e-5 for band 9, in each of two products.
        let mut left = 0.0;
        for (y, row) in map.texels.chunks(map.width).enumerate() {
            for (x, texel) in row.iter().enumerate() {
                let values = projection.evaluate(map.direction(x, y));
                let squares = texel.iter().zip(values).map(|(a, b)| (a - b) * (a - b));
                left += squares.sum::<f64>() * map.solid_angle(x, y);
            }
        }
        assert!((left - projection.beyond).abs() < 4.5e-3 * bands, "{name}");
    }
}

#[test]
fn orders_follow_from_budgets() {
    for (name, by_percent) in [
        ("city", [(25.0, 2), (5.0, 3), (2.0, 5), (1.0, 7)]),
        ("studio", [(40.0, 1), (8.0, 3), (4.0, 5), (2.0, 7)]),
        ("sunrise", [(31.0, 2), (7.0, 3), (4.0, 5), (2.0, 7)]),
    ] {
        let radiance = scene(name).project(32);
        let irradiance = radiance.irradiance();
        for (budget, order) in by_percent {
            let found = irradiance.smallest_order(budget / 100.0);
            assert_eq!(found, Some(order), "{name} within {budget} %: {:?}", irradiance.errors());
        }
        assert!((3..32).all(|l| irradiance.vanishes(l) == (l % 2 == 1)));
        assert!((3..32).step_by(2).all(|l| irradiance.band_energy()[l] == 0.0));
        // The lights are so small that order 32 of the radiance misses more than a tenth of them.
        assert_eq!(radiance.smallest_order(0.1), None);
        assert!(radiance.errors().windows(2).all(|e| e[0] > e[1]));
    }
}

#[test]
fn negative_radiance_is_refused_with_the_place_and_the_cure() {
    let file = path("data/adversarial_sky_negative.exr");
    let error = Map::read(&file).unwrap_err();
    match &error {
        MapError::Negative { lowest, .. } => assert!((lowest + 3394.0).abs() < 1.0, "{lowest}"),
        other => panic!("{other}"),
    }
    let message = error.to_string();
    assert!(message.starts_with(&format!("{}: ", file.display())), "{message}");
    assert!(message.ends_with("clamp the map to 0 and save it again"), "{message}");
    assert!(!message.contains('\n'));
}

#[test]
fn files_that_are_no_maps_are_refused() {
    let whole = std::fs::read(path("../scenes/maps/city_256x128.hdr")).unwrap();
    for length in [20, 50, 60, whole.len() / 2, whole.len() - 1] {
        let error = Map::from_bytes("city.hdr", &whole[..length]).unwrap_err();
        assert!(matches!(error, MapError::Malformed { .. }), "{length}: {error}");
    }
    let message = |bytes: &[u8]| Map::from_bytes("city.hdr", bytes).unwrap_err().to_string();
    assert_eq!(
        message(&whole[..50_000]),
        "city.hdr: cannot be decoded (it ends too early); save or download the map again"
    );
    let negative = std::fs::read(path("data/adversarial_sky_negative.exr")).unwrap();
    for length in [4, 100, 400, 50_000, negative.len() - 1] {
        let error = Map::from_bytes("sky.exr", &negative[..length]).unwrap_err();
        assert!(matches!(error, MapError::Malformed { .. }), "{length}: {error}");
    }

    let text = Map::read(&path("Cargo.toml")).unwrap_err();
    assert!(text.to_string().contains("neither Radiance HDR nor OpenEXR nor PNG"), "{text}");
    let error = Map::read(&path("data/none.hdr")).unwrap_err();
    assert!(matches!(error, MapError::Unreadable { .. }), "{error}");
    assert!(error.to_string().ends_with("check the path and its permissions"));
    let error = Map::read(&path("data")).unwrap_err();
    assert!(error.to_string().contains("hold no face of a cube"), "{error}");
}
