//! Each single call once, for a program that counts instructions; `cargo measure --instructions` starts it under
//! callgrind and writes `docs/measure/instructions.md`.

mod calls;

use std::hint::black_box;

fn main() {
    let inputs = calls::Inputs::new(1);
    // What has no function that writes in place is the same call in both forms.
    let is_call = |row: &calls::Row| match row.form {
        "call" => true,
        "into" => matches!(row.function, "rotate" | "evaluate_basis" | "tilt"),
        _ => false,
    };
    for row in calls::rows().into_iter().filter(is_call) {
        let mut work = (row.make)(&inputs);
        work.run();
        let [first, ..] = black_box(work.written()) else { continue };
        println!("{} {} {}: {first}", row.function, row.form, row.order);
    }
}
