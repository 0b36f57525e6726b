//! Products of functions on the sphere.

pub mod cover;
pub mod plan;
pub mod rings;
pub mod search;
pub mod wave;
