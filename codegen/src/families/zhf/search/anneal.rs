//! A try: simulated annealing from a random set, then descent. It is steered by f64 alone, by operations that give the same
//! on every machine, and decides nothing.

use super::grid::{Direction, EQUATOR, Grid, POLE};
use super::task::{SLACK, Task};
use crate::families::zhf::lobes::Mode;
use crate::math::linear::condition;
use crate::promise::samples::Random;
use std::collections::BTreeMap;
use std::rc::Rc;

/// What makes a guess in f64 a zero; it steers the search and decides nothing.
const LIKELY_ZERO: f64 = 1e-9;
/// How many moves a try makes: of one band, of the bands of an order.
const MOVES: [usize; 2] = [30_000, 60_000];
/// How many accepted moves are made on an inverse before it is computed anew.
const FRESH: usize = 60;
/// A row is not exchanged for one whose part outside of the others' span is smaller than this part of what it was.
const SMALLEST_PIVOT: f64 = 1e-3;

/// One band of a set: which directions it has, and the columns of Â one after another.
#[derive(Clone, Debug)]
struct Part {
    l: usize,
    members: Vec<usize>,
    inverse: Vec<f64>,
    nonzeros: usize,
    /// The sum of the squares of Â's entries; with Y's, which is known, it bounds the condition.
    square: f64,
}

impl Part {
    fn new(grid: &Grid, l: usize, members: Vec<usize>, pool: &[Direction]) -> Option<Self> {
        let rows: Vec<Vec<f64>> = members.iter().map(|&d| grid.row(l, &pool[d])).collect();
        let inverse = inverse(&rows)?;
        let mut part = Self { l, members, inverse, nonzeros: 0, square: 0.0 };
        part.count();
        Some(part)
    }

    fn count(&mut self) {
        let (mut nonzeros, mut square) = (0, 0.0);
        for x in &self.inverse {
            if x.abs() > LIKELY_ZERO {
                nonzeros += 1;
            }
            square += x * x;
        }
        (self.nonzeros, self.square) = (nonzeros, square);
    }

    /// The part with another row of Y; none if it were nearly dependent.
    fn with_row(&self, slot: usize, row: &[f64]) -> Option<Self> {
        let size = row.len();
        let factors: Vec<f64> = self.inverse.chunks_exact(size).map(|column| inner(column, row)).collect();
        let pivot = factors[slot];
        if pivot.abs() < SMALLEST_PIVOT {
            return None;
        }
        let mut inverse = self.inverse.clone();
        let (scale, start) = (1.0 / pivot, slot * size);
        inverse[start..start + size].iter_mut().for_each(|x| *x *= scale);
        let own = inverse[start..start + size].to_vec();
        for (d, (column, factor)) in inverse.chunks_exact_mut(size).zip(&factors).enumerate() {
            if d != slot && factor.abs() > 1e-14 {
                for (x, y) in column.iter_mut().zip(&own) {
                    *x -= factor * y;
                }
            }
        }
        let mut part = Self { l: self.l, members: self.members.clone(), inverse, nonzeros: 0, square: 0.0 };
        part.count();
        Some(part)
    }
}

fn inner(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (x, y) in a.iter().zip(b) {
        sum += x * y;
    }
    sum
}

/// The columns of the inverse of a matrix given by its rows; none if it is nearly singular.
fn inverse(rows: &[Vec<f64>]) -> Option<Vec<f64>> {
    let size = rows.len();
    let mut work: Vec<Vec<f64>> = rows
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().copied().chain((0..size).map(|j| f64::from(u8::from(i == j)))).collect())
        .collect();
    for column in 0..size {
        let pivot = (column..size).max_by(|&a, &b| work[a][column].abs().total_cmp(&work[b][column].abs()))?;
        if work[pivot][column].abs() < 1e-7 {
            return None;
        }
        work.swap(column, pivot);
        let scale = 1.0 / work[column][column];
        work[column].iter_mut().for_each(|x| *x *= scale);
        let lead = work[column].clone();
        for (i, row) in work.iter_mut().enumerate() {
            let factor = row[column];
            if i != column && factor != 0.0 {
                row.iter_mut().zip(&lead).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    Some((0..size).flat_map(|d| work.iter().map(move |row| row[size + d])).collect())
}

/// What a try takes for a set, and what f64 thinks of it.
#[derive(Clone, Debug)]
pub struct Guess {
    pub pool: Vec<Direction>,
    pub members: Vec<Vec<usize>>,
    pub nonzeros: usize,
    pub condition: f64,
}

/// The directions of a set and its bands.
#[derive(Clone, Debug)]
struct Set {
    pool: Vec<Direction>,
    parts: Vec<Rc<Part>>,
}

/// A step from one set to a neighbour.
enum Move {
    /// Another direction in a place.
    Replace(usize, Direction),
    /// Two directions exchanged: of nested sets, which take them in order.
    Exchange(usize, usize),
    /// Another direction of the pool in a slot of one part: of free sets.
    Take { part: usize, slot: usize, other: usize },
}

impl Set {
    fn nonzeros(&self) -> usize {
        self.parts.iter().map(|part| part.nonzeros).sum()
    }

    /// The square of an upper bound of the largest condition number.
    fn square(&self) -> f64 {
        self.parts.iter().map(|part| part.square * ((2 * part.l + 1) * (2 * part.l + 1)) as f64).fold(0.0, f64::max)
    }

    fn after(&self, grid: &Grid, step: &Move) -> Option<Self> {
        let mut next = self.clone();
        match *step {
            Move::Replace(place, direction) => {
                next.pool[place] = direction;
                for part in &mut next.parts {
                    if let Some(slot) = part.members.iter().position(|&d| d == place) {
                        *part = Rc::new(part.with_row(slot, &grid.row(part.l, &direction))?);
                    }
                }
            }
            Move::Exchange(a, b) => {
                next.pool.swap(a, b);
                for part in &mut next.parts {
                    let size = part.members.len();
                    let (low, high) = (a.min(b), a.max(b));
                    if high < size {
                        let (head, tail) = Rc::make_mut(part).inverse.split_at_mut(high * size);
                        head[low * size..(low + 1) * size].swap_with_slice(&mut tail[..size]);
                    } else if low < size {
                        *part = Rc::new(part.with_row(low, &grid.row(part.l, &next.pool[low]))?);
                    }
                }
            }
            Move::Take { part, slot, other } => {
                let from = &self.parts[part];
                let mut changed = from.with_row(slot, &grid.row(from.l, &self.pool[other]))?;
                changed.members[slot] = other;
                next.parts[part] = Rc::new(changed);
            }
        }
        Some(next)
    }

    /// Returns the set with its inverses computed anew, without what many changes have rounded off.
    fn fresh(&self, grid: &Grid) -> Option<Self> {
        let part = |part: &Rc<Part>| Part::new(grid, part.l, part.members.clone(), &self.pool).map(Rc::new);
        let parts: Option<Vec<Rc<Part>>> = self.parts.iter().map(part).collect();
        Some(Self { pool: self.pool.clone(), parts: parts? })
    }
}

/// The logarithm to base 2 of a positive number, by a straight line between powers of two: good enough to steer, and the
/// same on every machine.
fn rough_log2(x: f64) -> f64 {
    x.to_bits() as f64 / (1u64 << 52) as f64 - 1023.0
}

/// Random choices of a try, none of which depends on a machine.
struct Dice(Random);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        (self.0.bits() % count as u64) as usize
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// A number that is exponentially distributed, or nearly so.
    fn exponential(&mut self) -> f64 {
        let unit = ((self.0.bits() >> 11) + 1) as f64 / (1u64 << 53) as f64;
        -rough_log2(unit)
    }
}

/// What a try draws from: some of the heights and of the denominators, and how it weighs the condition.
struct Palette {
    heights: Vec<usize>,
    denominators: Vec<usize>,
    weight: f64,
    heat: f64,
}

impl Palette {
    fn new(grid: &Grid, task: &Task, dice: &mut Dice) -> Self {
        // Band 1 has no root between the pole and the equator.
        let roots: Vec<usize> = (2.min(grid.heights.len() - 1)..grid.heights.len()).collect();
        let heights = match dice.below(4) {
            0 => roots,
            _ => (0..2 + dice.below(5)).map(|_| dice.pick(&roots)).collect(),
        };
        let denominators = (0..1 + dice.below(3)).map(|_| 2 + dice.below(grid.turns.len() - 1)).collect();
        let heat = match task.mode {
            Mode::Band => [1.0, 2.0, 3.0],
            _ => [1.5, 3.0, 5.0],
        };
        Self { heights, denominators, weight: dice.pick(&[0.25, 0.5, 1.0, 2.0, 4.0]), heat: dice.pick(&heat) }
    }

    fn height(&self, dice: &mut Dice) -> usize {
        match dice.below(12) {
            0 => POLE,
            1..=4 => EQUATOR,
            _ => dice.pick(&self.heights),
        }
    }

    fn direction(&self, grid: &Grid, dice: &mut Dice) -> Direction {
        let (height, denominator) = (self.height(dice), dice.pick(&self.denominators));
        grid.direction(height, dice.below(2 * denominator), denominator)
    }

    /// Every direction.
    fn all(&self, grid: &Grid) -> Vec<Direction> {
        let mut all = vec![grid.direction(POLE, 0, 1)];
        for height in [EQUATOR].into_iter().chain(self.heights.iter().copied()) {
            for &denominator in &self.denominators {
                for numerator in 0..2 * denominator {
                    let direction = grid.direction(height, numerator, denominator);
                    if !all.contains(&direction) {
                        all.push(direction);
                    }
                }
            }
        }
        all
    }

    /// A neighbour of a direction: at the same height or at the same azimuth.
    fn near(&self, grid: &Grid, dice: &mut Dice, from: &Direction) -> Direction {
        match dice.below(2) {
            0 => grid.direction(self.height(dice), from.numerator, from.denominator),
            _ => {
                let denominator = dice.pick(&self.denominators);
                grid.direction(from.height, dice.below(2 * denominator), denominator)
            }
        }
    }

    fn energy(&self, set: &Set) -> f64 {
        set.nonzeros() as f64 + self.weight * rough_log2(set.square())
    }
}

/// A set whose first directions are independent in every band, for a start.
fn start(grid: &Grid, palette: &Palette, dice: &mut Dice) -> Option<Set> {
    let count = 2 * grid.bands.end - 1;
    let mut pool: Vec<Direction> = Vec::new();
    // An orthonormal basis of the rows so far, for each band.
    let mut spans: Vec<(usize, Vec<Vec<f64>>)> = grid.bands.clone().map(|l| (l, Vec::new())).collect();
    for _ in 0..200 * count {
        if pool.len() == count {
            break;
        }
        let direction = palette.direction(grid, dice);
        let rest = |(l, span): &(usize, Vec<Vec<f64>>)| -> Option<Vec<f64>> {
            let mut row = grid.row(*l, &direction);
            for unit in span {
                let along = inner(unit, &row);
                row.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
            }
            let length = inner(&row, &row).sqrt();
            (length > 0.02).then(|| row.iter().map(|x| x / length).collect())
        };
        let open = |(l, span): &&(usize, Vec<Vec<f64>>)| span.len() < 2 * l + 1;
        let rows: Option<Vec<Vec<f64>>> = spans.iter().filter(open).map(rest).collect();
        if let Some(rows) = rows {
            spans
                .iter_mut()
                .filter(|(l, span)| span.len() < 2 * l + 1)
                .zip(rows)
                .for_each(|((_, span), row)| span.push(row));
            pool.push(direction);
        }
    }
    if pool.len() < count {
        return None;
    }
    let part = |l: usize| Part::new(grid, l, (0..2 * l + 1).collect(), &pool).map(Rc::new);
    let parts: Option<Vec<Rc<Part>>> = grid.bands.clone().map(part).collect();
    Some(Set { parts: parts?, pool })
}

fn step(grid: &Grid, task: &Task, palette: &Palette, set: &Set, dice: &mut Dice) -> Move {
    let count = set.pool.len();
    let kind = dice.below(10);
    match task.mode {
        Mode::Nested if kind < 3 => {
            let a = dice.below(count);
            let b = (a + 1 + dice.below(count - 1)) % count;
            Move::Exchange(a, b)
        }
        // Band 0 is the same everywhere, and the last band has every direction.
        Mode::Free if kind < 5 && set.parts.len() > 2 => {
            let part = 1 + dice.below(set.parts.len() - 2);
            let members = &set.parts[part].members;
            let slot = dice.below(members.len());
            let others: Vec<usize> = (0..count).filter(|d| !members.contains(d)).collect();
            Move::Take { part, slot, other: dice.pick(&others) }
        }
        _ => {
            let place = dice.below(count);
            let direction = match kind % 2 {
                0 => palette.direction(grid, dice),
                _ => palette.near(grid, dice, &set.pool[place]),
            };
            Move::Replace(place, direction)
        }
    }
}

/// The best of a try: for each count of non-zeros the set with the smallest bound of the condition.
#[derive(Default)]
struct Front(BTreeMap<usize, (f64, Set)>);

impl Front {
    fn see(&mut self, set: &Set) {
        let (nonzeros, square) = (set.nonzeros(), set.square());
        let fewest = self.0.keys().next().copied().unwrap_or(usize::MAX);
        let far = nonzeros as f64 > fewest as f64 * SLACK;
        if far || self.0.range(..=nonzeros).any(|(_, (known, _))| *known <= square) {
            return;
        }
        self.0.insert(nonzeros, (square, set.clone()));
    }

    /// The sets with their conditions, the sparsest first; only those that no other beats.
    fn guesses(self, grid: &Grid, max_condition: f64) -> Vec<Guess> {
        let mut found: Vec<Guess> = Vec::new();
        for (nonzeros, (_, set)) in self.0 {
            let of = |part: &Rc<Part>| {
                condition(&part.members.iter().map(|&d| grid.row(part.l, &set.pool[d])).collect::<Vec<_>>())
            };
            let condition = set.parts.iter().map(of).fold(0.0, f64::max);
            if condition <= max_condition && found.iter().all(|better| better.condition > condition) {
                let members = set.parts.iter().map(|part| part.members.clone()).collect();
                found.push(Guess { pool: set.pool, members, nonzeros, condition });
            }
        }
        found
    }
}

/// One try: annealing, then descent to a set that no other direction in any place betters.
pub fn attempt(grid: &Grid, task: &Task, number: usize) -> Vec<Guess> {
    let mut dice = Dice(Random::new(u64::from(task.seed) << 32 | number as u64));
    let palette = Palette::new(grid, task, &mut dice);
    let Some(mut set) = start(grid, &palette, &mut dice) else {
        return Vec::new();
    };
    let mut front = Front::default();
    let mut energy = palette.energy(&set);
    let mut accepted = 0;
    let moves = MOVES[usize::from(task.mode != Mode::Band)];
    for i in 0..moves {
        let left = 1.0 - i as f64 / moves as f64;
        let limit = energy + palette.heat * left * left * dice.exponential();
        let step = step(grid, task, &palette, &set, &mut dice);
        let Some(next) = set.after(grid, &step) else { continue };
        let changed = palette.energy(&next);
        if changed > limit {
            continue;
        }
        (set, energy) = (next, changed);
        accepted += 1;
        if accepted % FRESH == 0 {
            match set.fresh(grid) {
                Some(fresh) => set = fresh,
                None => return front.guesses(grid, task.max_condition),
            }
        }
        front.see(&set);
    }
    let all = palette.all(grid);
    let mut better = true;
    while better {
        better = false;
        for place in 0..set.pool.len() {
            for direction in &all {
                let Some(next) = set.after(grid, &Move::Replace(place, *direction)) else { continue };
                let changed = palette.energy(&next);
                if changed < energy - 1e-6 {
                    (set, energy, better) = (next, changed, true);
                    front.see(&set);
                }
            }
        }
        match set.fresh(grid) {
            Some(fresh) => set = fresh,
            None => break,
        }
    }
    front.guesses(grid, task.max_condition)
}
