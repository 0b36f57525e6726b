//! The rooms: a Cornell box with a lamp, what stands in it, and what a ray brings of its light. Light bounces once: a surface
//! that a ray meets sends out what it gets of the lamp, and what is glossy shows that. The lamp's own light on what is glossy
//! is not part of what is cached.

use crate::gloss::Gloss;
use crate::place::Place;
use std::f64::consts::{FRAC_1_PI, PI};
use zonal_bake::occluders::Occluders;
use zonal_bake::point::Point;
use zonal_codegen::fault::Fault;
use zonal_picture::mesh::Mesh;
use zonal_picture::vector::{add, cross, dot, length, unit};

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Sends out the same in all directions, of R, G and B these shares.
    Matte([f64; 3]),
    /// Sends out most about the mirrored direction.
    Glossy(Gloss),
    /// The lamp.
    Lamp,
}

const WHITE: Material = Material::Matte([0.75, 0.75, 0.75]);
const RED: Material = Material::Matte([0.7, 0.1, 0.08]);
const GREEN: Material = Material::Matte([0.12, 0.5, 0.14]);
const BLUE: Material = Material::Matte([0.15, 0.25, 0.7]);

/// The lamp's radiance.
const POWER: [f64; 3] = [18.0, 16.0, 12.0];
/// Half of the lamp's side.
const LAMP: f64 = 0.35;
/// The lamp's height; the box goes from −1 to 1.
const CEILING: f64 = 0.99;
/// How glossy the sphere and the bunny are.
pub const OBJECTS: Gloss = Gloss { colour: [0.9, 0.85, 0.75], exponent: 12.0 };
/// How glossy the back wall is (Gautron et al. 2004, figure 9).
pub const WALL: Gloss = Gloss { colour: [0.9, 0.9, 0.9], exponent: 22.0 };

/// Triangles in a tree, with what they are made of.
pub struct Scene {
    mesh: Mesh,
    materials: Vec<Material>,
    occluders: Occluders,
}

/// What a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Where, in the frame of the surface.
    pub place: Place,
    /// What it is made of.
    pub material: Material,
    /// How far away.
    pub distance: f64,
    /// The unit normal of the triangle, towards where the ray comes from.
    pub face: [f64; 3],
}

/// Triangles before they are in a tree.
#[derive(Default)]
struct Parts {
    mesh: Mesh,
    materials: Vec<Material>,
}

fn narrow(v: [f64; 3]) -> [f32; 3] {
    v.map(|x| x as f32)
}

impl Parts {
    /// Adds a parallelogram, which looks to where e × f points.
    fn quad(&mut self, corner: [f64; 3], e: [f64; 3], f: [f64; 3], material: Material) {
        let normal = unit(cross(e, f)).unwrap_or([0.0, 0.0, 1.0]);
        let first = self.mesh.positions.len() as u32;
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            self.mesh.positions.push(narrow(add(add(corner, u, e), v, f)));
            self.mesh.normals.push(narrow(normal));
            self.mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
            self.mesh.uvs.push([0.0; 2]);
        }
        self.mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
        self.materials.extend([material; 2]);
    }

    /// Adds a mesh, scaled and moved so that it stands on the floor at (x, y).
    fn stand(&mut self, mesh: &Mesh, [x, y]: [f64; 2], scale: f64, material: Material) {
        let lowest = mesh.positions.iter().map(|p| p[2]).fold(f32::MAX, f32::min);
        let at = [x, y, -1.0 - scale * f64::from(lowest)];
        let first = self.mesh.positions.len() as u32;
        self.mesh.positions.extend(mesh.positions.iter().map(|p| narrow(add(at, scale, p.map(f64::from)))));
        self.mesh.normals.extend(&mesh.normals);
        self.mesh.tangents.extend(&mesh.tangents);
        self.mesh.uvs.extend(&mesh.uvs);
        self.mesh.indices.extend(mesh.indices.iter().map(|i| first + i));
        self.materials.extend(vec![material; mesh.indices.len() / 3]);
    }

    /// Adds a block on the floor, turned about z by an angle in radians.
    fn block(&mut self, [x, y]: [f64; 2], half: f64, height: f64, turn: f64, material: Material) {
        let (sin, cos) = turn.sin_cos();
        let (e, f, up) = ([cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, height]);
        let corner = |a: f64, b: f64| add(add([x, y, -1.0], a * half, e), b * half, f);
        let long = |v: [f64; 3], s: f64| v.map(|x| x * s * 2.0 * half);
        self.quad(add(corner(-1.0, -1.0), 1.0, up), long(e, 1.0), long(f, 1.0), material);
        self.quad(corner(-1.0, -1.0), long(e, 1.0), up, material);
        self.quad(corner(1.0, -1.0), long(f, 1.0), up, material);
        self.quad(corner(1.0, 1.0), long(e, -1.0), up, material);
        self.quad(corner(-1.0, 1.0), long(f, -1.0), up, material);
    }

    /// The box, open in front, with its lamp; `back` is its back wall.
    fn room(back: Material) -> Self {
        let mut parts = Self::default();
        let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]);
        parts.quad([-1.0; 3], x, y, WHITE);
        parts.quad([-1.0, -1.0, 1.0], y, x, WHITE);
        parts.quad([-1.0, 1.0, -1.0], x, z, back);
        parts.quad([-1.0; 3], y, z, RED);
        parts.quad([1.0, -1.0, -1.0], z, y, GREEN);
        let side = 2.0 * LAMP;
        parts.quad([-LAMP, -LAMP, CEILING], [0.0, side, 0.0], [side, 0.0, 0.0], Material::Lamp);
        parts
    }

    fn scene(self) -> Scene {
        let occluders = Occluders::new(&self.mesh);
        Scene { mesh: self.mesh, materials: self.materials, occluders }
    }
}

impl Scene {
    /// Returns the box of Gautron et al. (2004, figure 9): matte blocks before a glossy back wall.
    pub fn wall() -> Self {
        let mut parts = Parts::room(Material::Glossy(WALL));
        parts.block([-0.38, 0.3], 0.29, 1.15, 0.35, WHITE);
        parts.block([0.42, -0.25], 0.27, 0.55, -0.3, BLUE);
        parts.scene()
    }

    /// Returns the box with a glossy sphere and a glossy bunny.
    ///
    /// # Errors
    ///
    /// If the bunny that this program carries cannot be read.
    pub fn objects() -> Result<Self, Fault> {
        let path = "meshes/bunny.obj";
        let missing = || Fault::new(format!("`{path}` is not in this program"), "compile it again");
        let bunny = Mesh::from_obj(path, zonal_scenes::embedded(path).ok_or_else(missing)?)?;
        let mut parts = Parts::room(WHITE);
        parts.stand(&Mesh::sphere(), [-0.45, 0.15], 0.48, Material::Glossy(OBJECTS));
        parts.stand(&bunny, [0.42, -0.1], 0.62, Material::Glossy(OBJECTS));
        Ok(parts.scene())
    }

    /// Returns what a ray meets first.
    pub fn look(&self, from: [f64; 3], direction: [f64; 3]) -> Option<Seen> {
        let hit = self.occluders.first(from, direction)?;
        let place = Place::new(Point::inside(&self.mesh, hit.triangle, hit.weights));
        let face = place.point.face;
        let face = if dot(face, direction) > 0.0 { face.map(|x| -x) } else { face };
        let distance = length(add(place.point.position, -1.0, from));
        Some(Seen { place, material: self.materials[hit.triangle], distance, face })
    }

    /// Returns the irradiance for a direction of the lamp, and that direction: of a place of the lamp that two numbers from 0
    /// to 1 name, times the lamp's area.
    fn lamp(&self, place: &Place, [u, v]: [f64; 2]) -> Option<([f64; 3], [f64; 3])> {
        let at = [LAMP * (2.0 * u - 1.0), LAMP * (2.0 * v - 1.0), CEILING];
        let from = place.point.origin();
        let away = add(at, -1.0, from);
        let direction = unit(away)?;
        let cosine = dot(direction, place.normal());
        if cosine <= 0.0 || direction[2] <= 0.0 || dot(direction, place.point.face) <= 0.0 {
            return None;
        }
        let hit = self.occluders.first(from, direction)?;
        let strength = 4.0 * LAMP * LAMP * direction[2] * cosine / dot(away, away);
        (self.materials[hit.triangle] == Material::Lamp).then(|| (POWER.map(|p| p * strength), direction))
    }

    /// Returns the radiance that a surface sends out towards a unit direction of what it gets of the lamp, at a place of the
    /// lamp that two numbers from 0 to 1 name. Of the lamp itself it is none.
    pub fn sent(&self, seen: &Seen, towards: [f64; 3], at: [f64; 2]) -> [f64; 3] {
        let Some((light, direction)) = self.lamp(&seen.place, at) else { return [0.0; 3] };
        let share = match seen.material {
            Material::Matte(colour) => colour.map(|c| c * FRAC_1_PI),
            Material::Glossy(gloss) => gloss.value(seen.place.normal(), towards, direction),
            Material::Lamp => [0.0; 3],
        };
        std::array::from_fn(|k| share[k] * light[k])
    }

    /// Returns what the camera sees of what the lamp itself lights: the mean over a grid of `side` by `side` places of the
    /// lamp; of the lamp its radiance.
    pub fn direct(&self, seen: &Seen, towards: [f64; 3], side: usize) -> [f64; 3] {
        if seen.material == Material::Lamp {
            return POWER;
        }
        let mut sum = [0.0; 3];
        for i in 0..side * side {
            let at = [i % side, i / side].map(|k| (k as f64 + 0.5) / side as f64);
            sum = add(sum, 1.0 / (side * side) as f64, self.sent(seen, towards, at));
        }
        sum
    }
}

/// Returns the direction in a frame that two numbers from 0 to 1 name, spread evenly over the hemisphere of 2π.
pub fn over_hemisphere([u, v]: [f64; 2]) -> [f64; 3] {
    let radius = (1.0 - u * u).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * v).sin_cos();
    [radius * cos, radius * sin, u]
}

/// Returns four numbers from 0 to 1: those of a number in a scrambled sequence of Sobol's, of which every seed has its own.
pub fn sobol(number: usize, seed: u32) -> [f64; 4] {
    [0, 1, 2, 3].map(|dimension| f64::from(sobol_burley::sample(number as u32 & 0xffff, dimension, seed)))
}
