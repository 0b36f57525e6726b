//! The tests of the baker, one module a subject, in one program.

mod bunny;
mod islands;
mod models;

use std::path::{Path, PathBuf};

/// A path in the repository.
fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}
