//! The cheapest way to rotate within an error: a method for each band by the error law, and the operations of the kernels
//! that come of it.
//!
//! A band may be done in any way; what the ways share are the multiples of the angle that exact bands take, so that every
//! choice of the highest exact band is tried, and the kernels are counted. For the error of the worst or of the mean
//! signal each band stands for itself; for a signal of known energies the bands share the error, and the choices that
//! no other one beats in both cost and error are kept from band to band.

use crate::families::all::ALL;
use crate::families::family::{ByBand, Does, Family, Job, MIN_ORDER, SMALL_ANGLE_DEGREES, Spec};
use crate::families::parts::small_angle::SmallAngle;
use crate::ir::kernel::Domain;
use crate::ir::listing::Listing;
use crate::promise::law::{self, Error};
use crate::scene::budget::Norm;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

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

/// What does a job, an order and a number of channels given, and with which methods of its bands: itself, or its set-up
/// first.
pub fn candidates(job: Job, order: usize, rgb: bool) -> Vec<(Spec, Does)> {
    let mut specs: Vec<(Spec, Does)> = Vec::new();
    for &family in ALL {
        let spec = Spec { rgb, ..Spec::new(family, order) };
        let own = || match &family.by_band {
            None => vec![spec.clone()],
            Some(by_band) => {
                let last = (by_band.in_band)(order - 1);
                let methods = SmallAngle::APPROXIMATE.into_iter().filter(|method| last.contains(method));
                let all: Vec<Spec> = methods.map(|method| spec.clone().by(method)).collect();
                if all.is_empty() { vec![spec.clone()] } else { all }
            }
        };
        for does in (family.does)(order, rgb).into_iter().filter(|does| does.job == job) {
            for spec in own() {
                if !specs.iter().any(|(known, _)| *known == spec) {
                    specs.push((spec, does));
                }
            }
        }
    }
    specs
}

/// The kernel that makes a spec's parameters, if another one does.
pub fn set_up(spec: &Spec) -> Option<Spec> {
    let made = spec.kernel().params.into_iter().find_map(|param| match param.domain {
        Domain::Made(made) => Some(made.by),
        _ => None,
    })?;
    ALL.iter().find(|family| family.name == made).map(|family| Spec::new(family, spec.order))
}

/// The family that does a job by a method for each band.
fn by_methods(job: Job) -> (&'static Family, &'static ByBand) {
    let does = |family: &Family| (family.does)(MIN_ORDER, false).contains(&Does::job(job));
    let all = ALL.iter().filter_map(|family| family.by_band.as_ref().map(|by_band| (*family, by_band)));
    all.into_iter().find(|(family, _)| does(family)).expect("every job is done by a family of that kind")
}

/// The operations of one band's y rotation, without what bands share.
fn band_cost(job: Job, method: SmallAngle, l: usize) -> usize {
    type Key = (Job, SmallAngle, usize);
    static KNOWN: Mutex<Option<HashMap<Key, usize>>> = Mutex::new(None);
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(&cost) = known().get_or_insert_default().get(&(job, method, l)) {
        return cost;
    }
    let (_, by_band) = by_methods(job);
    let mut methods = by_band.alone(method, l + 1);
    methods[l - 1] = method;
    let mut kernel = (by_band.plane)(l + 1, &methods);
    kernel.outputs.drain(..l * l);
    let mut listing = Listing::new(&kernel);
    if method == SmallAngle::Exact {
        listing.steps.retain(|step| !step.kind.is_scalar());
    }
    let cost = listing.cost(1).total;
    known().get_or_insert_default().insert((job, method, l), cost);
    cost
}

/// A band's methods with cost and error, cheapest first.
fn options(job: Job, l: usize, budget: &Budget, exact: bool) -> Vec<(usize, Error, SmallAngle)> {
    let (_, by_band) = by_methods(job);
    let methods = (by_band.in_band)(l);
    let mut options: Vec<_> = methods
        .iter()
        .filter(|method| exact || methods.len() == 1 || **method != SmallAngle::Exact)
        .map(|&method| (band_cost(job, method, l), law::error(method, by_band.given, l, budget.max_angle), method))
        .collect();
    options.sort_by_key(|(cost, ..)| *cost);
    options
}

/// The cheapest method of every band within the budget, no band above `highest` exact.
fn mixture(job: Job, order: usize, budget: &Budget, highest: usize) -> Option<Vec<SmallAngle>> {
    let options = |l: usize| options(job, l, budget, l <= highest);
    if budget.norm != Norm::Signal {
        let keeps = |error: &Error| budget.combine(std::slice::from_ref(error)) <= budget.error;
        let cheapest = |l: usize| options(l).into_iter().find(|(_, error, _)| keeps(error)).map(|(.., method)| method);
        return (1..order).map(cheapest).collect();
    }
    // Cost, squared error, methods: what no other choice of the bands so far beats.
    let shares = budget.shares(order);
    let mut front: Vec<(usize, f64, Vec<SmallAngle>)> = vec![(0, 0.0, vec![])];
    for l in 1..order {
        let mut next: Vec<(usize, f64, Vec<SmallAngle>)> = Vec::new();
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
pub fn mixtures(job: Job, order: usize, budget: &Budget) -> Vec<Spec> {
    if budget.max_angle > SMALL_ANGLE_DEGREES.to_radians() * (1.0 + 1e-12) {
        return vec![];
    }
    let (family, by_band) = by_methods(job);
    // Exact bands share the multiples of the angle up to the highest of them, where a band may also be approximate.
    let is_free = by_band.takes_exact() && (by_band.in_band)(1).len() > 1;
    let highest = if is_free { 0..order } else { 0..1 };
    let mut specs: Vec<Spec> = Vec::new();
    for methods in highest.filter_map(|highest| mixture(job, order, budget, highest)) {
        let spec = Spec::new(family, order).by_band(methods);
        if !specs.contains(&spec) {
            specs.push(spec);
        }
    }
    specs
}

/// The cheapest exact kernel that does a job by itself, with the job's own parameters if there is one.
///
/// # Panics
///
/// If no family does it, which is a fault of zonal.
pub fn exact(job: Job, order: usize, rgb: bool) -> Spec {
    let all = candidates(job, order, rgb).into_iter();
    let exact = all.filter(|(spec, does)| does.barred.is_none() && !spec.is_approximate() && set_up(spec).is_none());
    let cost = |(spec, does): &(Spec, Does)| (does.otherwise, spec.code().cost(spec.channels()).total);
    exact.min_by_key(cost).expect("every job is done exactly").0
}

/// The cheapest kernel by operations whose method keeps the budget, and what it errs by: an approximate one or the exact
/// one, which always does.
pub fn cheapest(job: Job, order: usize, budget: &Budget) -> (Spec, usize, f64) {
    let cost = |spec: &Spec| spec.code().cost(1).total;
    // The first of those that cost the least: the exact one where it is among them.
    let all = [exact(job, order, false)].into_iter().chain(mixtures(job, order, budget));
    let weighed = all.map(|spec| (cost(&spec), spec));
    let (cost, spec) = weighed.min_by_key(|(cost, _)| *cost).expect("the exact kernel is one");
    let error = budget.predict(&spec);
    (spec, cost, error)
}
