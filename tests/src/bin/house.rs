//! The command `cargo house`: prints the files of every package so that imports run downwards, and every place that names
//! a family or a language outside of its own file, with the reason. It fails where the house does not keep that.

use std::process::ExitCode;
use zonal_tests::house::{LONGEST, SOURCES, downwards, imports, names, too_long};

fn main() -> ExitCode {
    let mut faults = 0;
    for sources in SOURCES {
        let graph = imports(sources);
        let arrows: usize = graph.values().map(|targets| targets.len()).sum();
        println!("{sources}: {} files, {arrows} imports", graph.len());
        match downwards(&graph) {
            Ok(order) => order.iter().for_each(|file| println!("    {file}")),
            Err(circle) => {
                faults += 1;
                println!("    a circle: {}", circle.join(" → "));
            }
        }
    }
    for (file, lines) in too_long() {
        faults += 1;
        println!("{file}: {lines} lines, above {LONGEST}, and its head does not say why");
    }
    println!("\n| place | names a | reason |\n|---|---|---|");
    for named in names() {
        faults += usize::from(named.reason.is_none());
        println!("| {} | {} | {} |", named.place, named.what, named.reason.as_deref().unwrap_or("**none is given**"));
    }
    match faults {
        0 => ExitCode::SUCCESS,
        _ => {
            eprintln!("{faults} faults");
            ExitCode::FAILURE
        }
    }
}
