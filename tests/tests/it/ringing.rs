//! What keeps a signal from ringing, against golden values, dense samples and the cases in which root finding is hard
//! (docs/MATH.md#ringing).

use serde_json::Value;
use zonal_codegen::promise::samples::Random;
use zonal_tests::turns::Sphere;
use zonal_tests::{Runner, golden, norm, numbers, spec};

fn cases() -> Vec<Value> {
    golden("dering")["cases"].as_array().expect("a golden file has cases").clone()
}

fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().expect("a number")
}

fn wide(text: &str) -> Runner<f64> {
    Runner::new(&spec(text))
}

fn narrow(text: &str) -> Runner<f32> {
    Runner::new(&spec(text))
}

#[test]
fn the_minimum_meets_the_golden_values() {
    let cases = cases();
    assert_eq!(cases.len(), 5);
    let (in_f64, in_f32) = (wide("minimum:3"), narrow("minimum:3"));
    for case in &cases {
        let (c, want) = (numbers(&case["irradiance_sh3"]), number(case, "min"));
        let got = in_f64.run(std::slice::from_ref(&c));
        // The value is off by the square of what the direction is off.
        assert!((got[0] - want).abs() < 1e-15 && got[4] <= want && got[4] > want - 1e-13, "{got:?}, {want}");
        let far: Vec<f64> = got[1..4].iter().zip(numbers(&case["argmin"])).map(|(a, b)| a - b).collect();
        assert!(norm(&far) < 1e-13, "{far:?}");
        let got = in_f32.run(&[c]);
        assert!((got[0] - want).abs() < 4e-7 && got[4] <= want && got[4] > want - 3e-6, "{got:?} in f32, {want}");
    }
}

/// Signals of all kinds: random, zonal about z and about others, without a linear or a quadratic part, with a linear part
/// that is orthogonal to the axis of the least eigenvalue or nearly so.
fn signals() -> Vec<Vec<f64>> {
    let (mut random, basis) = (Random::new(77), wide("basis:3"));
    let scale = [1.0, 3.0, 1e-3, 1e-6];
    let mut all = vec![vec![0.0; 9]];
    for i in 0..800 {
        let mut c: Vec<f64> = (0..9).map(|_| random.signed()).collect();
        let bands = [1, i / 8 % 4, i / 32 % 4].map(|at| scale[at]);
        c.iter_mut().enumerate().for_each(|(place, x)| *x *= bands[place.isqrt()]);
        match i % 8 {
            1 => [1, 3, 4, 5, 7, 8].into_iter().for_each(|place| c[place] = 0.0),
            2 => [1, 3].into_iter().for_each(|place| c[place] = 0.0),
            3 => c[1..4].fill(0.0),
            4 => c[4..].fill(0.0),
            5 | 6 => {
                let axis: [f64; 3] = random.unit();
                let [x, y, z] = axis;
                let other: [f64; 3] = random.unit();
                let mut across =
                    [y * other[2] - z * other[1], z * other[0] - x * other[2], x * other[1] - y * other[0]];
                let lean = if i % 8 == 5 { 0.0 } else { 0.1f64.powi((i / 8 % 12) as i32) };
                across.iter_mut().zip(axis).for_each(|(b, a)| *b += lean * a);
                let size = random.signed();
                let y = basis.run(&[axis.to_vec()]);
                (4..9).for_each(|place| c[place] = size * y[place]);
                (c[1], c[2], c[3]) = (-across[1], across[2], -across[0]);
            }
            _ => {}
        }
        all.push(c.into_iter().map(|x| f64::from(x as f32)).collect());
    }
    all
}

/// No sample is below the bound, in f64 and in f32; the direction holds the value, and the value is next to the bound.
#[test]
fn the_bound_is_below_every_value_and_the_direction_holds_the_least() {
    let directions: Vec<Vec<f64>> = {
        let grid = Sphere::new(24);
        grid.nodes().map(|(dir, _)| dir.to_vec()).collect()
    };
    let basis = wide("basis:3");
    let table: Vec<Vec<f64>> = directions.iter().map(|dir| basis.run(std::slice::from_ref(dir))).collect();
    let (in_f64, in_f32, eval) = (wide("minimum:3"), narrow("minimum:3"), wide("eval:3"));
    for c in signals() {
        let sampled = table.iter().map(|y| y.iter().zip(&c).map(|(y, c)| y * c).sum()).fold(f64::INFINITY, f64::min);
        let size = norm(&c);
        // A root that is nearly double is met to 3e-7 in eight steps; f32 rounds some twenty times.
        for (got, close, rounding) in
            [(in_f64.run(std::slice::from_ref(&c)), 3e-7, 1e-14), (in_f32.run(std::slice::from_ref(&c)), 1e-5, 2e-6)]
        {
            let dir = &got[1..4];
            assert!(got.iter().all(|x| x.is_finite()) && (norm(dir) - 1.0).abs() < rounding, "{c:?}: {got:?}");
            assert!(got[4] <= sampled && got[4] <= got[0] + rounding * size, "{c:?}: {got:?}, sampled {sampled}");
            assert!(got[0] - got[4] <= close * size, "{c:?}: the bound is {:e} below", got[0] - got[4]);
            let value = eval.run(&[dir.to_vec(), c.clone()])[0];
            assert!(
                (value - got[0]).abs() <= rounding * size && got[0] <= sampled + close * size,
                "{c:?}: {value}, {got:?}"
            );
        }
    }
}

#[test]
fn fading_takes_just_what_is_negative() {
    let (fade, least) = (wide("lerp_to_dc:3"), wide("minimum:3"));
    for case in &cases() {
        let (c, want) = (numbers(&case["irradiance_sh3"]), number(case, "lerp_scale"));
        let got = fade.run(std::slice::from_ref(&c));
        for (place, (got, c)) in got.iter().zip(&c).enumerate() {
            let share = if place == 0 { 1.0 } else { want };
            // The bound is some 1e-14 below the least value.
            assert!((got - share * c).abs() < 1e-12, "{place}: {got}, not {share} of {c}");
        }
        assert!(least.run(&[got])[0] > -1e-15);
    }
    for c in signals() {
        let [wide, narrow] = [fade.run(std::slice::from_ref(&c)), narrow("lerp_to_dc:3").run(std::slice::from_ref(&c))];
        let mean = c[0].max(0.0);
        for (got, rounding) in [(wide, 1e-13), (narrow, 1e-5)] {
            assert!(got.iter().all(|x| x.is_finite()) && got[0] == c[0], "{c:?}: {got:?}");
            let found = least.run(std::slice::from_ref(&got))[0];
            assert!(c[0] <= 0.0 || found >= -rounding * mean, "{c:?}: {got:?} falls to {found}");
            if c[0] <= 0.0 {
                assert!(got[1..].iter().all(|x| *x == 0.0), "{c:?}: {got:?}");
            }
        }
        if c[0] > 0.0 && least.run(std::slice::from_ref(&c))[4] > 0.0 {
            assert_eq!(fade.run(std::slice::from_ref(&c)), c, "what is not negative stays");
        }
    }
}

/// The smallest window that leaves nothing negative, by bisection.
#[test]
fn windows_meet_the_golden_values() {
    let (window, least) = (wide("window:3"), wide("minimum:3"));
    for case in &cases() {
        let (c, want) = (numbers(&case["irradiance_sh3"]), number(case, "gauss_mu"));
        let at = |mu: f64| least.run(&[window.run(&[vec![mu], c.clone()])])[0];
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if at(middle) < 0.0 { low = middle } else { high = middle }
        }
        // The least value changes by about the mean with mu.
        assert!((high - want).abs() < 1e-12, "{high}, not {want}");
    }
    for (text, factor) in [
        ("window:7", (|mu: f64, l: f64| (-mu * l * (l + 1.0)).exp()) as fn(f64, f64) -> f64),
        ("window:7:laplacian", |mu, l| 1.0 / (1.0 + mu * (l * (l + 1.0)).powi(2))),
    ] {
        for mu in [0.0, 1e-9, 0.01, 0.3, 1.0] {
            let (got, single) =
                ([wide(text).run(&[vec![mu], vec![1.0; 49]])], narrow(text).run(&[vec![mu], vec![1.0; 49]]));
            for (place, got) in got[0].iter().enumerate() {
                let want = factor(mu, place.isqrt() as f64);
                // The power of band 6 is made of 21 factors.
                assert!((got - want).abs() <= 1e-14 * want, "{text}, {mu}: {got}, not {want}");
                let exact = factor(f64::from(mu as f32), place.isqrt() as f64);
                assert!((single[place] - exact).abs() <= 3e-6 * exact, "{text} in f32, {mu}");
                assert!(mu != 0.0 || (*got == 1.0 && single[place] == 1.0), "{text}: nothing changes at 0");
            }
        }
    }
}

#[test]
fn reconstructions_of_four_numbers_meet_the_golden_values() {
    for (text, key) in [("eval_geomerics", "geomerics_l1"), ("eval_zh3", "zh3_hallucinated")] {
        for case in &cases() {
            let inputs = [numbers(&case["normal"]), numbers(&case["irradiance_sh3"])[..4].to_vec()];
            let want = number(case, key);
            let [wide, narrow] = [wide(text).run(&inputs)[0], narrow(text).run(&inputs)[0]];
            assert!((wide - want).abs() < 1e-15, "{text}: {wide}, not {want}");
            // A power of f32 is off by as many roundings as its exponent is large.
            assert!((narrow - want).abs() < 4e-7, "{text} in f32: {narrow}, not {want}");
        }
    }
}

/// The stored zonal band is the one next to band 2, by quadrature; what is zonal already is met, and a signal without band 1
/// keeps its first band alone. Inputs that vanish or are not numbers stay what they are.
#[test]
fn the_stored_zonal_band_is_the_nearest() {
    let (make, at, eval, basis) = (wide("to_zh3"), wide("eval_zh3:stored"), wide("eval:3"), wide("basis:3"));
    let nodes: Vec<([f64; 3], f64)> = Sphere::new(6).nodes().collect();
    let mut random = Random::new(31);
    for _ in 0..40 {
        let c: Vec<f64> = (0..9).map(|_| random.signed()).collect();
        let length = (c[1] * c[1] + c[2] * c[2] + c[3] * c[3]).sqrt();
        let axis = [-c[3], -c[1], c[2]].map(|x| x / length);
        // y_2 about the axis, of norm one.
        let zonal = |dir: &[f64; 3]| {
            let cosine: f64 = dir.iter().zip(axis).map(|(a, b)| a * b).sum();
            (5.0 / (16.0 * std::f64::consts::PI)).sqrt() * (3.0 * cosine * cosine - 1.0)
        };
        let value = |c: &[f64], dir: &[f64; 3]| eval.run(&[dir.to_vec(), c.to_vec()])[0];
        let want: f64 = nodes.iter().map(|(dir, weight)| weight * zonal(dir) * value(&c, dir)).sum();
        let got = make.run(std::slice::from_ref(&c));
        assert_eq!(got[..4], c[..4]);
        assert!((got[4] - want).abs() < 1e-13, "{}, not {want}", got[4]);
        let single = narrow("to_zh3").run(std::slice::from_ref(&c))[4];
        assert!((single - want).abs() < 2e-6, "{single} in f32, not {want}");
        let mut whole = c.clone();
        let along = basis.run(&[axis.to_vec()]);
        (4..9).for_each(|i| whole[i] = 0.7 * along[i]);
        let kept = make.run(std::slice::from_ref(&whole));
        for (dir, _) in nodes.iter().step_by(5) {
            let [got, want] = [at.run(&[dir.to_vec(), kept.clone()])[0], value(&whole, dir)];
            assert!((got - want).abs() < 1e-13, "{got}, not {want}");
            let got = narrow("eval_zh3:stored").run(&[dir.to_vec(), kept.clone()])[0];
            assert!((got - want).abs() < 2e-6, "{got} in f32, not {want}");
        }
    }
    let flat = vec![1.0, 0.0, 0.0, 0.0, 0.3, 0.1, -0.2, 0.4, 0.5];
    let kept = make.run(std::slice::from_ref(&flat));
    assert_eq!(kept, [1.0, 0.0, 0.0, 0.0, 0.0]);
    assert!((at.run(&[vec![0.0, 0.6, 0.8], kept])[0] - 0.25f64.sqrt() / std::f64::consts::PI.sqrt()).abs() < 1e-15);
    assert!(make.run(&[vec![f64::NAN; 9]])[4].is_nan());
}

/// Geomerics' is never negative where band 0 is positive, whatever band 1 is; both are finite for everything.
#[test]
fn reconstructions_hold_at_their_ends() {
    let mut random = Random::new(3);
    for i in 0..2000 {
        let dir: [f64; 3] = match i % 7 {
            0 => [0.0, 0.0, 1.0],
            1 => [0.0, 0.0, -1.0],
            _ => random.unit(),
        };
        let size = [0.0, 1e-12, 0.3, 1.0, 1.1547, 1.2, 5.0][i % 5];
        let axis: [f64; 3] = if i % 3 == 0 { [0.0, 0.0, 1.0] } else { random.unit() };
        let first = [1.0, 1e-4, 0.0, -1.0][i / 5 % 4];
        let c = vec![first, -size * axis[1], size * axis[2], -size * axis[0]];
        for text in ["eval_geomerics", "eval_zh3"] {
            for got in [wide(text).run(&[dir.to_vec(), c.clone()])[0], narrow(text).run(&[dir.to_vec(), c.clone()])[0]]
            {
                assert!(got.is_finite(), "{text}: {got} of {c:?} at {dir:?}");
                assert!(first <= 0.0 || text == "eval_zh3" || got >= 0.0, "{text}: {got} of {c:?} at {dir:?}");
            }
        }
    }
}

#[test]
fn operations_are_those_of_the_derivation() {
    for (text, most, special) in [
        ("minimum:3", 505, 82),
        ("lerp_to_dc:3", 460, 82),
        ("window:3", 11, 1),
        ("window:6", 44, 1),
        ("eval_geomerics", 22, 5),
        ("eval_zh3", 18, 2),
        ("eval_zh3:stored", 12, 1),
        ("to_zh3", 18, 1),
    ] {
        let cost = spec(text).code().cost(1);
        println!("{text}: {} and {} special", cost.total, cost.special);
        assert!(cost.total <= most && cost.special <= special, "{text}: {} and {}", cost.total, cost.special);
    }
}
