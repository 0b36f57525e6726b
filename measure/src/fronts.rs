//! What a budget buys: for each order and largest angle the y rotations that no other one beats in both operations and
//! error. A y rotation may do each band in its own way. The largest error of any band is what counts, so that for an
//! error e every band takes the cheapest way that keeps e; exact bands share the multiples of the angle, whose cost is
//! that of the highest exact band, so that each choice of that band is tried.

use crate::errors::{Comparison, LEVELS, SHOWN};
use crate::methods::{Band, Way, mixed_cost, restricted};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use zonal_codegen::graph::Kind;
use zonal_codegen::kernels::rotate::rotate_y;
use zonal_codegen::kernels::y_rotation::about_y;
use zonal_codegen::listing::Listing;

/// The orders that are weighed.
pub const ORDERS: std::ops::RangeInclusive<usize> = 3..=10;
/// The largest error is sought at so many angles up to the largest.
const FRACTIONS: usize = 8;

/// A y rotation: how, for how much, how well.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The way of each band from 1, joined by `+`, or of all bands.
    pub bands: String,
    /// Its operations.
    pub operations: usize,
    /// Its largest error up to the largest angle.
    pub error: f64,
    /// The same by the methods' laws.
    pub law: f64,
}

/// What can be had at an order up to an angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Front {
    /// The order.
    pub order: usize,
    /// The largest angle in degrees.
    pub degrees: f64,
    /// What no other choice beats, cheapest first.
    pub points: Vec<Choice>,
    /// Every band in the same way.
    pub uniform: Vec<Choice>,
}

impl Front {
    /// The cheapest of a list that keeps an error.
    pub fn cheapest(choices: &[Choice], error: f64) -> Option<&Choice> {
        choices.iter().filter(|choice| choice.error <= error).min_by_key(|choice| choice.operations)
    }
}

/// The errors of every way: `[band way][angle of SHOWN][l]`.
fn errors() -> Vec<Vec<Vec<f64>>> {
    let order = *ORDERS.end();
    Band::all()
        .map(|band| {
            let Band::Small(small) = band else {
                return vec![vec![0.0; order]; SHOWN.len()];
            };
            let comparison = Comparison::new(Way::Uniform(small), order);
            let at = |degrees: f64| -> Vec<f64> {
                let angles = (1..=FRACTIONS).map(|i| degrees.to_radians() * i as f64 / FRACTIONS as f64);
                angles.fold(vec![0.0; order], |worst, angle| {
                    worst.iter().zip(comparison.bands(angle)).map(|(a, b)| b[0].max(*a)).collect()
                })
            };
            SHOWN.map(at).to_vec()
        })
        .collect()
}

/// The fronts of one order.
struct Weighing<'a> {
    order: usize,
    ways: Vec<Band>,
    errors: &'a [Vec<Vec<f64>>],
    exact: zonal_codegen::kernel::Kernel,
    /// `estimates[way][l]`: what a band costs by itself, an exact one without its multiples.
    estimates: Vec<Vec<usize>>,
    /// What the multiples cost up to the highest exact band.
    set_up: Vec<usize>,
    known: HashMap<Vec<Band>, usize>,
}

impl<'a> Weighing<'a> {
    fn new(order: usize, errors: &'a [Vec<Vec<f64>>]) -> Self {
        let exact = rotate_y(order);
        let ways: Vec<Band> = Band::all().collect();
        let of_kind = |listing: &Listing, kind: Kind| -> usize {
            let mut part = listing.clone();
            part.steps.retain(|step| step.kind == kind);
            part.cost(1).total
        };
        let alone: Vec<Listing> = (0..order).map(|l| restricted(&exact, |band| band == l)).collect();
        let estimates = ways
            .iter()
            .map(|way| match way {
                Band::Exact => alone.iter().map(|listing| of_kind(listing, Kind::Signal)).collect(),
                Band::Small(small) => {
                    let kernel = about_y(order, &vec![*small; order - 1]);
                    (0..order).map(|l| restricted(&kernel, |band| band == l).cost(1).total).collect()
                }
            })
            .collect();
        let set_up = alone.iter().map(|listing| of_kind(listing, Kind::Scalar)).collect();
        Self { order, ways, errors, exact, estimates, set_up, known: HashMap::new() }
    }

    /// The cheapest way of each band that keeps an error, no band above `highest` exact.
    fn mixture(&self, angle: usize, error: f64, highest: usize) -> Option<(usize, Vec<Band>)> {
        let mut total = self.set_up[highest];
        let mut bands = Vec::new();
        for l in 1..self.order {
            let keeps =
                |way: &usize| self.errors[*way][angle][l] <= error && (l <= highest || self.ways[*way] != Band::Exact);
            let way = (0..self.ways.len()).filter(keeps).min_by_key(|way| self.estimates[*way][l])?;
            total += self.estimates[way][l];
            bands.push(self.ways[way]);
        }
        Some((total, bands))
    }

    fn choice(&mut self, angle: usize, bands: &[Band]) -> Choice {
        let operations = match self.known.get(bands) {
            Some(known) => *known,
            None => mixed_cost(&self.exact, bands),
        };
        self.known.insert(bands.to_vec(), operations);
        let way = |band: &Band| self.ways.iter().position(|way| way == band).expect("is one of them");
        let error = bands.iter().zip(1..).map(|(band, l)| self.errors[way(band)][angle][l]).fold(0.0, f64::max);
        let law = bands.iter().zip(1..).map(|(band, l)| band.law(l, SHOWN[angle].to_radians())).fold(0.0, f64::max);
        let same = bands.iter().all(|band| *band == bands[0]);
        let names: Vec<&str> = bands.iter().map(|band| band.name()).collect();
        Choice {
            bands: if same { names[0].to_owned() } else { names.join("+") },
            operations,
            error: significant(error),
            law: significant(law),
        }
    }

    fn front(&mut self, angle: usize) -> Front {
        let mut thresholds: Vec<f64> =
            self.errors.iter().flat_map(|way| way[angle][1..self.order].iter().copied()).collect();
        thresholds.sort_by(f64::total_cmp);
        thresholds.dedup();
        let mut points: Vec<Choice> = Vec::new();
        for error in thresholds {
            let all = (0..self.order).filter_map(|highest| self.mixture(angle, error, highest));
            let (_, bands) = all.min_by_key(|(total, _)| *total).expect("every band can be exact");
            points.push(self.choice(angle, &bands));
        }
        let ways = self.ways.clone();
        let uniform: Vec<Choice> = ways.iter().map(|way| self.choice(angle, &vec![*way; self.order - 1])).collect();
        points.extend(uniform.iter().cloned());
        points.sort_by(|a, b| a.operations.cmp(&b.operations).then(a.error.total_cmp(&b.error)));
        let mut best = f64::INFINITY;
        points.retain(|point| {
            let better = point.error < best;
            best = best.min(point.error);
            better
        });
        Front { order: self.order, degrees: SHOWN[angle], points, uniform }
    }
}

/// Every order and angle.
pub fn measure(progress: &dyn Progress) -> Vec<Front> {
    let errors = errors();
    let orders: Vec<usize> = ORDERS.collect();
    let fronts = each(progress, "cost against error", &orders, |order| {
        let mut weighing = Weighing::new(*order, &errors);
        (0..SHOWN.len()).map(|angle| weighing.front(angle)).collect::<Vec<_>>()
    });
    fronts.concat()
}

/// The cheapest choices of a front for [`LEVELS`], the largest error first.
pub fn budgets(choices: &[Choice]) -> Vec<(f64, Option<&Choice>)> {
    LEVELS.iter().rev().map(|level| (*level, Front::cheapest(choices, *level))).collect()
}
