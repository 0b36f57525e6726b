//! The little linear algebra that errors and conditions need: singular values, by no more than products, sums, quotients
//! and square roots, so that they are the same to the last bit on every machine.

/// Turns columns, and what each of them carries, by one-sided Jacobi rotations until they are orthogonal.
fn orthogonalise(columns: &mut [Vec<f64>], carried: &mut [Vec<f64>]) {
    for _ in 0..30 {
        let mut turned = false;
        for i in 1..columns.len() {
            for j in 0..i {
                let (a, b) = (&columns[j], &columns[i]);
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
                for lists in [&mut *columns, &mut *carried] {
                    let (head, tail) = lists.split_at_mut(i);
                    for (x, y) in head[j].iter_mut().zip(&mut tail[0]) {
                        (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
                    }
                }
            }
        }
        if !turned {
            break;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The spectral norm of a matrix given by its columns.
pub fn spectral_norm(columns: &[Vec<f64>]) -> f64 {
    singular_values(columns)[0]
}

/// The singular values of a matrix given by its columns (or rows), largest first.
pub fn singular_values(columns: &[Vec<f64>]) -> Vec<f64> {
    let mut columns = columns.to_vec();
    let mut nothing = vec![vec![]; columns.len()];
    orthogonalise(&mut columns, &mut nothing);
    let mut sizes: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    sizes
}

/// Returns the singular values of a matrix given by its columns, largest first, each with the input of norm one that it belongs
/// to.
pub fn right_singular(columns: &[Vec<f64>]) -> Vec<(f64, Vec<f64>)> {
    let mut columns = columns.to_vec();
    let mut inputs = units(columns.len());
    orthogonalise(&mut columns, &mut inputs);
    let sizes = columns.iter().map(|column| dot(column, column).sqrt());
    let mut all: Vec<(f64, Vec<f64>)> = sizes.zip(inputs).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all
}

fn units(count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

/// The input of norm one that a matrix, given by its columns, makes largest.
pub fn largest_input(columns: &[Vec<f64>]) -> Vec<f64> {
    right_singular(columns).swap_remove(0).1
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
        assert_eq!(largest_input(&[vec![3.0 * cos, 3.0 * sin], vec![-2.0 * sin, 2.0 * cos]]), [1.0, 0.0]);
        let sizes = singular_values(&[vec![1.0, 2.0], vec![2.0, 4.0]]);
        assert!((sizes[0] - 5.0).abs() < 1e-14 && sizes[1] < 1e-14);
        let [x, y] = largest_input(&[vec![1.0, 2.0], vec![2.0, 4.0]])[..] else { panic!("two columns") };
        assert!((y - 2.0 * x).abs() < 1e-14 && (x * x + y * y - 1.0).abs() < 1e-14);
        assert!((condition(&[vec![1.0, 1.0], vec![1.0, -1.0]]) - 1.0).abs() < 1e-14);
    }
}
