//! Generates spherical-harmonics kernels.

#[cfg(feature = "environment")]
pub mod environment;
pub mod eval;
pub mod graph;
pub mod kernel;
pub mod kernels;
pub mod listing;
pub mod sh;
