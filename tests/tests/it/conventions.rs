//! Conventions against the formulas of the programs that they name, typed here as those programs publish them: what such
//! a formula gives of converted coefficients at a direction of its own frame is what zonal gives at the same direction of
//! zonal's frame.

use std::f64::consts::PI;
use zonal_codegen::builder::files_of;
use zonal_codegen::environment::{Map, Projection, cosine_lobe};
use zonal_codegen::math::convention::{ALL, Convention, Holds, named};
use zonal_codegen::plan::Plan;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::command::Folder;
use zonal_tests::repository;

/// Rounding in f64 of sums of 9 to 49 products of numbers up to 4.
const ROUNDING: f64 = 1e-12;

type Direction = [f64; 3];

fn of(name: &str) -> &'static Convention {
    named(name).unwrap_or_else(|| panic!("no convention `{name}`"))
}

/// Directions in no special place.
fn directions() -> Vec<Direction> {
    let mut random = Random::new(17);
    (0..100).map(|_| random.unit()).collect()
}

fn signal(order: usize) -> Projection {
    let mut random = Random::new(5);
    let coefficients = (0..order * order).map(|_| std::array::from_fn(|_| random.signed())).collect();
    Projection { order, coefficients, beyond: 0.0 }
}

/// Every constant as the program prints it beside what it stands for, which is returned. Six digits are printed at the least,
/// of 0.743124 one more than is right.
fn constant(exact: f64, printed: f64) -> f64 {
    assert!((exact - printed).abs() < 1.2e-6, "{exact} is not {printed}");
    exact
}

/// Compares a program's evaluation of one channel with zonal's, times a factor, at directions of the program's frame.
fn agrees(convention: &Convention, signal: &Projection, factor: f64, value: impl Fn(&[f64], Direction) -> f64) {
    let converted = convention.convert_to(&signal.coefficients);
    for channel in 0..3 {
        let coefficients: Vec<f64> = converted.iter().map(|c| c[channel]).collect();
        for direction in directions() {
            let want = factor * signal.evaluate(convention.axes.to_zonal(direction))[channel];
            let got = value(&coefficients, direction);
            assert!((got - want).abs() < ROUNDING, "{}: {got}, not {want} at {direction:?}", convention.name);
        }
    }
}

/// three.js, `SphericalHarmonics3.getAt`.
fn three_js_get_at(c: &[f64], [x, y, z]: Direction) -> f64 {
    let k = [
        constant((1.0 / (4.0 * PI)).sqrt(), 0.282095),
        constant((3.0 / (4.0 * PI)).sqrt(), 0.488603),
        constant((15.0 / (4.0 * PI)).sqrt(), 1.092548),
        constant((5.0 / (16.0 * PI)).sqrt(), 0.315392),
        constant((15.0 / (16.0 * PI)).sqrt(), 0.546274),
    ];
    k[0] * c[0]
        + k[1] * (c[1] * y + c[2] * z + c[3] * x)
        + k[2] * (c[4] * (x * y) + c[5] * (y * z))
        + k[3] * c[6] * (3.0 * z * z - 1.0)
        + k[2] * c[7] * (x * z)
        + k[4] * c[8] * (x * x - y * y)
}

/// three.js, `SphericalHarmonics3.getIrradianceAt`, and Godot's lightmap captures: Ramamoorthi and Hanrahan 2001.
fn irradiance_of_radiance(c: &[f64], [x, y, z]: Direction) -> f64 {
    let k1 = constant(PI / 4.0 * (15.0 / (16.0 * PI)).sqrt(), 0.429043);
    let k2 = constant(PI / 3.0 * (3.0 / (4.0 * PI)).sqrt(), 0.511664);
    let k3 = constant(3.0 * PI / 4.0 * (5.0 / (16.0 * PI)).sqrt(), 0.743125);
    let k4 = constant(PI * (1.0 / (4.0 * PI)).sqrt(), 0.886227);
    let k5 = constant(PI / 4.0 * (5.0 / (16.0 * PI)).sqrt(), 0.247708);
    c[0] * k4
        + 2.0 * k2 * (c[1] * y + c[2] * z + c[3] * x)
        + 2.0 * k1 * (c[4] * x * y + c[5] * y * z + c[7] * x * z)
        + c[6] * (k3 * z * z - k5)
        + c[8] * k1 * (x * x - y * y)
}

/// Unity, `SHEvalLinearL0L1` and `SHEvalLinearL2`, from the vectors that `SphericalHarmonicsL2` is packed into.
fn unity(c: &[f64], [x, y, z]: Direction) -> f64 {
    let (sha, shb, shc) = ([c[3], c[1], c[2], c[0] - c[6]], [c[4], c[5], 3.0 * c[6], c[7]], c[8]);
    let dot = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(sha, [x, y, z, 1.0]) + dot(shb, [x * y, y * z, z * z, z * x]) + shc * (x * x - y * y)
}

/// Filament, `Irradiance_SphericalHarmonics`.
fn filament(c: &[f64], [x, y, z]: Direction) -> f64 {
    c[0] + c[1] * y
        + c[2] * z
        + c[3] * x
        + c[4] * (y * x)
        + c[5] * (y * z)
        + c[6] * (3.0 * z * z - 1.0)
        + c[7] * (z * x)
        + c[8] * (x * x - y * y)
}

/// PlayCanvas, the chunk `ambient`.
fn playcanvas(c: &[f64], [x, y, z]: Direction) -> f64 {
    c[0] + c[1] * x
        + c[2] * y
        + c[3] * z
        + c[4] * x * z
        + c[5] * z * y
        + c[6] * y * x
        + c[7] * (3.0 * z * z - 1.0)
        + c[8] * (x * x - y * y)
}

/// Babylon.js: what `SphericalHarmonics` does to radiance before its shader's polynomial, whose basis has signs.
fn babylon(c: &[f64], direction: Direction) -> f64 {
    let lobe = [PI, 2.0 * PI / 3.0, PI / 4.0];
    let basis =
        [(1.0, 4.0), (-3.0, 4.0), (3.0, 4.0), (-3.0, 4.0), (15.0, 4.0), (-15.0, 4.0), (5.0, 16.0), (-15.0, 4.0)];
    let k = basis.iter().chain(&[(15.0, 16.0)]).map(|(p, q): &(f64, f64)| p.signum() * (p.abs() / (q * PI)).sqrt());
    let scaled: Vec<f64> = k.zip(c).enumerate().map(|(i, (k, c))| k * c * lobe[i.isqrt()] / PI).collect();
    filament(&scaled, direction)
}

/// 3DGS, `eval_sh`, and `KHR_gaussian_splatting`, without the 0.5; DirectXMath's `XMSHEvalDirection` and Unreal's
/// `SHBasisFunction3` begin with the same nine.
fn signed_basis([x, y, z]: Direction) -> [f64; 16] {
    let k1 = constant((3.0 / (4.0 * PI)).sqrt(), 0.488_602_511_902_919_9);
    let k2 = constant((15.0 / (4.0 * PI)).sqrt(), 1.092_548_430_592_079_2);
    let k20 = constant((5.0 / (16.0 * PI)).sqrt(), 0.315_391_565_252_520_05);
    let k22 = constant((15.0 / (16.0 * PI)).sqrt(), 0.546_274_215_296_039_6);
    let k33 = constant((35.0 / (32.0 * PI)).sqrt(), 0.590_043_589_926_643_5);
    let k32 = constant((105.0 / (4.0 * PI)).sqrt(), 2.890_611_442_640_554);
    let k31 = constant((21.0 / (32.0 * PI)).sqrt(), 0.457_045_799_464_465_8);
    let k30 = constant((7.0 / (16.0 * PI)).sqrt(), 0.373_176_332_590_115_4);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        constant((1.0 / (4.0 * PI)).sqrt(), 0.282_094_791_773_878_14),
        -k1 * y,
        k1 * z,
        -k1 * x,
        k2 * (x * y),
        -k2 * (y * z),
        k20 * (2.0 * zz - xx - yy),
        -k2 * (x * z),
        k22 * (xx - yy),
        -k33 * y * (3.0 * xx - yy),
        k32 * (x * y) * z,
        -k31 * y * (4.0 * zz - xx - yy),
        k30 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy),
        -k31 * x * (4.0 * zz - xx - yy),
        0.5 * k32 * z * (xx - yy),
        -k33 * x * (xx - 3.0 * yy),
    ]
}

fn signed(c: &[f64], direction: Direction) -> f64 {
    signed_basis(direction).iter().zip(c).map(|(y, c)| y * c).sum()
}

#[test]
fn programs_that_take_radiance_evaluate_what_zonal_does() {
    let (radiance, order_4) = (signal(3), signal(4));
    agrees(of("three_js"), &radiance, 1.0, three_js_get_at);
    for (name, signal) in [
        ("directxmath", &radiance),
        ("unreal", &radiance),
        ("khr_gaussian_splatting", &order_4),
        ("threedgs", &order_4),
        ("wgpu", &order_4),
        ("bevy", &order_4),
        ("zonal", &order_4),
    ] {
        agrees(of(name), signal, 1.0, signed);
    }
}

#[test]
fn programs_that_multiply_the_cosine_factors_evaluate_irradiance() {
    let radiance = signal(3);
    let irradiance = radiance.irradiance();
    assert_eq!([0, 1, 2].map(cosine_lobe), [PI, 2.0 * PI / 3.0, PI / 4.0]);
    for (name, factor, value) in [
        ("three_js", 1.0, irradiance_of_radiance as fn(&[f64], Direction) -> f64),
        ("godot", 1.0 / PI, irradiance_of_radiance),
        ("babylon", 1.0 / PI, babylon),
    ] {
        let convention = of(name);
        let converted = convention.convert_to(&radiance.coefficients);
        for (channel, direction) in (0..3).flat_map(|channel| directions().into_iter().map(move |d| (channel, d))) {
            let c: Vec<f64> = converted.iter().map(|c| c[channel]).collect();
            let want = factor * irradiance.evaluate(convention.axes.to_zonal(direction))[channel];
            assert!((value(&c, direction) - want).abs() < ROUNDING, "{name} at {direction:?}");
        }
    }
}

#[test]
fn programs_that_take_irradiance_evaluate_what_a_white_surface_sends_out() {
    let irradiance = signal(3).irradiance();
    for (name, value) in
        [("unity", unity as fn(&[f64], Direction) -> f64), ("filament", filament), ("playcanvas", playcanvas)]
    {
        assert_eq!(of(name).holds, Holds::Irradiance);
        agrees(of(name), &irradiance, 1.0 / PI, value);
    }
    agrees(of("ext_lights_image_based"), &irradiance, 1.0, signed);
}

#[test]
fn a_source_has_the_channels_of_ambix() {
    // The table of ACN and SN3D up to the second order, in azimuth and elevation.
    let (azimuth, elevation): (f64, f64) = (0.7, -0.4);
    let ((sa, ca), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
    let half_root_3 = 3.0f64.sqrt() / 2.0;
    let want = [
        1.0,
        sa * ce,
        se,
        ca * ce,
        half_root_3 * (2.0 * azimuth).sin() * ce * ce,
        half_root_3 * sa * (2.0 * elevation).sin(),
        0.5 * (3.0 * se * se - 1.0),
        half_root_3 * ca * (2.0 * elevation).sin(),
        half_root_3 * (2.0 * azimuth).cos() * ce * ce,
    ];
    let source: Vec<[f64; 1]> = signed_basis([ca * ce, sa * ce, se])[..9].iter().map(|&y| [y]).collect();
    for ([got], want) in of("ambix").convert_to(&source).into_iter().zip(want) {
        assert!((got - want).abs() < ROUNDING, "{got}, not {want}");
    }
}

#[test]
fn every_convention_can_be_undone_and_no_name_stands_twice() {
    for (i, convention) in ALL.iter().enumerate() {
        assert!(ALL[..i].iter().all(|other| other.name != convention.name), "{}", convention.name);
        let signal = signal(convention.max_order.min(7));
        let there = convention.convert_to(&signal.coefficients);
        let back = convention.convert_from(&there);
        let difference = |a: &[[f64; 3]], b: &[[f64; 3]]| {
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(difference(&back, &signal.coefficients) < ROUNDING, "{}", convention.name);
        // It is no idle test: what is not zonal's own changes something.
        assert_eq!(difference(&there, &signal.coefficients) < ROUNDING, convention.name == "zonal");
        let [to, from] = [convention.to_matrix(2), convention.from_matrix(2)];
        for (a, row) in to.iter().enumerate() {
            for b in 0..5 {
                let product = (0..5).map(|c| &row[c] * &from[c][b]).sum::<zonal_codegen::math::exact::Exact>();
                assert!(if a == b { product.is_one() } else { product.is_zero() }, "{}", convention.name);
            }
        }
    }
}

#[test]
fn maps_lie_where_the_readers_of_programs_put_them() {
    // The direction that a program reads at u, v of a map, from its own formula, and the one that zonal reads there.
    let zonal = |u: f64, v: f64| {
        let ((sin, cos), (height, radius)) =
            ((-2.0 * PI * (u - 0.5)).sin_cos(), ((PI * (0.5 - v)).sin(), (PI * (0.5 - v)).cos()));
        [radius * cos, radius * sin, height]
    };
    type Uv = fn(Direction) -> [f64; 2];
    let three_js: Uv = |[x, y, z]| [z.atan2(x) / (2.0 * PI) + 0.5, 0.5 - y.asin() / PI];
    let unity: Uv = |[x, y, z]| [0.5 - z.atan2(x) * 0.5 / PI, y.acos() / PI];
    let godot: Uv = |[x, y, z]| [(x.atan2(-z) / (2.0 * PI)).rem_euclid(1.0), y.acos() / PI];
    let playcanvas: Uv = |[x, y, z]| [(-x).atan2(z) / (2.0 * PI) + 0.5, 0.5 - y.asin() / PI];
    let filament: Uv = |[x, y, z]| [((-x).atan2(z) / PI + 1.0) * 0.5, (1.0 - y.asin() * 2.0 / PI) * 0.5];
    let unreal: Uv = |[x, y, z]| [(PI + y.atan2(x)) / (2.0 * PI), z.acos() / PI];
    for (name, read) in [
        ("three_js", three_js),
        ("unity", unity),
        ("godot", godot),
        ("playcanvas", playcanvas),
        ("filament", filament),
        ("unreal", unreal),
    ] {
        for (u, v) in [(0.5, 0.5), (0.75, 0.5), (0.1, 0.2), (0.9, 0.7)] {
            let [got_u, got_v] = read(of(name).axes.from_zonal(zonal(u, v)));
            assert!((got_u - u).abs() < ROUNDING && (got_v - v).abs() < ROUNDING, "{name}: {got_u}, {got_v}");
        }
    }
    let left_handed: Vec<&str> = ALL.iter().filter(|c| c.axes.is_left_handed()).map(|c| c.name).collect();
    assert_eq!(left_handed, ["babylon", "unity", "unreal", "directxmath"]);
}

/// What `zonal project` prints of a map's irradiance in order 3, a row of R, G and B a coefficient.
fn projected(map: &str, arguments: &[&str]) -> Vec<[f64; 3]> {
    let map = repository(&format!("scenes/maps/{map}_256x128.hdr"));
    let map = map.to_str().expect("UTF-8");
    let run = Folder::new().run([&["project", map, "--irradiance", "--order", "3", "--json"], arguments].concat());
    assert_eq!(run.code, Some(0), "{}", run.err);
    let printed: serde_json::Value = serde_json::from_str(&run.out).expect("prints JSON");
    serde_json::from_value(printed["coefficients"].clone()).expect("nine rows")
}

/// The irradiance at a normal in three.js's frame, from a map's texels taken as points: u is atan(z, x) / 2π + ½ and v
/// asin(y) / π + ½ there.
fn brute_force(map: &Map, normal: Direction) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let (width, height) = (map.width as f64, map.height as f64);
    for (i, texel) in map.texels.iter().enumerate() {
        let (column, row) = ((i % map.width) as f64 + 0.5, (i / map.width) as f64 + 0.5);
        let (azimuth, elevation) = (2.0 * PI * (column / width - 0.5), PI * (0.5 - row / height));
        let radius = elevation.cos();
        let cosine =
            normal[0] * radius * azimuth.cos() + normal[1] * elevation.sin() + normal[2] * radius * azimuth.sin();
        let solid_angle = 2.0 * PI / width * PI / height * radius;
        (0..3).for_each(|channel| sum[channel] += texel[channel] * cosine.max(0.0) * solid_angle);
    }
    sum
}

#[test]
fn irradiance_of_a_map_is_right_at_the_normals_of_three_js_and_wrong_readings_are_seen() {
    let name = "city";
    let map = Map::read(&repository(&format!("scenes/maps/{name}_256x128.hdr"))).expect("a map");
    let normals = directions();
    let truth: Vec<[f64; 3]> = normals.iter().map(|&normal| brute_force(&map, normal)).collect();
    let mean = truth.iter().flatten().sum::<f64>() / (3 * truth.len()) as f64;
    // The rms error over normals and channels, over the mean of the irradiance.
    let error = |coefficients: &[[f64; 3]], value: &dyn Fn(&[f64], Direction) -> f64| {
        let mut squares = 0.0;
        for channel in 0..3 {
            let c: Vec<f64> = coefficients.iter().map(|c| c[channel]).collect();
            let pairs = normals.iter().zip(&truth);
            squares += pairs.map(|(&normal, truth)| (value(&c, normal) - truth[channel]).powi(2)).sum::<f64>();
        }
        (squares / (3 * truth.len()) as f64).sqrt() / mean
    };
    // Order 3 errs by 4.4 % over the whole sphere, as `environment.rs` has it from another program.
    let own = 0.04..0.05;
    let for_shader = error(&projected(name, &["--convention", "three_js"]), &three_js_get_at);
    let for_kernels = error(&projected(name, &["--axes", "three_js"]), &signed);
    let zonal = projected(name, &[]);
    let turned = error(&zonal, &|c, [x, y, z]| signed(c, [x, -z, y]));
    for right in [for_shader, for_kernels, turned] {
        assert!(own.contains(&right), "{right}");
    }
    let close = |a: f64, b: f64| (a - b).abs() < ROUNDING;
    assert!(close(for_shader, for_kernels) && close(for_kernels, turned), "{for_shader}, {for_kernels}, {turned}");
    // What was read without axes or signs errs by half of the light.
    let as_it_is = error(&zonal, &signed);
    let mirrored = error(&zonal, &|c, [x, y, z]| signed(c, [x, z, y]));
    let unsigned = error(&zonal, &|c, [x, y, z]| three_js_get_at(c, [x, -z, y]));
    assert!(as_it_is > 0.3 && mirrored > 0.15 && unsigned > 0.3, "{as_it_is}, {mirrored}, {unsigned}");
}

fn plan(environment: &str, rest: &str) -> Result<Plan, Diagnostic> {
    let text = format!(
        "name = \"a\"\n[environment]\nmap = \"maps/city_256x128.hdr\"\nsignal = \"irradiance\"\nbudget = 0.01\n{environment}\n{rest}"
    );
    Plan::new(&Scene::parse("scene.toml", &text, Maps::Folder(repository("scenes")))?)
}

#[test]
fn a_scene_holds_its_coefficients_as_it_says_and_every_file_says_so() {
    let values = |keys: &str| {
        let found = plan(keys, "").unwrap_or_else(|error| panic!("{error}"));
        let values = found.environment.as_ref().expect("has one").values.clone();
        let texts: Vec<String> = files_of(&found).expect("valid").into_iter().map(|file| file.text).collect();
        // Comments are wrapped: what they say is looked for without line ends.
        let texts = texts.iter().map(|text| text.replace("\n///", "").replace("\n//", "").replace('\n', " "));
        (values, texts.collect::<Vec<_>>())
    };
    let order_3 = "max_order = 3";
    let (zonal, texts) = values(order_3);
    assert_eq!(texts.len(), 4, "three languages and a report");
    let says = |texts: &[String], sentence: &str| {
        texts.iter().for_each(|text| assert!(text.contains(sentence), "`{sentence}` is not in\n{text}"));
    };
    says(
        &texts,
        "Axes: z up, the map's centre along +x, -y to its right; for normals of three.js: `axes = \"three_js\"`",
    );

    let (values_there, texts) = values("convention = \"unity\"");
    assert_eq!(values_there, of("unity").convert_to(&zonal));
    says(
        &texts,
        "Axes: y up, the map's centre along +x, -z to its right; as `unity` takes them: without the sign (-1)^m, times",
    );

    let (axes_alone, texts) = values(&format!("{order_3}\naxes = \"unity\""));
    assert_eq!(values(&format!("{order_3}\naxes = \"x, z, y\"")).0, axes_alone);
    assert_ne!(axes_alone, values_there);
    says(&texts, "Axes: y up, the map's centre along +x, -z to its right.");
    let turned = Projection { order: 3, coefficients: axes_alone, beyond: 0.0 };
    let whole = Projection { order: 3, coefficients: zonal, beyond: 0.0 };
    for direction in directions() {
        let [got, want] = [turned.evaluate(direction), whole.evaluate(of("unity").axes.to_zonal(direction))];
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < ROUNDING), "{got:?}, not {want:?}");
    }
    // A convention with other axes than its own.
    let (both, _) = values("convention = \"unity\"\naxes = \"z,-x,y\"");
    assert_ne!(both, values_there);
}

#[test]
fn what_no_program_or_no_kernel_takes_is_refused() {
    let refused = |keys: &str, rest: &str, parts: &[&str]| {
        let error = plan(keys, rest).map(|plan| plan.scene).expect_err(keys).to_string();
        parts.iter().for_each(|part| assert!(error.contains(part), "`{part}` is not in\n{error}"));
    };
    let kernel = "[[kernel]]\nspec = \"eval:environment:rgb\"\n";
    refused(
        "convention = \"threejs\"",
        "",
        &["`threejs` is no convention", "did you mean `three_js`?", "playcanvas, "],
    );
    refused("convention = \"\"", "", &["is no convention", "known are zonal, three_js, "]);
    refused("axes = \"threejs\"", "", &["`threejs` names no axes", "did you mean `three_js`?", "`x,-z,y`"]);
    refused("axes = \"x,-z,z\"", "", &["`x,-z,z` is not three axes", "`x,-z,y`"]);
    refused("convention = \"three_js\"\nmax_order = 5", "", &["`three_js` has at most 3 bands, not 5", "take order 3"]);
    refused("convention = \"three_js\"", kernel, &["no kernel of zonal takes", "write `axes = \"three_js\"`"]);
    let rotation = "[[rotation]]\nkind = \"tilt\"\norder = \"environment\"\nmax_angle = 15\nmax_error = 0.1\n";
    refused("convention = \"unity\"", rotation, &["no kernel of zonal takes"]);
    for keys in ["convention = \"unreal\"", "convention = \"three_js\"\naxes = \"z,x,y\"", "max_order = 3"] {
        let taken = plan(keys, if keys.contains("three_js") { "" } else { kernel });
        assert!(taken.is_ok(), "{keys}: {}", taken.map(|plan| plan.scene).expect_err("is an error"));
    }
    let radiance =
        "name = \"a\"\n[environment]\nmap = \"m\"\nsignal = \"radiance\"\nbudget = 0\nconvention = \"filament\"\n";
    let error =
        Scene::parse("scene.toml", radiance, Maps::Folder(repository("scenes"))).expect_err("radiance").to_string();
    assert!(error.contains("`filament` holds irradiance") && error.contains("signal = \"irradiance\""), "{error}");
}

#[test]
fn project_says_its_axes_and_refuses_what_it_does_not_know() {
    let folder = Folder::new();
    let map = repository("scenes/maps/city_256x128.hdr");
    let map = map.to_str().expect("UTF-8");
    let run = folder.run(["project", map, "--irradiance", "--convention", "playcanvas"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    assert!(
        run.out.contains("Axes: y up, the map's centre along +z, -x to its right; as `playcanvas` takes"),
        "{}",
        run.out
    );
    // In its order: 1; x, y, z, which are m = 1, -1, 0.
    let places: Vec<&str> =
        run.out.lines().rev().take(9).map(|line| line.split('|').nth(2).unwrap_or("").trim()).collect();
    assert_eq!(places, ["2", "0", "-2", "-1", "1", "0", "-1", "1", "0"]);
    let plain = folder.run(["project", map, "--json"]);
    let printed: serde_json::Value = serde_json::from_str(&plain.out).expect("prints JSON");
    assert_eq!(printed["convention"], "zonal");
    assert_eq!(printed["axes"], serde_json::json!({"centre": "+x", "right": "-y", "up": "+z"}));
    for (arguments, code, part) in [
        (&["--convention", "threejs"][..], 2, "three_js"),
        (&["--axes", "x,y"], 1, "`x,y` is not three axes"),
        (&["--axes", "unti"], 1, "known are zonal"),
        (&["--convention", "unity"], 1, "`--irradiance`"),
        (&["--convention", "three_js", "--order", "4"], 1, "at most 3 bands, not 4"),
    ] {
        let run = folder.run([&["project", map], arguments].concat());
        assert_eq!(run.code, Some(code), "{arguments:?}: {}{}", run.out, run.err);
        assert!(run.err.contains(part), "{arguments:?}: {}", run.err);
    }
}
