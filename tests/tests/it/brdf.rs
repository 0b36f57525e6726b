//! Reflectances: their coefficients against dense quadrature of their values and against closed forms, their albedo,
//! the error of looking them up, and what is no reflectance.

use std::f64::consts::PI;

use zonal_codegen::environment::{Map, cosine_lobe};
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::brdf::{Brdf, BrdfError, Table};

const ALL: [&str; 6] = ["lambert", "phong:5", "phong:100", "ward:0.3", "ward:0.1", "ward:0.2:0.6"];

fn brdf(text: &str) -> Brdf {
    text.parse().unwrap()
}

fn view(elevation: f64, azimuth: f64) -> [f64; 3] {
    let (sin, cos) = elevation.to_radians().sin_cos();
    let (y, x) = azimuth.to_radians().sin_cos();
    [sin * x, sin * y, cos]
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// The coefficients of the reflectance as an image of the sphere: another quadrature, in another order.
fn by_a_map(brdf: &Brdf, view: [f64; 3], order: usize) -> Vec<f64> {
    let mut map = Map { width: 1024, height: 512, texels: vec![[0.0; 3]; 1024 * 512] };
    for i in 0..map.texels.len() {
        map.texels[i] = [brdf.value(view, map.direction(i % map.width, i / map.width)); 3];
    }
    map.project(order).coefficients.iter().map(|c| c[0]).collect()
}

#[test]
fn coefficients_are_those_of_a_dense_map_of_values() {
    for text in ALL {
        for [elevation, azimuth] in [[0.0, 0.0], [20.0, 70.0], [60.0, 200.0], [80.0, 310.0]] {
            let view = view(elevation, azimuth);
            let (found, expected) = (brdf(text).coefficients(view, 8), by_a_map(&brdf(text), view, 8));
            // A texel holds the value at its centre and is 0.35 degrees wide: at most l(l+1) Δ²/24 = 9e-5 of band 7.
            // The lobes' own quadrature promises 1e-3.
            let error = distance(&found, &expected) / norm(&expected);
            assert!(error < 1e-3, "{text} at {elevation}, {azimuth}: {error:.1e}");
        }
    }
}

#[test]
fn lambert_is_the_cosine_lobe_and_an_upright_phong_lobe_has_its_closed_form() {
    let lambert = brdf("lambert").coefficients(view(50.0, 10.0), 10);
    for l in 0..10 {
        let expected = cosine_lobe(l) / PI * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
        assert!((lambert[l * (l + 1)] - expected).abs() < 1e-15);
    }
    // Seen from above, the lobe is a clamped power s + 1 of z, whose integral I(p, l) against P_l obeys
    // (p + l + 1) I(p, l) = p I(p - 1, l - 1) and I(p, 0) = 1 / (p + 1), for any p but negative integers.
    fn moment(power: f64, l: usize) -> f64 {
        match l {
            0 => 1.0 / (power + 1.0),
            _ => power * moment(power - 1.0, l - 1) / (power + l as f64 + 1.0),
        }
    }
    for exponent in [1.5, 20.5, 400.5] {
        let found = Brdf::Phong { exponent }.coefficients([0.0, 0.0, 1.0], 9);
        for l in 0..9 {
            let expected = (exponent + 2.0) * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * moment(exponent + 1.0, l);
            let error = found[l * (l + 1)] - expected;
            // What lies below 1e-9 of the peak is left out.
            assert!(error.abs() < 1e-7, "phong:{exponent}, band {l}: {error:.1e}");
        }
        let others = (0..81).filter(|i| !(0..9).any(|l| l * (l + 1) == *i)).map(|i| found[i].abs());
        assert!(others.fold(0.0, f64::max) < 1e-12);
    }
}

#[test]
fn no_reflectance_sends_more_than_it_gets() {
    for text in ALL {
        for elevation in [0.0, 15.0, 45.0, 75.0, 89.0, 90.0] {
            // The first coefficient is the albedo over √4π.
            let albedo = brdf(text).coefficients(view(elevation, 30.0), 2)[0] * (4.0 * PI).sqrt();
            assert!(albedo > 0.02 && albedo < 1.0 + 1e-6, "{text} at {elevation}: {albedo}");
        }
    }
    let upright = |text| brdf(text).coefficients([0.0, 0.0, 1.0], 2)[0] * (4.0 * PI).sqrt();
    assert!((upright("phong:50") - 1.0).abs() < 1e-6);
    assert!(upright("ward:0.05") > 0.99);
}

#[test]
fn light_and_view_change_places_and_nothing_passes_the_horizon() {
    let mut random = Random::new(7);
    let mut above = || {
        let [x, y, z] = random.unit::<3>();
        [x, y, z.abs()]
    };
    for _ in 0..1000 {
        let (v, l) = (above(), above());
        for text in ALL {
            let (there, back) = (brdf(text).value(v, l) * v[2], brdf(text).value(l, v) * l[2]);
            assert!((there - back).abs() <= 1e-12 * there.abs().max(1e-300), "{text}");
            assert!(there >= 0.0);
            assert_eq!(brdf(text).value(v, [l[0], l[1], -l[2]]), 0.0);
        }
    }
}

#[test]
fn a_table_looks_up_within_a_hundredth() {
    let mut random = Random::new(8);
    for text in ["lambert", "phong:5", "phong:50", "ward:0.3", "ward:0.15", "ward:0.2:0.6"] {
        for order in [3, 5, 8] {
            let table = Table::new(&brdf(text), order);
            assert_eq!(table.values.len(), table.elevations * table.azimuths * table.stride());
            assert_eq!(table.azimuths == 1, brdf(text).is_isotropic());
            let last_step = table.view(table.elevations - 2, 0)[2];
            for _ in 0..200 {
                let [x, y, z] = random.unit::<3>();
                let view = [x, y, z.abs()];
                let exact = brdf(text).coefficients(view, order);
                let error = distance(&table.at(view), &exact) / norm(&exact);
                let bound = if view[2] < last_step && text.starts_with("ward") { 0.07 } else { 0.01 };
                assert!(error < bound, "{text}, order {order}, view {view:?}: {error:.1e}");
            }
        }
    }
}

#[test]
fn texts_name_reflectances_or_say_what_is_wrong() {
    for text in ALL {
        assert_eq!(brdf(text).to_string(), text);
    }
    assert_eq!(brdf("ward:0.3:0.3"), brdf("ward:0.3"));
    for text in ["", "phong", "phong:x", "ward", "ward:0.2:0.3:0.4", "lambert:1", "Phong:2"] {
        assert_eq!(text.parse::<Brdf>(), Err(BrdfError::Unknown(text.to_owned())));
    }
    for text in ["phong:0", "phong:-3", "phong:1e9", "phong:NaN", "ward:0", "ward:0.2:7", "ward:inf"] {
        let error = text.parse::<Brdf>().unwrap_err();
        assert!(matches!(error, BrdfError::Range { .. }), "{text}: {error}");
        assert!(error.to_string().contains("write a number from"), "{error}");
    }
}
