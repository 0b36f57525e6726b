//! What a person brings along: maps, a mesh and a scene on the command line. Each becomes one more choice on the page, and
//! the first of its kind the one that is shown first.

use crate::lighting::{Lit, ORDER};
use serde_json::{Map as Object, Value, json};
use std::path::{Path, PathBuf};
use zonal_cli::terminal::Failure;
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::environment::{self, Loaded};
use zonal_codegen::fault::Fault;
use zonal_codegen::input;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Maps, Order, Scene};
use zonal_picture::mesh::{self, Mesh};
use zonal_picture::method::Method;
use zonal_picture::normal_map::{self, NormalMap};

/// What was brought along, each with what people read of it.
#[derive(Default)]
pub struct Own {
    /// Maps.
    pub maps: Vec<Lit>,
    /// Meshes.
    pub meshes: Vec<(String, Mesh)>,
    /// Normal maps.
    pub normals: Vec<(String, NormalMap)>,
    /// Reflectances.
    pub brdfs: Vec<Brdf>,
    /// What the page shows first, where that is not its own first choice.
    pub first: Object<String, Value>,
}

/// What the identifiers of own things begin with; a number from 1 follows.
pub const ID: &str = "own-";

/// The last part of a path, without what it may not show.
pub fn name_of(path: &str) -> String {
    let trimmed = path.trim_end_matches(['/', '\\']);
    let name = trimmed.rsplit(['/', '\\']).next().unwrap_or(trimmed);
    name.chars().filter(|c| !c.is_control()).take(60).collect()
}

impl Own {
    /// Reads what the command line names: files that end in `.toml` are scenes, all others maps.
    ///
    /// # Errors
    ///
    /// If one of them cannot be read or is none.
    pub fn read(inputs: &[PathBuf], mesh: Option<&Path>) -> Result<Self, Failure> {
        let mut own = Self::default();
        for path in inputs {
            let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
            match is_scene {
                true => own.add_scene(&Scene::read(path)?)?,
                false => own.add_map(&path.display().to_string(), Loaded::read(path).map_err(Fault::from)?),
            }
        }
        if let Some(path) = mesh {
            let name = path.display().to_string();
            let bytes = input::read(path, mesh::MAX_BYTES).map_err(|error| {
                Fault::new(
                    format!("{name}: cannot be read ({error})"),
                    "check the path: a mesh is a Wavefront OBJ file",
                )
            })?;
            own.add_mesh(&name, Mesh::from_obj(&name, &bytes)?);
        }
        Ok(own)
    }

    fn set(&mut self, key: &str, value: Value) {
        self.first.insert(key.to_owned(), value);
    }

    fn set_first(&mut self, key: &str, value: Value) {
        self.first.entry(key.to_owned()).or_insert(value);
    }

    fn add_map(&mut self, path: &str, loaded: Loaded) {
        let id = format!("{ID}{}", self.maps.len() + 1);
        self.set_first("light", json!(id));
        self.maps.push(Lit { id, label: name_of(path), loaded });
    }

    fn add_mesh(&mut self, path: &str, mesh: Mesh) {
        self.meshes.push((name_of(path), mesh));
        self.set("mesh", json!(format!("{ID}{}", self.meshes.len())));
    }

    fn add_scene(&mut self, scene: &Scene) -> Result<(), Diagnostic> {
        if let Some(environment) = &scene.environment {
            let name = &environment.map.value;
            let loaded = match &scene.maps {
                Maps::Folder(folder) => Loaded::read(&folder.join(name)),
                Maps::Embedded(_) => Loaded::from_bytes(name, &scene.bytes(&environment.map, environment::MAX_BYTES)?),
            };
            let loaded = loaded.map_err(|error| Diagnostic::of(&environment.map.place, error))?;
            self.add_map(name, loaded);
        }
        if let Some(brdf) = &scene.brdf {
            if brdf.table().is_some() {
                let help = "`zonal render` draws it, `zonal plan --plot` shows what it needs; or leave `[brdf]` out";
                return Err(Diagnostic::at(&scene.name.place, "the explorer knows no tabulated reflectances", help));
            }
            self.set("brdf", json!(brdf.to_string()));
            self.brdfs.push(brdf.clone());
        }
        let Some(picture) = &scene.picture else { return Ok(()) };
        match picture.mesh.value.as_str() {
            known @ ("sphere" | "plane") => self.set("mesh", json!(known)),
            name => {
                let bytes = scene.bytes(&picture.mesh, mesh::MAX_BYTES)?;
                let mesh = Mesh::in_axes(name, &bytes, scene.axes());
                self.add_mesh(name, mesh.map_err(|error| Diagnostic::of(&picture.mesh.place, error))?);
            }
        }
        match &picture.normals {
            None => self.set("normals", json!("flat")),
            Some(file) => {
                let bytes = scene.bytes(file, normal_map::MAX_BYTES)?;
                let map = NormalMap::from_bytes(&file.value, &bytes);
                self.normals.push((name_of(&file.value), map.map_err(|error| Diagnostic::of(&file.place, error))?));
                self.set("normals", json!(format!("{ID}{}", self.normals.len())));
            }
        }
        let number = picture.order.as_ref().and_then(|order| match order.value {
            Order::Number(number) => Some(number),
            Order::Environment => None,
        });
        let most = scene.environment.as_ref().map(|environment| environment.max_order);
        if let Some(order) = number.or(most) {
            self.set("order", json!(order.clamp(*ORDERS.start(), ORDER)));
        }
        // The page has no tables: what reads them is exact but for their error.
        let method = picture.method.map(|method| if method.reads_tables() { Method::Exact } else { method });
        if let Some(method) = method {
            self.set("method", json!(method.name()));
        }
        let camera = picture.camera;
        for (key, value) in [
            ("strength", picture.strength),
            ("exposure", picture.exposure),
            ("azimuth", camera.azimuth),
            ("elevation", camera.elevation),
            ("distance", camera.distance),
            ("field", camera.field),
        ] {
            self.set(key, json!(value));
        }
        Ok(())
    }
}

/// A map that came over the wire.
pub fn dropped(number: usize, files: &[(String, Vec<u8>)]) -> Result<Lit, Fault> {
    let loaded = Loaded::from_files(files).map_err(Fault::from)?;
    let names: Vec<String> = files.iter().map(|(name, _)| name_of(name)).collect();
    let label = match &names[..] {
        [name] => name.clone(),
        [name, ..] => format!("{name} and {} more", names.len() - 1),
        [] => String::new(),
    };
    Ok(Lit { id: format!("{ID}dropped-{number}"), label, loaded })
}
