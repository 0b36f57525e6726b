//! The laws of the approximate rotations against their kernels' own matrices.

use zonal_codegen::families::about_y::about_y;
use zonal_codegen::families::axis::ROTATE_Y;
use zonal_codegen::families::family::AngleAs;
use zonal_codegen::families::{SmallAngle, Spec};
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::accuracy::band_errors;
use zonal_codegen::promise::law;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{norm, spec};

const DEGREES: [f64; 6] = [1e-3, 1.0, 5.0, 10.0, 15.0, 25.0];

#[test]
fn the_law_is_the_spectral_norm_of_every_band() {
    for text in [
        "taylor1:10",
        "taylor15:10",
        "taylor2:10",
        "lf3:10",
        "lf5:10",
        "lf3:12",
        "lf5:12",
        "rotate:7:lf5",
        "rotate_small:10",
        "rotate_small:10:lf5",
        "rotate_small:10:taylor1",
        "rotate_small:10:taylor15",
        "rotate_small:10:taylor2",
        "tilt:10",
        "tilt:10:lf5",
        "tilt_prescaled:6",
        "mix:5:taylor15+taylor15+taylor15+taylor1",
        "rotate:6",
    ] {
        let spec = spec(text);
        let angles = DEGREES.map(f64::to_radians);
        for (angle, measured) in angles.iter().zip(band_errors(&spec, &angles)) {
            let law = law::errors(&spec, *angle);
            for (l, (law, measured)) in law.iter().zip(&measured).enumerate() {
                // The kernels' constants and sums are rounded in f64: some 1e-14 of a rotation.
                let close = (law.max - measured).abs() <= 1e-6 * measured + 1e-13;
                assert!(close, "{text}, band {l} at {angle}: law {:e}, measured {measured:e}", law.max);
            }
        }
    }
}

/// The mean of the law against the errors of random signals.
#[test]
fn the_law_is_what_random_signals_err_by() {
    let mut random = Random::new(41);
    let (order, beta) = (7, 0.2f64);
    for (text, method) in SmallAngle::APPROXIMATE.map(|method| (method.name(), method)) {
        let approximate = Program::<f64>::new(&Listing::new(&about_y(order, &vec![method; order - 1])));
        let exact = Program::<f64>::new(&Listing::new(&Spec::new(&ROTATE_Y, order).kernel()));
        let mut squares = vec![0.0; order];
        let count = 2000;
        for _ in 0..count {
            let mut c: Vec<f64> = (0..order * order).map(|_| (0..12).map(|_| random.signed()).sum()).collect();
            for l in 0..order {
                let size = norm(&c[l * l..(l + 1) * (l + 1)]);
                c[l * l..(l + 1) * (l + 1)].iter_mut().for_each(|x| *x /= size);
            }
            let got = approximate.run(&[&[beta], &c], Contraction::Separate);
            let want = exact.run(&[&[beta.cos(), beta.sin()], &c], Contraction::Separate);
            for (l, square) in squares.iter_mut().enumerate() {
                let band = l * l..(l + 1) * (l + 1);
                *square += got[band.clone()].iter().zip(&want[band]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            }
        }
        for l in 1..order {
            let (mean, law) = ((squares[l] / count as f64).sqrt(), law::error(method, AngleAs::Angle, l, beta).mean);
            // Two thousand samples of a sum of squares that varies by less than its mean: half of 1 / √2000, times 4.
            assert!((mean / law - 1.0).abs() < 0.05, "{text}, band {l}: {mean:e}, law {law:e}");
        }
    }
}

/// What a planner may count on: the error grows with the angle as far as the methods are meant for.
#[test]
fn the_law_grows_with_the_angle() {
    for method in SmallAngle::APPROXIMATE {
        for given in [AngleAs::Angle, AngleAs::Phase, AngleAs::Normal] {
            for l in 1..10 {
                let mut last = 0.0;
                for step in 1..=100 {
                    let beta = f64::to_radians(25.0) * f64::from(step) / 100.0;
                    let error = law::error(method, given, l, beta).max;
                    let ends = l as f64 * beta > 2.0;
                    assert!(
                        error >= last || ends,
                        "{method:?}, {given:?}, band {l} at {beta}: {error:e} after {last:e}"
                    );
                    last = error;
                }
            }
        }
    }
}
