//! The cheapest way to rotate within an error: a method for each band by the error law, and the operations of the kernels
//! that come of it.
//!
//! A band may be done in any way; what the ways share are the multiples of the angle that exact bands take, so that every
//! choice of the highest exact band is tried, and the kernels are counted. For the error of the worst or of the mean
//! signal each band stands for itself; for a signal of known energies the bands share the error, and the choices that
//! no other one beats in both cost and error are kept from band to band.

use crate::families::spec::{Family, Method, SMALL_ANGLE_DEGREES, Spec};
use crate::families::y_rotation::{self, Small};
use crate::ir::code::Code;
use crate::ir::listing::Listing;
use crate::promise::built;
use crate::promise::law::{self, Error, Given};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// Which rotation is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Turn {
    /// The shortest one from z to a normal.
    Tilt,
    /// About y.
    Y,
    /// About z, y and z: any rotation, its y angle bounded.
    Zyz,
    /// The same from a quaternion.
    Quaternion,
}

/// Which numbers a kernel works in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// f32.
    #[default]
    F32,
    /// f16, in WGSL alone.
    F16,
    /// f16 where the error that is allowed has room for its rounding.
    Auto,
}

/// What an error is the error of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Norm {
    /// The worst signal of the worst band.
    #[default]
    Max,
    /// A random signal of the worst band, in the root mean square.
    Mean,
    /// The worst signal whose bands have given energies, against all of it.
    Signal,
}

impl Norm {
    /// What an error in it is the error of.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Max => "of the worst band's norm",
            Self::Mean => "of the worst band's norm, in the root mean square over signals",
            Self::Signal => "of the norm of a signal with the environment's energies",
        }
    }
}

/// An error that a rotation may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// The largest y angle or tilt in radians.
    pub max_angle: f64,
    /// What the method may err by, relative to a band's norm, or to the signal's.
    pub error: f64,
    /// Of which signal.
    pub norm: Norm,
    /// The energy of each band, for [`Norm::Signal`].
    pub energy: Vec<f64>,
}

impl Budget {
    /// The bands' errors as one.
    pub fn combine(&self, errors: &[Error]) -> f64 {
        match self.norm {
            Norm::Max => errors.iter().map(|error| error.max).fold(0.0, f64::max),
            Norm::Mean => errors.iter().map(|error| error.mean).fold(0.0, f64::max),
            Norm::Signal => {
                let shares = self.shares(errors.len());
                errors.iter().zip(shares).map(|(error, share)| share * error.max * error.max).sum::<f64>().sqrt()
            }
        }
    }

    /// What the method of a spec errs by at the largest angle.
    pub fn predict(&self, spec: &Spec) -> f64 {
        self.combine(&law::errors(spec, self.max_angle))
    }

    /// Each band's share of the energy that the bands hold together.
    fn shares(&self, order: usize) -> Vec<f64> {
        let held: f64 = self.energy.iter().take(order).sum();
        let share = |l: usize| self.energy.get(l).copied().unwrap_or(0.0) / held;
        (0..order).map(|l| if held > 0.0 { share(l) } else { 1.0 / order as f64 }).collect()
    }
}

/// The small-angle family of a rotation with these methods.
pub(crate) fn family(turn: Turn, methods: Vec<Small>) -> Family {
    match turn {
        Turn::Y => Family::SmallY(methods),
        Turn::Zyz => Family::Rotate(Method::Small(methods)),
        Turn::Quaternion => Family::RotateSmall(methods),
        Turn::Tilt => Family::Tilt(methods),
    }
}

/// What a rotation is given, and which methods a band may have.
fn ways(turn: Turn, l: usize) -> (Given, Vec<Small>) {
    let approximate = Small::ALL.map(|(method, _)| method);
    match turn {
        Turn::Y | Turn::Zyz => (Given::Angle, approximate.to_vec()),
        Turn::Quaternion => (Given::Phase, [&[Small::Exact], &approximate[..]].concat()),
        Turn::Tilt => (Given::Normal, if l < 3 { vec![Small::Exact] } else { vec![Small::Lf3, Small::Lf5] }),
    }
}

/// The operations of one band's y rotation, without what bands share.
fn band_cost(turn: Turn, method: Small, l: usize) -> usize {
    type Key = (Turn, Small, usize);
    static KNOWN: Mutex<Option<HashMap<Key, usize>>> = Mutex::new(None);
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(&cost) = known().get_or_insert_default().get(&(turn, method, l)) {
        return cost;
    }
    let order = l + 1;
    let methods: Vec<Small> = vec![method; l];
    let mut kernel = match (turn, method) {
        (Turn::Tilt, Small::Exact) => crate::families::tilt::tilt(order, &Small::Lf3.from_band_3(order), false),
        (Turn::Tilt, _) => crate::families::tilt::tilt(order, &method.from_band_3(order), false),
        _ => y_rotation::small_y(order, &methods),
    };
    kernel.outputs.drain(..l * l);
    let mut listing = Listing::new(&kernel);
    if method == Small::Exact && turn != Turn::Tilt {
        listing.steps.retain(|step| step.kind == crate::ir::graph::Kind::Signal);
    }
    let cost = listing.cost(1).total;
    known().get_or_insert_default().insert((turn, method, l), cost);
    cost
}

/// A band's methods with cost and error, cheapest first.
fn options(turn: Turn, l: usize, budget: &Budget, exact: bool) -> Vec<(usize, Error, Small)> {
    let (given, methods) = ways(turn, l);
    let mut options: Vec<_> = methods
        .into_iter()
        .filter(|method| exact || turn == Turn::Tilt || *method != Small::Exact)
        .map(|method| (band_cost(turn, method, l), law::error(method, given, l, budget.max_angle), method))
        .collect();
    options.sort_by_key(|(cost, ..)| *cost);
    options
}

/// The cheapest method of every band within the budget, no band above `highest` exact.
fn mixture(turn: Turn, order: usize, budget: &Budget, highest: usize) -> Option<Vec<Small>> {
    let options = |l: usize| options(turn, l, budget, l <= highest);
    if budget.norm != Norm::Signal {
        let keeps = |error: &Error| budget.combine(std::slice::from_ref(error)) <= budget.error;
        let cheapest = |l: usize| options(l).into_iter().find(|(_, error, _)| keeps(error)).map(|(.., method)| method);
        return (1..order).map(cheapest).collect();
    }
    // Cost, squared error, methods: what no other choice of the bands so far beats.
    let shares = budget.shares(order);
    let mut front: Vec<(usize, f64, Vec<Small>)> = vec![(0, 0.0, vec![])];
    for l in 1..order {
        let mut next: Vec<(usize, f64, Vec<Small>)> = Vec::new();
        for (cost, square, methods) in &front {
            for (own, error, method) in options(l) {
                let square = square + shares[l] * error.max * error.max;
                if square.sqrt() <= budget.error {
                    next.push((cost + own, square, [&methods[..], &[method]].concat()));
                }
            }
        }
        next.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut best = f64::INFINITY;
        next.retain(|(_, square, _)| {
            let better = *square < best;
            best = best.min(*square);
            better
        });
        front = next;
    }
    front.into_iter().next().map(|(.., methods)| methods)
}

/// The approximate kernels that keep the budget, a method for each band: one for every choice of the highest exact band,
/// none if the angle is beyond what they are meant for.
pub fn mixtures(turn: Turn, order: usize, budget: &Budget) -> Vec<Spec> {
    if budget.max_angle > SMALL_ANGLE_DEGREES.to_radians() * (1.0 + 1e-12) {
        return vec![];
    }
    let highest = if turn == Turn::Quaternion { 0..order } else { 0..1 };
    let mut specs: Vec<Spec> = Vec::new();
    for methods in highest.filter_map(|highest| mixture(turn, order, budget, highest)) {
        let spec = Spec::new(family(turn, methods), order);
        if !specs.contains(&spec) {
            specs.push(spec);
        }
    }
    specs
}

/// The exact kernel of a rotation.
pub fn exact(turn: Turn, order: usize, rgb: bool) -> Spec {
    let family = match turn {
        Turn::Y => Family::RotateY,
        Turn::Tilt if order <= 3 => Family::Tilt(Small::Lf3.from_band_3(order)),
        Turn::Tilt | Turn::Quaternion => Family::Rotate(Spec::default_method(order, rgb)),
        Turn::Zyz => Family::Rotate(Method::Euler),
    };
    Spec { rgb, ..Spec::new(family, order) }
}

/// The cheapest kernel by operations whose method keeps the budget, and what it errs by: an approximate one or the exact
/// one, which always does.
pub fn cheapest(turn: Turn, order: usize, budget: &Budget) -> (Spec, usize, f64) {
    let cost = |spec: &Spec| match built::code(spec) {
        Code::Straight(listing) => listing.cost(1).total,
        code => code.cost(1).total,
    };
    // The first of those that cost the least: the exact one where it is among them.
    let all = [exact(turn, order, false)].into_iter().chain(mixtures(turn, order, budget));
    let weighed = all.map(|spec| (cost(&spec), spec));
    let (cost, spec) = weighed.min_by_key(|(cost, _)| *cost).expect("the exact kernel is one");
    let error = budget.predict(&spec);
    (spec, cost, error)
}
