//! Each single call once, for a program that counts instructions; `cargo measure --instructions` starts it under
//! callgrind and writes `docs/measure/instructions.md`.

mod calls;

use std::hint::black_box;

fn main() {
    let inputs = calls::Inputs::new(1);
    for row in calls::rows().into_iter().filter(|row| row.form == "call") {
        let mut work = (row.make)(&inputs);
        work.run();
        let [first, ..] = black_box(work.written()) else { continue };
        println!("{} {}: {first}", row.function, row.order);
    }
}
