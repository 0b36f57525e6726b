//! Conventions in the runtime, which has them as a generated table of numbers: against the generator's exact ones, which
//! `conventions.rs` holds to the formulas that programs publish, and against what a change of axes means.

use super::{TRIALS, direction, narrow, signal, wide};
use zonal::Error;
use zonal::conventions::{self, Axis};
use zonal_codegen::math::convention::{ALL, Axes, named};
use zonal_codegen::promise::samples::Random;
use zonal_tests::band_error;

/// All 48 frames, in the runtime's words and the generator's.
fn frames() -> Vec<([Axis; 3], Axes)> {
    let axes = [
        (Axis::X, "x"),
        (Axis::Y, "y"),
        (Axis::Z, "z"),
        (Axis::MinusX, "-x"),
        (Axis::MinusY, "-y"),
        (Axis::MinusZ, "-z"),
    ];
    let pairs = axes.iter().flat_map(|a| axes.iter().map(move |b| (a, b)));
    let triples = pairs.flat_map(|(a, b)| axes.iter().map(move |c| [a, b, c]));
    triples
        .filter_map(|triple| {
            let text = triple.map(|(_, name)| *name).join(",");
            Some((triple.map(|(axis, _)| *axis), text.parse().ok()?))
        })
        .collect()
}

#[test]
fn a_signal_of_another_frame_has_its_values_there() {
    let mut random = Random::new(101);
    let frames = frames();
    assert_eq!(frames.len(), 48);
    for (axes, known) in frames {
        let dir = direction(&mut random).to_array();
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let there = zonal::to_axes(&c, axes).expect("a frame");
            let (want, got) = (zonal::evaluate(dir, &c), zonal::evaluate(known.from_zonal(dir), &there));
            assert!((want - got).abs() < 1e-12, "order {} to {known}: {got}, not {want}", N.isqrt());
            let back = zonal::from_axes(&there, axes).expect("a frame");
            assert!(band_error(&back, &c) < 1e-14, "order {} to {known} and back", N.isqrt());
        });
    }
}

#[test]
fn axes_that_are_no_frame_are_refused() {
    let c = [1.0_f32; 9];
    for axes in [[Axis::X, Axis::X, Axis::Y], [Axis::Y, Axis::Z, Axis::MinusY], [Axis::Z, Axis::Y, Axis::Y]] {
        assert_eq!([zonal::to_axes(&c, axes), zonal::from_axes(&c, axes)], [Err(Error::Axes(axes)); 2]);
        assert_eq!(Error::Axes(axes).to_string(), format!("{axes:?} are not three different axes"));
    }
}

#[test]
fn the_table_is_the_generators() {
    let names: Vec<&str> = conventions::ALL.iter().map(|convention| convention.name).collect();
    assert_eq!(names, ALL.iter().map(|convention| convention.name).collect::<Vec<_>>());
    let frames = frames();
    let mut random = Random::new(103);
    for convention in conventions::ALL {
        let known = named(convention.name).expect("the same names");
        let frame = frames.iter().find(|(axes, _)| *axes == convention.axes).expect("a frame");
        assert_eq!((frame.1, convention.max_order), (known.axes, known.max_order.min(10)), "{}", convention.name);
        every_order!(N, {
            let (order, c) = (N.isqrt(), signal::<N>(&mut random));
            let there = zonal::to_convention(&c, convention);
            if order > convention.max_order {
                let error = there.expect_err("too many bands");
                assert_eq!(Err(error), zonal::from_convention(&c, convention));
                let words = error.to_string();
                assert!(words.contains(&format!("takes {} bands, not {order}", convention.max_order)), "{words}");
            } else {
                let there = there.expect("few enough bands");
                let want: Vec<f64> = known.convert_to(&c.map(|c| [c])).into_iter().flatten().collect();
                // Factors are up to 3.6; a number is rounded after J, and once by its factor.
                let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-13);
                assert!(close(&there, &want), "{}, order {order}: {there:?}, not {want:?}", convention.name);
                let back = zonal::from_convention(&there, convention).expect("the same bands");
                assert!(close(&back, &c), "{}, order {order} and back", convention.name);
                let rgb = zonal::to_convention(&narrow(&c).map(|c| [c, 2.0 * c, 0.0]), convention).expect("as many");
                let in_f32 = wide(&rgb.map(|c| c[1]));
                assert!(in_f32.iter().zip(&want).all(|(a, b)| (a - 2.0 * b).abs() < 1e-5), "{}", convention.name);
            }
        });
    }
}

/// three.js's `getIrradianceAt`, whose constants Ramamoorthi and Hanrahan 2001 print, of what comes from here.
#[test]
fn three_js_lights_with_what_it_is_given() {
    let mut random = Random::new(107);
    for _ in 0..TRIALS {
        let (radiance, [x, y, z]) = (signal::<9>(&mut random), direction(&mut random).to_array());
        let c = zonal::to_convention(&radiance, &conventions::THREE_JS).expect("order 3");
        let seen = c[0] * 0.886227
            + 2.0 * 0.511664 * (c[1] * y + c[2] * z + c[3] * x)
            + 2.0 * 0.429043 * (c[4] * x * y + c[5] * y * z + c[7] * x * z)
            + c[6] * (0.743125 * z * z - 0.247708)
            + c[8] * 0.429043 * (x * x - y * y);
        // Their y is zonal's z, and their z is zonal's −y; their constants have six digits.
        let want = zonal::irradiance_at([x, -z, y], &radiance);
        assert!((seen - want).abs() < 1e-5, "{seen}, not {want}");
    }
}
