//! Conventions as data: in which frame, with which signs and factors and in which order a program holds coefficients, and
//! how zonal's become its own and back. docs/MATH.md#conventions-of-others derives it.

mod axes;
mod record;
mod rows;

pub use axes::{Axes, Axis};
pub use record::{Convention, Holds, Places, Scale};
pub use rows::{ALL, ZONAL};

/// The convention of a name.
pub fn named(name: &str) -> Option<&'static Convention> {
    ALL.iter().find(|convention| convention.name == name)
}

/// The names of all conventions.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|convention| convention.name).collect()
}
