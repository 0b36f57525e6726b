//! A camera that looks at the origin, z up: its matrix for shaders, and the direction that a pixel looks in.

use super::vector::{add, cross, dot, unit};
pub use zonal_codegen::scene::picture::Camera;

/// A camera at work.
pub trait View {
    /// Where the camera is.
    fn eye(&self) -> [f64; 3];

    /// Unit vectors to the right, up and backwards, towards the camera.
    fn axes(&self) -> [[f64; 3]; 3];

    /// The matrix, by columns, that takes a point (x, y, z, 1) to clip space, with depths from 0 to 1; `aspect` is
    /// width over height.
    fn matrix(&self, aspect: f64) -> [[f64; 4]; 4];

    /// The unit direction that a place in the picture looks in: x to the right and y up, from −1 to 1.
    fn direction(&self, x: f64, y: f64, aspect: f64) -> [f64; 3];
}

impl View for Camera {
    fn eye(&self) -> [f64; 3] {
        let (sin, cos) = self.azimuth.to_radians().sin_cos();
        let (up, out) = self.elevation.to_radians().sin_cos();
        [out * cos, out * sin, up].map(|x| x * self.distance)
    }

    fn axes(&self) -> [[f64; 3]; 3] {
        let back = self.eye().map(|x| x / self.distance);
        let right = unit(cross([0.0, 0.0, 1.0], back)).unwrap_or([0.0, 1.0, 0.0]);
        [right, cross(back, right), back]
    }

    fn matrix(&self, aspect: f64) -> [[f64; 4]; 4] {
        let [right, up, back] = self.axes();
        let eye = self.eye();
        let scale = 1.0 / (0.5 * self.field.to_radians()).tan();
        // What can be seen lies in a sphere a little larger than the unit sphere.
        let (near, far) = ((self.distance - 1.1).max(0.01), self.distance + 1.1);
        let row = |axis: [f64; 3]| [axis[0], axis[1], axis[2], -dot(axis, eye)];
        let (x, y, z) = (row(right), row(up), row(back));
        let column = |i: usize| {
            let constant = if i == 3 { near * far / (near - far) } else { 0.0 };
            [scale / aspect * x[i], scale * y[i], far / (near - far) * z[i] + constant, -z[i]]
        };
        [0, 1, 2, 3].map(column)
    }

    fn direction(&self, x: f64, y: f64, aspect: f64) -> [f64; 3] {
        let [right, up, back] = self.axes();
        let tangent = (0.5 * self.field.to_radians()).tan();
        let sideways = add(right.map(|v| v * tangent * aspect * x), tangent * y, up);
        unit(add(sideways, -1.0, back)).unwrap_or(back)
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::length;
    use super::*;

    #[test]
    fn points_along_a_pixel_s_direction_land_on_the_pixel() {
        let camera = Camera { azimuth: 40.0, elevation: -20.0, distance: 3.0, field: 45.0 };
        let matrix = camera.matrix(1.5);
        for [x, y, t] in [[0.0, 0.0, 3.0], [0.3, -0.7, 2.5], [-0.9, 0.8, 3.9]] {
            let point = add(camera.eye(), t, camera.direction(x, y, 1.5));
            let p = [point[0], point[1], point[2], 1.0];
            let clip: [f64; 4] = std::array::from_fn(|i| (0..4).map(|j| matrix[j][i] * p[j]).sum());
            assert!((clip[0] / clip[3] - x).abs() < 1e-12 && (clip[1] / clip[3] - y).abs() < 1e-12, "{clip:?}");
            assert!((0.0..1.0).contains(&(clip[2] / clip[3])), "{clip:?}");
        }
        assert!((length(camera.eye()) - 3.0).abs() < 1e-12);
    }
}
