//! Files that a person names, read whole: regular ones, up to a limit. It knows nothing of what they hold.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Whether a path names what the process has open already, so that opening it waits for nobody: the standard input, or
/// what a shell puts in the place of `<(...)`.
fn is_open_already(path: &Path) -> bool {
    let below = |folder: &str| path.parent() == Some(Path::new(folder)) && path.file_name() != Some(OsStr::new(""));
    path == Path::new("/dev/stdin") || below("/dev/fd") || below("/proc/self/fd")
}

/// Refuses what is no regular file, such as a device or a pipe: it need not end, and opening it may already wait without end.
///
/// # Errors
///
/// If there is no such file, or it is another thing.
pub fn check_regular(path: &Path) -> io::Result<fs::Metadata> {
    let data = fs::metadata(path)?;
    match (data.is_file(), data.is_dir()) {
        (true, _) => Ok(data),
        (_, true) => Err(io::ErrorKind::IsADirectory.into()),
        _ => Err(io::Error::other("it is a device or a pipe, not a regular file")),
    }
}

/// Returns the bytes of a file of at most `limit` bytes. It must be a regular file, but for the standard input as
/// `/dev/stdin` and what a shell puts in the place of `<(...)`.
///
/// # Errors
///
/// If there is no such file, it is a folder, a device or a pipe, it cannot be read, or it is larger, which is
/// [`io::ErrorKind::FileTooLarge`]. Of no file are more than `limit + 1` bytes read.
pub fn read(path: &Path, limit: usize) -> io::Result<Vec<u8>> {
    let too_large = || {
        let text = format!("it is larger than {limit} bytes, the most that are read of such a file");
        io::Error::new(io::ErrorKind::FileTooLarge, text)
    };
    let length = match is_open_already(path) {
        true => 0,
        false => check_regular(path)?.len(),
    };
    if length > limit as u64 {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(length as usize);
    File::open(path)?.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    match bytes.len() > limit {
        true => Err(too_large()),
        false => Ok(bytes),
    }
}

/// As [`read()`], for a file of text.
///
/// # Errors
///
/// As [`read()`], or if it is not UTF-8.
pub fn read_text(path: &Path, limit: usize) -> io::Result<String> {
    String::from_utf8(read(path, limit)?).map_err(|error| {
        let text = format!("it is no text: byte {} is not UTF-8", error.utf8_error().valid_up_to());
        io::Error::new(io::ErrorKind::InvalidData, text)
    })
}
