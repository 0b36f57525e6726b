//! `docs/REFLECTIONS.md` is what `cargo render page reflections` measures: a part of it is measured again, and Gaussians are
//! nearer to many samples than one sample is.

use crate::bands::stands;
use crate::report::repository;
use indicatif::ProgressBar;
use zonal_render::mirror::page::{ORDERS, Report, SIDE, costs_text, evals, grown};
use zonal_render::pages::mirror;

const HELP: &str = "docs/REFLECTIONS.md is stale; run `cargo render page reflections`";

#[test]
fn the_page_is_what_is_measured_and_gaussians_are_nearer_than_one_sample() {
    let page = std::fs::read_to_string(repository("docs/REFLECTIONS.md")).unwrap_or_else(|e| panic!("{e}: {HELP}"));
    let (ball, maps) = mirror(&repository("scenes")).unwrap_or_else(|error| panic!("{error}"));
    let last = maps.len() - 1;
    let report = Report::measure(&ball, &maps[last..], SIDE, &ORDERS[..1], &ProgressBar::hidden());
    let markdown = report.markdown();
    let start = format!("| {} | {} |", maps[last].0, ORDERS[0]);
    let lines: Vec<&str> = markdown.lines().filter(|line| line.starts_with(&start)).collect();
    assert_eq!(lines.len(), 2);
    let parts: Vec<&str> = page.split("\n## ").collect();
    for (line, part) in lines.iter().zip(&parts[1..]) {
        stands(part, line, 2, HELP);
    }
    assert!(page.contains(&costs_text()), "{HELP}");
    let row = &report.cases[0].rows[0];
    let [one, round, long] = row.own.map(|errors| errors.rms);
    assert!(round < 0.9 * one && long < round, "{row:?}");
    // The kernel's slices are interpolated, to half a percent, and the places are 288.
    assert!(report.cases[0].kernel.rms < 0.01, "{:?}", report.cases[0].kernel);
    let seen: usize = page
        .split(" of which ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next()?.parse().ok())
        .expect("the page says how many pixels show the ball");
    assert_eq!(seen, report.shown);
}

/// What is told beyond order 16 is a polynomial, which foretells an order that it was not made from.
#[test]
fn operations_grow_as_a_polynomial() {
    let known = evals();
    let (first, others) = known.split_first().expect("there are five");
    assert_eq!(grown(others, first.0), first.1);
}
