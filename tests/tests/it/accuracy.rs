//! What the files' heads promise, measured over inputs that the promise was not made from.

use rayon::prelude::*;
use zonal_codegen::emit::Function;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::math::linear::spectral_norm;
use zonal_codegen::promise::accuracy::{Accuracy, method_errors, round_up, rounding};
use zonal_tests::catalogue;

/// What is proven is measured with more inputs in `bounds`.
#[test]
fn every_kernel_that_is_measured_keeps_its_rounding_bound() {
    let is_measured = |function: &&Function| !function.spec.rgb && !function.built.accuracy.proven;
    let functions: Vec<_> = catalogue().iter().filter(is_measured).collect();
    assert!(functions.len() > 150, "{}", functions.len());
    functions.par_iter().for_each(|function| {
        let promised = function.built.accuracy.rounding_f32;
        for contraction in [Contraction::Separate, Contraction::Fused] {
            let measured = rounding::<f32>(&function.spec, &function.built.code, 99, 2000, contraction);
            assert!(measured <= promised, "{}: {measured:e} above {promised:e}", function.spec);
        }
    });
}

#[test]
fn method_errors_follow_their_laws() {
    // docs/MATH.md#taylor-expansions and docs/MATH.md#three-shears: T1 = L²/2, T2 = L³/6, LF3 = L³/24 with L = lβ, the
    // largest band's, for small L.
    let beta = 0.02;
    for order in [4usize, 6, 9] {
        let l = (order - 1) as f64;
        let error = |method: &str| method_errors(&zonal_tests::spec(&format!("{method}:{order}")), &[beta])[0];
        let even = |l: f64| if (l as usize).is_multiple_of(2) { l * l * l } else { l * l * l - l };
        let laws = [
            ("taylor1", (l * beta).powi(2) / 2.0),
            ("taylor2", (l * beta).powi(3) / 6.0),
            ("lf3", even(l) * beta.powi(3) / 24.0),
        ];
        for (method, law) in laws {
            assert!((error(method) / law - 1.0).abs() < 0.03, "{method}:{order}: {:e}, law {law:e}", error(method));
        }
        // Taylor 1.5 is about L²/4.
        assert!((error("taylor15") / (l * beta).powi(2) / 0.25 - 1.0).abs() < 0.2, "taylor15:{order}");
    }
}

#[test]
fn method_errors_equal_the_measured_figure_3() {
    // docs/MATH.md#taylor-expansions: degrees at which the largest error reaches 1e-2.
    for (text, degrees) in [
        ("taylor1:5", 2.03),
        ("taylor15:5", 3.00),
        ("taylor2:5", 5.61),
        ("taylor1:8", 1.16),
        ("taylor15:8", 1.68),
        ("taylor2:8", 3.21),
    ] {
        let error = method_errors(&zonal_tests::spec(text), &[f64::to_radians(degrees)])[0];
        assert!((error / 1e-2 - 1.0).abs() < 0.02, "{text} at {degrees}: {error:e}");
    }
    // docs/MATH.md#shears-of-the-tilt: the shears' and the tilt's error a band.
    for (text, degrees, error) in [("tilt:5", 10.0, 1.4e-2), ("tilt:8", 10.0, 8.1e-2), ("lf3:5", 5.0, 1.8e-3)] {
        let measured = method_errors(&zonal_tests::spec(text), &[f64::to_radians(degrees)])[0];
        assert!((measured / error - 1.0).abs() < 0.05, "{text} at {degrees}: {measured:e}");
    }
}

#[test]
fn exact_kernels_have_no_method_error() {
    for text in ["rotate:5", "tilt:3", "rotate_y:8", "zhf:4"] {
        let built = zonal_codegen::promise::built::Built::new(&zonal_tests::spec(text));
        assert!(built.accuracy.method.is_empty(), "{text}");
    }
    let tilt: Accuracy = zonal_codegen::promise::built::Built::new(&zonal_tests::spec("tilt:4")).accuracy;
    assert_eq!(tilt.method.len(), 4);
}

#[test]
fn bounds_are_rounded_up_to_two_digits() {
    for (value, want) in [(1.234e-7, 1.3e-7), (9.96e-3, 1.0e-2), (2.0, 2.0), (0.0, 0.0), (1.2001e5, 1.3e5)] {
        assert_eq!(round_up(value), want);
    }
}

#[test]
fn the_spectral_norm_of_a_known_matrix() {
    // [[3, 0], [4, 5]] has the singular values 3√5 and √5.
    let norm = spectral_norm(&[vec![3.0, 4.0], vec![0.0, 5.0]]);
    assert!((norm - 3.0 * 5f64.sqrt()).abs() < 1e-12, "{norm}");
    assert_eq!(spectral_norm(&[vec![0.0]]), 0.0);
}

#[test]
fn rounding_is_what_separates_f32_from_f64() {
    let spec = zonal_tests::spec("rotate:4");
    let code = spec.code();
    assert_eq!(rounding::<f64>(&spec, &code, 1, 50, Contraction::Separate), 0.0);
    assert!(rounding::<f32>(&spec, &code, 1, 50, Contraction::Separate) > 1e-8);
}
