//! The light that a point of a surface gets from the sky where nothing stands in its way, in a basis. It knows neither meshes
//! nor files.

use crate::basis::Basis;
use crate::occluders::Occluders;
use crate::point::Point;
use crate::sky::Sky;
use rayon::prelude::*;

/// What gathers light.
pub struct Baker<'a> {
    /// Where light comes from.
    pub sky: &'a Sky,
    /// What stands in its way.
    pub occluders: &'a Occluders,
    /// What it is stored in.
    pub basis: &'a Basis,
    /// How many rays a point casts over the whole sphere; those below its horizon meet nothing but itself, and are not cast.
    pub rays: usize,
    /// Which rays.
    pub seed: u64,
    /// Whether irradiance is divided by π: what a white surface sends out.
    pub over_pi: bool,
}

impl Baker<'_> {
    /// Returns the coefficients of a point, in its frame or, where the basis is of the object, in the object's axes. Light from below its horizon, which is the plane across its normal,
    /// counts as none: the surface itself is in the way. `number` tells its rays from those of other points.
    pub fn at(&self, point: &Point, number: u64) -> Vec<[f64; 3]> {
        let count = self.basis.order * self.basis.order;
        let (mut sums, mut values) = (vec![[0.0; 3]; count], vec![0.0; count]);
        let origin = point.origin();
        for ray in self.sky.rays(self.rays, self.seed ^ (number + 1).wrapping_mul(0x9e6c_63d0_876a_68de)) {
            let local = point.local(ray.direction);
            if local[2] > 0.0 && self.occluders.sees(origin, ray.direction) {
                let direction = if self.basis.is_of_object() { ray.direction } else { local };
                self.basis.values(direction, &mut values);
                let channels = self.basis.channels();
                for (sum, value) in sums.iter_mut().zip(&values) {
                    (0..channels).for_each(|channel| sum[channel] += value * ray.power[channel]);
                }
            }
        }
        let mut found = self.basis.coefficients(&sums);
        if self.over_pi && self.basis.is_irradiance() {
            found.iter_mut().flatten().for_each(|c| *c *= std::f64::consts::FRAC_1_PI);
        }
        found
    }

    /// Returns the coefficients of many points, whose numbers are their places; `tick` is called after each.
    pub fn all(&self, points: &[Point], tick: impl Fn() + Sync) -> Vec<Vec<[f64; 3]>> {
        let one = |(number, point): (usize, &Point)| {
            let found = self.at(point, number as u64);
            tick();
            found
        };
        points.par_iter().enumerate().map(one).collect()
    }
}
