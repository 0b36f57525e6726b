//! The rotation about y of a record over the hemisphere as a table over its angle: C D E with the best extension below the
//! horizon (the third method of Gautron et al. 2004; docs/MATH.md#rotation-on-the-hemisphere). Its entries are what the
//! generated kernel says in f64.

use crate::basis::Light;
use std::sync::OnceLock;
use zonal_codegen::families::hemisphere::table::places;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;

/// The largest angle in degrees: a cache of error 0.5 turns by 41.4 at most.
const DEGREES: usize = 45;

/// Matrices for every degree from 0 to 45.
pub struct Table {
    places: Vec<[usize; 2]>,
    rows: Vec<Vec<f32>>,
}

/// Returns the table of an order, which is made once.
pub fn of_order(order: usize) -> &'static Table {
    static TABLES: [OnceLock<Table>; 11] = [const { OnceLock::new() }; 11];
    TABLES[order.min(10)].get_or_init(|| Table::new(order.min(10)))
}

impl Table {
    fn new(order: usize) -> Self {
        let spec = format!("hsh_y_record:{order}:sh=16").parse::<zonal_codegen::families::family::Spec>();
        let spec = spec.expect("the family has that spec");
        let program = Program::<f64>::new(&Listing::new(&spec.kernel()));
        let count = order * order;
        let places = places(order);
        let unit = |column: usize| -> Vec<f64> { (0..count).map(|i| f64::from(u8::from(i == column))).collect() };
        let row = |degrees: usize| {
            let (sin, cos) = (degrees as f64).to_radians().sin_cos();
            let turned = |column| program.run(&[&[cos, sin], &unit(column)], Contraction::Separate);
            let columns: Vec<Vec<f64>> = (0..count).map(turned).collect();
            places.iter().map(|&[row, column]| columns[column][row] as f32).collect()
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
