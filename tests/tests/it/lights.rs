//! Zonal functions and lights against golden values, integrals over the sphere and the formulas that were published, and
//! what they give at the ends of what they take.

use serde_json::Value;
use std::f64::consts::PI;
use zonal_codegen::families::parts::zonal::{Gaussian, cosine_lobe};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::accuracy::Accuracy;
use zonal_codegen::promise::samples::{Random, inputs};
use zonal_tests::command::command;
use zonal_tests::turns::{Sphere, dot, frame_of};
use zonal_tests::{Runner, golden, larger, norm, numbers, spec};

/// The orders to which a table is known to 50 digits.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=10;

fn wide(text: &str) -> Runner<f64> {
    Runner::new(&spec(text))
}

fn narrow(text: &str) -> Runner<f32> {
    Runner::new(&spec(text))
}

/// What a kernel's head promises of f32.
fn promised(text: &str) -> f64 {
    let spec = spec(text);
    Accuracy::of(&spec, &spec.code()).rounding_f32
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<_>>())
}

/// The largest difference of two lists.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, larger)
}

/// The cases of a golden table: a number and the coefficients that it makes.
fn table(file: &Value, name: &str, parameter: &str) -> Vec<(f64, Vec<f64>)> {
    let cases = file[name].as_array().expect("a table has cases").iter();
    cases.map(|case| (case[parameter].as_f64().expect("a number"), numbers(&case["e"]))).collect()
}

/// f64 against the golden values, each relative to itself: a cap is as exact for a radius of 1e-6 as for a hemisphere.
/// In f32 the head's bound holds, and the numbers of small caps keep their digits: some ten roundings of each.
#[test]
fn caps_meet_the_golden_values_whatever_their_size() {
    let cases = table(&golden("zonal"), "cap", "s");
    assert!(cases.iter().any(|(s, _)| *s == 1e-12) && cases.iter().any(|(s, _)| *s == 1.0));
    for order in ORDERS {
        let text = format!("cap:{order}");
        let (wide, narrow, bound) = (wide(&text), narrow(&text), promised(&text));
        for (s, want) in &cases {
            let got = wide.run(&[vec![*s]]);
            for (l, (got, want)) in got.iter().zip(want).enumerate() {
                let error = (got - want).abs() / want.abs().max(want_floor(*s));
                assert!(error <= 1e-13, "{text}, s {s}, band {l}: {error:e}");
            }
            // Against what f64 makes of the same f32: half a rounding of s is none of the kernel's.
            let s = f64::from(*s as f32);
            let (got, want) = (narrow.run(&[vec![s]]), wide.run(&[vec![s]]));
            assert!(largest(&got, &want) <= bound, "{text}, s {s}: {got:?}, {want:?}");
            if s < 1e-3 {
                assert!(
                    got.iter().zip(&want).all(|(a, b)| (a - b).abs() <= 2e-6 * b),
                    "{text}, s {s}: {got:?}, {want:?}"
                );
            }
        }
    }
}

/// Where a band of a large cap passes zero its error is one of the largest band's.
fn want_floor(s: f64) -> f64 {
    if s > 0.01 { s } else { 0.0 }
}

/// 1e-13 of the first coefficient: what upward recurrence makes of roundings at its limit is 2e-14 at order 10.
#[test]
fn gaussians_meet_the_golden_values_whatever_their_sharpness() {
    let cases = table(&golden("zonal"), "sg", "kappa");
    assert!(cases.len() >= 10);
    for order in ORDERS {
        let text = format!("gaussian:{order}");
        let (wide, narrow, bound) = (wide(&text), narrow(&text), promised(&text));
        let short = self::wide(&format!("{text}:f32"));
        for (kappa, want) in &cases {
            let got = wide.run(&[vec![*kappa]]);
            let error = largest(&got, &want[..order]) / want[0];
            assert!(error <= 1e-13, "{text}, kappa {kappa}: {error:e}");
            let error = largest(&short.run(&[vec![*kappa]]), &want[..order]) / want[0];
            assert!(error <= 2e-8 * 1.1, "{text}:f32, kappa {kappa}: {error:e}");
            let kappa = f64::from(*kappa as f32);
            let (got, want) = (narrow.run(&[vec![kappa]]), wide.run(&[vec![kappa]]));
            assert!(largest(&got, &want) <= bound, "{text}, kappa {kappa}: {got:?}, {want:?}");
        }
    }
}

/// Sharpnesses of every size, five a doubling and some next to the limits where the ways change, against the integrals.
#[test]
fn both_ways_to_a_gaussian_hold_their_promises_up_to_their_limits() {
    for order in [2, 3, 6, 10, 11, 13, 16] {
        let exact = Gaussian::exact(order);
        let near = |limit: i64| [1.0 - 1e-7, 1.0, 1.0 + 1e-6, 1.05].map(|factor| limit as f64 * factor);
        let all = (-85..85).map(|k| 2f64.powf(f64::from(k) / 5.0)).chain([0.0]).chain(near(exact.limit));
        let text = format!("gaussian:{order}");
        let (wide, narrow, bound) = (wide(&text), narrow(&text), promised(&text));
        let (mut worst, mut worst_narrow) = (0.0, 0.0);
        for kappa in all {
            let kappa = f64::from(kappa as f32);
            let want = gaussian_by_integrals(order, kappa);
            let (got, in_f32) = (wide.run(&[vec![kappa]]), narrow.run(&[vec![kappa]]));
            worst = larger(worst, largest(&got, &want) / want[0]);
            worst_narrow = larger(worst_narrow, largest(&in_f32, &got));
        }
        println!("{text}: {worst:.1e} in f64, {worst_narrow:.1e} in f32, promised {bound:.1e}");
        assert!(worst <= 1e-13, "{text}: {worst:e}");
        assert!(worst_narrow <= bound, "{text}: {worst_narrow:e} above {bound:e}");
    }
}

/// 2π K_l ∫ e^(−κu) P_l(1 − u) du over panels that halve towards the axis.
fn gaussian_by_integrals(order: usize, kappa: f64) -> Vec<f64> {
    let mut sums = vec![0.0; order];
    let ends: Vec<f64> = (0..40).map(|k| 2.0 * 0.5f64.powi(k)).chain([0.0]).collect();
    for pair in ends.windows(2) {
        for (short, weight) in gauss_legendre(24, pair[1], pair[0]) {
            let value = weight * f64::exp(-kappa * short);
            for (l, (sum, legendre)) in sums.iter_mut().zip(legendre(order, 1.0 - short)).enumerate() {
                *sum += PI.sqrt() * ((2 * l + 1) as f64).sqrt() * value * legendre;
            }
        }
    }
    sums
}

/// The Legendre polynomials below an order, by their recurrence.
fn legendre(order: usize, x: f64) -> Vec<f64> {
    let mut all = vec![1.0, x];
    for l in 1..order {
        let n = l as f64;
        all.push(((2.0 * n + 1.0) * x * all[l] - n * all[l - 1]) / (n + 1.0));
    }
    all.truncate(order);
    all
}

/// A radiance by the direction of its axis: so many nodes in a cap about it, in frames that share no formula with the kernels.
fn projected(order: usize, dir: &[f64], height: f64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let (basis, frame) = (wide(&format!("basis:{order}")), frame_of(dir));
    let mut sums = vec![0.0; order * order];
    let ends: Vec<f64> = (0..30).map(|k| height * 0.5f64.powi(k)).chain([0.0]).collect();
    for pair in ends.windows(2) {
        for (short, weight) in gauss_legendre(12, pair[1], pair[0]) {
            let (cos, sin) = (1.0 - short, (short * (2.0 - short)).sqrt());
            for j in 0..2 * order {
                let phi = PI * (j as f64 + 0.5) / order as f64;
                let local = [sin * phi.cos(), sin * phi.sin(), cos];
                let place: Vec<f64> = (0..3).map(|i| (0..3).map(|k| frame[k][i] * local[k]).sum()).collect();
                let y = basis.run(&[place]);
                let value = value(short) * weight * PI / order as f64;
                sums.iter_mut().zip(y).for_each(|(sum, y)| *sum += value * y);
            }
        }
    }
    sums
}

/// A way to a light: its kernel, its parameters but for the direction, its reach, its radiance at one less the cosine.
type Light = (&'static str, Vec<f64>, f64, fn(f64, f64) -> f64);

fn lights() -> Vec<Light> {
    let cap_height = |s: f64| s / (1.0 + (1.0 - s).sqrt());
    let mut all: Vec<Light> = Vec::new();
    for s in [1e-12, 1e-4, 0.3, 0.999, 1.0] {
        all.push(("light_sphere", vec![s], cap_height(s), |_, _| 1.0));
    }
    // Inside of the sphere.
    all.push(("light_sphere", vec![7.0], 1.0, |_, _| 1.0));
    for cos in [1.0 - 1e-6, 0.5, 0.0, -0.4, -1.0] {
        all.push(("light_cone", vec![cos], 1.0 - cos, |_, _| 1.0));
    }
    for kappa in [1e-5, 0.7, 9.9, 10.1, 300.0, 1e5] {
        all.push(("light_gaussian", vec![kappa], 2.0, |kappa, short| f64::exp(-kappa * short)));
    }
    all
}

/// Every light is the integral of its radiance times the harmonics, added to what was there; 1e-13 of the largest number is
/// what a thousand nodes round off.
#[test]
fn lights_are_the_integrals_of_their_radiance() {
    let mut random = Random::new(12);
    for order in [2, 3, 5, 8] {
        for (name, parameters, height, value) in lights() {
            let (kernel, dir) = (wide(&format!("{name}:{order}")), random.unit::<3>().to_vec());
            let (light, c) = (1.0 + random.signed(), (0..order * order).map(|_| random.signed()).collect::<Vec<f64>>());
            let want = projected(order, &dir, height, |short| value(parameters[0], short));
            let got = kernel.run(&[dir.clone(), parameters.clone(), vec![light], c.clone()]);
            let added: Vec<f64> = got.iter().zip(&c).map(|(a, b)| a - b).collect();
            let want: Vec<f64> = want.iter().map(|x| x * light).collect();
            let error = largest(&added, &want);
            assert!(error <= 1e-13 * (1.0 + norm(&want)), "{name}:{order} {parameters:?}: {error:e}");
            // Alone, a light is exact relative to itself, however small it is.
            let alone = kernel.run(&[dir, parameters.clone(), vec![light], vec![0.0; order * order]]);
            let error = difference(&alone, &want) / norm(&want);
            assert!(error <= 1e-13, "{name}:{order} {parameters:?} alone: {error:e}");
        }
        let (kernel, dir) = (wide(&format!("light_hemisphere:{order}")), random.unit::<3>().to_vec());
        let [top, bottom] = [0.8, 0.3];
        let want = projected(order, &dir, 2.0, |short| top + (bottom - top) * short / 2.0);
        let got = kernel.run(&[dir, vec![top], vec![bottom], vec![0.0; order * order]]);
        assert!(largest(&got, &want) <= 1e-13, "light_hemisphere:{order}: {got:?}, {want:?}");
    }
}

/// A directional light is the limit of a cap whose radiance times solid angle is its irradiance.
#[test]
fn a_directional_light_is_the_smallest_of_caps() {
    let mut random = Random::new(3);
    for order in ORDERS {
        let dir = random.unit::<3>().to_vec();
        let (light, zero) = (vec![2.0], vec![0.0; order * order]);
        let directional = wide(&format!("light_directional:{order}"));
        let want = directional.run(&[dir.clone(), light, zero.clone()]);
        let s = 1e-16;
        let got = wide(&format!("light_sphere:{order}")).run(&[dir, vec![s], vec![2.0 / (PI * s)], zero]);
        // A cap's band l is short of it by l(l+1) s / 8.
        assert!(largest(&got, &want) <= 1e-13, "order {order}: {got:?}, {want:?}");
    }
}

/// f32 errs by no more than heads promise, on other inputs than those it was measured by.
#[test]
fn what_heads_promise_of_lights_holds() {
    let names =
        ["cap", "gaussian", "gaussian:f32", "phong", "henyey_greenstein", "convolve", "convolve_cosine", "irradiance"];
    let lights = ["light_directional", "light_sphere", "light_cone", "light_hemisphere", "light_gaussian"];
    let found = ["dominant", "light_fit", "light_fit_along"];
    for order in [2, 3, 4, 5, 6, 10] {
        for name in names.into_iter().chain(lights).chain(found) {
            let (family, method) = name.split_once(':').map_or((name, String::new()), |(a, b)| (a, format!(":{b}")));
            let text = format!("{family}:{order}{method}");
            let spec = spec(&text);
            let (wide, narrow, bound) = (Runner::<f64>::new(&spec), Runner::<f32>::new(&spec), promised(&text));
            let mut worst = 0.0;
            for input in inputs(spec.code().params(), 9, 3000, None) {
                let (got, want) = (narrow.run(&input), wide.run(&input));
                worst = larger(worst, spec.family.measure.error(&got, &want, order));
            }
            assert!(worst <= bound, "{text}: {worst:e} above {bound:e}");
        }
    }
}

/// No more than the best known, choices of the clamp counted: 7, 9, 11 and 14 operations at orders 3 to 6.
#[test]
fn a_cap_costs_no_more_than_the_best_known() {
    let costs: Vec<_> = (3..=6).map(|order| Listing::new(&spec(&format!("cap:{order}")).kernel()).cost(1)).collect();
    let totals: Vec<usize> = costs.iter().map(|cost| cost.total).collect();
    println!("cap from order 3: {totals:?}");
    assert!(totals.iter().zip([7, 9, 11, 14]).all(|(got, most)| *got <= most), "{totals:?}");
    assert!(costs.iter().all(|cost| cost.special <= 2));
}

/// What is not a number spreads to all that it is in; zeros stay zeros; infinitely sharp, large or near is no fault.
#[test]
fn the_ends_of_what_lights_take() {
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    for order in [2, 3, 6, 10] {
        for name in ["cap", "gaussian", "phong"] {
            let text = format!("{name}:{order}");
            assert!(wide(&text).run(&[vec![nan]]).iter().all(|x| x.is_nan()), "{text} in f64");
            assert!(narrow(&text).run(&[vec![nan]]).iter().all(|x| x.is_nan()), "{text} in f32");
        }
        let cap = wide(&format!("cap:{order}"));
        assert!(cap.run(&[vec![0.0]]).iter().all(|&x| x == 0.0));
        for s in [1.0, 2.0, 1e300, infinity] {
            assert_eq!(cap.run(&[vec![s]]), cap.run(&[vec![1.0]]), "a sphere about the point is a hemisphere");
        }
        let gaussian = narrow(&format!("gaussian:{order}"));
        let flat = gaussian.run(&[vec![0.0]]);
        assert!((flat[0] / (4.0 * PI).sqrt() - 1.0).abs() <= 1e-7 && flat[1..].iter().all(|&x| x == 0.0), "{flat:?}");
        for kappa in [1e5, 1e30, infinity] {
            let sharp = gaussian.run(&[vec![kappa]]);
            // All of its energy, 2π / κ, lies in one direction.
            let want = |l: usize| 2.0 * PI / kappa * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
            assert!(sharp.iter().enumerate().all(|(l, x)| (x - want(l)).abs() <= 1e-3 * want(l)), "{sharp:?}");
        }
        let zero = vec![0.0; order * order];
        let dir = vec![0.0, 0.6, -0.8];
        for (name, parameter) in [("light_sphere", 0.5), ("light_cone", 0.5), ("light_gaussian", 3.0)] {
            let kernel = narrow(&format!("{name}:{order}"));
            let run = |parameter: f64, light: f64, c: &[f64]| {
                kernel.run(&[dir.clone(), vec![parameter], vec![light], c.to_vec()])
            };
            assert!(run(parameter, 0.0, &zero).iter().all(|&x| x == 0.0), "{name} of no light");
            assert!(run(parameter, nan, &zero).iter().all(|x| x.is_nan()), "{name} of no number");
            let mut spoilt = zero.clone();
            spoilt[2] = nan;
            let (clean, got) = (run(parameter, 1.0, &zero), run(parameter, 1.0, &spoilt));
            assert!((0..got.len()).all(|i| if i == 2 { got[i].is_nan() } else { got[i] == clean[i] }), "{name}");
        }
    }
}

/// The direction in which the irradiance of the bands 0 and 1 is largest, of any size of coefficients; z of nothing.
#[test]
fn the_dominant_direction_is_where_linear_irradiance_is_largest() {
    let mut random = Random::new(8);
    for order in [2, 3, 6] {
        let (wide, narrow) = (wide(&format!("dominant:{order}")), narrow(&format!("dominant:{order}")));
        let linear = |c: &[f64], d: &[f64]| {
            PI * c[0] / (4.0 * PI).sqrt() + 2.0 * PI / 3.0 * (3.0 / (4.0 * PI)).sqrt() * dot(&[-c[3], -c[1], c[2]], d)
        };
        for _ in 0..20 {
            let c: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
            let found = wide.run(std::slice::from_ref(&c));
            assert!((norm(&found) - 1.0).abs() <= 1e-15);
            let most = linear(&c, &found);
            assert!((0..500).all(|_| linear(&c, &random.unit::<3>()) <= most));
            for exponent in [-60, -30, 30, 60] {
                let scaled: Vec<f64> = c.iter().map(|x| x * 2f64.powi(exponent)).collect();
                assert!(largest(&narrow.run(&[scaled]), &found) <= 5e-7, "2^{exponent}");
            }
        }
        for runner in [wide.run(&[vec![0.0; order * order]]), narrow.run(&[vec![0.0; order * order]])] {
            assert_eq!(runner, [0.0, 0.0, 1.0]);
        }
        // Its square is below the smallest normal number.
        let mut tiny = vec![0.0; order * order];
        tiny[3] = 1e-20;
        assert_eq!(narrow.run(&[tiny]), [0.0, 0.0, 1.0]);
    }
    let fit = wide("light_fit:3");
    assert_eq!(fit.run(&[vec![0.0; 9]]), [0.0, 0.0, 1.0, 0.0, 0.0]);
}

/// The least squares over the sphere of normals, of the irradiance of a light and of an ambient against that of the signal.
#[test]
fn the_fitted_light_and_ambient_are_nearest_in_irradiance() {
    let mut random = Random::new(21);
    for order in [2, 3, 4, 5, 6] {
        let fit = wide(&format!("light_fit:{order}"));
        let along = wide(&format!("light_fit_along:{order}"));
        let (convolve, basis) = (wide(&format!("convolve_cosine:{order}")), wide(&format!("basis:{order}")));
        let c: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
        let [x, y, z, light, ambient] = fit.run(std::slice::from_ref(&c))[..] else { panic!("five numbers") };
        let of_light = convolve.run(&[basis.run(&[vec![x, y, z]])]);
        let of_signal = convolve.run(std::slice::from_ref(&c));
        let mut normal = [[0.0; 3]; 2];
        for node in Sphere::new(order).nodes() {
            let harmonics = basis.run(&[node.0.to_vec()]);
            let functions = [dot(&of_light, &harmonics), PI];
            let signal = dot(&of_signal, &harmonics);
            for (row, f) in normal.iter_mut().zip(functions) {
                (0..2).for_each(|column| row[column] += node.1 * f * functions[column]);
                row[2] += node.1 * f * signal;
            }
        }
        let [[a, b, p], [_, d, q]] = normal;
        let determinant = a * d - b * b;
        let want = [(p * d - b * q) / determinant, (a * q - b * p) / determinant];
        assert!(largest(&[light, ambient], &want) <= 1e-13, "order {order}: {light}, {ambient}, not {want:?}");
        let again = along.run(&[vec![x, y, z], c]);
        assert!(largest(&again, &want) <= 1e-13, "order {order} along: {again:?}, not {want:?}");
    }
}

/// Irradiance is the integral over the hemisphere, and the cosine's factors are what the library of maps has.
#[test]
fn irradiance_is_the_integral_over_the_hemisphere() {
    let mut random = Random::new(30);
    for order in ORDERS {
        let (irradiance, eval) = (wide(&format!("irradiance:{order}")), wide(&format!("eval:{order}")));
        let convolve = wide(&format!("convolve_cosine:{order}"));
        let c: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
        let dir = random.unit::<3>().to_vec();
        let lobe = projected(order, &dir, 1.0, |short| 1.0 - short);
        let want = dot(&lobe, &c);
        let got =
            [irradiance.run(&[dir.clone(), c.clone()])[0], eval.run(&[dir, convolve.run(std::slice::from_ref(&c))])[0]];
        assert!(got.iter().all(|got| (got - want).abs() <= 1e-13 * norm(&c)), "order {order}: {got:?}, not {want}");
    }
    for l in 0..12 {
        let want = zonal_codegen::environment::cosine_lobe(l);
        assert!((cosine_lobe(l).to_f64() - want).abs() <= 1e-15, "band {l}");
    }
}

/// Convolution with a function is the projection of its product with the turned function, for all directions at once.
#[test]
fn convolution_is_an_integral_at_every_direction() {
    let mut random = Random::new(31);
    for order in [2, 3, 5, 8] {
        let (convolve, gaussian) = (wide(&format!("convolve:{order}")), wide(&format!("gaussian:{order}")));
        let eval = wide(&format!("eval:{order}"));
        let c: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
        let dir = random.unit::<3>().to_vec();
        let kappa = 4.0;
        let want = dot(&projected(order, &dir, 2.0, |short| f64::exp(-kappa * short)), &c);
        let convolved = convolve.run(&[gaussian.run(&[vec![kappa]]), c.clone()]);
        let got = eval.run(&[dir, convolved])[0];
        assert!((got - want).abs() <= 1e-13 * norm(&c), "order {order}: {got}, not {want}");
    }
}

/// A list of inputs may name what a light's kernel is called with in other libraries, and no intensity: it is one then.
#[test]
fn vectors_take_lights_without_their_intensity() {
    let folder = std::env::temp_dir().join(format!("zonal-lights-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let file = folder.join("inputs.json");
    let zeros = ["0"; 9].join(", ");
    std::fs::write(&file, format!("[{{\"dir\": [0, 0.6, 0.8], \"s\": 0.25, \"c\": [{zeros}]}}]")).expect("writable");
    for (text, channels) in [("light_sphere:3", 1), ("light_sphere:3:rgb", 3)] {
        let output = command().args(["vectors", text, "--inputs"]).arg(&file).output().expect("the command starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["parameters"][2]["usual"], 1.0, "{value}");
        let want = wide("light_sphere:3").run(&[vec![0.0, 0.6, 0.8], vec![0.25], vec![1.0], vec![0.0; 9]]);
        for (got, want) in value["cases"][0]["f64"].as_array().expect("a list").iter().zip(want) {
            let got = if channels == 1 { vec![got.as_f64().expect("a number")] } else { numbers(got) };
            assert_eq!(got, vec![want; channels], "{text}");
        }
    }
    let without = folder.join("without.json");
    std::fs::write(&without, "[{\"dir\": [0, 0, 1], \"s\": 0.25}]").expect("writable");
    let output = command().args(["vectors", "light_sphere:3", "--inputs"]).arg(&without).output();
    let output = output.expect("the command starts");
    assert!(!output.status.success() && String::from_utf8_lossy(&output.stderr).contains("has no `c`"));
    std::fs::remove_dir_all(&folder).expect("removable");
}

/// Every kernel that lights are made of is listed, with what it costs.
#[test]
fn the_list_has_lights_and_zonal_functions() {
    let output = command().args(["list", "--json", "--order", "3"]).output().expect("the command starts");
    let rows: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let listed: Vec<&str> = rows.as_array().expect("a list").iter().filter_map(|row| row["spec"].as_str()).collect();
    for name in
        ["cap", "gaussian", "phong", "henyey_greenstein", "convolve", "convolve_cosine", "irradiance", "dominant"]
    {
        assert!(listed.contains(&format!("{name}:3").as_str()), "{name}");
    }
    for name in ["directional", "sphere", "cone", "hemisphere", "gaussian", "fit", "fit_along"] {
        assert!(listed.contains(&format!("light_{name}:3").as_str()), "light_{name}");
    }
    assert!(listed.contains(&"gaussian:3:f32") && listed.contains(&"light_gaussian:3:rgb"));
}
