//! What is known of the pixels of a picture, whoever found it: their radiance, and how the surface lies at them.

use zonal_picture::vector::{add, cross, dot, unit};

/// Linear radiance, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The width and the height.
    pub size: [usize; 2],
    /// R, G and B where the object is; negative where a lobe rings.
    pub pixels: Vec<Option<[f64; 3]>>,
    /// The median time of drawing it, in milliseconds, waiting included; 0 if it was not timed.
    pub milliseconds: f64,
}

/// How a surface lies at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The rotation from the surface's frame to the world, a unit quaternion (x, y, z, w).
    pub frame: [f64; 4],
    /// The normal map's unit normal in that frame.
    pub normal: [f64; 3],
    /// The unit direction to the eye in that frame.
    pub view: [f64; 3],
}

/// A vector turned by a unit quaternion.
fn turned([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let axis = [x, y, z];
    let half = cross(axis, v).map(|c| 2.0 * c);
    add(add(v, w, half), 1.0, cross(axis, half))
}

impl Surface {
    /// The frame of the normal map's normal, which the shortest rotation takes there from the surface's: its axes in the
    /// world, and the view in it. A view from behind the normal counts as grazing.
    pub fn modulated(&self) -> ([[f64; 3]; 3], [f64; 3]) {
        let n = self.normal;
        let tilt = unit4([-n[1], n[0], 0.0, 1.0 + n[2]]);
        let local = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turned(tilt, axis));
        let [x, y, z] = local.map(|axis| dot(axis, self.view));
        let view = unit([x, y, z.max(0.0)]).unwrap_or([1.0, 0.0, 0.0]);
        let frame = unit4(self.frame);
        (local.map(|axis| turned(frame, axis)), view)
    }
}

fn unit4(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;

    fn surface(random: &mut Random) -> Surface {
        let [x, y, z] = random.unit::<3>();
        let view = random.unit::<3>();
        Surface { frame: random.unit(), normal: [x, y, z.abs()], view: [view[0], view[1], view[2].abs()] }
    }

    #[test]
    fn the_frame_of_the_normal_is_the_shortest_turn_away() {
        let mut random = Random::new(3);
        for _ in 0..100 {
            let surface = surface(&mut random);
            let ([x, y, z], view) = surface.modulated();
            let own = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turned(surface.frame, axis));
            let world = |v: [f64; 3]| add(add(own[0].map(|c| c * v[0]), v[1], own[1]), v[2], own[2]);
            for (a, b) in [(z, world(surface.normal)), (cross(x, y), z)] {
                assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-12), "{a:?} {b:?}");
            }
            // The shortest turn has the smallest angle: its trace is 1 + 2 cos, with the cosine that of the normals.
            let trace = dot(x, own[0]) + dot(y, own[1]) + dot(z, own[2]);
            assert!((trace - 1.0 - 2.0 * surface.normal[2]).abs() < 1e-12);
            assert!((dot(view, view) - 1.0).abs() < 1e-12 && view[2] >= 0.0);
        }
    }
}
