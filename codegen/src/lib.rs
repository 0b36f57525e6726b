//! Generates spherical-harmonics kernels.

pub mod accuracy;
pub mod builder;
pub mod built;
pub mod catalog;
pub mod diagnostic;
pub mod code;
pub mod emit;
#[cfg(feature = "environment")]
pub mod environment;
pub mod eval;
pub mod files;
pub mod graph;
pub mod kernel;
pub mod kernels;
pub mod listing;
pub mod names;
pub mod plan;
pub mod program;
pub mod samples;
pub mod scene;
pub mod sh;
pub mod spec;
pub mod validate;
