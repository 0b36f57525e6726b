//! What pixels of an object show: by brute force over lights that nothing hides, and by harmonics of the reflectance, of the
//! light and of what is seen of the sky, which is baked into the vertices.

use crate::lightmap::seen::directions;
use crate::turn::{facing, quaternion};
use crate::visibility::multiplier::{Grid, Multiplier};
use rayon::prelude::*;
use zonal_bake::basis::Basis;
use zonal_bake::gather::Baker;
use zonal_bake::occluders::{Hit, Occluders};
use zonal_bake::point::Point;
use zonal_bake::sky::Sky;
use zonal_codegen::environment::Projection;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::reflectance::brdf::{Brdf, Table};
use zonal_codegen::scene::picture::Camera;
use zonal_picture::camera::View;
use zonal_picture::lights::{Light, Lights};
use zonal_picture::mesh::Mesh;
use zonal_picture::vector::{add, dot};

/// An object that stands in its own light.
pub struct Object {
    /// Its triangles.
    pub mesh: Mesh,
    /// What rays meet.
    pub occluders: Occluders,
}

/// A point of the object that is looked at.
#[derive(Clone, Debug)]
pub struct Place {
    /// The point.
    pub point: Point,
    /// The axes of the frame that the view lies in the plane of x and z of.
    pub axes: [[f64; 3]; 3],
    /// The rotation of the world to that frame.
    pub q: [f64; 4],
    /// The direction to the eye in that frame.
    pub view: [f64; 3],
    /// The corners of the triangle, and what each weighs.
    pub corners: [(usize, f64); 3],
}

impl Object {
    /// Returns the object of a mesh.
    pub fn new(mesh: Mesh) -> Self {
        Self { occluders: Occluders::new(&mesh), mesh }
    }

    /// Returns the visibility of the vertices in the axes of the object, as `zonal bake --basis visibilityN` does; nothing of
    /// those that no place lies beside.
    ///
    /// # Errors
    ///
    /// If nothing is baked of that order.
    pub fn visibility(
        &self,
        places: &[Option<Place>],
        order: usize,
        rays: usize,
        seed: u64,
    ) -> Result<Vec<Vec<f64>>, Fault> {
        let mut is_needed = vec![false; self.mesh.positions.len()];
        places.iter().flatten().flat_map(|place| place.corners).for_each(|(at, _)| is_needed[at] = true);
        let (sky, basis) = (Sky::even(), format!("visibility{order}").parse::<Basis>()?);
        let baker = Baker { sky: &sky, occluders: &self.occluders, basis: &basis, rays, seed, over_pi: false };
        let one = |(at, point): (usize, &Point)| match is_needed[at] {
            true => baker.at(point, at as u64).into_iter().map(|[v, ..]| v).collect(),
            false => vec![],
        };
        Ok(Point::vertices(&self.mesh).par_iter().enumerate().map(one).collect())
    }

    /// Returns what pixels of a picture show, row by row from the top, where the surface looks to the camera.
    pub fn places(&self, camera: &Camera, size: [usize; 2]) -> Vec<Option<Place>> {
        let eye = camera.eye();
        let place = |direction: &[f64; 3]| {
            let Hit { triangle, weights } = self.occluders.first(eye, *direction)?;
            let point = Point::inside(&self.mesh, triangle, weights);
            let (view, normal) = (direction.map(|x| -x), point.axes[2]);
            if dot(view, normal) <= 0.0 {
                return None;
            }
            let axes = facing(view, normal);
            let corner = |k: usize| (self.mesh.indices[3 * triangle + k] as usize, weights[k]);
            let (q, view) = (quaternion(axes), axes.map(|axis| dot(axis, view)));
            Some(Place { point, axes, q, view, corners: [0, 1, 2].map(corner) })
        };
        directions(camera, size).par_iter().map(place).collect()
    }
}

impl Place {
    /// Returns what is reflected of lights by brute force: of all, and of those that nothing hides.
    pub fn by_rays(&self, object: &Object, brdf: &Brdf, lights: &[Light]) -> [[f64; 3]; 2] {
        let origin = self.point.origin();
        let mut sums = [[0.0; 3]; 2];
        for light in lights {
            let value = brdf.value(self.view, self.axes.map(|axis| dot(axis, light.direction)));
            if value > 0.0 {
                sums[0] = add(sums[0], value, light.power);
                if object.occluders.sees(origin, light.direction) {
                    sums[1] = add(sums[1], value, light.power);
                }
            }
        }
        sums
    }

    /// Returns the visibility of the point itself, in the axes of the object, by directions that are spread evenly.
    pub fn visibility(&self, object: &Object, order: usize, count: usize) -> Vec<f64> {
        let origin = self.point.origin();
        let (mut sums, mut values) = (vec![0.0; order * order], vec![0.0; order * order]);
        for Light { direction, power: [share, ..] } in Sky::even().rays(count, 1) {
            if dot(direction, self.axes[2]) > 0.0 && object.occluders.sees(origin, direction) {
                basis(order, direction, &mut values);
                sums.iter_mut().zip(&values).for_each(|(sum, y)| *sum += share * y);
            }
        }
        sums
    }

    /// Returns how much of its hemisphere a place sees, from 0 to 1.
    pub fn openness(&self, object: &Object) -> f64 {
        // Band 0 of the visibility over that of the whole hemisphere.
        self.visibility(object, 1, 512)[0] / std::f64::consts::PI.sqrt()
    }

    /// Returns coefficients of the frame in the axes of the object, of any order, by a rule that is exact: the harmonics of the
    /// rule's directions lie beside it.
    fn in_object(&self, c: &[f64], grid: &Grid, harmonics: &[Vec<f64>]) -> Vec<f64> {
        let order = c.len().isqrt();
        let (mut sums, mut values) = (vec![0.0; c.len()], vec![0.0; c.len()]);
        for ((direction, weight), y) in grid.directions.iter().zip(&grid.weights).zip(harmonics) {
            basis(order, self.axes.map(|axis| dot(axis, *direction)), &mut values);
            let value = weight * values.iter().zip(c).map(|(y, c)| y * c).sum::<f64>();
            sums.iter_mut().zip(y).for_each(|(sum, y)| *sum += value * y);
        }
        sums
    }
}

/// A kernel of an order by the name of its family.
fn kernel(name: &str, order: usize) -> Result<Program<f64>, Fault> {
    let spec: Spec = format!("{name}:{order}").parse().map_err(|error| Fault::new(format!("{error}"), ""))?;
    Ok(Program::new(&Listing::new(&spec.kernel())))
}

/// The most bands that a kernel is built for: those of order 16 take ten seconds.
pub const KERNELS: usize = 10;

/// What shades at an order.
pub struct Shader {
    order: usize,
    table: Table,
    way: Way,
}

/// How a reflectance meets the light.
enum Way {
    /// By the kernel `shade`.
    Kernel(Box<Program<f64>>),
    /// In the axes of the object, where an exact rule of quadrature brings it, and the harmonics of the rule's directions.
    Rule(Grid, Vec<Vec<f64>>),
}

impl Shader {
    /// Returns what shades a reflectance at an order.
    ///
    /// # Errors
    ///
    /// If there is no such kernel.
    pub fn new(brdf: &Brdf, order: usize) -> Result<Self, Fault> {
        let way = if order <= KERNELS {
            Way::Kernel(Box::new(kernel("shade", order)?))
        } else {
            let grid = Grid::of_degree(2 * (order - 1));
            let harmonics = grid.harmonics(order);
            Way::Rule(grid, harmonics)
        };
        Ok(Self { order, table: Table::new(brdf, order), way })
    }

    /// Returns what a place reflects of lights in the world, or of light times visibility.
    pub fn shade<const N: usize>(&self, place: &Place, lights: [&[[f64; 3]]; N]) -> [[f64; 3]; N] {
        // An isotropic reflectance is looked up at azimuth 0, where the view is.
        let (c, lights) = (self.table.at(place.view), lights.map(|e| &e[..self.order * self.order]));
        match &self.way {
            Way::Kernel(kernel) => lights.map(|e| {
                [0, 1, 2].map(|k| {
                    let one: Vec<f64> = e.iter().map(|e| e[k]).collect();
                    kernel.run(&[&place.q, &one, &c], Contraction::Separate)[0]
                })
            }),
            Way::Rule(grid, harmonics) => {
                let c = place.in_object(&c, grid, harmonics);
                lights.map(|e| sum(&c, e))
            }
        }
    }
}

fn sum(c: &[f64], e: &[[f64; 3]]) -> [f64; 3] {
    c.iter().zip(e).fold([0.0; 3], |sum, (&c, &e)| add(sum, c, e))
}

/// What is mixed of the corners of a triangle.
pub fn mixed(place: &Place, of: &[Vec<[f64; 3]>]) -> Vec<[f64; 3]> {
    let count = of[place.corners[0].0].len();
    (0..count).map(|i| place.corners.iter().fold([0.0; 3], |sum, &(at, weight)| add(sum, weight, of[at][i]))).collect()
}

/// How far shading at an order is from brute force with visibility, relative to its root mean square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// The order.
    pub order: usize,
    /// Without visibility.
    pub without: f64,
    /// With that of each place.
    pub with: f64,
}

/// Returns how shading converges, order by order, at places of an object under all texels of a map: no table, no triangle that
/// is interpolated over.
pub fn convergence(
    object: &Object,
    places: &[Place],
    brdf: &Brdf,
    lights: &Lights,
    light: &Projection,
    orders: std::ops::RangeInclusive<usize>,
    rays: usize,
) -> Vec<Convergence> {
    let most = *orders.end();
    let multiplier = Multiplier::new(light, most);
    let grid = Grid::of_degree(2 * (most - 1));
    let harmonics = grid.harmonics(most);
    /// Of a place the truth, and of each order what is found without and with visibility.
    type Found = ([f64; 3], Vec<[[f64; 3]; 2]>);
    let found: Vec<Found> = places
        .par_iter()
        .map(|place| {
            let [_, truth] = place.by_rays(object, brdf, &lights.0);
            let v = place.visibility(object, most, rays);
            let c = place.in_object(&brdf.coefficients(place.view, most), &grid, &harmonics);
            let of_order = |order: usize| {
                let (c, v) = (&c[..order * order], &v[..order * order]);
                [sum(c, &light.coefficients[..order * order]), sum(c, &multiplier.product(v))]
            };
            (truth, orders.clone().map(of_order).collect())
        })
        .collect();
    let square = |v: [f64; 3]| dot(v, v);
    let size: f64 = found.iter().map(|(truth, _)| square(*truth)).sum();
    let rms = |at: usize, which: usize| {
        let error = |(truth, of): &Found| square(add(of[at][which], -1.0, *truth));
        (found.iter().map(error).sum::<f64>() / size).sqrt()
    };
    orders.enumerate().map(|(at, order)| Convergence { order, without: rms(at, 0), with: rms(at, 1) }).collect()
}
