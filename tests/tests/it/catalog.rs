//! The checked-in set: the same bytes every time, fresh in the repository, no dearer than the ledger says.

use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use zonal_codegen::catalog::{BESIDE, files_of, standard};
use zonal_codegen::families::Spec;
use zonal_codegen::families::zhf;
use zonal_codegen::files::{Difference, File, Replace, differences};
use zonal_codegen::generate::build;
use zonal_codegen::promise::bound::{self, Bound};
use zonal_tests::{catalogue, repository, spec};

/// The files of the whole catalogue, printed and validated once for all tests.
fn whole() -> &'static [File] {
    static WHOLE: LazyLock<Vec<File>> = LazyLock::new(|| files_of(catalogue()).expect("the catalogue is valid"));
    &WHOLE
}

#[test]
fn the_catalogue_is_fresh() {
    let found = differences(&repository("generated"), whole(), &BESIDE).expect("generated/ can be read");
    let list: Vec<String> = found.iter().map(Difference::to_string).collect();
    assert!(
        list.is_empty(),
        "generated/ is not what the generator writes; run `cargo zonal catalog`:\n{}",
        list.join("\n")
    );
}

/// The orders that have every family; what is kept of proofs plays no part.
#[test]
fn twice_generated_is_the_same_to_the_last_byte() {
    let specs: Vec<Spec> = standard().into_iter().filter(|spec| spec.order <= 4).collect();
    let proven = |spec: &Spec| bound::of(spec, &spec.code());
    let [first, second] = [(); 2].map(|()| {
        let bounds: Vec<Option<Bound>> = specs.par_iter().map(proven).collect();
        (files_of(&build(&specs)).expect("the catalogue is valid"), bounds)
    });
    assert!(first == second, "twice the same");
    for file in first.0.iter().filter(|file| file.path.contains("/sh") && !file.path.ends_with("shaders.rs")) {
        assert!(whole().contains(file), "{} is another in the whole catalogue", file.path);
    }
}

#[test]
fn stale_missing_and_orphaned_files_are_found() {
    let folder = std::env::temp_dir().join(format!("zonal-catalog-{}", std::process::id()));
    let file = |path: &str, text: &str| File { path: path.to_owned(), text: text.to_owned() };
    let wanted = [file("wgsl/a.wgsl", "a"), file("wgsl/b.wgsl", "b"), file("c.md", "c")];
    assert_eq!(zonal_codegen::files::write(&folder, &wanted, Replace::Own).expect("a temporary folder"), 3);
    assert_eq!(
        zonal_codegen::files::write(&folder, &wanted, Replace::Own).expect("a temporary folder"),
        0,
        "unchanged files stay"
    );
    assert_eq!(differences(&folder, &wanted, &[]).expect("readable"), []);
    std::fs::write(folder.join("wgsl/a.wgsl"), "changed").expect("writable");
    std::fs::remove_file(folder.join("c.md")).expect("removable");
    std::fs::write(folder.join("wgsl/d.wgsl"), "d").expect("writable");
    let found = differences(&folder, &wanted, &[]).expect("readable");
    assert_eq!(
        found,
        [
            Difference::Stale("wgsl/a.wgsl".into()),
            Difference::Missing("c.md".into()),
            Difference::Orphaned("wgsl/d.wgsl".into())
        ]
    );
    assert_eq!(zonal_codegen::files::remove_orphans(&folder, &wanted, &[]).expect("removable"), 1);
    std::fs::remove_dir_all(&folder).expect("removable");
}

#[test]
fn names_and_specs_are_unique_and_survive_naga() {
    let all = standard();
    let mut names: BTreeMap<String, Spec> = BTreeMap::new();
    for spec in &all {
        let name = spec.name();
        assert!(!name.contains("__") && !name.ends_with(|c: char| c.is_ascii_digit()), "{name}: naga renames it");
        assert!(spec.to_string().parse::<Spec>().as_ref() == Ok(spec), "{spec} reads back");
        if let Some(other) = names.insert(name.clone(), spec.clone()) {
            panic!("{spec} and {other} are both called {name}");
        }
    }
}

fn totals(text: impl Fn(usize) -> String, orders: std::ops::RangeInclusive<usize>) -> Vec<usize> {
    let specs: Vec<Spec> = orders.map(|order| spec(&text(order))).collect();
    build(&specs).iter().map(|function| function.built.code.cost(function.spec.channels()).total).collect()
}

/// The least counts that were known when the kernels were begun, as the most that one may cost
/// (docs/MATH.md#operations-of-the-exact-rotation).
#[test]
fn no_kernel_costs_more_than_the_best_known() {
    type Text = fn(usize) -> String;
    let ledger: [(&str, Text, usize, &[usize]); 7] = [
        ("rotate", |n| format!("rotate:{n}"), 3, &[64, 137, 228, 350, 507, 703]),
        ("rotate rgb", |n| format!("rotate:{n}:rgb"), 3, &[149, 319, 566, 908, 1353, 1917]),
        ("angles given", |n| format!("rotate:{n}:angles"), 3, &[39, 91, 169, 279, 423, 607]),
        ("basis", |n| format!("basis:{n}"), 3, &[13, 27, 43, 65, 90, 122, 157, 199]),
        ("tilt", |n| format!("tilt:{n}"), 3, &[37, 85, 141, 211, 295, 393]),
        ("eval rgb", |n| format!("eval:{n}:rgb"), 3, &[37, 67, 105, 153, 210, 277]),
        ("rotate from 2", |n| format!("rotate:{n}"), 2, &[18]),
    ];
    for (name, text, first, most) in ledger {
        let got = totals(text, first..=first + most.len() - 1);
        println!("{name} from order {first}: {got:?}, best known before {most:?}");
        assert!(got.iter().zip(most).all(|(got, most)| got <= most), "{name}: {got:?} above {most:?}");
    }
    let nonzeros: Vec<usize> = (3..=8).map(zhf::nonzeros).collect();
    println!("A^ non-zeros from order 3: {nonzeros:?}");
    assert!(nonzeros.iter().zip([9, 28, 67, 135, 231, 352]).all(|(got, most)| *got <= most), "{nonzeros:?}");
}

/// The sparse fixed rotations cost what their matrices' non-zeros say: the claim of Křivánek et al. 2005, section 3.1,
/// corrected (docs/MATH.md#the-exchange-of-y-and-z).
#[test]
fn the_papers_baseline_costs_what_it_should() {
    // True cumulative non-zeros of x(±90°), orders 1 to 10, less the unit entries and the first product of each row.
    let nonzeros = [1, 4, 11, 24, 45, 76, 119, 176, 247, 338];
    for order in 2..=10 {
        let matrix: usize = (0..order)
            .map(|l| {
                let degrees = || -(l as isize)..=l as isize;
                let entries = degrees().flat_map(|a| degrees().map(move |b| (a, b)));
                entries.filter(|&(a, b)| !zonal_codegen::math::tables::swap_yz(l, a, b).is_zero()).count()
            })
            .sum();
        assert_eq!(matrix, nonzeros[order - 1], "order {order}");
    }
}
