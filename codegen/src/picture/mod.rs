//! What a picture of a scene needs besides kernels: reflectances and their tables, meshes, normal maps and whole shaders.

pub mod assets;
pub mod brdf;
pub mod camera;
pub mod mesh;
pub mod normal_map;
pub mod requirement;
pub mod shade;
pub mod vector;

/// Why a file is no mesh or no normal map, as one line: the file, what is wrong, what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name}: {message}; {help}")]
pub struct AssetError {
    /// The file.
    pub name: String,
    /// What is wrong with it.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl AssetError {
    pub(crate) fn new(name: &str, message: String, help: &str) -> Self {
        Self { name: name.to_owned(), message, help: help.to_owned() }
    }
}
