//! The H-basis and the Half-Life 2 basis against values that were found by other means, their counts, and what normals that
//! are no units or that lie below the horizon get (docs/MATH.md#the-h-basis).

use serde_json::Value;
use std::f64::consts::PI;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;
use zonal_picture::normal_map::NormalMap;
use zonal_tests::{Runner, golden, norm, numbers, repository, spec};

fn run(text: &str, inputs: &[Vec<f64>]) -> Vec<f64> {
    Runner::<f64>::new(&spec(text)).run(inputs)
}

fn narrow(text: &str, inputs: &[Vec<f64>]) -> Vec<f64> {
    Runner::<f32>::new(&spec(text)).run(inputs)
}

fn cases(name: &str) -> Vec<Value> {
    golden(name)["cases"].as_array().expect("a golden file has cases").clone()
}

fn close(got: &[f64], want: &[f64], most: f64, what: &str) {
    let error = got.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(got.len() == want.len() && error <= most, "{what}: {error:e}: {got:?}, not {want:?}");
}

#[test]
fn the_functions_meet_the_golden_values() {
    let cases = cases("hsh_hbasis");
    assert_eq!(cases.len(), 19);
    for case in cases {
        let (dir, want) = (numbers(&case["d"]), numbers(&case["hbasis"]));
        // Values up to 1.4 from at most three roundings, and f32's of the direction.
        close(&run("h6_basis", std::slice::from_ref(&dir)), &want, 1e-15, "h6_basis");
        close(&run("h4_basis", std::slice::from_ref(&dir)), &want[..4], 1e-15, "h4_basis");
        close(&narrow("h6_basis", &[dir]), &want, 4e-7, "h6_basis in f32");
    }
}

#[test]
fn the_matrix_from_harmonics_meets_the_golden_one() {
    let table: Vec<Vec<f64>> = golden("Th")["T"].as_array().expect("six rows").iter().map(numbers).collect();
    for (text, order, count) in [("sh3_to_h4", 3, 4), ("sh3_to_h6", 3, 6), ("sh5_to_h4", 5, 4), ("sh5_to_h6", 5, 6)] {
        for place in 0..order * order {
            let mut c = vec![0.0; order * order];
            c[place] = 1.0;
            let got = run(&format!("{text}:irradiance"), &[c]);
            // Irradiance has no band 3, which is not read.
            let want = |row: &Vec<f64>| if place.isqrt() == 3 { 0.0 } else { row[place] };
            close(
                &got,
                &table[..count].iter().map(want).collect::<Vec<_>>(),
                1e-15,
                &format!("{text}, column {place}"),
            );
        }
    }
}

#[test]
fn radiance_becomes_irradiance_in_every_basis() {
    let cases = cases("hbasis_ext");
    assert_eq!(cases.len(), 3);
    for case in cases {
        let (five, dirs) = (numbers(&case["radiance_sh5"]), &case["dirs"]);
        let three = five[..9].to_vec();
        let [from_three, from_five, mono] =
            ["irradiance_h6_from_sh3", "irradiance_h6_from_sh5", "mono6"].map(|key| numbers(&case[key]));
        // Sums of at most three terms of size ten.
        let most = 5e-15;
        let at = |text: &str, c: &[f64]| run(text, &[c.to_vec()]);
        close(&at("sh3_to_h6", &three), &from_three, most, "sh3_to_h6");
        close(&at("sh3_to_h4", &three), &from_three[..4], most, "sh3_to_h4");
        close(&at("sh5_to_h6", &five), &from_five, most, "sh5_to_h6");
        close(&at("sh5_to_h4", &five), &from_five[..4], most, "sh5_to_h4");
        close(&at("sh3_to_h6:monomial", &three), &mono, most, "sh3_to_h6:monomial");
        close(&at("h6_to_monomial", &from_three), &mono, most, "h6_to_monomial");
        let four = at("h4_to_monomial", &from_three[..4]);
        close(&at("sh3_to_h4:monomial", &three), &four, most, "sh3_to_h4:monomial");
        for text in ["sh5_to_h4", "sh5_to_h6"] {
            let name = text.trim_start_matches("sh5_to_");
            let want = at(&format!("{name}_to_monomial"), &at(text, &five));
            close(&at(&format!("{text}:monomial"), &five), &want, most, text);
        }
        let over_pi: Vec<f64> = from_three.iter().map(|x| x / std::f64::consts::PI).collect();
        close(&at("sh3_to_h6:over_pi", &three), &over_pi, most, "sh3_to_h6:over_pi");
        let (half_life, in_h4) = (numbers(&case["hl2_from_sh3"]), numbers(&case["h4_of_hl2"]));
        close(&at("sh3_to_hl2", &three), &half_life, most, "sh3_to_hl2");
        close(&at("hl2_to_h4", &half_life), &in_h4, most, "hl2_to_h4");
        let vector = at("hl2_to_vector", &half_life);
        let dirs: Vec<Vec<f64>> = dirs.as_array().expect("directions").iter().map(numbers).collect();
        let [e4, e6, e2] = ["E_h4", "E_h6", "E_hl2"].map(|key| numbers(&case[key]));
        for (i, dir) in dirs.into_iter().enumerate() {
            let sums: [(&str, &[f64], f64); 9] = [
                ("h4_eval", &from_three[..4], e4[i]),
                ("h4_eval:shared", &from_three[..4], e4[i]),
                ("h4_eval_monomial", &four, e4[i]),
                ("h6_eval", &from_three, e6[i]),
                ("h6_eval:shared", &from_three, e6[i]),
                ("h6_eval_monomial", &mono, e6[i]),
                ("h6_eval_monomial:shared", &mono, e6[i]),
                ("hl2_eval", &half_life, e2[i]),
                ("hl2_eval_vector", &vector, e2[i]),
            ];
            for (text, c, want) in sums {
                let inputs = [dir.clone(), c.to_vec()];
                close(&run(text, &inputs), &[want], most, text);
                // A unit's own length is off by a rounding.
                close(&narrow(text, &inputs), &[want], 4e-7 * norm(c), &format!("{text} in f32"));
                let long = [dir.iter().map(|x| 0.37 * x).collect(), c.to_vec()];
                let text = match text.split_once(':') {
                    Some((name, method)) => format!("{name}:{method}:normalised"),
                    None => format!("{text}:normalised"),
                };
                close(&run(&text, &long), &[want], most, &text);
            }
        }
        let mean = numbers(&case["nonunit"]);
        close(
            &run("h6_eval", &[mean, from_three]),
            &[case["E_h6_nonunit_as_polynomial"].as_f64().expect("a number")],
            most,
            "a mean normal",
        );
    }
}

/// docs/MATH.md#the-h-basis has these counts.
#[test]
fn operations_are_those_of_the_derivation() {
    let counts: [(&str, usize, Option<usize>); 24] = [
        ("h4_basis", 3, None),
        ("h6_basis", 8, None),
        ("h4_basis:normalised", 9, None),
        ("h4_eval", 6, Some(15)),
        ("h6_eval", 11, Some(26)),
        ("h4_to_monomial", 5, None),
        ("h6_to_monomial", 7, None),
        ("h4_eval_monomial", 3, Some(9)),
        ("h6_eval_monomial", 6, Some(17)),
        ("h6_eval_monomial:normalised", 12, Some(23)),
        ("sh3_to_h4", 8, None),
        ("sh3_to_h6", 10, None),
        ("sh3_to_h6:irradiance", 10, None),
        ("sh3_to_h6:monomial", 10, Some(30)),
        ("sh3_to_h6:over_pi:monomial", 10, None),
        ("sh5_to_h4", 11, None),
        ("sh5_to_h6", 13, None),
        ("sh5_to_h6:monomial", 14, None),
        ("hl2_basis", 5, None),
        ("hl2_eval", 8, Some(14)),
        ("sh3_to_hl2", 12, None),
        ("hl2_to_h4", 8, None),
        ("hl2_to_vector", 7, None),
        ("hl2_eval_vector", 3, Some(9)),
    ];
    for (text, scalar, rgb) in counts {
        let cost = spec(text).code().cost(1);
        assert_eq!((cost.total, cost.special), (scalar, usize::from(text.contains("normalised"))), "{text}");
        if let Some(rgb) = rgb {
            let text = format!("{text}:rgb");
            assert_eq!(spec(&text).code().cost(3).total, rgb, "{text}");
        }
    }
}

#[test]
fn specs_without_an_order_read_back_and_name_functions_without_one() {
    for (text, name) in [
        ("h6_eval", "h6_eval"),
        ("h6_eval:rgb", "h6_eval_rgb"),
        ("h6_eval:nested:rgb", "h6_eval_nested_rgb"),
        ("h6_eval:normalised", "h6_eval_normalised"),
        ("sh3_to_h6", "sh3_to_h6_coefficients"),
        ("sh5_to_h4:irradiance:monomial:rgb", "sh5_to_h4_coefficients_irradiance_monomial_rgb"),
    ] {
        let parsed = spec(text);
        assert_eq!((parsed.to_string().as_str(), parsed.name().as_str()), (text, name));
    }
    assert_eq!(spec("sh3_to_h6:monomial:over_pi").to_string(), "sh3_to_h6:over_pi:monomial", "in the lists' order");
    for (text, message, help) in [
        ("h6_eval:3", "`3` is no method of `h6_eval`", "nested"),
        ("sh3_to_h6:monomials", "`monomials` is no option of `sh3_to_h6`", "did you mean `monomial`?"),
        ("h4_basis:normalised:f16", "f16", "normalise in f32"),
        ("h6_eval:normalised:normalised", "twice", "leave one out"),
    ] {
        let error = text.parse::<zonal_codegen::families::Spec>().expect_err(text);
        assert!(error.message.contains(message) && error.help.contains(help), "{text}: {error}");
    }
}

/// Gauss and Legendre's nodes in z and equal steps around: exact for products of these functions.
fn over_hemisphere(f: &dyn Fn([f64; 3]) -> Vec<f64>) -> Vec<f64> {
    let mut sums: Vec<f64> = Vec::new();
    for (z, weight) in gauss_legendre(8, 0.0, 1.0) {
        for step in 0..8 {
            let (sin, cos) = (PI / 4.0 * (f64::from(step) + 0.3)).sin_cos();
            let s = (1.0 - z * z).sqrt();
            let values = f([s * cos, s * sin, z]);
            sums.resize(values.len(), 0.0);
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * PI / 4.0 * value);
        }
    }
    sums
}

#[test]
fn both_bases_are_orthonormal_over_the_hemisphere() {
    for (text, count) in [("h4_basis", 4), ("h6_basis", 6), ("hl2_basis", 3)] {
        let basis = Runner::<f64>::new(&spec(text));
        let gram = over_hemisphere(&|dir| {
            let values = basis.run(&[dir.to_vec()]);
            values.iter().flat_map(|a| values.iter().map(move |b| a * b)).collect()
        });
        for (i, entry) in gram.into_iter().enumerate() {
            let want = f64::from(u8::from(i / count == i % count));
            assert!((entry - want).abs() < 1e-13, "{text}: entry {i} is {entry}");
        }
    }
}

/// The mean of H4 over a footprint is H4 at the mean normal; a unit in its place is off. Of H6, whose two quadratic functions
/// shrink with the square of the length, both are off, the mean by less (docs/MATH.md#the-h-basis).
#[test]
fn means_of_normals_are_not_to_be_normalised() {
    let bytes = zonal_scenes::embedded("normals/0015.webp").expect("embedded");
    let map = NormalMap::from_bytes("0015.webp", bytes).expect("a normal map");
    let mut random = Random::new(19);
    let (mut lengths, mut squares) = (Vec::new(), [[0.0; 2]; 2]);
    for footprint in 0..64 {
        let (left, top) = (footprint % 8 * 64, footprint / 8 * 64);
        let normals: Vec<Vec<f64>> =
            (0..256).map(|i| map.normals[(top + i / 16) * map.width + left + i % 16].map(f64::from).to_vec()).collect();
        let mean: Vec<f64> = (0..3).map(|i| normals.iter().map(|n| n[i]).sum::<f64>() / 256.0).collect();
        lengths.push(norm(&mean));
        let c: Vec<f64> = (0..6).map(|_| random.signed()).collect();
        for (which, count) in [4, 6].into_iter().enumerate() {
            let text = format!("h{count}_eval");
            let (kernel, unit) =
                (Runner::<f64>::new(&spec(&text)), Runner::<f64>::new(&spec(&format!("{text}:normalised"))));
            let c = &c[..count];
            let at = |runner: &Runner<f64>, n: &[f64]| runner.run(&[n.to_vec(), c.to_vec()])[0];
            let want = normals.iter().map(|n| at(&kernel, n)).sum::<f64>() / 256.0;
            let errors = [at(&kernel, &mean) - want, at(&unit, &mean) - want];
            // Sums of 256 numbers below 4.
            assert!(which == 1 || errors[0].abs() < 1e-13, "H4 at the mean errs by {:e}", errors[0]);
            squares[which].iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
        }
    }
    let least = lengths.iter().copied().fold(1.0, f64::min);
    assert!(least < 0.9, "the map is rough: {least}");
    let [four, six] = squares.map(|both| both.map(|sum| (sum / 64.0).sqrt()));
    println!("rms errors as it is and normalised: H4 {four:?}, H6 {six:?}; lengths from {least}");
    assert!(four[1] > 0.01 && six[0] < 0.5 * six[1], "H4 {four:?}, H6 {six:?}");
}

/// Whatever is in a normal map, below the horizon and of other lengths, the sums are those of the polynomials.
#[test]
fn normals_of_a_map_are_taken_as_they_are() {
    let bytes = std::fs::read(repository("scenes/normals/0015.webp")).expect("a normal map");
    let image = image::load_from_memory(&bytes).expect("decodes").into_rgb32f();
    let all: Vec<[f64; 3]> = image.pixels().map(|pixel| pixel.0.map(|x| f64::from(2.0 * x - 1.0))).collect();
    let below: Vec<[f64; 3]> = all.iter().copied().filter(|n| n[2] < 0.0).collect();
    assert_eq!(below.len(), 3, "the map tilts below the horizon");
    let c = [0.4, -0.7, 0.9, 0.3, -0.5, 0.8];
    let kernels = ["h6_eval", "h6_eval:shared"].map(|text| Runner::<f64>::new(&spec(text)));
    let monomial = run("h6_to_monomial", &[c.to_vec()]);
    for [x, y, z] in below.into_iter().chain(all.into_iter().step_by(997)).chain([[0.0; 3], [0.6, 0.0, -0.8]]) {
        let (slope, bend) = ((1.5 / PI).sqrt(), (7.5 / PI).sqrt());
        let h = [
            (0.5 / PI).sqrt(),
            -slope * y,
            slope * (2.0 * z - 1.0),
            -slope * x,
            bend * x * y,
            0.5 * bend * (x * x - y * y),
        ];
        let want: f64 = h.iter().zip(c).map(|(h, c)| h * c).sum();
        for kernel in &kernels {
            close(&kernel.run(&[vec![x, y, z], c.to_vec()]), &[want], 4e-15, "h6_eval");
        }
        close(&run("h6_eval_monomial", &[vec![x, y, z], monomial.clone()]), &[want], 4e-15, "h6_eval_monomial");
    }
    // A zero normal stays zero where it is to be a unit.
    let nothing = vec![0.0; 3];
    assert_eq!(run("h6_eval:normalised", &[nothing.clone(), c.to_vec()]), run("h6_eval", &[nothing, c.to_vec()]));
}

/// H4 is the least-squares linear function: no other one is nearer to the irradiance over the hemisphere.
#[test]
fn the_coefficients_are_those_of_the_nearest_function() {
    let mut random = Random::new(7);
    let radiance: Vec<f64> = (0..9).map(|_| random.signed()).collect();
    let irradiance = Runner::<f64>::new(&spec("irradiance:3"));
    for (basis, convert) in [("h4_basis", "sh3_to_h4"), ("h6_basis", "sh3_to_h6"), ("hl2_basis", "sh3_to_hl2")] {
        let values = Runner::<f64>::new(&spec(basis));
        let want = over_hemisphere(&|dir| {
            let e = irradiance.run(&[dir.to_vec(), radiance.clone()])[0];
            values.run(&[dir.to_vec()]).into_iter().map(|b| b * e).collect()
        });
        // A sum of 64 numbers below 30.
        close(&run(convert, std::slice::from_ref(&radiance)), &want, 1e-13, convert);
    }
}
