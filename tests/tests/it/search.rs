//! The search for lobe directions: one seed finds one result, however it is cut in pieces; what it finds is counted by
//! exact numbers; what it cannot go on with it refuses.

use zonal_codegen::families::zhf::lobes::{self, Mode, Record, RecordError};
use zonal_codegen::families::zhf::search::{Search, SearchError, Task, keep, resume, state_text};
use zonal_tests::command::{Folder, Run};

fn task(mode: Mode, size: usize, seed: u32) -> Task {
    Task { mode, size, seed, max_condition: 100.0 }
}

fn searched(task: Task, pieces: &[usize]) -> Search {
    let mut search = Search::new(task).unwrap();
    pieces.iter().for_each(|tries| search.advance(*tries, || ()));
    search
}

#[test]
fn one_seed_finds_one_result_however_it_is_cut() {
    for (mode, size) in [(Mode::Band, 4), (Mode::Nested, 4), (Mode::Free, 4)] {
        let whole = searched(task(mode, size, 3), &[6]);
        let cut = searched(task(mode, size, 3), &[1, 2, 3]);
        assert_eq!(state_text(std::slice::from_ref(&whole)), state_text(std::slice::from_ref(&cut)), "{mode:?}");
        let other = searched(task(mode, size, 4), &[6]);
        assert_ne!(whole.found, other.found, "{mode:?}: another seed tries other sets");
        assert!(whole.found.iter().all(|record| record.seed == 3 && record.attempt < 6));
    }
}

#[test]
fn a_resumed_search_ends_as_an_uninterrupted_one() {
    let tasks = [task(Mode::Band, 3, 1), task(Mode::Nested, 3, 1)];
    let mut searches: Vec<Search> = tasks.iter().map(|task| searched(*task, &[3])).collect();
    // The second had not begun when the state was written.
    searches[1] = Search::new(tasks[1]).unwrap();
    let mut back = resume(&state_text(&searches), &tasks).unwrap();
    assert_eq!(back[0].tries, 3);
    back[0].advance(4, || ());
    back[1].advance(7, || ());
    let whole: Vec<Search> = tasks.iter().map(|task| searched(*task, &[7])).collect();
    assert_eq!(state_text(&back), state_text(&whole));
}

/// Table I of the paper where its counts are printed: the bands 2 to 4 are matched, 5 and 6 beaten.
#[test]
fn table_1_is_reproduced_and_beaten() {
    for (l, tries, printed) in [(2, 8, 9), (3, 8, 16), (4, 8, 31), (5, 8, 57), (6, 8, 86)] {
        let search = searched(task(Mode::Band, l, 1), &[tries]);
        let best = search.best().unwrap();
        println!("band {l}: {} non-zeros of condition {}, printed {printed}", best.total(), best.condition);
        match l {
            2..=4 => assert_eq!(best.total(), printed, "band {l}"),
            _ => assert!(best.total() < printed, "band {l}: {}", best.total()),
        }
        for record in &search.found {
            assert_eq!(record.counted(), Ok((record.nonzeros.clone(), record.condition)));
        }
    }
}

/// What a seed found once and the data holds, it finds again.
#[test]
fn a_set_of_the_data_is_found_again_by_its_seed() {
    for (mode, size) in [(Mode::Band, 4), (Mode::Free, 4), (Mode::Nested, 3)] {
        let kept = lobes::chosen(mode, size).unwrap();
        let search = searched(task(mode, size, kept.seed), &[kept.attempt + 1]);
        assert!(search.found.contains(kept), "{kept:?}");
    }
}

/// An azimuth that is a hair off the meridian makes entries that an epsilon would take for zeros.
#[test]
fn zeros_are_exact() {
    let lobes = |first: &str| -> Vec<String> {
        [first, "P2,0#1 7/4", "P2,0#1 1/4", "P2,0#1 5/4", "equator 1/2"].map(str::to_owned).to_vec()
    };
    let exact = Record::new(Mode::Band, 2, (0, 0), lobes("pole"), vec![]).unwrap();
    assert_eq!(exact.total(), 9);
    // Two lobes off by 5e-5 each: their products are below the paper's epsilon of 1e-9.
    let off = |a: &str, b: &str| -> Vec<String> {
        ["equator 0", a, "pole", "P3,1#1 1/6", "P3,1#1 7/6", b, "P3,1#1 11/6"].map(str::to_owned).to_vec()
    };
    let straight = Record::new(Mode::Band, 3, (0, 0), off("equator 1/3", "equator 2/3"), vec![]).unwrap();
    assert_eq!(straight.total(), 16);
    let bent = Record::new(Mode::Band, 3, (0, 0), off("equator 20000/60001", "equator 40000/60001"), vec![]).unwrap();
    let lobes: Vec<lobes::Lobe> = bent.lobes.iter().map(|text| text.parse().unwrap()).collect();
    let entries: Vec<f64> =
        lobes::a_hat(3, &lobes).unwrap().iter().flatten().map(|x| x.to_f64().abs()).filter(|x| *x > 0.0).collect();
    let seen = entries.iter().filter(|x| **x >= 1e-9).count();
    assert_eq!(bent.total(), entries.len());
    assert!(entries.len() > 16 && seen <= entries.len(), "{entries:?}");
    // Nearer still, entries are near the noise of f64 and yet counted.
    let near = |d: &str| Record::new(Mode::Band, 2, (0, 0), lobes_of(d), vec![]).unwrap();
    assert!(near("P2,0#1 16381/65521").total() > near("P2,0#1 1/4").total());
}

fn lobes_of(second: &str) -> Vec<String> {
    ["pole", "P2,0#1 7/4", second, "P2,0#1 5/4", "equator 1/2"].map(str::to_owned).to_vec()
}

#[test]
fn what_is_no_set_is_refused() {
    let record = |lobes: &[&str], subsets: Vec<Vec<usize>>, mode: Mode| {
        Record::new(mode, 2, (0, 0), lobes.iter().map(|text| (*text).to_owned()).collect(), subsets).unwrap_err()
    };
    let five = ["pole", "P2,0#1 7/4", "P2,0#1 1/4", "P2,0#1 5/4", "equator 1/2"];
    assert!(matches!(record(&five[..4], vec![], Mode::Band), RecordError::Shape { .. }));
    assert!(matches!(record(&five[..3], vec![], Mode::Free), RecordError::Shape { .. }));
    assert!(matches!(record(&five[..3], vec![vec![0], vec![0, 1, 3]], Mode::Free), RecordError::Shape { .. }));
    assert!(matches!(record(&["north", "pole", "pole"], vec![], Mode::Nested), RecordError::Lobe(_)));
    assert_eq!(record(&["pole", "equator 0", "equator 0"], vec![], Mode::Nested), RecordError::Dependent(1));
    assert_eq!(record(&["equator 0", "equator 1/2", "equator 1/4"], vec![], Mode::Nested), RecordError::Dependent(1));
    assert!(matches!(Search::new(task(Mode::Free, 1, 0)), Err(SearchError::Size { size: 1 })));
    assert!(matches!(Search::new(task(Mode::Band, 11, 0)), Err(SearchError::Size { size: 11 })));
    for max_condition in [0.5, f64::NAN] {
        assert_eq!(Search::new(Task { max_condition, ..task(Mode::Free, 3, 0) }), Err(SearchError::Condition));
    }
}

#[test]
fn a_front_keeps_what_nothing_beats() {
    let record = |nonzeros: usize, condition: f64| Record {
        mode: Mode::Band,
        size: 2,
        seed: 0,
        attempt: 0,
        nonzeros: vec![nonzeros],
        condition,
        lobes: vec![],
        subsets: vec![],
    };
    let mut front = Vec::new();
    for (nonzeros, condition) in [(12, 3.0), (10, 5.0), (11, 5.0), (11, 4.0), (12, 3.0), (20, 1.0)] {
        keep(&mut front, record(nonzeros, condition));
    }
    let kept: Vec<(usize, f64)> = front.iter().map(|record| (record.total(), record.condition)).collect();
    assert_eq!(kept, [(10, 5.0), (11, 4.0), (12, 3.0)]);
}

/// Runs the command in a folder; it must succeed.
fn run(folder: &Folder, arguments: &[&str]) -> String {
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(0), "{arguments:?}: {out}{err}");
    out
}

#[test]
fn the_command_resumes_and_keeps_what_it_finds() {
    let folder = Folder::new();
    let base = ["search-lobes", "--mode", "band", "--size", "2-3", "--seed", "5"];
    let with = |more: &[&'static str]| [&base[..], more].concat();
    let cut = run(&folder, &with(&["--tries", "2", "--resume", "state.toml"]));
    assert!(cut.contains("| band 3") && folder.path("state.toml").is_file(), "{cut}");
    let on = run(&folder, &with(&["--tries", "6", "--resume", "state.toml", "--out", "found.toml"]));
    assert_eq!(on, run(&folder, &with(&["--tries", "6"])));
    let text = std::fs::read_to_string(folder.path("found.toml")).unwrap();
    assert!(text.starts_with("# @generated by zonal search-lobes") && text.contains("seed = 5"), "{text}");
    // The same again adds nothing.
    run(&folder, &with(&["--tries", "6", "--out", "found.toml"]));
    assert_eq!(text, std::fs::read_to_string(folder.path("found.toml")).unwrap());
    // No time, no tries; a state with more tries than asked for is left as it is.
    run(&folder, &with(&["--tries", "1", "--resume", "state.toml"]));
}

#[test]
fn the_command_refuses_what_it_cannot_use() {
    let folder = Folder::new();
    let small = ["search-lobes", "--mode", "band", "--size", "2", "--tries", "1"];
    let with = |more: &[&'static str]| [&small[..], more].concat();
    run(&folder, &with(&["--resume", "state.toml"]));
    folder.put("broken.toml", "[[search]]\ntask = 5\n");
    folder.put("other.toml", "name = \"a scene\"\n");
    let changed = std::fs::read_to_string(folder.path("state.toml")).unwrap().replace("nonzeros = [", "nonzeros = [1");
    folder.put("changed.toml", &changed);
    let before = folder.names();
    for (arguments, parts) in [
        (with(&["--resume", "state.toml", "--seed", "2"]), ["state.toml", "another search", "from seed 2"]),
        (with(&["--resume", "broken.toml"]), ["broken.toml", "no state of a search", "name another file"]),
        (with(&["--resume", "changed.toml"]), ["changed.toml", "its non-zeros are", "name another file"]),
        (with(&["--out", "other.toml"]), ["other.toml", "holds no lobe sets", "or a new one"]),
        (with(&["--max-condition", "0.5"]), ["condition below one", "--help", ""]),
    ] {
        let Run { code, out, err } = folder.run(&arguments);
        assert_eq!(code, Some(1), "{arguments:?}: {out}{err}");
        assert!(parts.iter().all(|part| err.contains(part)), "{arguments:?}: {err}");
    }
    for arguments in [["--size", "1"], ["--size", "5-3"], ["--size", "2-11"], ["--mode", "loose"], ["--tries", "0"]] {
        let Run { code, err, .. } = folder.run([&["search-lobes"][..], &arguments[..]].concat());
        assert_eq!(code, Some(2), "{arguments:?}: {err}");
    }
    assert_eq!(folder.names(), before);
}
