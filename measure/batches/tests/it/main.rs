//! The page of the batches' times is made of its figures, and these know every function, order and layout.

use std::path::Path;
use zonal_measure_batches::page::{JSON, PAGE, Report, markdown};

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_page_is_made_of_its_figures() {
    let report: Report = serde_json::from_str(&read(JSON)).expect("figures of the page");
    assert_eq!(read(PAGE), markdown(&report), "`cargo measure-batches` writes it");
    for function in ["rotate_each", "rotate_all", "tilt_each", "eval_each", "basis_each"] {
        for order in 2..=10 {
            let rows = report.rows.iter().filter(|row| row.function == function && row.order == order);
            let layouts: Vec<&str> = rows.map(|row| row.layout.as_str()).collect();
            assert!(layouts.contains(&"blocks"), "{function} of order {order} is timed");
        }
    }
}
