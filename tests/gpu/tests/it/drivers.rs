//! Every kernel on every driver against the interpreter; a corrupted constant that must show; the table of errors.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use zonal_codegen::catalog::standard;
use zonal_codegen::emit::language::{Arrays, GLSL};
use zonal_gpu_tests::bench::ARRAYS;
use zonal_gpu_tests::devices::COLUMNS;
use zonal_gpu_tests::report::{self, Measured};
use zonal_gpu_tests::row::Row;
use zonal_tests::toys;

fn measure(mode: &str) -> Measured {
    let _turn = crate::turn();
    let measured = report::measure(env!("CARGO_BIN_EXE_zonal-gpu-worker"), mode);
    measured.unwrap_or_else(|error| panic!("{error}"))
}

/// Not `print!`, which the test harness keeps to itself.
fn say(text: &str) {
    std::io::stdout().write_all(text.as_bytes()).expect("there is an output");
}

/// The rows that one is not content with, as text.
fn listed(measured: &Measured, bad: impl Fn(&Row) -> bool) -> String {
    let rows: Vec<String> = measured.rows.iter().filter(|row| bad(row)).map(|row| format!("{row}\n")).collect();
    format!("spec, driver and language, change, error, tolerance, seconds:\n{}", rows.concat())
}

#[test]
fn every_kernel_agrees_with_the_interpreter_on_every_driver() {
    let measured = measure("catalogue");
    let specs: BTreeSet<String> = standard().iter().map(ToString::to_string).collect();
    for column in COLUMNS {
        let rows = measured.rows.iter().filter(|row| row.column == column.name());
        let ran: BTreeSet<String> = rows.map(|row| row.spec.clone()).collect();
        assert_eq!(ran, specs, "{}", column.name());
    }
    let table = report::markdown(&measured);
    say(&format!("{table}\n{}", report::times(&measured)));
    assert!(measured.rows.iter().all(Row::agrees), "{}", listed(&measured, |row| !row.agrees()));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/DRIVERS.md");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &table).expect("the table can be written");
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let checked = report::check(&written, &measured);
    assert_eq!(checked, Ok(()), "docs/DRIVERS.md is out of date: UPDATE=1 cargo test -p zonal-gpu-tests");
}

/// Constants that no result shows a thousandth of: how much of a bound is taken away for rounding, and where a share ends.
const UNSEEN: [(&str, &str); 2] = [("minimum:3", ": 32.0 became"), ("lerp_to_dc:3", ": 1.0 became")];

#[test]
fn a_corrupted_constant_is_noticed_on_every_driver() {
    let measured = measure("mutated");
    let family = |text: &str| report::family(&text.parse().expect("the bench prints specs"));
    let families: BTreeSet<String> = standard().iter().map(report::family).collect();
    for column in COLUMNS {
        let rows = measured.rows.iter().filter(|row| row.column == column.name());
        let ran: BTreeSet<String> = rows.map(|row| family(&row.spec)).collect();
        assert_eq!(ran, families, "{}", column.name());
    }
    let is_unseen = |row: &Row| UNSEEN.iter().any(|(spec, change)| row.spec == *spec && row.change.contains(change));
    let missed = |row: &Row| row.agrees() && !is_unseen(row);
    assert!(!measured.rows.iter().any(missed), "{}", listed(&measured, missed));
}

#[test]
fn arrays_passed_in_other_ways_give_the_same_on_every_driver() {
    let measured = measure("arrays");
    for column in COLUMNS {
        let ways: &[Arrays] = match column.target == &GLSL {
            true => &[Arrays::Struct, Arrays::Reference, Arrays::Vec4],
            false => &[Arrays::Vec4],
        };
        let named = |spec: &&str| ways.iter().map(|arrays| ((*spec).to_owned(), arrays.name().to_owned())).collect();
        let wanted: BTreeSet<(String, String)> = ARRAYS.iter().flat_map(|spec| -> Vec<_> { named(spec) }).collect();
        let rows = measured.rows.iter().filter(|row| row.column == column.name());
        let ran: BTreeSet<(String, String)> = rows.map(|row| (row.spec.clone(), row.change.clone())).collect();
        assert_eq!(ran, wanted, "{}", column.name());
    }
    assert!(measured.rows.iter().all(Row::agrees), "{}", listed(&measured, |row| !row.agrees()));
}

/// Choices, roots, powers and logarithms, and products of signals.
#[test]
fn toys_agree_with_the_interpreter_on_every_driver() {
    let measured = measure("toys");
    let specs: BTreeSet<String> = toys::specs().iter().map(ToString::to_string).collect();
    for column in COLUMNS {
        let rows = measured.rows.iter().filter(|row| row.column == column.name());
        let ran: BTreeSet<String> = rows.map(|row| row.spec.clone()).collect();
        assert_eq!(ran, specs, "{}", column.name());
    }
    assert!(measured.rows.iter().all(Row::agrees), "{}", listed(&measured, |row| !row.agrees()));
}
