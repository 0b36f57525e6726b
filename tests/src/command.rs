//! The command `zonal`, built once and run as a user runs it, the examples, and folders that vanish after a test.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::repository;

/// The path of the command, built on first use.
///
/// # Panics
///
/// If it does not compile.
pub fn zonal() -> &'static Path {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    let programs = ["zonal", "zonal-bake", "zonal-explorer", "zonal-render"].map(|program| ["--bin", program]);
    PATH.get_or_init(|| built("zonal", programs.as_flattened()))
}

/// The command, ready to run. It finds the programs that draw and bake beside itself: under cargo it would have cargo compile them
/// with features of their own, and the generator once more for each.
pub fn command() -> Command {
    let mut command = Command::new(zonal());
    command.env_remove("CARGO");
    command
}

/// The path of an example of a package.
///
/// # Panics
///
/// If it does not compile.
pub fn example(name: &str) -> PathBuf {
    built(name, &["--example", name])
}

/// Builds programs and returns the path of the one of this name. They are built with the features that the whole workspace
/// has: with those of a package alone, what the tests have compiled would be compiled again.
fn built(name: &str, programs: &[&str]) -> PathBuf {
    let messages = printed(
        Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--message-format", "json", "--workspace"])
            .args(programs)
            .current_dir(repository("")),
    );
    let executable = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["target"]["name"] == name)
        .find_map(|message| message["executable"].as_str().map(PathBuf::from));
    executable.expect("cargo names the executable")
}

/// Runs a program to its end and returns what it printed.
///
/// # Panics
///
/// If it cannot be run or fails: with all that it printed.
pub fn printed(command: &mut Command) -> String {
    let run = command.output().unwrap_or_else(|error| panic!("{command:?} cannot be run: {error}"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(run.status.success(), "{command:?} failed:\n{}{}", text(&run.stdout), text(&run.stderr));
    text(&run.stdout)
}

/// What cargo knows of the packages of the workspace.
///
/// # Panics
///
/// If cargo does not list them.
pub fn metadata() -> serde_json::Value {
    let arguments = ["metadata", "--no-deps", "--format-version", "1", "--offline"];
    let listed = printed(Command::new(env!("CARGO")).args(arguments).current_dir(repository("")));
    serde_json::from_str(&listed).expect("cargo prints JSON")
}

/// How a run of the command ended.
#[derive(Debug)]
pub struct Run {
    /// The exit code.
    pub code: Option<i32>,
    /// The standard output.
    pub out: String,
    /// The standard error.
    pub err: String,
}

/// A folder of its own, removed at the end.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// A new, empty one.
    ///
    /// # Panics
    ///
    /// If it cannot be created.
    #[expect(clippy::new_without_default, reason = "it makes a folder")]
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("zonal-test-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    /// A path below it.
    pub fn path(&self, below: &str) -> PathBuf {
        self.0.join(below)
    }

    /// Puts a file into it.
    ///
    /// # Panics
    ///
    /// If it cannot be written.
    pub fn put(&self, below: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(below);
        std::fs::write(&path, content).expect("writable");
        path
    }

    /// The names of what it holds, sorted.
    ///
    /// # Panics
    ///
    /// If it cannot be read.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("readable");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command in it.
    ///
    /// # Panics
    ///
    /// If the command cannot be run.
    pub fn run<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Run {
        let Output { status, stdout, stderr } = command().args(arguments).current_dir(&self.0).output().expect("runs");
        Run {
            code: status.code(),
            out: String::from_utf8(stdout).expect("prints text"),
            err: String::from_utf8(stderr).expect("prints text"),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
