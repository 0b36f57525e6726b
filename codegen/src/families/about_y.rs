//! Approximate rotations about y by a small angle, alone and between two rotations about z. A kernel names a method for
//! every band.

use crate::families::family::{AngleAs, ByBand, Does, Family, Group, Job, Looped, Spec, Spelled, small_angle};
use crate::families::loops;
use crate::families::parts::params::{rotated, signal};
use crate::families::parts::phases::phases;
use crate::families::parts::small_angle::{Powers, SmallAngle, between_z, small_rotation, sources};
use crate::ir::graph::Id;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};

const BY_BAND: ByBand = ByBand {
    spelled: Spelled::AsFamily,
    given: AngleAs::Angle,
    in_band: |_| &SmallAngle::APPROXIMATE,
    rule: ["a rotation by an angle alone has no exact bands", "`rotate_small` has them: it knows cosine and sine"],
    plane: about_y,
};

/// `taylor1`, `taylor15`, `taylor2`, `lf3`, `lf5` and `mix`.
pub static ABOUT_Y: Family = Family {
    name: "mix",
    stem: "y",
    group: Group::SmallAngle,
    what: |spec| {
        let (order, sources) = (spec.order, sources(&spec.methods));
        format!("Rotates order {order} about y by a small angle, approximately ({sources}).")
    },
    looped: Some(Looped {
        name: "taylor15",
        has: |spec| spec.methods.iter().all(|method| *method == SmallAngle::Taylor15),
        kernel: loops::taylor15_loop,
    }),
    by_band: Some(BY_BAND),
    kernel: |spec| about_y(spec.order, &spec.methods),
    does: |_, _| vec![Does::job(Job::Y)],
    shown: |order| {
        let each = |method| Spec::new(&ABOUT_Y, order).by(method).both();
        let mut specs: Vec<Spec> = SmallAngle::APPROXIMATE.into_iter().flat_map(each).collect();
        if order == 5 {
            // The mixture of Křivánek et al. 2005.
            let mixture = [vec![SmallAngle::Taylor15; 3], vec![SmallAngle::Taylor1]].concat();
            specs.push(Spec::new(&ABOUT_Y, order).by_band(mixture));
        }
        specs.extend(Spec::new(&ABOUT_Y, order).by(SmallAngle::Taylor15).looped().both());
        specs
    },
    ..Family::PLAIN
};

/// `rotate:n:lf3` and the others.
pub static SMALL_ZYZ: Family = Family {
    name: "rotate",
    method: "mix",
    stem: "zyz",
    usual: |_, _| false,
    group: Group::SmallAngle,
    what: |spec| {
        let (order, sources) = (spec.order, sources(&spec.methods));
        format!("Rotates order {order} by z, y, z with a small y angle, approximately ({sources}).")
    },
    by_band: Some(ByBand { spelled: Spelled::AsMethod, ..BY_BAND }),
    kernel: |spec| small_zyz(spec.order, &spec.methods),
    does: |_, _| {
        const WHY: &str = "takes angles, which a normal gives by trigonometry only, none at n = z";
        vec![Does::job(Job::Zyz), Does::barred(Job::Tilt, WHY)]
    },
    shown: |order| {
        let each = |method| Spec::new(&SMALL_ZYZ, order).by(method).both();
        SmallAngle::APPROXIMATE.into_iter().flat_map(each).collect()
    },
    ..Family::PLAIN
};

fn angle(builder: &mut Builder) -> Id {
    let domain = Domain::Angle(small_angle());
    builder.param("beta", Shape::Scalar, domain, "the angle about y in radians, small")[0]
}

/// About y by β, `methods[l − 1]` for band l.
pub fn about_y(order: usize, methods: &[SmallAngle]) -> Kernel {
    let mut builder = Builder::new();
    let beta = angle(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let powers = Powers::of_angle(g, beta);
    let out = small_rotation(g, &c, order, &powers, methods);
    rotated(builder, order, out)
}

/// Rz(α) Ry(β) Rz(γ) with a small β, `methods[l − 1]` for band l.
fn small_zyz(order: usize, methods: &[SmallAngle]) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(2), Domain::Phases, "(cos, sin) of α and γ in Rz(α) Ry(β) Rz(γ)");
    let beta = angle(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let both = phases(&cs);
    let powers = Powers::of_angle(g, beta);
    let out = between_z(g, &c, order, [both[0], both[1]], &powers, methods);
    rotated(builder, order, out)
}
