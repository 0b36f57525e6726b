//! Isotropic decomposition (Soler et al. 2015): a band as a sum of 2l + 1 copies of a zonal function about directions that
//! all bands share, what that makes of shading, and the same shading without it (docs/MATH.md#isotropic-decomposition).
//! All of it is I = c · D(R) e, for coefficients c of a reflectance in the frame of the surface and e of the light in the
//! world, of which R takes the one to the other.

pub mod decomposition;
pub mod direct;
pub mod directions;
pub mod mother;
pub mod mothers;
pub mod paper;
pub mod search;

use crate::families::family::{Acts, Family, Group, Measure};
use crate::families::parts::quaternion::matrix_of_quaternion;
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Shape};

/// What the kernels that shade have in common.
const SHADING: Family =
    Family { group: Group::Shade, measure: Measure::Product, acts: Acts::Mixes, half: false, ..Family::PLAIN };

/// Declares the rotation of the world to the local frame.
fn to_local(builder: &mut Builder) -> Vec<Id> {
    let doc = "the rotation R of the world to the local frame, a unit quaternion (x, y, z, w)";
    builder.param("q", Shape::Vec4, Domain::Quaternion, doc)
}

/// Declares the light as coefficients in the world.
fn light(builder: &mut Builder, order: usize) -> Vec<Id> {
    let doc = "the coefficients of the light in the world, index l(l+1)+m";
    builder.param("e", Shape::Array(order * order), Domain::Signal, doc)
}

/// Declares the rotation and the light, and returns the light's coefficients and the rotation of the local frame back to the
/// world, by its rows.
fn light_and_back(builder: &mut Builder, order: usize) -> (Vec<Id>, [[Id; 3]; 3]) {
    let q = to_local(builder);
    let e = light(builder, order);
    let rows = matrix_of_quaternion(&mut builder.graph, &q);
    // The inverse's rows are the columns.
    (e, std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i])))
}

/// Declares a light that is a zonal function about a direction.
fn zonal_light(builder: &mut Builder, order: usize) -> [Vec<Id>; 2] {
    let doc = "the direction of the light in the world, of unit length";
    let dir = builder.param("dir", Shape::Vec3, Domain::Direction, doc);
    let doc = "the zonal coefficients of the light, one a band and for all channels; its colour multiplies the result";
    [dir, builder.param("g", Shape::Array(order), Domain::Grey, doc)]
}

/// What a kernel that shades returns.
const SHADED: &str = "the integral of the light times the reflectance";
