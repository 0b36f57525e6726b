//! What is promised of a kernel: seeded inputs, the rounding measured and proven and what is kept of it, the error law of approximations, and
//! a spec's kernel with all of that.

pub mod accuracy;
pub mod bound;
pub mod built;
pub mod law;
pub mod proofs;
pub mod samples;
