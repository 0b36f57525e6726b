//! The pieces that families share: parameters, columns of the basis, phases, rotations of one band, orthogonal matrices, small angles.

pub mod bands;
pub mod columns;
pub mod orthogonal;
pub mod params;
pub mod phases;
pub mod small_angle;
pub mod sums;
pub mod usual;
pub mod zonal;
