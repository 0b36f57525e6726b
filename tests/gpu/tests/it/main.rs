//! What drivers, browsers and compilers say of the shaders, one module a subject, in one program.

mod compilers;
mod drivers;
mod explorer;
mod three;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The turn of a test that takes all processors, and of which a part looks at times or waits for a browser.
fn turn() -> MutexGuard<'static, ()> {
    static MACHINE: Mutex<()> = Mutex::new(());
    MACHINE.lock().unwrap_or_else(PoisonError::into_inner)
}
