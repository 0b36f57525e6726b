//! What draws and what bakes is other programs, so that this one needs no graphics, plots, pages or rays: it finds them and
//! hands over.

use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use zonal_cli::terminal::Failure;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// Where this program was compiled: a checkout with the other packages beside it, or a copy without them.
const PACKAGE: &str = env!("CARGO_MANIFEST_DIR");

/// A program of another package, which is called as the program is.
struct Helper {
    name: &'static str,
    /// The folder of its package in a checkout.
    folder: &'static str,
}

const BAKER: Helper = Helper { name: "zonal-bake", folder: "bake" };
const EXPLORER: Helper = Helper { name: "zonal-explorer", folder: "explorer" };
const RENDERER: Helper = Helper { name: "zonal-render", folder: "render" };

impl Helper {
    /// The program beside this one, or else in a folder of PATH.
    fn installed(&self) -> Option<PathBuf> {
        let beside = std::env::current_exe().ok().and_then(|path| Some(path.parent()?.to_owned()));
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let all = beside.into_iter().chain(std::env::split_paths(&folders));
        all.map(|folder| folder.join(format!("{}{EXE_SUFFIX}", self.name))).find(|path| path.is_file())
    }

    /// What compiles it in a checkout and runs it.
    fn in_checkout(&self, cargo: OsString) -> Option<Command> {
        let manifest = Path::new(PACKAGE).parent()?.join(self.folder).join("Cargo.toml");
        manifest.is_file().then(|| {
            let mut command = Command::new(cargo);
            command.args(["run", "--quiet", "--manifest-path"]).arg(manifest).arg("--");
            command
        })
    }

    /// The ways to start it, the best first. Under `cargo run` cargo knows better than a folder whether the program is
    /// up to date.
    fn commands(&self) -> impl Iterator<Item = Command> {
        let under_cargo = std::env::var_os("CARGO").and_then(|cargo| self.in_checkout(cargo));
        let installed = self.installed().map(Command::new);
        under_cargo.into_iter().chain(installed).chain(self.in_checkout("cargo".into()))
    }

    fn run(&self, arguments: Vec<OsString>) -> Result<(), Failure> {
        let Self { name, folder } = self;
        for mut command in self.commands() {
            match replace(command.args(&arguments)) {
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                Err(error) => {
                    return Err(
                        Diagnostic::nowhere(format!("`{name}` does not start: {error}"), "install it again").into()
                    );
                }
                Ok(result) => return result,
            }
        }
        let help = format!("run `cargo install {name}`, or in a checkout `cargo run -p zonal-{folder}`");
        Err(Diagnostic::nowhere(format!("`{name}` is neither beside zonal nor in a folder of PATH"), help).into())
    }
}

/// Becomes the other program, so that what ends this one ends that one.
#[cfg(unix)]
fn replace(command: &mut Command) -> std::io::Result<Result<(), Failure>> {
    Err(std::os::unix::process::CommandExt::exec(command))
}

/// Runs the other program and ends as it does.
#[cfg(not(unix))]
fn replace(command: &mut Command) -> std::io::Result<Result<(), Failure>> {
    let status = command.status()?;
    Ok(match status.code() {
        Some(0) => Ok(()),
        code => Err(Failure::Told(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(1))),
    })
}

pub fn render(arguments: Vec<OsString>) -> Result<(), Failure> {
    RENDERER.run(arguments)
}

pub fn bake(arguments: Vec<OsString>) -> Result<(), Failure> {
    BAKER.run(arguments)
}

pub fn explore(arguments: Vec<OsString>) -> Result<(), Failure> {
    EXPLORER.run(std::iter::once("explore".into()).chain(arguments).collect())
}

/// Hands over the command as it was given, which the explorer knows with a plot.
pub fn same() -> Result<(), Failure> {
    EXPLORER.run(std::env::args_os().skip(1).collect())
}
