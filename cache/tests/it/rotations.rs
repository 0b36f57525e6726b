//! The ways to turn records agree where they should, and the limit between them is what the mathematics says.

use serde_json::Value;
use zonal_cache::basis::{Basis, HSH6, SH6, SH10};
use zonal_cache::light::Light;
use zonal_cache::methods::{Limit, Method};
use zonal_codegen::promise::samples::Random;

/// A turn about z, a small one about y, a turn about z.
fn turn(random: &mut Random, degrees: f64) -> [f32; 4] {
    let [a, c] = [random.signed(), random.signed()];
    let (s, w) = (0.5 * degrees.to_radians()).sin_cos();
    [-s * (a - c).sin(), s * (a - c).cos(), w * (a + c).sin(), w * (a + c).cos()].map(|x| x as f32)
}

fn smooth<const C: usize>(random: &mut Random) -> Light<C> {
    // Powers of bands fall as those of light.
    std::array::from_fn(|i| {
        let l = (i as f64).sqrt().floor();
        [0, 1, 2].map(|_| (random.signed() / ((1.0 + l) * (1.0 + l))) as f32)
    })
}

/// The distance of two lists as a share of the second's norm.
fn distance<const C: usize>(a: &Light<C>, b: &Light<C>) -> f32 {
    let square = |x: f32| x * x;
    let (a, b) = (a.as_flattened(), b.as_flattened());
    let far: f32 = a.iter().zip(b).map(|(a, b)| square(a - b)).sum();
    (far / b.iter().map(|b| square(*b)).sum::<f32>()).sqrt()
}

fn named<const C: usize>(basis: &Basis<C>, name: &str) -> Method<C> {
    *basis.methods.iter().find(|method| method.name == name).expect("a method of that name")
}

/// How far a method is from the exact one at an angle, the worst of some.
fn worst<const C: usize>(basis: &Basis<C>, name: &str, degrees: f64) -> f32 {
    let (method, exact) = (named(basis, name), basis.methods[basis.methods.len() - 1]);
    let mut random = Random::new(5);
    let far = (0..12).map(|_| {
        let (q, c) = (turn(&mut random, degrees), smooth::<C>(&mut random));
        // Whatever the limit, a method for small angles is tried.
        distance(&method.turn(q, 1.0, &c).0, &exact.turn(q, 0.0, &c).0)
    });
    far.fold(0.0, f32::max)
}

fn spherical<const C: usize>(basis: &Basis<C>) {
    for name in ["zxzxz", "Ivanic and Ruedenberg"] {
        // Both are exact: f32 rounds, some tens of operations deep.
        assert!(worst(basis, name, 30.0) < 2e-5, "{name}: {}", worst(basis, name, 30.0));
    }
    let at = |degrees| ["ignored", "Taylor 1.5", "LF3", "tilt"].map(|name| worst(basis, name, degrees));
    // All small ones are small at two degrees: Taylor 1.5 is of the first order, the shears of the third.
    let [none, taylor, shears, tilt] = at(2.0);
    assert!(taylor < 0.01 && shears < 1e-3 && tilt < 1e-3 && none > 0.02, "{:?}", at(2.0));
    let [none, taylor, shears, tilt] = at(8.0);
    assert!(shears < taylor && tilt < taylor && taylor < none, "{:?}", at(8.0));
}

#[test]
fn rotations_of_spherical_harmonics_agree_where_angles_are_small() {
    spherical(&SH6);
    spherical(&SH10);
}

#[test]
fn rotations_of_hemispherical_harmonics_agree_where_angles_are_small() {
    for name in ["LF3 on B", "equation 13"] {
        let (small, large) = (worst(&HSH6, name, 3.0), worst(&HSH6, name, 20.0));
        assert!(small < large && small < 0.15, "{name}: {small} {large}");
    }
    // What eight spherical bands do not hold is missing at any angle.
    for degrees in [0.0, 3.0, 20.0] {
        let lost = worst(&HSH6, "method 1, 8 bands", degrees);
        assert!((0.01..0.15).contains(&lost), "{degrees}: {lost}");
    }
    // Without a turn the table leaves a record as it is, but for what the extension's 10⁻³ weighs; an entry between two
    // degrees lies between theirs.
    let (c, mut random) = (smooth::<36>(&mut Random::new(9)), Random::new(4));
    let table = named(&HSH6, "table C D_y E");
    let still = table.turn([0.0, 0.0, 0.0, 1.0], 0.0, &c).0;
    assert!(distance(&still, &c) < 0.02, "{}", distance(&still, &c));
    let q = turn(&mut random, 0.5);
    let (z, y) = ([0.0, 0.0, q[2], q[3]], table.turn(q, 0.0, &c).0);
    let norm = q[2].hypot(q[3]);
    let near = distance(&y, &table.turn(z.map(|x| x / norm), 0.0, &c).0);
    // Half a degree times the generator's norm, some eight at order 6.
    assert!((1e-4..0.1).contains(&near), "{near}");
}

fn meets<const C: usize>(case: &Value) {
    let numbers = |name: &str| -> Vec<f64> {
        case[name].as_array().expect("numbers").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let [given, wanted] = ["h", "best_extension"].map(|name| -> Light<C> {
        let numbers = numbers(name);
        std::array::from_fn(|i| [numbers[i] as f32; 3])
    });
    let beta = case["deg"].as_f64().expect("an angle").to_radians() as f32;
    let found = zonal_cache::table::of_order(C.isqrt()).turn(beta, &given);
    // f32 rounds entries and sums.
    assert!(distance(&found, &wanted) < 1e-6, "{} {}", case["n"], distance(&found, &wanted));
}

#[test]
fn the_table_meets_the_golden_values() {
    let text = std::fs::read_to_string("../tests/golden/hsh_rotation.json").expect("the file is there");
    let file: Value = serde_json::from_str(&text).expect("it is JSON");
    let cases = file["cases"].as_array().expect("cases").iter().filter(|case| case["best_extension"].is_array());
    let mut tried = 0;
    for case in cases {
        match case["n"].as_u64() {
            Some(3) => meets::<9>(case),
            Some(4) => meets::<16>(case),
            other => panic!("order {other:?} is not tried"),
        }
        tried += 1;
    }
    assert_eq!(tried, 4);
}

#[test]
fn the_two_forms_of_the_limit_are_those_of_the_paper_and_of_the_mathematics() {
    // docs/MATH.md: f(b) = (√2 + 2r/R) sin(b/2) = a at the limit in closed form, r/R = 0.1.
    for a in [0.05, 0.1, 0.3, 0.5, 1.0] {
        let half = 0.5 * Limit::Closed.angle(a);
        let f = 0.2 * half.sin() + (1.0 - (2.0 * half).cos()).sqrt();
        // 1 − cos loses digits where the angle is small: 1e-16 over its root.
        assert!((f - a).abs() < 1e-13, "{a}: {f}");
        assert_eq!(Limit::Rounded.angle(a), 1.25 * a);
        assert_eq!(Limit::Held(0.1).angle(a), 0.1);
    }
    // 1.25 a exceeds nothing that the exact bound allows above 0.368, and more below: where they meet.
    let gap = |a: f64| Limit::Rounded.angle(a) - Limit::Closed.angle(a);
    assert!(gap(0.36) > 0.0 && gap(0.376) < 0.0 && gap(0.36825).abs() < 1e-5, "{}", gap(0.36825));
    // 21.4 degrees at a = 0.3.
    assert!((Limit::Closed.angle(0.3).to_degrees() - 21.4).abs() < 0.05);
    // At the limit the small method is done, beyond it the other.
    let exact = named(&SH6, "LF3");
    let c = smooth::<36>(&mut Random::new(1));
    assert!(!exact.turn([0.1, 0.0, 0.0, 0.995], 0.1, &c).1 && exact.turn([0.11, 0.0, 0.0, 0.9939], 0.1, &c).1);
}
