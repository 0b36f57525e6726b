//! The command `explore`: writes the page and serves it to this machine alone.

use crate::http::{self, Answer};
use crate::page::{self, Asset};
use std::io;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::time::Instant;
use zonal_cli::terminal::{Failure, out, progress};
use zonal_codegen::files::{self, Replace};
use zonal_codegen::scene::diagnostic::Diagnostic;

/// Where the page is written to unless another folder is named.
const FOLDER: &str = "zonal-out/explorer";

/// Content types by extension; anything else is bytes.
const TYPES: [(&str, &str); 7] = [
    ("html", "text/html; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("json", "application/json"),
    ("wgsl", "text/plain; charset=utf-8"),
    ("frag", "text/plain; charset=utf-8"),
    ("vert", "text/plain; charset=utf-8"),
];

/// Writes the page, and serves it if asked to.
pub fn explore(folder: Option<PathBuf>, port: u16, serves: bool, replace: Replace) -> Result<(), Failure> {
    let start = Instant::now();
    // A port that is taken is known before anything is made.
    let listener = serves.then(|| listen(port)).transpose()?;
    let bar = progress("generating the explorer");
    let assets = page::assets(&bar)?;
    let folder = folder.unwrap_or_else(|| PathBuf::from(FOLDER));
    let list: Vec<(&str, &[u8])> = assets.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
    let changed = files::write_below(&folder, &list, replace)?;
    drop(bar);
    let megabytes = assets.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() as f64 / 1e6;
    out(&format!(
        "{} files in `{}`, {megabytes:.0} MB, {changed} of them changed, in {:.1} s\n",
        assets.len(),
        folder.display(),
        start.elapsed().as_secs_f64()
    ))?;
    match listener {
        Some(listener) => serve(&listener, &assets),
        None => out("Serve the folder with any web server; a page from a file cannot load its data.\n"),
    }
}

fn listen(port: u16) -> Result<TcpListener, Diagnostic> {
    TcpListener::bind(("127.0.0.1", port)).map_err(|error| {
        let message = format!("cannot serve on port {port} of 127.0.0.1: {error}");
        Diagnostic::nowhere(message, "name another with `--port`, or none for one that is free")
    })
}

fn serve(listener: &TcpListener, assets: &[Asset]) -> Result<(), Failure> {
    let fault = |error: io::Error| Diagnostic::nowhere(format!("cannot serve: {error}"), "end other programs");
    let address = listener.local_addr().map_err(fault)?;
    out(&format!("http://{address}/ shows it; end with ctrl-c\n"))?;
    http::serve(listener, |path| answer(path, assets)).map_err(fault)?;
    Ok(())
}

/// Answers from memory: what is not part of the page does not exist.
fn answer<'a>(path: &str, assets: &'a [Asset]) -> Answer<'a> {
    let path = path.trim_start_matches('/');
    // The page names its icon itself; a browser that shows a file of it alone asks for this one.
    if path == "favicon.ico" {
        return Answer { status: "204 No Content", headers: String::new(), body: &[] };
    }
    let path = if path.is_empty() { "index.html" } else { path };
    let Some((_, bytes)) = assets.iter().find(|(known, _)| known == path) else {
        return Answer::line("404 Not Found", "not found\n");
    };
    let extension = Path::new(path).extension().and_then(|extension| extension.to_str()).unwrap_or("");
    let known = TYPES.iter().find(|(name, _)| *name == extension);
    let content = known.map_or("application/octet-stream", |(_, content)| content);
    Answer { status: "200 OK", headers: format!("Content-Type: {content}\r\nCache-Control: no-cache\r\n"), body: bytes }
}
