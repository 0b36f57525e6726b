//! The mesh that a person names, whichever format it is in, and what is odd about it. It knows nothing of light.

use crate::gltf;
use std::collections::HashMap;
use std::path::Path;
use zonal_codegen::fault::Fault;
use zonal_codegen::input;
use zonal_picture::mesh::{MAX_BYTES, Model};

fn bytes(path: &Path) -> Result<Vec<u8>, Fault> {
    input::read(path, MAX_BYTES).map_err(|error| {
        Fault::new(format!("cannot read `{}`: {error}", path.display()), "name a mesh, .obj, .gltf or .glb")
    })
}

/// Reads a mesh, Wavefront OBJ or glTF 2.0 by its content, with a second OBJ file for the lightmap's texture coordinates
/// where one is named.
///
/// # Errors
///
/// If a file cannot be read or is at fault, or a second one is named for a glTF file, which holds its own.
pub fn read(path: &Path, lightmap: Option<&Path>) -> Result<Model, Fault> {
    let (name, text) = (path.display().to_string(), bytes(path)?);
    if !gltf::is_gltf(&text) {
        let other = lightmap.map(|path| bytes(path).map(|text| (path.display().to_string(), text))).transpose()?;
        return Model::from_obj(&name, &text, other.as_ref().map(|(name, text)| (name.as_str(), &text[..])));
    }
    if lightmap.is_some() {
        let message = format!("{name}: holds its second set of texture coordinates itself, as TEXCOORD_1");
        return Err(Fault::new(message, "leave out `--lightmap-uv`, which is for OBJ files"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    gltf::read(&name, &text, folder)
}

/// Returns how many edges, told by where their ends are, belong to three triangles or more.
pub fn crowded_edges(model: &Model) -> usize {
    let place = |i: u32| model.places[i as usize].map(|x| (x + 0.0).to_bits());
    let mut edges: HashMap<[[u32; 3]; 2], u32> = HashMap::new();
    for corners in model.mesh.indices.as_chunks::<3>().0 {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let mut ends = [place(corners[i]), place(corners[j])];
            ends.sort_unstable();
            *edges.entry(ends).or_default() += 1;
        }
    }
    edges.values().filter(|&&count| count > 2).count()
}
