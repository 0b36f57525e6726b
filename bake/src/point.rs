//! Where light is gathered: a point of a surface with the frame in which it is stored. It knows neither light nor
//! lightmaps.

use zonal_picture::mesh::Mesh;
use zonal_picture::vector::{across, add, cross, dot, unit};

/// How far above the surface rays start, in radii of the mesh, so that they do not meet the triangle that they leave. It
/// stands for some hundred times the rounding of f32.
pub const LIFT: f64 = 1e-4;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Where it is, in the mesh's unit sphere.
    pub position: [f64; 3],
    /// The tangent, the bitangent and the normal: unit vectors across each other. Of a mirrored frame they are left-handed.
    pub axes: [[f64; 3]; 3],
    /// The normal of the triangle, on the side of the frame's normal; the frame's, at a vertex.
    pub face: [f64; 3],
}

fn wide<const N: usize>(v: [f32; N]) -> [f64; N] {
    v.map(f64::from)
}

impl Point {
    fn new(position: [f64; 3], normal: [f64; 3], tangent: [f64; 4], face: [f64; 3]) -> Self {
        let normal = unit(normal).or(unit(face)).unwrap_or([0.0, 0.0, 1.0]);
        let [x, y, z, w] = tangent;
        let tangent = across(unit([x, y, z]).unwrap_or([0.0; 3]), normal);
        let handed = if w < 0.0 { -1.0 } else { 1.0 };
        let face = unit(face).unwrap_or(normal);
        let face = if dot(face, normal) < 0.0 { face.map(|x| -x) } else { face };
        Self { position, axes: [tangent, cross(normal, tangent).map(|x| x * handed), normal], face }
    }

    /// Returns the vertices of a mesh.
    pub fn vertices(mesh: &Mesh) -> Vec<Self> {
        let vertex = |i: usize| {
            let normal = wide(mesh.normals[i]);
            Self::new(wide(mesh.positions[i]), normal, wide(mesh.tangents[i]), normal)
        };
        (0..mesh.positions.len()).map(vertex).collect()
    }

    /// Returns the point of a triangle of a mesh at which its corners have these weights: the normal and the tangent are
    /// interpolated, then brought to length one, the tangent across the normal.
    pub fn inside(mesh: &Mesh, triangle: usize, weights: [f64; 3]) -> Self {
        let corners: [usize; 3] = std::array::from_fn(|k| mesh.indices[3 * triangle + k] as usize);
        let [a, b, c] = corners.map(|i| wide(mesh.positions[i]));
        let mixed =
            |of: &dyn Fn(usize) -> [f64; 3]| (0..3).fold([0.0; 3], |sum, k| add(sum, weights[k], of(corners[k])));
        let handed: f64 = (0..3).map(|k| weights[k] * f64::from(mesh.tangents[corners[k]][3])).sum();
        let [x, y, z] = mixed(&|i| {
            let [x, y, z, _] = wide(mesh.tangents[i]);
            [x, y, z]
        });
        Self::new(
            mixed(&|i| wide(mesh.positions[i])),
            mixed(&|i| wide(mesh.normals[i])),
            [x, y, z, handed],
            cross(add(b, -1.0, a), add(c, -1.0, a)),
        )
    }

    /// Returns from where rays leave: [`LIFT`] above the face.
    pub fn origin(&self) -> [f64; 3] {
        add(self.position, LIFT, self.face)
    }

    /// Returns a direction of the world in the frame.
    pub fn local(&self, direction: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, direction))
    }

    /// Returns a vector of the frame in the world.
    pub fn world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [tangent, bitangent, normal] = self.axes;
        add(add(tangent.map(|t| t * x), y, bitangent), z, normal)
    }
}
