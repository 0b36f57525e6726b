//! The rotation of a zonal signal: its axis goes from z to a direction.

use crate::families::family::{Family, Group, Spec};
use crate::families::parts::columns;
use crate::families::parts::params::rotated;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};

/// `rotate:n:zonal`.
pub static ZONAL: Family = Family {
    name: "rotate",
    method: "zonal",
    stem: "rotate_zonal",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!("Rotates a zonal signal of order {order} exactly so that its axis goes from z to a direction.")
    },
    kernel: |spec| zonal(spec.order),
    shown: |order| Spec::new(&ZONAL, order).both(),
    ..Family::PLAIN
};

/// `rotate` of a zonal signal's axis from z to a direction: c_lm = √(4π / (2l + 1)) g_l y_lm(dir).
fn zonal(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Vec3, Domain::Direction, "where the axis goes, of unit length");
    let c = builder.param("c", Shape::Array(order), Domain::Signal, "the zonal coefficients, one a band");
    let g = &mut builder.graph;
    let y = columns::values(g, &dir, order, columns::zonal);
    let out = (0..order).flat_map(|l| std::iter::repeat_n(c[l], 2 * l + 1)).zip(y).map(|(c, y)| g.mul(c, y)).collect();
    rotated(builder, order, out)
}
