//! The rotation as the papers do it, z, x, z, x, z with sparse x rotations: the baseline.

use crate::families::family::{Family, Group, Spec};
use crate::families::parts::bands::{constant_band, each_band, z_band};
use crate::families::parts::params::{quaternion, rotated, signal};
use crate::families::parts::phases::{multiples, phases_of_quaternion};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel};
use crate::math::tables;

/// `rotate:n:zxzxz`.
pub static ZXZXZ: Family = Family {
    name: "rotate",
    method: "zxzxz",
    stem: "rotate_zxzxz",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!(
            "Rotates order {order} exactly, by z, x, z, x, z with sparse x rotations (Krivanek et al. 2005): the baseline."
        )
    },
    half: false,
    kernel: |spec| zxzxz(spec.order),
    shown: |order| Spec::new(&ZXZXZ, order).both(),
    ..Family::PLAIN
};

fn x90_band(g: &mut Graph, band: &[Id], sign: i32) -> Vec<Id> {
    let out = constant_band(g, band, |l, a, b| tables::x90(l, a, b, sign));
    g.stage(&out);
    out
}

/// `rotate` as the papers do it: z, +90° about x, z, −90° about x, z, each x rotation a sparse product.
fn zxzxz(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let angles = phases_of_quaternion(g, &q);
    let [alpha, beta, gamma] = angles.map(|phase| multiples(g, phase, order - 1));
    let out = each_band(g, &c, order, |g, _, band| {
        let band = z_band(g, band, &gamma);
        // Ry(β) = Rx(−90°) Rz(β) Rx(90°).
        let band = x90_band(g, &band, 1);
        let band = z_band(g, &band, &beta);
        let band = x90_band(g, &band, -1);
        z_band(g, &band, &alpha)
    });
    rotated(builder, order, out)
}
