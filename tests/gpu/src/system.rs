//! What has to be installed: two software Vulkan drivers and the compilers. What is missing is an error that says how to
//! get it; nothing is skipped.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A Vulkan driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Driver {
    /// What it is called here.
    pub name: &'static str,
    /// A part of its adapter's name.
    pub adapter: &'static str,
    /// The folder of its manifest, and how the manifest's name begins.
    manifest: (&'static str, &'static str),
    /// The package that installs it.
    package: &'static str,
    /// What its environment says besides.
    pub settings: &'static [(&'static str, &'static str)],
}

/// The drivers that every kernel is run on.
pub const DRIVERS: [Driver; 2] = [
    Driver {
        name: "lavapipe",
        adapter: "llvmpipe",
        manifest: ("/usr/share/vulkan/icd.d", "lvp_icd"),
        package: "mesa-vulkan-drivers",
        // LLVM's optimiser takes most of the time and changes no result: the same operations are compiled as they are.
        settings: &[("GALLIVM_PERF", "nopt")],
    },
    Driver {
        name: "SwiftShader",
        adapter: "SwiftShader",
        manifest: ("/usr/lib/chromium", "vk_swiftshader_icd"),
        package: "chromium",
        settings: &[],
    },
];

/// What to do where a package is missing.
pub fn missing(what: &str, package: &str) -> String {
    format!("{what} is missing; install it: apt-get install -y --no-install-recommends {package}")
}

impl Driver {
    /// The file that tells the Vulkan loader of the driver.
    ///
    /// # Errors
    ///
    /// If the driver is not installed: which package is missing.
    pub fn manifest(&self) -> Result<PathBuf, String> {
        let (folder, start) = self.manifest;
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let is_it = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(start));
        files
            .into_iter()
            .find(|path| is_it(path))
            .ok_or_else(|| missing(&format!("The driver {}", self.name), self.package))
    }
}

/// The output of a compiler on files.
///
/// # Errors
///
/// What it says if it refuses one, or which package is missing.
pub fn compile(program: &str, package: &str, arguments: &[&str], files: &[PathBuf]) -> Result<(), String> {
    let output = Command::new(program).args(arguments).args(files).output();
    let output = output.map_err(|_| missing(program, package))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(format!(
            "{program} refuses\n{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        )),
    }
}
