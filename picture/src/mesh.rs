//! Triangle meshes with what a normal map needs: a normal, a tangent and texture coordinates at every vertex. A sphere, a
//! plane, and Wavefront OBJ files, whose missing normals and coordinates are made up. It knows nothing of shading.
//!
//! A mesh lies in the unit sphere around the origin, z up. Texture coordinates grow with the tangent (u) and with the
//! bitangent w · n × t (v); a step of one is one repetition of the map. A [`Model`] is a mesh whose vertices are those of its
//! file, for what is computed for them and handed back.

mod patch;

use super::vector::{across, add, cross, dot, length, unit};
pub use patch::REPEATS;
use patch::{Chart, Patch, Vertex};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::io::Cursor;
use tobj::LoadOptions;
use zonal_codegen::fault::Fault;
use zonal_codegen::math::convention::Axes;

/// Edges where faces meet at a larger angle stay sharp, where a file has no normals.
const CREASE_DEGREES: f64 = 60.0;
/// Each triangle of a file without normals is cut into the square of this, and rounded.
const PARTS: usize = 3;
/// The largest file that is read, in bytes: some 250 for each of the triangles that it may hold.
pub const MAX_BYTES: usize = 1 << 28;
/// The most triangles of a file.
pub const MAX_TRIANGLES: usize = 1 << 20;

/// How many numbers [`Mesh::interleaved`] has of a vertex.
pub const STRIDE: usize = 12;

/// Triangles, ready for a vertex buffer. See the [module](self) for its space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Where the vertices are.
    pub positions: Vec<[f32; 3]>,
    /// The unit normals, outwards.
    pub normals: Vec<[f32; 3]>,
    /// The unit tangents, across the normals, and w = ±1: the bitangent is w · n × t.
    pub tangents: Vec<[f32; 4]>,
    /// The texture coordinates.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
}

/// A mesh as its file has it: nothing is rounded off or cut, and what belongs to a vertex can be handed back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The triangles, moved and scaled into the unit sphere.
    pub mesh: Mesh,
    /// Where the vertices are in the file, in its axes and its unit of length.
    pub places: Vec<[f32; 3]>,
    /// The second set of texture coordinates, in which every point has a place of its own: v upwards, from 0 to 1. Empty if
    /// there is none.
    pub lightmap: Vec<[f32; 2]>,
    /// Whether the file says how the tangents lie, by texture coordinates or by themselves.
    pub has_frames: bool,
}

impl Mesh {
    /// The unit sphere; its tangents run east, its normal map goes three times around.
    pub fn sphere() -> Self {
        const ROWS: usize = 64;
        const COLUMNS: usize = 128;
        let mut mesh = Self::default();
        let vertex = |row: f64, column: f64| {
            let (sin, cos) = (PI * row / ROWS as f64).sin_cos();
            let (y, x) = (2.0 * PI * column / COLUMNS as f64).sin_cos();
            let normal = [sin * x, sin * y, cos];
            let repeats = (2.0 * PI * REPEATS).round();
            Vertex {
                position: normal,
                normal,
                tangent: [-y, x, 0.0, 1.0],
                uv: [repeats * column / COLUMNS as f64, repeats / 2.0 * (1.0 - row / ROWS as f64)],
                lightmap: [0.0; 2],
            }
        };
        // A triangle at a pole has a pole of its own, whose tangent is that of the middle of its far edge.
        let mut numbers = HashMap::new();
        for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row as f64, column as f64))) {
            let [a, b] = [vertex(row, column), vertex(row, column + 1.0)];
            let [c, d] = [vertex(row + 1.0, column), vertex(row + 1.0, column + 1.0)];
            if row > 0.0 {
                let c = if row + 1.0 < ROWS as f64 { c } else { vertex(ROWS as f64, column + 0.5) };
                [a, c, b].into_iter().for_each(|vertex| mesh.push(vertex, &mut numbers));
            }
            if row + 1.0 < ROWS as f64 {
                let b = if row > 0.0 { b } else { vertex(0.0, column + 0.5) };
                [b, c, d].into_iter().for_each(|vertex| mesh.push(vertex, &mut numbers));
            }
        }
        mesh
    }

    /// A square in the plane z = 0 whose corners lie on the unit sphere; one repetition of the normal map.
    pub fn plane() -> Self {
        let half = 0.5f64.sqrt();
        let mut mesh = Self::default();
        let mut numbers = HashMap::new();
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let position = [(2.0 * u - 1.0) * half, (2.0 * v - 1.0) * half, 0.0];
            let (normal, tangent) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]);
            mesh.push(Vertex { position, normal, tangent, uv: [u, v], lightmap: [0.0; 2] }, &mut numbers);
        }
        mesh
    }

    /// A mesh from the text of a Wavefront OBJ file, y up, moved and scaled into the unit sphere. `name` is what errors
    /// call it.
    ///
    /// Without normals in the file the surface is smooth but for its creases, and rounded. Without texture coordinates
    /// each triangle takes those of the face of a cube that it looks to most.
    ///
    /// # Errors
    ///
    /// If it is no OBJ file, holds no triangle or too many, or a number that is not finite.
    pub fn from_obj(name: &str, text: &[u8]) -> Result<Self, Fault> {
        Self::in_axes(name, text, None)
    }

    /// Returns [`Mesh::from_obj`] for a file whose coordinates are in other axes than y up, right-handed: those of a
    /// program, in which they are zonal's x, y and z. Of left-handed ones the faces still look outwards.
    ///
    /// # Errors
    ///
    /// As [`Mesh::from_obj`].
    pub fn in_axes(name: &str, text: &[u8], axes: Option<Axes>) -> Result<Self, Fault> {
        let mut faces = Faces::read(name, text, axes)?;
        faces.normalise(name)?;
        Ok(faces.mesh(PARTS).0)
    }

    /// Every vertex as [`STRIDE`] numbers: position, normal, tangent, texture coordinates.
    pub fn interleaved(&self) -> Vec<f32> {
        let vertex = |i: usize| {
            [&self.positions[i][..], &self.normals[i], &self.tangents[i], &self.uvs[i]].into_iter().flatten().copied()
        };
        (0..self.positions.len()).flat_map(vertex).collect()
    }

    /// The number of a vertex, which is the same for vertices that are equal once rounded.
    fn push(&mut self, vertex: Vertex, numbers: &mut HashMap<[u32; KEY], u32>) {
        let [x, y, z, w] = vertex.tangent;
        let [x, y, z] = across([x, y, z], vertex.normal);
        let (position, normal) = (vertex.position.map(|x| x as f32), vertex.normal.map(|x| x as f32));
        let (tangent, uv) = ([x, y, z, w].map(|x| x as f32), vertex.uv.map(|x| x as f32));
        let all = [&position[..], &normal, &tangent, &uv, &vertex.lightmap.map(|x| x as f32)].concat();
        let key: [u32; KEY] = std::array::from_fn(|i| (all[i] + 0.0).to_bits());
        let next = self.positions.len() as u32;
        let number = *numbers.entry(key).or_insert(next);
        if number == next {
            self.positions.push(position);
            self.normals.push(normal);
            self.tangents.push(tangent);
            self.uvs.push(uv);
        }
        self.indices.push(number);
    }
}

/// How many numbers tell vertices apart.
const KEY: usize = 14;

impl Model {
    /// A mesh from the text of a Wavefront OBJ file, y up, each of its vertices as it is. `name` is what errors call it.
    /// Normals and texture coordinates that the file lacks are those of [`Mesh::from_obj`].
    ///
    /// `lightmap` is the text of a second file, with what errors call it, that holds the same triangles in the same order:
    /// its texture coordinates are the second set.
    ///
    /// # Errors
    ///
    /// As [`Mesh::from_obj`], or if the second file has other triangles or no texture coordinates.
    pub fn from_obj(name: &str, text: &[u8], lightmap: Option<(&str, &[u8])>) -> Result<Self, Fault> {
        let mut faces = Faces::read(name, text, None)?;
        if let Some((other, text)) = lightmap {
            faces.add_lightmap(name, other, &Faces::read(other, text, None)?)?;
        }
        let has_frames = faces.corners.iter().flatten().all(|corner| corner.uv.is_some());
        let given = faces.positions.clone();
        faces.normalise(name)?;
        let (mesh, corners) = faces.mesh(1);
        let mut places = vec![[0.0; 3]; mesh.positions.len()];
        let mut charts = vec![[0.0; 2]; mesh.positions.len()];
        for (corner, &number) in corners.iter().flat_map(|&face| &faces.corners[face]).zip(&mesh.indices) {
            // The inverse of `upright`.
            let [x, y, z] = given[corner.position];
            places[number as usize] = [x, z, -y].map(|x| x as f32);
            charts[number as usize] = corner.lightmap.map(|x| x as f32);
        }
        let lightmap = if lightmap.is_some() { charts } else { Vec::new() };
        Ok(Self { mesh, places, lightmap, has_frames })
    }
}

/// Returns the direction in which the first texture coordinate grows over a triangle, across its normal, and 1 if the second
/// grows to the left of it, −1 if to the right, 0 if the triangle has no area in the texture.
pub fn growth(p: [[f64; 3]; 3], uv: [[f64; 2]; 3], normal: [f64; 3]) -> ([f64; 3], f64) {
    let [e, f] = [1, 2].map(|i| (add(p[i], -1.0, p[0]), [uv[i][0] - uv[0][0], uv[i][1] - uv[0][1]]));
    let turn = e.1[0] * f.1[1] - f.1[0] * e.1[1];
    let sign = if turn == 0.0 { 0.0 } else { turn.signum() };
    let grow = add(e.0.map(|x| x * f.1[1]), -e.1[1], f.0).map(|x| x * turn.signum());
    (across(unit(grow).unwrap_or([0.0; 3]), normal), sign)
}

/// A corner of a triangle in a file.
#[derive(Clone, Copy, Debug)]
struct Corner {
    position: usize,
    normal: Option<[f64; 3]>,
    uv: Option<[f64; 2]>,
    lightmap: [f64; 2],
}

/// What a file holds: positions, each once, and triangles.
#[derive(Debug, Default)]
struct Faces {
    /// The axes of the file, if they are not y up, right-handed.
    axes: Option<Axes>,
    positions: Vec<[f64; 3]>,
    numbers: HashMap<[u32; 3], usize>,
    corners: Vec<[Corner; 3]>,
}

/// y up becomes z up.
fn upright([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, -z, y]
}

impl Faces {
    fn read(name: &str, text: &[u8], axes: Option<Axes>) -> Result<Self, Fault> {
        let fault = |message: String, help: &str| Err(Fault::new(format!("{name}: {message}"), help));
        let options = LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
        let none = |_: &std::path::Path| Ok(Default::default());
        let models = match tobj::load_obj_buf(&mut Cursor::new(text), &options, none) {
            Ok((models, _)) => models,
            Err(error) => return fault(format!("is no Wavefront OBJ file ({error})"), "save the mesh as .obj again"),
        };
        let mut faces = Self { axes, ..Self::default() };
        for model in &models {
            faces.add(&model.mesh);
        }
        if faces.corners.len() > MAX_TRIANGLES {
            let message = format!("has {} triangles, and {MAX_TRIANGLES} is the most", faces.corners.len());
            return fault(message, "reduce it");
        }
        let uvs = faces.corners.iter().flatten().flat_map(|corner| corner.uv.unwrap_or_default());
        if faces.positions.iter().flatten().copied().chain(uvs).any(|x| !x.is_finite()) {
            return fault("holds a coordinate that is not finite".to_owned(), "save the mesh again");
        }
        Ok(faces)
    }

    /// Takes the texture coordinates of other faces as the second set of these.
    fn add_lightmap(&mut self, name: &str, other: &str, faces: &Self) -> Result<(), Fault> {
        let fault = |message: String, help: &str| Err(Fault::new(format!("{other}: {message}"), help));
        let help = "save the same mesh twice, once with each set of texture coordinates";
        if faces.corners.len() != self.corners.len() {
            let (found, wanted) = (faces.corners.len(), self.corners.len());
            return fault(format!("has {found} triangles, and {name} has {wanted}"), help);
        }
        for (own, lightmap) in self.corners.iter_mut().flatten().zip(faces.corners.iter().flatten()) {
            match lightmap.uv {
                Some(uv) => own.lightmap = uv,
                None => return fault("has faces without texture coordinates (`vt`)".to_owned(), help),
            }
            if self.positions[own.position] != faces.positions[lightmap.position] {
                return fault(format!("has its corners elsewhere or in another order than {name}"), help);
            }
        }
        Ok(())
    }

    /// Adds an object of a file; positions that are written twice become one.
    fn add(&mut self, mesh: &tobj::Mesh) {
        let axes = self.axes;
        let vector = |list: &[f32], i: u32| -> [f64; 3] {
            let found = std::array::from_fn(|k| f64::from(list[3 * i as usize + k]));
            axes.map_or(upright(found), |axes| axes.to_zonal(found))
        };
        let complete = |indices: &[u32]| indices.len() == mesh.indices.len();
        let (normals, uvs) = (complete(&mesh.normal_indices), complete(&mesh.texcoord_indices));
        let corners: Vec<Corner> = (0..mesh.indices.len())
            .map(|i| {
                let position = vector(&mesh.positions, mesh.indices[i]);
                let key = position.map(|x| (x as f32 + 0.0).to_bits());
                let next = self.positions.len();
                let number = *self.numbers.entry(key).or_insert(next);
                if number == next {
                    self.positions.push(position);
                }
                let uv = |i: u32| std::array::from_fn(|k| f64::from(mesh.texcoords[2 * i as usize + k]));
                Corner {
                    position: number,
                    normal: normals.then(|| unit(vector(&mesh.normals, mesh.normal_indices[i]))).flatten(),
                    uv: uvs.then(|| uv(mesh.texcoord_indices[i])),
                    lightmap: [0.0; 2],
                }
            })
            .collect();
        let start = self.corners.len();
        self.corners.extend(corners.as_chunks().0);
        if axes.is_some_and(Axes::is_left_handed) {
            self.corners[start..].iter_mut().for_each(|face| face.swap(1, 2));
        }
    }

    fn positions_of(&self, face: &[Corner; 3]) -> [[f64; 3]; 3] {
        face.map(|corner| self.positions[corner.position])
    }

    /// The normal of a triangle at the length of twice its area.
    fn area(&self, face: &[Corner; 3]) -> [f64; 3] {
        let [a, b, c] = self.positions_of(face);
        cross(add(b, -1.0, a), add(c, -1.0, a))
    }

    /// Moves and scales everything into the unit sphere, drops triangles without an area, turns the others outwards if
    /// no normal says where that is. Fails if none is left.
    fn normalise(&mut self, name: &str) -> Result<(), Fault> {
        let nothing =
            || Err(Fault::new(format!("{name}: holds no triangle of any size"), "export the mesh with its faces"));
        let used: Vec<[f64; 3]> = self.corners.iter().flat_map(|face| self.positions_of(face)).collect();
        let bound = |pick: fn(f64, f64) -> f64| -> [f64; 3] {
            std::array::from_fn(|i| used.iter().map(|p| p[i]).reduce(pick).unwrap_or(0.0))
        };
        let (low, high) = (bound(f64::min), bound(f64::max));
        let centre: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
        let radius = used.iter().map(|&p| length(add(p, -1.0, centre))).fold(0.0, f64::max);
        if radius == 0.0 {
            return nothing();
        }
        self.positions.iter_mut().for_each(|p| *p = add(*p, -1.0, centre).map(|x| x / radius));
        let areas: Vec<[f64; 3]> = self.corners.iter().map(|face| self.area(face)).collect();
        let mut areas = areas.into_iter();
        self.corners.retain(|_| areas.next().is_some_and(|area| length(area) > 1e-12));
        let volume: f64 = self.corners.iter().map(|face| dot(self.area(face), self.positions[face[0].position])).sum();
        if volume < 0.0 && self.corners.iter().flatten().all(|corner| corner.normal.is_none()) {
            self.corners.iter_mut().for_each(|face| face.swap(1, 2));
        }
        if self.corners.is_empty() { nothing() } else { Ok(()) }
    }

    /// The mesh with each triangle that has no normals cut into the square of so many, and of each triangle the face that it
    /// is of.
    fn mesh(&self, parts: usize) -> (Mesh, Vec<usize>) {
        // What each position's triangles add to its normal: their own normal, weighted by their angle there.
        let mut around: Vec<Vec<([f64; 3], f64)>> = vec![vec![]; self.positions.len()];
        let normals: Vec<[f64; 3]> =
            self.corners.iter().map(|face| unit(self.area(face)).unwrap_or([0.0, 0.0, 1.0])).collect();
        for (face, &normal) in self.corners.iter().zip(&normals) {
            let p = self.positions_of(face);
            for i in 0..3 {
                let side = |j: usize| unit(add(p[(i + j) % 3], -1.0, p[i])).unwrap_or([0.0; 3]);
                around[face[i].position].push((normal, dot(side(1), side(2)).clamp(-1.0, 1.0).acos()));
            }
        }
        let limit = CREASE_DEGREES.to_radians().cos();
        let average = |position: usize, of: [f64; 3], limit: f64| {
            let near = around[position].iter().filter(|(normal, _)| dot(*normal, of) >= limit);
            unit(near.fold([0.0; 3], |sum, &(normal, angle)| add(sum, angle, normal))).unwrap_or(of)
        };
        let tangents = self.tangents(&normals);
        let mut mesh = Mesh::default();
        let mut numbers = HashMap::new();
        let mut faces = Vec::new();
        for (i, ((face, &normal), sums)) in self.corners.iter().zip(&normals).zip(&tangents).enumerate() {
            let patch = Patch {
                corners: self.positions_of(face),
                // Where surfaces meet at a crease they are rounded alike, so that no gap opens.
                round: face.map(|corner| average(corner.position, normal, -1.0)),
                normals: face.map(|corner| corner.normal.unwrap_or_else(|| average(corner.position, normal, limit))),
                chart: Chart::of(normal),
                given: face[0].uv.is_some().then(|| std::array::from_fn(|i| (face[i].uv.unwrap_or_default(), sums[i]))),
                lightmap: face.map(|corner| corner.lightmap),
                parts: if face[0].normal.is_some() { 1 } else { parts },
            };
            patch.cut(|vertex| mesh.push(vertex, &mut numbers));
            faces.resize(mesh.indices.len() / 3, i);
        }
        (mesh, faces)
    }

    /// The tangents of corners with texture coordinates: the direction in which u grows, summed over the triangles that
    /// share position, coordinates, normal and the side to which v grows, and that side.
    fn tangents(&self, normals: &[[f64; 3]]) -> Vec<[[f64; 4]; 3]> {
        let key = |corner: &Corner, sign: f64| {
            let normal = corner.normal.map(|normal| normal.map(f64::to_bits));
            (corner.position, corner.uv.map(|uv| uv.map(f64::to_bits)), normal, sign < 0.0)
        };
        let grown: Vec<([f64; 3], f64)> = self
            .corners
            .iter()
            .zip(normals)
            .map(|(face, &normal)| growth(self.positions_of(face), face.map(|c| c.uv.unwrap_or_default()), normal))
            .collect();
        let mut sums: HashMap<_, [f64; 4]> = HashMap::new();
        for (face, &(across, sign)) in self.corners.iter().zip(&grown) {
            for corner in face {
                let sum = sums.entry(key(corner, sign)).or_default();
                (0..3).for_each(|i| sum[i] += across[i]);
                sum[3] += sign;
            }
        }
        let found = |corner: &Corner, sign: f64| sums.get(&key(corner, sign)).copied().unwrap_or([1.0, 0.0, 0.0, 1.0]);
        self.corners.iter().zip(&grown).map(|(face, &(_, sign))| face.each_ref().map(|c| found(c, sign))).collect()
    }
}

#[cfg(test)]
mod tests;
