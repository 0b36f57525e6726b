//! Generates spherical-harmonics kernels.

pub mod sh;
