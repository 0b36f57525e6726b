//! `cargo run --release -p zonal-tests --bin fuzz -- 1000000 [SEED [FOLDER]]`: reads that many changed inputs and says on
//! which a reader panicked and how long the slowest took, which it writes into the folder. It fails if one panicked or took
//! longer than ten seconds.

use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;
use zonal_tests::fuzz;

/// How long a reader may take, on the machine that it runs on.
const LIMIT: Duration = Duration::from_secs(10);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize| arguments.get(place).map(|text| text.parse::<u64>());
    let (Some(Ok(count)), Ok(seed)) = (number(0), number(1).unwrap_or(Ok(1))) else {
        eprintln!("write how many inputs, the seed if it is not to be 1, and a folder for the slowest if it is wanted");
        return ExitCode::from(2);
    };
    // What a reader catches itself is no fault, and what escapes is told below.
    std::panic::set_hook(Box::new(|_| ()));
    let mut failed = false;
    for outcome in fuzz::run(count as usize, seed) {
        let fuzz::Outcome { kind, count, accepted, panics, longest, slowest } = outcome;
        println!(
            "{kind:8} {count} inputs, {accepted} accepted, {} panics, the slowest of {} bytes took {longest:?}",
            panics.len(),
            slowest.len()
        );
        for input in panics.iter().take(3) {
            println!("    {input:?}");
        }
        if let Some(Err(error)) = arguments.get(2).map(|folder| std::fs::write(Path::new(folder).join(kind), &slowest))
        {
            eprintln!("the slowest input cannot be written: {error}");
            failed = true;
        }
        failed |= !panics.is_empty() || longest > LIMIT;
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
