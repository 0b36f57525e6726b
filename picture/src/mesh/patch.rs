//! A triangle of a file on its way to vertices: cut and rounded where the file has no normals, with texture coordinates by the
//! face of a cube where it has none.

use crate::vector::{across, add, cross, dot, unit};

/// How many repetitions of a normal map lie on a unit length, where a file has no texture coordinates.
pub const REPEATS: f64 = 0.5;
/// How much of the way to the curved surface is gone (Boubekeur and Alexa 2008 recommend three quarters).
const ROUNDING: f64 = 0.75;

/// A vertex before it gets a number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) position: [f64; 3],
    pub(super) normal: [f64; 3],
    pub(super) tangent: [f64; 4],
    pub(super) uv: [f64; 2],
    pub(super) lightmap: [f64; 2],
}

/// The face of a cube: how texture coordinates lie on a surface that looks in its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chart {
    u: [f64; 3],
    v: [f64; 3],
}

impl Chart {
    /// The chart of the axis that a normal is closest to. Around the sides v is up, so that the tangents agree there.
    pub(super) fn of(normal: [f64; 3]) -> Self {
        let size = normal.map(f64::abs);
        let sign = |i: usize| normal[i].signum();
        if size[2] > size[0] && size[2] > size[1] {
            Self { u: [sign(2), 0.0, 0.0], v: [0.0, 1.0, 0.0] }
        } else if size[0] > size[1] {
            Self { u: [0.0, sign(0), 0.0], v: [0.0, 0.0, 1.0] }
        } else {
            Self { u: [-sign(1), 0.0, 0.0], v: [0.0, 0.0, 1.0] }
        }
    }
}

/// A triangle that is to be cut.
pub(super) struct Patch {
    pub(super) corners: [[f64; 3]; 3],
    /// The normals of the curved surface.
    pub(super) round: [[f64; 3]; 3],
    /// The normals to shade with.
    pub(super) normals: [[f64; 3]; 3],
    pub(super) chart: Chart,
    /// Texture coordinates and tangents, if the file has them.
    pub(super) given: Option<[([f64; 2], [f64; 4]); 3]>,
    pub(super) lightmap: [[f64; 2]; 3],
    pub(super) parts: usize,
}

impl Patch {
    /// Hands out the vertices of the parts, three a triangle.
    pub(super) fn cut(&self, mut push: impl FnMut(Vertex)) {
        let n = self.parts;
        for i in 0..n {
            for j in 0..n - i {
                [[i, j], [i + 1, j], [i, j + 1]].into_iter().for_each(|at| push(self.vertex(at)));
                if i + j + 1 < n {
                    [[i + 1, j], [i + 1, j + 1], [i, j + 1]].into_iter().for_each(|at| push(self.vertex(at)));
                }
            }
        }
    }

    /// The vertex so many parts along the first two sides, on the surface of Phong tessellation (Boubekeur and Alexa
    /// 2008): the flat point, drawn towards its projections on the tangent planes of the corners.
    fn vertex(&self, [i, j]: [usize; 2]) -> Vertex {
        let n = self.parts as f64;
        let weights = [(self.parts - i - j) as f64 / n, i as f64 / n, j as f64 / n];
        let mix = |of: [[f64; 3]; 3]| (0..3).fold([0.0; 3], |sum, k| add(sum, weights[k], of[k]));
        let flat = mix(self.corners);
        let projected = [0, 1, 2].map(|k| {
            let height = dot(add(flat, -1.0, self.corners[k]), self.round[k]);
            add(flat, -height, self.round[k])
        });
        let position = add(flat.map(|x| x * (1.0 - ROUNDING)), ROUNDING, mix(projected));
        let normal = unit(mix(self.normals)).unwrap_or(self.normals[0]);
        let (uv, tangent) = match &self.given {
            Some(given) => {
                let blend = |of: fn(&([f64; 2], [f64; 4])) -> f64| (0..3).map(|k| weights[k] * of(&given[k])).sum();
                let uv = [blend(|g| g.0[0]), blend(|g| g.0[1])];
                let handed = if blend(|g| g.1[3]) < 0.0 { -1.0 } else { 1.0 };
                let [x, y, z] = [blend(|g| g.1[0]), blend(|g| g.1[1]), blend(|g| g.1[2])];
                (uv, [x, y, z, handed])
            }
            None => {
                let along = |axis: [f64; 3]| REPEATS * dot(axis, position);
                // Along the tangent v does not change.
                let [x, y, z] = cross(self.chart.v, normal);
                ([along(self.chart.u), along(self.chart.v)], [x, y, z, 1.0])
            }
        };
        let [x, y, z] = across(unit([tangent[0], tangent[1], tangent[2]]).unwrap_or([0.0; 3]), normal);
        let lightmap = [0, 1].map(|i| (0..3).map(|k| weights[k] * self.lightmap[k][i]).sum());
        Vertex { position, normal, tangent: [x, y, z, tangent[3]], uv, lightmap }
    }
}
