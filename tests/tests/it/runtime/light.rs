//! Irradiance and convolutions against integrals over the sphere, windows, and how negative a signal is against functions
//! whose least value is known.

use super::arithmetic::integral;
use super::{TRIALS, direction, narrow, signal, wide};
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};
use zonal::Coefficients;
use zonal_codegen::environment::cosine_lobe;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::band_error;

/// Legendre's polynomial by its recurrence.
fn legendre(l: usize, t: f64) -> f64 {
    let (mut before, mut value) = (0.0, 1.0);
    for k in 0..l {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * t * value - k * before) / (k + 1.0));
    }
    value
}

#[test]
fn the_cosine_factors_are_their_integrals() {
    for l in 0..=20 {
        // 16 points are exact to degree 31.
        let integral: f64 = gauss_legendre(16, 0.0, 1.0).map(|(t, weight)| weight * t * legendre(l, t)).sum();
        let factor = zonal::cosine_factor(l);
        assert!((factor - TAU * integral).abs() < 1e-14, "band {l}: {factor}");
        assert!((factor - cosine_lobe(l)).abs() < 1e-15, "band {l}: {factor}");
    }
    assert!([3, 5, 7, 63].iter().all(|&l| zonal::cosine_factor(l) == 0.0));
}

/// What a surface gets: radiance times the cosine over the hemisphere around a normal. In the frame of the normal it is a
/// polynomial of degree 10 at most in the height, and has as many waves in the azimuth.
fn gathered<C: Coefficients<Element = f64, Scalar = f64>>(normal: DVec3, radiance: &C) -> f64 {
    let frame = DQuat::from_rotation_arc(DVec3::Z, normal);
    let row = |t: f64| {
        let radius = (1.0 - t * t).sqrt();
        let at = |i: i32| {
            frame
                * DVec3::new(radius * (f64::from(i) * TAU / 16.0).cos(), radius * (f64::from(i) * TAU / 16.0).sin(), t)
        };
        (0..16).map(|i| zonal::evaluate(at(i), radiance)).sum::<f64>() * TAU / 16.0
    };
    gauss_legendre(16, 0.0, 1.0).map(|(t, weight)| weight * t * row(t)).sum()
}

#[test]
fn irradiance_is_what_a_surface_gathers() {
    let mut random = Random::new(61);
    for _ in 0..TRIALS {
        let normal = direction(&mut random);
        every_order!(N, {
            let radiance = signal::<N>(&mut random);
            let want = gathered(normal, &radiance);
            let got = [zonal::evaluate(normal, &zonal::irradiance(&radiance)), zonal::irradiance_at(normal, &radiance)];
            assert!(got.iter().all(|got| (got - want).abs() < 1e-12), "order {}: {got:?}, not {want}", N.isqrt());
            // In f32: the rounding of a sum of up to 100 products of numbers up to 3.
            let narrow = zonal::irradiance_at(normal.as_vec3(), &narrow(&radiance).map(|c| [c, 2.0 * c]));
            assert!((f64::from(narrow[0]) - want).abs() < 2e-5 && (f64::from(narrow[1]) - 2.0 * want).abs() < 4e-5);
        });
    }
}

#[test]
fn a_convolution_is_an_integral() {
    let mut random = Random::new(67);
    for _ in 0..TRIALS / 4 {
        let towards = direction(&mut random);
        every_order!(N, {
            const ORDER: usize = N.isqrt();
            let (c, g): ([f64; N], [f64; ORDER]) = (signal(&mut random), std::array::from_fn(|_| random.signed()));
            // The function about z, by its definition.
            let lobe = |t: f64| -> f64 {
                (0..ORDER).map(|l| g[l] * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * legendre(l, t)).sum()
            };
            let want = integral(|dir| zonal::evaluate(dir, &c) * lobe(DVec3::from_array(dir).dot(towards)));
            let got = zonal::evaluate(towards, &zonal::convolve(&c, &g));
            assert!((got - want).abs() < 1e-11, "order {ORDER}: {got}, not {want}");
            let rgb = zonal::convolve(&c.map(|c| [c, -c]), &g);
            assert_eq!(rgb.map(|[a, b]| [a, -b]), zonal::convolve(&c, &g).map(|c| [c, c]));
        });
    }
}

#[test]
fn windows_fall_from_one_to_zero() {
    for width in [1.0, 2.5, 3.0, 4.0, 10.0] {
        for l in 0..12 {
            let share = l as f64 / width;
            let (hann, lanczos) = (zonal::hann(l, width), zonal::lanczos(l, width));
            // Of the half angle, which is another way to compute the same.
            let want = if share < 1.0 { (0.5 * PI * share).cos().powi(2) } else { 0.0 };
            assert!((hann - want).abs() < 1e-15, "band {l} of {width}: {hann}");
            // Euler's product, cut where its factors are 1 - 2.5e-7 and later.
            let product: f64 = (1..2000).map(|k| 1.0 - (share / f64::from(k)).powi(2)).product();
            let want = if share < 1.0 { product } else { 0.0 };
            assert!((lanczos - want).abs() < 1e-3, "band {l} of {width}: {lanczos}, not {want}");
            assert!((zonal::hann(l, width as f32) - hann as f32).abs() < 1e-6);
            assert!(lanczos >= hann - 1e-15, "the milder one");
        }
    }
    for bad in [0.0, -1.0, f64::NAN] {
        assert_eq!([zonal::hann(0, bad), zonal::lanczos(0, bad)], [1.0; 2]);
        assert_eq!([zonal::hann(1, bad), zonal::lanczos(1, bad)], [0.0; 2]);
    }
    assert_eq!([zonal::hann(3, f64::INFINITY), zonal::lanczos(3, 1e300)], [1.0; 2]);
}

/// a + b t + c t² about some direction, as coefficients of an order.
fn quadratic([a, b, c]: [f64; 3], axis: DVec3) -> [f64; 9] {
    // 1, t and (3 t² − 1) / 2 are √(4π / (2l + 1)) times the harmonics about the axis.
    let bands = [a + c / 3.0, b, 2.0 * c / 3.0];
    let y: [f64; 9] = zonal::evaluate_basis(axis);
    std::array::from_fn(|i| {
        let l = i.isqrt();
        bands[l] * 4.0 * PI / (2 * l + 1) as f64 * y[i]
    })
}

#[test]
fn the_least_value_and_the_negative_share_are_those_of_known_functions() {
    let mut random = Random::new(71);
    for _ in 0..TRIALS / 4 {
        let axis = direction(&mut random);
        for [a, b, c] in [[0.1, 1.0, 0.0], [0.5, 1.0, 2.0], [-0.2, 0.3, 1.5], [1.0, 0.5, -2.0], [1.0, 0.5, 0.5]] {
            let value = |t: f64| a + b * t + c * t * t;
            let peak = if c == 0.0 { 1.0 } else { (-b / (2.0 * c)).clamp(-1.0, 1.0) };
            let ends = [value(-1.0), value(1.0), value(peak)];
            let least = ends.into_iter().fold(f64::INFINITY, f64::min);
            let most = ends.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            // Where it is below 0, counted finely.
            let negative = (0..100_000).filter(|i| value((f64::from(*i) + 0.5) / 5e4 - 1.0) < 0.0).count() as f64 / 1e5;
            let signal = quadratic([a, b, c], axis);
            let got = zonal::least(&signal);
            // At order 3 a kernel finds it, to some hundred roundings.
            assert!((got - least).abs() <= 1e-13 * (1.0 + most), "{got}, not {least} of {a}, {b}, {c}");
            let share = zonal::negative_share(&signal);
            // The circles where it vanishes cross the texels of a grid of 48 rows.
            assert!((share - negative).abs() < 0.01, "{share}, not {negative} of {a}, {b}, {c}");
            let both = zonal::least(&zonal::resize::<_, [[f32; 2]; 16]>(&signal.map(|x| [x as f32, -x as f32])));
            assert!((f64::from(both[0]) - got).abs() < 0.01 * most && both[1] < 0.0);
        }
    }
}

#[test]
fn a_window_takes_what_rings() {
    every_order!(N, {
        let lobe = zonal::evaluate_basis::<[f64; N]>([0.0, 0.0, 1.0]);
        let windowed = zonal::scale_bands(&lobe, |l| zonal::hann(l, N.isqrt() as f64));
        let ringing = |c: &[f64; N]| -zonal::least(c) / zonal::evaluate([0.0, 0.0, 1.0], c);
        assert!(ringing(&windowed) < 0.6 * ringing(&lobe), "order {}", N.isqrt());
        assert!(band_error(&wide(&narrow(&windowed)), &windowed) < 1e-6);
    });
}
