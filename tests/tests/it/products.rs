//! Products of functions: against golden values, against quadrature at every order and mixture of orders, against each
//! other, and at extremes.

use rayon::prelude::*;
use zonal_codegen::families::Spec;
use zonal_codegen::families::product::plan::HIGHEST_ORDER;
use zonal_codegen::generate::build;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::turns::dot;
use zonal_tests::{Runner, golden, norm, numbers, quaternion_of_angles, spec};

/// What f64 may round off a product relative to both norms: some thousand operations, each by 1.1e-16 of a part of it.
const ROUNDING: f64 = 1e-13;

fn signal(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| f64::from(random.signed() as f32)).collect()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    norm(&a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<_>>())
}

/// The spec of a product of these orders.
fn of([a, b, order]: [usize; 3]) -> Spec {
    match a == order && b == order {
        true => spec(&format!("product:{order}")),
        false => spec(&format!("product:{a}+{b}:{order}")),
    }
}

/// Holds the f32 form to what its head promises; the inputs are rounded too, and a function of order n is at most
/// n / √(4π) times its norm anywhere.
fn hold_in_f32(spec: &Spec, inputs: &[Vec<f64>], want: &[f64], size: f64) {
    let promised = build(std::slice::from_ref(spec))[0].built.accuracy.rounding_f32;
    let inputs_error = 2.0 * f64::from(f32::EPSILON) * spec.factor_orders()[1].max(spec.order) as f64;
    let error = difference(&Runner::<f32>::new(spec).run(inputs), want) / size;
    assert!(error <= promised + inputs_error, "{spec}: {error:e} in f32, promised {promised:e}");
}

#[test]
fn products_meet_the_golden_values() {
    let file = golden("products");
    let cases = file["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 19);
    for case in cases {
        let orders = ["na", "nb", "nout"].map(|name| case[name].as_u64().expect("an order") as usize);
        let [a, b, want] = ["a", "b", "c"].map(|name| numbers(&case[name]));
        let size = norm(&a) * norm(&b);
        let mut specs = vec![(of(orders), vec![a.clone(), b.clone()])];
        if a == b && orders == [orders[0]; 3] {
            specs.push((spec(&format!("square:{}", orders[0])), vec![a]));
        }
        for (spec, inputs) in specs {
            let error = difference(&Runner::<f64>::new(&spec).run(&inputs), &want) / size;
            assert!(error <= ROUNDING, "{spec}: {error:e}");
            hold_in_f32(&spec, &inputs, &want, size);
        }
    }
}

#[test]
fn zonal_products_meet_the_golden_values() {
    let file = golden("zonal_product");
    let cases = file["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 4);
    for case in cases {
        let [mut zonal, axis, b, a, want] = ["zonal", "axis", "b", "a", "c"].map(|name| numbers(&case[name]));
        let order = case["n"].as_u64().expect("an order") as usize;
        zonal.resize(order, 0.0);
        let a = [a.clone(), vec![0.0; order * order - a.len()]].concat();
        let axis: Vec<f64> = axis.iter().map(|x| x / norm(&axis)).collect();
        let size = norm(&a) * norm(&b);
        let about = spec(&format!("product_zonal_about:{order}"));
        let inputs = [axis.clone(), zonal.clone(), b.clone()];
        assert!(difference(&Runner::<f64>::new(&about).run(&inputs), &want) <= ROUNDING * size, "{about}");
        hold_in_f32(&about, &inputs, &want, size);
        let got = Runner::<f64>::new(&of([order; 3])).run(&[a, b]);
        assert!(difference(&got, &want) <= ROUNDING * size, "expanded, order {order}");
    }
}

/// Directions, weights and the basis, of a rule that is exact for polynomials of a degree, over the sphere or above the
/// horizon alone.
fn nodes(order: usize, degree: usize, from: f64) -> Vec<(f64, Vec<f64>)> {
    let basis = Runner::<f64>::new(&Spec::new(&zonal_codegen::families::basis::BASIS, order));
    let around = degree + 1;
    let step = std::f64::consts::TAU / around as f64;
    let ring = |(z, weight): (f64, f64)| {
        let sin = (1.0 - z * z).sqrt();
        let basis = &basis;
        (0..around).map(move |i| {
            let angle = step * (i as f64 + 0.5);
            (weight * step, basis.run(&[vec![sin * angle.cos(), sin * angle.sin(), z]]))
        })
    };
    gauss_legendre(degree / 2 + 1, from, 1.0).flat_map(ring).collect()
}

/// The coefficients of the product of functions, by quadrature.
fn integrated(nodes: &[(f64, Vec<f64>)], a: &[f64], b: &[f64], order: usize) -> Vec<f64> {
    let mut out = vec![0.0; order * order];
    for (weight, y) in nodes {
        let value = weight * dot(a, &y[..a.len()]) * dot(b, &y[..b.len()]);
        out.iter_mut().zip(y).for_each(|(sum, y)| *sum += value * y);
    }
    out
}

/// Every mixture of orders up to 6, in which every band of both factors counts, and some beyond.
fn mixtures() -> Vec<[usize; 3]> {
    let mut all: Vec<[usize; 3]> = Vec::new();
    for a in 2..=6 {
        for b in 2..=6 {
            for order in 2..=HIGHEST_ORDER.min(a + b - 1) {
                if a.max(b) < a.min(b) + order {
                    all.push([a, b, order]);
                }
            }
        }
    }
    all.extend([[7; 3], [8; 3], [2, 8, 8], [8, 2, 8], [8, 8, 2], [4, 7, 5], [3, 8, 6]]);
    all
}

#[test]
fn products_are_quadrature_at_every_order_and_mixture_of_orders() {
    let all = mixtures();
    assert!(all.len() > 100, "{}", all.len());
    let worst = all
        .par_iter()
        .map(|&[a, b, order]| {
            let nodes = nodes(a.max(b).max(order), a + b + order - 3, -1.0);
            let runner = Runner::<f64>::new(&of([a, b, order]));
            let mut random = Random::new(21);
            (0..3)
                .map(|_| {
                    let (a, b) = (signal(&mut random, a * a), signal(&mut random, b * b));
                    let got = runner.run(&[a.clone(), b.clone()]);
                    let error = difference(&got, &integrated(&nodes, &a, &b, order)) / (norm(&a) * norm(&b));
                    assert!(error <= ROUNDING, "{a:?} {b:?}, order {order}: {error:e}");
                    error
                })
                .fold(0.0, f64::max)
        })
        .reduce(|| 0.0, f64::max);
    println!("{} mixtures: {worst:e}", all.len());
}

#[test]
fn squares_are_quadrature_at_every_order() {
    for order in 2..=HIGHEST_ORDER {
        let nodes = nodes(order, 3 * order - 3, -1.0);
        let square = spec(&format!("square:{order}"));
        let (runner, product) = (Runner::<f64>::new(&square), Runner::<f64>::new(&of([order; 3])));
        let mut random = Random::new(22);
        for _ in 0..3 {
            let a = signal(&mut random, order * order);
            let (got, size) = (runner.run(std::slice::from_ref(&a)), norm(&a).powi(2));
            assert!(difference(&got, &integrated(&nodes, &a, &a, order)) <= ROUNDING * size, "{square}");
            assert!(difference(&got, &product.run(&[a.clone(), a])) <= ROUNDING * size, "{square}");
        }
    }
}

#[test]
fn products_are_symmetric_and_one_changes_nothing() {
    let mut random = Random::new(23);
    for order in 2..=HIGHEST_ORDER {
        let runner = Runner::<f64>::new(&of([order; 3]));
        let [a, b] = [(); 2].map(|()| signal(&mut random, order * order));
        let size = norm(&a) * norm(&b);
        let [got, other] = [[&a, &b], [&b, &a]].map(|[a, b]| runner.run(&[a.clone(), b.clone()]));
        assert!(difference(&got, &other) <= ROUNDING * size, "order {order}");
        let mut one = vec![0.0; order * order];
        one[0] = (4.0 * std::f64::consts::PI).sqrt();
        assert!(difference(&runner.run(&[one.clone(), b.clone()]), &b) <= ROUNDING * norm(&one) * norm(&b));
        let dot = Runner::<f64>::new(&spec(&format!("dot:{order}"))).run(&[a.clone(), b.clone()]);
        // The integral of the product is √(4π) times its first coefficient.
        assert!((dot[0] - one[0] * got[0]).abs() <= ROUNDING * size * one[0], "order {order}");
    }
    let (a, b) = (signal(&mut random, 4), signal(&mut random, 9));
    let [got, other] = [("product:2+3:4", [&a, &b]), ("product:3+2:4", [&b, &a])]
        .map(|(text, [a, b])| Runner::<f64>::new(&spec(text)).run(&[a.clone(), b.clone()]));
    assert_eq!(got, other, "one plan serves both ways round");
}

/// A rotation of both factors rotates the product, for it mixes no bands and cuts none off.
#[test]
fn products_turn_with_their_factors() {
    let q = quaternion_of_angles(0.7, 1.1, -2.3);
    let mut random = Random::new(24);
    for order in 2..=HIGHEST_ORDER {
        let rotate = Runner::<f64>::new(&spec(&format!("rotate:{order}")));
        let turned = |c: &[f64]| rotate.run(&[q.clone(), c.to_vec()]);
        let [a, b] = [(); 2].map(|()| signal(&mut random, order * order));
        let size = norm(&a) * norm(&b);
        let product = Runner::<f64>::new(&of([order; 3]));
        let (got, want) = (product.run(&[turned(&a), turned(&b)]), turned(&product.run(&[a.clone(), b])));
        assert!(difference(&got, &want) <= ROUNDING * size, "order {order}");
        let square = Runner::<f64>::new(&spec(&format!("square:{order}")));
        let (got, want) = (square.run(&[turned(&a)]), turned(&square.run(std::slice::from_ref(&a))));
        assert!(difference(&got, &want) <= ROUNDING * norm(&a).powi(2), "order {order}");
    }
}

/// What a coefficient that is no number reaches is no number; zeros give zeros; numbers as large and as small as f32 has
/// give what they should, or infinities, and never a number that is wrong.
#[test]
fn products_at_extremes() {
    let mut random = Random::new(25);
    for order in 2..=6 {
        let (narrow, wide) = (Runner::<f32>::new(&of([order; 3])), Runner::<f64>::new(&of([order; 3])));
        let count = order * order;
        let [a, b] = [(); 2].map(|()| signal(&mut random, count));
        let want = wide.run(&[a.clone(), b.clone()]);
        for place in 0..count {
            let mut unit = vec![0.0; count];
            unit[place] = 1.0;
            let reached = wide.run(&[unit, vec![1.0; count]]);
            let mut spoilt = a.clone();
            spoilt[place] = f64::NAN;
            let got = narrow.run(&[spoilt, b.clone()]);
            for (i, (got, reached)) in got.iter().zip(&reached).enumerate() {
                assert!(reached.abs() < 1e-9 || got.is_nan(), "order {order}: {place} reaches {i}");
            }
        }
        let zeros = narrow.run(&[vec![0.0; count], b.clone()]);
        assert!(zeros.iter().all(|x| *x == 0.0), "order {order}: {zeros:?}");
        let scaled = |list: &[f64], power: i32| -> Vec<f64> { list.iter().map(|x| x * 2f64.powi(power)).collect() };
        let plain = narrow.run(&[a.clone(), b.clone()]);
        // f32 ends at 2^128: a ring's amplitudes are some times their coefficients.
        let huge = narrow.run(&[scaled(&a, 100), scaled(&b, 20)]);
        assert_eq!(huge, scaled(&plain, 120), "order {order}");
        let beyond = narrow.run(&[scaled(&a, 100), scaled(&b, 100)]);
        assert!(beyond.iter().all(|x| !x.is_finite() || *x == 0.0), "order {order}: {beyond:?}");
        // Subnormal numbers are whole multiples of 2^-149, and each operation may be off by half of one.
        let small = narrow.run(&[scaled(&a, -100), scaled(&b, -30)]);
        let most = 2000.0 * 2f64.powi(-149) * order as f64;
        assert!(difference(&small, &scaled(&want, -130)) <= most, "order {order}");
    }
}

#[test]
fn the_matrix_and_the_grey_product_are_the_product() {
    let mut random = Random::new(26);
    for order in 2..=6 {
        let count = order * order;
        let [a, b] = [(); 2].map(|()| signal(&mut random, count));
        let size = norm(&a) * norm(&b);
        let run = |name: &str, inputs: &[Vec<f64>]| Runner::<f64>::new(&spec(&format!("{name}:{order}"))).run(inputs);
        let want = run("product", &[a.clone(), b.clone()]);
        let matrix = run("product_matrix", std::slice::from_ref(&a));
        // As the head says: the lower triangle row by row, without the entries that are zero for every function.
        assert_eq!(matrix.len(), [7, 40, 125, 310, 646][order - 2]);
        let column = |j: usize| {
            let mut unit = vec![0.0; count];
            unit[j] = 1.0;
            run("product", &[a.clone(), unit])
        };
        let columns: Vec<Vec<f64>> = (0..count).map(column).collect();
        let mut packed = matrix.iter();
        for i in 0..count {
            for (j, column) in columns[..=i].iter().enumerate() {
                // What is not zero for every function is above 1e-4 for this one.
                if column[i].abs() > 1e-12 {
                    let entry = packed.next().expect("an entry");
                    assert!((entry - column[i]).abs() <= ROUNDING * norm(&a), "order {order}, entry {i}, {j}");
                }
            }
        }
        assert_eq!(packed.next(), None, "order {order}");
        let by_matrix = run("product_by_matrix", &[matrix, b.clone()]);
        assert!(difference(&by_matrix, &want) <= ROUNDING * size, "order {order}");
        let grey = run("product_grey", &[a, b]);
        assert!(difference(&grey, &want) <= ROUNDING * size, "order {order}");
    }
}

#[test]
fn a_zonal_product_is_the_product_with_the_turned_zonal_function() {
    let mut random = Random::new(27);
    for order in 2..=HIGHEST_ORDER {
        let run = |name: &str, inputs: &[Vec<f64>]| Runner::<f64>::new(&spec(name)).run(inputs);
        let product = Runner::<f64>::new(&of([order; 3]));
        let angles = Runner::<f64>::new(&spec(&format!("axis_angles:{order}")));
        for axis in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], random.unit(), random.unit()] {
            let (zonal, b) = (signal(&mut random, order), signal(&mut random, order * order));
            let size = norm(&zonal) * norm(&b);
            let axis = axis.to_vec();
            let turned = run(&format!("rotate:{order}:zonal"), &[axis.clone(), zonal.clone()]);
            let want = product.run(&[turned, b.clone()]);
            let about = run(&format!("product_zonal_about:{order}"), &[axis.clone(), zonal.clone(), b.clone()]);
            assert!(difference(&about, &want) <= ROUNDING * size, "order {order} about {axis:?}");
            let given = [angles.run(std::slice::from_ref(&axis)), zonal.clone(), b.clone()];
            let given = run(&format!("product_zonal_about:{order}:angles"), &given);
            assert!(difference(&given, &want) <= ROUNDING * size, "order {order} about {axis:?}, angles given");
            if axis[2] == 1.0 {
                let about_z = run(&format!("product_zonal:{order}"), &[zonal, b]);
                assert!(difference(&about_z, &want) <= ROUNDING * size, "order {order}");
            }
        }
    }
}

/// By quadrature above the horizon, of which all bands of the fixed function are; about an axis after a rotation of the
/// other factor.
#[test]
fn fixed_zonal_products_are_quadrature() {
    let mut random = Random::new(28);
    for order in 2..=HIGHEST_ORDER {
        let nodes = nodes(order, 2 * order - 1, 0.0);
        let sectors: Vec<(f64, Vec<f64>, f64)> = nodes
            .into_iter()
            // y_1^0 is √(3/4π) z.
            .map(|(weight, y)| (weight, y.clone(), y[2] / (0.75 / std::f64::consts::PI).sqrt()))
            .collect();
        for name in ["cosine", "hemisphere"] {
            let of = |b: &[f64]| {
                let mut out = vec![0.0; order * order];
                for (weight, y, z) in &sectors {
                    let value = weight * dot(b, y) * if name == "cosine" { *z } else { 1.0 };
                    out.iter_mut().zip(y).for_each(|(sum, y)| *sum += value * y);
                }
                out
            };
            let b = signal(&mut random, order * order);
            let about_z = Runner::<f64>::new(&spec(&format!("product_{name}:{order}")));
            let got = about_z.run(std::slice::from_ref(&b));
            assert!(difference(&got, &of(&b)) <= ROUNDING * norm(&b), "{name}, order {order}");
            let (alpha, beta) = (2.1, 0.8f64);
            let axis = vec![beta.sin() * f64::cos(alpha), beta.sin() * f64::sin(alpha), beta.cos()];
            let rotate = Runner::<f64>::new(&spec(&format!("rotate:{order}")));
            let back = rotate.run(&[quaternion_of_angles(0.0, -beta, -alpha), b.clone()]);
            let want = rotate.run(&[quaternion_of_angles(alpha, beta, 0.0), of(&back)]);
            let about = Runner::<f64>::new(&spec(&format!("product_{name}_about:{order}")));
            assert!(difference(&about.run(&[axis.clone(), b.clone()]), &want) <= ROUNDING * norm(&b), "{name}");
            let angles = Runner::<f64>::new(&spec(&format!("axis_angles:{order}"))).run(&[axis]);
            let given = Runner::<f64>::new(&spec(&format!("product_{name}_about:{order}:angles")));
            assert!(difference(&given.run(&[angles, b.clone()]), &want) <= ROUNDING * norm(&b), "{name}");
        }
    }
}
