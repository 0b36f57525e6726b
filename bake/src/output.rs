//! What is written: layers of an OpenEXR image, or the vertices of a mesh as PLY, each with a small TOML file beside it that
//! says what the numbers are. It computes nothing.

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text, WritableImage,
};
use serde::Serialize;
use std::io::Cursor;
use zonal_codegen::fault::Fault;
use zonal_codegen::files::MARK;
use zonal_picture::mesh::Model;

/// What the numbers of a file are.
#[derive(Clone, Debug, Serialize)]
pub struct About {
    /// The basis, as the command takes it.
    pub basis: String,
    /// The bands of radiance that were gathered for it.
    pub order: usize,
    /// How many coefficients a point has.
    pub coefficients: usize,
    /// How many numbers each of them has: R, G and B, or one.
    pub channels: usize,
    /// `radiance`, `irradiance` or `visibility`.
    pub of: &'static str,
    /// Whether irradiance is divided by π.
    pub over_pi: bool,
    /// The order, the signs and the factors of the coefficients.
    pub convention: &'static str,
    /// The frame that the coefficients are in: `tangent`, or `object`.
    pub space: &'static str,
    /// Of `object` where its axes lie in the mesh's file: those that its places are brought to before they are baked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<&'static str>,
    /// What the numbers are to be multiplied by.
    pub scale: f64,
    /// What each layer, or each group of properties of a vertex, is called, in their order.
    pub layers: Vec<String>,
    /// The mesh.
    pub mesh: String,
    /// The map, if one was taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<String>,
    /// How many rays a point cast.
    pub rays: usize,
    /// Which ones.
    pub seed: u64,
}

impl About {
    /// The text.
    ///
    /// # Errors
    ///
    /// If it cannot be written as TOML.
    pub fn toml(&self) -> Result<String, Fault> {
        let text = toml::to_string(self).map_err(|error| Fault::new(error.to_string(), ""))?;
        Ok(format!("# {MARK} bake: what the numbers are of the file beside this one.\n{text}"))
    }
}

/// Where the axes of an object lie in its file, whose y axis points up.
pub const AXES: &str = "x,-z,y";

/// What the numbers of a coefficient are called after its name: nothing of one alone.
fn suffixes(channels: usize, names: [&'static str; 3]) -> Vec<&'static str> {
    if channels == 1 { vec![""] } else { names.to_vec() }
}

/// Returns the names of so many coefficients.
pub fn layers(count: usize) -> Vec<String> {
    (0..count).map(|i| format!("c{i}")).collect()
}

/// Returns the bytes of a square OpenEXR image of f32, with a layer of R, G and B a coefficient, or of the first number alone
/// under the layer's name where there is one channel, and `covered`, 1 where the centre of the texel lies on the surface.
///
/// # Errors
///
/// If it cannot be encoded.
pub fn exr(size: usize, values: &[Vec<[f64; 3]>], channels: usize, covered: &[bool]) -> Result<Vec<u8>, Fault> {
    let count = values.first().map_or(0, Vec::len);
    let mut all: Vec<AnyChannel<FlatSamples>> = Vec::new();
    for (i, layer) in layers(count).iter().enumerate() {
        for (k, name) in suffixes(channels, [".R", ".G", ".B"]).into_iter().enumerate() {
            let samples = values.iter().map(|value| value[i][k] as f32).collect();
            all.push(AnyChannel::new(Text::new_or_panic(format!("{layer}{name}")), FlatSamples::F32(samples)));
        }
    }
    let covered = covered.iter().map(|&covered| f32::from(u8::from(covered))).collect();
    all.push(AnyChannel::new("covered", FlatSamples::F32(covered)));
    let comments = Some(Text::new_or_panic(format!("{MARK} bake")));
    let about = LayerAttributes { comments, ..LayerAttributes::default() };
    let layer = Layer::new((size, size), about, Encoding::SMALL_LOSSLESS, AnyChannels::sort(all.into()));
    let mut bytes = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.map_err(|error| Fault::new(format!("the image cannot be encoded: {error}"), ""))?;
    Ok(bytes.into_inner())
}

/// Returns the bytes of a binary PLY file: each vertex with its place, its frame, both in the axes of the mesh's file, and
/// three numbers a coefficient, or the first alone where there is one channel; then the triangles.
pub fn ply(model: &Model, values: &[Vec<[f64; 3]>], channels: usize) -> Vec<u8> {
    let (mesh, count) = (&model.mesh, values.first().map_or(0, Vec::len));
    let mut head = format!("ply\nformat binary_little_endian 1.0\ncomment {MARK} bake\n");
    head += &format!("element vertex {}\n", values.len());
    let frame = ["x", "y", "z", "nx", "ny", "nz", "tx", "ty", "tz", "tw"].map(str::to_owned);
    let coefficients = layers(count);
    let suffixes = suffixes(channels, ["_r", "_g", "_b"]);
    let coefficients = coefficients.iter().flat_map(|layer| suffixes.iter().map(move |k| format!("{layer}{k}")));
    for name in frame.into_iter().chain(coefficients) {
        head += &format!("property float {name}\n");
    }
    head += &format!("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", mesh.indices.len() / 3);
    let mut bytes = head.into_bytes();
    // Back to y up.
    let back = |[x, y, z]: [f32; 3]| [x, z, -y];
    for (i, value) in values.iter().enumerate() {
        let [x, y, z, w] = mesh.tangents[i];
        let frame = [model.places[i], back(mesh.normals[i]), back([x, y, z])];
        let numbers = frame.into_iter().flatten().chain([w]);
        for number in numbers.chain(value.iter().flat_map(|c| &c[..channels]).map(|&c| c as f32)) {
            bytes.extend(number.to_le_bytes());
        }
    }
    for corners in mesh.indices.as_chunks::<3>().0 {
        bytes.push(3);
        corners.iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    }
    bytes
}
