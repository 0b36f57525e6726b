//! The files of the explorer: its page, the shaders of every choice, and the data that they read, all from the library.

use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::{Value, json};
use zonal_cli::terminal::Failure;
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::emit::Function;
// Names a language: these are what browsers take.
use zonal_codegen::emit::language::{GLSL, WGSL};
use zonal_codegen::emit::validate::validate;
use zonal_codegen::environment::Map;
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::generate;
use zonal_codegen::reflectance::brdf::{Brdf, Table};
use zonal_picture::mesh::{self, Mesh};
use zonal_picture::method::{Judged, Method};
use zonal_picture::normal_map::{LEAST_Z, NormalMap};
use zonal_picture::shade::{self, Shading};

/// A file of the page: its path below the folder, with `/`, and its bytes.
pub type Asset = (String, Vec<u8>);

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

/// The order of the light and of the tables; lower ones are their first bands.
const ORDER: usize = *ORDERS.end();
/// Errors are given for every whole degree below this.
const DEGREES: usize = 90;

fn floats(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
    values.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// The last part of a path without its extension.
fn stem(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.split('.').next().unwrap_or(name)
}

/// The bytes of a file that zonal carries.
fn carried(path: &str) -> &'static [u8] {
    zonal_scenes::embedded(path).unwrap_or_default()
}

/// Every file of the page.
pub fn assets(bar: &ProgressBar) -> Result<Vec<Asset>, Failure> {
    let mut all: Vec<Asset> =
        zonal_templates::EXPLORER.iter().map(|&(path, text)| (path.to_owned(), text.as_bytes().to_vec())).collect();
    bar.set_message("measuring the kernels");
    let functions = generate::build(&specs());
    bar.set_message("writing and validating the shaders");
    all.extend(shaders(&functions)?);
    bar.set_message("projecting the reflectances");
    let (brdfs, tables) = brdfs()?;
    all.extend(tables);
    bar.set_message("preparing objects and lights");
    let (meshes, files) = meshes()?;
    all.extend(files);
    let (normals, files) = normals()?;
    all.extend(files);
    let (maps, files) = maps()?;
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
    });
    all.push(("data/index.json".to_owned(), index.to_string().into_bytes()));
    Ok(all)
}

fn shadings() -> Vec<Shading> {
    let of = |order: usize| Method::ALL.into_iter().flat_map(move |method| [true, false].map(|i| (order, method, i)));
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
    Ok(all?.into_iter().flatten().chain([vertex]).collect())
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
        let row = json!({"spec": spec.to_string(), "name": spec.name(), "total": cost.total, "special": cost.special});
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

fn brdfs() -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for (text, label) in BRDFS {
        let brdf: Brdf = text.parse().map_err(Fault::from)?;
        let table = Table::new(&brdf, ORDER);
        rows.push(json!({
            "id": text,
            "label": label,
            "isotropic": brdf.is_isotropic(),
            "elevations": table.elevations,
            "azimuths": table.azimuths,
            "file": format!("data/brdf-{}.bin", text.replace([':', '.'], "-")),
        }));
        files.push((format!("data/brdf-{}.bin", text.replace([':', '.'], "-")), floats(table.values)));
    }
    Ok((rows, files))
}

fn meshes() -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for (path, label) in MESHES {
        let mesh = match path {
            "sphere" => Mesh::sphere(),
            "plane" => Mesh::plane(),
            path => Mesh::from_obj(path, carried(path))?,
        };
        let file = format!("data/mesh-{}.bin", stem(path));
        rows.push(json!({
            "id": stem(path),
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

fn normals() -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for (path, label) in NORMALS {
        let map = match path {
            "flat" => NormalMap::flat(),
            path => NormalMap::from_bytes(path, carried(path))?,
        };
        let file = format!("data/normals-{}.bin", stem(path));
        let row = json!({
            "id": stem(path), "label": label, "width": map.width, "height": map.height, "file": file,
        });
        rows.push(row);
        files.push((file, map.levels().into_iter().flatten().flatten().collect()));
    }
    Ok((rows, files))
}

/// The environment maps: a small, smooth picture of each for the background, and all their coefficients.
fn maps() -> Result<(Vec<Value>, Vec<Asset>), Failure> {
    let paths: Vec<&str> = zonal_scenes::below("maps").collect();
    let mut rows = Vec::new();
    let mut files = Vec::new();
    let mut lights = Vec::new();
    for path in paths {
        let map = Map::from_bytes(path, carried(path)).map_err(Fault::from)?;
        lights.extend(map.project(ORDER).coefficients.into_iter().flatten().map(|value| value as f32));
        let id = stem(path).split('_').next().unwrap_or_default();
        let (first, rest) = id.split_at(1);
        let small = blurred(&map);
        let file = format!("data/map-{id}.bin");
        rows.push(json!({
            "id": id,
            "label": first.to_uppercase() + rest,
            "width": small.width,
            "height": small.height,
            "file": file,
        }));
        files.push((file, small.texels.iter().flat_map(|texel| shared_exponent(*texel).to_le_bytes()).collect()));
    }
    files.push(("data/lights.bin".to_owned(), floats(lights)));
    Ok((rows, files))
}

/// The map at half its size under a small binomial filter.
fn blurred(map: &Map) -> Map {
    const WEIGHTS: [f64; 6] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let (width, height) = (map.width / 2, map.height / 2);
    let texel = |x: usize, y: usize| {
        let mut sum = [0.0; 3];
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            let column = (2 * x + map.width + i - 2) % map.width;
            let row = (2 * y + j).saturating_sub(2).min(map.height - 1);
            let weight = WEIGHTS[i] * WEIGHTS[j] / 1024.0;
            let texel = map.texels[row * map.width + column];
            (0..3).for_each(|k| sum[k] += weight * texel[k]);
        }
        sum
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
    Map { width, height, texels }
}

/// A colour in the format RGB9E5 of the texture units: three mantissas of nine bits and one exponent (OpenGL ES 3.0,
/// section 3.8.3).
fn shared_exponent(texel: [f64; 3]) -> u32 {
    const MOST: f64 = 65408.0;
    let texel = texel.map(|value| value.clamp(0.0, MOST));
    let most = texel.iter().copied().fold(0.0, f64::max);
    let first = if most > 0.0 { (most.log2().floor() as i32).max(-16) + 1 } else { -15 };
    let step = |exponent: i32| f64::from(exponent - 9).exp2();
    // The largest may round up to 512.
    let exponent = if (most / step(first)).round() > 511.0 { first + 1 } else { first };
    let [r, g, b] = texel.map(|value| (value / step(exponent)).round() as u32);
    r | g << 9 | b << 18 | ((exponent + 15) as u32) << 27
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_exponent_keeps_eight_bits_of_the_largest() {
        let back = |bits: u32| {
            let scale = f64::from((bits >> 27) as i32 - 15 - 9).exp2();
            [0, 9, 18].map(|shift| f64::from(bits >> shift & 511) * scale)
        };
        for texel in
            [[0.0; 3], [1.0, 0.5, 0.25], [511.9, 3.0, 0.1], [1e-6, 2e-6, 0.0], [7e4, 1.0, 0.0], [0.3, 0.9999, 0.2]]
        {
            let most = texel.iter().copied().fold(0.0, f64::max);
            for (got, want) in back(shared_exponent(texel)).into_iter().zip(texel) {
                // Half a step: of the smallest exponent, or of a largest mantissa from 255.5, rounded up, to 511.
                let tolerance = (most / 255.5 / 2.0).max(1.0 / f64::from(1 << 25));
                assert!((got - want.min(65408.0)).abs() <= tolerance, "{texel:?}: {got}");
            }
        }
    }

    #[test]
    fn errors_of_a_band_do_not_depend_on_the_order() {
        let angle = [0.3];
        for method in Method::ALL {
            let (low, high) = (method.band_errors(5, &angle), method.band_errors(ORDER, &angle));
            assert!(low[0].iter().zip(&high[0]).all(|(a, b)| (a - b).abs() < 1e-12), "{method}");
        }
    }
}
