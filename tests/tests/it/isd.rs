//! Isotropic decomposition, shading with and without it, coupled lobes and gradients of records, against golden values, brute
//! force and each other (docs/MATH.md#isotropic-decomposition, docs/MATH.md#translational-gradients).

use crate::hemisphere::hemisphere;
use serde_json::Value;
use zonal_codegen::families::isd::directions::{Record, Records, best, kept};
use zonal_codegen::families::isd::mother::{Decomposition, HOPELESS, Levels, Mother};
use zonal_codegen::families::isd::search::{search, search_own};
use zonal_codegen::generate::build;
use zonal_codegen::promise::samples::Random;
use zonal_tests::command::{Folder, Run};
use zonal_tests::turns::{dot, frame_of};
use zonal_tests::{Runner, golden, larger, norm, numbers, spec};

fn runner(text: &str) -> Runner<f64> {
    Runner::new(&spec(text))
}

fn unit(list: &[f64]) -> Vec<f64> {
    list.iter().map(|x| x / norm(list)).collect()
}

fn vector(list: &[f64]) -> [f64; 3] {
    list.try_into().expect("three numbers")
}

fn random(count: usize, random: &mut Random) -> Vec<f64> {
    (0..count).map(|_| random.signed()).collect()
}

fn cases(file: &Value) -> &Vec<Value> {
    file["cases"].as_array().expect("a golden file has cases")
}

/// The golden file's M, of which an entry is a sum of at most 160 products of numbers below 16; its conditions are those of
/// another program's singular values.
#[test]
fn matrices_of_mother_functions_meet_the_golden_values() {
    let file = golden("isd");
    let directions = |name: &str| -> Vec<[f64; 3]> {
        file[name].as_array().expect("directions").iter().map(|v| vector(&numbers(v))).collect()
    };
    let levels = [Levels::own(4, &directions("dirs")), Levels::shared(4, &directions("shared_dirs"))];
    let [own, shared] = levels.map(|levels| levels.expect("as many directions as it takes"));
    assert_eq!(cases(&file).len(), 10);
    let (mut refused, mut worst) = (0, 0.0);
    for case in cases(&file) {
        let mother = match case["mother"].as_str().expect("a name") {
            "y" => Mother::Harmonic,
            "legendre" => Mother::Legendre,
            "gaussian" => Mother::Gaussian,
            "phong_clamped" => Mother::Phong,
            "gauss_legendre" => Mother::GaussLegendre,
            other => panic!("{other}: a mother function that nobody knows"),
        };
        let levels = if case["shared"] == true { &shared } else { &own };
        let made = Decomposition::measured(mother, levels);
        for (got, want) in made.matrix.iter().zip(case["M"].as_array().expect("rows")) {
            for (got, want) in got.iter().zip(numbers(want)) {
                worst = larger(worst, (got - want).abs());
            }
        }
        let condition = case["cond"].as_f64().expect("a number");
        if condition < 1e15 {
            let error = (made.condition / condition - 1.0).abs();
            assert!(error <= 1e-6, "{mother:?}: condition {:e}, not {condition:e}", made.condition);
        }
        let name = mother.name();
        match Decomposition::new(mother, levels) {
            Ok(made) => assert!(made.condition <= HOPELESS && condition <= HOPELESS),
            Err(message) => {
                refused += 1;
                let figure = if condition < 1e15 { format!("{condition:.1e}") } else { "singular".to_owned() };
                assert!(condition > HOPELESS && message.contains(name) && message.contains(&figure), "{message}");
            }
        }
    }
    println!("{refused} of 10 refused; entries are {worst:e} off");
    assert!(worst <= 1e-13, "{worst:e}");
    assert_eq!(refused, 3, "the unshared harmonics, twice, and the shared Phong");
}

#[test]
fn even_mother_functions_are_refused_and_spread_ones_are_not() {
    for bands in [1, 2, 4, 8] {
        let levels = Levels::dealt(bands);
        for (mother, name) in Mother::ALL {
            match Decomposition::new(mother, &levels) {
                Ok(_) => assert_ne!(mother, Mother::EvenPhong, "{bands} bands"),
                Err(message) => {
                    assert_eq!(mother, Mother::EvenPhong, "{message}");
                    assert!(message.contains(name) && message.contains("clamped"), "{message}");
                }
            }
        }
    }
    assert!(Levels::shared(4, &[[0.0, 0.0, 1.0]; 8]).is_err_and(|message| message.contains("give 9")));
    assert!(Levels::own(4, &[[0.0, 0.0, 1.0]; 24]).is_err_and(|message| message.contains("give 25")));
}

#[test]
fn directions_are_those_of_the_golden_values_and_reach_twenty_orders() {
    let file = golden("isd_directions");
    for bands in 2..=10 {
        let set = &file["sets"][format!("nested{bands}")];
        let want: Vec<Vec<f64>> = set["dirs"].as_array().expect("directions").iter().map(numbers).collect();
        let record = kept().iter().find(|record| record.bands == bands && record.seed.is_none()).expect("is kept");
        assert!(record.directions.iter().zip(&want).all(|(got, want)| got.as_slice() == want.as_slice()));
        let most = numbers(&set["cond"]).into_iter().fold(0.0, f64::max);
        assert!((record.counted().expect("is a set") - most).abs() <= 1e-4, "{bands} bands");
    }
    for bands in 2..=19 {
        let record = best(bands).expect("is kept");
        let counted = record.counted().expect("is a set");
        println!("{bands} bands: condition {counted:.4}, seed {:?}", record.seed);
        assert!((counted - record.condition).abs() <= 1e-4, "{bands} bands");
        assert!(counted <= 25.0, "{bands} bands");
    }
}

#[test]
fn the_search_finds_a_set_again_and_the_command_keeps_it() {
    let (once, again) = (search(4, 7, 2, || ()), search(4, 7, 2, || ()));
    // Two starts alone: what is kept has 2.6, random directions ten and more.
    assert!(once == again && once.condition < 4.0, "{once:?}");
    assert!(search(4, 8, 2, || ()) != once);
    let folder = Folder::new();
    let arguments = ["search-directions", "--bands", "2-3", "--tries", "1", "--out", "sets.toml"];
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(0), "{out}{err}");
    let text = std::fs::read_to_string(folder.path("sets.toml")).expect("written");
    assert!(text.starts_with("# @generated by zonal search-directions"), "{text}");
    let records = Records::read(&text).expect("reads back");
    assert_eq!(records.set, [2, 3].map(|bands| search(bands, 1, 1, || ())));
    assert_eq!(folder.run(arguments).code, Some(0));
    assert_eq!(text, std::fs::read_to_string(folder.path("sets.toml")).expect("still there"));
    folder.put("other.toml", "name = \"a scene\"\n");
    let Run { code, err, .. } = folder.run(["search-directions", "--bands", "2", "--out", "other.toml"]);
    assert!(code == Some(1) && err.contains("holds no directions"), "{err}");
    let Run { code, err, .. } = folder.run(["search-directions", "--bands", "20"]);
    assert!(code == Some(2) && err.contains("bands are 1 to 19"), "{err}");
    let wrong = |record: Record, part: &str| {
        let text = format!("# @generated by zonal\n{}", toml_of(&record));
        assert!(Records::read(&text).is_err_and(|message| message.contains(part)), "{part}");
    };
    let mut own = ["search-directions", "--mother", "phong", "--bands", "2-3", "--tries", "2", "--out", "sets.toml"];
    assert_eq!(folder.run(own).code, Some(0));
    let both = Records::read(&std::fs::read_to_string(folder.path("sets.toml")).expect("written")).expect("reads back");
    assert_eq!(both.set[..2], records.set[..]);
    assert_eq!(both.set[2..], [2, 3].map(|bands| search_own(Mother::Phong, bands, 1, 2, || ())));
    own[4] = "11";
    let Run { code, err, .. } = folder.run(own);
    assert!(code == Some(1) && err.contains("are 1 to 10"), "{err}");
    let good = records.set[0].clone();
    wrong(Record { bands: 3, ..good.clone() }, "has 5 directions, not 7");
    wrong(Record { condition: 1.0, ..good.clone() }, "not 1");
    wrong(Record { directions: vec![[0.0; 3]; 5], ..good }, "has no length");
}

fn toml_of(record: &Record) -> String {
    let directions: Vec<String> = record.directions.iter().map(|v| format!("{v:?}")).collect();
    let (bands, condition, directions) = (record.bands, record.condition, directions.join(", "));
    format!("[[set]]\nbands = {bands}\ncondition = {condition:?}\ndirections = [{directions}]\n")
}

/// A golden case: its order, quaternion, reflectance and weights.
fn shading(case: &Value) -> (usize, Vec<f64>, Vec<f64>, Vec<f64>) {
    let order = case["L"].as_u64().expect("a number") as usize + 1;
    let [w, x, y, z] = numbers(&case["quat_wxyz"])[..] else { panic!("four numbers") };
    let lambda = case["lambda_nested"].as_array().expect("bands").iter().flat_map(numbers).collect();
    (order, unit(&[x, y, z, w]), numbers(&case["brdf"]), lambda)
}

/// f64 rounds some hundred times by 1.1e-16, of numbers below the product of both norms.
#[test]
fn shading_meets_the_golden_values() {
    let file = golden("isd_shading");
    assert_eq!(cases(&file).len(), 5);
    for case in cases(&file) {
        let (order, q, c, lambda) = shading(case);
        let weights = runner(&format!("isd_weights:{order}")).run(std::slice::from_ref(&c));
        let error = weights.iter().zip(&lambda).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
        assert!(error <= 1e-13 * norm(&lambda), "order {order}: weights {error:e} off");
        let back = runner(&format!("isd_matrix:{order}")).run(std::slice::from_ref(&lambda));
        let error = back.iter().zip(&c).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
        assert!(error <= 1e-13 * norm(&c), "order {order}: coefficients {error:e} off");
        let want = case["I"].as_f64().expect("a number");
        let (inputs, kernels): (Vec<Vec<f64>>, [&str; 2]) = match case["kind"].as_str().expect("a kind") {
            "env" => (vec![q, numbers(&case["e"])], ["isd_shade", "shade"]),
            _ => {
                let axis = unit(&numbers(&case["axis_world"]));
                (vec![q, axis, numbers(&case["e_l"])], ["isd_shade_zonal", "shade_zonal"])
            }
        };
        let size = norm(inputs.last().expect("a light")) * norm(&c);
        for (kernel, last) in kernels.into_iter().zip([lambda, c.clone()]) {
            let all: Vec<Vec<f64>> = inputs.iter().cloned().chain([last]).collect();
            let text = format!("{kernel}:{order}");
            let (wide, narrow) = (runner(&text).run(&all)[0], Runner::<f32>::new(&spec(&text)).run(&all)[0]);
            println!("{text}: {:e} in f64, {:e} in f32", (wide - want).abs() / size, (narrow - want).abs() / size);
            assert!((wide - want).abs() <= 1e-13 * size, "{text}: {wide} instead of {want}");
            // The inputs are rounded to f32 too.
            assert!((narrow - want).abs() <= 1e-5 * size, "{text}: {narrow} instead of {want}");
        }
    }
}

#[test]
fn every_form_is_the_inner_product_with_the_turned_light() {
    let mut dice = Random::new(13);
    for order in 2..=8 {
        let count = order * order;
        let (rotate, direct) = (runner(&format!("rotate:{order}:zyz")), runner(&format!("shade:{order}")));
        let (isotropic, zonal) = (runner(&format!("shade_isotropic:{order}")), runner(&format!("shade_zonal:{order}")));
        let (turned, decomposed) =
            (runner(&format!("rotate:{order}:zonal")), (order > 2).then(|| runner(&format!("isd_weights:{order}"))));
        for _ in 0..10 {
            let (q, e, c) = (dice.unit::<4>().to_vec(), random(count, &mut dice), random(count, &mut dice));
            let (dir, g) = (dice.unit::<3>().to_vec(), random(order, &mut dice));
            let local = rotate.run(&[q.clone(), e.clone()]);
            let close = |got: f64, want: f64, what: &str| {
                let size = norm(&c) * norm(&e);
                assert!((got - want).abs() <= 1e-13 * size, "{what} of order {order}: {got} instead of {want}");
            };
            close(direct.run(&[q.clone(), e.clone(), c.clone()])[0], dot(&local, &c), "the direct form");
            let places = (0..order).flat_map(|l| (0..=l).map(move |m| l * (l + 1) + m));
            let (places, packed): (Vec<usize>, Vec<f64>) = places.map(|place| (place, c[place])).unzip();
            let half: f64 = places.iter().map(|&place| local[place] * c[place]).sum();
            close(isotropic.run(&[q.clone(), e.clone(), packed])[0], half, "the isotropic form");
            let lamp = turned.run(&[dir.clone(), g.clone()]);
            let want = dot(&rotate.run(&[q.clone(), lamp]), &c);
            close(zonal.run(&[q.clone(), dir.clone(), g.clone(), c.clone()])[0], want, "the zonal form");
            if let Some(weights) = &decomposed {
                let lambda = weights.run(std::slice::from_ref(&c));
                let [shade, lit] = ["isd_shade", "isd_shade_zonal"].map(|name| runner(&format!("{name}:{order}")));
                close(shade.run(&[q.clone(), e.clone(), lambda.clone()])[0], dot(&local, &c), "equation 22");
                close(lit.run(&[q, dir, g, lambda])[0], want, "equation 34");
            }
        }
    }
}

/// What was known before is the most that a kernel may cost; where a quaternion turns a direction, 9 more than by the matrix
/// that those figures take as given.
#[test]
fn shading_costs_what_the_mathematics_says() {
    let most: [(&str, [usize; 4]); 3] = [
        ("shade", [73, 253, 556, 767]),
        ("shade_isotropic", [71, 223, 493, 683]),
        ("shade_zonal", [34 + 9, 82 + 9, 155 + 9, 202 + 9]),
    ];
    for (name, most) in most {
        let specs: Vec<_> = [3, 5, 7, 8].map(|order| spec(&format!("{name}:{order}"))).to_vec();
        let got: Vec<usize> = build(&specs).iter().map(|function| function.built.code.cost(1).total).collect();
        println!("{name}: {got:?}, known before {most:?}");
        assert!(got.iter().zip(most).all(|(got, most)| *got <= most), "{name}: {got:?} above {most:?}");
    }
    for order in [3, 5] {
        let cost = |name: &str| build(&[spec(&format!("{name}:{order}"))])[0].built.code.cost(1).total;
        assert!(cost("isd_shade") > cost("shade") && cost("isd_shade_zonal") > cost("shade_zonal"), "order {order}");
    }
}

#[test]
fn no_light_gives_none_and_what_is_not_a_number_stays_so() {
    for text in ["shade:3", "shade:3:zyz", "shade:5", "shade_isotropic:5", "isd_shade:4"] {
        let kernel = runner(text);
        let params = spec(text).kernel().params;
        let count = |name: &str| params.iter().find(|param| param.name == name).map_or(0, |param| param.shape.len());
        let rest = params.last().expect("has parameters").name;
        let (dark, other) = (vec![0.0; count("e")], vec![0.5; count(rest)]);
        let q = vec![0.0, 0.0, 0.0, 1.0];
        assert_eq!(kernel.run(&[q.clone(), dark.clone(), other.clone()])[0], 0.0, "{text}");
        let mut bad = dark.clone();
        bad[1] = f64::NAN;
        // Of an isotropic reflectance the sine part is no matter, and no number still.
        assert!(kernel.run(&[q.clone(), bad, other.clone()])[0].is_nan(), "{text}");
        assert!(kernel.run(&[vec![f64::NAN; 4], vec![0.5; dark.len()], other])[0].is_nan(), "{text}");
    }
}

#[test]
fn coupled_lobes_are_the_inner_product_after_a_turn() {
    let mut dice = Random::new(7);
    for order in 2..=6 {
        let count = order * order;
        let [weights, with_signal, with_lobes] =
            ["zhf_weights", "zhf_dot", "zhf_dot_lobes"].map(|name| runner(&format!("{name}:{order}")));
        let rotate = runner(&format!("rotate:{order}:zyz"));
        let lobes = |c: &Vec<f64>| -> Vec<f64> {
            let norm = |place: usize| ((2 * place.isqrt() + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
            weights.run(std::slice::from_ref(c)).iter().enumerate().map(|(place, z)| norm(place) * z).collect()
        };
        for i in 0..10 {
            let q = if i == 0 { vec![0.0, 0.0, 0.0, 1.0] } else { dice.unit::<4>().to_vec() };
            let (c, other) = (random(count, &mut dice), random(count, &mut dice));
            let want = dot(&rotate.run(&[q.clone(), c.clone()]), &other);
            let got = [
                with_signal.run(&[q.clone(), lobes(&c), other.clone()])[0],
                with_lobes.run(&[q, lobes(&c), lobes(&other)])[0],
            ];
            let size = norm(&c) * norm(&other);
            for got in got {
                assert!((got - want).abs() <= 1e-13 * size, "order {order}: {got} instead of {want}");
            }
        }
    }
}

#[test]
fn gradients_meet_the_golden_values() {
    let file = golden("gradients");
    assert_eq!(cases(&file).len(), 2);
    for case in cases(&file) {
        let order = case["n"].as_u64().expect("a number");
        let kernel = runner(&format!("hsh_gradient:{order}"));
        let samples = case["samples"].as_array().expect("samples");
        for (name, e) in [("ddx", [1.0, 0.0, 0.0]), ("ddy", [0.0, 1.0, 0.0])] {
            let want = numbers(&case[name]);
            let mut got = vec![0.0; want.len()];
            let weight = std::f64::consts::TAU / samples.len() as f64;
            for sample in samples {
                let number = |name: &str| vec![sample[name].as_f64().expect("a number")];
                let [dir, m] = ["dir", "normal"].map(|name| unit(&numbers(&sample[name])));
                let out = kernel.run(&[dir, e.to_vec(), number("dist"), m, number("L")]);
                got.iter_mut().zip(out).for_each(|(sum, x)| *sum += weight * x);
            }
            let error = got.iter().zip(&want).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
            println!("order {order}, {name}: {error:e} off");
            assert!(error <= 1e-13 * norm(&want), "order {order}, {name}: {error:e}");
        }
    }
}

/// A sphere of radius one about the origin: the distance from a point in it, along a direction, and the normal there.
fn hit(point: [f64; 3], dir: [f64; 3]) -> (f64, [f64; 3]) {
    let along = dot(&point, &dir);
    let r = (along * along + 1.0 - dot(&point, &point)).sqrt() - along;
    (r, std::array::from_fn(|i| -(point[i] + r * dir[i])))
}

/// In a closed sphere of one radiance nothing changes, whatever the point; of another radiance what changes is what central
/// differences say, whose own error is the square of their step.
#[test]
fn gradients_are_those_of_the_integral_and_close() {
    let order = 4;
    let (kernel, basis) = (runner(&format!("hsh_gradient:{order}")), runner(&format!("hsh_basis:{order}")));
    let around = hemisphere(60, 120);
    // The roots at the horizon go away with the square of the height's root.
    let nodes: Vec<([f64; 3], f64)> = around
        .iter()
        .map(|([x, y, u], weight)| {
            let z = u * u;
            let scale = ((1.0 - z * z) / (1.0 - u * u)).sqrt();
            ([x * scale, y * scale, z], weight * 2.0 * u)
        })
        .collect();
    let shine = |dir: [f64; 3], point: [f64; 3]| {
        let (r, _) = hit(point, dir);
        let at: [f64; 3] = std::array::from_fn(|i| point[i] + r * dir[i]);
        1.0 + at[0] * at[1] + 0.5 * (2.0 * at[0] + at[2]).sin()
    };
    let point = [0.2, -0.3, -0.1];
    let e = [0.6, 0.8, 0.0];
    let gradient = |light: &dyn Fn([f64; 3]) -> f64| {
        let mut sum = vec![0.0; order * order];
        for (dir, weight) in &nodes {
            let (r, normal) = hit(point, *dir);
            let input = [dir.to_vec(), e.to_vec(), vec![r], normal.to_vec(), vec![light(*dir)]];
            kernel.run(&input).iter().zip(&mut sum).for_each(|(x, sum)| *sum += weight * x);
        }
        sum
    };
    let still = gradient(&|_| 1.0).into_iter().map(f64::abs).fold(0.0, larger);
    println!("of one radiance the gradient is {still:e}");
    assert!(still <= 1e-7, "{still:e}");
    let record = |step: f64| {
        let moved: [f64; 3] = std::array::from_fn(|i| point[i] + step * e[i]);
        let mut sum = vec![0.0; order * order];
        for (dir, weight) in &nodes {
            let value = weight * shine(*dir, moved);
            basis.run(&[dir.to_vec()]).iter().zip(&mut sum).for_each(|(h, sum)| *sum += value * h);
        }
        sum
    };
    let step = 1e-4;
    let (ahead, behind) = (record(step), record(-step));
    let want: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
    let got = gradient(&|dir| shine(dir, point));
    let error = got.iter().zip(&want).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
    println!("central differences: {error:e} of {:e}", norm(&want));
    assert!(error <= 1e-6, "{error:e}: {got:?} instead of {want:?}");
}

/// At the pole, at the horizon and below it, seen at grazing angles and from behind, a gradient is bounded by what the nearest
/// and the most grazing hit can do: the slope of H, and 3 + 1 / 0.1 times H.
#[test]
fn gradients_are_bounded_everywhere() {
    for order in [2, 3, 6, 10] {
        let kernel = Runner::<f32>::new(&spec(&format!("hsh_gradient:{order}")));
        let mut dice = Random::new(3);
        for dir in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1e-20], [0.6, 0.0, -0.8], [0.0, 0.0, -1.0]] {
            for _ in 0..20 {
                let [e, ..] = frame_of(&dice.unit::<3>());
                let input = [dir.to_vec(), e.to_vec(), vec![1.0], dice.unit::<3>().to_vec(), vec![1.0]];
                let got = kernel.run(&input);
                let most = 20.0 * (order * order) as f64;
                assert!(norm(&got) <= most, "order {order} at {dir:?}: {got:?}");
                let dark: Vec<Vec<f64>> = input[..4].iter().cloned().chain([vec![0.0]]).collect();
                assert!(kernel.run(&dark).iter().all(|x| *x == 0.0));
            }
        }
    }
}
