//! Rotations by a quaternion whose y angle is small: approximately, or, by the only branch in any kernel, approximately
//! below a limiting angle and exactly above it.

use crate::families::family::{AngleAs, ByBand, Does, Family, Group, Job, Spec, Spelled, small_angle};
use crate::families::parts::bands::zyz_from_quaternion;
use crate::families::parts::params::{quaternion, rotated, signal};
use crate::families::parts::phases::{phases, phases_of_quaternion};
use crate::families::parts::small_angle::{Powers, SmallAngle, between_z, small_rotation, sources};
use crate::families::parts::sums::inner;
use crate::ir::code::Branch;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::ir::listing::Listing;

const BY_BAND: ByBand = ByBand {
    spelled: Spelled::AsOption,
    given: AngleAs::Phase,
    in_band: |_| &SmallAngle::ALL,
    rule: ["a band is rotated in a way that there is not", "name one of the methods for small angles"],
    plane: small_y,
};

/// `rotate_small`.
pub static ROTATE_SMALL: Family = Family {
    name: "rotate_small",
    stem: "rotate_small",
    group: Group::SmallAngle,
    what: |spec| {
        let (order, sources) = (spec.order, sources(&spec.methods));
        format!("Rotates order {order} by z, y, z from a quaternion whose y angle is small, approximately ({sources}).")
    },
    half: false,
    by_band: Some(BY_BAND),
    kernel: |spec| rotate_small(spec.order, &spec.methods),
    does: |_, _| vec![Does::job(Job::Quaternion)],
    shown: |order| {
        let spec = Spec::new(&ROTATE_SMALL, order);
        match order {
            2 | 3 => spec.both(),
            _ => [spec.clone().both(), spec.by(SmallAngle::Lf5).both()].concat(),
        }
    },
    ..Family::PLAIN
};

/// `rotate_adaptive`.
pub static ROTATE_ADAPTIVE: Family = Family {
    name: "rotate_adaptive",
    stem: "rotate_adaptive",
    group: Group::SmallAngle,
    what: |spec| {
        let (order, sources) = (spec.order, sources(&spec.methods));
        format!(
            "Rotates order {order} from a quaternion: approximately where the y angle is below a limit ({sources}), exactly above it."
        )
    },
    half: false,
    by_band: Some(BY_BAND),
    kernel: |spec| {
        let [_, _, exact] = adaptive(spec.order, &spec.methods);
        exact
    },
    branch: Some(|spec| {
        let [condition, below, above] = adaptive(spec.order, &spec.methods).map(|kernel| Listing::new(&kernel));
        Branch { condition, below, above }
    }),
    shown: |order| match order {
        2 | 3 => vec![],
        _ => Spec::new(&ROTATE_ADAPTIVE, order).both(),
    },
    ..Family::PLAIN
};

/// The y rotation of `rotate_small` alone, from (cos β, sin β).
pub fn small_y(order: usize, methods: &[SmallAngle]) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Domain::Phases, "(cos β, sin β)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let powers = Powers::of_phase(g, phases(&cs)[0], methods);
    let out = small_rotation(g, &c, order, &powers, methods);
    rotated(builder, order, out)
}

/// From a unit quaternion whose y angle is small, `methods[l − 1]` for band l.
fn rotate_small(order: usize, methods: &[SmallAngle]) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, turn(methods));
    let c = signal(&mut builder, order);
    let out = small_from_quaternion(&mut builder.graph, &q, &c, order, methods);
    rotated(builder, order, out)
}

/// The rotations that methods are meant for: all of them where every band is exact.
fn turn(methods: &[SmallAngle]) -> Domain {
    match methods.iter().all(|method| *method == SmallAngle::Exact) {
        true => Domain::Quaternion,
        false => Domain::SmallTurn(small_angle()),
    }
}

fn small_from_quaternion(g: &mut Graph, q: &[Id], c: &[Id], order: usize, methods: &[SmallAngle]) -> Vec<Id> {
    let [alpha, beta, gamma] = phases_of_quaternion(g, q);
    let powers = Powers::of_phase(g, beta, methods);
    between_z(g, c, order, [alpha, gamma], &powers, methods)
}

/// `rotate_adaptive` as three kernels of the same parameters: the two numbers of which the first must not be above the
/// second for the small rotation, sin²(β/2) and its limit; the small rotation; the exact one.
fn adaptive(order: usize, methods: &[SmallAngle]) -> [Kernel; 3] {
    type Part<'a> = &'a dyn Fn(&mut Graph, [&[Id]; 3]) -> Vec<Id>;
    let make = |f: Part<'_>, shape: Shape, domain: Domain| {
        let mut builder = Builder::new();
        let q = quaternion(&mut builder, domain);
        let doc = "sin(b/2) of the largest y angle b that may be rotated approximately, not negative; a / (√2 + 2 r/R) \
                   for a radiance cache of error a whose record has the radius R and is used at the distance r";
        let limit = builder.param("limit", Shape::Scalar, Domain::HalfSine(small_angle()), doc);
        let c = signal(&mut builder, order);
        let out = f(&mut builder.graph, [&q, &limit, &c]);
        builder.finish(out, shape, "the rotated coefficients")
    };
    let condition = |g: &mut Graph, [q, limit, _]: [&[Id]; 3]| {
        vec![inner(g, &[q[0], q[1]], &[q[0], q[1]]), g.mul(limit[0], limit[0])]
    };
    let small = |g: &mut Graph, [q, _, c]: [&[Id]; 3]| small_from_quaternion(g, q, c, order, methods);
    let exact = |g: &mut Graph, [q, _, c]: [&[Id]; 3]| zyz_from_quaternion(g, q, c, order);
    let all = Shape::Array(order * order);
    let every = Domain::Quaternion;
    [make(&condition, Shape::Pair, every), make(&small, all, turn(methods)), make(&exact, all, every)]
}
