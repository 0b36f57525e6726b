//! The exact rotation by z, y, z: the y rotation of a band splits into chains of even and odd m, each of which a constant
//! orthogonal matrix turns into plane rotations by multiples of the angle (docs/MATH.md#the-exact-y-rotation). From a
//! quaternion, from three angles, and from all their multiples, which `angles` makes once for many signals.

use crate::families::family::{Does, Family, Group, Job, Looped, Measure, Spec};
use crate::families::loops;
use crate::families::parts::bands::{zyz_apply, zyz_from_quaternion};
use crate::families::parts::params::{quaternion, rotated, signal};
use crate::families::parts::phases::{Euler, Phase, YPhases, euler, phases, phases_of_quaternion};
use crate::families::parts::usual::{FROM_QUATERNION, is_tensor};
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::ir::kernel::{Domain, Held, Made, OfAngle};

/// `rotate:n:zyz`, from order 4 on `rotate:n`.
pub static ZYZ: Family = Family {
    name: "rotate",
    method: "zyz",
    stem: "rotate_zyz",
    usual: |order, rgb| !is_tensor(order, rgb),
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!("Rotates order {order} exactly, by z, y, z from a quaternion: no trigonometry, no branch, every angle.")
    },
    half: false,
    looped: Some(Looped { name: "rotate", has: |_| true, kernel: loops::rotate_loop }),
    kernel: |spec| zyz(spec.order),
    does: |order, rgb| if is_tensor(order, rgb) { vec![] } else { FROM_QUATERNION.to_vec() },
    shown: |order| [Spec::new(&ZYZ, order).both(), Spec::new(&ZYZ, order).looped().both()].concat(),
    ..Family::PLAIN
};

/// `rotate:n:euler`.
pub static EULER: Family = Family {
    name: "rotate",
    method: "euler",
    stem: "rotate_euler",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| format!("Rotates order {} exactly, by z, y, z from three (cos, sin) pairs.", spec.order),
    kernel: |spec| from_euler(spec.order),
    does: |_, _| vec![Does::job(Job::Zyz)],
    shown: |order| Spec::new(&EULER, order).both(),
    ..Family::PLAIN
};

/// `rotate:n:angles`.
pub static FROM_ANGLES: Family = Family {
    name: "rotate",
    method: "angles",
    stem: "rotate_angles",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!("Rotates order {order} exactly, by z, y, z from the multiples that `angles:{order}` makes.")
    },
    kernel: |spec| from_angles(spec.order),
    does: |_, _| vec![Does::job(Job::Quaternion)],
    shown: |order| Spec::new(&FROM_ANGLES, order).both(),
    ..Family::PLAIN
};

/// `angles`: what [`FROM_ANGLES`] takes.
pub static ANGLES: Family = Family {
    name: "angles",
    stem: "angles",
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!(
            "The multiples of the three angles of a rotation that `rotate:{order}:angles` takes; done once for many signals."
        )
    },
    half: false,
    kernel: |spec| angles(spec.order),
    measure: Measure::Through(from_angles),
    shown: |order| vec![Spec::new(&ANGLES, order)],
    ..Family::PLAIN
};

/// From a unit quaternion.
pub fn zyz(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let c = signal(&mut builder, order);
    let out = zyz_from_quaternion(&mut builder.graph, &q, &c, order);
    rotated(builder, order, out)
}

/// From the three angles' cosine and sine.
fn from_euler(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(3), Domain::Phases, "(cos, sin) of α, β and γ in Rz(α) Ry(β) Rz(γ)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let angles = phases(&cs);
    let angles = euler(g, [angles[0], angles[1], angles[2]], order);
    let out = zyz_apply(g, &c, order, &angles);
    rotated(builder, order, out)
}

fn angle_pairs(order: usize) -> usize {
    3 * (order - 1) + 1
}

const PAIRS: &str = "(cos, sin) of α, 2α, …, (n−1)α, then of the multiples of β, then of γ, in Rz(α) Ry(β) Rz(γ); \
                     last the pair (sin²β / 2, sin β cos β)";

/// What each number of [`PAIRS`] is.
fn holds(order: usize) -> Vec<Held> {
    let pair = |circle: usize, k: usize| [OfAngle::Cos(k), OfAngle::Sin(k)].map(|of| Held { circle, of });
    let multiples = (0..3).flat_map(|circle| (1..order).flat_map(move |k| pair(circle, k)));
    multiples.chain([OfAngle::HalfSquare, OfAngle::Product].map(|of| Held { circle: 1, of })).collect()
}

/// With every multiple of the three angles given, as [`angles`] makes them.
fn from_angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let made = Made { by: ANGLES.name, order, kernel: angles, max_angle: None, holds };
    let cs = builder.param("cs", Shape::Pairs(angle_pairs(order)), Domain::Made(made), PAIRS);
    let c = signal(&mut builder, order);
    let all = phases(&cs);
    let count = order - 1;
    let last = all[3 * count];
    let angles = Euler {
        alpha: all[..count].to_vec(),
        beta: YPhases { multiples: all[count..2 * count].to_vec(), half_square: last.cos, product: last.sin },
        gamma: all[2 * count..3 * count].to_vec(),
    };
    let out = zyz_apply(&mut builder.graph, &c, order, &angles);
    rotated(builder, order, out)
}

/// The multiples of the three angles of a unit quaternion; made once for many signals.
pub fn angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let g = &mut builder.graph;
    let angles = phases_of_quaternion(g, &q);
    let angles = euler(g, angles, order);
    let pair = |phase: &Phase| [phase.cos, phase.sin];
    let mut out: Vec<Id> =
        [&angles.alpha, &angles.beta.multiples, &angles.gamma].into_iter().flatten().flat_map(pair).collect();
    out.extend([angles.beta.half_square, angles.beta.product]);
    builder.finish(out, Shape::Pairs(angle_pairs(order)), PAIRS)
}
