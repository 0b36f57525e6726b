//! The tests of the pictures, one module a subject, in one program.

mod height_field;
mod lightmap;
mod pictures;
mod report;
mod visibility;
