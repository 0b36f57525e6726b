//! `docs/VISIBILITY.md` is what is measured of shading with visibility, and what it says holds. Written with
//! `UPDATE=1 cargo test -p zonal-render --test it visibility`, which takes a minute for its pictures.

use crate::report::{repository, split};
use zonal_codegen::environment::Map;
use zonal_picture::mesh::Mesh;
use zonal_render::visibility::page::Subjects;

fn subjects() -> Subjects {
    let mesh = |name: &str| {
        let path = format!("scenes/meshes/{name}.obj");
        let bytes = std::fs::read(repository(&path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        (name.to_owned(), Mesh::from_obj(name, &bytes).unwrap_or_else(|error| panic!("{error}")))
    };
    let map = |name: &str| {
        let path = repository(&format!("scenes/maps/{name}_256x128.hdr"));
        (name.to_owned(), Map::read(&path).unwrap_or_else(|error| panic!("{error}")))
    };
    Subjects::new(["bunny", "teapot"].map(mesh).to_vec(), ["interior", "night"].map(map))
}

#[test]
fn the_page_is_what_is_measured_and_visibility_converges() {
    let subjects = subjects();
    let report = subjects.measure().unwrap_or_else(|error| panic!("{error}"));
    let (path, fresh) = (repository("docs/VISIBILITY.md"), report.markdown());
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &fresh).expect("writable");
        let pictures = [("visibility", subjects.visible(2)), ("local_lights", subjects.lit(2))];
        for (name, canvas) in pictures {
            let canvas = canvas.unwrap_or_else(|error| panic!("{error}"));
            std::fs::write(repository(&format!("docs/{name}.png")), canvas.png()).expect("writable");
        }
    }
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let ((words, numbers), (old_words, old_numbers)) = (split(&fresh), split(&old));
    let help = "docs/VISIBILITY.md is stale; run `UPDATE=1 cargo test -p zonal-render --test it visibility`";
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Two digits are printed, and the last may be rounded the other way.
        assert!((new - old).abs() <= 0.02 * new.abs().max(old.abs()) + 1e-9, "{help}: {new} stands as {old}");
    }

    for equal in &report.equal {
        // Some thousand roundings of numbers that are as large as the root mean square, give or take a digit.
        assert!(equal.wide.iter().all(|x| *x <= 1e-12) && equal.narrow.iter().all(|x| *x <= 1e-6), "{equal:?}");
        assert!(equal.cut > 1e-3, "{equal:?}");
    }
    for costs in &report.costs {
        assert!(costs.pixel < costs.paper.iter().sum(), "{costs:?}");
    }
    // Visibility errs less with every few bands, to a fifth of what leaving it out costs, which no band makes good.
    let rows = &report.convergence;
    let errors: Vec<f64> = rows.iter().step_by(3).take(5).map(|row| row.with).collect();
    assert!(errors.is_sorted_by(|few, many| few > many), "{rows:?}");
    let last = rows.last().expect("there are orders");
    assert!(last.order == 20 && last.with < 0.2 * last.without && last.without > 0.9 * rows[8].without, "{rows:?}");
    for pictured in &report.pictured {
        let by_order: Vec<f64> = pictured.errors.iter().map(|[_, with]| with.rms).collect();
        assert!(by_order.is_sorted_by(|a, b| a > b), "{}: {by_order:?}", pictured.name);
        assert!(pictured.errors.iter().all(|[without, with]| with.rms < without.rms), "{}", pictured.name);
    }
    for [near, far] in &report.lit {
        assert!(near.rms < far.rms, "{near:?} {far:?}");
    }
}
