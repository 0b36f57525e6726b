//! What a scene asks for, and the files that it names.

use crate::emit::language::{self, Arrays, Target};
use crate::families::family::Job;
use crate::input;
use crate::math::convention::{Axes, Convention};
use crate::reflectance::brdf::Brdf;
use crate::scene::budget::{Hemisphere, Norm, Precision, RelativeTo};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::located::{Located, Order};
use crate::scene::picture::Picture;
use crate::scene::sphere::SphereLight;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::PathBuf;

/// What a scene's environment is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    /// The relative rms error of what is seen that leaving bands out may cost.
    pub budget: f64,
    /// What that error is relative to.
    pub relative_to: RelativeTo,
    /// The most bands that the scene can afford.
    pub max_order: usize,
    /// What the constants are called.
    pub name: Located<String>,
    /// How they are held.
    pub convention: Located<Convention>,
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
    /// What the coefficients are of, where they are hemispherical.
    pub hemisphere: Option<Located<Hemisphere>>,
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
    /// The form of the files, if it is not each language's own; a target knows it at least.
    pub form: Option<&'static str>,
    /// The most vector registers that a kernel may take, if it is said.
    pub registers: Option<Located<usize>>,
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
    /// The spheres that shine, beside the map.
    pub lights: Vec<SphereLight>,
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
            form: None,
            registers: None,
            environment: None,
            kernels: vec![],
            rotations: vec![],
            brdf: None,
            lights: vec![],
            picture: None,
            maps: Maps::Folder(PathBuf::new()),
        }
    }

    /// Returns the axes that the scene says of its environment, if they are not zonal's: those of the program in which its
    /// coefficients are used, and in which its mesh is.
    pub fn axes(&self) -> Option<Axes> {
        let axes = self.environment.as_ref()?.convention.value.axes;
        (axes != Axes::default()).then_some(axes)
    }

    /// Returns the bytes of a file that the scene names, beside the scene or in memory.
    ///
    /// # Errors
    ///
    /// If it cannot be read, is no regular file, or is larger than `limit` bytes.
    pub fn bytes(&self, file: &Located<String>, limit: usize) -> Result<Cow<'static, [u8]>, Diagnostic> {
        let read = match &self.maps {
            Maps::Folder(folder) => input::read(&folder.join(&file.value), limit).map(Cow::Owned),
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
