//! Three properties of `properties.rs`, of families whose results are no signal: that zonal coefficients are those of the
//! function that the record has, that what is found of a signal turns with it, and that a basis turns about z as its
//! coefficients do.

use crate::properties::{COUNT, ROUNDING, Tried, difference, ensure};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::kernel::{Domain, Param, Shape};
use zonal_codegen::math::index::index;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::{Random, inputs, matrix_of};
use zonal_tests::turns::{Sphere, apply};
use zonal_tests::{Runner, norm};

/// The n² values at a direction are those at another one about z, each pair of m and −m turned by m times the angle: of bases of
/// the sphere and of the hemisphere alike.
pub(crate) fn a_basis_turns_about_z(spec: &Spec) -> Tried {
    let (code, order) = (spec.code(), spec.order);
    let is_basis = matches!(code.params(), [Param { domain: Domain::Direction, .. }]);
    if !is_basis || code.result().0 != Shape::Array(order * order) {
        return Ok(false);
    }
    let runner = Runner::<f64>::new(spec);
    let (cos, sin) = (0.6, 0.8);
    for input in inputs(code.params(), 79, COUNT, None) {
        let [x, y, z] = input[0][..] else { panic!("a direction has three numbers") };
        let (values, got) = (runner.run(&input), runner.run(&[vec![cos * x - sin * y, sin * x + cos * y, z]]));
        let mut want = values.clone();
        let mut multiple = (cos, sin);
        for m in 1..order as isize {
            for l in m as usize..order {
                let [plus, minus] = [m, -m].map(|m| index(l, m));
                want[plus] = multiple.0 * values[plus] - multiple.1 * values[minus];
                want[minus] = multiple.0 * values[minus] + multiple.1 * values[plus];
            }
            multiple = (multiple.0 * cos - multiple.1 * sin, multiple.0 * sin + multiple.1 * cos);
        }
        let error = difference(&got, &want);
        ensure(error <= ROUNDING * norm(&want), || format!("{error:e} off at {input:?}"))?;
    }
    Ok(true)
}

/// The zonal coefficients are the integrals of the function that the record has, times the harmonics of m = 0 as Legendre's
/// recurrence gives them.
pub(crate) fn it_is_the_function_that_it_says(spec: &Spec) -> Tried {
    let Some(function) = spec.family.zonal else { return Ok(false) };
    let (runner, order) = (Runner::<f64>::new(spec), spec.order);
    for input in inputs(spec.code().params(), 71, COUNT, None) {
        let want = integrals(order, (function.reach)(&input), |short| (function.value)(&input, short));
        let (got, size) = (runner.run(&input), want.iter().fold(0.0, |most: f64, x| most.max(x.abs())));
        // Where there is no number, the function is one in a direction alone.
        if want.iter().all(|x| x.is_finite()) {
            let error = difference(&got, &want);
            ensure(error <= (ROUNDING + function.error) * size, || {
                format!("{error:e} of {size:e} at {input:?}: {got:?}, {want:?}")
            })?;
        }
    }
    Ok(true)
}

/// 2π K_l ∫ f P_l, over panels that halve towards both ends.
fn integrals(order: usize, reach: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut sums = vec![0.0; order];
    let ends: Vec<f64> = (0..60).map(|k| reach / 2.0 * 0.5f64.powi(k)).chain([0.0]).collect();
    let near = ends.windows(2).map(|pair| (pair[1], pair[0]));
    let far = ends.windows(2).map(|pair| (reach - pair[0], reach - pair[1]));
    for (from, to) in near.chain(far).filter(|(from, to)| from < to) {
        for (short, weight) in gauss_legendre(16, from, to) {
            let value = weight * f(short);
            let (mut before, mut legendre) = (0.0, 1.0);
            for (l, sum) in sums.iter_mut().enumerate() {
                *sum += std::f64::consts::PI.sqrt() * ((2 * l + 1) as f64).sqrt() * value * legendre;
                let l = l as f64;
                let next = ((2.0 * l + 1.0) * (1.0 - short) * legendre - l * before) / (l + 1.0);
                (before, legendre) = (legendre, next);
            }
        }
    }
    sums
}

/// Coefficients of whole bands, turned, and what follows them as it is: numbers about the signal's own axis.
fn turned(sphere: &Sphere, matrix: &[f64; 9], list: &[f64]) -> Vec<f64> {
    let (bands, rest) = list.split_at(list.len().isqrt().pow(2));
    [&sphere.turned(matrix, bands)[..], rest].concat()
}

/// What is found of coefficients turns as they do: the direction that the record says, while the other numbers stay; where it
/// says none and as many numbers are found, all of them do. A value at a direction stays where that turns too.
pub(crate) fn what_is_found_turns_with_the_signal(spec: &Spec) -> Tried {
    let params = spec.code().params().to_vec();
    let is_at = match params[..] {
        [Param { domain: Domain::Coefficients, .. }] => false,
        [Param { domain: Domain::Direction, .. }, Param { domain: Domain::Coefficients, .. }] => true,
        _ => return Ok(false),
    };
    let (runner, sphere, mut random) = (Runner::<f64>::new(spec), Sphere::new(spec.order), Random::new(5));
    // The first is nothing, of which a direction is found that does not turn.
    for input in inputs(&params, 73, COUNT, None).into_iter().skip(1) {
        let matrix = matrix_of(random.unit());
        let mut other: Vec<Vec<f64>> = input.clone();
        if let (true, [dir, _]) = (is_at, &mut other[..]) {
            *dir = apply(&matrix, dir).to_vec();
        }
        let last = other.last_mut().expect("there are coefficients");
        *last = turned(&sphere, &matrix, last);
        let (found, after) = (runner.run(&input), runner.run(&other));
        let want = match spec.family.direction {
            _ if is_at => found,
            Some(at) => {
                let (before, rest) = found.split_at(at);
                let length = (norm(&rest[..3]) - 1.0).abs();
                ensure(length <= ROUNDING, || format!("{length:e} too long at {input:?}"))?;
                [before, &apply(&matrix, &rest[..3]), &rest[3..]].concat()
            }
            None => turned(&sphere, &matrix, &found),
        };
        let error = difference(&after, &want) / norm(&want);
        ensure(error <= ROUNDING * 10.0, || format!("{error:e} at {input:?}"))?;
    }
    Ok(true)
}
