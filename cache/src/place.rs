//! The frame in which light is stored at a point, and the rotation from one frame to another.

use glam::{DMat3, DQuat, DVec3};
use zonal_bake::point::Point;
use zonal_picture::vector::{across, cross};

/// A point of a surface with its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The point.
    pub point: Point,
    /// The rotation from the frame to the world.
    pub frame: DQuat,
}

impl Place {
    /// Returns a point with a frame of its own: z along its normal, x along what of the world's x is across it, so that frames
    /// turn smoothly wherever the normal is not along x.
    pub fn new(mut point: Point) -> Self {
        let normal = point.axes[2];
        let tangent = across([1.0, 0.0, 0.0], normal);
        point.axes = [tangent, cross(normal, tangent), normal];
        let [x, y, z] = point.axes.map(DVec3::from_array);
        Self { point, frame: DQuat::from_mat3(&DMat3::from_cols(x, y, z)) }
    }

    /// Returns the rotation of what is stored in another frame into this one, as (x, y, z, w).
    pub fn aligned(&self, other: &Self) -> [f32; 4] {
        (self.frame.conjugate() * other.frame).normalize().to_array().map(|x| x as f32)
    }

    /// Returns the normal.
    pub fn normal(&self) -> [f64; 3] {
        self.point.axes[2]
    }
}
