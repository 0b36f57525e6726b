//! Each single call once, for a program that counts instructions; `cargo measure --instructions` starts it under
//! callgrind and writes `docs/measure/instructions.md`.

mod calls;

use std::hint::black_box;

fn main() {
    for mut row in calls::rows(&calls::Inputs::new(1)) {
        row.work.run();
        black_box(row.work.written());
    }
}
