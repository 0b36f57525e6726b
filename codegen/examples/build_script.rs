//! What a build script looks like. In a crate of yours this is `build.rs`, `zonal-codegen` is a build dependency, and the
//! sources take what was written:
//!
//! ```ignore
//! mod kernels {
//!     include!(concat!(env!("OUT_DIR"), "/kernels.rs"));
//! }
//! const WGSL: &str = include_str!(concat!(env!("OUT_DIR"), "/kernels.wgsl"));
//! ```
//!
//! `cargo run -p zonal-codegen --example build_script` writes into the folder that cargo gives to the build script of
//! zonal-codegen itself, and says what it wrote. tests/fixture is a whole crate, with a scene instead of a list of kernels.

use std::path::PathBuf;

use zonal_codegen::builder::{Builder, Error};
use zonal_codegen::emit::language::{RUST, WGSL};

fn main() -> Result<(), Error> {
    Builder::new("kernels")
        // Light of order 3 in a direction, three channels at once: nine coefficients each.
        .spec("eval:3:rgb")
        // The same light turned by a quaternion, under a name of your own.
        .named("turn_light", "rotate:3:rgb")
        .target(&RUST)
        .target(&WGSL)
        .write_to_out_dir()?;

    // A build script ends here. An example shows what came of it.
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or(Error::NoOutDir)?);
    for name in ["kernels.rs", "kernels.wgsl", "kernels.md"] {
        let path = folder.join(name);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        println!("{}: {} lines", path.display(), text.lines().count());
        for line in text.lines().filter(|line| line.starts_with("fn ") || line.trim_start().starts_with("pub fn ")) {
            println!("    {}", line.trim_start());
        }
    }
    Ok(())
}
