//! The rotation by turned lobes, c' = Y z with z = Âᵀ c: a column of Y is the basis at one lobe, so that the error weights
//! of a column are functions of that lobe's direction alone. Each is as large as it is anywhere on the sphere, whatever
//! the rotation; their norms add as squares.

// Names a family: the norm of turned lobes is that of their own matrix.
use crate::families::zhf::lobes;
use crate::ir::listing::{Listing, Op, Operand};
use crate::math::linear::singular_values;
use crate::promise::bound::norm::SLACK;
use crate::promise::bound::prover::{Part, Prover};
use crate::promise::bound::region::{Region, Root};
use crate::promise::bound::roundoff::{Both, INPUT, larger_of};
use crate::promise::bound::section::{Run, Section, Start};
use crate::promise::bound::sweep::density;
use std::collections::HashMap;

impl Prover<'_> {
    /// The error of every band relative to its norm.
    pub(super) fn turned_lobes(&self) -> Option<Vec<Both>> {
        let directions = &self.listing.directions;
        let first = directions.first()?;
        let error = self.scalars(directions.as_flattened())?;
        let components: HashMap<Operand, usize> =
            directions.iter().flat_map(|xyz| xyz.iter().copied().zip(0..)).collect();
        let alike = alike(self.listing, |operand| components.get(&operand).map(|&i| first[i]));
        let component = |operand: Operand| first.iter().position(|&known| known == operand);
        let start = |operand| Some(Start { root: Root::Component(component(operand)?), spread: 0.0, error });
        (0..self.spec.order).map(|l| self.turned(l, &alike, &start)).collect()
    }

    fn turned(&self, l: usize, alike: &Listing, start: &dyn Fn(Operand) -> Option<Start>) -> Option<Both> {
        let inputs = &self.coefficients()[l * l..(l + 1) * (l + 1)];
        let outputs = |listing: &Listing| listing.outputs[l * l..(l + 1) * (l + 1)].to_vec();
        let (signals, _) = self.cone(inputs, &outputs(self.listing))?;
        let is_between =
            |stage: &&Vec<Operand>| stage.len() == inputs.len() && stage.iter().all(|z| signals.contains(z));
        let Some(place) = self.listing.stages.iter().position(|stage| is_between(&stage)) else {
            return self.band(l);
        };
        let weights = self.part(inputs, &self.listing.stages[place], &[])?;
        let section = Section::new(alike, Region::Sphere, &alike.stages[place], &outputs(alike), start)?;
        let roots: Vec<Root> = section.starts().iter().map(|start| start.root).collect();
        let degree = section.degree();
        // Entries that were rounded to f32 turn a lobe to a vector that is not quite of unit length.
        let (grid, factor) = Region::Sphere.grid(&roots, degree, density(degree), (0.0, 0.0));
        let mut run = Run::default();
        let mut columns = [vec![0.0; inputs.len()], vec![0.0; inputs.len()]];
        for mut values in grid {
            values.iter_mut().for_each(|value| value.1 += INPUT);
            section.run(&values, section.starts(), self.roundoff, &mut run);
            for (mode, columns) in columns.iter_mut().enumerate() {
                let weights = section.weights(&run, mode);
                for (j, largest) in columns.iter_mut().enumerate() {
                    let column = (0..inputs.len()).map(|row| weights.row(row)[j]);
                    *largest = larger_of(column.map(|w| w * w).sum(), *largest);
                }
            }
        }
        let error = columns.map(|columns| columns.iter().sum::<f64>().sqrt() * factor * SLACK);
        // Turned lobes make the matrix D Y, as large as Y, the inverse of Â, but for what the entries' rounding adds.
        let a_hat: Vec<Vec<f64>> =
            lobes(self.spec.order).a_hat(l).iter().map(|row| row.iter().map(|x| x.to_f64()).collect()).collect();
        let norm = 1.0001 / singular_values(&a_hat).last().copied()?;
        Some(weights.then(Part { error, norm }).error.map(|error| error * SLACK))
    }
}

/// Returns the listing with some operands taken for others and equal operations done once.
fn alike(listing: &Listing, other: impl Fn(Operand) -> Option<Operand>) -> Listing {
    let mut listing = listing.clone();
    let mut places: Vec<Operand> = Vec::new();
    let mut known: HashMap<Op, Operand> = HashMap::new();
    let of = |operand: Operand, places: &[Operand]| match (other(operand), operand) {
        (Some(other), _) => other,
        (None, Operand::Step(place)) => places[place],
        _ => operand,
    };
    for (place, step) in listing.steps.iter_mut().enumerate() {
        step.op = step.op.map(|operand| of(operand, &places));
        places.push(*known.entry(step.op).or_insert(Operand::Step(place)));
    }
    for operand in listing.outputs.iter_mut().chain(listing.stages.iter_mut().flatten()) {
        *operand = of(*operand, &places);
    }
    listing
}
