//! The cache: which records serve a place, by the weight of Ward et al. as Křivánek et al. use it, and what they bring
//! together (Gautron et al. 2004, equations 23 and 24).

use crate::basis::Basis;
use crate::light::Light;
use crate::methods::{Limit, Method};
use crate::place::Place;
use crate::record::{Record, Sampling};
use crate::scene::Scene;
use zonal_picture::vector::{add, dot, length};

/// Along each axis the room is cut into so many cells, in which records are found.
const CELLS: usize = 32;
/// The least that divides a weight: nearer than this, records count as being there.
const NEAREST: f64 = 1e-4;

/// Records with where they serve.
pub struct Cache<const C: usize> {
    /// What they are stored in.
    pub basis: Basis<C>,
    /// The records, in the order in which they came.
    pub records: Vec<Record<C>>,
    /// The error a: a record serves where 1/weight is at most this.
    pub error: f64,
    cells: Vec<Vec<u32>>,
}

/// How many rotations were done, and how many of them by the method for any angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// All.
    pub all: usize,
    /// Those for any angle.
    pub any: usize,
}

/// The cell of a coordinate.
fn cell(x: f64) -> usize {
    ((x + 1.0) / 2.0 * CELLS as f64).clamp(0.0, (CELLS - 1) as f64) as usize
}

impl<const C: usize> Cache<C> {
    /// Returns an empty cache of an error from 0 to 1.
    pub fn new(basis: Basis<C>, error: f64) -> Self {
        Self { basis, records: Vec::new(), error, cells: vec![Vec::new(); CELLS * CELLS * CELLS] }
    }

    /// Adds a record.
    pub fn insert(&mut self, record: Record<C>) {
        let reach = self.error * record.radius;
        let [x, y, z] = record.place.point.position.map(|x| cell(x - reach)..=cell(x + reach));
        let number = self.records.len() as u32;
        for k in z {
            for j in y.clone() {
                for i in x.clone() {
                    self.cells[(k * CELLS + j) * CELLS + i].push(number);
                }
            }
        }
        self.records.push(record);
    }

    /// Returns the records that serve a place, each with 1/weight: |p − p_i|/R_i + √(1 − n·n_i).
    fn serving(&self, place: &Place) -> impl Iterator<Item = (&Record<C>, f64)> {
        let (at, normal) = (place.point.position, place.normal());
        let [i, j, k] = at.map(cell);
        self.cells[(k * CELLS + j) * CELLS + i].iter().filter_map(move |&number| {
            let record = &self.records[number as usize];
            let far = length(add(at, -1.0, record.place.point.position)) / record.radius;
            let error = far + (1.0 - dot(normal, record.place.normal())).max(0.0).sqrt();
            (error <= self.error).then_some((record, error))
        })
    }

    /// Returns whether a record serves a place.
    pub fn serves(&self, place: &Place) -> bool {
        self.serving(place).next().is_some()
    }

    /// Adds records until one serves each of some places, in their order.
    pub fn fill(&mut self, scene: &Scene, places: impl Iterator<Item = Place>, sampling: Sampling, tick: impl Fn()) {
        for place in places {
            if !self.serves(&place) {
                self.insert(Record::new(&self.basis, scene, place, sampling, self.records.len()));
            }
            tick();
        }
    }

    /// Returns the light at a place, in its frame: the mean of the records that serve it, each moved by its derivatives and
    /// turned; nothing where none serves. `limit` is the sine of half the largest angle for small turns.
    pub fn light(&self, place: &Place, method: &Method<C>, limit: f32, count: &mut Count) -> Option<Light<C>> {
        let (mut sum, mut total) = ([[0.0f32; 3]; C], 0.0f32);
        for (record, error) in self.serving(place) {
            let away = record.place.point.local(add(place.point.position, -1.0, record.place.point.position));
            let [dx, dy] = [away[0] as f32, away[1] as f32];
            let mut moved = record.light;
            let moves = moved.as_flattened_mut().iter_mut();
            let slopes = record.slopes[0].as_flattened().iter().zip(record.slopes[1].as_flattened());
            moves.zip(slopes).for_each(|(c, (x, y))| *c += dx * x + dy * y);
            let (turned, is_any) = method.turn(place.aligned(&record.place), limit, &moved);
            count.all += 1;
            count.any += usize::from(is_any);
            let weight = (1.0 / error.max(NEAREST)) as f32;
            sum.as_flattened_mut().iter_mut().zip(turned.as_flattened()).for_each(|(s, c)| *s += weight * c);
            total += weight;
        }
        (total > 0.0).then(|| sum.map(|c| c.map(|x| x / total)))
    }

    /// Returns the sine of half the angle of a limit for this cache's error.
    pub fn limit(&self, limit: Limit) -> f32 {
        (0.5 * limit.angle(self.error)).sin() as f32
    }
}
