//! A crate outside the workspace that generates its kernels in its build script: it compiles without a warning, its own
//! tests hold the kernels to golden values, nothing is written twice, and it never compiles the command line.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use serde_json::Value;
use zonal_tests::command::printed;
use zonal_tests::repository;

/// Where crates of users are built, those of other tests too.
pub(crate) const USERS: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/fixture");

/// Runs cargo on the fixture and returns what it printed. Its packages are those of the workspace, so that nothing is
/// fetched.
fn cargo(command: &str, options: &[&str]) -> String {
    cargo_on("tests/fixture/Cargo.toml", command, options)
}

fn cargo_on(manifest: &str, command: &str, options: &[&str]) -> String {
    printed(
        Command::new(env!("CARGO"))
            .args([command, "--offline", "--manifest-path"])
            .arg(repository(manifest))
            .args(options)
            .env("CARGO_TARGET_DIR", USERS),
    )
}

/// The folder of the build script's output, from what cargo says of the build.
fn out_dir() -> PathBuf {
    let messages = cargo("build", &["--message-format=json"]);
    let mut messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let executed = |message: &Value| {
        let id = message["package_id"].as_str().unwrap_or_default();
        message["reason"] == "build-script-executed" && id.contains("fixture")
    };
    let message = messages.rfind(executed).expect("the fixture has a build script");
    PathBuf::from(message["out_dir"].as_str().expect("a folder"))
}

fn written(path: &Path) -> SystemTime {
    fs::metadata(path).and_then(|metadata| metadata.modified()).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[test]
fn a_crate_outside_the_workspace_generates_its_kernels() {
    fs::copy(repository("Cargo.lock"), repository("tests/fixture/Cargo.lock")).expect("the lock file is copied");

    let report = cargo("test", &[]);
    assert!(report.contains("4 passed"), "{report}");

    let folder = out_dir();
    let names = ["kernels.rs", "kernels.wgsl", "kernels.glsl", "kernels.md"];
    let times = || names.map(|name| written(&folder.join(name)));
    let (before, ran) = (times(), written(&folder.join("../output")));
    let scene = File::options().append(true).open(repository("tests/fixture/scene.toml")).expect("the scene opens");
    scene.set_modified(SystemTime::now()).expect("the scene is touched");
    assert_eq!(out_dir(), folder);
    assert!(written(&folder.join("../output")) > ran, "the build script ran again");
    assert_eq!(times(), before, "what has not changed is not written again");

    let tree = cargo("tree", &["--prefix=none", "--edges=normal,build"]);
    let packages = packages_of(&tree);
    for package in ["zonal-codegen", "naga", "syn"] {
        assert!(packages.contains(package), "a build script does not compile {package}: {packages:?}");
    }
    for package in ["clap", "miette", "indicatif", "image", "rayon"] {
        assert!(!packages.contains(package), "a build script compiles {package}: {packages:?}");
    }
}

/// The names of the packages that `cargo tree --prefix=none` lists.
fn packages_of(tree: &str) -> BTreeSet<&str> {
    tree.lines().filter_map(|line| line.split(' ').next()).collect()
}

#[test]
fn the_generator_without_its_checkers_compiles_none_of_them() {
    let tree = |options: &[&str]| {
        let common = ["--prefix=none", "--edges=normal,no-proc-macro"];
        cargo_on("codegen/Cargo.toml", "tree", &[&common, options].concat())
    };
    let (with, without) = (tree(&[]), tree(&["--no-default-features"]));
    for package in ["naga", "syn", "proc-macro2", "half"] {
        assert!(packages_of(&with).contains(package), "{package} is not looked for any more:\n{with}");
        assert!(!packages_of(&without).contains(package), "{package} is compiled without `check`:\n{without}");
    }
}
