//! Hashes the sources that a proof rests on, so that proofs which are kept on disk are not taken for those of another
//! prover ([`promise::proofs`]). It reads files and nothing else.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};

/// What a kernel, its operations and its bound are made from.
const FOLDERS: [&str; 5] = ["src/ir", "src/math", "src/families", "src/promise", "data"];

fn files(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { files(&path, found)? } else { found.push(path) }
    }
    Ok(())
}

fn main() -> io::Result<()> {
    let mut all = Vec::new();
    for folder in FOLDERS {
        println!("cargo::rerun-if-changed={folder}");
        files(Path::new(folder), &mut all)?;
    }
    all.sort();
    let mut hasher = DefaultHasher::new();
    for path in all {
        (&path, fs::read(&path)?).hash(&mut hasher);
    }
    println!("cargo::rustc-env=ZONAL_PROVER={:016x}", hasher.finish());
    Ok(())
}
