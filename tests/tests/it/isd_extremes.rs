//! What the kernels of isotropic decomposition, of shading, of coupled lobes and of gradients give of what makes no sense, and of
//! nothing (docs/MATH.md#isotropic-decomposition): no number where a number is none, zero of no light, and a finite slice and
//! result for a view at or below the horizon.

use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_tests::{Runner, norm, spec};

/// A kernel of every family, and which of its parameters is the light; of lobes and gradients too it makes the result linear.
const KERNELS: [(&str, &str); 12] = [
    ("isd_matrix:4", "lambda"),
    ("isd_weights:4", "c"),
    ("isd_shade:4", "e"),
    ("isd_shade_zonal:4", "g"),
    ("shade:3", "e"),
    ("shade:5", "e"),
    ("shade_isotropic:5", "e"),
    ("shade_zonal:5", "g"),
    ("zhf_dot:4", "w"),
    ("zhf_dot_lobes:4", "v"),
    ("hsh_gradient:3", "light"),
    ("hsh_gradient:6", "light"),
];

/// A value that makes sense.
fn sound(param: &Param) -> Vec<f64> {
    match (param.name, param.shape) {
        ("q", _) => vec![0.1, -0.5, 0.7, 0.5],
        ("m", Shape::Vec3) => vec![0.0, -0.6, -0.8],
        (_, Shape::Vec3) => vec![0.48, 0.6, 0.64],
        (_, shape) => (0..shape.len()).map(|i| 0.5 + 0.1 * (i % 7) as f64).collect(),
    }
}

#[test]
fn what_is_not_a_number_makes_none_and_no_light_makes_nothing() {
    for (text, light) in KERNELS {
        let params = spec(text).kernel().params;
        let (wide, narrow) = (Runner::<f64>::new(&spec(text)), Runner::<f32>::new(&spec(text)));
        let inputs: Vec<Vec<f64>> = params.iter().map(sound).collect();
        assert!(norm(&wide.run(&inputs)) > 0.0, "{text}");
        for (at, param) in params.iter().enumerate() {
            for number in 0..param.shape.len() {
                let mut inputs = inputs.clone();
                inputs[at][number] = f64::NAN;
                // In the tangent plane the height is not looked at.
                let is_left_out = text.starts_with("hsh_gradient") && param.name == "e" && number == 2;
                for found in [wide.run(&inputs), narrow.run(&inputs)] {
                    let is_finite = found.iter().all(|x| x.is_finite());
                    assert_eq!(is_finite, is_left_out, "{text}: {}[{number}]: {found:?}", param.name);
                }
            }
            if param.name == light {
                let mut inputs = inputs.clone();
                inputs[at].fill(0.0);
                for found in [wide.run(&inputs), narrow.run(&inputs)] {
                    assert!(found.iter().all(|x| *x == 0.0), "{text}: {found:?} without light");
                }
            }
        }
        assert!(params.iter().any(|param| param.name == light), "{text}");
    }
}

/// A view below the horizon counts as grazing: its slice is finite, no larger than that of others by far, and shades so.
#[test]
fn views_at_and_below_the_horizon_shade_to_what_is_finite() {
    let mut dice = Random::new(2);
    for brdf in ["lambert", "phong:20", "ward:0.3", "ward:0.25:0.6"] {
        let brdf: Brdf = brdf.parse().expect("a reflectance");
        let straight = norm(&brdf.coefficients([0.0, 0.0, 1.0], 5));
        for view in [[1.0, 0.0, 0.0], [0.8, 0.6, 0.0], [0.6, 0.0, -0.8], [0.0, 0.0, -1.0], [0.999_999, 0.001, 1e-9]] {
            let c = brdf.coefficients(view, 5);
            assert!(c.iter().all(|x| x.is_finite()) && norm(&c) < 4.0 * straight, "{brdf} {view:?}: {c:?}");
            let even: Vec<f64> =
                (0..5).flat_map(|l: usize| (0..=l).map(move |m| l * (l + 1) + m)).map(|i| c[i]).collect();
            let lambda = Runner::<f64>::new(&spec("isd_weights:5")).run(std::slice::from_ref(&c));
            let (q, e) = (dice.unit::<4>().to_vec(), (0..25).map(|_| dice.signed()).collect::<Vec<f64>>());
            let last = [("shade:5", c.clone()), ("shade_isotropic:5", even), ("isd_shade:5", lambda)];
            for (text, last) in last {
                let found = Runner::<f32>::new(&spec(text)).run(&[q.clone(), e.clone(), last])[0];
                // A turn leaves norms as they are.
                assert!(found.abs() <= 1.001 * norm(&c) * norm(&e), "{text} of {brdf} at {view:?}: {found}");
            }
        }
        // A light is none from below, whatever the view.
        assert_eq!(brdf.value([0.6, 0.0, 0.8], [0.6, 0.0, -0.8]), 0.0);
        assert_eq!(brdf.value([0.6, 0.0, -0.8], [0.6, 0.0, 0.8]), 0.0);
    }
}
