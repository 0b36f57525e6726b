//! What `docs/GPU.md` says in sentences, compiled again: kernels in pieces spill nothing where the whole ones do, for the
//! same operations, and loops over local arrays do not pay. The driver's version may be another than the page's, so that
//! no figure of it is compared.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;
use zonal_codegen::families::Spec;
use zonal_codegen::promise::registers::waves;
use zonal_measure_gpu::compile::{GPUS, Report, Row, compile};
use zonal_measure_gpu::kernels::{Called, Kernel, Pass, shaders};
use zonal_measure_gpu::price::{COMPARED, agreement};
use zonal_measure_gpu::shader::spirv;
use zonal_measure_gpu::{loops, page, registers};

/// What is compiled here.
const SPECS: [&str; 14] = [
    IN_MEMORY[0],
    IN_MEMORY[1],
    "rotate:5",
    "rotate:5:rgb",
    "rotate:8",
    "rotate:8:rgb",
    "rotate:10",
    "rotate:10:rgb",
    "tilt:8:rgb",
    "tilt:10:rgb",
    "taylor15:5",
    "taylor15:5:loop",
    "rotate:5:loop",
    "eval:5",
];

/// What spills unless its arrays lie in memory.
const IN_MEMORY: [&str; 2] = ["rotate:9:lifted", "zhf:6:rgb"];

fn report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let specs: Vec<Spec> = SPECS.map(|text| text.parse().expect("a spec")).to_vec();
        let program = Path::new(env!("CARGO_BIN_EXE_zonal-measure-gpu"));
        compile(program, &shaders(&specs), || ()).unwrap_or_else(|error| panic!("{error}"))
    })
}

fn row(spec: &str, called: Called) -> &'static Row {
    let found = report().rows.iter().find(|row| row.spec == spec && row.called == called);
    found.unwrap_or_else(|| panic!("{spec} {called:?} was compiled"))
}

#[test]
fn pieces_spill_nothing_where_the_whole_does() {
    for row in report().rows.iter().filter(|row| row.called != Called::Whole) {
        for (gpu, counted) in GPUS.iter().zip(row.gpus) {
            println!("{} {:?} on {}: {counted:?}", row.spec, row.called, gpu.family);
            // Three channels at once are too many from order 7 on, channel after channel is not; hundreds of numbers that bands
            // take are too many as values, in memory they are not.
            let is_small = match row.called {
                Called::Memory => true,
                Called::Pieces => !row.spec.ends_with(":rgb") && !IN_MEMORY.contains(&&*row.spec),
                _ => !IN_MEMORY.contains(&&*row.spec),
            };
            if is_small {
                assert_eq!(counted.spilled, 0, "{} {:?} on {}", row.spec, row.called, gpu.family);
            }
        }
    }
    for spec in IN_MEMORY {
        let other = if spec.ends_with(":rgb") { Called::Channels } else { Called::Pieces };
        assert!(row(spec, other).gpus[2].spilled > 0, "{spec} needs no memory");
        assert_eq!(row(spec, Called::Memory).gpus[2].spilled, 0, "{spec}");
    }
    for gpu in [1, 2] {
        let [whole, by_channels] =
            [Called::Whole, Called::Channels].map(|called| row("rotate:8:rgb", called).gpus[gpu]);
        assert!(whole.spilled > 100, "{whole:?}");
        assert!(by_channels.waves > whole.waves, "{by_channels:?}, whole {whole:?}");
    }
    let [whole, pieces] = [Called::Whole, Called::Pieces].map(|called| row("rotate:8:rgb", called).gpus[2]);
    assert!(3 * pieces.cycles <= whole.cycles, "RDNA 3: {} of {}", pieces.cycles, whole.cycles);
}

#[test]
fn loops_over_local_arrays_do_not_pay() {
    for (looped, straight) in [("taylor15:5:loop", "taylor15:5"), ("rotate:5:loop", "rotate:5")] {
        let [looped, straight] = [looped, straight].map(|spec| row(spec, Called::Whole));
        for (a, b) in looped.gpus.iter().zip(straight.gpus) {
            assert!(a.cycles > 3 * b.cycles, "{} takes {}, {} {}", looped.spec, a.cycles, straight.spec, b.cycles);
        }
    }
}

/// The page multiplies what a loop's body takes by how often it runs; the driver by eight, by four in a loop's loop, and by
/// two in that one's.
#[test]
fn the_driver_takes_a_loop_to_run_eight_times() {
    let nested = |depth: usize| {
        let bounds = ["u32(parameters[0])", "u32(parameters[1])", "u32(parameters[2])"];
        let opened: String =
            (0..depth).map(|at| format!("for (var i{at} = 0u; i{at} < {}; i{at} += 1u) {{\n", bounds[at])).collect();
        let text = format!(
            "@group(0) @binding(0) var<storage, read> parameters: array<f32>;\n\
             @group(0) @binding(2) var<storage, read_write> results: array<f32>;\n\
             @compute @workgroup_size(64)\nfn main(@builtin(global_invocation_id) thread: vec3<u32>) {{\n\
             var x = parameters[thread.x];\n{opened}{}{}results[thread.x] = x;\n}}\n",
            "x = x * x + 0.5;\n".repeat(500),
            "}\n".repeat(depth)
        );
        Kernel {
            spec: String::new(),
            called: Called::Whole,
            operations: 0,
            special: 0,
            weight: 0,
            held: 0,
            passes: vec![Pass { spirv: spirv(&text), times: 1 }],
        }
    };
    let program = Path::new(env!("CARGO_BIN_EXE_zonal-measure-gpu"));
    let kernels: Vec<Kernel> = (0..4).map(nested).collect();
    let report = compile(program, &kernels, || ()).unwrap_or_else(|error| panic!("{error}"));
    for gpu in [1, 2] {
        let cycles: Vec<f64> = report.rows.iter().map(|row| row.gpus[gpu].cycles as f64).collect();
        println!("{}: {cycles:?}", GPUS[gpu].family);
        for (place, times) in [8.0, 4.0, 2.0].into_iter().enumerate() {
            // What is outside of the loop, and its own counter, are less than a twentieth.
            let found = cycles[place + 1] / cycles[place];
            assert!((0.95..1.05).contains(&(found / times)), "{place}: {found}, not {times}");
        }
    }
}

#[test]
fn no_loop_pays() {
    let report = checked_in();
    let [least, most] = loops::pays(&report);
    println!("loops over memory take {least:.2} to {most:.2} times the cycles of pieces");
    assert!(least > 1.0, "{least}");
}

/// Each instruction of a wave of 64 takes two cycles or more, and each operation is one at least.
#[test]
fn operations_are_a_lower_bound_of_instructions() {
    for row in report().rows.iter().filter(|row| !row.spec.ends_with(":loop")) {
        for counted in row.gpus {
            assert!(counted.instructions as usize >= row.operations, "{}: {counted:?}", row.spec);
        }
    }
}

fn checked_in() -> Report {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let text = std::fs::read_to_string(folder.join(page::JSON)).expect("docs hold the figures");
    serde_json::from_str(&text).expect("they are as this program writes them")
}

#[test]
fn the_planner_orders_kernels_as_their_cycles_do() {
    let report = checked_in();
    for compared in &COMPARED {
        for gpu in [1, 2] {
            let all = agreement(&report, gpu, compared);
            assert_eq!(all.len(), compared.orders.clone().count());
            for agreed in all {
                let words = format!("{}, {}, order {}", compared.words, GPUS[gpu].family, agreed.order);
                println!("{words}: {:.1} %, ranks {:.3}", 100.0 * agreed.share, agreed.correlation);
                assert!(agreed.kernels >= 19 && agreed.correlation > 0.95, "{words}");
                assert!(agreed.share >= 0.95, "{words}: {} {:?}", agreed.share, agreed.wrong);
            }
        }
    }
}

/// The driver counts waves of 32 threads, two for each of 64.
#[test]
fn registers_leave_room_for_as_many_waves_as_the_planner_counts() {
    let report = checked_in();
    let mut found = BTreeSet::new();
    for row in &report.rows {
        let counted = row.gpus[registers::GPU];
        assert_eq!(2 * waves(counted.registers as usize) as u64, counted.waves, "{} {:?}", row.spec, row.called);
        found.insert(counted.waves);
    }
    assert!(found.len() >= 8, "{found:?}");
}

/// On RDNA 2 and RDNA 3, whatever has pieces: as they are, a channel after the other, or with its arrays in memory.
#[test]
fn in_some_form_nothing_spills() {
    let report = checked_in();
    let mut least: BTreeMap<(&str, usize), u64> = BTreeMap::new();
    for row in report.rows.iter().filter(|row| row.called != Called::Whole) {
        for gpu in [1, 2] {
            let spilled = least.entry((&row.spec, gpu)).or_insert(u64::MAX);
            *spilled = row.gpus[gpu].spilled.min(*spilled);
        }
    }
    let spilled: Vec<_> = least.iter().filter(|(_, spilled)| **spilled > 0).collect();
    assert!(least.len() > 900 && spilled.is_empty(), "of {}: {spilled:?}", least.len());
}

#[test]
fn the_table_of_registers_is_of_the_figures() {
    let report = checked_in();
    let table = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../codegen/data/registers.tsv"));
    assert!(
        table.expect("is there") == registers::tsv(&report),
        "codegen/data/registers.tsv: `cargo measure-gpu --page`"
    );
    // Where nothing was measured, what is counted suffices for nine kernels of ten.
    for way in [Called::Whole, Called::Pieces, Called::Channels] {
        let all = registers::for_a_number(&report, way);
        println!("{way:?}: {} kernels, {:.1} %", all.len(), 100.0 * registers::enough(&all, way));
        assert!(all.len() > 100 && registers::enough(&all, way) >= 0.9, "{way:?}: {}", registers::enough(&all, way));
    }
}

#[test]
fn the_page_is_made_of_its_figures() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let report = checked_in();
    let page = std::fs::read_to_string(folder.join(page::PAGE)).expect("docs hold the page");
    assert!(page == page::markdown(&report), "docs/GPU.md is not of docs/gpu.json: `cargo measure-gpu --page`");
    // Every kernel of the catalogue is in it, with the operations that it has now.
    let known: BTreeMap<&str, usize> = report.rows.iter().map(|row| (row.spec.as_str(), row.operations)).collect();
    for spec in zonal_codegen::catalog::standard() {
        let operations = spec.code().cost(spec.channels()).total;
        assert_eq!(known.get(spec.to_string().as_str()), Some(&operations), "{spec}: `cargo measure-gpu`");
    }
}
