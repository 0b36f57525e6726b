//! Hemispherical harmonics against golden values, quadrature and each other: the basis, sums over it, conversions; at the pole,
//! at the horizon and below it.

use serde_json::Value;
use zonal_codegen::generate::build;
use zonal_codegen::math::hemisphere::{SPHERICAL_ORDER, extension, overlap};
use zonal_codegen::math::index::{band_degree, coefficients, index};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{Runner, band_error, golden, larger, norm, numbers, spec};

/// What C is in f64.
pub(crate) fn entry(l: usize, spherical: usize, m: isize) -> f64 {
    overlap(l, spherical, m).to_f64()
}

fn cases(file: &Value) -> &Vec<Value> {
    file["cases"].as_array().expect("a golden file has cases")
}

fn signal(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..count).map(|_| f64::from(random.signed() as f32)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Directions above the horizon with their weights: exact for products of hemispherical harmonics up to order 10, whose
/// roots in z go away with z = (1 − cos)/2 of the stretched sphere.
pub(crate) fn hemisphere(heights: usize, around: usize) -> Vec<([f64; 3], f64)> {
    let turn = std::f64::consts::TAU / around as f64;
    let ring = |(z, weight): (f64, f64)| {
        let rim = (1.0 - z * z).sqrt();
        (0..around).map(move |i| {
            let (sin, cos) = (turn * (i as f64 + 0.5)).sin_cos();
            ([rim * cos, rim * sin, z], weight * turn)
        })
    };
    gauss_legendre(heights, 0.0, 1.0).flat_map(ring).collect()
}

#[test]
fn the_basis_meets_the_golden_values_at_pole_and_horizon() {
    let file = golden("hsh_hbasis");
    assert_eq!(cases(&file).len(), 19);
    for order in 2..=8 {
        let basis = spec(&format!("hsh_basis:{order}"));
        let (wide, narrow) = (Runner::<f64>::new(&basis), Runner::<f32>::new(&basis));
        let (mut worst, mut worst_wide) = (0.0, 0.0);
        for case in cases(&file) {
            let (direction, want) = (numbers(&case["d"]), numbers(&case["hsh"]));
            let want = &want[..order * order];
            let error = band_error(&wide.run(std::slice::from_ref(&direction)), want);
            worst_wide = larger(worst_wide, error);
            let error = band_error(&narrow.run(&[direction]), want);
            worst = larger(worst, error);
        }
        println!("order {order}: {worst:e} in f32, {worst_wide:e} in f64");
        assert!(worst_wide <= 1e-14, "order {order}: {worst_wide:e} in f64");
        assert!(worst <= 3e-6, "order {order}: {worst:e} in f32, the inputs' own roundings included");
    }
}

/// Of many directions, heights down to 1e-8 on both sides of the hemisphere among them.
#[test]
fn the_basis_errs_in_f32_by_at_most_what_is_asked() {
    let mut random = Random::new(5);
    for order in 2..=10 {
        let basis = spec(&format!("hsh_basis:{order}"));
        let (wide, narrow) = (Runner::<f64>::new(&basis), Runner::<f32>::new(&basis));
        let mut worst = 0.0;
        for i in 0..4000 {
            let [x, y, z] = random.unit::<3>();
            let size = 2f64.powi(-(i % 27));
            let z = match i % 3 {
                0 => z.abs(),
                1 => size * (1.0 + z) / 2.0,
                _ => 1.0 - size * (1.0 + z) / 2.0,
            };
            let (rim, around) = ((1.0 - z * z).max(0.0).sqrt(), x.hypot(y));
            let direction = [x / around * rim, y / around * rim, z].map(|x| f64::from(x as f32)).to_vec();
            let want = wide.run(std::slice::from_ref(&direction));
            worst = larger(worst, band_error(&narrow.run(&[direction]), &want));
        }
        println!("order {order}: {worst:e}");
        assert!(worst <= if order <= 8 { 3e-6 } else { 6e-6 }, "order {order}: {worst:e}");
    }
}

#[test]
fn the_basis_is_orthonormal_over_the_hemisphere() {
    for order in [2, 4, 10] {
        let basis = Runner::<f64>::new(&spec(&format!("hsh_basis:{order}")));
        let count = order * order;
        let mut gram = vec![0.0; count * count];
        // Products of two are polynomials of degree 2n − 2 in z, and of as many waves around.
        for (direction, weight) in hemisphere(order, 2 * order) {
            let h = basis.run(&[direction.to_vec()]);
            for (i, x) in h.iter().enumerate() {
                h.iter().enumerate().for_each(|(j, y)| gram[i * count + j] += weight * x * y);
            }
        }
        let error = gram.iter().enumerate().map(|(i, got)| (got - f64::from(u8::from(i % (count + 1) == 0))).abs());
        let worst = error.fold(0.0, larger);
        println!("order {order}: {worst:e}");
        assert!(worst <= 1e-13, "order {order}: {worst:e}");
    }
}

#[test]
fn below_the_horizon_is_what_the_horizon_has() {
    for order in [2, 3, 6, 10] {
        let [basis, eval] = ["hsh_basis", "hsh_eval"].map(|name| spec(&format!("{name}:{order}")));
        let want: Vec<f64> = coefficients(order)
            .map(|(l, m)| match m {
                0 => (if l % 2 == 0 { 1.0 } else { -1.0 }) * ((2 * l + 1) as f64 / std::f64::consts::TAU).sqrt(),
                _ => 0.0,
            })
            .collect();
        let c = signal(order * order, 3);
        let monomials = Runner::<f64>::new(&spec(&format!("hsh_to_monomial:{order}"))).run(std::slice::from_ref(&c));
        for direction in [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.6, -0.8, -0.0], [0.48, 0.6, -0.64], [0.8, 0.6, 1e-36]] {
            let direction = direction.to_vec();
            let [wide, narrow] = [
                Runner::<f64>::new(&basis).run(std::slice::from_ref(&direction)),
                Runner::<f32>::new(&basis).run(std::slice::from_ref(&direction)),
            ];
            // k is 2e-18 there, and the constants' own f32 rounding is half a unit.
            assert!(band_error(&wide, &want) <= 1e-14, "{direction:?}: {wide:?}");
            assert!(band_error(&narrow, &want) <= 1e-6, "{direction:?}: {narrow:?}");
            let sums = [
                Runner::<f64>::new(&eval).run(&[direction.clone(), c.clone()])[0],
                Runner::<f64>::new(&spec(&format!("hsh_eval_monomial:{order}"))).run(&[direction, monomials.clone()])
                    [0],
            ];
            let size = norm(&c) * norm(&want);
            assert!(sums.iter().all(|sum| (sum - dot(&c, &want)).abs() <= 1e-14 * size), "{sums:?}");
        }
        // What is not a number stays none, wherever it stands.
        for place in 0..3 {
            let mut direction = vec![0.6, 0.0, 0.8];
            direction[place] = f64::NAN;
            assert!(Runner::<f64>::new(&basis).run(&[direction]).iter().any(|x| x.is_nan()), "order {order}");
        }
    }
}

#[test]
fn sums_meet_the_golden_values_and_the_basis() {
    let file = golden("evaluation");
    let hemispherical: Vec<&Value> = cases(&file).iter().filter(|case| case["hsh"].is_array()).collect();
    assert_eq!(hemispherical.len(), 5);
    for case in hemispherical {
        let c = numbers(&case["hsh"]);
        let order = c.len().isqrt();
        let runner = |name: &str| Runner::<f64>::new(&spec(&format!("{name}:{order}")));
        let monomials = runner("hsh_to_monomial").run(std::slice::from_ref(&c));
        let (eval, eval_monomial) = (runner("hsh_eval"), runner("hsh_eval_monomial"));
        for (direction, want) in case["dirs"].as_array().expect("directions").iter().zip(numbers(&case["value"])) {
            let direction = numbers(direction);
            let got = eval.run(&[direction.clone(), c.clone()])[0];
            assert!((got - want).abs() <= 1e-14 * norm(&c), "order {order}: {got} for {want}");
            let got = eval_monomial.run(&[direction, monomials.clone()])[0];
            // Monomials amplify rounding: some bits more from order 6 on.
            let most = 1e-14 * f64::powi(2.0, order as i32 - 4).max(1.0);
            assert!((got - want).abs() <= most * norm(&c), "order {order}: {got} for {want}");
        }
    }
    let directions = hemisphere(16, 24);
    for order in 2..=10 {
        let runner = |name: &str| Runner::<f64>::new(&spec(&format!("{name}:{order}")));
        let narrow = |name: &str| Runner::<f32>::new(&spec(&format!("{name}:{order}")));
        let (basis, eval, [by_monomials, in_f32]) =
            (runner("hsh_basis"), runner("hsh_eval"), [narrow("hsh_eval_monomial"), narrow("hsh_eval")]);
        let (mut worst_monomial, mut worst) = (0.0f64, 0.0f64);
        for seed in 0..4 {
            let c = signal(order * order, seed);
            let monomials = runner("hsh_to_monomial").run(std::slice::from_ref(&c));
            let monomials: Vec<f64> = monomials.iter().map(|x| f64::from(*x as f32)).collect();
            let same = runner("hsh_eval_monomial");
            let (mut sup, mut errors) = (0.0f64, [0.0f64; 2]);
            for (direction, _) in &directions {
                let direction = direction.to_vec();
                let want = dot(&basis.run(std::slice::from_ref(&direction)), &c);
                let got = eval.run(&[direction.clone(), c.clone()])[0];
                assert!((got - want).abs() <= 1e-14 * norm(&c) * order as f64, "order {order}: {got} for {want}");
                sup = sup.max(want.abs());
                // Of the same f32 numbers, which are no unit vector any more.
                let direction: Vec<f64> = direction.iter().map(|x| f64::from(*x as f32)).collect();
                let inputs = [direction.clone(), monomials.clone()];
                errors[0] = errors[0].max((by_monomials.run(&inputs)[0] - same.run(&inputs)[0]).abs());
                let inputs = [direction, c.clone()];
                errors[1] = errors[1].max((in_f32.run(&inputs)[0] - eval.run(&inputs)[0]).abs());
            }
            worst_monomial = worst_monomial.max(errors[0] / sup);
            worst = worst.max(errors[1] / sup);
        }
        println!("order {order}: of the largest value f32 errs by {worst:e}, in monomials by {worst_monomial:e}");
        if order <= 8 {
            assert!(worst_monomial <= 6e-6, "order {order}: {worst_monomial:e}");
        }
    }
}

#[test]
fn conversions_are_c_its_transpose_and_the_best_extension() {
    let file = golden("C");
    let rows: Vec<Vec<f64>> = file["C"].as_array().expect("rows").iter().map(numbers).collect();
    assert_eq!((rows.len(), rows[0].len()), (36, 36));
    for (to, from) in [(2, 2), (3, 3), (3, 5), (6, 6), (4, 6), (5, 2)] {
        let run = |text: &str, list: &[f64]| Runner::<f64>::new(&spec(text)).run(&[list.to_vec()]);
        let (sphere, half) = (signal(from * from, 1), signal(to * to, 2));
        let got = run(&format!("sh_to_hsh:{from}+{to}"), &sphere);
        for (i, got) in got.iter().enumerate() {
            let want = dot(&rows[i], &sphere);
            assert!((got - want).abs() <= 1e-14 * norm(&sphere), "{from}+{to}, {i}: {got} for {want}");
        }
        let got = run(&format!("hsh_to_sh:{to}+{from}"), &half);
        for (i, got) in got.iter().enumerate() {
            let want: f64 = rows.iter().zip(&half).map(|(row, h)| row[i] * h).sum();
            assert!((got - want).abs() <= 1e-14 * norm(&half), "{to}+{from}, {i}: {got} for {want}");
        }
    }
    let cost = |text: &str| build(&[spec(text)])[0].built.code.cost(1).total;
    let non_zeros = ["3", "4+3", "5+3", "7+3"].map(|orders| cost(&format!("sh_to_hsh:{orders}")));
    assert_eq!(non_zeros, [15, 24, 32, 49], "the non-zeros of C");
}

/// E (C S Cᵀ + 1/1000) = S Cᵀ, its defining equation, with C and S in f64.
#[test]
fn the_extension_is_the_best_one() {
    for order in [2, 3, 6, 10] {
        for m in 0..order as isize {
            let bands: Vec<usize> = (m as usize..order).collect();
            let power = |spherical: usize| ((1 + spherical) as f64).powf(-1.6);
            let gram = |a: usize, b: usize| {
                let all = m as usize..SPHERICAL_ORDER;
                let sum: f64 = all.map(|k| entry(a, k, m) * power(k) * entry(b, k, m)).sum();
                if a == b { sum + 1e-3 } else { sum }
            };
            for spherical in m as usize..SPHERICAL_ORDER {
                for &b in &bands {
                    let got: f64 = bands.iter().map(|&a| extension(order, spherical, a, m).to_f64() * gram(a, b)).sum();
                    let want = power(spherical) * entry(b, spherical, m);
                    // E is an inverse of condition up to 1e3.
                    assert!((got - want).abs() <= 1e-12, "order {order}, m {m}: {got} for {want}");
                }
            }
        }
    }
    let c = signal(9, 4);
    let got = Runner::<f64>::new(&spec("hsh_extend:3+7")).run(std::slice::from_ref(&c));
    for (place, got) in got.iter().enumerate() {
        let (spherical, m) = band_degree(place);
        let bands = m.unsigned_abs()..3;
        let want: f64 = bands.map(|l| extension(3, spherical, l, m).to_f64() * c[index(l, m)]).sum();
        assert!((got - want).abs() <= 1e-12 * norm(&c), "{place}: {got} for {want}");
    }
}

#[test]
fn orders_of_a_conversion_are_read_and_refused() {
    for text in ["sh_to_hsh:3", "sh_to_hsh:5+3", "hsh_to_sh:3+5:rgb", "hsh_extend:10+16"] {
        assert_eq!(spec(text).to_string(), text);
    }
    assert_eq!(spec("sh_to_hsh:4+4"), spec("sh_to_hsh:4"));
    assert_eq!(spec("sh_to_hsh:5+3").name(), "sh3_of_order_5_sh_to_hsh");
    for (text, said) in [
        ("sh_to_hsh:17+3", "orders 2 to 16"),
        ("sh_to_hsh:3+0", "orders are 2 to 16"),
        ("sh_to_hsh:3+11", "orders 2 to 10"),
        ("hsh_to_sh:11+12", "orders 2 to 10"),
        ("hsh_to_sh:11", "orders 2 to 10"),
        ("sh_to_hsh:5+", "as in `sh_to_hsh:5+3`"),
        ("hsh_basis:5+3", "orders are 2 to 16"),
    ] {
        let error = text.parse::<zonal_codegen::families::Spec>().expect_err(text).to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}

/// The operations that were known, the choice of z or 1e-36 not counted, as the most that a kernel may cost.
#[test]
fn nothing_on_the_hemisphere_costs_more_than_the_best_known() {
    let costs = |name: &str| -> Vec<_> {
        let specs: Vec<_> = (2..=8).map(|order| spec(&format!("{name}:{order}"))).collect();
        build(&specs).iter().map(|function| function.built.code.cost(1)).collect()
    };
    for (name, most) in
        [("hsh_basis", [7, 17, 31, 47, 69, 94, 125]), ("hsh_eval_monomial", [7, 12, 19, 28, 39, 52, 67])]
    {
        let got = costs(name);
        let totals: Vec<usize> = got.iter().map(|cost| cost.total - cost.choice).collect();
        println!("{name}: {totals:?}, and a choice");
        assert!(totals.iter().zip(most).all(|(got, most)| *got <= most), "{name}: {totals:?} above {most:?}");
        assert!(got.iter().all(|cost| cost.special == 1 && cost.choice == 1), "{name}");
    }
    for (got, plain) in costs("hsh_eval").iter().zip(costs("eval")) {
        assert!(got.total <= plain.total + 5 && got.special == 1, "{got:?} beside {plain:?}");
    }
}
