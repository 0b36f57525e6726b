//! `cargo run --release -p zonal-tests --bin fuzz -- 1000000 [SEED]`: reads that many changed inputs and says on which a
//! reader panicked and how long the slowest took. It fails if one panicked.

use std::process::ExitCode;
use zonal_tests::fuzz;

fn main() -> ExitCode {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let (Some(Ok(count)), Ok(seed)) = (numbers.next(), numbers.next().unwrap_or(Ok(1))) else {
        eprintln!("write how many inputs, and the seed if it is not to be 1");
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
        failed |= !panics.is_empty();
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
