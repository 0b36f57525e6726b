//! What zonal carries with it: a scene, and the environment maps, meshes and normal maps of all scenes, by the paths
//! with which the scenes beside this package name them. It reads none of them.

/// The text of the scene that the command takes without one.
pub const GLOSSY: &str = include_str!("../glossy.toml");

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_bytes!(concat!("../", $path)))),*]
    };
}

/// Every file: its path, as a scene writes it, and its bytes.
pub const FILES: &[(&str, &[u8])] = files![
    "maps/city_256x128.hdr",
    "maps/courtyard_256x128.hdr",
    "maps/forest_256x128.hdr",
    "maps/interior_256x128.hdr",
    "maps/night_256x128.hdr",
    "maps/studio_256x128.hdr",
    "maps/sunrise_256x128.hdr",
    "maps/sunset_256x128.hdr",
    "meshes/bunny.obj",
    "meshes/teapot.obj",
    "normals/0000.webp",
    "normals/0003.webp",
    "normals/0015.webp",
];

/// The bytes of a file by its path.
pub fn embedded(path: &str) -> Option<&'static [u8]> {
    FILES.iter().find(|(name, _)| *name == path).map(|(_, bytes)| *bytes)
}

/// The paths in one folder, as in `maps`.
pub fn below(folder: &str) -> impl Iterator<Item = &'static str> {
    let prefix = format!("{folder}/");
    FILES.iter().map(|(path, _)| *path).filter(move |path| path.starts_with(&prefix))
}
