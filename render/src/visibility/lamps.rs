//! Spheres of light beside an object (Soler et al. 2015, figure 10): each is a light by its direction and its size as they are
//! seen from the place that is shaded, added to what a map gives.

use crate::reference::Lights;
use crate::visibility::seen::{Object, Place, Shader};
use rayon::prelude::*;
use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::SphereLight;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::vector::add;

/// A small warm one and a large cold one, as far from the object's middle as twice its radius.
pub const SPHERES: [SphereLight; 2] = [
    SphereLight { position: [1.2, -1.3, 0.5], radius: 0.25, radiance: [14.0, 8.0, 3.0] },
    SphereLight { position: [0.5, 1.3, 1.2], radius: 0.7, radiance: [0.5, 0.9, 2.0] },
];

/// Returns spheres as they lie around a point.
pub fn around(spheres: &[SphereLight], point: [f64; 3]) -> Vec<SphereLight> {
    let moved = |sphere: &SphereLight| SphereLight { position: add(sphere.position, -1.0, point), ..*sphere };
    spheres.iter().map(moved).collect()
}

/// What adds spheres to coefficients.
pub struct Adder {
    kernel: Program<f64>,
    /// The operations of one sphere in R, G and B.
    pub operations: usize,
    /// Its roots and reciprocals.
    pub special: usize,
}

impl Adder {
    /// Returns what adds them at an order.
    ///
    /// # Errors
    ///
    /// If there is no such kernel.
    pub fn new(order: usize) -> Result<Self, Fault> {
        let spec: Spec = format!("light_sphere:{order}").parse().map_err(|error| Fault::new(format!("{error}"), ""))?;
        let listing = Listing::new(&spec.kernel());
        let cost = listing.cost(3);
        Ok(Self { kernel: Program::new(&listing), operations: cost.total, special: cost.special })
    }

    /// Returns coefficients with spheres added that lie around the point where they are taken.
    pub fn add(&self, spheres: &[SphereLight], e: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut sum = e.to_vec();
        for sphere in spheres {
            let (dir, s) = (sphere.direction(), sphere.squared_sine());
            for channel in 0..3 {
                let c: Vec<f64> = sum.iter().map(|c| c[channel]).collect();
                let found = self.kernel.run(&[&dir, &[s], &[sphere.radiance[channel]], &c], Contraction::Separate);
                sum.iter_mut().zip(found).for_each(|(sum, found)| sum[channel] = found);
            }
        }
        sum
    }
}

/// A pixel under spheres.
#[derive(Clone, Debug)]
pub struct Pixel {
    /// By brute force, nothing in the way.
    pub truth: [f64; 3],
    /// At each order the spheres taken as they lie around the pixel, and around the object's middle.
    pub found: Vec<[[f64; 3]; 2]>,
}

/// Returns what pixels show under a map and the spheres, at orders.
///
/// # Errors
///
/// If an order has no kernel.
pub fn picture(
    object: &Object,
    camera: &Camera,
    size: [usize; 2],
    brdf: &Brdf,
    map: &Map,
    orders: &[usize],
) -> Result<Vec<Option<Pixel>>, Fault> {
    /// An order's shader, what adds spheres, the map's light, the same with spheres around the middle.
    type Way = (Shader, Adder, Vec<[f64; 3]>, Vec<[f64; 3]>);
    let way = |&order: &usize| -> Result<Way, Fault> {
        let (adder, Projection { coefficients, .. }) = (Adder::new(order)?, map.project(order));
        let middle = adder.add(&SPHERES, &coefficients);
        Ok((Shader::new(brdf, order)?, adder, coefficients, middle))
    };
    let ways = orders.iter().map(way).collect::<Result<Vec<Way>, Fault>>()?;
    let lights = zonal_picture::lights::Lights::of(map).gathered(1024);
    let pixel = |place: &Option<Place>| {
        let place = place.as_ref()?;
        let spheres = around(&SPHERES, place.point.position);
        let own = Lights::of_spheres(&spheres);
        let truth = [&lights, &own]
            .into_iter()
            .fold([0.0; 3], |sum, lights| add(sum, 1.0, lights.radiance(brdf, place.axes, place.view)));
        let found =
            ways.iter().map(|(shader, adder, e, middle)| shader.shade(place, [&adder.add(&spheres, e)[..], middle]));
        Some(Pixel { truth, found: found.collect() })
    };
    Ok(object.places(camera, size).par_iter().map(pixel).collect())
}
