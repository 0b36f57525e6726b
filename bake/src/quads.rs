//! Scenes of rectangles, each an island of the lightmap: rooms and boxes, for pictures and for tests.

use zonal_picture::mesh::{Mesh, Model};
use zonal_picture::vector::{add, cross, length, unit};

/// The room between two islands and around each, in texels, for what filters across an edge.
const GUTTER: f64 = 2.0;

/// A rectangle in the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quad {
    /// One of its corners.
    pub corner: [f64; 3],
    /// From there along its first side, which is where the normal map's first coordinate runs.
    pub along: [f64; 3],
    /// Along its second side. It is seen from where that is to the left of the first.
    pub up: [f64; 3],
    /// Whether the normal map is mirrored on it: its first coordinate runs the other way.
    pub is_mirrored: bool,
}

/// How an island lies in the lightmap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lie {
    /// Turned by so many quarters.
    pub quarters: usize,
    /// Mirrored before that.
    pub is_mirrored: bool,
}

impl Quad {
    /// Returns the six sides of a box that are seen from outside, or from inside.
    pub fn sides([a, b, c]: [f64; 3], [x, y, z]: [f64; 3], is_room: bool) -> [Self; 6] {
        let (along_x, along_y, along_z) = ([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]);
        let quad = |corner, first, second| {
            let (along, up) = if is_room { (second, first) } else { (first, second) };
            Self { corner, along, up, is_mirrored: false }
        };
        [
            quad([a, b, c], along_y, along_x),
            quad([a, b, c + z], along_x, along_y),
            quad([a, b, c], along_x, along_z),
            quad([a, b + y, c], along_z, along_x),
            quad([a, b, c], along_z, along_y),
            quad([a + x, b, c], along_y, along_z),
        ]
    }

    /// How wide and high its island is at so many texels a unit length, as it lies.
    fn extent(&self, texels: f64, lie: Lie) -> [f64; 2] {
        let [wide, high] = [self.along, self.up].map(|side| (texels * length(side)).ceil().max(2.0));
        if lie.quarters.is_multiple_of(2) { [wide, high] } else { [high, wide] }
    }
}

/// Returns the corners at the upper left of the islands, in texels, in rows of a lightmap of so many texels along a side; none
/// if it is too small.
fn packed(extents: &[[f64; 2]], size: f64) -> Option<Vec<[f64; 2]>> {
    let mut order: Vec<usize> = (0..extents.len()).collect();
    order.sort_by(|&a, &b| extents[b][1].total_cmp(&extents[a][1]).then(a.cmp(&b)));
    let (mut places, mut x, mut y, mut row) = (vec![[0.0; 2]; extents.len()], GUTTER, GUTTER, 0.0f64);
    for i in order {
        let [wide, high] = extents[i];
        if x + wide + GUTTER > size {
            (x, y, row) = (GUTTER, y + row + GUTTER, 0.0);
        }
        if x + wide + GUTTER > size || y + high + GUTTER > size {
            return None;
        }
        places[i] = [x, y];
        x += wide + GUTTER;
        row = row.max(high);
    }
    Some(places)
}

/// Returns rectangles with so many repetitions of the normal map on a unit length, and islands as large as a lightmap of so
/// many texels along a side has room for, each lying as it is told; none if it has room for none.
pub fn model(quads: &[Quad], repeats: f64, size: usize, lie: impl Fn(usize) -> Lie) -> Option<Model> {
    let side = size as f64;
    let laid = (0..400).find_map(|step| {
        let texels = side * 0.98f64.powi(step);
        let extents: Vec<[f64; 2]> = quads.iter().enumerate().map(|(i, quad)| quad.extent(texels, lie(i))).collect();
        Some((packed(&extents, side)?, extents))
    });
    let (places, extents) = laid?;
    let (mut mesh, mut lightmap) = (Mesh::default(), Vec::new());
    for (i, quad) in quads.iter().enumerate() {
        let Some(normal) = unit(cross(quad.along, quad.up)) else { continue };
        let first = mesh.positions.len() as u32;
        for [s, t] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let position = add(add(quad.corner, s, quad.along), t, quad.up);
            let [mut u, mut v] = [s, t];
            if lie(i).is_mirrored {
                u = 1.0 - u;
            }
            for _ in 0..lie(i).quarters {
                [u, v] = [v, 1.0 - u];
            }
            let place = [places[i][0] + u * extents[i][0], side - places[i][1] - (1.0 - v) * extents[i][1]];
            let sign = if quad.is_mirrored { -1.0 } else { 1.0 };
            let [x, y, z] = unit(quad.along).unwrap_or_default().map(|x| x * sign);
            let uv = [sign * s * length(quad.along), t * length(quad.up)].map(|x| x * repeats);
            mesh.positions.push(position.map(|x| x as f32));
            mesh.normals.push(normal.map(|x| x as f32));
            mesh.tangents.push([x, y, z, sign].map(|x| x as f32));
            mesh.uvs.push(uv.map(|x| x as f32));
            lightmap.push(place.map(|x| (x / side) as f32));
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
    let places = mesh.positions.iter().map(|&[x, y, z]| [x, z, -y]).collect();
    Some(Model { mesh, places, lightmap, has_frames: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Chart;
    use zonal_picture::vector::dot;

    #[test]
    fn a_box_looks_outwards_and_a_room_inwards() {
        for is_room in [false, true] {
            for quad in Quad::sides([-0.2, -0.3, -0.4], [0.4, 0.6, 0.8], is_room) {
                let middle = add(add(quad.corner, 0.5, quad.along), 0.5, quad.up);
                assert_eq!(dot(cross(quad.along, quad.up), middle) < 0.0, is_room, "{quad:?}");
            }
        }
    }

    #[test]
    fn islands_do_not_touch_and_each_lies_as_it_is_told() {
        let quads = Quad::sides([-0.3; 3], [0.6, 0.3, 0.5], false);
        for quarters in 0..4 {
            let model = model(&quads, 2.0, 64, |i| Lie { quarters, is_mirrored: i % 2 == 1 }).expect("room");
            let chart = Chart::new("a", &model, 64).expect("a chart");
            assert_eq!(chart.overlaps, 0);
            let covered = chart.points.iter().flatten().count();
            assert!(covered > 64 * 64 / 3, "{covered}");
            // Each island's texels are of one side, and none is next to another's.
            for (i, point) in chart.points.iter().enumerate() {
                let Some(point) = point else { continue };
                for near in chart.around(i).filter_map(|i| chart.points[i]) {
                    assert!(dot(near.axes[2], point.axes[2]) > 0.99);
                }
            }
        }
        assert!(model(&quads, 2.0, 8, |_| Lie::default()).is_none(), "six islands of two texels with gutters");
    }
}
