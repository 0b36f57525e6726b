//! The pieces that families share: parameters, columns of the basis, polynomials and their sums, phases, rotations of one
//! band, orthogonal matrices, small angles.

pub mod bands;
pub mod bivariate;
pub mod columns;
pub mod once;
pub mod orthogonal;
pub mod params;
pub mod phases;
pub mod polynomial;
pub mod small_angle;
pub mod sums;
pub mod usual;
pub mod zonal;
