//! The tests of the pictures, one module a subject, in one program.

mod bands;
mod height_field;
mod lightmap;
mod mirror;
mod pictures;
mod report;
mod visibility;
