//! The way in for a build script and for the command line: specs or a scene, to files. [`Builder::generate`] is pure
//! but for reading the scene and its map; what writes is thin.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), zonal_codegen::builder::Error> {
//!     zonal_codegen::builder::Builder::new("kernels")
//!         .spec("eval:3:rgb")
//!         .named("turn", "rotate:3:rgb")
//!         .write_to_out_dir()
//! }
//! ```
//!
//! What is generated is parsed and validated before it is written, unless this crate is built without its feature `check`
//! (`default-features = false`), by which a build script compiles half as long; then nothing is parsed before the compilers
//! of its user read it.
//!
//! Then `include!(concat!(env!("OUT_DIR"), "/kernels.rs"));` in a module of its own, and `include_str!` for the shaders.

use crate::emit::language::{self, Arrays, Target};
use crate::files::{self, Difference, File, FileError, Replace};
use crate::generate::{self, GenerateError};
use crate::plan::Plan;
use crate::plan::environment::EnvironmentPlan;
use crate::reflectance::brdf::Brdf;
use crate::scene::diagnostic::{Diagnostic, Place};
use crate::scene::{self, Located, Maps, Scene, Wanted};
use std::fmt;
use std::path::{Path, PathBuf};

/// Why nothing was generated or written.
#[derive(thiserror::Error)]
pub enum Error {
    /// A scene, a spec, a name or a map is at fault.
    #[error(transparent)]
    Scene(#[from] Diagnostic),
    /// A text could not be made, or a validator refused it.
    #[error(transparent)]
    Generate(#[from] GenerateError),
    /// The files could not be written.
    #[error(transparent)]
    Files(#[from] FileError),
    /// There is no build script around.
    #[error("`OUT_DIR` is not set: `write_to_out_dir` is for build scripts; call `write` with a folder elsewhere")]
    NoOutDir,
}

/// As [`Display`](fmt::Display) writes it, since this is what a build script that returns the error shows.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Where a builder's scene comes from.
#[derive(Clone, Debug)]
enum Origin {
    File(PathBuf),
    Scene(Box<Scene>),
}

/// Generates kernels: collects what is wanted, then [`generate`](Self::generate)s, [`write`](Self::write)s or
/// [`check`](Self::check)s what is written already.
///
/// Every text is parsed and validated, by the feature `check` of this crate. Without that feature nothing is parsed: the
/// files are what zonal printed. Its own tests have checked the kernels of its catalogue.
#[derive(Clone, Debug)]
pub struct Builder {
    origin: Origin,
    kernels: Vec<Wanted>,
    targets: Vec<Target>,
    arrays: Option<Arrays>,
    form: Option<Located<String>>,
    replace: Replace,
}

fn located(source: &str, text: &str) -> Located<String> {
    Located { value: text.to_owned(), place: Place::whole(source, text) }
}

impl Builder {
    fn from_origin(origin: Origin) -> Self {
        Self { origin, kernels: vec![], targets: vec![], arrays: None, form: None, replace: Replace::Own }
    }

    /// An empty builder whose files are called `name`.
    pub fn new(name: &str) -> Self {
        Scene::new(located("Builder::new", name)).into()
    }

    /// What a scene file asks for. The file is read later, by what generates.
    pub fn scene(path: impl Into<PathBuf>) -> Self {
        Self::from_origin(Origin::File(path.into()))
    }

    /// Adds a kernel by its spec, as in `rotate:5:rgb`.
    #[must_use]
    pub fn spec(mut self, spec: &str) -> Self {
        self.kernels.push(Wanted { spec: located("Builder::spec", spec), name: None, max_angle: None });
        self
    }

    /// Adds a kernel by its spec, under a name of your own.
    #[must_use]
    pub fn named(mut self, name: &str, spec: &str) -> Self {
        self.kernels.push(Wanted {
            spec: located("Builder::named", spec),
            name: Some(located("Builder::named", name)),
            max_angle: None,
        });
        self
    }

    /// Adds a language; without any, those of the scene are printed, or all.
    #[must_use]
    pub fn target(mut self, target: Target) -> Self {
        self.targets.push(target);
        self
    }

    /// Sets how kernels take and return arrays; without it, as the scene says, or as each language does by itself.
    #[must_use]
    pub fn arrays(mut self, arrays: Arrays) -> Self {
        self.arrays = Some(arrays);
        self
    }

    /// Sets the form of the files, by its name, as `form` of a scene does.
    #[must_use]
    pub fn form(mut self, form: &str) -> Self {
        self.form = Some(located("Builder::form", form));
        self
    }

    /// Replaces files that zonal did not write, too; without it they are an error, and nothing is written.
    #[must_use]
    pub fn force(mut self) -> Self {
        self.replace = Replace::Any;
        self
    }

    fn resolved(&self) -> Result<Scene, Diagnostic> {
        let mut scene = match &self.origin {
            Origin::File(path) => Scene::read(path)?,
            Origin::Scene(scene) => (**scene).clone(),
        };
        scene.kernels.extend(self.kernels.iter().cloned());
        scene.arrays = self.arrays.or(scene.arrays);
        if !self.targets.is_empty() {
            scene.targets.clone_from(&self.targets);
            language::sort(&mut scene.targets);
        }
        if let Some(form) = &self.form {
            scene.form = Some(scene::form(form, &scene.targets)?);
        }
        Ok(scene)
    }

    /// What would be generated, and why.
    ///
    /// # Errors
    ///
    /// If the scene, a spec, a name or the map is at fault.
    pub fn plan(&self) -> Result<Plan, Error> {
        Ok(Plan::new(&self.resolved()?)?)
    }

    /// The files: one a language and a report of costs, `<name>.md`. They were parsed and validated, if this
    /// crate has its feature `check`.
    ///
    /// # Errors
    ///
    /// As [`Builder::plan`], or if a kernel is too long for a language.
    pub fn generate(&self) -> Result<Vec<File>, Error> {
        files_of(&self.plan()?)
    }

    /// Writes the files below a folder, those that changed, and returns how many did.
    ///
    /// # Errors
    ///
    /// As [`Builder::generate`], or if a file stands in the way that zonal did not write, or the file system refuses; then
    /// nothing is written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<usize, Error> {
        let files = self.generate()?;
        Ok(files::write(folder.as_ref(), &files, self.replace)?)
    }

    /// How the files in a folder differ from what would be written; other files there are left alone.
    ///
    /// # Errors
    ///
    /// As [`Builder::generate`], or if the folder cannot be read.
    pub fn check(&self, folder: impl AsRef<Path>) -> Result<Vec<Difference>, Error> {
        let files = self.generate()?;
        Ok(files::changes(folder.as_ref(), &files))
    }

    /// From a build script: writes the files into `OUT_DIR`, and tells cargo to run the script again when it, the scene,
    /// the map or the table of a reflectance changes. If no order that the scene affords keeps its budget, cargo shows a warning that says so.
    ///
    /// # Errors
    ///
    /// As [`Builder::write`], or if there is no build script around.
    pub fn write_to_out_dir(&self) -> Result<(), Error> {
        let folder = std::env::var_os("OUT_DIR").ok_or(Error::NoOutDir)?;
        println!("cargo::rerun-if-changed=build.rs");
        if let Origin::File(path) = &self.origin {
            println!("cargo::rerun-if-changed={}", path.display());
        }
        let scene = self.resolved()?;
        if let (Some(environment), Maps::Folder(maps)) = (&scene.environment, &scene.maps) {
            println!("cargo::rerun-if-changed={}", maps.join(&environment.map.value).display());
        }
        if let (Some(table), Maps::Folder(maps)) = (scene.brdf.as_ref().and_then(Brdf::table), &scene.maps) {
            println!("cargo::rerun-if-changed={}", maps.join(&table.name).display());
        }
        let plan = Plan::new(&scene)?;
        if let Some(warning) = plan.environment.as_ref().and_then(EnvironmentPlan::warning) {
            println!("cargo::warning={}: {warning}", plan.scene);
        }
        files::write(Path::new(&folder), &files_of(&plan)?, self.replace)?;
        Ok(())
    }
}

impl From<Scene> for Builder {
    fn from(scene: Scene) -> Self {
        Self::from_origin(Origin::Scene(Box::new(scene)))
    }
}

/// Returns the files of a plan, validated if this crate has its feature `check`.
///
/// # Errors
///
/// If a kernel is too long for a language, or a validator refuses a text, which is a fault of zonal.
pub fn files_of(plan: &Plan) -> Result<Vec<File>, Error> {
    let name = &plan.scene;
    let mut files = Vec::new();
    for &target in &plan.targets {
        let file = generate::file(&plan.module, target, "").map_err(|error| located_limit(plan, error))?;
        files.push(file);
    }
    files.push(File {
        path: format!("{name}.md"),
        text: format!(
            "<!-- @generated by zonal from the scene `{name}`; do not edit, generate it again. -->\n\n{plan}"
        ),
    });
    Ok(files)
}

/// A kernel that is too long is shown where it was asked for.
fn located_limit(plan: &Plan, error: GenerateError) -> Error {
    let GenerateError::Limit(limit) = &error else {
        return error.into();
    };
    let asked = plan.module.functions.iter().position(|function| function.spec.to_string() == limit.spec);
    match asked {
        Some(i) => Diagnostic::at(&plan.places[i], limit.to_string(), "").into(),
        None => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::Limit;

    #[test]
    fn a_kernel_that_is_too_long_is_shown_where_it_was_asked_for() {
        let plan = Builder::new("a").spec("eval:2").spec("eval:3").plan().expect("valid");
        let limit = |spec: &str| Limit {
            spec: spec.to_owned(),
            target: &language::WGSL,
            why: "6000 statements, and 5000 is the most".to_owned(),
            help: "take a lower order".to_owned(),
        };
        let error = located_limit(&plan, limit("eval:3").into()).to_string();
        assert!(
            error.starts_with("Builder::spec:1:1: `eval:3` cannot be printed for wgsl: 6000 statements, and 5000"),
            "{error}"
        );
        assert!(matches!(located_limit(&plan, limit("eval:4").into()), Error::Generate(_)));
    }
}
