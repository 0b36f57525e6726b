//! What people read of generated files, as texts: no mathematics, no type logic, no code but this list of names.

/// The files of kernels in WGSL.
pub const WGSL: &str = include_str!("../wgsl.tera");
/// The files of kernels in GLSL.
pub const GLSL: &str = include_str!("../glsl.tera");
/// The files of kernels in Rust.
pub const RUST: &str = include_str!("../rust.tera");
/// What the kernels in Rust are generic over.
pub const REAL: &str = include_str!("../real.rs.tera");

/// The scene that `zonal init` writes.
pub const SCENE: &str = include_str!("../scene.toml.tera");
/// The format of scenes as JSON schema, which `zonal schema` prints.
pub const SCENE_SCHEMA: &str = include_str!("../scene.schema.json");

macro_rules! texts {
    ($folder:literal: $($name:literal = $file:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../", $folder, "/", $file)))),*]
    };
}

/// What surrounds the kernels in a whole shader, by the names with which the templates include each other.
pub const PICTURE: &[(&str, &str)] = texts!["picture":
    "picture/head" = "head.tera",
    "picture/shade.wgsl" = "shade.wgsl.tera",
    "picture/shade.glsl" = "shade.glsl.tera",
    "picture/vertex.glsl" = "vertex.glsl.tera",
    "picture/check.wgsl" = "check.wgsl.tera",
    "picture/check.glsl" = "check.glsl.tera",
];

/// What reads the bands of a light from cubemaps, by the name of the language.
pub const BANDS: &[(&str, &str)] = texts!["bands":
    "wgsl" = "bands.wgsl.tera",
    "glsl" = "bands.glsl.tera",
];

/// The explorer's page, by the paths at which it is served.
pub const EXPLORER: &[(&str, &str)] = texts!["explorer":
    "index.html" = "index.html",
    "style.css" = "style.css",
    "app.js" = "app.js",
    "charts.js" = "charts.js",
    "figures.js" = "figures.js",
    "own.js" = "own.js",
    "webgl.js" = "webgl.js",
    "webgpu.js" = "webgpu.js",
    "shaders/display.wgsl" = "display.wgsl",
    "shaders/display.frag" = "display.frag",
];
