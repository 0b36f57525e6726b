//! `docs/PICTURES.md` is what the renderer measures, and what it says is what the papers claim. Written with
//! `UPDATE=1 cargo test -p zonal-render report`.

use indicatif::ProgressBar;
use std::path::{Path, PathBuf};
use zonal_codegen::environment::Map;
use zonal_codegen::scene::Scene;
use zonal_picture::method::{Judged, Method};
use zonal_render::gpu::Gpu;
use zonal_render::report::{LIT, METHODS, Report};
use zonal_render::subject::{Instead, Subject};

pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn subject(scene: &str) -> Subject {
    let scene = Scene::read(&repository(scene)).unwrap_or_else(|error| panic!("{error}"));
    Subject::new(&scene, Instead::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn measured() -> Report {
    let (subject, lit) = (subject("scenes/teapot.toml"), subject("scenes/lights.toml"));
    let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
    let maps = ["courtyard", "city"].map(|name| {
        let path = repository(&format!("scenes/maps/{name}_256x128.hdr"));
        (name, Map::read(&path).unwrap_or_else(|error| panic!("{error}")))
    });
    Report::measure(&gpu, &subject, &maps, &lit, &ProgressBar::hidden()).unwrap_or_else(|error| panic!("{error}"))
}

/// A text with a mark for every number, and the numbers.
pub fn split(text: &str) -> (String, Vec<f64>) {
    let (mut words, mut numbers, mut open) = (String::new(), Vec::new(), String::new());
    for c in text.chars().chain(['\n']) {
        let inside = c.is_ascii_digit() || (!open.is_empty() && c == '.');
        if inside {
            open.push(c);
        } else {
            if !open.is_empty() {
                numbers.push(open.trim_end_matches('.').parse().expect("digits"));
                words.push('#');
                open.clear();
            }
            words.push(c);
        }
    }
    (words, numbers)
}

#[test]
fn the_page_is_what_is_measured_and_the_papers_claim_holds() {
    let report = measured();
    let (path, fresh) = (repository("docs/PICTURES.md"), report.markdown());
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &fresh).expect("writable");
    }
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let ((words, numbers), (old_words, old_numbers)) = (split(&fresh), split(&old));
    let help = "docs/PICTURES.md is stale; run `UPDATE=1 cargo test -p zonal-render report`";
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Two digits are printed, of which another driver may change the last: it rasterises a few edge pixels otherwise.
        assert!((new - old).abs() <= 0.12 * new.abs().max(old.abs()), "{help}: {new} stands as {old}");
    }

    let tilt = METHODS.iter().position(|method| *method == Method::Tilt).expect("one of them");
    for (map, cases) in &report.maps {
        for case in cases {
            let [taylor, lf3, _, none] = case.against_exact.map(|errors| errors.mean);
            let name = format!("{} under {map}", case.brdf);
            // Ours to the paper's: both shears are more accurate than its expansion, and all are much better than nothing.
            assert!(lf3 < taylor && case.against_exact[tilt].mean < taylor, "{name}");
            assert!(none > 5.0 * taylor, "{name}: {none} {taylor}");
            // Leaving bands out is an error of its own, yet the turn is seen through it.
            let truth = case.against_truth.map(|errors| errors.mean);
            assert!(truth[4] > truth[1 + tilt], "{name}: {truth:?}");
            assert!((truth[1 + tilt] / truth[0] - 1.0).abs() < 0.05, "{name}: {truth:?}");
        }
    }
    assert!(Method::Tilt.cost(report.order).total < Method::Taylor15.cost(report.order).total);

    for (exponent, rows) in &report.convergence.1 {
        for pair in rows.windows(2) {
            assert!(pair[1].errors.rms < pair[0].errors.rms, "phong:{exponent} {pair:?}");
        }
        for row in rows {
            // One object is one sample of the rotations that the expectation is over.
            let ratio = row.errors.rms / row.expected;
            assert!((0.6..1.6).contains(&ratio), "phong:{exponent} {row:?}");
        }
    }
    for (brdf, rows) in &report.lit.2 {
        for pair in rows.windows(2) {
            // Of Lambert's lobe the odd bands from 3 on are nothing.
            assert!(pair[1].errors.rms <= pair[0].errors.rms * 1.05, "{brdf} {pair:?}");
        }
        // What is left at order 10 is what the lobe has above, and tables near grazing, no light that is missing or elsewhere.
        let last = rows.last().expect("there are orders");
        let most = if *brdf == LIT[2] { 0.15 } else { 0.02 };
        assert!(last.errors.rms < most && last.errors.rms < rows[0].errors.rms / 9.0, "{brdf} {last:?}");
    }
    // An exponent of s needs about √s bands, so four times the exponent twice as many; light has less in higher bands.
    let needed: Vec<f64> = report.convergence.1.iter().filter_map(|(_, rows)| Report::order_for(rows, 0.5)).collect();
    assert_eq!(needed.len(), 3);
    for pair in needed.windows(2) {
        assert!((1.4..2.2).contains(&(pair[1] / pair[0])), "{needed:?}");
    }
}
