//! The search for directions of isotropic decomposition: a quasi-Newton descent of condition numbers
//! (docs/MATH.md#the-search-for-directions). Directions that bands share come from random ones, by sums, products, quotients
//! and square roots alone, so that a seed finds one set on every machine; those of levels that share none come from a spiral
//! that is shaken.

use crate::families::isd::directions::{Record, gram, legendre};
use crate::families::isd::mother::{Levels, Mother};
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

/// What is conditioned: the condition numbers at the directions of a point, and their relative slopes, d log κ by component.
type Conditions<'a> = &'a dyn Fn(&[f64]) -> Vec<(f64, Vector)>;

/// The condition number of a matrix whose columns belong to directions, from the products of its columns, and its relative slope:
/// `slope(i, j)` is that of the product of the columns i and j by the cosine between their directions.
fn conditioned(
    point: &[f64],
    directions: &[[f64; 3]],
    products: &[Vec<f64>],
    slope: impl Fn(usize, usize, f64) -> f64,
) -> (f64, Vector) {
    let found = right_singular(products);
    let ((most, high), (least, low)) = (&found[0], &found[found.len() - 1]);
    let mut slopes = vec![0.0; point.len()];
    for (i, a) in directions.iter().enumerate() {
        let mut pull = [0.0; 3];
        for (j, b) in directions.iter().enumerate().filter(|(j, _)| *j != i) {
            // Half of the slope of log λ, of which each pair is there twice.
            let weight = slope(i, j, dot(a, b)) * (high[i] * high[j] / most - low[i] * low[j] / least);
            pull.iter_mut().zip(b).for_each(|(sum, x)| *sum += weight * x);
        }
        let (along, length) = (dot(&pull, a), dot(&point[3 * i..3 * i + 3], &point[3 * i..3 * i + 3]).sqrt());
        for axis in 0..3 {
            slopes[3 * i + axis] = (pull[axis] - along * a[axis]) / length;
        }
    }
    ((most / least).sqrt(), slopes)
}

/// Those of each band from 1 on, which take the first directions.
fn of_bands(point: &[f64], bands: usize) -> Vec<(f64, Vector)> {
    let directions: Vec<[f64; 3]> = point.chunks(3).map(unit).collect();
    let band = |l: usize| {
        let members = &directions[..2 * l + 1];
        conditioned(point, members, &gram(l, members), |_, _, cosine| legendre(l, cosine)[1])
    };
    (1..=bands).map(band).collect()
}

/// That of the matrix of mother functions, of which `beta` has the coefficients of each level: the product of two columns is
/// Σ β_ll'' β_l'l'' P_l'' of the cosine between their directions, since Σ y y is (2l'' + 1)/4π P_l'' and π_l'' undoes it.
fn of_levels(point: &[f64], beta: &[Vec<f64>]) -> Vec<(f64, Vector)> {
    let directions: Vec<[f64; 3]> = point.chunks(3).map(unit).collect();
    let factors = |i: usize, j: usize| beta[i.isqrt()].iter().zip(&beta[j.isqrt()]).map(|(a, b)| a * b);
    let sum = |i: usize, j: usize, cosine: f64, part: usize| {
        factors(i, j).enumerate().map(|(l, factor)| factor * legendre(l, cosine)[part]).sum::<f64>()
    };
    let row = |i: usize| (0..directions.len()).map(move |j| (i, j));
    let product = |(i, j): (usize, usize)| sum(i, j, dot(&directions[i], &directions[j]), 0);
    let products: Vec<Vec<f64>> = (0..directions.len()).map(|i| row(i).map(product).collect()).collect();
    vec![conditioned(point, &directions, &products, |i, j, cosine| sum(i, j, cosine, 1))]
}

/// Σ (κ / size)^power and its slope; not finite where directions are dependent.
fn measured(point: &[f64], conditions: Conditions<'_>, size: f64, power: i32) -> (f64, Vector) {
    let mut slope = vec![0.0; point.len()];
    let mut value = 0.0;
    for (condition, relative) in conditions(point) {
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

fn largest(point: &[f64], conditions: Conditions<'_>) -> f64 {
    conditions(point).into_iter().map(|(condition, _)| condition).fold(1.0, f64::max)
}

/// Descends until a power's steps are done or lead nowhere.
fn settled(mut point: Vector, conditions: Conditions<'_>, power: i32) -> Vector {
    let size = largest(&point, conditions);
    if !size.is_finite() {
        return point;
    }
    let (mut value, mut slope) = measured(&point, conditions, size, power);
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
            let (new, new_slope) = measured(&tried, conditions, size, power);
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

/// The best of what tries lead to, with its condition number; `step` is called after each.
fn best_of(
    tries: usize,
    attempt: impl Fn(usize) -> Vector,
    conditions: Conditions<'_>,
    mut step: impl FnMut(),
) -> (f64, Vector) {
    let mut best: Option<(f64, Vector)> = None;
    for i in 0..tries {
        let found = attempt(i);
        let condition = largest(&found, conditions);
        if best.as_ref().is_none_or(|(least, _)| condition < *least) {
            best = Some((condition, found));
        }
        step();
    }
    best.expect("at least one try")
}

fn rounded(condition: f64) -> f64 {
    (condition * 1e4).round() / 1e4
}

/// Returns the best set of so many bands that `tries` starts from a seed lead to; `step` is called after each.
///
/// # Panics
///
/// If there are no bands or no tries.
pub fn search(bands: usize, seed: u32, tries: usize, step: impl FnMut()) -> Record {
    assert!(bands > 0 && tries > 0, "a set has bands, a search tries");
    let attempt = |attempt: usize| {
        let mut random = Random::new(u64::from(seed) << 32 | attempt as u64);
        let mut point: Vector = (0..2 * bands + 1).flat_map(|_| random.unit::<3>()).collect();
        // Bands are added one by one: from a random start all of them at once find worse valleys.
        for bands in (2..=bands).step_by(3) {
            point = settled(point, &|point: &[f64]| of_bands(point, bands), POWERS[0]);
        }
        POWERS.iter().fold(point, |point, &power| settled(point, &|point: &[f64]| of_bands(point, bands), power))
    };
    let (condition, point) = best_of(tries, attempt, &|point: &[f64]| of_bands(point, bands), step);
    let directions = point.chunks(3).map(unit).collect();
    Record { bands, mother: None, seed: Some(seed), tries: Some(tries), condition: rounded(condition), directions }
}

/// How far the spiral is shaken for each try after the first.
const SHAKEN: f64 = 0.25;

/// Returns the best set for a profile of mother functions whose levels share no directions, (L + 1)² of the whole sphere, those
/// of level l from l² on, that `tries` starts from a seed lead to; `step` is called after each. The first start is the spiral
/// itself.
///
/// # Panics
///
/// If there are no bands or no tries.
pub fn search_own(mother: Mother, bands: usize, seed: u32, tries: usize, step: impl FnMut()) -> Record {
    assert!(bands > 0 && tries > 0, "a set has bands, a search tries");
    let beta: Vec<Vec<f64>> = (0..=bands).map(|l| mother.beta(l, bands)).collect();
    let conditions = |point: &[f64]| of_levels(point, &beta);
    let spiral: Vector = Levels::dealt(bands).directions().concat().concat();
    let attempt = |attempt: usize| {
        let mut random = Random::new(u64::from(seed) << 32 | attempt as u64);
        let size = if attempt == 0 { 0.0 } else { SHAKEN };
        let point: Vector = spiral.iter().map(|x| x + size * random.signed()).collect();
        // There is one number alone: its logarithm is what a small power of it descends by.
        settled(point, &conditions, 1)
    };
    let (_, point) = best_of(tries, attempt, &conditions, step);
    // Six decimals are as good and take a third of the text.
    let directions: Vec<[f64; 3]> = point.chunks(3).map(|v| unit(v).map(|x| (x * 1e6).round() / 1e6)).collect();
    let condition = rounded(largest(&directions.concat(), &conditions));
    Record { bands, mother: Some(mother), seed: Some(seed), tries: Some(tries), condition, directions }
}

/// Adds a set to those that are kept, of each number of bands and each mother function the best conditioned.
pub fn keep(all: &mut Vec<Record>, found: Record) {
    match all.iter_mut().find(|record| (record.mother, record.bands) == (found.mother, found.bands)) {
        Some(old) if found.condition < old.condition => *old = found,
        Some(_) => {}
        None => all.push(found),
    }
    all.sort_by_key(|record| (record.mother, record.bands));
}
