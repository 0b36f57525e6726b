//! `docs/LIGHTMAPS.md` is what is measured in the room with a lightmap, and the bases rank as Habel and Wimmer say. Written
//! with `UPDATE=1 cargo test -p zonal-render --test it lightmap`, which takes some minutes for its picture.

use crate::report::{repository, split};
use indicatif::ProgressBar;
use zonal_codegen::environment::Map;
use zonal_picture::mesh::Mesh;
use zonal_picture::normal_map::NormalMap;
use zonal_render::lightmap::page::Report;
use zonal_render::lightmap::seen::Relief;

fn measured(samples: usize) -> Report {
    let bytes = |path: &str| std::fs::read(repository(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    let map = Map::read(&repository("scenes/maps/night_256x128.hdr")).unwrap_or_else(|error| panic!("{error}"));
    let object = Mesh::from_obj("teapot", &bytes("scenes/meshes/teapot.obj")).unwrap_or_else(|error| panic!("{error}"));
    let normals = NormalMap::from_bytes("normals", &bytes("scenes/normals/0015.webp"));
    let relief = Relief { normals: normals.unwrap_or_else(|error| panic!("{error}")), strength: 1.0 };
    Report::measure("night", &map, &object, &relief, samples, &ProgressBar::hidden())
        .unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_page_is_what_is_measured_and_the_bases_rank_as_the_paper_says() {
    let report = measured(1);
    let (path, fresh) = (repository("docs/LIGHTMAPS.md"), report.markdown());
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &fresh).expect("writable");
        std::fs::write(repository("docs/lightmaps.png"), measured(2).canvas().png()).expect("writable");
    }
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let ((words, numbers), (old_words, old_numbers)) = (split(&fresh), split(&old));
    let help = "docs/LIGHTMAPS.md is stale; run `UPDATE=1 cargo test -p zonal-render --test it lightmap`";
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Two digits are printed, and the last may be rounded the other way.
        assert!((new - old).abs() <= 0.02 * new.abs().max(old.abs()) + 1e-9, "{help}: {new} stands as {old}");
    }

    let at = |name: &str| report.ways.iter().position(|way| way.name == name).expect("a way of that name");
    let [flat, hl2, h4, h6] = ["flat", "hl2", "h4", "h6"].map(at);
    for errors in [&report.baked, &report.own] {
        assert!(errors[h6].rms < errors[h4].rms && errors[h4].rms < errors[hl2].rms, "{errors:?}");
        assert!(errors[h4].rms < errors[flat].rms);
    }
    // What H6 has beyond H4 it has where normals lean; each range has all that lean less, too.
    let by_lean: Vec<f64> = report.leans.iter().map(|lean| lean.errors[h6] / lean.errors[h4]).collect();
    assert!(by_lean.is_sorted_by(|steep, flat| steep < flat) && by_lean[0] < 0.6, "{by_lean:?}");
    // A mean that is shorter than one says how wide the normals lie around it; two by two of them hardly do.
    for level in &report.levels[2..] {
        for way in [hl2, h4, h6] {
            assert!(level.as_it_is[way] < 0.95 * level.normalised[way], "{level:?}");
        }
    }
    let last = report.levels.last().expect("there are levels");
    for way in [h4, h6] {
        assert!(last.normalised[way] > 3.0 * last.as_it_is[way], "{last:?}");
    }
}
