//! The error of a section's signal depth by depth, which keeps the signs that weights lose.

use super::{Run, Section, Slot, ends};
use crate::ir::graph::Kind;
use crate::promise::bound::norm::{Matrix, SLACK};
use crate::promise::bound::roundoff::Both;
use crate::promise::bound::value::EPSILON;

impl Section {
    /// Another bound of the error's norm: with P the map from a depth's values to the outputs and V that from the inputs
    /// to what is rounded there, a depth adds ‖P‖ ‖V‖ u. It keeps the signs that weights lose, and counts depths.
    pub fn error_by_depth(&self, run: &Run, roundoff: f64) -> Both {
        let rows = self.outputs.len();
        let (mut mid, mut radius) = (vec![0.0; self.slots.len() * rows], vec![0.0; self.slots.len() * rows]);
        for (row, &output) in self.outputs.iter().enumerate() {
            mid[output * rows + row] += 1.0;
        }
        let mut total = [0.0; 2];
        for (at, slot) in self.slots.iter().enumerate().rev() {
            let (&Slot::Step(op), Kind::Signal) = (slot, self.kinds[at]) else { continue };
            let (factor, _, [plus, minus]) = self.form(op, &run.scalars);
            let (first, last) = ends(op);
            for row in 0..rows {
                let (m, r) = (mid[at * rows + row], radius[at * rows + row]);
                let to = first * rows + row;
                mid[to] += plus * factor.mid * m;
                radius[to] += m.abs() * (factor.radius + EPSILON * factor.mid.abs()) + r * factor.magnitude();
                radius[to] += mid[to].abs() * EPSILON;
                if let Some(last) = last {
                    let to = last * rows + row;
                    mid[to] += minus * m;
                    radius[to] += r + mid[to].abs() * EPSILON;
                }
            }
        }
        for level in &self.levels {
            let side = |values: &[f64]| -> Matrix {
                let entries = level.iter().flat_map(|&at| values[at * rows..(at + 1) * rows].iter().copied()).collect();
                Matrix { columns: rows, entries }
            };
            let after = side(&mid).quick_norm() + side(&radius).frobenius();
            // What each step rounds: its sum and its product; what its factor is off by; and errors of errors.
            let mut parts: [Matrix; 3] = std::array::from_fn(|_| self.empty(level.len()));
            let mut factors = [self.empty(level.len()), self.empty(level.len())];
            let (mut rest, mut thick) = ([0.0; 2], 0.0);
            for (i, &at) in level.iter().enumerate() {
                let Slot::Step(op) = self.slots[at] else { unreachable!("a level holds steps") };
                let (factor, rounds, _) = self.form(op, &run.scalars);
                for (entry, &column) in (self.offset[at]..).zip(&self.support[at]) {
                    let (a, to) = (self.from[entry][0] as usize, i * self.columns + column as usize);
                    let (given, size) = (run.mid[a], factor.magnitude());
                    parts[0].entries[to] = if rounds[1] { run.mid[entry] } else { 0.0 };
                    let product = if rounds[0] { factor.mid * given } else { 0.0 };
                    parts[if rounds[1] { 1 } else { 2 }].entries[to] = product;
                    let loose =
                        run.radius[entry] + run.radius[a] * size + given.abs() * (factor.radius + EPSILON * size);
                    thick += loose * loose;
                    for mode in 0..2 {
                        factors[mode].entries[to] = factor.error[mode] * given;
                        let error = 2.0 * roundoff * run.weight[mode][entry]
                            + factor.error[mode] * (run.radius[a] + run.weight[mode][a]);
                        rest[mode] += error * error;
                    }
                }
            }
            let [sum, fused, alone] = parts.map(|part| part.quick_norm());
            for mode in 0..2 {
                let rounded = sum + alone + if mode == 0 { fused } else { 0.0 } + 4.0 * thick.sqrt();
                let error = roundoff * rounded + factors[mode].quick_norm() + rest[mode].sqrt();
                total[mode] += if error == 0.0 { 0.0 } else { after * error };
            }
        }
        total.map(|error| error * SLACK)
    }

    fn empty(&self, rows: usize) -> Matrix {
        Matrix { columns: self.columns, entries: vec![0.0; rows * self.columns] }
    }
}
