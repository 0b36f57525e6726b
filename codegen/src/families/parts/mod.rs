//! The pieces that families share: parameters, columns of the basis, polynomials and their sums, phases, rotations of one
//! band, orthogonal matrices, small angles, derivatives.

pub mod bands;
pub mod bivariate;
pub mod columns;
pub mod derivative;
pub mod form;
pub mod legendre;
pub mod once;
pub mod orthogonal;
pub mod params;
pub mod phases;
pub mod polynomial;
pub mod quaternion;
pub mod small_angle;
pub mod sums;
pub mod turned;
pub mod usual;
pub mod zonal;
