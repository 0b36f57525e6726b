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
//! [brdf]                              # for pictures, see below; what [`crate::picture`] draws
//! kind = "ward"                       # or "phong" with an `exponent`, or "lambert" alone
//! alpha = [0.2, 0.6]                  # the roughness along the tangent and across it, or one number
//!
//! [picture]
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
//!
//! Without the feature `picture` of this crate, these last two tables are skipped.

pub mod budget;
pub mod diagnostic;
#[cfg(feature = "picture")]
pub mod picture;

use crate::emit::language::{self, Arrays, Target};
pub use crate::families::family::Job;
use crate::families::family::{MAX_ORDER, MIN_ORDER};
use crate::families::text::hint;
use crate::files;
use crate::scene::diagnostic::{Diagnostic, Place, Source};
pub use budget::{Norm, Precision};
use serde::Deserialize;
use serde::de::{Deserializer, Visitor};
use serde_spanned::Spanned;
use std::borrow::Cow;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest scene that is read, in bytes.
const MAX_BYTES: usize = 1 << 20;

/// The most signals that a rotation may turn: beyond it, only what is done for each of them counts.
const MAX_SIGNALS: usize = 1_000_000;

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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, serde::Serialize)]
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
    #[cfg(feature = "picture")]
    pub brdf: Option<crate::picture::brdf::Brdf>,
    /// What a picture shows.
    #[cfg(feature = "picture")]
    pub picture: Option<picture::Picture>,
    /// Where the maps are.
    pub maps: Maps,
}

/// The manifest as TOML holds it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    name: Spanned<String>,
    targets: Option<Spanned<Vec<Spanned<String>>>>,
    arrays: Option<Spanned<String>>,
    output: Option<Spanned<String>>,
    environment: Option<EnvironmentTable>,
    #[serde(default)]
    kernel: Vec<KernelTable>,
    #[serde(default)]
    rotation: Vec<RotationTable>,
    #[cfg_attr(not(feature = "picture"), expect(dead_code))]
    brdf: Option<tables::Brdf>,
    #[cfg_attr(not(feature = "picture"), expect(dead_code))]
    picture: Option<tables::Picture>,
}

/// What pictures are made from.
mod tables {
    #[cfg(feature = "picture")]
    pub(super) use super::picture::{BrdfTable as Brdf, PictureTable as Picture};
    #[cfg(not(feature = "picture"))]
    pub(super) use serde::de::{IgnoredAny as Brdf, IgnoredAny as Picture};
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EnvironmentTable {
    map: Spanned<String>,
    signal: Light,
    budget: Spanned<f64>,
    max_order: Option<Spanned<Order>>,
    name: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KernelTable {
    spec: Spanned<String>,
    name: Option<Spanned<String>>,
    max_angle: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RotationTable {
    kind: Job,
    order: Spanned<Order>,
    max_angle: Spanned<f64>,
    max_error: Spanned<f64>,
    norm: Option<Spanned<Norm>>,
    precision: Option<Spanned<Precision>>,
    #[serde(default)]
    rgb: bool,
    signals: Option<Spanned<i64>>,
    name: Option<Spanned<String>>,
}

impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OrderVisitor;
        impl Visitor<'_> for OrderVisitor {
            type Value = Order;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "an order from {MIN_ORDER} to {MAX_ORDER} or \"environment\"")
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Order, E> {
                match usize::try_from(value) {
                    Ok(order) if (MIN_ORDER..=MAX_ORDER).contains(&order) => Ok(Order::Number(order)),
                    _ => {
                        Err(E::custom(format!("order {value} is out of range: orders are {MIN_ORDER} to {MAX_ORDER}")))
                    }
                }
            }
            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Order, E> {
                self.visit_i64(i64::try_from(value).unwrap_or(i64::MAX))
            }
            fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Order, E> {
                match value {
                    "environment" => Ok(Order::Environment),
                    other => Err(E::custom(format!("`{other}` is no order: write a number, or \"environment\""))),
                }
            }
        }
        deserializer.deserialize_any(OrderVisitor)
    }
}

/// What a fault of the TOML itself says, with a suggestion for a word that was mistyped.
fn toml_diagnostic(error: &toml::de::Error, source: &Arc<Source>) -> Diagnostic {
    let message = error.message().trim().replace('\n', "; ");
    let span = error.span().unwrap_or(0..0);
    let place = Place { source: Arc::clone(source), span };
    let words: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match (message.split_once(", expected"), &words[..]) {
        (Some((unknown, _)), [got, known @ ..]) if message.starts_with("unknown") && !known.is_empty() => {
            Diagnostic::at(&place, unknown, hint(got, known))
        }
        _ => match message.split_once("; ") {
            Some((message, help)) => Diagnostic::at(&place, message, help),
            None if message.starts_with("missing field") => Diagnostic::at(&place, message, "add it"),
            None => Diagnostic::at(&place, message, ""),
        },
    }
}

/// Locates what serde found.
struct Locator(Arc<Source>);

impl Locator {
    fn at<T>(&self, spanned: Spanned<T>) -> Located<T> {
        let place = Place { source: Arc::clone(&self.0), span: spanned.span() };
        Located { value: spanned.into_inner(), place }
    }

    /// A value that may be left out, which then stands at another's place.
    fn or_default<T: Default, U>(&self, value: Option<Spanned<T>>, place: &Spanned<U>) -> Located<T> {
        match value {
            Some(value) => self.at(value),
            None => {
                let place = Place { source: Arc::clone(&self.0), span: place.span() };
                Located { value: T::default(), place }
            }
        }
    }

    /// A number within bounds, of which the lower may be excluded.
    fn number(&self, spanned: Spanned<f64>, what: &str, least: f64, most: f64) -> Result<Located<f64>, Diagnostic> {
        let located = self.at(spanned);
        match located.value > least && located.value <= most {
            true => Ok(located),
            false => Err(Diagnostic::at(
                &located.place,
                format!("{what} {} is out of range", located.value),
                format!("write a number above {least} and up to {most}"),
            )),
        }
    }

    fn signals(&self, spanned: Spanned<i64>) -> Result<usize, Diagnostic> {
        let located = self.at(spanned);
        let count = usize::try_from(located.value).ok().filter(|count| (1..=MAX_SIGNALS).contains(count));
        count.ok_or_else(|| {
            let message = format!("{} signals are out of range", located.value);
            Diagnostic::at(&located.place, message, format!("write a number from 1 to {MAX_SIGNALS}"))
        })
    }

    fn angle(&self, spanned: Spanned<f64>) -> Result<Located<f64>, Diagnostic> {
        self.number(spanned, "an angle in degrees of", 0.0, 180.0)
    }
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
            #[cfg(feature = "picture")]
            brdf: None,
            #[cfg(feature = "picture")]
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
        let manifest: Manifest = toml::from_str(text).map_err(|error| toml_diagnostic(&error, &source))?;
        let locate = Locator(source);
        let mut scene = Self::new(locate.at(manifest.name));
        scene.maps = maps;
        if let Some(targets) = manifest.targets {
            scene.targets = self::targets(&locate, targets)?;
        }
        if let Some(text) = manifest.arrays {
            scene.arrays = Some(arrays(&locate.at(text), &scene.targets)?);
        }
        if let Some(output) = manifest.output {
            let output = locate.at(output);
            if !files::stays_inside(&output.value) {
                let message = format!("`{}` leads out of the folder that zonal runs in", output.value);
                let help = "write a relative path without `..`, or give another folder with `--out`";
                return Err(Diagnostic::at(&output.place, message, help));
            }
            scene.output = output.value;
        }
        scene.environment = manifest.environment.map(|table| environment(&locate, table, &scene.name)).transpose()?;
        for table in manifest.kernel {
            scene.kernels.push(Wanted {
                spec: locate.at(table.spec),
                name: table.name.map(|name| locate.at(name)),
                max_angle: table.max_angle.map(|angle| locate.angle(angle)).transpose()?,
            });
        }
        for table in manifest.rotation {
            scene.rotations.push(Rotation {
                kind: table.kind,
                order: locate.at(table.order),
                max_angle: locate.angle(table.max_angle)?,
                norm: locate.or_default(table.norm, &table.max_error),
                precision: locate.or_default(table.precision, &table.max_error),
                max_error: locate.number(table.max_error, "an error of", 0.0, f64::MAX)?,
                rgb: table.rgb,
                signals: table.signals.map_or(Ok(1), |signals| locate.signals(signals))?,
                name: table.name.map(|name| locate.at(name)),
            });
        }
        #[cfg(feature = "picture")]
        {
            scene.brdf = manifest.brdf.map(|table| picture::brdf(&locate, table)).transpose()?;
            scene.picture = manifest.picture.map(|table| picture::picture(&locate, table)).transpose()?;
        }
        Ok(scene)
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

fn targets(locate: &Locator, list: Spanned<Vec<Spanned<String>>>) -> Result<Vec<Target>, Diagnostic> {
    let list = locate.at(list);
    if list.value.is_empty() {
        return Err(Diagnostic::at(&list.place, "no target is named", "name wgsl, glsl or rust, or leave the key out"));
    }
    let mut targets: Vec<Target> = Vec::new();
    for text in list.value {
        let Located { value, place } = locate.at(text);
        let Ok(target) = language::named(&value) else {
            let help = hint(&value, &language::names());
            return Err(Diagnostic::at(&place, format!("`{value}` is no target"), help));
        };
        if targets.contains(&target) {
            return Err(Diagnostic::at(&place, format!("`{value}` stands twice"), "leave one out"));
        }
        targets.push(target);
    }
    language::sort(&mut targets);
    Ok(targets)
}

fn arrays(text: &Located<String>, targets: &[Target]) -> Result<Arrays, Diagnostic> {
    let Located { value, place } = text;
    let Some(arrays) = Arrays::named(value) else {
        let help = hint(value, &Arrays::ALL.map(|(_, name)| name));
        return Err(Diagnostic::at(place, format!("`{value}` is no way to pass arrays"), help));
    };
    match targets.iter().find(|target| !target.arrays.contains(&arrays)) {
        None => Ok(arrays),
        Some(target) => {
            let able = language::ALL.iter().filter(|target| target.arrays.contains(&arrays));
            let able: Vec<String> = able.map(|target| format!("\"{target}\"")).collect();
            let message = format!("{} does not pass arrays as `{value}`", target.title);
            let help = format!("leave it out, or write `targets = [{}]`", able.join(", "));
            Err(Diagnostic::at(place, message, help))
        }
    }
}

fn environment(locate: &Locator, table: EnvironmentTable, scene: &Located<String>) -> Result<Environment, Diagnostic> {
    let max_order = match table.max_order.map(|order| locate.at(order)) {
        None => 10,
        Some(order) => match order.value {
            Order::Number(number) => number,
            Order::Environment => {
                let help = "write the most bands that the scene can afford, as a number";
                return Err(Diagnostic::at(&order.place, "the largest order cannot be `environment`", help));
            }
        },
    };
    let budget = locate.at(table.budget);
    if !(0.0..1.0).contains(&budget.value) {
        let message = format!("a budget of {} is out of range", budget.value);
        return Err(Diagnostic::at(
            &budget.place,
            message,
            "write a share of the whole, from 0 to below 1, as in 0.05",
        ));
    }
    Ok(Environment {
        map: locate.at(table.map),
        signal: table.signal,
        budget: budget.value,
        max_order,
        name: table.name.map_or_else(
            || Located { value: format!("{}_environment", scene.value), place: scene.place.clone() },
            |name| locate.at(name),
        ),
    })
}
