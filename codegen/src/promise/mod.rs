//! What is promised of a kernel: seeded inputs, the rounding measured and proven and what is kept of it, the error law of
//! approximations, what rotations on the hemisphere err by, and a spec's kernel with all of that.

pub mod accuracy;
pub mod bound;
pub mod built;
pub mod hemisphere;
pub mod law;
pub mod proofs;
pub mod registers;
pub mod samples;
