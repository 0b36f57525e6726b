//! `zonal init`: a scene to begin with.

use std::path::Path;
use tera::{Context, Tera};
use toml::Value;
use zonal_cli::terminal::{Failure, out};
use zonal_codegen::files::{self, Replace};
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Maps, Scene};

/// What a scene is called that no file names well.
const NAME: &str = "scene";
/// What stands before a line that is optional.
const OPTIONAL: &str = "#";

/// The name of a scene in a file: the letters, digits and `_` of the file's stem.
fn name(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let name: String = stem.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name.to_lowercase() } else { NAME.to_owned() }
}

/// Writes a scene that can be generated as it stands, with all that it may hold besides.
///
/// # Errors
///
/// If a file is there, `map` is not, or the file system refuses.
pub fn run(file: &Path, map: Option<&Path>, replace: Replace) -> Result<(), Failure> {
    let (folder, base) = files::split(file);
    let written = match map {
        None => "light.hdr".to_owned(),
        Some(map) if !map.exists() => {
            let message = format!("{}: is not there", map.display());
            return Err(
                Diagnostic::nowhere(message, "name an environment map, or the folder of a cube's six faces").into()
            );
        }
        // A scene names its files relative to itself.
        Some(map) if folder != Path::new(".") => {
            std::path::absolute(map).unwrap_or_else(|_| map.to_owned()).display().to_string()
        }
        Some(map) => map.display().to_string(),
    };
    let mut context = Context::new();
    context.insert("file", &base);
    context.insert("name", &name(file));
    context.insert("map", &Value::String(written).to_string());
    context.insert("environment", if map.is_some() { "" } else { OPTIONAL });
    let text = Tera::default().render_str(zonal_templates::SCENE, &context, false);
    let text = text.unwrap_or_else(|error| panic!("the scene's template is at fault: {error}"));
    Scene::parse(&base, &text, Maps::Folder(folder.to_owned()))?;
    files::write_text(file, &text, replace)?;
    let shown = file.display();
    out(&format!("{shown}: a scene; now `zonal plan {shown}` says what it gets, `zonal generate {shown}` writes it\n"))
}
