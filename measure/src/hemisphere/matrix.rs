//! Dense matrices in f64, as much of them as rotations on the hemisphere need.

/// A matrix, by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// The matrix of a function of row and column.
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let entries = (0..rows * columns).map(|i| entry(i / columns, i % columns)).collect();
        Self { rows, columns, entries }
    }

    /// The matrix that changes nothing.
    pub fn identity(size: usize) -> Self {
        Self::from_fn(size, size, |i, j| f64::from(u8::from(i == j)))
    }

    /// An entry.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * self.columns + column]
    }

    /// A row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The first rows and columns.
    pub fn corner(&self, rows: usize, columns: usize) -> Self {
        Self::from_fn(rows, columns, |i, j| self.at(i, j))
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |i, j| self.at(j, i))
    }

    /// The product with another, of as many rows as this has columns.
    pub fn times(&self, other: &Self) -> Self {
        let mut entries = vec![0.0; self.rows * other.columns];
        for (row, sums) in entries.chunks_mut(other.columns).enumerate() {
            for (factor, with) in self.row(row).iter().zip(other.entries.chunks(other.columns)) {
                if *factor != 0.0 {
                    sums.iter_mut().zip(with).for_each(|(sum, x)| *sum += factor * x);
                }
            }
        }
        Self { rows: self.rows, columns: other.columns, entries }
    }

    /// The product with a vector.
    pub fn apply(&self, vector: &[f64]) -> Vec<f64> {
        self.entries.chunks(self.columns).map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
    }

    /// a times this and b times another of the same size, added.
    pub fn mixed(&self, a: f64, other: &Self, b: f64) -> Self {
        let entries = self.entries.iter().zip(&other.entries).map(|(x, y)| a * x + b * y).collect();
        Self { entries, ..*self }
    }

    /// The exponential: a Taylor series of the matrix halved until it is small, and squared as often.
    pub fn exp(&self) -> Self {
        let size = self.entries.chunks(self.columns).map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
        let halvings = size.fold(0.0, f64::max).max(0.25).log2().ceil().max(-2.0) as i32 + 2;
        let small = self.mixed(0.5f64.powi(halvings), self, 0.0);
        let one = Self::identity(self.rows);
        let series = (1..=14).rev().fold(one.clone(), |sum, k| one.mixed(1.0, &small.times(&sum), 1.0 / f64::from(k)));
        (0..halvings).fold(series, |power, _| power.times(&power))
    }

    /// This times the inverse of a symmetric positive definite matrix, by the latter's Cholesky factor.
    pub fn over(&self, definite: &Self) -> Self {
        let n = definite.rows;
        let mut factor = vec![vec![0.0; n]; n];
        for i in 0..n {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
                let rest = definite.at(i, j) - known;
                factor[i][j] = if i == j { rest.sqrt() } else { rest / factor[j][j] };
            }
        }
        let mut entries = self.entries.clone();
        for row in entries.chunks_mut(n) {
            for i in 0..n {
                let known: f64 = (0..i).map(|k| factor[i][k] * row[k]).sum();
                row[i] = (row[i] - known) / factor[i][i];
            }
            for i in (0..n).rev() {
                let known: f64 = (i + 1..n).map(|k| factor[k][i] * row[k]).sum();
                row[i] = (row[i] - known) / factor[i][i];
            }
        }
        Self { entries, ..*self }
    }
}

/// The length of a vector.
pub fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// How far a vector is from another, relative to the latter's length.
pub fn relative(got: &[f64], want: &[f64]) -> f64 {
    let difference: Vec<f64> = got.iter().zip(want).map(|(a, b)| a - b).collect();
    norm(&difference) / norm(want)
}
