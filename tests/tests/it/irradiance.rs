//! Evaluation at the floor and irradiance, at once and prepared, against golden values; what each costs, and how far f32 errs
//! (docs/MATH.md#evaluation-at-the-floor).

use serde_json::Value;
use std::f64::consts::PI;
use zonal_codegen::families::Spec;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{Runner, golden, norm, numbers, spec};

fn cases() -> Vec<Value> {
    let cases = golden("evaluation")["cases"].as_array().expect("a golden file has cases").clone();
    cases.into_iter().filter(|case| case.get("c").is_some()).collect()
}

fn run(text: &str, inputs: &[Vec<f64>]) -> Vec<f64> {
    Runner::<f64>::new(&spec(text)).run(inputs)
}

/// The kernel's result in f64 and in f32.
fn both(text: &str, inputs: &[Vec<f64>]) -> [f64; 2] {
    let spec = spec(text);
    [Runner::<f64>::new(&spec).run(inputs)[0], Runner::<f32>::new(&spec).run(inputs)[0]]
}

#[test]
fn every_way_meets_the_golden_values() {
    let cases = cases();
    assert_eq!(cases.iter().map(|case| case["n"].as_u64().expect("an order")).collect::<Vec<_>>(), [3, 4, 5, 6]);
    for case in cases {
        let (order, c) = (case["n"].as_u64().expect("an order"), numbers(&case["c"]));
        let (value, irradiance) = (numbers(&case["value"]), numbers(&case["irradiance"]));
        let dirs = case["dirs"].as_array().expect("directions").iter().map(numbers);
        let size = norm(&c) * order as f64;
        for (i, dir) in dirs.enumerate() {
            let check = |text: &str, c: &[f64], want: f64| {
                let [wide, narrow] = both(text, &[dir.clone(), c.to_vec()]);
                // f64 and f32 in the same number of roundings, a few for each operation that matters.
                assert!((wide - want).abs() <= 2e-15 * size, "{text}: {wide}, not {want}");
                assert!((narrow - want).abs() <= 1e-6 * size, "{text} in f32: {narrow}, not {want}");
            };
            check(&format!("eval:{order}"), &c, value[i]);
            for axis in ["", ":x", ":y"] {
                let turned = run(&format!("to_monomial:{order}{axis}"), std::slice::from_ref(&c));
                check(&format!("eval_monomial:{order}{axis}"), &turned, value[i]);
                let prepared = run(&format!("to_irradiance:{order}{axis}"), std::slice::from_ref(&c));
                check(&format!("irradiance_prepared:{order}{axis}"), &prepared, irradiance[i]);
                let prepared = run(&format!("to_irradiance:{order}:over_pi{axis}"), std::slice::from_ref(&c));
                check(&format!("irradiance_prepared:{order}{axis}"), &prepared, irradiance[i] / PI);
            }
            for method in ["", ":nested"] {
                check(&format!("irradiance:{order}{method}"), &c, irradiance[i]);
                check(&format!("irradiance:{order}{method}:over_pi"), &c, irradiance[i] / PI);
            }
            if order == 3 {
                check("eval:3:once", &c, value[i]);
            }
        }
    }
}

/// The counts of docs/MATH.md#evaluation-at-the-floor, as the most that a kernel may take.
#[test]
fn operations_are_those_of_the_derivation() {
    let counts = [
        ("irradiance:2", 5),
        ("irradiance:3", 16),
        ("irradiance:3:rgb", 37),
        ("irradiance:4", 16),
        ("irradiance:4:over_pi", 16),
        ("irradiance_prepared:3", 8),
        ("irradiance_prepared:3:rgb", 24),
        ("irradiance_prepared:4", 8),
        ("to_irradiance:3", 11),
        ("to_irradiance:4", 11),
        ("eval:2:once", 5),
        ("eval:3:once", 16),
    ];
    for (text, most) in counts {
        let spec = spec(text);
        let cost = spec.code().cost(spec.channels());
        assert_eq!((cost.total, cost.special), (most, 0), "{text}");
    }
    for order in 5..=8 {
        let cost = |text: String, channels: usize| spec(&text).code().cost(channels).total;
        let prepared =
            [cost(format!("irradiance_prepared:{order}"), 1), cost(format!("irradiance_prepared:{order}:rgb"), 3)];
        println!("irradiance_prepared:{order}: {prepared:?}");
        assert!(
            prepared[0] < order * order - 1 && prepared[1] < 3 * (order * order - 1),
            "order {order}: {prepared:?}"
        );
    }
    for (order, most) in (2..).zip([4, 11, 24, 48, 91, 156, 251]) {
        let cost = spec(&format!("to_monomial:{order}")).code().cost(1).total;
        assert_eq!(cost, most, "to_monomial:{order}");
    }
}

#[test]
fn order_four_is_order_three() {
    let mut random = Random::new(41);
    let [c, dir] = [(0..16).map(|_| random.signed()).collect(), random.unit::<3>().to_vec()];
    let three: Vec<f64> = c[..9].to_vec();
    assert_eq!(run("to_irradiance:4", std::slice::from_ref(&c)), run("to_irradiance:3", std::slice::from_ref(&three)));
    assert_eq!(run("irradiance:4", &[dir.clone(), c.clone()]), run("irradiance:3", &[dir, three]));
    assert_eq!(spec("irradiance_prepared:4").code().params()[1].shape.len(), 9);
}

/// f32 errs by no more of the largest value than MATH says, random signals and such as fall with the band; from order 7 on
/// the sum over harmonics is the more exact (docs/MATH.md#evaluation-at-the-floor).
#[test]
fn rounding_doubles_with_each_order() {
    let mut random = Random::new(23);
    let bounds = [1.6e-7, 2.1e-7, 3.4e-7, 5.7e-7, 9.1e-7, 1.5e-6, 4.2e-6];
    for (order, bound) in (2..=8).zip(bounds) {
        let texts = [format!("eval_monomial:{order}"), format!("eval:{order}")];
        let [narrow, plain] = texts.each_ref().map(|text| Runner::<f32>::new(&spec(text)));
        let [wide, turn] = [&texts[1], &format!("to_monomial:{order}")].map(|text| Runner::<f64>::new(&spec(text)));
        let mut worst = [0.0f64; 2];
        for signal in 0..12 {
            let falls = |i: usize| if signal % 2 == 0 { 1.0 } else { 1.0 / (1 + i.isqrt()) as f64 };
            let c: Vec<f64> = (0..order * order).map(|i| f64::from((random.signed() * falls(i)) as f32)).collect();
            let stored = turn.run(std::slice::from_ref(&c));
            let (mut most, mut errors) = (0.0f64, [0.0f64; 2]);
            for i in 0..600 {
                let dir = match i {
                    0 => vec![0.0, 0.0, 1.0],
                    1 => vec![0.0, 0.0, -1.0],
                    2 => vec![-1.0, 0.0, 0.0],
                    _ => random.unit::<3>().map(|x| f64::from(x as f32)).to_vec(),
                };
                let want = wide.run(&[dir.clone(), c.clone()])[0];
                most = most.max(want.abs());
                let got = [narrow.run(&[dir.clone(), stored.clone()])[0], plain.run(&[dir, c.clone()])[0]];
                errors = [0, 1].map(|way| errors[way].max((got[way] - want).abs()));
            }
            worst = [0, 1].map(|way| worst[way].max(errors[way] / most));
        }
        println!("order {order}: monomials {:e}, harmonics {:e}, of the largest value", worst[0], worst[1]);
        // The directions' own lengths are off by a rounding too; the table has the worst of 20,000 directions.
        assert!(worst[0] <= 1.5 * bound, "order {order}: {:e}", worst[0]);
        assert!(order < 7 || worst[1] < worst[0], "order {order}: {worst:?}");
    }
}

#[test]
fn what_no_kernel_has_is_refused_and_says_what_to_do() {
    for (text, message, help) in [
        ("irradiance:5:once", "to 4", "leave `once` out"),
        ("eval:4:once", "orders 2 and 3", "leave `once` out"),
        ("to_irradiance:9", "to 8", "convolve_cosine:9"),
        ("eval_monomial:9:y", "powers of x + iy", "leave `y` out"),
        ("to_irradiance:3:x:y", "exclude each other", "leave one out"),
        ("irradiance:3:over_py", "`over_py` is no method of `irradiance`", "did you mean `over_pi`?"),
    ] {
        let error = text.parse::<Spec>().expect_err(text);
        assert!(error.message.contains(message) && error.help.contains(help), "{text}: {error}");
    }
    assert_eq!(spec("to_irradiance:3:y:over_pi").to_string(), "to_irradiance:3:over_pi:y");
    assert_eq!(spec("irradiance:3:rgb").name(), "sh3_irradiance_rgb");
    assert_eq!(spec("irradiance:3:nested:over_pi").name(), "sh3_irradiance_nested_over_pi");
}
