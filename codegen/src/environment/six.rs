//! Six files, a face of a cube each: which is which, by their names alone.

use super::error::MapError;
use super::layout::FACES;
use std::path::{Path, PathBuf};

/// What faces are called, each list in the order of [`FACES`]. `front` is +z and `right` +x, as in OpenGL.
const NAMES: [[&str; 6]; 4] = [
    ["px", "nx", "py", "ny", "pz", "nz"],
    ["posx", "negx", "posy", "negy", "posz", "negz"],
    ["right", "left", "top", "bottom", "front", "back"],
    ["right", "left", "up", "down", "front", "back"],
];

/// What is said where names tell nothing.
const HELP: &str = "name the six files by their faces: px nx py ny pz nz, or posx negx … negz, or right left top bottom front \
                    back, alone or at the end, as in day_px.hdr; and name the folder that holds them alone, or their common \
                    name with * in the place of the face, as in sky/day_*.hdr";
/// The extensions of what may be a face.
const EXTENSIONS: [&str; 4] = ["hdr", "pic", "exr", "png"];
/// How many files of a folder are looked at.
const MOST: usize = 10_000;

/// Whether the last part of a path stands for several files.
pub(super) fn is_pattern(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().matches('*').count() == 1)
}

/// A file's name without folders and extension, in lower case.
fn stem(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_lowercase()
}

/// Whether a name ends in a word, with nothing or no letter before it.
fn ends_in(stem: &str, word: &str) -> bool {
    stem.strip_suffix(word).is_some_and(|before| !before.ends_with(|c: char| c.is_ascii_alphabetic()))
}

/// The places of the six faces among names. `what` is what errors call them.
///
/// # Errors
///
/// If there are not six, or their names do not say which is which.
pub(super) fn order(what: &str, names: &[&str]) -> Result<[usize; 6], MapError> {
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let mut best = (0, MapError::refused(what, "hold no face of a cube by their names", HELP));
    for words in NAMES {
        let of = |word: &str| -> Vec<usize> { (0..stems.len()).filter(|&i| ends_in(&stems[i], word)).collect() };
        let found = words.map(of);
        if let Some(place) = found.iter().position(|all| all.len() > 1) {
            let [first, second] = [0, 1].map(|i| names[found[place][i]]);
            let message = format!("hold the face {} twice: {first} and {second}", FACES[place]);
            let help = "name one set by a pattern, as in sky/day_*.hdr";
            return Err(MapError::refused(what, message, help));
        }
        let count = found.iter().filter(|all| !all.is_empty()).count();
        if count == 6 {
            return match names.len() {
                6 => Ok(found.map(|all| all[0])),
                more => Err(MapError::refused(what, format!("are {more}, and a cube has six faces"), HELP)),
            };
        }
        if count > best.0 {
            let missing: Vec<&str> = (0..6).filter(|&i| found[i].is_empty()).map(|i| words[i]).collect();
            let message = format!("hold only {count} faces of a cube: {} is missing", missing.join(", "));
            best = (count, MapError::refused(what, message, HELP));
        }
    }
    Err(best.1)
}

/// The six files that a folder holds or a pattern names, in the order of the faces.
///
/// # Errors
///
/// If they are not there, or their names do not say which is which.
pub(super) fn find(path: &Path) -> Result<[PathBuf; 6], MapError> {
    let what = path.display().to_string();
    if path.is_dir() {
        let entries = std::fs::read_dir(path).map_err(|source| MapError::Unreadable { name: what.clone(), source })?;
        let mut paths: Vec<PathBuf> = entries.take(MOST).flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| {
            let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
            extension.is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
        });
        paths.sort();
        let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        // What is beside the faces, such as a preview, is no face.
        let faces: Vec<&str> = names.iter().copied().filter(|name| is_face(name)).collect();
        return Ok(order(&format!("the files in {what}"), &faces)?.map(|i| PathBuf::from(faces[i])));
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let of = |word: &str| path.with_file_name(name.replace('*', word));
    let sets = NAMES.iter().map(|words| words.map(of));
    let complete = sets.clone().find(|set| set.iter().all(|path| path.is_file()));
    complete.ok_or_else(|| {
        // Of equals the first list.
        let most = sets.rev().max_by_key(|set| set.iter().filter(|path| path.is_file()).count());
        let missing = most.iter().flatten().find(|path| !path.is_file());
        let missing = missing.map(|path| path.display().to_string()).unwrap_or_default();
        MapError::refused(&what, format!("names no six files: there is no {missing}"), HELP)
    })
}

fn is_face(name: &str) -> bool {
    let stem = stem(name);
    NAMES.iter().flatten().any(|word| ends_in(&stem, word))
}

/// What six names have in common, for people.
pub(super) fn common(names: &[&str]) -> String {
    let Some(&first) = names.first() else { return "six faces".to_owned() };
    let shared = |a: &str, b: &str| a.chars().zip(b.chars()).take_while(|(a, b)| a == b).count();
    let length = names.iter().map(|name| shared(first, name)).min().unwrap_or(0);
    let text: String = first.chars().take(length).collect();
    let extension = first.rsplit_once('.').map_or("", |(_, extension)| extension);
    format!("{text}*.{extension}")
}
