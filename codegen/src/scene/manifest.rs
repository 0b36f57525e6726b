//! The manifest of a scene as TOML holds it: its tables, and how they become a scene whose values know their places.

use crate::emit::language::{self, Arrays, Target};
use crate::families::family::{Job, MAX_ORDER, MIN_ORDER};
use crate::fault::hint;
use crate::files;
use crate::input;
use crate::math::convention::{Convention, ZONAL};
use crate::scene::budget::{Hemisphere, Norm, Precision, RelativeTo};
use crate::scene::diagnostic::{Diagnostic, Place, Source};
use crate::scene::frame;
#[cfg(feature = "schema")]
use crate::scene::located::MAX_SIGNALS;
use crate::scene::located::{Located, Locator, Order, Placed};
use crate::scene::picture::{self, BrdfTable, Kind, PictureTable};
use crate::scene::sphere::{self, LightTable};
use crate::scene::wanted::{Environment, Light, Maps, Rotation, Scene, Wanted};
use serde::Deserialize;
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::io;
use std::path::Path;
use std::sync::Arc;

/// A scene: what a renderer needs, from which zonal chooses, generates and writes kernels.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Manifest {
    /// What the files that are written are called, without their extension: letters, digits, `_` and `-`.
    name: Placed<String>,
    /// The languages to print; all of them if it is left out.
    #[cfg_attr(feature = "schema", schemars(with = "Option<Vec<super::words::Language>>"))]
    targets: Option<Placed<Vec<Placed<String>>>>,
    /// How functions take and return arrays; if it is left out, as a value, which every language does. `vec4` puts each
    /// item into a vector of four, as uniform buffers hold them. `sink`, in Rust alone, takes a signal as a function of the index
    /// and gives each number of the result to a function as soon as it is known. `memory`, in shaders alone, takes places
    /// in a memory that functions of yours read and write, so that arrays take no registers.
    #[cfg_attr(feature = "schema", schemars(with = "Option<super::words::Passed>"))]
    arrays: Option<Placed<String>>,
    /// The form of the files for what takes them in: `naga_oil` (WGSL with its import path), `wesl` (WGSL as a module of a
    /// WESL package), `bare` (WGSL or GLSL without comments and guards, for wgslFn and glslFn of three.js); each language's
    /// own if it is left out, and in languages that do not know it.
    #[cfg_attr(feature = "schema", schemars(with = "Option<super::words::FormName>"))]
    form: Option<Placed<String>>,
    /// The most vector registers that a kernel may take on AMD's RDNA 2, where a thread has 256 and half as many let twice as
    /// many waves run. A kernel that needs more is printed in pieces, a set-up and a function a band; without a limit none is.
    #[cfg_attr(feature = "schema", schemars(range(min = 1, max = 256)))]
    registers: Option<Placed<i64>>,
    /// The folder to write to, relative to the folder that zonal runs in, which it may not leave; `zonal-out/` and the name
    /// if it is left out.
    output: Option<Placed<String>>,
    /// The light that the scene stands in: its coefficients are written as constants, and its order is chosen.
    environment: Option<EnvironmentTable>,
    /// A kernel by its name.
    #[serde(default)]
    kernel: Vec<KernelTable>,
    /// A rotation by its error: zonal chooses the cheapest method that keeps it.
    #[serde(default)]
    rotation: Vec<RotationTable>,
    /// What the surface reflects. The order of the environment is then chosen by the light that is reflected.
    brdf: Option<BrdfTable>,
    /// A sphere that shines, beside the map, for who draws the scene.
    #[serde(default)]
    light: Vec<LightTable>,
    /// What a picture of the scene shows, which `zonal render` draws.
    picture: Option<PictureTable>,
}

/// The light that a scene stands in.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct EnvironmentTable {
    /// The environment map, relative to the scene: latitude and longitude, or a cubemap in a strip or a cross, as Radiance
    /// HDR, OpenEXR or PNG; or six faces, `sky` for their folder or `sky/day_*.png`.
    map: Placed<String>,
    /// What the kernels need of it.
    signal: Light,
    /// The relative error, in the root mean square, of what is seen that leaving out bands may cost, as in 0.05: of what the
    /// reflectance gives, over all normals and views; of irradiance, over all normals; or of the light itself.
    #[cfg_attr(feature = "schema", schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0)))]
    budget: Placed<f64>,
    /// What the error is relative to; `all_bands` if it is left out.
    #[serde(default)]
    relative_to: RelativeTo,
    /// The most bands that the scene can afford; 10 if it is left out, or as many as the convention has.
    max_order: Option<Placed<Order>>,
    /// What the constants are called; the scene's name and `_environment` if it is left out.
    name: Option<Placed<String>>,
    /// Where the directions of the coefficients lie: the name of a convention of docs/ENGINES.md, whose axes are taken, or the
    /// axes to the centre of the map, to the left of it and up, as in `x,-z,y`. If it is left out, those of the convention. A picture's
    /// mesh lies in these axes too.
    axes: Option<Placed<String>>,
    /// In whose convention the coefficients are held: a name of docs/ENGINES.md; zonal's own if it is left out.
    #[cfg_attr(feature = "schema", schemars(with = "Option<super::words::ConventionName>"))]
    convention: Option<Placed<String>>,
}

/// A kernel by its name.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct KernelTable {
    /// What to print, as in `rotate:5:rgb`: `zonal list` knows them all. Where the order would stand it may say
    /// `environment`: as many bands as the environment needs.
    spec: Placed<String>,
    /// What the function is called; its own name if it is left out.
    name: Option<Placed<String>>,
    /// The largest angle in degrees that it must take: a kernel for smaller angles is refused.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 180.0)))]
    max_angle: Option<Placed<f64>>,
}

/// A rotation by its error.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct RotationTable {
    /// Which rotation.
    kind: Job,
    /// The bands of the signal that is turned.
    order: Placed<Order>,
    /// The largest angle in degrees: of a tilt or about y.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 180.0)))]
    max_angle: Placed<f64>,
    /// The largest relative error at that angle, as in 0.01.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0.0)))]
    max_error: Placed<f64>,
    /// What it is the error of; `max` if it is left out.
    norm: Option<Placed<Norm>>,
    /// Where the coefficients are hemispherical ones, of what: `lobe` vanishes below the horizon, `record` goes on. The error is
    /// then the mean over such functions, and `norm` is left out.
    hemisphere: Option<Placed<Hemisphere>>,
    /// Which numbers the kernel may work in; `f32` if it is left out.
    precision: Option<Placed<Precision>>,
    /// Whether the signal has three channels.
    #[serde(default)]
    rgb: bool,
    /// How many signals each rotation turns, which shares what is done once for all of them; 1 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = 1, max = MAX_SIGNALS)))]
    signals: Option<Placed<i64>>,
    /// What the function is called; its own name if it is left out.
    name: Option<Placed<String>>,
}

/// Returns the format of scenes as JSON schema, in draft 2020-12. It is for editors, which complete and check a scene by
/// it, and for the page that documents it; what it cannot say, reading a scene checks.
#[cfg(feature = "schema")]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Manifest)
}

/// The words that a type knows, as serde lists them.
fn words<T: DeserializeOwned>() -> Option<String> {
    let error =
        T::deserialize("".into_deserializer()).map_err(|error: serde::de::value::Error| error.to_string()).err()?;
    error.split_once("expected ").map(|(_, known)| known.trim_start_matches("one of ").to_owned())
}

/// What the value of a field may be that must be there; `table` is the text from its table on.
fn values(field: &str, table: &str) -> Option<String> {
    match field {
        "signal" => words::<Light>(),
        "kind" if table.starts_with("[brdf]") => words::<Kind>(),
        "kind" => words::<Job>(),
        "name" => Some("the stem of the files, as in `name = \"probe\"`".to_owned()),
        "map" => Some(
            "the file of an environment map, .hdr, .exr or .png; or six faces of a cube, as in \"sky/*.png\""
                .to_owned(),
        ),
        "budget" => Some(BUDGET.to_owned()),
        // Names a family: it is an example of a spec.
        "spec" => Some("what to print, as in `spec = \"rotate:5:rgb\"`".to_owned()),
        "order" => Some(format!("a number from {MIN_ORDER} to {MAX_ORDER}, or \"environment\"")),
        "max_angle" => Some("a number of degrees, above 0 and up to 180".to_owned()),
        "max_error" => Some("a number above 0, as in 0.01".to_owned()),
        "position" => Some("three numbers, as in `position = [2, -1, 3]`".to_owned()),
        "radius" => Some("a number above 0 and below the distance".to_owned()),
        "radiance" => Some("R, G and B, as in `radiance = [8, 6, 4]`".to_owned()),
        "mesh" => Some("\"sphere\", \"plane\" or the file of a mesh, .obj".to_owned()),
        _ => None,
    }
}

/// What a budget may be.
const BUDGET: &str = "a share of the whole, from 0 to below 1, as in 0.05";

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
            None if message.starts_with("missing field") => {
                let help = match words.first().and_then(|field| values(field, place.text())) {
                    Some(values) => format!("add it: {values}"),
                    None => "add it".to_owned(),
                };
                Diagnostic::at(&place, message, help)
            }
            None => Diagnostic::at(&place, message, ""),
        },
    }
}

/// The largest scene that is read, in bytes.
const MAX_BYTES: usize = 1 << 20;

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    ///
    /// If it cannot be read or is no scene.
    pub fn read(path: &Path) -> Result<Self, Diagnostic> {
        let name = path.display().to_string();
        let bytes = input::read(path, MAX_BYTES).map_err(|error| match error.kind() {
            io::ErrorKind::FileTooLarge => {
                let message = format!("{name}: is larger than a scene may be, {MAX_BYTES} bytes");
                Diagnostic::nowhere(message, "a scene is a TOML file of a few lines")
            }
            _ => Diagnostic::nowhere(
                format!("{name}: cannot be read ({error})"),
                "check the path: a scene is a TOML file",
            ),
        })?;
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
        read(text, source, maps)
    }
}

/// Reads the text of a scene.
fn read(text: &str, source: Arc<Source>, maps: Maps) -> Result<Scene, Diagnostic> {
    let manifest: Manifest = toml::from_str(text).map_err(|error| toml_diagnostic(&error, &source))?;
    let locate = Locator(source);
    let mut scene = Scene::new(locate.at(manifest.name));
    scene.maps = maps;
    if let Some(list) = manifest.targets {
        scene.targets = targets(&locate, list)?;
    }
    if let Some(text) = manifest.arrays {
        scene.arrays = Some(arrays(&locate.at(text), &scene.targets)?);
    }
    if let Some(text) = manifest.form {
        scene.form = Some(form(&locate.at(text), &scene.targets)?);
    }
    scene.registers = manifest.registers.map(|registers| locate.registers(registers)).transpose()?;
    if let Some(output) = manifest.output {
        let output = locate.at(output);
        let path = Path::new(&output.value);
        if !files::stays_inside(&output.value) || !files::resolves_inside(Path::new("."), path) {
            let message = format!("`{}` leads out of the folder that zonal runs in", output.value);
            let help = "write a relative path without `..` and without links to elsewhere, or leave it out and give \
                        another folder with `--out`";
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
            hemisphere: table.hemisphere.map(|hemisphere| locate.at(hemisphere)),
            precision: locate.or_default(table.precision, &table.max_error),
            max_error: locate.number(table.max_error, "an error of", 0.0, f64::MAX)?,
            rgb: table.rgb,
            signals: table.signals.map_or(Ok(1), |signals| locate.signals(signals))?,
            name: table.name.map(|name| locate.at(name)),
        });
    }
    let bytes = |file: &Located<String>, limit| scene.bytes(file, limit);
    scene.brdf = manifest.brdf.map(|table| picture::brdf(&bytes, &locate, table)).transpose()?;
    scene.lights = manifest.light.into_iter().map(|table| sphere::light(&locate, table)).collect::<Result<_, _>>()?;
    scene.picture = manifest.picture.map(|table| picture::picture(&locate, table)).transpose()?;
    Ok(scene)
}

fn targets(locate: &Locator, list: Placed<Vec<Placed<String>>>) -> Result<Vec<Target>, Diagnostic> {
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
            let message = format!("{} does not pass arrays as `{value}`", target.title);
            Err(Diagnostic::at(place, message, fewer(|target| target.arrays.contains(&arrays))))
        }
    }
}

/// Returns the form of this name, which a target knows at least.
pub(crate) fn form(text: &Located<String>, targets: &[Target]) -> Result<&'static str, Diagnostic> {
    let Located { value, place } = text;
    let names = language::forms();
    let Some(&name) = names.iter().find(|name| *name == value) else {
        return Err(Diagnostic::at(place, format!("`{value}` is no form of a file"), hint(value, &names)));
    };
    if targets.iter().any(|target| target.form(name).is_some()) {
        return Ok(name);
    }
    let titles: Vec<&str> = targets.iter().map(|target| target.title).collect();
    let message = format!("{} has no form `{name}`", titles.join(" or "));
    Err(Diagnostic::at(place, message, fewer(|target| target.form(name).is_some())))
}

/// What to do where a target cannot do what others can.
fn fewer(is_able: impl Fn(Target) -> bool) -> String {
    let able = language::ALL.iter().filter(|target| is_able(target));
    let able: Vec<String> = able.map(|target| format!("\"{target}\"")).collect();
    format!("leave it out, or write `targets = [{}]`", able.join(", "))
}

/// The convention that an environment names, with the axes that it names; zonal's stands at the place of the scene.
fn convention(
    locate: &Locator,
    name: Option<Placed<String>>,
    axes: Option<Placed<String>>,
    scene: &Place,
) -> Result<Located<Convention>, Diagnostic> {
    let (name, axes) = (name.map(|name| locate.at(name)), axes.map(|axes| locate.at(axes)));
    let mut wanted = match &name {
        Some(name) => frame::convention(&name.value).map_err(|fault| Diagnostic::of(&name.place, fault))?,
        None => ZONAL,
    };
    if let Some(axes) = &axes {
        wanted.axes = frame::axes(&axes.value).map_err(|fault| Diagnostic::of(&axes.place, fault))?;
    }
    let place = name.or(axes).map_or_else(|| scene.clone(), |said| said.place);
    Ok(Located { value: wanted, place })
}

fn environment(locate: &Locator, table: EnvironmentTable, scene: &Located<String>) -> Result<Environment, Diagnostic> {
    let convention = convention(locate, table.convention, table.axes, &scene.place)?;
    let max_order = match table.max_order.map(|order| locate.at(order)) {
        None => convention.value.max_order.min(10),
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
        return Err(Diagnostic::at(&budget.place, message, format!("write {BUDGET}")));
    }
    frame::check(&convention.value, table.signal, max_order)
        .map_err(|fault| Diagnostic::of(&convention.place, fault))?;
    Ok(Environment {
        convention,
        map: locate.at(table.map),
        signal: table.signal,
        budget: budget.value,
        relative_to: table.relative_to,
        max_order,
        name: table.name.map_or_else(
            || Located { value: format!("{}_environment", scene.value), place: scene.place.clone() },
            |name| locate.at(name),
        ),
    })
}
