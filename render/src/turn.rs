//! Frames as rotations: what kernels take where a surface lies in the world. It knows nothing of light.

use zonal_picture::vector::{across, cross};

/// Returns the unit quaternion (x, y, z, w) of a rotation matrix given by its rows.
pub fn quaternion([x, y, z]: [[f64; 3]; 3]) -> [f64; 4] {
    let trace = x[0] + y[1] + z[2];
    let apart = [z[1] - y[2], x[2] - z[0], y[0] - x[1]];
    // The largest component is computed first, so that nothing is divided by what vanishes.
    let q = if trace > 0.0 {
        [apart[0], apart[1], apart[2], 1.0 + trace]
    } else if x[0] >= y[1] && x[0] >= z[2] {
        [1.0 + x[0] - y[1] - z[2], x[1] + y[0], x[2] + z[0], apart[0]]
    } else if y[1] >= z[2] {
        [x[1] + y[0], 1.0 - x[0] + y[1] - z[2], y[2] + z[1], apart[1]]
    } else {
        [x[2] + z[0], y[2] + z[1], 1.0 - x[0] - y[1] + z[2], apart[2]]
    };
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    q.map(|v| v / length)
}

/// Returns the axes of the frame in which isotropic reflectances are symmetric: z the unit normal, x across it to the side of
/// the unit view.
pub fn facing(view: [f64; 3], normal: [f64; 3]) -> [[f64; 3]; 3] {
    let x = across(view, normal);
    [x, cross(normal, x), normal]
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::{Random, matrix_of};
    use zonal_picture::vector::dot;

    #[test]
    fn a_quaternion_is_that_of_its_matrix() {
        let mut random = Random::new(4);
        let special = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        for q in special.into_iter().chain((0..200).map(|_| random.unit::<4>())) {
            let m = matrix_of(q);
            let found = quaternion([0, 1, 2].map(|i| [0, 1, 2].map(|j| m[3 * j + i])));
            let same: f64 = q.iter().zip(found).map(|(a, b)| a * b).sum();
            assert!((same.abs() - 1.0).abs() < 1e-12, "{q:?} {found:?}");
        }
    }

    #[test]
    fn a_view_lies_in_the_plane_of_x_and_z() {
        let mut random = Random::new(5);
        for _ in 0..50 {
            let (view, normal) = (random.unit::<3>(), random.unit::<3>());
            let axes = facing(view, normal);
            assert!(dot(axes[1], view).abs() < 1e-12 && dot(axes[0], view) >= 0.0);
            assert!(dot(cross(axes[0], axes[1]), axes[2]) > 1.0 - 1e-12);
        }
        // Straight from above any frame serves.
        let axes = facing([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        assert!(dot(axes[0], axes[2]).abs() < 1e-12);
    }
}
