//! What stands in the way of light: triangles, and what a ray meets of them. The tree and its traversal are of the crate
//! obvhs.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use std::time::Duration;
use zonal_picture::mesh::Mesh;
use zonal_picture::vector::{add, cross, dot};

/// Triangles in a tree.
pub struct Occluders {
    tree: CwBvh,
    /// In the order of the mesh.
    triangles: Vec<Triangle>,
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle's number in the mesh.
    pub triangle: usize,
    /// What the three corners weigh at that point; 1 together.
    pub weights: [f64; 3],
}

fn single(v: [f64; 3]) -> Vec3A {
    Vec3A::from_array(v.map(|x| x as f32))
}

impl Occluders {
    /// Returns the tree of a mesh, which has to hold a triangle.
    pub fn new(mesh: &Mesh) -> Self {
        let corner = |i: u32| Vec3A::from_array(mesh.positions[i as usize]);
        let triangle = |&[a, b, c]: &[u32; 3]| Triangle { v0: corner(a), v1: corner(b), v2: corner(c) };
        let triangles: Vec<Triangle> = mesh.indices.as_chunks().0.iter().map(triangle).collect();
        let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
        Self { tree, triangles }
    }

    fn distance(&self, ray: &Ray, place: usize) -> f32 {
        self.triangles[self.tree.primitive_indices[place] as usize].intersect(ray)
    }

    /// Returns whether nothing is met from a point in a direction.
    pub fn sees(&self, from: [f64; 3], direction: [f64; 3]) -> bool {
        let ray = Ray::new_inf(single(from), single(direction));
        self.tree.ray_traverse_miss(ray, |ray, place| self.distance(ray, place))
    }

    /// Returns what is met first from a point in a direction.
    pub fn first(&self, from: [f64; 3], direction: [f64; 3]) -> Option<Hit> {
        let (ray, mut hit) = (Ray::new_inf(single(from), single(direction)), RayHit::none());
        if !self.tree.ray_traverse(ray, &mut hit, |ray, place| self.distance(ray, place)) {
            return None;
        }
        let triangle = self.tree.primitive_indices[hit.primitive_id as usize] as usize;
        let Triangle { v0, v1, v2 } = self.triangles[triangle];
        let [a, b, c] = [v0, v1, v2].map(|v| v.to_array().map(f64::from));
        // In f64, from where the line of the ray meets the plane.
        let (e, f) = (add(b, -1.0, a), add(c, -1.0, a));
        let across = cross(direction, f);
        let scale = 1.0 / dot(e, across);
        let away = add(from, -1.0, a);
        let u = (scale * dot(away, across)).clamp(0.0, 1.0);
        let v = (scale * dot(direction, cross(away, e))).clamp(0.0, 1.0 - u);
        Some(Hit { triangle, weights: [1.0 - u - v, u, v] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;
    use zonal_picture::vector::length;

    /// Whether a ray meets a triangle, and how near it passes by an edge, as shares of the triangle's height: by volumes of
    /// tetrahedra, in f64.
    fn meets(from: [f64; 3], direction: [f64; 3], p: [[f64; 3]; 3]) -> (bool, f64) {
        let [a, b, c] = p.map(|p| add(p, -1.0, from));
        let volumes = [(b, c), (c, a), (a, b)].map(|(p, q)| dot(direction, cross(p, q)));
        let total: f64 = volumes.iter().sum();
        let shares = volumes.map(|volume| volume / total);
        let least = shares.iter().copied().fold(f64::MAX, f64::min);
        let ahead = dot(a, cross(add(b, -1.0, a), add(c, -1.0, a))) / total > 0.0;
        (least > 0.0 && ahead, least.abs())
    }

    #[test]
    fn rays_meet_what_a_plain_loop_over_all_triangles_says() {
        let path = "meshes/teapot.obj";
        let mesh = Mesh::from_obj(path, zonal_scenes::embedded(path).expect("embedded")).expect("a mesh");
        let occluders = Occluders::new(&mesh);
        let triangles: Vec<[[f64; 3]; 3]> = mesh
            .indices
            .as_chunks::<3>()
            .0
            .iter()
            .map(|corners| corners.map(|i| mesh.positions[i as usize].map(f64::from)))
            .collect();
        let mut random = Random::new(12);
        let (mut blocked, mut close) = (0, 0);
        for _ in 0..400 {
            let from = random.unit::<3>().map(|x| 0.6 * x);
            let direction = random.unit::<3>();
            let all: Vec<(bool, f64)> = triangles.iter().map(|&p| meets(from, direction, p)).collect();
            let sees = !all.iter().any(|(met, _)| *met);
            blocked += usize::from(!sees);
            // What passes by an edge within the rounding of f32 may go either way.
            if all.iter().any(|(_, margin)| *margin < 1e-4) && occluders.sees(from, direction) != sees {
                close += 1;
                continue;
            }
            assert_eq!(occluders.sees(from, direction), sees, "{from:?} {direction:?}");
            let hit = occluders.first(from, direction);
            assert_eq!(hit.is_none(), sees);
            if let Some(hit) = hit {
                let point = (0..3).fold([0.0; 3], |sum, k| add(sum, hit.weights[k], triangles[hit.triangle][k]));
                let away = add(point, -1.0, from);
                assert!(length(cross(away, direction)) < 1e-5 && dot(away, direction) > 0.0, "{hit:?}");
            }
        }
        assert!((100..390).contains(&blocked) && close < 4, "{blocked} blocked, {close} close");
    }
}
