//! The tests of the radiance cache, one module a subject, in one program.

mod cache;
mod gradients;
mod page;
mod rotations;
