//! Files as text, and the one place that writes them: inside one folder, nothing half-written, what has not changed
//! untouched.

use crate::fault::Fault;
use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct File {
    /// Its path below the output folder, with `/`.
    pub path: String,
    /// Its whole text, lines ended by `\n`.
    pub text: String,
}

/// Why files could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A path leads out of the output folder.
    Outside(String),
    /// The file system refused.
    Io {
        /// What was tried.
        what: &'static str,
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl From<&FileError> for Fault {
    fn from(error: &FileError) -> Self {
        match error {
            FileError::Outside(path) => {
                Self::new(format!("`{path}` leads out of the output folder"), "use a relative path without `..`")
            }
            FileError::Io { what, path, source } => Self::new(
                format!("cannot {what} `{}`: {source}", path.display()),
                "check that the folder exists and may be written",
            ),
        }
    }
}

impl From<FileError> for Fault {
    fn from(error: FileError) -> Self {
        (&error).into()
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Fault::from(self).fmt(f)
    }
}

fn io_error(what: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FileError {
    let path = path.to_owned();
    move |source| FileError::Io { what, path, source }
}

/// Whether a path stays below the folder that it is joined to.
pub fn stays_inside(path: &str) -> bool {
    !path.is_empty()
        && Path::new(path).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// How a folder differs from what it should hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// A file that should be there is not.
    Missing(String),
    /// A file holds another text.
    Stale(String),
    /// A file that nothing generates any more.
    Orphaned(String),
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(path) => write!(f, "missing: {path}"),
            Self::Stale(path) => write!(f, "stale: {path}"),
            Self::Orphaned(path) => write!(f, "orphaned: {path}"),
        }
    }
}

/// Writes files below a folder and returns how many changed. Every text is first written beside its place; only when all
/// of them are there are they renamed, so that a failure leaves the folder as it was.
///
/// # Errors
///
/// If a path leads out of the folder or the file system refuses.
pub fn write(folder: &Path, files: &[File]) -> Result<usize, FileError> {
    let files: Vec<(&str, &[u8])> = files.iter().map(|file| (file.path.as_str(), file.text.as_bytes())).collect();
    write_below(folder, &files)
}

/// Writes files that need not be text, given as paths below the folder, with `/`, and bytes, all or none as [`write()`] does,
/// and returns how many changed.
///
/// # Errors
///
/// As [`write()`].
pub fn write_below(folder: &Path, files: &[(&str, &[u8])]) -> Result<usize, FileError> {
    if let Some((path, _)) = files.iter().find(|(path, _)| !stays_inside(path)) {
        return Err(FileError::Outside((*path).to_owned()));
    }
    let mut staged: Vec<(PathBuf, PathBuf)> = Vec::new();
    let mut result = stage(folder, files, &mut staged);
    for (temporary, place) in &staged {
        result = result.and_then(|()| fs::rename(temporary, place).map_err(io_error("write", place)));
        if result.is_err() {
            let _ = fs::remove_file(temporary);
        }
    }
    result.map(|()| staged.len())
}

fn stage(folder: &Path, files: &[(&str, &[u8])], staged: &mut Vec<(PathBuf, PathBuf)>) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(io_error("create", folder))?;
    for &(path, bytes) in files {
        let place = folder.join(path);
        if fs::read(&place).is_ok_and(|old| old == bytes) {
            continue;
        }
        if place.is_dir() {
            return Err(io_error("write", &place)(io::ErrorKind::IsADirectory.into()));
        }
        let parent = place.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(io_error("create", parent))?;
        let name = place.file_name().unwrap_or_default().to_string_lossy();
        let temporary = parent.join(format!(".{name}.{}.tmp", std::process::id()));
        staged.push((temporary.clone(), place));
        fs::write(&temporary, bytes).map_err(io_error("write", &temporary))?;
    }
    Ok(())
}

/// Compares the files of a folder with what they should hold; others are left alone.
pub fn changes(folder: &Path, files: &[File]) -> Vec<Difference> {
    files
        .iter()
        .filter_map(|file| match fs::read(folder.join(&file.path)) {
            Ok(text) if text == file.text.as_bytes() => None,
            Ok(_) => Some(Difference::Stale(file.path.clone())),
            Err(_) => Some(Difference::Missing(file.path.clone())),
        })
        .collect()
}

/// Compares a folder with what it should hold, all of it but for what may lie `beside` the files.
///
/// # Errors
///
/// If a folder cannot be read.
pub fn differences(folder: &Path, files: &[File], beside: &[&str]) -> Result<Vec<Difference>, FileError> {
    let mut found = changes(folder, files);
    let known: BTreeSet<&str> = files.iter().map(|file| file.path.as_str()).collect();
    for path in below(folder)? {
        if !known.contains(path.as_str()) && !beside.contains(&path.as_str()) {
            found.push(Difference::Orphaned(path));
        }
    }
    Ok(found)
}

/// Whether zonal wrote a file, by its first lines.
pub fn is_generated(path: &Path) -> bool {
    use io::Read;
    let mut head = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(400).read_to_end(&mut head));
    read.is_ok() && String::from_utf8_lossy(&head).contains("@generated by zonal")
}

/// Removes the files of a folder that nothing generates, but for what may lie `beside`, and the folders that they leave
/// empty.
///
/// # Errors
///
/// If the file system refuses.
pub fn remove_orphans(folder: &Path, files: &[File], beside: &[&str]) -> Result<usize, FileError> {
    let mut removed = 0;
    for difference in differences(folder, files, beside)? {
        if let Difference::Orphaned(path) = difference {
            let place = folder.join(path);
            fs::remove_file(&place).map_err(io_error("remove", &place))?;
            let mut parent = place.parent();
            while let Some(empty) = parent.filter(|parent| *parent != folder && fs::remove_dir(parent).is_ok()) {
                parent = empty.parent();
            }
            removed += 1;
        }
    }
    Ok(removed)
}

/// Every file below a folder, sorted, with `/`; none if there is no such folder.
fn below(folder: &Path) -> Result<Vec<String>, FileError> {
    let mut files = Vec::new();
    let mut open = vec![(folder.to_owned(), String::new())];
    while let Some((place, prefix)) = open.pop() {
        let entries = match fs::read_dir(&place) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            entries => entries.map_err(io_error("read", &place))?,
        };
        for entry in entries {
            let entry = entry.map_err(io_error("read", &place))?;
            let path = format!("{prefix}{}", entry.file_name().to_string_lossy());
            // A link is not followed: it could lead anywhere.
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                open.push((entry.path(), format!("{path}/")));
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
