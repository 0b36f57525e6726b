//! `docs/CACHE.md` is what is measured: of its first table all but the times and what brute force takes a minute for.

use std::path::Path;
use zonal_cache::basis::SH6;
use zonal_cache::page::{ERROR, FULL, rows};
use zonal_cache::record::Sampling;
use zonal_cache::scene::{OBJECTS, Scene};
use zonal_cache::study::{CAMERA, Setup, filled, table};
use zonal_cache::view::View;

/// The columns of a row: the method, its kernels, how many rotations, the share done exactly, the error against exact ones.
fn held(line: &str) -> Option<[&str; 5]> {
    let columns: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    (columns.len() == 8).then(|| [0, 1, 4, 5, 6].map(|i| columns[i]))
}

#[test]
fn the_first_table_of_the_page_is_what_is_measured() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/CACHE.md");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let help = "docs/CACHE.md is stale; run `cargo run -p zonal-cache -- page`";
    let section = text.split("## Spherical harmonics of order 6").nth(1).expect(help);
    let section = section.split("\n## ").next().unwrap_or_default();
    let scene = Scene::objects().expect("the bunny is there");
    let view = View::new(&scene, &CAMERA, FULL.side);
    assert!(text.contains(&format!("of which {} show something glossy", view.glossy.len())), "{help}");
    // Errors against brute force are not looked at.
    let truth = vec![[1.0; 3]; view.glossy.len()];
    let sampling = Sampling { rays: FULL.rays, seed: FULL.seed };
    let setup = Setup { scene: &scene, gloss: OBJECTS, view: &view, truth: &truth, sampling };
    let (cache, _) = filled(&setup, SH6, ERROR, &|| ());
    let count = format!("At a = {ERROR}, {} records", cache.records.len());
    assert!(section.contains(&count), "{help}: {count}");
    let found = rows(&table(&setup, &cache, 0.0));
    let printed: Vec<[&str; 5]> = section.lines().filter_map(held).collect();
    let mut seen = 0;
    for row in found.lines().filter_map(held) {
        assert!(printed.contains(&row), "{help}: {row:?}");
        seen += usize::from(SH6.methods.iter().any(|method| method.name == row[0]));
    }
    assert_eq!(seen, SH6.methods.len());
}
