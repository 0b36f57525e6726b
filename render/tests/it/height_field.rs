//! `docs/HEIGHT_FIELD.md` is what is measured of light turned into every frame. Written with
//! `UPDATE=1 cargo test -p zonal-render --test it height_field`, which draws and takes times.

use crate::report::{repository, split};
use zonal_codegen::environment::Map;
use zonal_render::field::page::{Subject, TIMES};
use zonal_render::field::ways::Turn;
use zonal_render::gpu::Gpu;

#[test]
fn the_page_is_what_is_measured_and_all_ways_are_one() {
    let map = Map::read(&repository("scenes/maps/sunset_256x128.hdr")).unwrap_or_else(|error| panic!("{error}"));
    let subject = Subject::new("sunset", &map);
    let report = subject.measure().unwrap_or_else(|error| panic!("{error}"));
    let (path, fresh) = (repository("docs/HEIGHT_FIELD.md"), report.markdown());
    if std::env::var_os("UPDATE").is_some() {
        let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
        let (canvas, times) = subject.draw(&gpu).unwrap_or_else(|error| panic!("{error}"));
        std::fs::write(&path, fresh.clone() + &times).expect("writable");
        std::fs::write(repository("docs/height_field.png"), canvas.png()).expect("writable");
    }
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let old = old.split(&format!("\n{TIMES}")).next().unwrap_or_default();
    let ((words, numbers), (old_words, old_numbers)) = (split(&fresh), split(old));
    let help = "docs/HEIGHT_FIELD.md is stale; run `UPDATE=1 cargo test -p zonal-render --test it height_field`";
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Two digits are printed, and the last may be rounded the other way.
        assert!((new - old).abs() <= 0.02 * new.abs().max(old.abs()) + 1e-9, "{help}: {new} stands as {old}");
    }

    let object = report.rows.last().expect("there are ways").operations[0];
    for row in &report.rows {
        // f32 rounds some hundred times, and the mean radiance is less than the norms of light and transfer.
        assert!(row.exact.worst <= 1e-12 || !row.way.is_exact(), "{}: {:?}", row.way.name, row.exact);
        match row.way.turn {
            _ if !row.way.is_exact() => assert!(row.exact.worst > 1e-3, "{:?}", row.exact),
            // What is read errs by a hundredth of each band's largest value, which is more than a point's share of it.
            Turn::Samples => assert!((1e-4..0.1).contains(&row.errors.rms), "{:?}", row.errors),
            _ => assert!(row.errors.worst <= 1e-5, "{}: {:?}", row.way.name, row.errors),
        }
        assert!(row.operations[0] >= object);
    }
    // The steeper, the worse; within five degrees a hundredth.
    let leans = &report.leans;
    assert!(leans.is_sorted_by(|flat, steep| flat[2] < steep[2]) && leans[0][2] < 0.01, "{leans:?}");
    let [symmetric, isotropic] = report.kept;
    assert!(symmetric.rms > 1e-3 && isotropic.rms > symmetric.rms, "{:?}", report.kept);
}
