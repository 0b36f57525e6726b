//! A scene: what a renderer needs, as a TOML manifest. It says which kernels, or which rotations within which error, and
//! which environment map, for which languages; [`crate::plan`] decides what that comes to. Every value keeps its place
//! in the text, so that whatever is wrong with it is shown where it stands.
//!
//! ```toml
//! name = "glossy"                     # the stem of the files
//! targets = ["wgsl", "glsl", "rust"]  # all three if left out
//! arrays = "value"                    # if left out; or "struct" or "reference": how kernels take and return arrays, for
//!                                     # languages that know more than one way, which is GLSL alone
//! output = "zonal-out/glossy"         # this if left out; below the folder that zonal runs in
//!
//! [environment]                       # optional: a map's coefficients as constants
//! map = "maps/city_256x128.hdr"       # beside the scene file
//! signal = "radiance"                 # or "irradiance"
//! max_order = 5                       # 10 if left out
//! budget = 0.05                       # the relative rms error, against max_order, that leaving orders out may cost
//! name = "city"                       # the constants are called CITY
//!
//! [[kernel]]
//! spec = "eval:environment:rgb"       # `environment` is the order that the map was found to need
//! name = "shade"                      # optional, a name of your own
//! max_angle = 15                      # optional, in degrees: the method must take it
//!
//! [[rotation]]                        # an error budget instead of a method
//! kind = "tilt"                       # z to a normal; or "y", about y by an angle; or "zyz", any three angles; or
//!                                     # "quaternion", any rotation whose y angle is bounded
//! order = "environment"               # or a number
//! max_angle = 15                      # the largest tilt, or angle about y, in degrees
//! max_error = 0.05                    # of a band's norm, the worst band
//! norm = "max"                        # the worst signal's error, if left out; or "mean", a random one's; or "signal",
//!                                     # that of the environment's energies, against all of it
//! precision = "f32"                   # if left out; or "f16" (WGSL alone), or "auto": f16 where the error allows it
//! rgb = true
//! signals = 1                         # if left out; how many such signals each rotation turns: with more, a kernel may
//!                                     # be chosen that does the set-up of a `quaternion` once for all of them
//! name = "bump"                       # optional
//!
//! [brdf]                              # what the surface reflects; it decides what is required of the environment
//! kind = "ward"                       # or "phong" with an `exponent`, or "lambert" alone
//! alpha = [0.2, 0.6]                  # the roughness along the tangent and across it, or one number
//!
//! [picture]                           # for who draws the scene: `zonal-render`
//! mesh = "meshes/teapot.obj"          # beside the scene file; or "sphere" or "plane"
//! normals = "normals/0003.webp"       # optional
//! strength = 1.0                      # of the normal map: a factor for its slopes; this if left out
//! size = [960, 540]                   # this if left out
//! method = "tilt"                     # if left out, what was chosen for the first rotation of the kind "tilt"
//! order = 5                           # if left out, the environment's
//! azimuth = 0                         # of the camera, which looks at the middle of the object, in degrees
//! elevation = 15                      # in degrees
//! distance = 4                        # in radii of the object
//! field = 30                          # of view from bottom to top, in degrees
//! exposure = 0                        # in stops
//! ```

pub mod budget;
pub mod diagnostic;
mod manifest;
pub mod picture;

use crate::emit::language::{self, Arrays, Target};
pub use crate::families::family::Job;
use crate::reflectance::brdf::Brdf;
use crate::scene::diagnostic::{Diagnostic, Place, Source};
use crate::scene::picture::Picture;
pub use budget::{Norm, Precision};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest scene that is read, in bytes.
const MAX_BYTES: usize = 1 << 20;

/// A value and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where.
    pub place: Place,
}

/// An order in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// A number of bands.
    Number(usize),
    /// As many as the environment needs.
    Environment,
}

/// What a scene's environment is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Light {
    /// The light from a direction.
    Radiance,
    /// The light that reaches a surface by its normal.
    Irradiance,
}

/// The environment of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// The file of the map, as the scene writes it.
    pub map: Located<String>,
    /// What is wanted of it.
    pub signal: Light,
    /// The relative rms error against `max_order` that leaving out orders below it may cost.
    pub budget: f64,
    /// The most bands that the scene can afford.
    pub max_order: usize,
    /// What the constants are called.
    pub name: Located<String>,
}

/// A kernel that a scene names.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// The spec's text; its order may be `environment`.
    pub spec: Located<String>,
    /// A name that replaces the spec's own.
    pub name: Option<Located<String>>,
    /// The largest angle in degrees that it must take.
    pub max_angle: Option<Located<f64>>,
}

/// A rotation that a scene bounds instead of naming a method.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotation {
    /// Which rotation.
    pub kind: Job,
    /// The order of the signal.
    pub order: Located<Order>,
    /// The largest angle in degrees.
    pub max_angle: Located<f64>,
    /// The largest error.
    pub max_error: Located<f64>,
    /// What it is the error of.
    pub norm: Located<Norm>,
    /// Which numbers it may work in.
    pub precision: Located<Precision>,
    /// Whether the signal has three channels.
    pub rgb: bool,
    /// How many such signals each rotation turns.
    pub signals: usize,
    /// A name that replaces the spec's own.
    pub name: Option<Located<String>>,
}

/// Where the maps of a scene are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Maps {
    /// In files, named relative to this folder.
    Folder(PathBuf),
    /// In memory, by the names that the scene uses.
    Embedded(&'static [(&'static str, &'static [u8])]),
}

/// What a renderer needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The stem of the files.
    pub name: Located<String>,
    /// The languages, each once, in their own order.
    pub targets: Vec<Target>,
    /// How kernels take and return arrays, if it is said.
    pub arrays: Option<Arrays>,
    /// The output folder, relative.
    pub output: String,
    /// The environment.
    pub environment: Option<Environment>,
    /// The kernels by name.
    pub kernels: Vec<Wanted>,
    /// The rotations by error.
    pub rotations: Vec<Rotation>,
    /// What the surface reflects.
    pub brdf: Option<Brdf>,
    /// What a picture shows.
    pub picture: Option<Picture>,
    /// Where the maps are.
    pub maps: Maps,
}

impl Scene {
    /// A scene that asks for nothing yet, for all targets, its folder named after it.
    pub fn new(name: Located<String>) -> Self {
        Self {
            output: format!("zonal-out/{}", name.value),
            name,
            targets: language::ALL.to_vec(),
            arrays: None,
            environment: None,
            kernels: vec![],
            rotations: vec![],
            brdf: None,
            picture: None,
            maps: Maps::Folder(PathBuf::new()),
        }
    }

    /// Reads a scene file.
    ///
    /// # Errors
    ///
    /// If it cannot be read or is no scene.
    pub fn read(path: &Path) -> Result<Self, Diagnostic> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| {
            Diagnostic::nowhere(format!("{name}: cannot be read ({error})"), "check the path: a scene is a TOML file")
        })?;
        if bytes.len() > MAX_BYTES {
            let message = format!("{name}: is larger than a scene may be ({} of {MAX_BYTES} bytes)", bytes.len());
            return Err(Diagnostic::nowhere(message, "a scene is a TOML file of a few lines"));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let message = format!("{name}: is no text (byte {} is not UTF-8)", error.utf8_error().valid_up_to());
            Diagnostic::nowhere(message, "a scene is a TOML file")
        })?;
        Self::parse(&name, &text, Maps::Folder(path.parent().unwrap_or(Path::new("")).to_owned()))
    }

    /// Reads the text of a scene. `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// If it is no TOML, or a key is unknown, missing, or of the wrong type or range.
    pub fn parse(name: &str, text: &str, maps: Maps) -> Result<Self, Diagnostic> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        if text.trim().is_empty() {
            let message = format!("{name}: is empty");
            return Err(Diagnostic::nowhere(
                message,
                "begin with `name = \"...\"`, then a `[[kernel]]` with its `spec`",
            ));
        }
        manifest::read(text, source, maps)
    }

    /// The bytes of a file that the scene names, beside the scene or in memory.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn bytes(&self, file: &Located<String>) -> Result<Cow<'static, [u8]>, Diagnostic> {
        let read = match &self.maps {
            Maps::Folder(folder) => std::fs::read(folder.join(&file.value)).map(Cow::Owned),
            Maps::Embedded(files) => match files.iter().find(|(known, _)| *known == file.value) {
                Some((_, bytes)) => Ok(Cow::Borrowed(*bytes)),
                None => Err(std::io::ErrorKind::NotFound.into()),
            },
        };
        read.map_err(|error| {
            let message = format!("{}: cannot be read ({error})", file.value);
            Diagnostic::at(&file.place, message, "check the path, which is relative to the scene")
        })
    }
}
