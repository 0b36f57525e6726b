//! The parameters that families share, each with its domain, and the end of a rotation's kernel.

use crate::ir::graph::Id;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};

/// Declares the signal `c` of n² coefficients.
pub fn signal(builder: &mut Builder, order: usize) -> Vec<Id> {
    builder.param("c", Shape::Array(order * order), Domain::Signal, "the coefficients, index l(l+1)+m")
}

/// Declares the unit quaternion `q` of a domain of rotations.
pub fn quaternion(builder: &mut Builder, domain: Domain) -> Vec<Id> {
    builder.param("q", Shape::Vec4, domain, "the rotation, a unit quaternion (x, y, z, w)")
}

/// Declares the unit normal `n` of a domain of normals.
pub fn normal(builder: &mut Builder, domain: Domain) -> Vec<Id> {
    builder.param("n", Shape::Vec3, domain, "where the z axis goes, of unit length")
}

/// Declares a unit normal of another name, and says what it is.
pub fn normal_as(builder: &mut Builder, name: &'static str, doc: &str) -> Vec<Id> {
    builder.param(name, Shape::Vec3, Domain::Normal, doc)
}

/// Declares the direction `dir`.
pub fn direction(builder: &mut Builder) -> Vec<Id> {
    builder.param("dir", Shape::Vec3, Domain::Direction, "the direction, of unit length")
}

/// Declares the rotation matrix `m`.
pub fn matrix(builder: &mut Builder) -> Vec<Id> {
    builder.param("m", Shape::Mat3, Domain::Rotation, "the rotation, a matrix of three columns")
}

/// The kernel whose result are rotated coefficients.
pub fn rotated(builder: Builder, order: usize, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}
