//! The room: a floor, two walls, one with a window, and boxes where a seed puts them, all of rectangles with a lightmap; and a
//! teapot, whose vertices are baked. It knows nothing of bases.

use rayon::prelude::*;
use zonal_bake::basis::Basis;
use zonal_bake::chart::{Chart, filtered};
use zonal_bake::gather::Baker;
use zonal_bake::occluders::{Hit, Occluders};
use zonal_bake::point::Point;
use zonal_bake::quads::{Lie, Quad, model};
use zonal_bake::sky::Sky;
use zonal_codegen::environment::Map;
use zonal_codegen::fault::Fault;
use zonal_codegen::promise::samples::Random;
use zonal_picture::mesh::{self, Mesh, Model};

/// How many texels the lightmap has along a side.
pub const SIZE: usize = 128;
/// How many rays a texel and a vertex casts.
pub const RAYS: usize = 2048;
/// How many repetitions of the normal map lie on a unit length.
pub const REPEATS: f64 = 0.25;
/// How large the teapot is, as the radius of the sphere around it.
const TEAPOT: f64 = 0.3;
/// Where the floor is.
const FLOOR: f64 = -0.35;
/// How far the floor reaches to all sides.
const REACH: f64 = 0.62;
/// How high the walls are.
const HEIGHT: f64 = 0.8;

/// The triangles of the room with what tells its lightmap.
pub struct Room {
    /// The room's, then the teapot's.
    mesh: Mesh,
    /// The second set of texture coordinates, of the room's vertices alone.
    lightmap: Vec<[f32; 2]>,
    /// What stands in the way of light.
    pub occluders: Occluders,
    chart: Chart,
}

fn quads(seed: u64) -> Vec<Quad> {
    let quad = |corner, along, up| Quad { corner, along, up, is_mirrored: false };
    let wall = |from: f64, to: f64, low: f64, high: f64| {
        quad([from, REACH, FLOOR + low], [to - from, 0.0, 0.0], [0.0, 0.0, high - low])
    };
    let (window, sill, lintel) = (0.22, 0.25, 0.6);
    let mut all = vec![
        quad([-REACH, -REACH, FLOOR], [2.0 * REACH, 0.0, 0.0], [0.0, 2.0 * REACH, 0.0]),
        quad([-REACH, -REACH, FLOOR], [0.0, 2.0 * REACH, 0.0], [0.0, 0.0, HEIGHT]),
        wall(-REACH, -window, 0.0, HEIGHT),
        wall(window, REACH, 0.0, HEIGHT),
        wall(-window, window, 0.0, sill),
        wall(-window, window, lintel, HEIGHT),
    ];
    let mut random = Random::new(seed);
    let mut between = |low: f64, high: f64| low + 0.5 * (random.signed() + 1.0) * (high - low);
    for x in [-0.5, 0.25] {
        let corner = [x + between(0.0, 0.1), between(0.2, 0.35), FLOOR];
        let size = [between(0.12, 0.22), between(0.12, 0.22), between(0.15, 0.5)];
        // Not the side that it stands on.
        all.extend(Quad::sides(corner, size, false).into_iter().skip(1));
    }
    // The normal map is mirrored on some, as artists do where it repeats.
    all.iter_mut().skip(1).step_by(3).for_each(|quad| quad.is_mirrored = true);
    all
}

impl Room {
    /// Builds the room of a seed around a mesh that lies in the unit sphere.
    ///
    /// # Errors
    ///
    /// If the lightmap has no room for its islands.
    pub fn new(seed: u64, object: &Mesh) -> Result<Self, Fault> {
        let lie = |i: usize| Lie { quarters: i % 4, is_mirrored: i % 2 == 1 };
        let small = || Fault::new("the lightmap has no room for the islands", "make it larger");
        let room = model(&quads(seed), REPEATS, SIZE, lie).ok_or_else(small)?;
        let chart = Chart::new("the room", &room, SIZE)?;
        let Model { mut mesh, lightmap, .. } = room;
        let (vertices, middle) = (mesh.positions.len() as u32, [0.02, -0.2]);
        let low = object.positions.iter().map(|p| f64::from(p[2])).fold(f64::MAX, f64::min);
        let placed = |p: &[f32; 3]| {
            let [x, y, z] = p.map(f64::from);
            [middle[0] + TEAPOT * x, middle[1] + TEAPOT * y, FLOOR + 1e-3 + TEAPOT * (z - low)].map(|x| x as f32)
        };
        mesh.positions.extend(object.positions.iter().map(placed));
        mesh.normals.extend(&object.normals);
        mesh.tangents.extend(&object.tangents);
        let repeats = (REPEATS * TEAPOT / mesh::REPEATS) as f32;
        mesh.uvs.extend(object.uvs.iter().map(|uv| uv.map(|x| x * repeats)));
        mesh.indices.extend(object.indices.iter().map(|i| vertices + i));
        Ok(Self { occluders: Occluders::new(&mesh), mesh, lightmap, chart })
    }
}

/// The light of a map in the room: radiance in five bands, from which every basis is made.
pub struct Baked {
    /// Texels, with those outside of the islands.
    texels: Vec<Vec<[f64; 3]>>,
    /// Vertices of the teapot.
    vertices: Vec<Vec<[f64; 3]>>,
}

/// A point of the room with what is known there.
#[derive(Clone, Debug)]
pub struct Place {
    /// The point and its frame.
    pub point: Point,
    /// Where it is in the normal map, in repetitions.
    pub uv: [f64; 2],
    /// What is baked there.
    pub baked: Vec<[f64; 3]>,
}

impl Room {
    /// Bakes the light of a map.
    ///
    /// # Errors
    ///
    /// If the map has no light.
    pub fn bake(&self, map: &Map) -> Result<Baked, Fault> {
        let basis: Basis = "sh5".parse()?;
        let sky = Sky::new(map.clone()).ok_or_else(|| Fault::new("the map is black", "take another"))?;
        let baker =
            Baker { sky: &sky, occluders: &self.occluders, basis: &basis, rays: RAYS, seed: 11, over_pi: false };
        let texels: Vec<Point> = self.chart.points.iter().flatten().copied().collect();
        let teapot = Point::vertices(&self.mesh).split_off(self.lightmap.len());
        Ok(Baked { texels: self.chart.filled(&baker.all(&texels, || {})), vertices: baker.all(&teapot, || {}) })
    }

    /// Returns what is seen from a point in a direction.
    pub fn seen(&self, baked: &Baked, from: [f64; 3], direction: [f64; 3]) -> Option<Place> {
        let Hit { triangle, weights } = self.occluders.first(from, direction)?;
        let corners: [usize; 3] = std::array::from_fn(|k| self.mesh.indices[3 * triangle + k] as usize);
        let mixed = |of: &dyn Fn(usize) -> [f64; 2]| -> [f64; 2] {
            std::array::from_fn(|i| (0..3).map(|k| weights[k] * of(corners[k])[i]).sum())
        };
        let found = match corners[0] < self.lightmap.len() {
            true => filtered(SIZE, &baked.texels, mixed(&|i| self.lightmap[i].map(f64::from))),
            false => {
                let of = |k: usize| &baked.vertices[corners[k] - self.lightmap.len()];
                let mix = |i: usize| {
                    std::array::from_fn(|channel| (0..3).map(|k| weights[k] * of(k)[i][channel]).sum::<f64>())
                };
                (0..of(0).len()).map(mix).collect()
            }
        };
        let uv = mixed(&|i| self.mesh.uvs[i].map(f64::from));
        Some(Place { point: Point::inside(&self.mesh, triangle, weights), uv, baked: found })
    }

    /// Returns what is seen of many pixels, row by row, if anything: those whose surface looks to the camera.
    pub fn places(&self, baked: &Baked, eye: [f64; 3], directions: &[[f64; 3]]) -> Vec<Option<Place>> {
        let faces = |place: &Place, direction: &[f64; 3]| place.point.local(*direction)[2] < 0.0;
        let one = |direction: &[f64; 3]| self.seen(baked, eye, *direction).filter(|place| faces(place, direction));
        directions.par_iter().map(one).collect()
    }
}
