//! The house keeps what it promises: imports run downwards in every package, no file is long without saying why, and who
//! names a family or a language outside of its own file says why. `cargo house` prints all of it.

use std::collections::{BTreeMap, BTreeSet};
use zonal_tests::house::{SOURCES, downwards, imports, names, overlooked, targets, too_long};

#[test]
fn imports_run_downwards_in_every_package() {
    for sources in SOURCES {
        let graph = imports(sources);
        let order = downwards(&graph).unwrap_or_else(|circle| panic!("{sources}: {}", circle.join(" → ")));
        assert_eq!(order.len(), graph.len(), "{sources}: every file has its place");
        let place = |file: &String| order.iter().position(|known| known == file);
        for (file, targets) in &graph {
            assert!(targets.iter().all(|target| place(file) < place(target)), "{sources}: {file}");
        }
    }
    // The graph is not empty: these are known to be there.
    let graph = imports("codegen/src");
    let arrows = [
        ("promise/bound/mod.rs", "promise/bound/prover.rs"),
        ("families/zyz.rs", "families/parts/bands.rs"),
        ("catalog.rs", "families/all.rs"),
    ];
    assert!(arrows.iter().all(|(from, to)| graph[*from].contains(*to)), "{graph:?}");
}

#[test]
fn a_circle_is_found() {
    let arrow =
        |from: &str, to: &[&str]| (from.to_owned(), to.iter().map(|to| (*to).to_owned()).collect::<BTreeSet<_>>());
    let graph = BTreeMap::from([arrow("a", &["b"]), arrow("b", &["c"]), arrow("c", &["b"])]);
    assert_eq!(downwards(&graph), Err(vec!["b".to_owned(), "c".to_owned()]));
}

#[test]
fn long_files_say_why() {
    assert_eq!(too_long(), []);
}

#[test]
fn who_names_a_family_or_a_language_says_why() {
    let all = names();
    assert!(all.len() > 20, "only {} places were found", all.len());
    let silent: Vec<String> = all
        .iter()
        .filter(|named| named.reason.is_none())
        .map(|named| format!("{} ({})", named.place, named.what))
        .collect();
    assert!(silent.is_empty(), "without a word: {silent:#?}");
}

#[test]
fn no_test_is_where_cargo_is_told_to_look_for_none() {
    let targets = targets();
    assert!(targets.iter().any(|target| !target.test) && targets.iter().any(|target| target.test), "{targets:?}");
    let overlooked: Vec<String> = targets.iter().flat_map(overlooked).collect();
    assert_eq!(overlooked, [""; 0], "set `test` or `doctest` of these in their manifests");
}
