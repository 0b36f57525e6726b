//! The search for directions that rotated zonal harmonics share: from random ones, a quasi-Newton descent of the bands'
//! condition numbers (docs/MATH.md#the-search-for-directions). It takes sums, products, quotients and square roots alone, so
//! that a seed finds one set on every machine.

use crate::families::isd::directions::{Record, gram, legendre};
use crate::math::linear::right_singular;
use crate::promise::samples::Random;

/// The powers of the condition numbers that are summed, one after another: the last is close to their maximum.
const POWERS: [i32; 3] = [3, 10, 40];
/// The most steps for each power.
const STEPS: usize = 120;
/// How many earlier steps the curvature is estimated from.
const MEMORY: usize = 12;

type Vector = Vec<f64>;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn unit(v: &[f64]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    std::array::from_fn(|i| v[i] / length)
}

/// The condition number of each band from 1 on at the directions of a point, and its relative slope: d log κ, by component.
fn conditions(point: &[f64], bands: usize) -> Vec<(f64, Vector)> {
    let directions: Vec<[f64; 3]> = point.chunks(3).map(unit).collect();
    let lengths: Vec<f64> = point.chunks(3).map(|v| dot(v, v).sqrt()).collect();
    let band = |l: usize| {
        let members = &directions[..2 * l + 1];
        let found = right_singular(&gram(l, members));
        let ((most, high), (least, low)) = (&found[0], &found[found.len() - 1]);
        let mut slope = vec![0.0; point.len()];
        for (i, a) in members.iter().enumerate() {
            let mut pull = [0.0; 3];
            for (j, b) in members.iter().enumerate().filter(|(j, _)| *j != i) {
                let [_, steep] = legendre(l, dot(a, b));
                // Half of the slope of log λ, of which each pair is there twice.
                let weight = steep * (high[i] * high[j] / most - low[i] * low[j] / least);
                pull.iter_mut().zip(b).for_each(|(sum, x)| *sum += weight * x);
            }
            let along = dot(&pull, a);
            for axis in 0..3 {
                slope[3 * i + axis] = (pull[axis] - along * a[axis]) / lengths[i];
            }
        }
        ((most / least).sqrt(), slope)
    };
    (1..=bands).map(band).collect()
}

/// Σ (κ / size)^power and its slope; not finite where directions are dependent.
fn measured(point: &[f64], bands: usize, size: f64, power: i32) -> (f64, Vector) {
    let mut slope = vec![0.0; point.len()];
    let mut value = 0.0;
    for (condition, relative) in conditions(point, bands) {
        let term = (condition / size).powi(power);
        value += term;
        let factor = f64::from(power) * term;
        slope.iter_mut().zip(&relative).for_each(|(sum, x)| *sum += factor * x);
    }
    (value, slope)
}

/// Where a step leads, by the inverse curvature that earlier steps (s, y) say.
fn descent(slope: &[f64], memory: &[(Vector, Vector)]) -> Vector {
    let mut q = slope.to_vec();
    let mut factors = Vec::new();
    for (s, y) in memory.iter().rev() {
        let factor = dot(s, &q) / dot(s, y);
        q.iter_mut().zip(y).for_each(|(q, y)| *q -= factor * y);
        factors.push(factor);
    }
    if let Some((s, y)) = memory.last() {
        let scale = dot(s, y) / dot(y, y);
        q.iter_mut().for_each(|q| *q *= scale);
    }
    for ((s, y), factor) in memory.iter().zip(factors.into_iter().rev()) {
        let back = dot(y, &q) / dot(s, y);
        q.iter_mut().zip(s).for_each(|(q, s)| *q += (factor - back) * s);
    }
    q.iter_mut().for_each(|q| *q = -*q);
    q
}

fn moved(point: &[f64], step: &[f64], length: f64) -> Vector {
    point.iter().zip(step).map(|(x, d)| x + length * d).collect()
}

fn largest(point: &[f64], bands: usize) -> f64 {
    conditions(point, bands).into_iter().map(|(condition, _)| condition).fold(1.0, f64::max)
}

/// Descends until a power's steps are done or lead nowhere.
fn settled(mut point: Vector, bands: usize, power: i32) -> Vector {
    let size = largest(&point, bands);
    if !size.is_finite() {
        return point;
    }
    let (mut value, mut slope) = measured(&point, bands, size, power);
    let mut memory: Vec<(Vector, Vector)> = Vec::new();
    for _ in 0..STEPS {
        let mut step = descent(&slope, &memory);
        if dot(&step, &slope) >= 0.0 {
            memory.clear();
            step = slope.iter().map(|x| -x).collect();
        }
        // No direction moves by more than a fifth of its length.
        let longest = step.chunks(3).map(|v| dot(v, v).sqrt()).fold(0.0, f64::max);
        let mut length = if longest > 0.2 { 0.2 / longest } else { 1.0 };
        let fall = dot(&step, &slope);
        let mut next = None;
        for _ in 0..20 {
            let tried = moved(&point, &step, length);
            let (new, new_slope) = measured(&tried, bands, size, power);
            if new <= value + 1e-4 * length * fall {
                next = Some((tried, new, new_slope));
                break;
            }
            length /= 2.0;
        }
        let Some((tried, new, new_slope)) = next else { break };
        let s: Vector = tried.iter().zip(&point).map(|(a, b)| a - b).collect();
        let y: Vector = new_slope.iter().zip(&slope).map(|(a, b)| a - b).collect();
        if dot(&s, &y) > 1e-12 * dot(&y, &y) {
            memory.push((s, y));
            if memory.len() > MEMORY {
                memory.remove(0);
            }
        }
        let done = value - new <= 1e-7 * value;
        (point, value, slope) = (tried, new, new_slope);
        if done {
            break;
        }
    }
    // Lengths play no part; ones near one keep the steps alike.
    point.chunks(3).flat_map(unit).collect()
}

/// Returns the best set of so many bands that `tries` starts from a seed lead to; `step` is called after each.
///
/// # Panics
///
/// If there are no bands or no tries.
pub fn search(bands: usize, seed: u32, tries: usize, mut step: impl FnMut()) -> Record {
    assert!(bands > 0 && tries > 0, "a set has bands, a search tries");
    let attempt = |attempt: usize| {
        let mut random = Random::new(u64::from(seed) << 32 | attempt as u64);
        let mut point: Vector = (0..2 * bands + 1).flat_map(|_| random.unit::<3>()).collect();
        // Bands are added one by one: from a random start all of them at once find worse valleys.
        for bands in (2..=bands).step_by(3) {
            point = settled(point, bands, POWERS[0]);
        }
        POWERS.iter().fold(point, |point, &power| settled(point, bands, power))
    };
    let mut best: Option<(f64, Vector)> = None;
    for i in 0..tries {
        let found = attempt(i);
        let condition = largest(&found, bands);
        if best.as_ref().is_none_or(|(least, _)| condition < *least) {
            best = Some((condition, found));
        }
        step();
    }
    let (condition, point) = best.expect("at least one try");
    let directions = point.chunks(3).map(unit).collect();
    let condition = (condition * 1e4).round() / 1e4;
    Record { bands, seed: Some(seed), tries: Some(tries), condition, directions }
}

/// Adds a set to those that are kept, of each number of bands the best conditioned.
pub fn keep(all: &mut Vec<Record>, found: Record) {
    match all.iter_mut().find(|record| record.bands == found.bands) {
        Some(old) if found.condition < old.condition => *old = found,
        Some(_) => {}
        None => all.push(found),
    }
    all.sort_by_key(|record| record.bands);
}
