//! The tests of the pictures, one module a subject, in one program.

mod lightmap;
mod pictures;
mod report;
mod visibility;
