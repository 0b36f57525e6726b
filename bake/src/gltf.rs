//! glTF 2.0, as the crate `gltf` reads it: the triangles of a scene with both sets of texture coordinates, tangents where it
//! has them, each vertex in the order of the file.
//!
//! What a file may name besides itself are buffers, in its own folder or below. Nothing else of it matters: no material, no
//! skin, no animation.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::buffer::Source;
use gltf::mesh::Mode;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use zonal_codegen::fault::Fault;
use zonal_codegen::{files, input};
use zonal_picture::mesh::{self, Mesh, Model, growth};
use zonal_picture::vector::{across, add, cross, dot, length, unit};

/// The most nodes of a scene, which a damaged file may make a circle of.
const MAX_NODES: usize = 1 << 16;

/// Whether bytes are glTF: the binary container, or a JSON object.
pub fn is_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF") || bytes.trim_ascii_start().starts_with(b"{")
}

/// What a file holds, y up, in the world.
#[derive(Default)]
struct Parts {
    positions: Vec<[f64; 3]>,
    normals: Vec<Option<[f64; 3]>>,
    tangents: Vec<Option<[f64; 4]>>,
    uvs: Vec<Option<[f64; 2]>>,
    lightmap: Vec<Option<[f64; 2]>>,
    indices: Vec<u32>,
}

/// Reads a model from the bytes of a file. `name` is what errors call it, `folder` where its buffers lie.
///
/// Normals that a file lacks are the mean of the triangles at a vertex; tangents follow the texture coordinates, or are any
/// where there are none, and [`Model::has_frames`] says so.
///
/// # Errors
///
/// If it is no glTF 2.0, is damaged, needs what is not read, holds no triangle or too many, or a number that is not finite.
pub fn read(name: &str, bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    // The reader is not proof against overflow in damaged files.
    let read = catch_unwind(AssertUnwindSafe(|| decode(name, bytes, folder)));
    read.unwrap_or_else(|_| Err(damaged(name, "the decoder gave up")))
}

fn damaged(name: &str, why: &str) -> Fault {
    Fault::new(format!("{name}: cannot be read ({why})"), "export the mesh as glTF 2.0 again")
}

/// The bytes of a buffer.
fn buffer(name: &str, source: Source<'_>, blob: Option<&[u8]>, folder: &Path) -> Result<Vec<u8>, Fault> {
    let uri = match source {
        Source::Bin => return blob.map(<[u8]>::to_vec).ok_or_else(|| damaged(name, "it has no binary part")),
        Source::Uri(uri) => uri,
    };
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, text) = data.split_once(";base64,").ok_or_else(|| damaged(name, "a buffer is not in base64"))?;
        return STANDARD.decode(text).map_err(|error| damaged(name, &format!("a buffer is no base64: {error}")));
    }
    let uri = uri.replace("%20", " ");
    if uri.contains(':') || !files::stays_inside(&uri) || !files::resolves_inside(folder, Path::new(&uri)) {
        let message = format!("{name}: names the buffer `{uri}`, which is not in its folder");
        return Err(Fault::new(message, "save the mesh with its buffer beside it, or as .glb"));
    }
    input::read(&folder.join(&uri), mesh::MAX_BYTES).map_err(|error| {
        Fault::new(format!("{name}: cannot read its buffer `{uri}`: {error}"), "put it beside the mesh")
    })
}

fn decode(name: &str, bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    let gltf = gltf::Gltf::from_slice(bytes).map_err(|error| damaged(name, &error.to_string()))?;
    let version = &gltf.as_json().asset.version;
    if !version.starts_with("2.") {
        return Err(damaged(name, &format!("it is of version {version}")));
    }
    let mut buffers = Vec::new();
    for source in gltf.buffers() {
        buffers.push(buffer(name, source.source(), gltf.blob.as_deref(), folder)?);
    }
    let mut parts = Parts::default();
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let mut open: Vec<(gltf::Node<'_>, [[f64; 4]; 4])> = match &scene {
        Some(scene) => scene.nodes().map(|node| (node, IDENTITY)).collect(),
        None => gltf.nodes().map(|node| (node, IDENTITY)).collect(),
    };
    let mut count = 0;
    while let Some((node, above)) = open.pop() {
        count += 1;
        if count > MAX_NODES {
            return Err(damaged(name, &format!("its scene has more than {MAX_NODES} nodes")));
        }
        let matrix = product(above, node.transform().matrix().map(|column| column.map(f64::from)));
        open.extend(node.children().map(|child| (child, matrix)));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            parts.add(name, &primitive, &buffers, &matrix)?;
        }
    }
    parts.model(name)
}

const IDENTITY: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The product of matrices, given and returned by columns.
fn product(a: [[f64; 4]; 4], b: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    b.map(|column| std::array::from_fn(|i| (0..4).map(|k| a[k][i] * column[k]).sum()))
}

impl Parts {
    fn add(
        &mut self,
        name: &str,
        primitive: &gltf::Primitive<'_>,
        buffers: &[Vec<u8>],
        matrix: &[[f64; 4]; 4],
    ) -> Result<(), Fault> {
        match primitive.mode() {
            Mode::Triangles => {}
            Mode::TriangleStrip | Mode::TriangleFan => {
                let message = format!("{name}: holds a strip or a fan of triangles");
                return Err(Fault::new(message, "export the mesh as plain triangles"));
            }
            _ => return Ok(()),
        }
        let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
        let short = |what: &str| damaged(name, &format!("its {what} reach beyond a buffer"));
        let first = self.positions.len() as u32;
        let positions: Vec<[f32; 3]> = reader.read_positions().ok_or_else(|| short("positions"))?.collect();
        let count = positions.len();
        let [x, y, z] = [0, 1, 2].map(|k| [matrix[k][0], matrix[k][1], matrix[k][2]]);
        let turned = |v: [f64; 3]| add(add(x.map(|c| c * v[0]), v[1], y), v[2], z);
        let mirrored = dot(x, cross(y, z)) < 0.0;
        // What normals are turned by, but for a positive factor.
        let sign = if mirrored { -1.0 } else { 1.0 };
        let [p, q, r] = [cross(y, z), cross(z, x), cross(x, y)].map(|c| c.map(|c| c * sign));
        let normal = |v: [f64; 3]| unit(add(add(p.map(|c| c * v[0]), v[1], q), v[2], r));
        self.positions.extend(
            positions.iter().map(|p| add(turned(p.map(f64::from)), 1.0, [matrix[3][0], matrix[3][1], matrix[3][2]])),
        );
        let normals: Vec<Option<[f64; 3]>> =
            reader.read_normals().into_iter().flatten().map(|n| normal(n.map(f64::from))).collect();
        let tangents: Vec<Option<[f64; 4]>> = reader
            .read_tangents()
            .into_iter()
            .flatten()
            .map(|[x, y, z, w]| {
                let [x, y, z] = unit(turned([x, y, z].map(f64::from)))?;
                (w.abs() == 1.0).then_some([x, y, z, sign * f64::from(w)])
            })
            .collect();
        // In a file the second coordinate runs down the image.
        let set = |set: u32| -> Vec<Option<[f64; 2]>> {
            let found = reader.read_tex_coords(set).into_iter().flat_map(|found| found.into_f32());
            found.map(|[u, v]| Some([f64::from(u), 1.0 - f64::from(v)])).collect()
        };
        let (uvs, lightmap) = (set(0), set(1));
        self.normals.extend(padded(normals, count).ok_or_else(|| short("normals"))?);
        self.tangents.extend(padded(tangents, count).ok_or_else(|| short("tangents"))?);
        self.uvs.extend(padded(uvs, count).ok_or_else(|| short("texture coordinates"))?);
        self.lightmap.extend(padded(lightmap, count).ok_or_else(|| short("texture coordinates"))?);
        let start = self.indices.len();
        match (primitive.indices(), reader.read_indices()) {
            (None, _) => self.indices.extend(first..first + count as u32),
            (Some(_), None) => return Err(short("indices")),
            (Some(_), Some(indices)) => {
                for i in indices.into_u32() {
                    if i as usize >= count {
                        return Err(damaged(name, &format!("an index is {i}, and there are {count} vertices")));
                    }
                    self.indices.push(first + i);
                }
            }
        }
        let whole = (self.indices.len() - start) / 3 * 3;
        self.indices.truncate(start + whole);
        if mirrored {
            self.indices[start..].as_chunks_mut::<3>().0.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        if self.indices.len() / 3 > mesh::MAX_TRIANGLES {
            let message = format!("{name}: has more than {} triangles, which is the most", mesh::MAX_TRIANGLES);
            return Err(Fault::new(message, "reduce it"));
        }
        Ok(())
    }

    fn model(self, name: &str) -> Result<Model, Fault> {
        let numbers = self.positions.iter().flatten().chain(self.uvs.iter().flatten().flatten());
        if !numbers.chain(self.lightmap.iter().flatten().flatten()).all(|x| x.is_finite()) {
            return Err(Fault::new(format!("{name}: holds a coordinate that is not finite"), "save the mesh again"));
        }
        let used = || self.indices.iter().map(|&i| self.positions[i as usize]);
        let [low, high] = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| -> [f64; 3] {
            std::array::from_fn(|k| used().map(|p| p[k]).reduce(pick).unwrap_or(0.0))
        });
        let centre: [f64; 3] = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let radius = used().map(|p| length(add(p, -1.0, centre))).fold(0.0, f64::max);
        let upright = |[x, y, z]: [f64; 3]| [x, -z, y];
        let positions: Vec<[f64; 3]> =
            self.positions.iter().map(|&p| upright(add(p, -1.0, centre)).map(|x| x / radius)).collect();
        let triangles: Vec<[usize; 3]> =
            self.indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|i| i as usize)).collect();
        let area = |c: &[usize; 3]| {
            let [p, q, r] = c.map(|i| positions[i]);
            cross(add(q, -1.0, p), add(r, -1.0, p))
        };
        if radius == 0.0 || !triangles.iter().any(|corners| length(area(corners)) > 1e-12) {
            return Err(Fault::new(format!("{name}: holds no triangle of any size"), "export the mesh with its faces"));
        }
        let mut sums = vec![[0.0; 3]; positions.len()];
        for corners in &triangles {
            corners.iter().for_each(|&i| sums[i] = add(sums[i], 1.0, area(corners)));
        }
        let given = self.normals.iter().zip(&sums);
        let normals: Vec<[f64; 3]> =
            given.map(|(n, &sum)| n.map(upright).or_else(|| unit(sum)).unwrap_or([0.0, 0.0, 1.0])).collect();
        let mut grown = vec![[0.0; 4]; positions.len()];
        for corners in &triangles {
            let uv = corners.map(|i| self.uvs[i].unwrap_or_default());
            let normal = unit(area(corners)).unwrap_or([0.0, 0.0, 1.0]);
            let ([x, y, z], sign) = growth(corners.map(|i| positions[i]), uv, normal);
            corners.iter().for_each(|&i| (0..4).for_each(|k| grown[i][k] += [x, y, z, sign][k]));
        }
        let tangent = |i: usize| {
            let [x, y, z, w] = match self.tangents[i] {
                Some([x, y, z, w]) => {
                    let [x, y, z] = upright([x, y, z]);
                    [x, y, z, w]
                }
                None => grown[i],
            };
            let [x, y, z] = across(unit([x, y, z]).unwrap_or([0.0; 3]), normals[i]);
            [x, y, z, if w < 0.0 { -1.0 } else { 1.0 }].map(|x| x as f32)
        };
        let indexed = |list: &[Option<[f64; 2]>]| triangles.iter().flatten().all(|&i| list[i].is_some());
        let framed = |i: &usize| self.tangents[*i].is_some() || self.uvs[*i].is_some();
        let pairs =
            |list: &[Option<[f64; 2]>]| list.iter().map(|uv| uv.unwrap_or_default().map(|x| x as f32)).collect();
        Ok(Model {
            has_frames: triangles.iter().flatten().all(framed),
            lightmap: if indexed(&self.lightmap) { pairs(&self.lightmap) } else { Vec::new() },
            places: self.positions.iter().map(|p| p.map(|x| x as f32)).collect(),
            mesh: Mesh {
                tangents: (0..positions.len()).map(tangent).collect(),
                positions: positions.iter().map(|p| p.map(|x| x as f32)).collect(),
                normals: normals.iter().map(|n| n.map(|x| x as f32)).collect(),
                uvs: pairs(&self.uvs),
                indices: self.indices,
            },
        })
    }
}

/// A list of so many things, or of none that a file leaves out; nothing if it has another length.
fn padded<T: Clone>(list: Vec<Option<T>>, count: usize) -> Option<Vec<Option<T>>> {
    match list.len() {
        0 => Some(vec![None; count]),
        length => (length == count).then_some(list),
    }
}
