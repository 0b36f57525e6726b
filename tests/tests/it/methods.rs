//! The methods that widen the front: five shears, the tilt on prescaled coefficients, evaluation in monomials, the small
//! rotation from a quaternion, and the rotation that decides between it and the exact one.

use zonal_codegen::families::lifted::LIFTED_DEGREES;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::listing::Cost;
use zonal_codegen::plan::contest::weigh;
use zonal_codegen::plan::{SPECIAL_WEIGHT, price};
use zonal_codegen::promise::accuracy::{band_errors, method_errors};
use zonal_codegen::promise::registers::Registers;
use zonal_codegen::promise::samples::{self, Random};
use zonal_tests::{Runner, band_error, norm, quaternion_of_angles, spec};

/// Runs a kernel of any form in f64.
fn run(text: &str, inputs: &[&[f64]]) -> Vec<f64> {
    spec(text).code().runner::<f64>().run(inputs, Contraction::Separate)
}

fn signal(random: &mut Random, order: usize) -> Vec<f64> {
    (0..order * order).map(|_| random.signed()).collect()
}

#[test]
fn five_shears_follow_their_law_and_the_golden_ratio_is_their_best_split() {
    // The triangles of a frequency k err by e (kβ)³ with e = (7 − 3√5)/24; taking off the best linear part leaves a
    // quarter of that for even bands, as for three shears (docs/MATH.md#five-shears).
    let law = (7.0 - 3.0 * 5f64.sqrt()) / 96.0;
    let beta = 0.02;
    for order in [5usize, 7, 9] {
        let l = (order - 1) as f64;
        let error = method_errors(&spec(&format!("lf5:{order}")), &[beta])[0];
        let ratio = error / (law * (l * beta).powi(3));
        assert!((ratio - 1.0).abs() < 0.03, "lf5:{order}: {ratio} of its law");
    }
    // docs/MATH.md#five-shears: coefficients fitted for each band by search err by so much in band 4 and band 7; ours
    // are closed forms and may err by a quarter more.
    for (order, degrees, fitted) in [(5, 10.0, 1.0e-3), (5, 15.0, 3.6e-3), (8, 10.0, 5.7e-3), (8, 25.0, 0.13)] {
        let error = method_errors(&spec(&format!("tilt:{order}:lf5")), &[f64::to_radians(degrees)])[0];
        let most = if degrees > 20.0 { 1.6 } else { 1.25 };
        assert!(error < most * fitted, "tilt:{order}:lf5 at {degrees}: {error:e}, fitted {fitted:e}");
    }
}

#[test]
fn the_tilt_on_prescaled_coefficients_is_the_tilt() {
    let mut random = Random::new(3);
    for (order, method) in [(4, ""), (6, ""), (6, ":lf5"), (10, ""), (10, ":lf5")] {
        let text = |name: &str| format!("{name}:{order}{method}");
        let (tilt, prescaled) = (spec(&text("tilt")), spec(&text("tilt_prescaled")));
        let [scale, unscale] =
            ["tilt_scale", "tilt_unscale"].map(|name| Runner::<f64>::new(&spec(&format!("{name}:{order}"))));
        let inputs = samples::inputs(tilt.code().params(), 7, 40, None);
        let light = signal(&mut random, order);
        for input in &inputs {
            let want = Runner::<f64>::new(&tilt).run(input);
            let stored = scale.run(&input[1..]);
            let tilted = Runner::<f64>::new(&prescaled).run(&[input[0].clone(), stored]);
            // 1e-13: a thousand f64 roundings of values of about one.
            assert!(
                band_error(&unscale.run(std::slice::from_ref(&tilted)), &want) < 1e-13,
                "{}",
                text("tilt_prescaled")
            );
            // A light scaled the other way gives the same product.
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
            let product = dot(&tilted, &unscale.run(std::slice::from_ref(&light)));
            assert!((product - dot(&want, &light)).abs() < 1e-12 * norm(&light) * norm(&want));
        }
    }
}

#[test]
fn prescaled_coefficients_stay_near_the_others() {
    // What f32 and f16 must hold: the factors of the stored data.
    for order in 4..=10 {
        let ones = vec![1.0; order * order];
        for name in ["tilt_scale", "tilt_unscale"] {
            let factors = Runner::<f64>::new(&spec(&format!("{name}:{order}"))).run(std::slice::from_ref(&ones));
            let largest = factors.iter().fold(0.0f64, |most, x| most.max(*x));
            assert!(factors.iter().all(|x| *x > 0.0) && largest < 40.0, "{name}:{order}: {largest}");
        }
    }
}

#[test]
fn monomials_evaluate_to_what_harmonics_do() {
    let mut random = Random::new(11);
    for order in 2..=10 {
        let harmonics = Runner::<f64>::new(&spec(&format!("eval:{order}")));
        let [turn, eval] = ["to_monomial", "eval_monomial"].map(|name| spec(&format!("{name}:{order}")));
        let (turn, narrow) = (Runner::<f64>::new(&turn), Runner::<f32>::new(&eval));
        let eval = Runner::<f64>::new(&eval);
        let (mut worst, mut worst_narrow) = (0.0f64, 0.0f64);
        for i in 0..500 {
            let dir = match i {
                0 => vec![0.0, 0.0, 1.0],
                1 => vec![0.0, 0.0, -1.0],
                2 => vec![1.0, 0.0, 0.0],
                _ => random.unit::<3>().to_vec(),
            };
            let c = signal(&mut random, order);
            let want = harmonics.run(&[dir.clone(), c.clone()])[0];
            let stored = turn.run(std::slice::from_ref(&c));
            // The sup norm of a sum of harmonics is at most |c| √(n²/4π).
            let size = norm(&c) * order as f64 / (4.0 * std::f64::consts::PI).sqrt();
            worst = worst.max((eval.run(&[dir.clone(), stored.clone()])[0] - want).abs() / size);
            let exact: Vec<f64> = dir.iter().map(|x| f64::from(*x as f32)).collect();
            let want = harmonics.run(&[exact.clone(), c])[0];
            worst_narrow = worst_narrow.max((narrow.run(&[exact, stored])[0] - want).abs() / size);
        }
        println!("order {order}: f64 {worst:e}, f32 {worst_narrow:e}");
        assert!(worst < 1e-13, "order {order}: {worst:e}");
        // docs/MATH.md#evaluation-at-the-floor: of the largest value, of which a bound is taken here; beyond order 8 other
        // monomials take 3e-6 (docs/MATH.md#monomials).
        let most = [1.6e-7, 2.1e-7, 3.4e-7, 5.7e-7, 9.1e-7, 1.5e-6, 4.2e-6].get(order - 2).copied().unwrap_or(3e-6);
        assert!(worst_narrow < most, "order {order}: {worst_narrow:e}");
    }
}

#[test]
fn the_monomial_form_costs_one_operation_a_coefficient() {
    for (order, scalar) in (2..).zip([3, 8, 15, 24, 35, 48, 63]) {
        let cost = |text: String, channels: usize| spec(&text).code().cost(channels).total;
        for axis in ["", ":x", ":y"] {
            let text = format!("eval_monomial:{order}{axis}");
            assert_eq!([cost(text.clone(), 1), cost(format!("{text}:rgb"), 3)], [scalar, 3 * scalar], "{text}");
        }
    }
    for order in 9..=10 {
        let cost = spec(&format!("eval_monomial:{order}:rgb")).code().cost(3).total;
        assert_eq!(cost, 3 * (order * order - 1) + 4 * (order - 2), "the floor for free coefficients and the powers");
    }
}

#[test]
fn prescaling_pays_from_order_4_on() {
    for (order, most) in [(4, 77), (5, 127), (6, 191), (8, 349), (10, 557)] {
        let cost = |text: String| spec(&text).code().cost(1).total;
        let prescaled = cost(format!("tilt_prescaled:{order}"));
        assert!(prescaled <= most && prescaled < cost(format!("tilt:{order}")), "order {order}: {prescaled}");
    }
}

#[test]
fn the_small_rotation_errs_by_what_its_method_says() {
    let mut random = Random::new(5);
    for text in ["rotate_small:5", "rotate_small:8", "rotate_small:8:lf5", "rotate_small:6:exact+lf3+lf3+lf5+lf5"] {
        let spec = spec(text);
        let exact = format!("rotate:{}:zyz", spec.order);
        for degrees in [1e-6, 1.0, 10.0, 25.0] {
            let beta = f64::to_radians(degrees);
            let q = quaternion_of_angles(random.signed() * 3.0, beta, random.signed() * 3.0);
            let c = signal(&mut random, spec.order);
            let (got, want) = (run(text, &[&q, &c]), run(&exact, &[&q, &c]));
            for (l, &most) in band_errors(&spec, &[beta])[0].iter().enumerate() {
                let band = l * l..(l + 1) * (l + 1);
                let error: Vec<f64> = got[band.clone()].iter().zip(&want[band.clone()]).map(|(a, b)| a - b).collect();
                // 1e-13: f64 rounding.
                assert!(norm(&error) <= (most * (1.0 + 1e-9) + 1e-13) * norm(&c[band]), "{text}, band {l}, {degrees}");
            }
        }
    }
}

#[test]
fn the_adaptive_rotation_takes_one_of_two_ways() {
    let mut random = Random::new(17);
    for order in [4, 6, 9] {
        let texts = ["rotate_adaptive", "rotate_small", "rotate"].map(|name| format!("{name}:{order}"));
        let [adaptive, small, exact] = texts.each_ref().map(|text| text.as_str());
        for i in 0..60 {
            let limit = random.signed().abs() * 0.2;
            let largest = 2.0 * f64::asin(limit);
            // Angles on both sides of the limit, and next to it.
            let beta = match i {
                0 => 0.0,
                1 => std::f64::consts::PI,
                2 => largest * (1.0 - 1e-9),
                3 => largest * (1.0 + 1e-9),
                _ => largest * 2.0 * random.signed().abs(),
            };
            let q = quaternion_of_angles(random.signed() * 3.0, beta, random.signed() * 3.0);
            let c = signal(&mut random, order);
            let want = if beta <= largest { small } else { exact };
            let same = run(adaptive, &[&q, &[limit], &c]) == run(want, &[&q, &c]);
            assert!(same, "{adaptive}, limit {limit}, angle {beta}: not {want}");
        }
        // NaN is above every limit.
        assert!(run(adaptive, &[&[f64::NAN; 4], &[0.1], &vec![1.0; order * order]])[1].is_nan());
    }
}

/// Křivánek et al. 2005, appendix B: a cache record may be used at the distance r from it, in the frame turned by b,
/// while (2r/R) sin(b/2) + √(1 − cos b) is at most a; the exact inverse is in docs/MATH.md#the-adaptive-rotation.
#[test]
fn the_limit_is_the_exact_inverse_of_the_caching_error() {
    for a in [0.05, 0.2, 0.368, 0.6, 1.0] {
        for ratio in [0.0, 0.1, 0.3, 1.0] {
            let half_sine: f64 = a / (2f64.sqrt() + 2.0 * ratio);
            let b = 2.0 * half_sine.asin();
            let error = 2.0 * ratio * (b / 2.0).sin() + (1.0 - b.cos()).sqrt();
            assert!((error - a).abs() < 1e-12, "a {a}, r/R {ratio}: {error}");
        }
        // 1.25 a is only safe up to a = 0.368.
        let exact: f64 = 2.0 * f64::asin(a / (2f64.sqrt() + 0.2));
        assert_eq!(1.25 * a <= exact, a > 0.368 + 1e-3, "a {a}");
    }
}

/// Not on the front, and so no kernel: what minimax polynomials in the generator and four shears would give
/// (docs/MATH.md#three-shears). Their errors are those of 2 × 2 matrices, as the laws are.
#[test]
fn what_is_not_on_the_front_is_left_out() {
    use zonal_codegen::families::SmallAngle;
    use zonal_codegen::families::family::AngleAs;
    use zonal_codegen::promise::law::error;
    // Four shears of (1 − ½√2, ½√2, ½√2, 1 − ½√2) T, the linear part of the cubic error taken off: 4/3 of LF3's shears.
    let root = 0.5f64.sqrt();
    let four = |l: usize, beta: f64| -> f64 {
        let p = if l.is_multiple_of(2) { (l * l) as f64 / 8.0 } else { (3 * l * l + 1) as f64 / 24.0 };
        let t = beta * (1.0 - 6.0 * (root / 2.0 - 1.0 / 3.0) * p * beta * beta);
        (1..=l)
            .map(|k| {
                let x = k as f64;
                let mut m = [[1.0, 0.0], [0.0, 1.0]];
                for (parity, share) in [(0, 1.0 - root), (1, root), (0, root), (1, 1.0 - root)] {
                    let f = x * share * t;
                    let [a, b] = m;
                    m = match parity {
                        0 => [[a[0] + f * b[0], a[1] + f * b[1]], b],
                        _ => [a, [b[0] - f * a[0], b[1] - f * a[1]]],
                    };
                }
                let (sin, cos) = (x * beta).sin_cos();
                let d: [f64; 4] = [m[0][0] - cos, m[0][1] - sin, m[1][0] + sin, m[1][1] - cos];
                d.iter().map(|x| x * x).sum::<f64>().sqrt() / 2f64.sqrt()
            })
            .fold(0.0, f64::max)
    };
    for (l, degrees) in [(4, 15.0), (6, 10.0), (8, 10.0)] {
        let beta = f64::to_radians(degrees);
        let (three, five) =
            (error(SmallAngle::Lf3, AngleAs::Angle, l, beta).max, error(SmallAngle::Lf5, AngleAs::Angle, l, beta).max);
        // A third more operations than three shears for hardly less error, where two thirds more give five to twelve times less.
        assert!(
            four(l, beta) > 0.4 * three && five < 0.2 * three,
            "l {l}: {} between {three} and {five}",
            four(l, beta)
        );
    }
    // The best quadratic in A has the error of T₃ on [−lβ, lβ] at least: (lβ)³/24, LF3's own, for 36 operations at l = 4
    // where LF3 takes 33 and keeps the determinant.
    let cost = |text: &str| spec(text).code().cost(1).total;
    let band = |text: &str| cost(&format!("{text}:5")) - cost(&format!("{text}:4"));
    println!("operations of band 4: lf3 {}, lf5 {}, taylor2 {}", band("lf3"), band("lf5"), band("taylor2"));
    assert!(band("lf3") < band("taylor2"), "a quadratic costs what Taylor 2 does");
}

/// What rotates by z, y, z with a set-up of its own: by planes, or lifted.
const SHARED: [&str; 2] = ["angles", "lifted"];

/// The pair's set-up and rotation, in `T`.
fn prepared<T: Number>(method: &str, order: usize, q: &[f64], c: &[f64]) -> Vec<f64> {
    let run = |text: String, inputs: &[&[f64]]| -> Vec<f64> {
        let rounded: Vec<Vec<T>> = inputs.iter().map(|list| list.iter().map(|&x| T::from_f64(x)).collect()).collect();
        let rounded: Vec<&[T]> = rounded.iter().map(Vec::as_slice).collect();
        let got = spec(&text).code().runner::<T>().run(&rounded, Contraction::Separate);
        got.into_iter().map(Number::to_f64).collect()
    };
    let made = run(format!("{method}:{order}"), &[q]);
    run(format!("rotate:{order}:{method}"), &[&made, c])
}

#[test]
fn the_lifted_rotation_is_the_exact_one_in_its_whole_domain() {
    let mut random = Random::new(31);
    for order in 3..=10 {
        let most = spec(&format!("lifted:{order}")).max_angle().expect("the domain is bounded");
        for fraction in [0.0, 1e-30, 1e-16, 1e-8, 1e-4, 0.1, 0.5, 0.9, 0.999, 1.0] {
            let q = quaternion_of_angles(random.signed() * 3.2, most * fraction, random.signed() * 3.2);
            let c = signal(&mut random, order);
            let want = run(&format!("rotate:{order}:zyz"), &[&q, &c]);
            let error = band_error(&prepared::<f64>("lifted", order, &q, &c), &want);
            assert!(error < 1e-13, "order {order} at {fraction} of its domain: {error:e}");
        }
        let c = signal(&mut random, order);
        let same = prepared::<f64>("lifted", order, &[0.0, 0.0, 0.0, 1.0], &c);
        assert!(band_error(&same, &c) < 1e-14, "order {order}: the identity");
        // What is no number in one band stays there.
        for l in 0..order {
            let mut spoilt = c.clone();
            spoilt[l * l] = f64::NAN;
            let got = prepared::<f64>("lifted", order, &[0.0, 0.1 * most, 0.0, 1.0], &spoilt);
            assert!(
                (0..order * order).filter(|i| i.isqrt() != l).all(|i| got[i].is_finite()),
                "order {order}, band {l}"
            );
        }
    }
}

/// Why the domain ends where the largest tangent is √3: up to there f32 errs by hardly more than twice what planes
/// do at worst, half of the way as they do; beyond, it errs without bound.
#[test]
fn the_lifted_domain_ends_where_its_tangents_begin_to_cost() {
    for order in [4, 5, 7, 9] {
        let worst = |method: &str, degrees: f64| {
            let mut random = Random::new(8);
            let errors = (0..200).map(|_| {
                let beta = f64::to_radians(degrees) / (order - 1) as f64;
                let q = quaternion_of_angles(random.signed() * 3.2, beta, random.signed() * 3.2);
                let q: Vec<f64> = q.iter().map(|x| f64::from(*x as f32)).collect();
                let c: Vec<f64> = signal(&mut random, order).iter().map(|x| f64::from(*x as f32)).collect();
                band_error(&prepared::<f32>(method, order, &q, &c), &run(&format!("rotate:{order}:zyz"), &[&q, &c]))
            });
            errors.fold(0.0, f64::max)
        };
        let planes = worst("angles", LIFTED_DEGREES);
        let [inside, edge, beyond, far] = [60.0, LIFTED_DEGREES, 150.0, 175.0].map(|degrees| worst("lifted", degrees));
        println!(
            "order {order}: planes {planes:.1e}; lifted {inside:.1e} at 60, {edge:.1e} at 120, {beyond:.1e}, {far:.1e}"
        );
        assert!(
            inside < 1.5 * planes && edge < 2.5 * planes && beyond > 1.2 * edge && far > 5.0 * edge,
            "order {order}"
        );
    }
}

/// The ledger: what a rotation costs with all given, and what its set-up does.
#[test]
fn the_lifted_rotation_has_the_fewest_operations_with_its_set_up_given() {
    let cost = |text: String| spec(&text).code().cost(1);
    let mut rows = Vec::new();
    for n in 3..=10usize {
        let (planes, lifted) = (cost(format!("rotate:{n}:angles")), cost(format!("rotate:{n}:lifted")));
        let (angles, shears) = (cost(format!("angles:{n}")), cost(format!("lifted:{n}")));
        let z = 4 * n * (n - 1);
        // Three shears of n (n² − 1) / 6 couplings, each one multiply-add, and no constant.
        assert_eq!(lifted.total - z, n * (n * n - 1) / 2, "order {n}");
        assert_eq!((lifted.special, shears.special - 1), (0, n - 2), "order {n}: a reciprocal a frequency from 2");
        let [angles, shears] = [angles, shears].map(|cost| weigh(cost.total, cost.special, 0));
        rows.push([n, planes.total - z, lifted.total - z, angles, shears]);
    }
    println!("order, the y rotation by planes and lifted, the prices of their set-ups: {rows:?}");
    // Planes that are lifted themselves take 12 36 78 147 237 358, n = 3 to 8 (docs/MATH.md#the-lifted-rotation).
    assert_eq!(rows.iter().map(|row| row[1]).collect::<Vec<_>>(), [15, 43, 89, 155, 243, 361, 511, 691]);
    assert_eq!(rows.iter().map(|row| row[2]).collect::<Vec<_>>(), [12, 30, 60, 105, 168, 252, 360, 495]);
    assert_eq!(rows.iter().map(|row| row[4]).collect::<Vec<_>>(), [42, 81, 138, 235, 374, 593, 882, 1311]);
}

/// Where the lifted rotation is on the front of operations: its set-up pays from three to seven signals on, so for RGB up
/// to order 5, by a sixtieth, and for two RGB signals up to order 9. For many signals it saves a sixth; for one it never
/// pays. Registers say otherwise; see [`lifting_costs_registers`].
#[test]
fn lifting_pays_from_a_few_signals_on() {
    let price = |cost: Cost| weigh(cost.total, cost.special, 0);
    let cost = |text: &str, signals: usize| {
        let code = spec(text).code();
        price(code.cost(1)) + (signals - 1) * (price(code.cost(2)) - price(code.cost(1)))
    };
    let all = |n: usize, signals: usize| -> [usize; 3] {
        let pair = |method: &str| {
            price(spec(&format!("{method}:{n}")).code().cost(1)) + cost(&format!("rotate:{n}:{method}"), signals)
        };
        [cost(&format!("rotate:{n}"), signals), pair(SHARED[0]), pair(SHARED[1])]
    };
    let mut pays = Vec::new();
    for n in 3..=10 {
        let first = (1..100).find(|&signals| {
            let [whole, planes, lifted] = all(n, signals);
            lifted < whole.min(planes)
        });
        let [three, many] = [3, 48].map(|signals| all(n, signals));
        println!("order {n}: pays from {first:?} signals; RGB {three:?}, 48 signals {many:?}");
        assert!(n < 4 || many[2] as f64 <= 0.88 * many[1] as f64, "order {n}: {many:?}");
        pays.push(first.expect("pays at last"));
    }
    assert_eq!(pays, [3, 3, 3, 4, 4, 5, 6, 7]);
    // Planes that are lifted one by one save an operation each, a change of basis stays: at RGB a fortieth, and they take
    // a reciprocal, two operations and a pair of numbers a frequency. Not enough for a kernel of its own.
    for n in 4..=10 {
        let planes = 3 * n * (n - 1) / 2;
        let set_up = (n - 1) * (2 + SPECIAL_WEIGHT);
        let saved = planes as f64 - set_up as f64;
        assert!(saved < 0.026 * all(n, 3)[0] as f64, "order {n}: {saved}");
    }
}

/// By the planner's price, which counts the numbers that a rotation is given, two per coefficient and more: each call reads
/// them again, so that one RGB signal never pays and two do up to order 5; beyond, more is held than there are registers.
#[test]
fn lifting_costs_registers() {
    let all = |n: usize, calls: usize| -> [usize; 3] {
        let own = |text: &str| {
            let spec = spec(text);
            let code = spec.code();
            price(&code, spec.channels(), Registers::of(&spec, &code).registers)
        };
        let pair = |method: &str| own(&format!("{method}:{n}")) + calls * own(&format!("rotate:{n}:{method}:rgb"));
        [calls * own(&format!("rotate:{n}:rgb")), pair(SHARED[0]), pair(SHARED[1])]
    };
    let pays = |n: usize| {
        (1..100).find(|&calls| {
            let [whole, planes, lifted] = all(n, calls);
            lifted < whole.min(planes)
        })
    };
    let from: Vec<_> = (3..=10).map(|n| pays(n).unwrap_or_default()).collect();
    println!("RGB signals from which on it pays, orders 3 to 10: {from:?}");
    assert_eq!(from, [2, 2, 2, 0, 0, 0, 0, 0]);
}
