//! Sums of weights times the bands of a signal at directions that a rotation turns.

use crate::families::parts::columns::{self, BandScale};
use crate::families::parts::sums::inner;
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// Returns the constant directions turned by a matrix given by its rows: nine operations each at most.
pub fn directions(g: &mut Graph, rows: &[[Id; 3]; 3], directions: &[[Exact; 3]]) -> Vec<[Id; 3]> {
    directions.iter().map(|xyz| rows.each_ref().map(|row| g.dot(xyz, row))).collect()
}

/// Returns Σ_l scale(l) Σ_j w_lj Σ_m c_lm y_l^m(R ω_j): `bands` has the indices of the directions of each band, in the order of
/// the weights, of which band l begins at l².
///
/// # Panics
///
/// If there is no band.
pub fn sum(
    g: &mut Graph,
    rows: &[[Id; 3]; 3],
    constant: &[[Exact; 3]],
    bands: &[Vec<usize>],
    w: &[Id],
    c: &[Id],
    scale: BandScale,
) -> Id {
    let turned = directions(g, rows, constant);
    let values: Vec<Vec<Id>> = turned.iter().map(|dir| columns::values(g, dir, bands.len(), scale)).collect();
    let mut sum = None;
    for (l, members) in bands.iter().enumerate() {
        let range = l * l..(l + 1) * (l + 1);
        for (&at, &weight) in members.iter().zip(&w[range.clone()]) {
            let of_band = inner(g, &c[range.clone()], &values[at][range.clone()]);
            let term = g.mul(of_band, weight);
            sum = Some(sum.map_or(term, |sum| g.add(sum, term)));
        }
    }
    sum.expect("there is a band")
}
