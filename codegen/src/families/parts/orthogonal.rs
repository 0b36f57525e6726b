//! Constant orthogonal matrices applied with the fewest operations: dense, as plane rotations by shears, as Householder
//! reflections, or, where the matrix is a symmetric involution, as three block shears
//! (docs/MATH.md#orthogonal-blocks).

use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

type Matrix = Vec<Vec<Exact>>;

/// A matrix as a product of sparse steps, first step first.
#[derive(Clone, Debug)]
struct Plan {
    steps: Vec<Stage>,
    cost: usize,
}

/// One step of a [`Plan`] on a vector that is changed in place.
#[derive(Clone, Debug)]
enum Stage {
    /// x ← M x.
    Dense(Matrix),
    /// x_to ← x_to + factor · x_from.
    Shear { to: usize, from: usize, factor: Exact },
    /// x_i ← −x_i.
    Flip(usize),
    /// x_i ↔ x_j.
    Swap(usize, usize),
    /// w = x_first + Σ v_i x_i over i > first; x_first ← x_first − β w; x_i ← x_i − β v_i w.
    Reflect { first: usize, v: Vec<Exact>, beta: Exact },
}

fn is_unit(value: &Exact) -> bool {
    value.abs().is_one()
}

fn dense_cost(matrix: &Matrix) -> usize {
    matrix
        .iter()
        .map(|row| {
            let terms = row.iter().filter(|x| !x.is_zero()).count();
            let free = row.iter().any(is_unit);
            terms - usize::from(free && terms > 0)
        })
        .sum()
}

/// A 2×2 orthogonal matrix as three shears after a signed permutation that leaves an angle of 45 degrees at most, so
/// that no factor exceeds √2/2.
fn plane(matrix: &Matrix, at: usize) -> Option<Vec<Stage>> {
    let [a, b] = [&matrix[0][0], &matrix[0][1]];
    if a.is_zero() || b.is_zero() {
        return None;
    }
    let mut steps = Vec::new();
    let (mut m, swapped) = (matrix.clone(), a.abs().to_f64() < b.abs().to_f64());
    if swapped {
        steps.push(Stage::Swap(at, at + 1));
        for row in &mut m {
            row.swap(0, 1);
        }
    }
    for column in 0..2 {
        if m[column][column].signum() < 0 {
            steps.push(Stage::Flip(at + column));
            for row in &mut m {
                row[column] = -row[column].clone();
            }
        }
    }
    let (cos, sin) = (&m[0][0], &m[1][0]);
    let lift = &(cos - &Exact::one()) / sin;
    let shear =
        |to: usize, from: usize, factor: &Exact| Stage::Shear { to: at + to, from: at + from, factor: factor.clone() };
    steps.extend([shear(0, 1, &lift), shear(1, 0, sin), shear(0, 1, &lift)]);
    Some(steps)
}

/// Householder reflections down to a plane: r² − 1 operations.
fn reflections(matrix: &Matrix) -> Option<Plan> {
    let r = matrix.len();
    let mut rest = matrix.clone();
    let mut reversed: Vec<Vec<Stage>> = Vec::new();
    for at in 0..r.saturating_sub(2) {
        let size = rest.len();
        let lead = &rest[0][0];
        let sign = if lead.signum() < 0 { Exact::int(1) } else { Exact::int(-1) };
        let divisor = lead - &sign;
        let v: Vec<Exact> = (1..size).map(|i| &rest[i][0] / &divisor).collect();
        let norm = v.iter().fold(Exact::one(), |sum, x| &sum + &(x * x));
        let beta = &Exact::int(2) / &norm;
        let column = |j: usize, i: usize| -> Exact {
            let w = (1..size).fold(rest[0][j].clone(), |sum, k| &sum + &(&v[k - 1] * &rest[k][j]));
            &rest[i][j] - &(&(&beta * &v[i - 1]) * &w)
        };
        let below: Matrix = (1..size).map(|i| (1..size).map(|j| column(j, i)).collect()).collect();
        let mut steps = Vec::new();
        if sign.signum() < 0 {
            steps.push(Stage::Flip(at));
        }
        steps.push(Stage::Reflect { first: at, v, beta });
        reversed.push(steps);
        rest = below;
    }
    let mut steps = plane(&rest, r - 2)?;
    steps.extend(reversed.into_iter().rev().flatten());
    Some(Plan { steps, cost: r * r - 1 })
}

fn inverse(matrix: &Matrix) -> Option<Matrix> {
    let n = matrix.len();
    let mut rows: Matrix = (0..n)
        .map(|i| {
            let unit = (0..n).map(|j| Exact::int(i64::from(i == j)));
            matrix[i].iter().cloned().chain(unit).collect()
        })
        .collect();
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| {
            let size = |row: usize| rows[row][column].abs().to_f64();
            size(a).total_cmp(&size(b))
        })?;
        if rows[pivot][column].is_zero() {
            return None;
        }
        rows.swap(column, pivot);
        let lead = rows[column][column].clone();
        for value in &mut rows[column] {
            *value = &*value / &lead;
        }
        for row in (0..n).filter(|&row| row != column) {
            let factor = rows[row][column].clone();
            if factor.is_zero() {
                continue;
            }
            for j in 0..2 * n {
                let change = &factor * &rows[column][j];
                rows[row][j] = &rows[row][j] - &change;
            }
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}

/// Every choice of `q` out of `0..r`.
fn choices(r: usize, q: usize) -> Vec<Vec<usize>> {
    (0u32..1 << r)
        .filter(|bits| bits.count_ones() as usize == q)
        .map(|bits| (0..r).filter(|i| bits >> i & 1 == 1).collect())
        .collect()
}

/// A symmetric involution with q eigenvalues −1 as three block shears, 3 q (r − q) operations: with A, B, C, D its
/// blocks, X = (A − 1) C⁺ and Z = X D − B, it is (1 X; 0 1)(1 0; C 1)(1 Z; 0 1) diag(1, −1).
fn involution(matrix: &Matrix) -> Option<Plan> {
    let r = matrix.len();
    let symmetric = (0..r).all(|i| (0..i).all(|j| matrix[i][j] == matrix[j][i]));
    if !symmetric || r < 3 {
        return None;
    }
    let trace: f64 = (0..r).map(|i| matrix[i][i].to_f64()).sum();
    let minus = ((r as f64 - trace) / 2.0).round() as usize;
    let negate = 2 * minus > r;
    let q = if negate { r - minus } else { minus };
    let source: Matrix = if negate {
        matrix.iter().map(|row| row.iter().map(|x| -x.clone()).collect()).collect()
    } else {
        matrix.clone()
    };
    let best = choices(r, q)
        .into_iter()
        .filter_map(|second| block_shears(&source, &second))
        .min_by(|a, b| (a.0.cost, a.1).partial_cmp(&(b.0.cost, b.1)).expect("costs and sizes are numbers"))?;
    let mut plan = best.0;
    if negate {
        plan.steps.extend((0..r).map(Stage::Flip));
    }
    Some(plan)
}

/// The three shears for one choice of the second block, and their largest factor.
fn block_shears(matrix: &Matrix, second: &[usize]) -> Option<(Plan, f64)> {
    let r = matrix.len();
    let first: Vec<usize> = (0..r).filter(|i| !second.contains(i)).collect();
    let block = |rows: &[usize], columns: &[usize]| -> Matrix {
        rows.iter().map(|&i| columns.iter().map(|&j| matrix[i][j].clone()).collect()).collect()
    };
    let (a, b) = (block(&first, &first), block(&first, second));
    let (c, d) = (block(second, &first), block(second, second));
    let product = |x: &Matrix, y: &Matrix| -> Matrix {
        x.iter()
            .map(|row| {
                (0..y[0].len())
                    .map(|j| row.iter().zip(y).fold(Exact::zero(), |sum, (p, q)| &sum + &(p * &q[j])))
                    .collect()
            })
            .collect()
    };
    let transposed: Matrix = (0..first.len()).map(|j| c.iter().map(|row| row[j].clone()).collect()).collect();
    let gram = inverse(&product(&c, &transposed))?;
    let less_one: Matrix = a
        .iter()
        .enumerate()
        .map(|(i, row)| {
            let entry = |(j, x): (usize, &Exact)| if i == j { x - &Exact::one() } else { x.clone() };
            row.iter().enumerate().map(entry).collect()
        })
        .collect();
    let x = product(&product(&less_one, &transposed), &gram);
    let z: Matrix =
        product(&x, &d).iter().zip(&b).map(|(p, q)| p.iter().zip(q).map(|(p, q)| p - q).collect()).collect();
    let mut steps: Vec<Stage> = second.iter().map(|&i| Stage::Flip(i)).collect();
    let (mut cost, mut largest) = (0, 0f64);
    for (rows, columns, factors) in [(&first[..], second, &z), (second, &first[..], &c), (&first[..], second, &x)] {
        for (&to, row) in rows.iter().zip(factors) {
            for (&from, factor) in columns.iter().zip(row) {
                if factor.is_zero() {
                    continue;
                }
                cost += 1;
                largest = largest.max(factor.abs().to_f64());
                steps.push(Stage::Shear { to, from, factor: factor.clone() });
            }
        }
    }
    // Large factors cost accuracy: they are left to the other forms.
    (largest <= 1.5).then_some((Plan { steps, cost }, largest))
}

fn plan(matrix: &Matrix) -> Plan {
    let dense = Plan { steps: vec![Stage::Dense(matrix.clone())], cost: dense_cost(matrix) };
    let others = [(matrix.len() >= 2).then(|| reflections(matrix)).flatten(), involution(matrix)];
    others.into_iter().flatten().fold(dense, |best, other| if other.cost < best.cost { other } else { best })
}

/// How many operations [`apply`] takes for this matrix.
pub fn cost(matrix: &[Vec<Exact>]) -> usize {
    plan(&matrix.to_vec()).cost
}

/// M x for an orthogonal M of exact entries.
pub fn apply(g: &mut Graph, matrix: &[Vec<Exact>], x: &[Id]) -> Vec<Id> {
    let mut x = x.to_vec();
    for stage in plan(&matrix.to_vec()).steps {
        match stage {
            Stage::Dense(matrix) => x = matrix.iter().map(|row| g.dot(row, &x)).collect(),
            Stage::Shear { to, from, factor } => x[to] = g.scale_add(&factor, x[from], x[to]),
            Stage::Flip(i) => x[i] = g.neg(x[i]),
            Stage::Swap(i, j) => x.swap(i, j),
            Stage::Reflect { first, v, beta } => {
                let mut w = x[first];
                for (factor, &value) in v.iter().zip(&x[first + 1..]) {
                    w = g.scale_add(factor, value, w);
                }
                let minus = -beta.clone();
                x[first] = g.scale_add(&minus, w, x[first]);
                for (i, factor) in v.iter().enumerate() {
                    x[first + 1 + i] = g.scale_add(&(&minus * factor), w, x[first + 1 + i]);
                }
            }
        }
    }
    x
}

/// The transposed matrix.
pub fn transpose(matrix: &[Vec<Exact>]) -> Matrix {
    (0..matrix.first().map_or(0, Vec::len)).map(|j| matrix.iter().map(|row| row[j].clone()).collect()).collect()
}
