//! Runs the bench on the drivers that the environment names and prints what it measured, a row a text and driver.

use zonal_gpu_tests::bench::{Mode, run};

fn main() -> Result<(), String> {
    let mode = match std::env::args().nth(1).as_deref() {
        Some("catalogue") => Mode::Catalogue,
        Some("mutated") => Mode::Mutated,
        Some("arrays") => Mode::Arrays,
        Some("toys") => Mode::Toys,
        _ => return Err("say `catalogue`, `mutated`, `arrays` or `toys`".to_owned()),
    };
    run(mode, |line| println!("{line}"))
}
