//! The rotation of z to a normal with the spin about it left open.

use crate::families::family::{Does, Family, Group, Job, Spec};
use crate::families::parts::bands::{each_band, y_band, z_band};
use crate::families::parts::params::{normal, rotated, signal};
use crate::families::parts::phases::{multiples, phases_of_normal, y_phases};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel};

/// `rotate:n:align`.
pub static ALIGN: Family = Family {
    name: "rotate",
    method: "align",
    stem: "rotate_align",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        format!("Rotates order {} exactly so that z goes to a normal, the spin about it left open.", spec.order)
    },
    half: false,
    kernel: |spec| align(spec.order),
    does: |_, _| vec![Does::barred(Job::Tilt, "leaves the spin about the normal open")],
    shown: |order| Spec::new(&ALIGN, order).both(),
    ..Family::PLAIN
};

/// `rotate` of the z axis to a normal where the spin about it is irrelevant: y, then z.
fn align(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let n = normal(&mut builder, Domain::Normal);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let [phi, theta] = phases_of_normal(g, &n);
    let (phi, theta) = (multiples(g, phi, order - 1), y_phases(g, theta, order - 1));
    let out = each_band(g, &c, order, |g, _, band| {
        let band = y_band(g, band, &theta);
        z_band(g, &band, &phi)
    });
    rotated(builder, order, out)
}
