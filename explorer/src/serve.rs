//! The command `explore`: writes the page and serves it to this machine alone.

use crate::page::{self, Asset};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tiny_http::{Header, Method, Request, Response, Server};
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
    let server = serves.then(|| listen(port)).transpose()?;
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
    match server {
        Some(server) => serve(&server, &assets),
        None => out("Serve the folder with any web server; a page from a file cannot load its data.\n"),
    }
}

fn listen(port: u16) -> Result<Server, Diagnostic> {
    Server::http(("127.0.0.1", port)).map_err(|error| {
        let message = format!("cannot serve on port {port} of 127.0.0.1: {error}");
        Diagnostic::nowhere(message, "name another with `--port`, or none for one that is free")
    })
}

fn serve(server: &Server, assets: &[Asset]) -> Result<(), Failure> {
    let address = server.server_addr();
    out(&format!("http://{address}/ shows it; end with ctrl-c\n"))?;
    for request in server.incoming_requests() {
        // A browser that hangs up early is no fault.
        let _ = answer(request, assets);
    }
    Ok(())
}

/// Answers from memory: what is not part of the page does not exist.
fn answer(request: Request, assets: &[Asset]) -> std::io::Result<()> {
    if !matches!(request.method(), Method::Get | Method::Head) {
        return request.respond(Response::empty(405).with_header(header("Allow", "GET, HEAD")));
    }
    let path = request.url().split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let path = if path.is_empty() { "index.html" } else { path };
    let Some((_, bytes)) = assets.iter().find(|(known, _)| known == path) else {
        return request.respond(Response::from_string("not found\n").with_status_code(404));
    };
    let extension = Path::new(path).extension().and_then(|extension| extension.to_str()).unwrap_or("");
    let known = TYPES.iter().find(|(name, _)| *name == extension);
    let content = known.map_or("application/octet-stream", |(_, content)| content);
    let response = Response::from_data(bytes.as_slice())
        .with_chunked_threshold(usize::MAX)
        .with_header(header("Content-Type", content))
        .with_header(header("Cache-Control", "no-cache"));
    request.respond(response)
}

fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("names and values are ASCII")
}
