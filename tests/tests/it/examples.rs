//! The examples of the packages, run as a reader runs them: what they write is what they say, and what they print is true.

use std::f64::consts::PI;
use std::process::Command;

use zonal_tests::command::{Folder, example, printed};

/// What an example prints with a folder of its own for `OUT_DIR`.
fn output(name: &str, folder: &Folder) -> String {
    printed(Command::new(example(name)).env("OUT_DIR", folder.path("")))
}

#[test]
fn the_build_script_writes_what_it_says() {
    let folder = Folder::new();
    let text = output("build_script", &folder);
    assert!(text.starts_with("cargo::rerun-if-changed=build.rs\n"), "{text}");
    assert_eq!(folder.names(), ["kernels.md", "kernels.rs", "kernels.wgsl"]);
    for name in folder.names() {
        let written = std::fs::read_to_string(folder.path(&name)).expect("readable");
        let line = format!("{}: {} lines\n", folder.path(&name).display(), written.lines().count());
        assert!(text.contains(&line), "{line} is not in\n{text}");
    }
    for function in ["fn sh3_eval_rgb(", "fn turn_light(", "pub fn eval_rgb<", "pub fn turn_light<"] {
        assert!(text.contains(function), "{function} is not in\n{text}");
    }
}

#[test]
fn the_irradiance_probe_is_that_of_its_sky() {
    let text = output("irradiance_probe", &Folder::new());
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split_whitespace().map(|number| number.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 4, "{text}");
    for row in rows {
        let [_, _, z, own @ ..] = &row[..] else { panic!("{text}") };
        let (world, object) = own.split_at(3);
        for (channel, (zenith, albedo)) in [(0.6, 0.3), (0.8, 0.2), (1.0, 0.1)].into_iter().enumerate() {
            // The bands 0 to 2 of a sky that depends on the height t alone: A_l (2l+1)/2 P_l(z) ∫ L(t) P_l(t) dt.
            let ground = 7.0 / 9.0 * albedo;
            let bands = [
                PI / 2.0 * (2.0 / 3.0 + ground),
                PI * (7.0 / 18.0 - ground / 2.0) * z,
                5.0 * PI / 8.0 / 12.0 * (3.0 * z * z - 1.0) / 2.0,
            ];
            let truth = zenith * bands.iter().sum::<f64>();
            // Twenty thousand directions, the horizon between two rows of them.
            assert!((world[channel] - truth).abs() < 1e-3, "{} is not {truth}:\n{text}", world[channel]);
            // The last printed digit of each.
            assert!((world[channel] - object[channel]).abs() < 1.1e-4, "{text}");
        }
    }
}
