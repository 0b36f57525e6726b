//! What a budget buys, by the generator's own choice: for each order and largest angle the rotations that no other one
//! beats in both operations and error, and the cheapest one within each error, with what is predicted of it and what it
//! errs by in f32, on the signals that it errs most on.

use crate::errors::{LEVELS, SHOWN};
use crate::stability::truth::norm;
use crate::{Progress, each};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::code::Runner;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::ir::kernel::Domain;
use zonal_codegen::math::linear::largest_input;
use zonal_codegen::plan::mixtures::{Budget, cheapest, exact};
use zonal_codegen::promise::accuracy::Difference;
use zonal_codegen::promise::built::Built;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::scene::{Job, Norm};

/// The orders that are weighed.
pub const ORDERS: std::ops::RangeInclusive<usize> = 3..=10;
/// The rotations that are planned; the first has the fronts, since only it may mix exact bands with others.
pub const TURNS: [Job; 3] = [Job::Quaternion, Job::Y, Job::Tilt];
/// A plan is run at so many angles up to its largest, each with so many turns about z before and after.
const ANGLES: usize = 8;
const TURNED: usize = 4;
const SEED: u64 = 0xf407;

/// A rotation: which, for how much, how well.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The spec.
    pub spec: String,
    /// Its operations.
    pub operations: usize,
    /// Its largest error up to the largest angle, by its law.
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
}

/// The cheapest rotation within an error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Which rotation is wanted.
    pub turn: Job,
    /// The order.
    pub order: usize,
    /// The largest angle in degrees.
    pub degrees: f64,
    /// The error.
    pub budget: f64,
    /// What was chosen.
    pub choice: Choice,
    /// What f32 may add to its law, as the planner has it.
    pub rounding: f64,
    /// The largest error that it was seen to have in f32.
    pub measured: f64,
}

impl Plan {
    /// What the planner promises.
    pub fn predicted(&self) -> f64 {
        self.choice.law + self.rounding
    }
}

fn within(degrees: f64, error: f64) -> Budget {
    Budget { max_angle: degrees.to_radians(), error, norm: Norm::Max, energy: vec![] }
}

fn front(order: usize, degrees: f64) -> Front {
    let mut points: Vec<Choice> = Vec::new();
    let mut error = f64::INFINITY;
    while error > 0.0 {
        let (spec, operations, law) = cheapest(TURNS[0], order, &within(degrees, error));
        points.retain(|point| point.operations < operations);
        points.push(Choice { spec: spec.to_string(), operations, law });
        error = law.next_down();
    }
    Front { order, degrees, points }
}

/// A turn by β about y between two turns about z, as a unit quaternion (x, y, z, w).
fn quaternion([alpha, beta, gamma]: [f64; 3]) -> [f64; 4] {
    let (sum, difference) = (((alpha + gamma) / 2.0).sin_cos(), ((alpha - gamma) / 2.0).sin_cos());
    let (sin, cos) = (beta / 2.0).sin_cos();
    [-sin * difference.0, sin * difference.1, cos * sum.0, cos * sum.1]
}

/// What a kernel takes for such a turn, rounded to f32, and the rotation that this is.
fn given(parameter: Domain, angles: [f64; 3]) -> (Vec<f64>, Vec<f64>) {
    let [alpha, beta, _] = angles;
    let (sin, cos) = beta.sin_cos();
    let exact = match parameter {
        Domain::Quaternion | Domain::SmallTurn(_) => quaternion(angles).to_vec(),
        Domain::Hemisphere | Domain::Tilt(_) => vec![sin * alpha.cos(), sin * alpha.sin(), cos],
        Domain::Phases => vec![cos, sin],
        _ => vec![beta],
    };
    let rounded: Vec<f64> = exact.iter().map(|x| f64::from(*x as f32)).collect();
    let size = norm(rounded.iter().copied());
    let meant = match &rounded[..] {
        [x, y, z] => vec![-y, *x, 0.0, size + z],
        [cos, sin] => vec![0.0, *sin, 0.0, size + cos],
        [beta] => quaternion([0.0, *beta, 0.0]).to_vec(),
        _ => rounded.clone(),
    };
    let size = norm(meant.iter().copied());
    (rounded, meant.into_iter().map(|x| x / size).collect())
}

/// The largest error of any band, over its norm, that a kernel has in f32 at angles up to one in radians.
fn measured(turn: Job, built: &Built, exact: &Runner<f64>, max_angle: f64) -> f64 {
    let (order, narrow) = (built.spec.order, built.code.runner::<f32>());
    let difference = Difference::new(&built.spec);
    let mut random = Random::new(SEED);
    let mut worst = 0.0f64;
    for step in 1..=ANGLES {
        let beta = max_angle * step as f64 / ANGLES as f64;
        let most: Vec<f64> = difference.bands(beta).iter().flat_map(|band| largest_input(band)).collect();
        for _ in 0..TURNED {
            let [alpha, gamma] = [random.signed(), random.signed()].map(|x| x * std::f64::consts::PI);
            let [alpha, gamma] = match turn {
                Job::Y => [0.0; 2],
                Job::Tilt => [alpha, -alpha],
                _ => [alpha, gamma],
            };
            let (parameter, meant) = given(built.code.params()[0].domain, [alpha, beta, gamma]);
            // The turn before the one about y is taken off beforehand.
            let most = exact.run(&[&quaternion([0.0, 0.0, -gamma]), &most], Contraction::Separate);
            let any: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
            for signal in [most, any] {
                let signal: Vec<f32> = signal.into_iter().map(|x| x as f32).collect();
                let wide: Vec<f64> = signal.iter().map(|x| f64::from(*x)).collect();
                let parameter: Vec<f32> = parameter.iter().map(|x| *x as f32).collect();
                let want = exact.run(&[&meant, &wide], Contraction::Separate);
                for contraction in [Contraction::Separate, Contraction::Fused] {
                    let got = narrow.run(&[&parameter, &signal], contraction);
                    for l in 0..order {
                        let band = l * l..(l + 1) * (l + 1);
                        let error = norm(band.clone().map(|i| f64::from(got[i]) - want[i]));
                        worst = worst.max(error / norm(wide[band].iter().copied()));
                    }
                }
            }
        }
    }
    worst
}

/// The plans of a turn at an order: the cheapest kernels whose law and rounding together keep each error.
fn plans(turn: Job, order: usize) -> Vec<Plan> {
    let reference = exact(Job::Quaternion, order, false).code().runner();
    let mut known: HashMap<Spec, Built> = HashMap::new();
    let mut plans = Vec::new();
    for degrees in SHOWN {
        for budget in LEVELS.into_iter().rev() {
            let mut left = budget;
            let (built, operations, law, rounding) = loop {
                let (spec, operations, law) = cheapest(turn, order, &within(degrees, left));
                let built = known.entry(spec).or_insert_with_key(Built::new);
                let rounding = built.rounding_within(degrees.to_radians());
                if law + rounding <= budget || law == 0.0 {
                    break (built, operations, law, rounding);
                }
                left = budget - rounding;
            };
            plans.push(Plan {
                turn,
                order,
                degrees,
                budget,
                choice: Choice { spec: built.spec.to_string(), operations, law },
                rounding,
                measured: measured(turn, built, &reference, degrees.to_radians()),
            });
        }
    }
    plans
}

/// Every order and angle.
pub fn measure(progress: &dyn Progress) -> (Vec<Front>, Vec<Plan>) {
    let at: Vec<(usize, f64)> = ORDERS.flat_map(|order| SHOWN.map(|degrees| (order, degrees))).collect();
    let fronts = each(progress, "cost against error", &at, |(order, degrees)| front(*order, *degrees));
    let tasks: Vec<(usize, Job)> = ORDERS.flat_map(|order| TURNS.map(|turn| (order, turn))).collect();
    let mut plans = each(progress, "plans", &tasks, |(order, turn)| plans(*turn, *order)).concat();
    plans.sort_by_key(|plan| TURNS.iter().position(|turn| *turn == plan.turn));
    (fronts, plans)
}
