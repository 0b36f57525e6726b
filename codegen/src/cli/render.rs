//! `zonal render`: hands over to the renderer, a program of its own, so that this one needs no graphics.

use super::Failure;
use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use zonal_codegen::scene::diagnostic::Diagnostic;

/// The program.
const NAME: &str = "zonal-render";

/// It beside this program, or else in a folder of PATH.
fn renderer() -> Option<PathBuf> {
    let beside = std::env::current_exe().ok().and_then(|path| Some(path.parent()?.to_owned()));
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let all = beside.into_iter().chain(std::env::split_paths(&folders));
    all.map(|folder| folder.join(format!("{NAME}{EXE_SUFFIX}"))).find(|path| path.is_file())
}

pub fn render(arguments: &[OsString]) -> Result<(), Failure> {
    let Some(path) = renderer() else {
        let help = "run `cargo install zonal-render`, or in a checkout `cargo render` instead of `cargo zonal render`";
        let message = format!("`{NAME}` is neither beside zonal nor in a folder of PATH");
        return Err(Diagnostic::nowhere(message, help).into());
    };
    let status = Command::new(&path).args(arguments).status().map_err(|error| {
        Diagnostic::nowhere(format!("`{}` does not start: {error}", path.display()), "install it again")
    })?;
    match status.code() {
        Some(0) => Ok(()),
        code => Err(Failure::Told(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(1))),
    }
}
