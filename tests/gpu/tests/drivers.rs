//! Every kernel on every driver against the interpreter; a corrupted constant that must show; the table of errors.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use zonal_codegen::catalog::standard;
use zonal_gpu_tests::bench::Row;
use zonal_gpu_tests::report::{self, LANGUAGES, Measured};
use zonal_gpu_tests::system::DRIVERS;

fn measure(mode: &str) -> Vec<Measured> {
    let worker = env!("CARGO_BIN_EXE_zonal-gpu-worker");
    DRIVERS.map(|driver| report::measure(worker, driver, mode).unwrap_or_else(|error| panic!("{error}"))).into()
}

/// The rows that one is not content with, as text.
fn listed(measured: &[Measured], bad: impl Fn(&Row) -> bool) -> String {
    let rows = |measured: &Measured| -> Vec<String> {
        measured.rows.iter().filter(|row| bad(row)).map(|row| format!("{}: {row}\n", measured.driver.name)).collect()
    };
    measured.iter().flat_map(rows).collect()
}

#[test]
fn every_kernel_agrees_with_the_interpreter_on_every_driver() {
    let measured = measure("catalogue");
    let specs: BTreeSet<String> = standard().iter().map(ToString::to_string).collect();
    for measured in &measured {
        for language in LANGUAGES {
            let rows = measured.rows.iter().filter(|row| row.target == language);
            let ran: BTreeSet<String> = rows.map(|row| row.spec.clone()).collect();
            assert_eq!(ran, specs, "{}, {language}", measured.driver.name);
        }
    }
    let table = report::markdown(&measured);
    // Not `print!`, which the test harness keeps to itself.
    std::io::stdout().write_all(table.as_bytes()).expect("there is an output");
    let wrong = listed(&measured, |row| !row.agrees());
    assert!(wrong.is_empty(), "driver, spec, language, change, error, tolerance:\n{wrong}");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/DRIVERS.md");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &table).expect("the table can be written");
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let checked = report::check(&written, &measured);
    assert_eq!(checked, Ok(()), "docs/DRIVERS.md is out of date: UPDATE=1 cargo test -p zonal-gpu-tests");
}

#[test]
fn a_corrupted_constant_is_noticed_on_every_driver() {
    let measured = measure("mutated");
    for measured in &measured {
        assert!(measured.rows.len() > 100, "{} texts are too few", measured.rows.len());
    }
    let unnoticed = listed(&measured, Row::agrees);
    assert!(unnoticed.is_empty(), "driver, spec, language, change, error, tolerance:\n{unnoticed}");
}
