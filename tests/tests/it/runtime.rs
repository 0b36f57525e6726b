//! What the crate `zonal` promises: golden values through glam's types, one meaning whatever the order, the precision
//! and the channels, agreement between the ways to do one thing, and what bad input can do.

use glam::{DMat3, DQuat, DVec3, Mat3, Quat, Vec3, Vec3A, Vec4};
use serde_json::Value;
use zonal::Rotation;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{band_error, golden, norm, numbers};

/// Repeats a block for every order, whose coefficients it counts.
macro_rules! every_order {
    ($count:ident, $body:block) => {
        every_order!(@ $count $body 4 9 16 25 36 49 64 81 100)
    };
    (@ $count:ident $body:block) => {};
    (@ $count:ident $body:block $first:literal $($more:literal)*) => {
        {
            const $count: usize = $first;
            $body
        }
        every_order!(@ $count $body $($more)*)
    };
}

mod arithmetic;
mod batch;
mod conventions;
mod dependents;
mod light;
mod project;
mod surface;

const TRIALS: usize = 40;

fn wide<T: Copy + Into<f64>>(values: &[T]) -> Vec<f64> {
    values.iter().map(|&x| x.into()).collect()
}

/// A signal each band of which has the norm one.
fn signal<const N: usize>(random: &mut Random) -> [f64; N] {
    let mut c = [0.0; N];
    for l in 0..N.isqrt() {
        let band = &mut c[l * l..(l + 1) * (l + 1)];
        band.iter_mut().for_each(|x| *x = random.signed());
        let length = norm(band);
        band.iter_mut().for_each(|x| *x /= length);
    }
    c
}

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.unit())
}

fn quaternion(random: &mut Random) -> DQuat {
    DQuat::from_array(random.unit())
}

fn narrow<const N: usize>(c: &[f64; N]) -> [f32; N] {
    c.map(|x| x as f32)
}

/// The golden rotations: the quaternion and the matrices of the bands.
fn rotations() -> Vec<(DQuat, Vec<Vec<Vec<f64>>>)> {
    let rows = |band: &Value| band.as_array().expect("rows").iter().map(numbers).collect();
    let file = golden("rotations");
    let cases = file["cases"].as_array().expect("cases");
    cases
        .iter()
        .map(|case| {
            let q = numbers(&case["quat_wxyz"]);
            let bands = case["D"].as_array().expect("bands").iter().map(rows).collect();
            (DQuat::from_xyzw(q[1], q[2], q[3], q[0]).normalize(), bands)
        })
        .collect()
}

fn turned(bands: &[Vec<Vec<f64>>], c: &[f64]) -> Vec<f64> {
    let rows = (0..c.len().isqrt()).flat_map(|l| bands[l].iter().map(move |row| (l, row)));
    rows.map(|(l, row)| row.iter().zip(&c[l * l..]).map(|(a, b)| a * b).sum()).collect()
}

#[test]
fn the_basis_is_the_golden_one() {
    let file = golden("basis");
    for case in file["cases"].as_array().expect("cases") {
        let (dir, want) = (DVec3::from_slice(&numbers(&case["unit"])), numbers(&case["y"]));
        every_order!(N, {
            let y: [f64; N] = zonal::evaluate_basis(dir);
            assert!(band_error(&y, &want[..N]) <= 1e-14, "order {} at {dir}", N.isqrt());
            let y: [f32; N] = zonal::evaluate_basis(dir.as_vec3());
            assert!(band_error(&wide(&y), &want[..N]) <= 2e-6, "order {} at {dir} in f32", N.isqrt());
            let c = signal::<N>(&mut Random::new(2));
            let sum: f64 = c.iter().zip(&want).map(|(c, y)| c * y).sum();
            assert!((zonal::evaluate(dir, &c) - sum).abs() <= 1e-13, "order {} at {dir}", N.isqrt());
        });
    }
}

#[test]
fn rotations_are_the_golden_ones_by_every_way_in() {
    let mut random = Random::new(3);
    for (q, bands) in rotations() {
        every_order!(N, {
            let (order, c) = (N.isqrt(), signal::<N>(&mut random));
            let want = turned(&bands, &c);
            let m = DMat3::from_quat(q);
            let ways = [
                zonal::rotate(q, &c),
                zonal::rotate_matrix(m.to_cols_array_2d(), &c),
                Rotation::<[f64; N]>::new(q).apply(&c),
            ];
            for got in ways {
                assert!(band_error(&got, &want) <= 2e-14, "order {order} by {q}");
            }
            let (q, m, c) = (q.as_quat(), Mat3::from_quat(q.as_quat()), narrow(&c));
            let bound = if order <= 8 { 2e-6 } else { 3e-6 };
            assert!(band_error(&wide(&zonal::rotate(q, &c)), &want) <= bound, "order {order} by {q} in f32");
            let ready = Rotation::<[f32; N]>::new(q).apply(&c);
            assert!(band_error(&wide(&ready), &want) <= bound, "order {order} by {q} in f32, made ready");
            // glam's matrix and its quaternion are rounded once more.
            let by_matrix = zonal::rotate_matrix(m.to_cols_array_2d(), &c);
            assert!(band_error(&wide(&by_matrix), &want) <= 2.0 * bound, "order {order} by {m} in f32");
        });
    }
}

/// Every fourth of the quaternion's components is the largest of some rotation, half turns about the axes among them.
#[test]
fn a_matrix_of_any_rotation_is_taken() {
    let mut random = Random::new(29);
    let half = std::f64::consts::PI;
    let turns = [DQuat::from_rotation_x(half), DQuat::from_rotation_y(half), DQuat::from_rotation_z(half)];
    let near = |q: DQuat, random: &mut Random| (q + quaternion(random) * 1e-9).normalize();
    let mut all: Vec<DQuat> = turns.to_vec();
    all.extend(turns.map(|q| near(q, &mut random)));
    all.push(DQuat::IDENTITY);
    all.extend((0..TRIALS).map(|_| quaternion(&mut random)));
    for q in all {
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let columns = DMat3::from_quat(q).to_cols_array_2d();
            let want = zonal::rotate(q, &c);
            assert!(band_error(&zonal::rotate_matrix(columns, &c), &want) <= 2e-14, "order {} by {q}", N.isqrt());
            let ready = Rotation::<[f64; N]>::from_matrix(columns).apply(&c);
            assert!(band_error(&ready, &want) <= 2e-14, "order {} by {q}, made ready", N.isqrt());
        });
    }
}

/// What converts into an array is that array, to the last bit.
#[test]
fn vectors_of_other_crates_are_arrays() {
    let mut random = Random::new(31);
    for _ in 0..TRIALS {
        let (q, n) = (quaternion(&mut random).as_quat(), direction(&mut random).as_vec3());
        let [x, y, z] = n.to_array();
        every_order!(N, {
            let c = narrow(&signal::<N>(&mut random));
            let value = zonal::evaluate([x, y, z], &c);
            let vector = mint::Vector3 { x, y, z };
            assert_eq!([zonal::evaluate(n, &c), zonal::evaluate(Vec3A::from(n), &c)], [value; 2]);
            assert_eq!([zonal::evaluate(vector, &c), zonal::evaluate((x, y, z), &c)], [value; 2]);
            let turned = zonal::rotate(q.to_array(), &c);
            assert_eq!([zonal::rotate(q, &c), zonal::rotate(mint::Quaternion::from(q.to_array()), &c)], [turned; 2]);
            let m = Mat3::from_quat(q).to_cols_array_2d();
            assert_eq!(zonal::rotate_matrix(mint::ColumnMatrix3::from(m), &c), zonal::rotate_matrix(m, &c));

            let rgb = c.map(|c| [c, 2.0 * c, 3.0 * c]);
            let turned = zonal::rotate(q, &rgb);
            assert_eq!(zonal::rotate(q, &rgb.map(Vec3::from_array)), turned.map(Vec3::from_array));
            assert_eq!(zonal::rotate(q, &rgb.map(Vec3A::from_array)), turned.map(Vec3A::from_array));
            assert_eq!(zonal::rotate(q, &rgb.map(mint::Vector3::from)), turned.map(mint::Vector3::from));
            let rgba = rgb.map(|[r, g, b]| Vec4::new(r, g, b, 1.0));
            assert_eq!(zonal::rotate(q, &rgba).map(|v| v.truncate().to_array()), turned);
        });
    }
}

#[test]
fn a_rotated_signal_has_its_values_where_they_were_taken() {
    let mut random = Random::new(5);
    for _ in 0..TRIALS {
        let (q, dir) = (quaternion(&mut random), direction(&mut random));
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let (before, after) = (zonal::evaluate(dir, &c), zonal::evaluate(q * dir, &zonal::rotate(q, &c)));
            assert!((before - after).abs() <= 1e-12, "order {} by {q}", N.isqrt());
        });
    }
}

#[test]
fn fixed_rotations_are_the_general_one() {
    let mut random = Random::new(7);
    for _ in 0..TRIALS {
        let (angle, dir) = (4.0 * random.signed(), direction(&mut random));
        let quarter = std::f64::consts::FRAC_PI_2;
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let about_x = |angle| zonal::rotate(DQuat::from_rotation_x(angle), &c);
            let about_z = zonal::rotate(DQuat::from_rotation_z(angle), &c);
            assert!(band_error(&zonal::rotate_z(angle, &c), &about_z) <= 2e-14);
            let about_y = zonal::rotate(DQuat::from_rotation_y(angle), &c);
            assert!(band_error(&zonal::rotate_y(angle, &c), &about_y) <= 2e-14);
            assert!(band_error(&zonal::rotate_x_plus_90(&c), &about_x(quarter)) <= 2e-14);
            assert!(band_error(&zonal::rotate_x_minus_90(&c), &about_x(-quarter)) <= 2e-14);
            let swapped = zonal::swap_yz(&c);
            let there = zonal::evaluate(DVec3::new(dir.x, dir.z, dir.y), &swapped);
            assert!((there - zonal::evaluate(dir, &c)).abs() <= 1e-12);
            assert!(band_error(&zonal::swap_yz(&swapped), &c) <= 2e-15);
        });
    }
}

#[test]
fn normals_take_z_with_them() {
    let mut random = Random::new(11);
    for _ in 0..TRIALS {
        let n = direction(&mut random);
        let small = DVec3::new(0.05 * n.x, 0.05 * n.y, 1.0).normalize();
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let z = zonal::evaluate(DVec3::Z, &c);
            assert!((zonal::evaluate(n, &zonal::align(n, &c)) - z).abs() <= 1e-12, "order {} to {n}", N.isqrt());
            let want = zonal::rotate(DQuat::from_rotation_arc(DVec3::Z, small), &c);
            let tilted = zonal::tilt(small, &c);
            assert!(band_error(&tilted[..9.min(N)], &want[..9.min(N)]) <= 2e-14, "bands 1 and 2 to {small}");
            // (l b)³ / 24 is the error law of the shears, docs/MATH.md#three-shears.
            let law = (N.isqrt() as f64 * 0.05).powi(3) / 24.0;
            assert!(band_error(&tilted, &want) <= law, "order {} to {small}", N.isqrt());
        });
    }
}

#[test]
fn a_zonal_signal_is_a_signal() {
    let mut random = Random::new(13);
    for _ in 0..TRIALS {
        let dir = direction(&mut random);
        every_order!(N, {
            const ORDER: usize = N.isqrt();
            let g: [f64; ORDER] = std::array::from_fn(|_| random.signed());
            let mut c = [0.0; N];
            (0..ORDER).for_each(|l| c[l * (l + 1)] = g[l]);
            let got: [f64; N] = zonal::rotate_zonal(dir, &g);
            assert!(band_error(&got, &zonal::align(dir, &c)) <= 2e-14, "order {ORDER} to {dir}");
        });
    }
}

#[test]
fn channels_share_one_rotation() {
    let mut random = Random::new(17);
    for _ in 0..TRIALS {
        let (q, n) = (quaternion(&mut random).as_quat(), direction(&mut random).as_vec3());
        every_order!(N, {
            let channels: [[f32; N]; 3] = std::array::from_fn(|_| narrow(&signal::<N>(&mut random)));
            let rgb: [Vec3; N] = std::array::from_fn(|i| Vec3::from_array(channels.map(|channel| channel[i])));
            let rgba: [[f32; 4]; N] = rgb.map(|v| [v.x, v.y, v.z, 1.0]);
            let (turned, tilted, value) = (zonal::rotate(q, &rgb), zonal::tilt(n, &rgb), zonal::evaluate(n, &rgb));
            assert_eq!(zonal::rotate(q, &rgba).map(|v| [v[0], v[1], v[2]]), turned.map(|v| v.to_array()));
            let ready = Rotation::<[f32; N]>::new(q);
            for (i, c) in channels.iter().enumerate() {
                // Order 3 has a way for one channel and another for three.
                let (one, three) = (wide(&zonal::rotate(q, c)), wide(&turned.map(|v| v[i])));
                assert!(if N == 9 { band_error(&three, &one) <= 2e-6 } else { three == one }, "{three:?} by {q}");
                assert_eq!(zonal::tilt(n, c), tilted.map(|v| v[i]));
                assert_eq!(zonal::evaluate(n, c), value[i]);
                assert_eq!(ready.apply(c), ready.apply(&rgb).map(|v| v[i]));
            }
        });
    }
}

#[test]
fn what_is_written_in_place_has_the_bits_of_what_is_returned() {
    let mut random = Random::new(41);
    for _ in 0..4 {
        let (q, n) = (quaternion(&mut random), direction(&mut random));
        let (q_narrow, n_narrow) = (q.as_quat(), n.as_vec3());
        every_order!(N, {
            let (c, wide) = (narrow(&signal::<N>(&mut random)), signal::<N>(&mut random));
            let rgb: [Vec3; N] = std::array::from_fn(|i| Vec3::new(c[i], wide[i] as f32, c[N - 1 - i]));
            // What is not written is not a number, and equal to nothing.
            let mut to = [f32::NAN; N];
            zonal::rotate_into(q_narrow, &c, &mut to);
            assert_eq!(to, zonal::rotate(q_narrow, &c));
            to = [f32::NAN; N];
            zonal::tilt_into(n_narrow, &c, &mut to);
            assert_eq!(to, zonal::tilt(n_narrow, &c));
            to = [f32::NAN; N];
            zonal::evaluate_basis_into(n_narrow, &mut to);
            assert_eq!(to, zonal::evaluate_basis::<[f32; N]>(n_narrow));
            let mut three = [Vec3::NAN; N];
            zonal::rotate_into(q_narrow, &rgb, &mut three);
            assert_eq!(three, zonal::rotate(q_narrow, &rgb));
            let mut double = [f64::NAN; N];
            zonal::rotate_into(q, &wide, &mut double);
            assert_eq!(double, zonal::rotate(q, &wide));
        });
    }
}

#[test]
fn what_is_not_unit_errs_as_documented() {
    let mut random = Random::new(19);
    for _ in 0..10 * TRIALS {
        let (q, dir, e) = (quaternion(&mut random), direction(&mut random), 0.1 * random.signed());
        every_order!(N, {
            let c = signal::<N>(&mut random);
            let within = |got: &[f64], want: &[f64], bound: &dyn Fn(f64) -> f64, what: &str| {
                for l in 0..N.isqrt() {
                    let range = l * l..(l + 1) * (l + 1);
                    let difference: Vec<f64> = range.map(|i| got[i] - want[i]).collect();
                    assert!(norm(&difference) <= bound(l as f64) + 1e-13, "{what} of order {}, band {l}", N.isqrt());
                }
            };
            let turned = zonal::rotate(q, &c);
            let slope = if N <= 9 { 15.0 } else { 5.0 };
            within(&zonal::rotate(q * (1.0 + e), &c), &turned, &|l| slope * l * e.abs(), "rotate");
            let ready = Rotation::<[f64; N]>::new(q * (1.0 + e)).apply(&c);
            within(&ready, &turned, &|l| 5.0 * l * e.abs(), "Rotation");
            let (e, basis) = (0.1 * e, zonal::evaluate_basis::<[f64; N]>(dir));
            let longer = zonal::evaluate_basis::<[f64; N]>(dir * (1.0 + e));
            within(&longer, &basis, &|l| l * l * e.abs(), "evaluate_basis");
            let sum = (0..N.isqrt()).map(|l| (l * l) as f64 * e.abs()).sum::<f64>();
            let moved = zonal::evaluate(dir * (1.0 + e), &c) - zonal::evaluate(dir, &c);
            assert!(moved.abs() <= sum + 1e-13, "evaluate of order {}", N.isqrt());
        });
    }
}

#[test]
fn nan_goes_where_documented() {
    every_order!(N, {
        let c = [1.0_f32; N];
        let only_band_zero = |got: [f32; N]| got[0] == 1.0 && got[1..].iter().all(|x| x.is_nan());
        for place in 0..4 {
            let mut q = [0.1, 0.2, 0.3, 0.9];
            q[place] = f32::NAN;
            let q = Quat::from_array(q);
            assert!(only_band_zero(zonal::rotate(q, &c)), "order {}", N.isqrt());
            assert!(only_band_zero(Rotation::<[f32; N]>::new(q).apply(&c)), "order {}", N.isqrt());
        }
        for place in 0..3 {
            let mut n = [0.1, 0.2, 0.9];
            n[place] = f32::NAN;
            let n = Vec3::from_array(n);
            assert!(only_band_zero(zonal::align(n, &c)), "order {}", N.isqrt());
            assert!(zonal::evaluate(n, &c).is_nan(), "order {}", N.isqrt());
        }
    });
}

#[test]
fn negated_and_zero_quaternions_do_as_documented() {
    let mut random = Random::new(23);
    for _ in 0..TRIALS {
        let q = quaternion(&mut random).as_quat();
        every_order!(N, {
            let c = narrow(&signal::<N>(&mut random));
            let ready = |q: Quat| Rotation::<[f32; N]>::new(q).apply(&c);
            for [one, other] in [[zonal::rotate(q, &c), zonal::rotate(-q, &c)], [ready(q), ready(-q)]] {
                let error = band_error(&wide(&one), &wide(&other));
                // Each is within its own rounding, a few units a band.
                assert!(error <= 16.0 * N.isqrt() as f64 * f64::from(f32::EPSILON), "order {}: {error}", N.isqrt());
            }
        });
    }
    let none = Quat::from_array([0.0; 4]);
    every_order!(N, {
        let c = [1.0_f32; N];
        let only_band_zero = |got: [f32; N]| got[0] == 1.0 && got[1..].iter().all(|x| x.is_nan());
        assert!(only_band_zero(Rotation::<[f32; N]>::new(none).apply(&c)), "order {}", N.isqrt());
        match N.isqrt() {
            2 | 3 => assert_eq!(zonal::rotate(none, &c), c),
            order => assert!(only_band_zero(zonal::rotate(none, &c)), "order {order}"),
        }
    });
}

#[test]
fn bands_do_not_mix() {
    let q = Quat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize();
    let n = Vec3::new(0.1, -0.2, 0.9).normalize();
    every_order!(N, {
        for (band, bad) in (0..N.isqrt()).zip([f32::NAN, f32::INFINITY].into_iter().cycle()) {
            let mut c = [1.0_f32; N];
            c[band * (band + 1)] = bad;
            let ready = Rotation::<[f32; N]>::new(q);
            let ways = [zonal::rotate(q, &c), ready.apply(&c), zonal::tilt(n, &c), zonal::align(n, &c)];
            for got in ways.into_iter().chain([zonal::swap_yz(&c), zonal::rotate_z(0.3, &c)]) {
                for (i, x) in got.iter().enumerate() {
                    assert!(x.is_finite() || i.isqrt() == band, "order {}: band {band} is in {i}", N.isqrt());
                }
            }
        }
    });
}

#[test]
fn shader_texts_are_the_files() {
    let mut specs = std::collections::BTreeSet::new();
    assert_eq!(zonal::shaders::ALL[0], zonal::shaders::sh2::EVALUATION);
    for file in zonal::shaders::ALL {
        for (spec, name) in file.kernels {
            assert!(file.wgsl.contains(&format!("fn {name}(")), "{spec}");
            assert!(file.glsl.contains(&format!(" {name}(")), "{spec}");
            let order = spec.parse::<zonal_codegen::families::Spec>().expect("a spec").order;
            assert_eq!(order, file.order, "{spec}");
            assert!(specs.insert(*spec), "{spec} stands twice");
        }
    }
    let standard: Vec<String> = zonal_codegen::catalog::standard().iter().map(ToString::to_string).collect();
    assert!(standard.len() == specs.len() && standard.iter().all(|spec| specs.contains(spec.as_str())));
}
