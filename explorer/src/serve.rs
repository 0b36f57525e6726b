//! The command `explore`: writes the page and serves it to this machine alone.

use crate::http::{self, Answer, Site};
use crate::lighting::Asset;
use crate::own::Own;
use crate::page;
use crate::upload::{self, Uploads};
use std::borrow::Cow;
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
pub fn explore(own: &Own, folder: Option<PathBuf>, port: u16, serves: bool, replace: Replace) -> Result<(), Failure> {
    let start = Instant::now();
    // A port that is taken is known before anything is made.
    let listener = serves.then(|| listen(port)).transpose()?;
    let bar = progress("generating the explorer");
    let assets = page::assets(own, &bar)?;
    let folder = folder.unwrap_or_else(|| PathBuf::from(FOLDER));
    let list: Vec<(&str, &[u8])> = assets.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
    let changed = files::write_below(&folder, &list, replace)?;
    drop(bar);
    let megabytes = assets.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() as f64 / 1e6;
    out(&format!(
        "{} files in `{}`, {megabytes:.0} MB, of which {changed} were new or changed, in {:.1} s\n",
        assets.len(),
        folder.display(),
        start.elapsed().as_secs_f64()
    ))?;
    match listener {
        Some(listener) => serve(&listener, Page { assets, uploads: Uploads::new(page::reflectances(own)?) }),
        None => out("Serve the folder with any web server; a page from a file cannot load its data.\n"),
    }
}

fn listen(port: u16) -> Result<TcpListener, Diagnostic> {
    TcpListener::bind(("127.0.0.1", port)).map_err(|error| {
        let message = format!("cannot serve on port {port} of 127.0.0.1: {error}");
        Diagnostic::nowhere(message, "name another with `--port`, or none for one that is free")
    })
}

fn serve(listener: &TcpListener, page: Page) -> Result<(), Failure> {
    let fault = |error: io::Error| Diagnostic::nowhere(format!("cannot serve: {error}"), "end other programs");
    let address = listener.local_addr().map_err(fault)?;
    out(&format!("http://{address}/ shows it; end with ctrl-c\n"))?;
    http::serve(listener, &page).map_err(fault)?;
    Ok(())
}

/// The page as it is served: from memory, so that what is not part of it does not exist.
struct Page {
    assets: Vec<Asset>,
    uploads: Uploads,
}

impl Site for Page {
    fn get(&self, path: &str) -> Answer<'_> {
        let path = path.trim_start_matches('/');
        // The page names its icon itself; a browser that shows a file of it alone asks for this one.
        if path == "favicon.ico" {
            return Answer { status: "204 No Content", headers: String::new(), body: Cow::Borrowed(&[]) };
        }
        let path = if path.is_empty() { "index.html" } else { path };
        let made = || self.uploads.get(path).map(Cow::Owned);
        let known = self.assets.iter().find(|(known, _)| known == path).map(|(_, bytes)| Cow::Borrowed(&bytes[..]));
        let Some(body) = known.or_else(made) else {
            return Answer::line("404 Not Found", "not found\n");
        };
        let extension = Path::new(path).extension().and_then(|extension| extension.to_str()).unwrap_or("");
        let known = TYPES.iter().find(|(name, _)| *name == extension);
        let content = known.map_or("application/octet-stream", |(_, content)| content);
        Answer { status: "200 OK", headers: format!("Content-Type: {content}\r\nCache-Control: no-cache\r\n"), body }
    }

    fn takes(&self, path: &str) -> Option<usize> {
        (path.trim_start_matches('/') == upload::PATH).then_some(upload::MAX_BODY)
    }

    fn post(&self, _: &str, body: &[u8]) -> Answer<'_> {
        match self.uploads.add(body) {
            Ok(row) => Answer {
                status: "200 OK",
                headers: "Content-Type: application/json\r\nCache-Control: no-store\r\n".to_owned(),
                body: row.to_string().into_bytes().into(),
            },
            Err(fault) => Answer::line("422 Unprocessable Content", format!("{fault}\n")),
        }
    }
}
