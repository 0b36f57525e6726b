//! The files of the explorer: its page, the shaders of every choice, and the data that they read, all from the library.

use crate::lighting::{self, Asset, Lit, ORDER, floats};
use crate::own::{self, Own};
use crate::upload;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::{Value, json};
use zonal_cli::terminal::Failure;
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::emit::Function;
// Names a language: these are what browsers take.
use zonal_codegen::emit::language::{GLSL, WGSL};
use zonal_codegen::emit::validate::validate;
use zonal_codegen::environment::Loaded;
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::generate;
use zonal_codegen::reflectance::brdf::{Brdf, Table};
use zonal_picture::mesh::{self, Mesh};
use zonal_picture::method::{Judged, Method};
use zonal_picture::normal_map::{LEAST_Z, NormalMap};
use zonal_picture::shade::{self, Shading};

/// The reflectances to choose from.
const BRDFS: [(&str, &str); 6] = [
    ("lambert", "Lambert"),
    ("phong:8", "Phong, exponent 8"),
    ("phong:30", "Phong, exponent 30"),
    ("ward:0.4", "Ward, roughness 0.4"),
    ("ward:0.25", "Ward, roughness 0.25"),
    ("ward:0.2:0.6", "Ward, brushed: 0.2 along, 0.6 across"),
];

/// The objects; the two that are no files come first.
const MESHES: [(&str, &str); 4] =
    [("sphere", "Sphere"), ("plane", "Plane"), ("meshes/teapot.obj", "Teapot"), ("meshes/bunny.obj", "Bunny")];

/// The normal maps; the one that is no file comes first.
const NORMALS: [(&str, &str); 4] = [
    ("flat", "None"),
    ("normals/0000.webp", "Dents"),
    ("normals/0003.webp", "Cracks"),
    ("normals/0015.webp", "Pebbles"),
];

/// The methods: what they are called and how band l errs when the normal leans by β.
const METHODS: [(Method, &str, &str); 6] = [
    (Method::Exact, "Exact", "no error but rounding"),
    (Method::Tilt, "Tilt", "bands 1 and 2 exact, band l errs by (lβ)³/24"),
    (Method::Tilt5, "Tilt, five shears", "bands 1 and 2 exact, band l errs by about (lβ)³/329"),
    (Method::Lf3, "Shears (lf3)", "band l errs by (lβ)³/24"),
    (Method::Taylor15, "Taylor 1.5", "band l errs by about (lβ)²/4"),
    (Method::None, "None: simplified normal mapping", "band l errs by about lβ, for nothing is turned"),
];

/// False colours for errors, from none to all: samples of matplotlib's `inferno` (CC0) at equal steps.
const RAMP: [&str; 9] =
    ["#000004", "#1f0c48", "#550f6d", "#88226a", "#ba3655", "#e35933", "#f98c0a", "#f9c932", "#fcffa4"];

/// Errors are given for every whole degree below this.
const DEGREES: usize = 90;

/// The last part of a path without its extension.
fn stem(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.split('.').next().unwrap_or(name)
}

/// The bytes of a file that zonal carries.
fn carried(path: &str) -> &'static [u8] {
    zonal_scenes::embedded(path).unwrap_or_default()
}

/// The reflectances of the page: its own, and those that were brought along.
pub fn reflectances(own: &Own) -> Result<Vec<Brdf>, Fault> {
    let mut all = BRDFS.iter().map(|(text, _)| text.parse()).collect::<Result<Vec<Brdf>, _>>()?;
    for brdf in &own.brdfs {
        if !all.contains(brdf) {
            all.push(brdf.clone());
        }
    }
    Ok(all)
}

/// Every file of the page.
pub fn assets(own: &Own, bar: &ProgressBar) -> Result<Vec<Asset>, Failure> {
    let reflectances = reflectances(own)?;
    let mut all: Vec<Asset> =
        zonal_templates::EXPLORER.iter().map(|&(path, text)| (path.to_owned(), text.as_bytes().to_vec())).collect();
    bar.set_message("measuring the kernels");
    let functions = generate::build(&specs());
    bar.set_message("writing and validating the shaders");
    all.extend(shaders(&functions)?);
    bar.set_message("projecting the reflectances");
    let (brdfs, tables) = brdfs(&reflectances);
    all.extend(tables);
    bar.set_message("preparing objects and lights");
    let (meshes, files) = meshes(own)?;
    all.extend(files);
    let (normals, files) = normals(own)?;
    all.extend(files);
    let (maps, files) = maps(own, &reflectances, bar)?;
    all.extend(files);
    all.push(("data/errors.bin".to_owned(), floats(errors())));
    let index = json!({
        "orders": ORDERS.collect::<Vec<_>>(),
        "methods": methods(&functions),
        "brdfs": brdfs,
        "meshes": meshes,
        "normals": normals,
        "maps": maps,
        "checks": functions.iter().map(check_of).collect::<Vec<_>>(),
        "degrees": DEGREES,
        "repeats": mesh::REPEATS,
        "leastZ": LEAST_Z,
        "ramp": RAMP,
        "bands": lighting::BANDS,
        "lightsARow": shade::LIGHTS_A_ROW,
        "first": own.first,
        "drop": {"path": upload::PATH, "most": upload::MAX_BODY},
    });
    all.push(("data/index.json".to_owned(), index.to_string().into_bytes()));
    Ok(all)
}

fn shadings() -> Vec<Shading> {
    let of = |order: usize| Method::TURNS.into_iter().flat_map(move |method| [true, false].map(|i| (order, method, i)));
    ORDERS.flat_map(of).map(|(order, method, isotropic)| Shading { order, method, isotropic }).collect()
}

/// The kernels of every shader, each once.
fn specs() -> Vec<Spec> {
    let mut specs: Vec<Spec> = shadings().iter().flat_map(Shading::specs).collect();
    specs.sort();
    specs.dedup();
    specs
}

fn shaders(functions: &[Function]) -> Result<Vec<Asset>, Failure> {
    let both = |stem: String, wgsl: String, glsl: String| -> Result<[Asset; 2], generate::GenerateError> {
        let paths = [format!("shaders/{stem}.wgsl"), format!("shaders/{stem}.frag")];
        validate(&WGSL, &paths[0], &wgsl)?;
        let [first, second] = paths;
        Ok([(first, wgsl.into_bytes()), (second, glsl.into_bytes())])
    };
    let shades = shadings().into_par_iter().map(|shading| {
        let Shading { order, method, isotropic } = shading;
        let kind = if isotropic { "isotropic" } else { "anisotropic" };
        let text = |target| shading.text(functions, target);
        both(format!("{order}-{method}-{kind}"), text(&WGSL)?, text(&GLSL)?)
    });
    let checks = functions.par_iter().map(|function| {
        let text = |target| shade::check(function, target);
        both(format!("check-{}", function.shader_name()), text(&WGSL)?, text(&GLSL)?)
    });
    let all: Result<Vec<[Asset; 2]>, _> = shades.chain(checks).collect();
    let vertex = ("shaders/vertex.vert".to_owned(), shade::glsl_vertex().into_bytes());
    let brute = both("all-bands".to_owned(), shade::brute(&WGSL), shade::brute(&GLSL))?;
    Ok(all?.into_iter().flatten().chain(brute).chain([vertex]).collect())
}

/// What the page must know to run a kernel on numbers of its own.
fn check_of(function: &Function) -> Value {
    let count: usize = function.built.code.params().iter().map(|param| param.shape.len()).sum();
    json!({
        "spec": function.spec.to_string(),
        "name": function.shader_name(),
        "inputs": count,
        "outputs": function.built.code.result().0.len(),
    })
}

fn methods(functions: &[Function]) -> Vec<Value> {
    let kernel = |method: Method, order: usize| {
        let spec = method.spec(order)?;
        let function = functions.iter().find(|function| function.spec == spec)?;
        let cost = function.built.code.cost(1);
        let row = json!({
            "spec": spec.to_string(),
            "name": spec.name(),
            "total": cost.total,
            "special": cost.special,
            "limit": spec.max_degrees(),
        });
        Some((order.to_string(), row))
    };
    METHODS
        .iter()
        .map(|&(method, label, law)| {
            let kernels: serde_json::Map<String, Value> = ORDERS.filter_map(|order| kernel(method, order)).collect();
            json!({"id": method.name(), "label": label, "law": law, "kernels": kernels})
        })
        .collect()
}

/// For each method, for each degree, the error of each band at worst; then all of that again as a root mean square.
fn errors() -> Vec<f32> {
    let angles: Vec<f64> = (0..DEGREES).map(|degrees| (degrees as f64).to_radians()).collect();
    let all = METHODS.par_iter().map(|(method, ..)| method.band_errors(ORDER, &angles));
    let typical = METHODS.par_iter().map(|(method, ..)| method.typical_band_errors(ORDER, &angles));
    all.chain(typical).flatten_iter().flatten_iter().map(|error| error as f32).collect()
}

/// What a reflectance is to the shader of brute force: its kind and its numbers.
fn numbers_of(brdf: &Brdf) -> [f64; 3] {
    match *brdf {
        Brdf::Lambert => [0.0, 0.0, 0.0],
        Brdf::Phong { exponent } => [1.0, exponent, 0.0],
        Brdf::Ward { alpha: [x, y] } => [2.0, x, y],
        // No shader of brute force knows it; the scene that would bring it is refused.
        Brdf::Measured(_) => [3.0, 0.0, 0.0],
    }
}

fn brdfs(all: &[Brdf]) -> (Vec<Value>, Vec<Asset>) {
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for brdf in all {
        let text = brdf.to_string();
        let label = BRDFS.iter().find(|(known, _)| *known == text).map_or(text.as_str(), |(_, label)| label);
        let table = Table::new(brdf, ORDER);
        let file = format!("data/brdf-{}.bin", text.replace([':', '.'], "-"));
        rows.push(json!({
            "id": text,
            "label": label,
            "isotropic": brdf.is_isotropic(),
            "numbers": numbers_of(brdf),
            "norms": lighting::norms(brdf),
            "elevations": table.elevations,
            "azimuths": table.azimuths,
            "file": file,
        }));
        files.push((file, floats(table.values)));
    }
    (rows, files)
}

/// The choices of a kind: those that were brought along, then the page's own, by what they are called.
fn choices<T>(own: &[(String, T)], all: Vec<(String, String, T)>) -> Vec<(String, String, T)>
where
    T: Clone,
{
    let brought =
        own.iter().enumerate().map(|(i, (label, made))| (format!("{}{}", own::ID, i + 1), label.clone(), made.clone()));
    brought.chain(all).collect()
}

fn meshes(own: &Own) -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let mut all = Vec::new();
    for (path, label) in MESHES {
        let mesh = match path {
            "sphere" => Mesh::sphere(),
            "plane" => Mesh::plane(),
            path => Mesh::from_obj(path, carried(path))?,
        };
        all.push((stem(path).to_owned(), label.to_owned(), mesh));
    }
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for (id, label, mesh) in choices(&own.meshes, all) {
        let file = format!("data/mesh-{id}.bin");
        rows.push(json!({
            "id": id,
            "label": label,
            "vertices": mesh.positions.len(),
            "indices": mesh.indices.len(),
            "file": file,
        }));
        let mut bytes = floats(mesh.interleaved());
        bytes.extend(mesh.indices.iter().flat_map(|index| index.to_le_bytes()));
        files.push((file, bytes));
    }
    Ok((rows, files))
}

fn normals(own: &Own) -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let mut all = Vec::new();
    for (path, label) in NORMALS {
        let map = match path {
            "flat" => NormalMap::flat(),
            path => NormalMap::from_bytes(path, carried(path))?,
        };
        all.push((stem(path).to_owned(), label.to_owned(), map));
    }
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for (id, label, map) in choices(&own.normals, all) {
        let file = format!("data/normals-{id}.bin");
        rows.push(json!({"id": id, "label": label, "width": map.width, "height": map.height, "file": file}));
        files.push((file, map.levels().into_iter().flatten().flatten().collect()));
    }
    Ok((rows, files))
}

/// The environment maps.
fn maps(own: &Own, brdfs: &[Brdf], bar: &ProgressBar) -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let carried = zonal_scenes::below("maps").map(|path| {
        let id = stem(path).split('_').next().unwrap_or_default();
        let (first, rest) = id.split_at(1);
        let loaded = Loaded::from_bytes(path, carried(path)).map_err(Fault::from)?;
        Ok(Lit { id: id.to_owned(), label: first.to_uppercase() + rest, loaded })
    });
    let carried = carried.collect::<Result<Vec<Lit>, Fault>>()?;
    let prepared = own.maps.iter().chain(&carried).map(|lit| {
        bar.set_message(format!("preparing the light of {}", lit.label));
        lighting::prepared(lit, brdfs)
    });
    Ok(prepared.unzip())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_band_do_not_depend_on_the_order() {
        let angle = [0.3];
        for method in Method::TURNS {
            let (low, high) = (method.band_errors(5, &angle), method.band_errors(ORDER, &angle));
            assert!(low[0].iter().zip(&high[0]).all(|(a, b)| (a - b).abs() < 1e-12), "{method}");
        }
    }
}
