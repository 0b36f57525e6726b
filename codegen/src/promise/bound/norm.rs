//! Upper bounds of the 2-norm of a matrix. Both only ever overestimate; the last factor covers f64's own rounding.

/// Covers the f64 rounding of the sums below.
pub const SLACK: f64 = 1.0 + 1e-9;

/// A matrix by rows.
#[derive(Clone, Debug, Default)]
pub struct Matrix {
    /// How many columns it has.
    pub columns: usize,
    /// The entries, row by row.
    pub entries: Vec<f64>,
}

impl Matrix {
    /// Σ of squares, its root: at least the 2-norm.
    pub fn frobenius(&self) -> f64 {
        self.entries.iter().map(|x| x * x).sum::<f64>().sqrt() * SLACK
    }

    /// The row with this number.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// The rows, in order.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.entries.chunks_exact(self.columns)
    }

    fn transposed_times(&self, image: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (row, y) in self.rows().zip(image) {
            row.iter().zip(&mut *out).for_each(|(w, x)| *x += w * y);
        }
    }

    /// MᵀM.
    pub fn gram(&self) -> Self {
        let mut gram = vec![0.0; self.columns * self.columns];
        for row in self.rows() {
            for (i, a) in row.iter().enumerate() {
                gram[i * self.columns..(i + 1) * self.columns].iter_mut().zip(row).for_each(|(g, b)| *g += a * b);
            }
        }
        Self { columns: self.columns, entries: gram }
    }

    /// At least the 2-norm of a matrix without negative entries: for any x > 0 the largest (WᵀW x)ᵢ / xᵢ is at least the
    /// spectral radius of WᵀW (Collatz and Wielandt), and x is taken close to the eigenvector. `enough`, if the norm is
    /// seen to stay below it, is returned instead.
    pub fn weight_norm(&self, enough: f64) -> f64 {
        let frobenius = self.frobenius();
        if frobenius <= enough || !frobenius.is_finite() {
            return if frobenius.is_finite() { enough } else { frobenius };
        }
        let mut x = vec![1.0; self.columns];
        let (mut image, mut next) = (vec![0.0; self.entries.len() / self.columns], vec![0.0; self.columns]);
        let mut best = frobenius;
        for _ in 0..12 {
            for (row, y) in self.rows().zip(&mut image) {
                *y = row.iter().zip(&x).map(|(w, x)| w * x).sum();
            }
            self.transposed_times(&image, &mut next);
            let ratio = next.iter().zip(&x).map(|(y, x)| y / x).fold(0.0, f64::max);
            best = best.min(ratio.sqrt() * SLACK);
            if best <= enough {
                return enough;
            }
            let largest = next.iter().copied().fold(0.0, f64::max);
            x.iter_mut().zip(&next).for_each(|(x, y)| *x = y / largest + 1e-6);
        }
        best
    }

    /// At least the 2-norm of any matrix, exact if its rows or its columns are orthogonal: ‖(MᵀM)⁴‖ to the power 1/8, in
    /// the largest row sum, of the smaller of MᵀM and MMᵀ.
    pub fn quick_norm(&self) -> f64 {
        let rows = self.entries.len().checked_div(self.columns).unwrap_or(0);
        let mut power = if rows < self.columns { self.transposed().gram() } else { self.gram() };
        let largest = |m: &Self| m.rows().map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max);
        let (mut logarithm, mut exponent) = (0.0, 0.5);
        for squared in 0..3 {
            let size = largest(&power);
            if size == 0.0 || !size.is_finite() {
                return size;
            }
            logarithm += size.ln() * exponent;
            if squared < 2 {
                power.entries.iter_mut().for_each(|x| *x /= size);
                power = power.gram();
                exponent /= 2.0;
            }
        }
        logarithm.exp() * SLACK
    }

    fn transposed(&self) -> Self {
        let rows = self.entries.len() / self.columns;
        let entries =
            (0..self.columns).flat_map(|j| (0..rows).map(move |i| self.entries[i * self.columns + j])).collect();
        Self { columns: rows, entries }
    }

    /// At least the 2-norm of any matrix: ‖(MᵀM)^(2ᵏ)‖ to the power 2^−(k+1), in the Frobenius norm.
    pub fn norm(&self) -> f64 {
        let mut power = self.gram();
        let (mut logarithm, mut exponent) = (0.0, 0.5);
        for _ in 0..8 {
            let size = power.frobenius();
            if size == 0.0 || !size.is_finite() {
                return if size == 0.0 && logarithm == 0.0 { 0.0 } else { f64::INFINITY };
            }
            logarithm += size.ln() * exponent;
            power.entries.iter_mut().for_each(|x| *x /= size);
            // The power is symmetric, so that its Gram matrix is its square.
            power = power.gram();
            exponent /= 2.0;
        }
        (logarithm + power.frobenius().ln() * exponent).exp() * SLACK
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_above_the_norm_and_close() {
        // [[3, 4], [0, 5]] has the singular values 3√5 and √5.
        let (norm, matrix) = (3.0 * 5f64.sqrt(), Matrix { columns: 2, entries: vec![3.0, 4.0, 0.0, 5.0] });
        for bound in [matrix.norm(), matrix.weight_norm(0.0), matrix.quick_norm()] {
            assert!(bound >= norm && bound < norm * 1.05, "{bound}");
        }
        let turn = Matrix { columns: 2, entries: vec![0.6, -0.8, 0.8, 0.6] };
        assert!((turn.norm() - 1.0).abs() < 1e-2);
        assert!((turn.quick_norm() - 1.0).abs() < 1e-8);
        let zero = Matrix { columns: 2, entries: vec![0.0; 4] };
        assert_eq!((zero.norm(), zero.weight_norm(0.0), zero.quick_norm()), (0.0, 0.0, 0.0));
    }
}
