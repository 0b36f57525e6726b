//! Generates spherical-harmonics kernels.

pub mod accuracy;
pub mod built;
pub mod catalog;
pub mod emit;
#[cfg(feature = "environment")]
pub mod environment;
pub mod eval;
pub mod files;
pub mod graph;
pub mod kernel;
pub mod kernels;
pub mod listing;
pub mod samples;
pub mod sh;
pub mod spec;
pub mod validate;
