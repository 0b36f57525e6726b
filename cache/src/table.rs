//! The rotation about y of a record over the hemisphere as a table over its angle: C D E with the best extension below the
//! horizon (the third method of Gautron et al. 2004; docs/MATH.md#rotation-on-the-hemisphere). C and E are the generator's,
//! D of order 16 is by the recursion of Ivanic and Ruedenberg: the kernel `hsh_y_record:n:sh=16` says the same, but takes ten
//! seconds to be built.

use crate::light::Light;
use std::sync::OnceLock;
// Names a family: its table and this one have their entries in the same order.
use zonal_codegen::families::hemisphere::table::places;
use zonal_codegen::math::hemisphere::{SPHERICAL_ORDER, extension, overlap};
use zonal_codegen::math::index::{coefficients, index};
use zonal_measure::stability::recursion::Matrices;

/// The largest angle in degrees: a cache of error 0.5 turns by 41.4 at most.
const DEGREES: usize = 45;
/// The highest order that there is a table of.
const HIGHEST: usize = 10;

/// Matrices for every degree from 0 to 45.
pub struct Table {
    places: Vec<[usize; 2]>,
    rows: Vec<Vec<f32>>,
}

/// Returns the table of an order, 10 at most, which is made once.
pub fn of_order(order: usize) -> &'static Table {
    static TABLES: [OnceLock<Table>; HIGHEST + 1] = [const { OnceLock::new() }; HIGHEST + 1];
    let order = order.min(HIGHEST);
    TABLES[order].get_or_init(|| Table::new(order))
}

/// For each hemispherical coefficient the spherical places that it meets, ascending, with their factors.
type Factors = Vec<Vec<(usize, f64)>>;

/// What a function of l', l and m is for every spherical band l' that m leaves, for each hemispherical coefficient: the places
/// among the spherical ones with their factors.
fn factors(order: usize, of: impl Fn(usize, usize, isize) -> f64) -> Factors {
    let one = |(l, m): (usize, isize)| {
        (m.unsigned_abs()..SPHERICAL_ORDER).map(|spherical| (index(spherical, m), of(spherical, l, m))).collect()
    };
    coefficients(order).map(one).collect()
}

/// Returns hemispherical coefficients of order 10 at most as `S` spherical ones, of a function that goes on below the horizon:
/// E, as `hsh_extend`, which the catalogue has up to order 6.
pub fn extended<const C: usize, const S: usize>(c: &Light<C>) -> Light<S> {
    static FACTORS: [OnceLock<Factors>; HIGHEST + 1] = [const { OnceLock::new() }; HIGHEST + 1];
    let order = C.isqrt().min(HIGHEST);
    let factors =
        FACTORS[order].get_or_init(|| factors(order, |spherical, l, m| extension(order, spherical, l, m).to_f64()));
    let mut out = [[0.0; 3]; S];
    for (column, c) in factors.iter().zip(c) {
        for &(at, factor) in column.iter().take_while(|(at, _)| *at < S) {
            (0..3).for_each(|channel| out[at][channel] += factor as f32 * c[channel]);
        }
    }
    out
}

impl Table {
    fn new(order: usize) -> Self {
        let up = factors(order, |spherical, l, m| extension(order, spherical, l, m).to_f64());
        let down = factors(order, |spherical, l, m| overlap(l, spherical, m).to_f64());
        let places = places(order);
        let row = |degrees: usize| {
            let (sin, cos) = (0.5 * (degrees as f64).to_radians()).sin_cos();
            let turn = Matrices::<f64>::new([0.0, sin, 0.0, cos], SPHERICAL_ORDER - 1);
            let turned = |column: &Vec<(usize, f64)>| {
                let mut signal = vec![0.0; SPHERICAL_ORDER * SPHERICAL_ORDER];
                column.iter().for_each(|&(at, factor)| signal[at] = factor);
                turn.apply(&signal)
            };
            let columns: Vec<Vec<f64>> = up.iter().map(turned).collect();
            let entry = |&[row, column]: &[usize; 2]| -> f32 {
                down[row].iter().map(|&(at, factor)| factor * columns[column][at]).sum::<f64>() as f32
            };
            places.iter().map(entry).collect()
        };
        Self { rows: (0..=DEGREES).map(row).collect(), places }
    }

    /// Returns coefficients turned about y by an angle in radians from 0 to a quarter of π; beyond, by that.
    pub fn turn<const C: usize>(&self, beta: f32, c: &Light<C>) -> Light<C> {
        let at = beta.to_degrees().clamp(0.0, DEGREES as f32);
        let below = (at as usize).min(DEGREES - 1);
        let part = at - below as f32;
        let (low, high) = (&self.rows[below], &self.rows[below + 1]);
        let mut out = [[0.0; 3]; C];
        for (&[row, column], (low, high)) in self.places.iter().zip(low.iter().zip(high)) {
            let entry = low + part * (high - low);
            (0..3).for_each(|channel| out[row][channel] += entry * c[column][channel]);
        }
        out
    }
}
