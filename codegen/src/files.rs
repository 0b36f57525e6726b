//! Files as text, and the one place that writes them: inside one folder, nothing half-written, what has not changed
//! untouched, what zonal did not write never replaced unasked.

use crate::fault::Fault;
use crate::input;
use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct File {
    /// Its path below the output folder, with `/`.
    pub path: String,
    /// Its whole text, lines ended by `\n`.
    pub text: String,
}

/// What may be replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Replace {
    /// What zonal wrote, which says so in its first lines or belongs to files of which one does.
    #[default]
    Own,
    /// Any file.
    Any,
}

impl Replace {
    /// Any file if it is forced, else what zonal wrote.
    pub fn forced(force: bool) -> Self {
        if force { Self::Any } else { Self::Own }
    }
}

/// Why files could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A path leads out of the output folder, by `..` or by a link.
    Outside(String),
    /// Files stand in the way that zonal did not write.
    Foreign {
        /// The first of them.
        path: PathBuf,
        /// How many others there are.
        others: usize,
    },
    /// A file stands where a folder is needed.
    NoFolder {
        /// The folder.
        folder: PathBuf,
        /// The file.
        file: PathBuf,
    },
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
            FileError::Outside(path) => Self::new(
                format!("`{path}` leads out of the output folder"),
                "use a relative path without `..` and without links to elsewhere",
            ),
            FileError::Foreign { path, others } => {
                let path = path.display();
                let message = match others {
                    0 => format!("`{path}` was not written by zonal"),
                    others => format!("`{path}` was not written by zonal, nor were {others} others in the way"),
                };
                let help =
                    "move it away, write elsewhere, or replace it with `--force`, in a build script `Builder::force`";
                Self::new(message, help)
            }
            FileError::NoFolder { folder, file } => Self::new(
                format!("cannot create `{}`: `{}` is a file", folder.display(), file.display()),
                "name a folder, or move the file away",
            ),
            FileError::Io { what, path, source } => {
                let place = path.display();
                match source.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        Self::new(format!("cannot {what} `{place}`: the disk is full"), "make room, then run it again")
                    }
                    _ => Self::new(
                        format!("cannot {what} `{place}`: {source}"),
                        "check that the folder exists and may be written",
                    ),
                }
            }
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
/// For any reason of [`check()`], or if the file system refuses.
pub fn write(folder: &Path, files: &[File], replace: Replace) -> Result<usize, FileError> {
    let files: Vec<(&str, &[u8])> = files.iter().map(|file| (file.path.as_str(), file.text.as_bytes())).collect();
    write_below(folder, &files, replace)
}

/// Writes one text, as [`write()`] does.
///
/// # Errors
///
/// As [`write()`].
pub fn write_text(path: &Path, text: &str, replace: Replace) -> Result<usize, FileError> {
    let (folder, name) = split(path);
    write_below(folder, &[(&name, text.as_bytes())], replace)
}

/// Returns the folder of a file and its name.
pub fn split(path: &Path) -> (&Path, String) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    (folder, path.file_name().unwrap_or_default().to_string_lossy().into_owned())
}

/// Writes files that need not be text, given as paths below the folder, with `/`, and bytes, all or none as [`write()`] does,
/// and returns how many changed.
///
/// # Errors
///
/// As [`write()`].
pub fn write_below(folder: &Path, files: &[(&str, &[u8])], replace: Replace) -> Result<usize, FileError> {
    check(folder, files, replace)?;
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

/// Whether files may be written below a folder, by what is there; nothing is written.
///
/// What zonal did not write is replaced by [`Replace::Any`] alone, unless it holds the same bytes. A file that cannot say who wrote it,
/// as a picture cannot, belongs to those that are written with it: it may be replaced where one of them says so.
///
/// # Errors
///
/// If a path leads out of the folder, by `..` or by a link, or a folder, a device or what zonal did not write stands in the
/// place of a file.
pub fn check(folder: &Path, files: &[(&str, &[u8])], replace: Replace) -> Result<(), FileError> {
    let mut foreign = Vec::new();
    let is_own_set = files.iter().any(|(path, bytes)| is_marked(bytes) && is_generated(&folder.join(path)));
    for &(path, bytes) in files {
        if !stays_inside(path) || !resolves_inside(folder, Path::new(path).parent().unwrap_or(Path::new(""))) {
            return Err(FileError::Outside(path.to_owned()));
        }
        let place = folder.join(path);
        match input::check_regular(&place) {
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => continue,
            result => result.map_err(io_error("write", &place))?,
        };
        let is_own = is_generated(&place) || (is_own_set && !is_marked(bytes));
        if replace == Replace::Own && !is_own && !holds(&place, bytes) {
            foreign.push(place);
        }
    }
    let others = foreign.len().saturating_sub(1);
    foreign.into_iter().next().map_or(Ok(()), |path| Err(FileError::Foreign { path, others }))
}

/// Whether a path stays below the folder that it is joined to once links are followed. What does not exist yet leads
/// nowhere else.
pub fn resolves_inside(folder: &Path, path: &Path) -> bool {
    let mut place = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() };
    let Ok(root) = place.canonicalize() else { return true };
    path.components().all(|part| {
        place.push(part);
        place.symlink_metadata().is_err() || place.canonicalize().is_ok_and(|real| real.starts_with(&root))
    })
}

/// Whether a file holds these bytes.
fn holds(place: &Path, bytes: &[u8]) -> bool {
    input::read(place, bytes.len()).is_ok_and(|old| old == bytes)
}

/// Creates a folder and those above it.
fn create(folder: &Path) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(|error| match folder.ancestors().find(|part| part.exists() && !part.is_dir()) {
        Some(file) => FileError::NoFolder { folder: folder.to_owned(), file: file.to_owned() },
        None => io_error("create", folder)(error),
    })
}

fn stage(folder: &Path, files: &[(&str, &[u8])], staged: &mut Vec<(PathBuf, PathBuf)>) -> Result<(), FileError> {
    create(folder)?;
    for &(path, bytes) in files {
        let place = folder.join(path);
        if holds(&place, bytes) {
            continue;
        }
        let parent = place.parent().unwrap_or(folder);
        create(parent)?;
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
        .filter_map(|file| {
            let place = folder.join(&file.path);
            match place.exists() {
                true if holds(&place, file.text.as_bytes()) => None,
                true => Some(Difference::Stale(file.path.clone())),
                false => Some(Difference::Missing(file.path.clone())),
            }
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

/// What the first lines of a file say that zonal wrote.
pub const MARK: &str = "@generated by zonal";

/// How many bytes the first lines of a file are.
const HEAD: usize = 400;

fn is_marked(bytes: &[u8]) -> bool {
    bytes[..bytes.len().min(HEAD)].windows(MARK.len()).any(|window| window == MARK.as_bytes())
}

/// Whether zonal wrote a file, by its first lines.
pub fn is_generated(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = input::check_regular(path)
        .and_then(|_| fs::File::open(path))
        .and_then(|file| file.take(HEAD as u64).read_to_end(&mut head));
    read.is_ok() && is_marked(&head)
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
