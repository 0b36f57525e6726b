//! What rotations promise, over random and extreme rotations: the group law, inverses, the identity, norms, each method
//! at its own bound; and where bad numbers may spread.

use zonal_codegen::families::Spec;
use zonal_codegen::promise::accuracy::method_errors;
use zonal_codegen::promise::samples::{Random, inputs};
use zonal_tests::{Runner, band_error, norm, quaternion_product, spec};

/// Every way to rotate by a quaternion.
fn quaternion_rotations(order: usize) -> Vec<Spec> {
    let methods: &[&str] = if order <= 3 { &["zyz", "zxzxz", "tensor"] } else { &["zyz", "zxzxz"] };
    methods.iter().map(|method| spec(&format!("rotate:{order}:{method}"))).collect()
}

/// Rotations and signals, extremes first, and random quaternions for a second rotation.
fn trials(spec: &Spec, count: usize) -> Vec<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let params = spec.kernel().params;
    let first = inputs(&params, 31, count, None);
    let mut random = Random::new(37);
    first.into_iter().map(|input| (input[0].clone(), random.unit::<4>().to_vec(), input[1].clone())).collect()
}

fn conjugate(q: &[f64]) -> Vec<f64> {
    vec![-q[0], -q[1], -q[2], q[3]]
}

fn unit(q: &[f64]) -> Vec<f64> {
    q.iter().map(|x| x / norm(q)).collect()
}

#[test]
fn rotations_form_a_group() {
    for order in [2, 3, 4, 6, 10] {
        for spec in quaternion_rotations(order) {
            let rotate = Runner::<f64>::new(&spec);
            for (a, b, c) in trials(&spec, 120) {
                let (a, b) = (unit(&a), unit(&b));
                let once = rotate.run(&[unit(&quaternion_product(&a, &b)), c.clone()]);
                let twice = rotate.run(&[a.clone(), rotate.run(&[b, c.clone()])]);
                // Three rotations of some 1e-15 each (goldens.rs measures one).
                assert!(band_error(&twice, &once) <= 3e-14, "{spec} at {a:?}");
                let back = rotate.run(&[conjugate(&a), rotate.run(&[a.clone(), c.clone()])]);
                assert!(band_error(&back, &c) <= 3e-14, "{spec} at {a:?}");
            }
        }
    }
}

#[test]
fn rotations_keep_the_norm_of_every_band_in_f32() {
    for order in [3, 5, 8, 10] {
        for spec in quaternion_rotations(order) {
            let rotate = Runner::<f32>::new(&spec);
            let bound = zonal_codegen::promise::built::Built::new(&spec).accuracy.rounding_f32;
            for (q, _, c) in trials(&spec, 200) {
                let out = rotate.run(&[q.clone(), c.clone()]);
                for l in 0..order {
                    let range = l * l..(l + 1) * (l + 1);
                    let (before, after) = (norm(&c[range.clone()]), norm(&out[range]));
                    // The quaternion itself is rounded: its norm is one within 1.2e-7, band l of a vector-and-tensor
                    // rotation grows with the 2l-th power of it.
                    let slack = bound + 2.0 * l as f64 * 1.2e-7;
                    assert!((after / before - 1.0).abs() <= slack, "{spec}, band {l} at {q:?}");
                }
            }
        }
    }
}

/// Order 2 returns its input to the last bit; the others, whose constants are rounded, within a few roundings, printed.
#[test]
fn the_identity_changes_nothing_or_a_few_roundings() {
    for order in 2..=10 {
        for spec in quaternion_rotations(order) {
            for q in [vec![0.0, 0.0, 0.0, 1.0], vec![0.0, 0.0, 0.0, -1.0]] {
                let (_, _, c) = trials(&spec, 1).remove(0);
                let narrow = Runner::<f32>::new(&spec).run(&[q.clone(), c.clone()]);
                let ulps = narrow.iter().zip(&c).map(|(got, want)| {
                    (got - want).abs() / (f64::from(f32::EPSILON) * want.abs().max(f64::MIN_POSITIVE))
                });
                let worst = ulps.fold(0.0, f64::max);
                let error = band_error(&narrow, &c);
                println!("{spec} at w = {}: {error:.1e} of a band's norm, {worst:.0} ulps at worst", q[3]);
                if order == 2 && spec.to_string() == "rotate:2" {
                    assert_eq!(narrow, c, "{spec}: to the last bit");
                }
                // 3e-7 is five roundings of a band's largest value.
                assert!(error <= 3e-7, "{spec}: {error:e}");
            }
        }
    }
}

#[test]
fn z_and_y_rotations_add_their_angles() {
    for order in [2, 5, 10] {
        for family in ["rotate_z", "rotate_y"] {
            let spec = spec(&format!("{family}:{order}"));
            let rotate = Runner::<f64>::new(&spec);
            let mut random = Random::new(41);
            for (_, _, c) in trials(&spec, 60) {
                let ([a, b], [p, q]) = (random.unit::<2>(), random.unit::<2>());
                let sum = vec![a * p - b * q, a * q + b * p];
                let twice = rotate.run(&[vec![a, b], rotate.run(&[vec![p, q], c.clone()])]);
                assert!(band_error(&twice, &rotate.run(&[sum, c.clone()])) <= 3e-14, "{spec}");
                let back = rotate.run(&[vec![a, -b], rotate.run(&[vec![a, b], c.clone()])]);
                assert!(band_error(&back, &c) <= 3e-14, "{spec}");
            }
        }
    }
}

/// An approximate rotation differs from the exact one by its method error at most, whatever the signal, and shears are
/// undone exactly by the shears of the opposite angle.
#[test]
fn approximate_rotations_keep_their_bounds() {
    for order in [3, 5, 8] {
        for method in ["taylor1", "taylor15", "taylor2", "lf3"] {
            let spec = spec(&format!("{method}:{order}"));
            let (small, exact) =
                (Runner::<f64>::new(&spec), Runner::<f64>::new(&zonal_tests::spec(&format!("rotate_y:{order}"))));
            for degrees in [0.1f64, 1.0, 5.0, 15.0, 30.0] {
                let beta = degrees.to_radians();
                let bound = method_errors(&spec, &[beta])[0];
                for (_, _, c) in trials(&spec, 40) {
                    let got = small.run(&[vec![beta], c.clone()]);
                    let want = exact.run(&[vec![beta.cos(), beta.sin()], c.clone()]);
                    let error = band_error(&got, &want);
                    assert!(error <= bound * 1.000_001 + 1e-14, "{spec} at {degrees}: {error:e} above {bound:e}");
                    if method == "lf3" {
                        let back = small.run(&[vec![-beta], got]);
                        assert!(band_error(&back, &c) <= 1e-13, "{spec} at {degrees}");
                    }
                }
            }
        }
    }
}

#[test]
fn tilts_are_undone_by_the_opposite_normal() {
    for order in 2..=10 {
        let spec = spec(&format!("tilt:{order}"));
        let tilt = Runner::<f64>::new(&spec);
        for (_, _, c) in trials(&spec, 5) {
            let mut random = Random::new(43);
            for _ in 0..20 {
                let [x, y] = random.unit::<2>().map(|v| v * 0.3);
                let z = (1.0 - x * x - y * y).sqrt();
                let there = tilt.run(&[vec![x, y, z], c.clone()]);
                let back = tilt.run(&[vec![-x, -y, z], there]);
                assert!(band_error(&back, &c) <= 1e-13, "{spec}");
            }
        }
    }
}

/// The nodes and weights of Gauss and Legendre on [−1, 1], by Newton's method.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let legendre = |x: f64| -> (f64, f64) {
        let (mut last, mut value) = (1.0, x);
        for k in 2..=count {
            let k = k as f64;
            (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
        }
        (value, count as f64 * (x * value - last) / (x * x - 1.0))
    };
    (0..count)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
            for _ in 0..10 {
                let (value, slope) = legendre(x);
                x -= value / slope;
            }
            let slope = legendre(x).1;
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[test]
fn the_basis_is_orthonormal() {
    // n nodes in z and 2n in φ integrate products of order n exactly.
    for order in [2usize, 5, 10] {
        let basis = Runner::<f64>::new(&spec(&format!("basis:{order}")));
        let size = order * order;
        let mut gram = vec![0.0; size * size];
        for (z, weight) in gauss_legendre(order) {
            for j in 0..2 * order {
                let phi = j as f64 * std::f64::consts::PI / order as f64;
                let s = (1.0 - z * z).sqrt();
                let y = basis.run(&[vec![s * phi.cos(), s * phi.sin(), z]]);
                for (a, ya) in y.iter().enumerate() {
                    for (b, yb) in y.iter().enumerate() {
                        gram[a * size + b] += ya * yb * weight * std::f64::consts::PI / order as f64;
                    }
                }
            }
        }
        for a in 0..size {
            for b in 0..size {
                let want = if a == b { 1.0 } else { 0.0 };
                let error = (gram[a * size + b] - want).abs();
                assert!(error <= 1e-13, "order {order}: entry {a}, {b} is {error:e} off");
            }
        }
    }
}

/// A bad number in one band stays in that band: infinite, NaN, huge or denormal.
#[test]
fn bands_do_not_mix() {
    for text in
        ["rotate:6", "rotate:6:zxzxz", "tilt:6", "lf3:6", "taylor15:6", "rotate_z:6", "swap_yz:6", "rotate:3", "zhf:6"]
    {
        let spec = spec(text);
        let params = spec.kernel().params;
        let clean = inputs(&params, 47, 20, Some(0.2)).pop().expect("twenty inputs");
        let runner = Runner::<f32>::new(&spec);
        let want = runner.run(&clean);
        let signal = clean.len() - 1;
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e38, 1e-38, 1e-45] {
            for band in 0..spec.order {
                let mut input = clean.clone();
                input[signal][band * band + band] = bad;
                let got = runner.run(&input);
                for l in (0..spec.order).filter(|l| *l != band) {
                    let range = l * l..(l + 1) * (l + 1);
                    assert_eq!(got[range.clone()], want[range], "{spec}: {bad} in band {band} reached band {l}");
                }
            }
        }
    }
}

/// Signals of any size are rotated to the same relative accuracy until a square overflows, which no kernel takes.
#[test]
fn huge_and_small_signals_keep_their_relative_accuracy() {
    for text in ["rotate:5", "rotate:3", "tilt:5", "lf3:5", "eval:5"] {
        let spec = spec(text);
        let params = spec.kernel().params;
        let (narrow, wide) = (Runner::<f32>::new(&spec), Runner::<f64>::new(&spec));
        for exponent in [-60, -100, 60, 100] {
            let scale = 2f64.powi(exponent);
            for input in inputs(&params, 53, 40, Some(0.2)) {
                let mut scaled = input.clone();
                let last = scaled.len() - 1;
                scaled[last].iter_mut().for_each(|x| *x *= scale);
                let (got, want) = (narrow.run(&scaled), wide.run(&input));
                let difference: Vec<f64> = got.iter().zip(&want).map(|(a, b)| a / scale - b).collect();
                assert!(norm(&difference) <= 4e-6 * norm(&input[last]), "{spec} at 2^{exponent}");
            }
        }
    }
}
