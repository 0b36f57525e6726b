//! Light in the frame of a surface: coefficients turn with the frame, mirrored or not, and the bases over the hemisphere are
//! made of them as the generator says.

use super::direction;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use zonal::{Error, Frame, project};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::samples::Random;

/// A frame anywhere, and whether it is mirrored.
fn frame(random: &mut Random, is_mirrored: bool) -> Frame<f64> {
    let [x, y, z] = direction(random).to_array();
    // Lengths and a lean, as interpolation leaves them.
    let normal = direction(random) * 1.7;
    Frame::new(normal, [0.4 * x, 0.4 * y, 0.4 * z, if is_mirrored { -1.0 } else { 1.0 }])
}

/// Directions with radiance and a solid angle each.
fn light(random: &mut Random, count: usize) -> Vec<([f64; 3], [f64; 3], f64)> {
    let sample = |random: &mut Random| {
        let radiance = [0; 3].map(|_| 1.0 + random.signed());
        (direction(random).to_array(), radiance, 4.0 * PI / count as f64)
    };
    (0..count).map(|_| sample(random)).collect()
}

#[test]
fn frames_are_three_unit_vectors_of_the_hand_that_they_are_told() {
    let mut random = Random::new(31);
    for trial in 0..40 {
        let is_mirrored = trial % 2 == 1;
        let frame = frame(&mut random, is_mirrored);
        let axes = [frame.tangent, frame.bitangent, frame.normal].map(DVec3::from_array);
        let matrix = DMat3::from_cols(axes[0], axes[1], axes[2]);
        assert!((matrix.determinant() - if is_mirrored { -1.0 } else { 1.0 }).abs() < 1e-12);
        assert!((matrix.transpose() * matrix).abs_diff_eq(DMat3::IDENTITY, 1e-12));
        let v = direction(&mut random);
        let local = frame.to_local(v);
        assert!(DVec3::from_array(local).abs_diff_eq(matrix.transpose() * v, 1e-12));
        assert!(DVec3::from_array(frame.to_world(local)).abs_diff_eq(v, 1e-12));
    }
}

#[test]
fn coefficients_in_a_frame_are_those_of_the_world_turned_into_it() {
    let mut random = Random::new(32);
    for is_mirrored in [false, true] {
        for _ in 0..10 {
            let frame = frame(&mut random, is_mirrored);
            let light = light(&mut random, 50);
            let world: [[f64; 3]; 25] = project::samples(light.iter().copied());
            let local: [[f64; 3]; 25] = project::in_frame(&frame, light.iter().copied());
            for _ in 0..5 {
                let v = direction(&mut random);
                let [a, b] = [zonal::evaluate(v, &world), zonal::evaluate(frame.to_local(v), &local)];
                // Sums of 50 products of order 5, each rounded a few times.
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-12), "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn bases_over_the_hemisphere_are_the_generator_s() {
    let run = |spec: &str, inputs: &[&[f64]]| {
        let spec: Spec = spec.parse().expect("a spec");
        Program::<f64>::new(&Listing::new(&spec.kernel())).run(inputs, Contraction::Separate)
    };
    let mut random = Random::new(33);
    let frame = frame(&mut random, true);
    let light = light(&mut random, 40);
    let five: [[f64; 3]; 25] = project::in_frame(&frame, light.iter().copied());
    let three: [[f64; 3]; 9] = project::in_frame(&frame, light.iter().copied());
    let channel = |c: &[[f64; 3]]| -> Vec<f64> { c.iter().map(|c| c[1]).collect() };
    let cases = [
        ("sh3_to_h4", &three[..], zonal::h4(&three).to_vec()),
        ("sh3_to_h6", &three, zonal::h6(&three).to_vec()),
        ("sh3_to_hl2", &three, zonal::hl2(&three).to_vec()),
        ("sh5_to_h4", &five, zonal::h4(&five).to_vec()),
        ("sh5_to_h6", &five, zonal::h6(&five).to_vec()),
    ];
    for (spec, radiance, found) in cases {
        let wanted = run(spec, &[&channel(radiance)]);
        assert_eq!(channel(&found), wanted, "{spec}");
    }
    let normal = [0.1, -0.2, 0.9];
    let [h4, h6, hl2] = [zonal::h4(&five).to_vec(), zonal::h6(&five).to_vec(), zonal::hl2(&three).to_vec()];
    let values = [
        ("h4_eval:shared", &h4, zonal::h4_at(normal, &zonal::h4(&five))),
        ("h6_eval:shared", &h6, zonal::h6_at(normal, &zonal::h6(&five))),
        ("hl2_eval", &hl2, zonal::hl2_at(normal, &zonal::hl2(&three))),
    ];
    for (spec, c, found) in values {
        assert_eq!(run(spec, &[&normal, &channel(c)]), [found[1]], "{spec}");
    }
    // One channel alone by the kernel that is cheaper for it, to the same value but for rounding.
    let green = zonal::h6(&five.map(|c| c[1]));
    let alone: f64 = zonal::h6_at(normal, &green);
    assert_eq!(run("h6_eval", &[&normal, &green]), [alone]);
    assert!((alone - zonal::h6_at(normal, &zonal::h6(&five))[1]).abs() < 1e-13);
}

#[test]
fn hemispherical_harmonics_are_orthonormal_over_the_directions_above() {
    let mut random = Random::new(34);
    let frame = frame(&mut random, true);
    // Products of two of the same m are polynomials in z: rows at the zeros of a Legendre polynomial between the horizon and
    // the normal integrate them exactly, and sixteen columns those of two m.
    let rows: Vec<(f64, f64)> = zonal_codegen::math::quadrature::gauss_legendre(12, 0.0, 1.0).collect();
    let directions: Vec<([f64; 3], f64)> = rows
        .iter()
        .flat_map(|&(z, weight)| {
            (0..16).map(move |i| {
                let (sin, cos) = (2.0 * PI * f64::from(i) / 16.0).sin_cos();
                let radius = (1.0 - z * z).sqrt();
                ([radius * cos, radius * sin, z], weight * 2.0 * PI / 16.0)
            })
        })
        .collect();
    let basis: Spec = "hsh_basis:4".parse().expect("a spec");
    let basis = Program::<f64>::new(&Listing::new(&basis.kernel()));
    for i in 0..16 {
        let sample = |(local, weight): &([f64; 3], f64)| {
            (frame.to_world(*local), basis.run(&[local], Contraction::Separate)[i], *weight)
        };
        // What lies below the horizon changes nothing.
        let below = [(frame.to_world([0.0, 0.6, -0.8]), 5.0, 1.0)];
        let c: [f64; 16] = project::on_hemisphere(&frame, directions.iter().map(sample).chain(below));
        for (j, c) in c.iter().enumerate() {
            let wanted = if i == j { 1.0 } else { 0.0 };
            assert!((c - wanted).abs() < 1e-12, "{i} {j}: {c}");
        }
    }
}

#[test]
fn slices_are_filled_frame_by_frame_on_any_number_of_threads() {
    let mut random = Random::new(35);
    let frames: Vec<Frame<f32>> = (0..30)
        .map(|i| {
            let frame = frame(&mut random, i % 2 == 0);
            let narrow = |v: [f64; 3]| v.map(|x| x as f32);
            let [x, y, z] = narrow(frame.tangent);
            Frame::new(narrow(frame.normal), [x, y, z, 1.0])
        })
        .collect();
    let light: Vec<([f32; 3], [f32; 3], f32)> = light(&mut random, 100)
        .into_iter()
        .map(|(direction, radiance, weight)| (direction.map(|x| x as f32), radiance.map(|x| x as f32), weight as f32))
        .collect();
    let samples = |i: usize| light[i..].iter().copied();
    let one = |frame: &Frame<f32>, light| -> [[f32; 3]; 6] {
        let radiance: [[f32; 3]; 25] = project::in_frame(frame, light);
        zonal::h6(&radiance)
    };
    let (mut found, mut threaded) = (vec![[[0.0; 3]; 6]; 30], vec![[[0.0; 3]; 6]; 30]);
    project::in_frames(&frames, samples, one, &mut found).expect("as many");
    project::parallel::in_frames(&frames, samples, one, &mut threaded).expect("as many");
    assert_eq!(found, threaded);
    assert_eq!(found[7], one(&frames[7], samples(7)));
    let error = project::in_frames(&frames, samples, one, &mut found[1..]).expect_err("one fewer");
    assert_eq!(error, Error::Frames { frames: 30, results: 29 });
    assert_eq!(error.to_string(), "30 frames, but room for 29 results");
    assert_eq!(project::parallel::in_frames(&frames, samples, one, &mut found[1..]), Err(error));
}
