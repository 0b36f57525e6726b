//! `docs/BANDS.md` is what `cargo render page bands` measures: a part of it is measured again, and what it says of tables holds.

use crate::report::{repository, split};
use indicatif::ProgressBar;
use zonal_codegen::scene::Scene;
use zonal_picture::method::{Method, Reading};
use zonal_render::bands_page::{ERRORS, forms_text, rows, sides};
use zonal_render::gpu::Gpu;
use zonal_render::pages::subject;
use zonal_render::subject::{Instead, Subject};

const HELP: &str = "docs/BANDS.md is stale; run `cargo render page bands`";

fn page() -> String {
    std::fs::read_to_string(repository("docs/BANDS.md")).unwrap_or_else(|error| panic!("{error}: {HELP}"))
}

/// A line of a page that begins as another one does says the same, to the last of two digits.
pub fn stands(page: &str, line: &str, begins: usize, help: &str) {
    let start: Vec<&str> = line.splitn(begins + 2, '|').take(begins + 1).collect();
    let start = start.join("|");
    let old = page.lines().find(|old| old.starts_with(&start)).unwrap_or_else(|| panic!("no line `{start}`: {help}"));
    let ((words, numbers), (old_words, old_numbers)) = (split(line.trim_end()), split(old));
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Another driver filters a little differently, which the least errors show.
        assert!((new - old).abs() <= 0.12 * new.abs().max(old.abs()), "{help}: {new} stands as {old} in {line}");
    }
}

#[test]
fn the_page_is_what_is_measured_and_reads_err_as_is_asked_for() {
    let page = page();
    let subject = subject(&repository("scenes")).unwrap_or_else(|error| panic!("{error}"));
    for side in sides(&subject.light(5), &[1, 4]).unwrap_or_else(|error| panic!("{error}")) {
        stands(&page, &side.line(), 1, HELP);
        assert!(side.sides.iter().zip(ERRORS).all(|((_, error), asked)| *error <= asked), "{side:?}");
        assert!(side.papers < ERRORS[2], "{side:?}");
    }
    let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
    let rows = rows(&gpu, &subject, &[3], &ProgressBar::hidden()).unwrap_or_else(|error| panic!("{error}"));
    for row in &rows {
        stands(&page, &row.line(), 2, HELP);
        // Errors of reads are independent enough that their sum is no larger than one.
        assert!(row.errors.iter().all(|errors| errors.rms < row.asked), "{row:?}");
    }
    // An error that is ten times less takes ten times the texels, and the picture errs ten times less.
    for pair in rows.windows(2) {
        for i in 0..2 {
            let ratio = pair[0].errors[i].rms / pair[1].errors[i].rms;
            assert!((5.0..20.0).contains(&ratio), "{pair:?}");
        }
        assert!((5.0..20.0).contains(&(pair[1].bytes as f64 / pair[0].bytes as f64)), "{pair:?}");
    }
    assert!(page.contains(&forms_text()), "{HELP}");
    assert_eq!(Reading::of(Method::IsdTables, 5).expect("it reads").reads, 25);
    assert_eq!(Reading::of(Method::Exact, 5), None);
}

/// An isotropic surface is looked up with its view to the side of x.
#[test]
fn an_isotropic_surface_is_drawn_from_tables_too() {
    let scene = Scene::read(&repository("scenes/lights.toml")).unwrap_or_else(|error| panic!("{error}"));
    let subject = Subject::new(&scene, Instead { order: Some(5), method: Some(Method::IsdTables) });
    let subject = subject.unwrap_or_else(|error| panic!("{error}"));
    assert!(subject.brdf.is_isotropic() && !subject.lights.is_empty());
    let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
    let rows = rows(&gpu, &subject, &[4], &ProgressBar::hidden()).unwrap_or_else(|error| panic!("{error}"));
    assert!(rows.iter().all(|row| row.errors.iter().all(|errors| errors.rms < row.asked)), "{rows:?}");
}

#[test]
fn orders_that_a_method_has_not_are_refused() {
    let scene = Scene::read(&repository("scenes/teapot.toml")).unwrap_or_else(|error| panic!("{error}"));
    for (order, method, part) in [(11, Method::ZhfTailored, "2 to 10"), (2, Method::IsdTables, "3 to 12")] {
        let refused = Subject::new(&scene, Instead { order: Some(order), method: Some(method) });
        let message = refused.expect_err("it has no such order").to_string();
        assert!(message.contains(&format!("`{method}` has the orders {part}, not {order}")), "{message}");
    }
}
