//! What has to be installed: two software Vulkan drivers, compilers and Node. What is missing is an error that says how to
//! get it; nothing is skipped.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A Vulkan driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vulkan {
    /// What it is called here.
    pub name: &'static str,
    /// A part of its adapter's name.
    pub adapter: &'static str,
    /// The folder of its manifest, and how the manifest's name begins.
    manifest: (&'static str, &'static str),
    /// The package that installs it.
    package: &'static str,
}

/// The drivers that every kernel is run on.
pub const VULKAN: [Vulkan; 2] = [
    Vulkan {
        name: "lavapipe",
        adapter: "llvmpipe",
        manifest: ("/usr/share/vulkan/icd.d", "lvp_icd"),
        package: "mesa-vulkan-drivers",
    },
    Vulkan {
        name: "SwiftShader",
        adapter: "SwiftShader",
        manifest: ("/usr/lib/chromium", "vk_swiftshader_icd"),
        package: "chromium",
    },
];

/// How lavapipe is told to compile fast. LLVM's optimiser takes two thirds of its time, and lanes beyond four take half of
/// the rest where an index is computed; neither changes what a lane computes. Its cache does not know of either setting.
const LAVAPIPE: [(&str, &str); 3] =
    [("GALLIVM_PERF", "nopt"), ("LP_NATIVE_VECTOR_WIDTH", "128"), ("MESA_SHADER_CACHE_DISABLE", "true")];

/// The environment of a process that runs shaders on all of [`VULKAN`].
///
/// # Errors
///
/// If a driver is not installed: which package is missing.
pub fn environment() -> Result<Vec<(&'static str, String)>, String> {
    let manifests: Result<Vec<String>, String> =
        VULKAN.iter().map(|driver| Ok(driver.manifest()?.display().to_string())).collect();
    let manifests = manifests?.join(":");
    let mut all = vec![("VK_ICD_FILENAMES", manifests.clone()), ("VK_DRIVER_FILES", manifests)];
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // Mesa only wants to hear of a folder.
        all.push(("XDG_RUNTIME_DIR", std::env::temp_dir().display().to_string()));
    }
    all.extend(LAVAPIPE.map(|(name, value)| (name, value.to_owned())));
    Ok(all)
}

/// What to do where a package is missing.
pub fn missing(what: &str, package: &str) -> String {
    format!("{what} is missing; install it: apt-get install -y --no-install-recommends {package}")
}

impl Vulkan {
    /// The file that tells the Vulkan loader of the driver.
    ///
    /// # Errors
    ///
    /// If the driver is not installed: which package is missing.
    fn manifest(&self) -> Result<PathBuf, String> {
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
