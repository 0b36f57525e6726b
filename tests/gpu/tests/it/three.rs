//! Coefficients of a map in three.js: a light probe of those that `zonal project --convention three_js` prints, lit by
//! three.js's own shader, against a kernel of zonal with those of `--axes three_js`, at the same normals in WebGL2.

use serde_json::{Value, json};
use std::f64::consts::PI;
use std::process::Command;
use zonal_codegen::promise::samples::Random;
use zonal_gpu_tests::system::missing;
use zonal_tests::command::Folder;
use zonal_tests::repository;

/// Rounding in f32 of nine products, and the six digits of three.js's constants, of which 0.743125 is 1.6e-6 too large.
const TOLERANCE: f64 = 1e-5;

fn coefficients(folder: &Folder, arguments: &[&str]) -> Value {
    let map = repository("scenes/maps/studio_256x128.hdr");
    let map = map.to_str().expect("UTF-8");
    let run = folder.run([&["project", map, "--order", "3", "--json"], arguments].concat());
    assert_eq!(run.code, Some(0), "{}", run.err);
    let printed: Value = serde_json::from_str(&run.out).expect("prints JSON");
    printed["coefficients"].clone()
}

/// What the page of three.js answers to a job.
fn asked(work: &Folder, what: &str, job: &Value) -> Value {
    work.put("job.json", job.to_string());
    let mut node = Command::new("node");
    let output = node.arg(repository("tests/browser/three.mjs")).arg(work.path("")).arg(what).output();
    let output = output.unwrap_or_else(|_| panic!("{}", missing("Node", "nodejs npm")));
    assert!(output.status.success(), "the browser's script fails:\n{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("the script prints JSON")
}

/// The largest difference of the irradiance, over the largest irradiance.
fn difference(lit: &Value) -> f64 {
    let rows = |key: &str| -> Vec<[f64; 3]> { serde_json::from_value(lit[key].clone()).expect("rows of three") };
    // A white surface sends out what reaches it over π.
    let probe: Vec<f64> = rows("probe").into_iter().flatten().map(|value| PI * value).collect();
    let kernel: Vec<f64> = rows("kernel").into_iter().flatten().collect();
    assert_eq!((probe.len(), kernel.len()), (300, 300));
    let largest = kernel.iter().copied().fold(0.0, f64::max);
    assert!(largest > 0.1, "the light is dark: {largest}");
    probe.iter().zip(&kernel).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

#[test]
fn a_light_probe_of_three_js_and_a_kernel_give_one_irradiance() {
    let _turn = crate::turn();
    let work = Folder::new();
    let shown = work.run(["show", "eval:3:rgb", "--target", "glsl"]);
    assert_eq!(shown.code, Some(0), "{}", shown.err);
    let mut random = Random::new(3);
    let normals: Vec<[f64; 3]> = (0..100).map(|_| random.unit()).collect();
    let with = |probe: &[&str], kernel: &[&str]| {
        let kernel = coefficients(&work, &[kernel, &["--irradiance"]].concat());
        let job = json!({
            "normals": normals,
            "probe": coefficients(&work, probe),
            "coefficients": kernel,
            "kernel": shown.out,
            "name": "sh3_eval_rgb",
        });
        difference(&asked(&work, "lit", &job))
    };
    let right = with(&["--convention", "three_js"], &["--axes", "three_js"]);
    assert!(right < TOLERANCE, "{right:e}");
    // Without signs or without axes it is another light.
    let wrong = [with(&["--axes", "three_js"], &["--axes", "three_js"]), with(&["--convention", "three_js"], &[])];
    assert!(wrong.iter().all(|&wrong| wrong > 0.1), "{wrong:?}");
    println!("three.js's light probe and the kernel differ by {right:e}");
}

/// A face of a cubemap as a PNG: its number in red, its columns in green and its rows in blue.
fn face(number: u8) -> Vec<u8> {
    const SIDE: u8 = 32;
    let texels = (0..SIDE).flat_map(|y| (0..SIDE).flat_map(move |x| [40 * number + 30, 30 + 7 * x, 30 + 5 * y]));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE.into(), SIDE.into());
    encoder.set_color(png::ColorType::Rgb);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels.collect::<Vec<u8>>()));
    written.expect("memory takes any image");
    bytes
}

/// three.js sums a texel at its centre, zonal over its area: by the second order in the width of 32 texels, a thousandth.
#[test]
fn a_cubemap_is_seen_mirrored_as_three_js_shows_it() {
    let _turn = crate::turn();
    let work = Folder::new();
    let names = ["px", "nx", "py", "ny", "pz", "nz"];
    let faces: Vec<Vec<u8>> = (0..)
        .zip(names)
        .map(|(number, name)| {
            let bytes = face(number);
            std::fs::create_dir_all(work.path("faces")).expect("can be made");
            std::fs::write(work.path(&format!("faces/{name}.png")), &bytes).expect("can be written");
            bytes
        })
        .collect();
    let own: Vec<f64> = serde_json::from_value(asked(&work, "probed", &json!({ "faces": faces }))).expect("numbers");
    let zonal = |axes: &str| -> Vec<f64> {
        let run = work.run(["project", "faces", "--order", "3", "--json", "--convention", "three_js", "--axes", axes]);
        assert_eq!(run.code, Some(0), "{}", run.err);
        let printed: Value = serde_json::from_str(&run.out).expect("prints JSON");
        let rows: Vec<[f64; 3]> = serde_json::from_value(printed["coefficients"].clone()).expect("rows of three");
        rows.into_iter().flatten().collect()
    };
    let difference = |axes: &str| {
        let zonal = zonal(axes);
        assert_eq!((own.len(), zonal.len()), (27, 27));
        let largest = own.iter().map(|value| value.abs()).fold(0.0, f64::max);
        own.iter().zip(&zonal).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
    };
    let (right, wrong) = (difference("-x,z,y"), difference("x,z,y"));
    assert!(right < 1e-3, "{right:e}");
    assert!(wrong > 0.05, "{wrong:e}");
    println!("three.js's probe of a cubemap differs by {right:e}");
}

#[test]
fn its_parsers_read_bare_functions() {
    let work = Folder::new();
    let shown = |target: &str, form: &[&str]| {
        let run = work.run([&["show", "eval:3:rgb", "--target", target], form].concat());
        assert_eq!(run.code, Some(0), "{}", run.err);
        json!({ "language": target, "text": run.out })
    };
    let bare = ["--form", "bare"];
    work.put("jobs.json", json!([shown("glsl", &[]), shown("glsl", &bare), shown("wgsl", &bare)]).to_string());
    let mut node = Command::new("node");
    let output = node.arg(repository("tests/browser/functions.mjs")).arg(work.path("jobs.json")).output();
    let output = output.unwrap_or_else(|_| panic!("{}", missing("Node", "nodejs npm")));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let seen: Vec<Value> = serde_json::from_slice(&output.stdout).expect("the script prints JSON");
    assert!(seen[0]["error"].is_string(), "guards are no function: {}", seen[0]);
    for seen in &seen[1..] {
        assert_eq!((&seen["name"], &seen["inputs"]), (&json!("sh3_eval_rgb"), &json!(["dir", "c"])), "{seen}");
        assert!(["vec3", "vec3<f32>"].contains(&seen["type"].as_str().expect("a name")), "{seen}");
    }
}
