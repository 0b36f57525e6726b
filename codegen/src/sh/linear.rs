//! The little linear algebra that errors and conditions need: singular values, by no more than products, sums, quotients
//! and square roots, so that they are the same to the last bit on every machine.

/// The singular values of a matrix given by its columns (or rows), largest first, by one-sided Jacobi rotations.
pub fn singular_values(columns: &[Vec<f64>]) -> Vec<f64> {
    let mut columns = columns.to_vec();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    for _ in 0..30 {
        let mut turned = false;
        for i in 1..columns.len() {
            let (head, tail) = columns.split_at_mut(i);
            for a in head {
                let b = &mut tail[0];
                let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
                if ab * ab <= 1e-30 * aa * bb {
                    continue;
                }
                turned = true;
                // The smaller angle that makes the two orthogonal.
                let slope = (bb - aa) / (2.0 * ab);
                let tan = slope.signum() / (slope.abs() + (1.0 + slope * slope).sqrt());
                let cos = 1.0 / (1.0 + tan * tan).sqrt();
                let sin = cos * tan;
                for (x, y) in a.iter_mut().zip(b) {
                    (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
                }
            }
        }
        if !turned {
            break;
        }
    }
    let mut sizes: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    sizes
}

/// The quotient of the largest and the smallest singular value.
pub fn condition(matrix: &[Vec<f64>]) -> f64 {
    let sizes = singular_values(matrix);
    sizes[0] / sizes[sizes.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_singular_values() {
        // A rotation times a diagonal, and a matrix of rank one.
        let (cos, sin) = (0.6, 0.8);
        let sizes = singular_values(&[vec![3.0 * cos, 3.0 * sin], vec![-2.0 * sin, 2.0 * cos]]);
        assert!((sizes[0] - 3.0).abs() < 1e-14 && (sizes[1] - 2.0).abs() < 1e-14);
        let sizes = singular_values(&[vec![1.0, 2.0], vec![2.0, 4.0]]);
        assert!((sizes[0] - 5.0).abs() < 1e-14 && sizes[1] < 1e-14);
        assert!((condition(&[vec![1.0, 1.0], vec![1.0, -1.0]]) - 1.0).abs() < 1e-14);
    }
}
