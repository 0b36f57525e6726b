//! Tabulated reflectances: files that are written from Ward's and Phong's give their values, slices and plans back; what is
//! missing is told; what is damaged is refused with what is wrong.

use std::path::{Path, PathBuf};
use zonal_codegen::environment::Map;
use zonal_codegen::fault::Fault;
use zonal_codegen::plan::Plan;
use zonal_codegen::reflectance::brdf::{Brdf, Table};
use zonal_codegen::reflectance::measured::Measured;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::command::{command, printed};
use zonal_tests::repository;
use zonal_tests::tabulated::{array, grid, merl, pairs};

fn brdf(text: &str) -> Brdf {
    text.parse().unwrap_or_else(|error| panic!("{error}"))
}

/// A reflectance without the cosine, in colour.
fn coloured(brdf: &Brdf, view: [f64; 3], light: [f64; 3]) -> [f64; 3] {
    // Ward's grows without bound where both are at the horizon: a little above it is what is measured there.
    let [view, light] = [view, light].map(|[x, y, z]| [x, y, z.max(0.05)]);
    let value = brdf.value(view, light) / light[2];
    [value, 0.5 * value, 0.25 * value]
}

fn read(bytes: &[u8]) -> Brdf {
    Measured::from_bytes("test", bytes).unwrap_or_else(|error| panic!("{error}")).into()
}

fn fault(bytes: &[u8]) -> Fault {
    Measured::from_bytes("test", bytes).expect_err("it is no table")
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>()) / norm(b)
}

fn direction(elevation: f64, azimuth: f64) -> [f64; 3] {
    let (sin, cos) = elevation.to_radians().sin_cos();
    let (y, x) = azimuth.to_radians().sin_cos();
    [sin * x, sin * y, cos]
}

/// The coefficients of a reflectance's values as an image of the sphere: another quadrature.
fn by_a_map(brdf: &Brdf, view: [f64; 3], order: usize) -> Vec<f64> {
    let mut map = Map { width: 512, height: 256, texels: vec![[0.0; 3]; 512 * 256] };
    for i in 0..map.texels.len() {
        map.texels[i] = [brdf.value(view, map.direction(i % map.width, i / map.width)); 3];
    }
    map.project(order).coefficients.iter().map(|c| c[0]).collect()
}

#[test]
fn a_file_of_merl_gives_back_what_it_was_written_from() {
    for text in ["ward:0.3", "phong:20"] {
        let truth = brdf(text);
        let measured = read(&merl(|view, light| coloured(&truth, view, light)));
        assert!(measured.is_isotropic() && measured.channels().len() == 3, "{text}");
        let told = measured.table().expect("a table").told();
        assert!(told.contains("none is missing") && told.contains("R, G and B"), "{told}");
        for [elevation, azimuth] in [[0.0, 0.0], [20.0, 70.0], [60.0, 200.0], [80.0, 310.0]] {
            let view = direction(elevation, azimuth);
            for (channel, of) in measured.channels().iter().enumerate() {
                let share = [1.0, 0.5, 0.25][channel];
                let wanted: Vec<f64> = truth.coefficients(view, 8).iter().map(|c| share * c).collect();
                // Entries lie a degree apart, where a lobe as wide as 0.3 curves by (π/180)²/8 · 2/0.09 = 8e-4; towards the
                // horizon of the view what lies below it is filled.
                let error = apart(&of.coefficients(view, 8), &wanted);
                let most = if elevation < 70.0 { 2e-3 } else { 1e-2 };
                assert!(error < most, "{text} at {elevation}, channel {channel}: {error:.1e}");
            }
            for light in [direction(10.0, 200.0), direction(50.0, 40.0), direction(70.0, azimuth + 180.0)] {
                let (found, wanted) = (measured.values(view, light), truth.value(view, light));
                assert!((found[0] - wanted).abs() < 3e-3 * (wanted + 0.1), "{text}: {found:?}, {wanted}");
                assert!((measured.value(view, light) - 1.75 / 3.0 * found[0]).abs() < 1e-6);
            }
        }
        // The table that is looked up holds what the slices are.
        let table = Table::new(&measured.channels()[1], 4);
        let view = direction(42.0, 130.0);
        assert!(apart(&table.at(view), &measured.channels()[1].coefficients(view, 4)) < 1e-2, "{text}");
    }
}

#[test]
fn what_is_missing_is_filled_and_told() {
    let truth = brdf("ward:0.4");
    let mut bytes = merl(|view, light| coloured(&truth, view, light));
    let place =
        |i: usize, j: usize, k: usize, channel: usize| 12 + 8 * (((i * 90 + j) * 180 + k) + channel * 1_458_000);
    // Three entries of one channel on a line, and a whole line.
    for j in 30..33 {
        bytes[place(5, j, 7, 1)..][..8].copy_from_slice(&(-1.0f64).to_le_bytes());
    }
    for (j, channel) in (0..90).flat_map(|j| (0..3).map(move |channel| (j, channel))) {
        bytes[place(20, j, 90, channel)..][..8].copy_from_slice(&(-1.0f64).to_le_bytes());
    }
    let measured = Measured::from_bytes("test", &bytes).expect("a table");
    assert!(measured.missing.filled > 3 + 60 && measured.missing.filled <= 3 + 90, "{:?}", measured.missing);
    assert_eq!(measured.missing.black, measured.missing.filled - 3);
    assert!(measured.told().contains(&format!("{} are missing", measured.missing.filled)), "{}", measured.told());
    let whole = read(&merl(|view, light| coloured(&truth, view, light)));
    let error = apart(
        &Brdf::from(measured).coefficients(direction(30.0, 0.0), 6),
        &whole.coefficients(direction(30.0, 0.0), 6),
    );
    assert!(error < 2e-3, "{error:.1e}");
}

#[test]
fn pairs_of_directions_give_back_what_they_were_written_from() {
    let truth = brdf("ward:0.5:0.9");
    let image = read(&pairs(13, |view, light| coloured(&truth, view, light)));
    let directions = grid(13, 48);
    let values: Vec<f32> = directions
        .iter()
        .flat_map(|&v| directions.iter().map(move |&l| (v, l)))
        .map(|(v, l)| coloured(&truth, v, l)[0] as f32)
        .collect();
    let grey = read(&array(&[13, 48, 13, 48], &values));
    assert!(!image.is_isotropic() && image.channels().len() == 3 && grey.channels().len() == 1);
    for [elevation, azimuth] in [[0.0, 0.0], [22.5, 37.5], [41.0, 100.0], [64.0, 250.0]] {
        let view = direction(elevation, azimuth);
        for (measured, red) in [(&grey, &grey), (&image, &image.channels()[0])] {
            let found = red.coefficients(view, 7);
            // The quadrature of what is linear between the entries, by texels of 0.7 degrees: at most l(l+1) Δ²/24 of band 6.
            let error = apart(&measured.coefficients(view, 7), &by_a_map(measured, view, 7));
            assert!(error < 1e-3, "at {elevation}, {azimuth}: {error:.1e}");
            // Steps of 7.5 degrees: (π/24)²/8 times the curvature 2/0.25 of the lobe in either direction.
            let error = apart(&found, &truth.coefficients(view, 7));
            assert!(error < 0.04, "at {elevation}, {azimuth}: {error:.1e}");
        }
    }
    // At the entries themselves.
    for (view, light) in [(3 * 48 + 5, 5 * 48 + 30), (7 * 48, 48), (11 * 48 + 47, 2 * 48 + 9)] {
        let (view, light) = (directions[view], directions[light]);
        let (found, wanted) = (image.values(view, light), truth.value(view, light));
        assert!((found[2] - 0.25 * wanted).abs() < 1e-6 * (1.0 + wanted), "{found:?}, {wanted}");
    }
}

#[test]
fn an_isotropic_array_turns_with_the_view() {
    let truth = brdf("phong:5");
    let (views, lights) = (grid(19, 1), grid(19, 72));
    let values: Vec<f32> = views
        .iter()
        .flat_map(|&v| lights.iter().map(move |&l| (v, l)))
        .flat_map(|(v, l)| coloured(&truth, v, l))
        .map(|x| x as f32)
        .collect();
    let measured = read(&array(&[19, 1, 19, 72, 3], &values));
    assert!(measured.is_isotropic());
    for [elevation, azimuth] in [[10.0, 0.0], [35.0, 77.0], [75.0, 200.0]] {
        let view = direction(elevation, azimuth);
        let error = apart(&measured.channels()[0].coefficients(view, 6), &truth.coefficients(view, 6));
        // Steps of 5 degrees: (π/36)²/8 times 5, the curvature of the lobe, twice.
        assert!(error < 0.01, "at {elevation}: {error:.1e}");
    }
}

#[test]
fn what_is_no_table_is_refused_with_what_is_wrong() {
    let flat = |value: f64| merl(|_, _| [value; 3]);
    let bytes = flat(0.5);
    let with = |at: usize, value: f64| {
        let mut bytes = bytes.clone();
        bytes[12 + 8 * at..][..8].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let mut size = bytes.clone();
    size[8] = 90;
    let shape = |shape: &[usize], count: usize| array(shape, &vec![0.5; count]);
    let nan = array(&[2, 3, 2, 3], &[0.5, 0.5, f32::NAN].repeat(12));
    for (bytes, said) in [
        (vec![], "it is empty"),
        (vec![1, 2, 3], "its 3 bytes are too few"),
        (size, "instead of 90, 90 and 180"),
        (bytes[..bytes.len() - 1].to_vec(), "ends too early"),
        (bytes[..1000].to_vec(), "ends too early"),
        ([&bytes[..], &[0]].concat(), "goes on too long"),
        (with(16_200 + 180 + 2, f64::NAN), "NaN at half angle 1, difference angle 1, azimuth 2"),
        (with(5, f64::INFINITY), "inf at half angle 0"),
        (with(5, 1e300), "1 of its 1458000 entries are no reflectance"),
        (flat(0.0), "no entry is above zero"),
        (flat(-2.0), "no entry is above zero"),
        (shape(&[2, 2, 2, 3], 24), "shape [2, 2, 2, 3]"),
        (shape(&[2, 3, 2, 3, 2], 72), "shape [2, 3, 2, 3, 2]"),
        (shape(&[1, 3, 2, 3], 18), "shape [1, 3, 2, 3]"),
        (shape(&[36], 36), "shape [36]"),
        (shape(&[2, 3, 2, 3], 35), "holds 140 bytes"),
        (shape(&[usize::MAX, 3, 2, 3], 36), "holds 144 bytes"),
        (nan, "NaN at view 0, light 2"),
        (b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), "head of the array is damaged"),
        (b"\x93NUMPY".to_vec(), "head of the array is damaged"),
        (pairs(3, |_, _| [-1.0; 3]), "no entry is above zero"),
        (pairs(3, |_, light| [light[0] / 0.0; 3]), "are no reflectance"),
        (pairs(4, |_, _| [0.5; 3])[..900].to_vec(), "test"),
    ] {
        let fault = fault(&bytes);
        assert!(fault.message.contains(said) && fault.message.starts_with("test"), "{said}: {fault}");
        assert!(!fault.help.is_empty() || said == "test", "{fault}");
    }
    // An image of another size, an array of integers, of the other order.
    let other = pairs(2, |_, _| [0.5; 3]);
    let text = String::from_utf8_lossy(&shape(&[2, 3, 2, 3], 36)).into_owned();
    assert!(text.contains("<f4"));
    let replaced = |from: &[u8], to: &[u8]| {
        let bytes = shape(&[2, 3, 2, 3], 36);
        let at = bytes.windows(from.len()).position(|window| window == from).expect("is there");
        [&bytes[..at], to, &bytes[at + from.len()..]].concat()
    };
    assert!(Measured::from_bytes("test", &other).is_ok());
    assert!(fault(&replaced(b"<f4", b"<i4")).message.contains("`<i4`"));
    assert!(fault(&replaced(b"False", b"True ")).message.contains("first index"));
    // Devices do not end.
    let device = Measured::read(Path::new("/dev/zero")).expect_err("it is no file");
    assert!(device.message.contains("not a regular file"), "{device}");
}

/// A folder with a scene of a reflectance, and the scene's path.
fn scene(name: &str, reflectance: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("writable");
    let map = repository("scenes/maps/city_256x128.hdr");
    let text = format!(
        "name = \"table\"\n[environment]\nmap = {:?}\nsignal = \"radiance\"\nbudget = 0.05\n[brdf]\n{reflectance}\n",
        map.display().to_string()
    );
    std::fs::write(folder.join("table.toml"), text).expect("writable");
    folder.join("table.toml")
}

#[test]
fn a_scene_is_planned_as_with_the_reflectance_that_was_measured() {
    let truth = brdf("phong:10");
    let analytic = Plan::new(&Scene::read(&scene("measured", "kind = \"phong\"\nexponent = 10")).expect("a scene"));
    let analytic = analytic.expect("a plan").environment.expect("an environment");
    let path = scene("measured", "kind = \"measured\"\nfile = \"table.npy\"");
    let lights = grid(31, 144);
    let values: Vec<f32> = grid(31, 1)
        .iter()
        .flat_map(|&view| lights.iter().map(move |&light| (view, light)))
        .map(|(view, light)| (coloured(&truth, view, light)[0]) as f32)
        .collect();
    std::fs::write(path.with_file_name("table.npy"), array(&[31, 1, 31, 144], &values)).expect("writable");
    let plan = Plan::new(&Scene::read(&path).expect("a scene")).expect("a plan").environment.expect("an environment");
    assert_eq!(plan.order, analytic.order);
    for (found, wanted) in plan.errors.iter().zip(&analytic.errors) {
        // What is linear over steps of 3 degrees holds up to (l τ)²/12 less of band l, 2 % of band 10, twice that of its energy.
        assert!((found - wanted).abs() < 0.06 * wanted + 1e-3, "{found}, {wanted}");
    }
    let said = printed(command().arg("plan").arg(&path));
    assert!(
        said.contains("measured:table.npy") && said.contains("31 × 1 views and 31 × 144 lights, isotropic, grey"),
        "{said}"
    );
    let map = repository("scenes/maps/city_256x128.hdr");
    let table = path.with_file_name("table.npy");
    let told = printed(command().arg("project").arg(map).arg("--brdf").arg(format!("measured:{}", table.display())));
    assert!(told.contains("measured:"), "{told}");
    // The fault is shown where the file is named.
    for (reflectance, said) in [
        ("kind = \"measured\"", "this kind needs its `file`"),
        ("kind = \"measured\"\nfile = \"none.exr\"", "none.exr: cannot be read"),
        ("kind = \"measured\"\nfile = \"table.toml\"", "it is no tabulated reflectance"),
        ("kind = \"measured\"\nfile = \"table.npy\"\nalpha = 0.2", "this kind has no `alpha`"),
        ("kind = \"ward\"\nalpha = 0.2\nfile = \"table.npy\"", "this kind has no `file`"),
    ] {
        let error = Scene::read(&scene("measured_bad", reflectance)).expect_err("it is at fault");
        assert!(error.to_string().contains(said), "{error}");
    }
    let folder = Maps::Folder(path.parent().expect("a folder").to_owned());
    assert!(Scene::parse("a", "name = \"a\"\n[brdf]\nkind = \"measured\"\nfile = \"table.npy\"\n", folder).is_ok());
}
