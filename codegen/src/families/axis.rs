//! Rotations about one axis: z, y by an angle, x by a quarter turn, and the exchange of y and z.

use crate::families::family::{Does, Family, Job, Spec};
use crate::families::parts::bands::{constant_band, each_band, y_band, z_band};
use crate::families::parts::params::{rotated, signal};
use crate::families::parts::phases::{multiples, phases, y_phases};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::tables;

/// `rotate_z`.
pub static ROTATE_Z: Family = Family {
    name: "rotate_z",
    stem: "rotate_z",
    what: |spec| format!("Rotates order {} about z by the angle of (cos, sin).", spec.order),
    kernel: |spec| rotate_z(spec.order),
    shown: |order| Spec::new(&ROTATE_Z, order).both(),
    ..Family::PLAIN
};

/// `rotate_y`.
pub static ROTATE_Y: Family = Family {
    name: "rotate_y",
    stem: "rotate_y",
    what: |spec| {
        format!("Rotates order {} about y by the angle of (cos, sin), exactly and at every angle.", spec.order)
    },
    kernel: |spec| rotate_y(spec.order),
    does: |_, _| vec![Does::job(Job::Y)],
    shown: |order| Spec::new(&ROTATE_Y, order).both(),
    ..Family::PLAIN
};

/// `swap_yz`.
pub static SWAP_YZ: Family = Family {
    name: "swap_yz",
    stem: "swap_yz",
    what: |spec| format!("Exchanges y and z of order {}: the sparse symmetric matrix J, a reflection.", spec.order),
    kernel: |spec| swap_yz(spec.order),
    shown: |order| Spec::new(&SWAP_YZ, order).both(),
    ..Family::PLAIN
};

/// `rotate_x_plus_90`.
pub static ROTATE_X_PLUS_90: Family = Family {
    name: "rotate_x_plus_90",
    stem: "rotate_x_plus_90deg",
    what: |spec| format!("Rotates order {} about x by +90 degrees, a sparse matrix.", spec.order),
    kernel: |spec| rotate_x_90(spec.order, 1),
    shown: |order| Spec::new(&ROTATE_X_PLUS_90, order).both(),
    ..Family::PLAIN
};

/// `rotate_x_minus_90`.
pub static ROTATE_X_MINUS_90: Family = Family {
    name: "rotate_x_minus_90",
    stem: "rotate_x_minus_90deg",
    what: |spec| format!("Rotates order {} about x by -90 degrees, a sparse matrix.", spec.order),
    kernel: |spec| rotate_x_90(spec.order, -1),
    shown: |order| Spec::new(&ROTATE_X_MINUS_90, order).both(),
    ..Family::PLAIN
};

/// The kernel `rotate_z`: about z by the angle of (cos α, sin α).
fn rotate_z(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Domain::Phases, "(cos α, sin α)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let alpha = multiples(g, phases(&cs)[0], order - 1);
    let out = each_band(g, &c, order, |g, _, band| z_band(g, band, &alpha));
    rotated(builder, order, out)
}

/// The kernel `rotate_y`: about y by the angle of (cos β, sin β), exactly.
pub fn rotate_y(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Domain::Phases, "(cos β, sin β)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let beta = y_phases(g, phases(&cs)[0], order - 1);
    let out = each_band(g, &c, order, |g, _, band| y_band(g, band, &beta));
    rotated(builder, order, out)
}

fn constant_rotation(order: usize, entry: impl Fn(usize, isize, isize) -> Exact) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let out = each_band(&mut builder.graph, &c, order, |g, _, band| constant_band(g, band, &entry));
    rotated(builder, order, out)
}

/// The kernel `swap_yz`: the sparse symmetric matrix J that exchanges y and z (a reflection).
fn swap_yz(order: usize) -> Kernel {
    constant_rotation(order, tables::swap_yz)
}

/// The kernels `rotate_x_plus_90` and `rotate_x_minus_90`.
fn rotate_x_90(order: usize, sign: i32) -> Kernel {
    constant_rotation(order, |l, a, b| tables::x90(l, a, b, sign))
}
