//! Two properties of `properties.rs`, of families whose results are no signal: that zonal coefficients are those of the
//! function that the record has, and that what is found of a signal turns with it.

use crate::properties::{COUNT, ROUNDING, Tried, difference, ensure};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::kernel::{Domain, Param};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::{Random, inputs, matrix_of};
use zonal_tests::turns::{Sphere, apply};
use zonal_tests::{Runner, norm};

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

/// What is found of coefficients turns as they do: the direction that the record says, while the other numbers stay; where it
/// says none and as many numbers are found, all of them do.
pub(crate) fn what_is_found_turns_with_the_signal(spec: &Spec) -> Tried {
    let params = spec.code().params().to_vec();
    if !matches!(params[..], [Param { domain: Domain::Coefficients, .. }]) {
        return Ok(false);
    }
    let (runner, sphere, mut random) = (Runner::<f64>::new(spec), Sphere::new(spec.order), Random::new(5));
    // The first is nothing, of which a direction is found that does not turn.
    for input in inputs(&params, 73, COUNT, None).into_iter().skip(1) {
        let matrix = matrix_of(random.unit());
        let (found, turned) = (runner.run(&input), runner.run(&[sphere.turned(&matrix, &input[0])]));
        let want = match spec.family.direction {
            Some(at) => {
                let (before, rest) = found.split_at(at);
                let length = (norm(&rest[..3]) - 1.0).abs();
                ensure(length <= ROUNDING, || format!("{length:e} too long at {input:?}"))?;
                [before, &apply(&matrix, &rest[..3]), &rest[3..]].concat()
            }
            None => sphere.turned(&matrix, &found),
        };
        let error = difference(&turned, &want) / norm(&want);
        ensure(error <= ROUNDING * 10.0, || format!("{error:e} at {input:?}"))?;
    }
    Ok(true)
}
