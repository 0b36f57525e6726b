//! Products of two signals, on the toys: the integrals of three harmonics against quadrature, products of functions, signs,
//! linearity in each signal, and what their error is relative to.

use crate::toys::{TOYS, toy};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_tests::toys::{CHOICES, CROSS, PRODUCT, triple};
use zonal_tests::{Runner, norm, spec};

/// Directions and weights of a rule that is exact for polynomials of degree 7: five bands and three functions of band 2
/// need 6.
fn sphere() -> Vec<([f64; 3], f64)> {
    const AROUND: usize = 8;
    let turn = |i: usize| std::f64::consts::TAU * (i as f64 + 0.5) / AROUND as f64;
    let ring = |(z, weight): (f64, f64)| {
        let sin = (1.0 - z * z).sqrt();
        (0..AROUND).map(move |i| {
            ([sin * turn(i).cos(), sin * turn(i).sin(), z], weight * std::f64::consts::TAU / AROUND as f64)
        })
    };
    gauss_legendre(4, -1.0, 1.0).flat_map(ring).collect()
}

#[test]
fn the_integrals_of_three_harmonics_are_those_of_quadrature() {
    let basis = Runner::<f64>::new(&spec("basis:3"));
    let values: Vec<(Vec<f64>, f64)> =
        sphere().into_iter().map(|(dir, weight)| (basis.run(&[dir.to_vec()]), weight)).collect();
    let (mut nonzeros, mut worst) = (0, 0.0f64);
    for i in 0..9 {
        for j in 0..9 {
            for k in 0..9 {
                let want: f64 = values.iter().map(|(y, weight)| weight * y[i] * y[j] * y[k]).sum();
                let got = triple(i, j, k);
                worst = worst.max((got.to_f64() - want).abs());
                nonzeros += usize::from(i <= j && j <= k && !got.is_zero());
            }
        }
    }
    assert!(worst < 1e-15, "{worst:e}");
    assert_eq!(nonzeros, 25, "docs/MATH.md#products");
}

/// Both signals of a toy.
fn signals(random: &mut Random, count: usize) -> [Vec<f64>; 2] {
    [(); 2].map(|()| (0..count).map(|_| f64::from(random.signed() as f32)).collect())
}

#[test]
fn a_product_is_that_of_the_functions() {
    let mut random = Random::new(12);
    for order in [2, 3] {
        let basis = Runner::<f64>::new(&spec(&format!("basis:{order}")));
        let nodes: Vec<(Vec<f64>, f64)> =
            sphere().into_iter().map(|(dir, weight)| (basis.run(&[dir.to_vec()]), weight)).collect();
        let straight = Spec::new(&PRODUCT, order);
        let runners = [straight.clone(), straight.looped()].map(|spec| spec.code().runner::<f64>());
        for _ in 0..50 {
            let [a, b] = signals(&mut random, order * order);
            let at = |c: &[f64], y: &[f64]| c.iter().zip(y).map(|(c, y)| c * y).sum::<f64>();
            let coefficient =
                |k: usize| nodes.iter().map(|(y, weight)| weight * at(&a, y) * at(&b, y) * y[k]).sum::<f64>();
            let want: Vec<f64> = (0..order * order).map(coefficient).collect();
            for runner in &runners {
                let got = runner.run(&[&a, &b], Contraction::Separate);
                let off: Vec<f64> = got.iter().zip(&want).map(|(got, want)| got - want).collect();
                assert!(norm(&off) < 1e-15 * norm(&a) * norm(&b), "order {order}: {:e}", norm(&off));
            }
        }
    }
}

#[test]
fn a_cross_product_has_its_signs() {
    let runner = Spec::new(&CROSS, 2).code().runner::<f64>();
    let (a, b) = ([2.0, -3.0, 5.0], [7.0, 11.0, -13.0]);
    let want: Vec<f64> = (0..3)
        .map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j] - a[i] * b[i]
        })
        .collect();
    for contraction in [Contraction::Separate, Contraction::Fused] {
        assert_eq!(runner.run(&[&a, &b], contraction), want);
    }
    let Code::Straight(listing) = Spec::new(&CROSS, 2).code() else { panic!("the toy is straight") };
    let (one, three) = (listing.cost(1), listing.cost(3));
    assert_eq!([one.mul, one.add, one.fma, one.total], [3, 0, 6, 9]);
    assert_eq!([three.mul, three.add, three.fma, three.total], [9, 0, 18, 27], "every product is one a channel");
}

/// P(αa + a', b) = αP(a, b) + P(a', b), the same in b, and to the last bit what a power of two multiplies.
#[test]
fn products_are_linear_in_each_signal() {
    let mut random = Random::new(13);
    for function in TOYS.iter().filter(|function| function.spec.family != &CHOICES && !function.spec.rgb) {
        let count = function.built.code.params()[0].shape.len();
        let (runner, narrow) = (function.built.code.runner::<f64>(), function.built.code.runner::<f32>());
        let product = |a: &[f64], b: &[f64]| runner.run(&[a, b], Contraction::Separate);
        for _ in 0..50 {
            let ([a, b], [other, _]) = (signals(&mut random, count), signals(&mut random, count));
            let factor = random.signed() * 4.0;
            let mixed: Vec<f64> = a.iter().zip(&other).map(|(a, other)| factor * a + other).collect();
            for (got, [first, second]) in [
                (product(&mixed, &b), [product(&a, &b), product(&other, &b)]),
                (product(&b, &mixed), [product(&b, &a), product(&b, &other)]),
            ] {
                let off: Vec<f64> =
                    got.iter().zip(first.iter().zip(&second)).map(|(got, (a, b))| got - (factor * a + b)).collect();
                let size = (norm(&mixed) + factor.abs() * norm(&a) + norm(&other)) * norm(&b);
                assert!(norm(&off) < 1e-15 * size, "{}: {:e}", function.spec, norm(&off) / size);
            }
            let [a, b] = [a, b].map(|list| list.iter().map(|&x| x as f32).collect::<Vec<f32>>());
            let scaled: Vec<f32> = a.iter().map(|x| x * 1024.0).collect();
            let [once, more] = [&a, &scaled].map(|a| narrow.run(&[a, &b], Contraction::Separate));
            assert!(once.iter().zip(&more).all(|(once, more)| once * 1024.0 == *more), "{}", function.spec);
        }
    }
}

/// An error is measured against the product of the norms: a result of 1 that is off by a millionth, of signals of norm 2
/// and 3.
#[test]
fn the_error_of_a_product_is_relative_to_both_norms() {
    let measure = PRODUCT.measure;
    assert_eq!(measure.error(&[1.0, 2.0, 2.0, 4.0], &[1.0; 4], 2), (1.0f64 + 1.0 + 9.0).sqrt());
    // The bands of samples have norm one, so that the norms of order 3 multiply to 3: a product of norm 1/3 of that at
    // most, a rounding or more for each of its terms.
    let accuracy = &toy("sh3_toy_product").built.accuracy;
    assert!((1e-8..1e-6).contains(&accuracy.measured_f32), "{accuracy:?}");
}
