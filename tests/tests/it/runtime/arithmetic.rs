//! Code that is generic over the order: coefficients as slices and bands, sums and products by their meaning, sizes that do
//! not fit, and what is written to files and bytes.

use super::{TRIALS, direction, narrow, signal};
use glam::Vec3;
use zonal::{Coefficients, Element, Error};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::band_error;

/// The integral over the sphere of what has at most 23 bands: the products of two signals of order 10, and more.
pub(super) fn integral(f: impl Fn([f64; 3]) -> f64) -> f64 {
    const COLUMNS: usize = 24;
    let columns = |z: f64| {
        let radius = (1.0 - z * z).sqrt();
        let at = move |column: usize| (column as f64 * std::f64::consts::TAU / COLUMNS as f64).sin_cos();
        (0..COLUMNS).map(at).map(move |(sin, cos)| [radius * cos, radius * sin, z])
    };
    let row = |z| columns(z).map(&f).sum::<f64>() * std::f64::consts::TAU / COLUMNS as f64;
    gauss_legendre(12, -1.0, 1.0).map(|(z, weight)| weight * row(z)).sum()
}

#[test]
fn sums_and_products_are_those_of_the_values() {
    let mut random = Random::new(41);
    for _ in 0..TRIALS {
        let (dir, t) = (direction(&mut random), random.signed());
        every_order!(N, {
            let [a, b] = [(); 2].map(|()| signal::<N>(&mut random));
            let value = |c: &[f64; N]| zonal::evaluate(dir, c);
            let close =
                |got: f64, want: f64| assert!((got - want).abs() <= 1e-12, "order {}: {got}, {want}", N.isqrt());
            close(value(&zonal::add(&a, &b)), value(&a) + value(&b));
            close(value(&zonal::scale(&a, t)), t * value(&a));
            close(value(&zonal::lerp(&a, &b, t)), (1.0 - t) * value(&a) + t * value(&b));
            assert_eq!(zonal::lerp(&a, &b, 0.0), a);
            assert!(band_error(&zonal::lerp(&a, &b, 1.0), &b) <= 1e-15);
            // Harmonics are orthonormal.
            let product = integral(|dir| zonal::evaluate(dir, &a) * zonal::evaluate(dir, &b));
            close(zonal::dot(&a, &b), product);
            close(zonal::weigh(&a, &b), product);
            close(zonal::weigh(&zonal::evaluate_basis(dir), &a), value(&a));

            let [rgb_a, rgb_b] = [&a, &b].map(|c| c.map(|c| [c, 2.0 * c, -c]));
            let [r, g, b] = zonal::dot(&rgb_a, &rgb_b);
            assert!(r == product_of(&a, &rgb_b, 0) && (g - 4.0 * r).abs() <= 1e-12 && (b - r).abs() <= 1e-12);
            assert_eq!(zonal::weigh(&a, &rgb_b).map(|x| (x - r).abs() <= 1e-12), [true, false, false]);
        });
    }
}

fn product_of<const N: usize>(a: &[f64; N], b: &[[f64; 3]; N], channel: usize) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b[channel]).sum()
}

#[test]
fn another_order_has_the_bands_that_both_have() {
    let mut random = Random::new(43);
    let all = signal::<100>(&mut random);
    every_order!(N, {
        let cut: [f64; N] = zonal::resize(&all);
        assert_eq!(cut[..], all[..N]);
        let back: [f64; 100] = zonal::resize(&cut);
        assert_eq!((&back[..N], &back[N..]), (&all[..N], &[0.0; 100][N..]));
        assert_eq!(zonal::resize::<_, [f64; N]>(&cut), cut);
    });
}

/// The sum of the squares of each band, and the indices, by nothing but the trait.
fn energies<C: Coefficients>(c: &C) -> Vec<f64> {
    let square = |x: C::Scalar| -> f64 { Into::<f64>::into(x).powi(2) };
    c.bands().map(|band| band.iter().flat_map(Element::channels).map(|&x| square(x)).sum()).collect()
}

#[test]
fn what_is_generic_over_the_order_needs_the_trait_alone() {
    let mut random = Random::new(47);
    every_order!(N, {
        type Rgb = [Vec3; N];
        let order = N.isqrt();
        assert_eq!((<[f32; N]>::ORDER, Rgb::COUNT), (order, N));
        assert_eq!(Rgb::zero(), [Vec3::ZERO; N]);
        let indices = <[f64; N]>::from_fn(|i| i as f64);
        assert_eq!((indices[0], indices[N - 1]), (0.0, (N - 1) as f64));
        let firsts: Vec<f64> = indices.bands().map(|band| band[0]).collect();
        assert_eq!(firsts, (0..order).map(|l| (l * l) as f64).collect::<Vec<_>>());
        assert_eq!(indices.bands().map(<[f64]>::len).sum::<usize>(), N);

        // Each band of a test's signal has the norm one.
        let c = signal::<N>(&mut random);
        for energy in energies(&c).into_iter().chain(energies(&narrow(&c)).into_iter()) {
            assert!((energy - 1.0).abs() < 1e-6, "{energy}");
        }
        let mut louder = c.map(|c| [c as f32; 3]);
        louder.bands_mut().enumerate().for_each(|(l, band)| band.iter_mut().for_each(|c| *c = c.map(|x| x * l as f32)));
        assert_eq!(louder, zonal::scale_bands(&c.map(|c| [c as f32; 3]), |l| l as f32));
        for (l, energy) in energies(&louder).into_iter().enumerate() {
            assert!((energy - (3 * l * l) as f64).abs() < 1e-4, "band {l}: {energy}");
        }
    });
}

#[test]
fn slices_that_do_not_fit_are_refused_with_their_sizes() {
    let (numbers, words) = ([0.5_f32; 400], |result: Result<[[f32; 3]; 9], Error>| result.unwrap_err().to_string());
    assert_eq!(
        words(<[[f32; 3]; 9]>::from_numbers(&numbers[..9])),
        "9 numbers, but order 3 in RGB is 9 of 3, which makes 27"
    );
    assert_eq!(words(<[[f32; 3]; 9]>::from_slice(&[[0.5; 3]; 16])), "16 coefficients, but order 3 is 9");
    let one = <[f32; 16]>::from_numbers(&numbers[..27]).unwrap_err();
    assert_eq!(one.to_string(), "27 numbers, but order 4 in one channel is 16 of 1, which makes 16");
    every_order!(N, {
        for length in 0..400 {
            let (array, rgb) =
                (<[f32; N]>::from_slice(&numbers[..length]), <[Vec3; N]>::from_numbers(&numbers[..length]));
            assert_eq!((array.is_ok(), rgb.is_ok()), (length == N, length == 3 * N), "{length}");
        }
    });
    let rising: Vec<f32> = (0..27).map(|i| i as f32).collect();
    let rgb = <[[f32; 3]; 9]>::from_numbers(&rising).expect("27 numbers");
    assert_eq!((rgb[0], rgb[8]), ([0.0, 1.0, 2.0], [24.0, 25.0, 26.0]));
}

#[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Probe {
    #[serde(with = "zonal::serde")]
    radiance: [[f32; 3]; 36],
    #[serde(with = "zonal::serde")]
    shadow: [f64; 100],
    #[serde(with = "zonal::serde")]
    vectors: [Vec3; 4],
}

#[test]
fn coefficients_of_every_order_are_written_and_read() {
    let mut random = Random::new(53);
    let probe = Probe {
        radiance: std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32)),
        shadow: signal(&mut random),
        vectors: std::array::from_fn(|i| Vec3::splat(i as f32)),
    };
    let text = serde_json::to_string(&probe).expect("writable");
    assert_eq!(serde_json::from_str::<Probe>(&text).expect("readable"), probe);
    for (from, to, count) in [("]],\"shadow\"", "],[0,0,0]],\"shadow\"", 37), ("[[0.0,0.0,0.0],", "[", 3)] {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text);
        let error = serde_json::from_str::<Probe>(&broken).expect_err("a size is wrong").to_string();
        let wanted = if count == 37 { "36 coefficients of order 6" } else { "4 coefficients of order 2" };
        assert!(error.contains(&format!("invalid length {count}, expected {wanted}")), "{error}");
    }
}

#[test]
fn coefficients_are_bytes() {
    let mut random = Random::new(59);
    let rgb: [[f32; 3]; 25] = std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32));
    let bytes: &[u8] = bytemuck::cast_slice(&rgb);
    assert_eq!(bytes.len(), 25 * 12);
    let vectors: &[Vec3] = bytemuck::cast_slice(&rgb);
    assert_eq!(<[Vec3; 25]>::from_slice(vectors).expect("25 of them"), rgb.map(Vec3::from_array));
    let channels: &[zonal::real::Channels<f32, 3>] = bytemuck::cast_slice(&rgb);
    assert!(channels.iter().zip(rgb).all(|(channel, rgb)| channel.0 == rgb));
}
