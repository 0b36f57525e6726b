//! Isotropic decomposition by mother functions other than harmonics: their kept directions, their kernels against the integrals
//! that define them, and what is refused (docs/MATH.md#mother-functions).

use std::f64::consts::{PI, TAU};
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::families::Spec;
use zonal_codegen::families::isd::directions::best_of;
use zonal_codegen::families::isd::mother::{Decomposition, Levels, Mother};
use zonal_codegen::families::isd::search::search_own;
use zonal_codegen::generate::build;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::turns::dot;
use zonal_tests::{Runner, norm, spec};

fn runner(text: &str) -> Runner<f64> {
    Runner::new(&spec(text))
}

fn unit(list: &[f64]) -> Vec<f64> {
    list.iter().map(|x| x / norm(list)).collect()
}

fn random(count: usize, random: &mut Random) -> Vec<f64> {
    (0..count).map(|_| random.signed()).collect()
}

/// Kept sets are conditioned as they say and better than the spiral.
#[test]
fn directions_of_mother_functions_are_kept_to_eight_bands() {
    for (mother, word) in [(Mother::Gaussian, 80.0), (Mother::GaussLegendre, 65.0), (Mother::Phong, 40.0)] {
        for bands in 2..=8 {
            let record = best_of(Some(mother), bands).expect("is kept");
            let counted = record.counted().expect("is a set");
            assert!((counted - record.condition).abs() <= 1e-3 * counted, "{mother:?}, {bands} bands: {counted}");
            assert!(counted < word, "{mother:?}, {bands} bands: {counted}");
            let spiral = Decomposition::measured(mother, &Levels::dealt(bands)).condition;
            assert!(counted < 0.7 * spiral, "{mother:?}, {bands} bands: {counted}, {spiral}");
        }
    }
    // The search goes by slopes that it derives; no step leads up.
    let (one, more) = (search_own(Mother::Gaussian, 3, 5, 1, || ()), search_own(Mother::Gaussian, 3, 5, 3, || ()));
    assert!(more.condition <= one.condition && one.condition < 60.0, "{one:?}");
}

/// M against the integrals that define it, its inverse, and shading against the direct form.
#[test]
fn kernels_of_mother_functions_are_as_defined() {
    let mut source = Random::new(31);
    for (mother, choice) in
        [(Mother::Gaussian, ""), (Mother::GaussLegendre, ":gauss_legendre"), (Mother::Phong, ":phong")]
    {
        for order in 3..=5 {
            let count = order * order;
            let lambda = random(count, &mut source);
            let directions: Vec<Vec<f64>> =
                best_of(Some(mother), order - 1).expect("is kept").directions.iter().map(|v| unit(v)).collect();
            let c = runner(&format!("mother_matrix:{order}{choice}")).run(std::slice::from_ref(&lambda));
            // Σ λ φ_l(z · ω) y(ω) over the sphere: a clamped power has a kink of a high degree at most.
            let mut wanted = vec![0.0; count];
            let mut values = vec![0.0; count];
            for (z, weight) in gauss_legendre(96, -1.0, 1.0) {
                for i in 0..192 {
                    let (y, x) = (TAU * f64::from(i) / 192.0).sin_cos();
                    let rim = (1.0 - z * z).sqrt();
                    let at = [rim * x, rim * y, z];
                    let one =
                        |(i, direction): (usize, &Vec<f64>)| lambda[i] * mother.value(i.isqrt(), dot(direction, &at));
                    // Level 0 of the clamped power is one over a half: its edge is summed apart.
                    let skip = usize::from(mother == Mother::Phong);
                    let value: f64 = directions.iter().enumerate().skip(skip).map(one).sum();
                    basis(order, at, &mut values);
                    let share = weight * TAU / 192.0 * value;
                    wanted.iter_mut().zip(&values).for_each(|(sum, y)| *sum += share * y);
                }
            }
            if mother == Mother::Phong {
                basis(order, [directions[0][0], directions[0][1], directions[0][2]], &mut values);
                // ∫ over a half of y_l is 2π y_l(z) ∫ P_l: 1, 1/2, 0, −1/8, 0.
                let half = [1.0, 0.5, 0.0, -0.125, 0.0];
                wanted
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, sum)| *sum += lambda[0] * TAU * half[i.isqrt()] * values[i]);
            }
            let error = norm(&c.iter().zip(&wanted).map(|(a, b)| a - b).collect::<Vec<_>>()) / norm(&wanted);
            assert!(error < 1e-6, "{mother:?}, order {order}: {error:e}");
            let back = runner(&format!("mother_weights:{order}{choice}")).run(std::slice::from_ref(&c));
            let error = norm(&back.iter().zip(&lambda).map(|(a, b)| a - b).collect::<Vec<_>>()) / norm(&lambda);
            // Rounding times the condition, at most 30.
            assert!(error < 1e-13, "{mother:?}, order {order}: {error:e}");
            let q = unit(&random(4, &mut source));
            let e = random(count, &mut source);
            let shaded =
                runner(&format!("mother_shade:{order}{choice}")).run(&[q.clone(), e.clone(), lambda.clone()])[0];
            let direct = runner(&format!("shade:{order}:zyz")).run(&[q, e.clone(), c.clone()])[0];
            assert!((shaded - direct).abs() <= 1e-13 * norm(&e) * norm(&lambda) * 4.0 * PI, "{shaded}, {direct}");
        }
    }
}

#[test]
fn a_hopeless_matrix_is_refused_with_its_figure() {
    for name in ["mother_matrix", "mother_weights", "mother_shade"] {
        let error = format!("{name}:4:even_phong").parse::<Spec>().expect_err("copies of an even function");
        let text = error.to_string();
        assert!(text.contains("condition number is") && text.contains("clamped"), "{text}");
        let error = format!("{name}:6").parse::<Spec>().expect_err("is too large").to_string();
        assert!(error.contains("3 to 5"), "{error}");
        let error = format!("{name}:4:phong:gaussian").parse::<Spec>().expect_err("two at once").to_string();
        assert!(error.contains("exclude each other"), "{error}");
        build(&[spec(&format!("{name}:3:phong")), spec(&format!("{name}:3"))]);
    }
}
