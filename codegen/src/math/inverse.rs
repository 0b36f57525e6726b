//! The inverse of a matrix of reals of 512 bits, by elimination with the largest pivot of each column.

use super::exact::Real;

/// Returns the inverse of a square matrix given by its rows; none if it is not square, or singular to 400 bits.
pub fn inverse(rows: &[Vec<Real>]) -> Option<Vec<Vec<Real>>> {
    let n = rows.len();
    if rows.iter().any(|row| row.len() != n) {
        return None;
    }
    let unit = |i: usize| (0..n).map(move |j| Real::from_ratio(i64::from(i == j), 1));
    let mut rows: Vec<Vec<Real>> =
        rows.iter().enumerate().map(|(i, row)| row.iter().cloned().chain(unit(i)).collect()).collect();
    for column in 0..n {
        let pivot = (column..n).max_by_key(|&i| rows[i][column].abs())?;
        if rows[pivot][column].is_negligible() {
            return None;
        }
        rows.swap(column, pivot);
        let inverse = Real::from_ratio(1, 1) / &rows[column][column];
        let lead: Vec<Real> = rows[column].iter().map(|x| x * &inverse).collect();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[column].clone();
            if i == column {
                row.clone_from(&lead);
            } else if !factor.is_negligible() {
                for (x, y) in row.iter_mut().zip(&lead).skip(column) {
                    *x = &*x - &factor * y;
                }
            }
        }
    }
    Some(rows.into_iter().map(|mut row| row.split_off(n)).collect())
}
