//! The lifted rotation: Ry(β) of a band as three shears, of its even orders, its odd ones and its even ones again, as LF3
//! has them, but exact. With A the band's generator, which couples even orders to odd ones alone, the outer shears are
//! the part tanh(βA/2) of even rows, the inner one is the part sinh(βA) of odd rows: sums of tan(kβ/2) and of sin kβ with
//! constant factors. Given these sums, a band takes 3 l (l + 1) / 2 multiply-adds and no change of basis, where the
//! rotation by planes takes two changes and four operations a plane. Making them is dearer than multiples of angles are,
//! so that it pays for several signals that turn alike. The tangents bound β; see [`LIFTED_DEGREES`].
//! docs/MATH.md#the-lifted-rotation derives it.

use crate::families::family::{Does, Family, Group, Job, MAX_ORDER, Measure, Spec};
use crate::families::parts::bands::{each_band, z_band};
use crate::families::parts::params::{quaternion, rotated, signal};
use crate::families::parts::phases::{Phase, half_tangent_of_quaternion, multiples, phases, phases_of_quaternion};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::ir::kernel::{Domain, Held, Made, OfAngle, POLAR};
use crate::math::exact::Exact;
use crate::math::tables;
use std::ops::RangeInclusive;

/// The largest (n − 1) β in degrees that a lifted rotation takes: there the tangents of its shears reach √3, and f32 errs
/// by some one and a half times what the rotation by planes does; beyond, the error grows with them, to infinity at 180
/// degrees.
pub const LIFTED_DEGREES: f64 = 120.0;

const ORDERS: RangeInclusive<usize> = 3..=MAX_ORDER;

fn max_angle(order: usize) -> f64 {
    (LIFTED_DEGREES / (order - 1) as f64).to_radians()
}

fn outside(order: usize) -> [String; 2] {
    match order < *ORDERS.start() {
        true => {
            let help = "at order 2 the matrix of a rotation costs least: take `rotate:2:matrix`";
            [format!("a lifted rotation has orders from 3 on, not {order}"), help.to_owned()]
        }
        false => (Family::PLAIN.outside)(order),
    }
}

/// `lifted`: what [`ROTATE_LIFTED`] takes.
pub static LIFTED: Family = Family {
    name: "lifted",
    stem: "lifted",
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!(
            "The multiples of the two z angles of a rotation and the shears of its y rotation that `rotate:{order}:lifted` takes; done once for many signals."
        )
    },
    orders: ORDERS,
    outside,
    half: false,
    kernel: |spec| lifted(spec.order),
    measure: Measure::Through(rotate),
    max_angle: |spec| Some(max_angle(spec.order)),
    shown: |order| if ORDERS.contains(&order) { vec![Spec::new(&LIFTED, order)] } else { vec![] },
    ..Family::PLAIN
};

/// `rotate:n:lifted`.
pub static ROTATE_LIFTED: Family = Family {
    name: "rotate",
    method: "lifted",
    stem: "rotate_lifted",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        let order = spec.order;
        format!(
            "Rotates order {order} exactly, by z, y, z with the y rotation as shears, from what `lifted:{order}` makes; the y angle is bounded."
        )
    },
    orders: ORDERS,
    outside,
    kernel: |spec| rotate(spec.order),
    max_angle: |spec| Some(max_angle(spec.order)),
    does: |order, _| if ORDERS.contains(&order) { vec![Does::job(Job::Quaternion)] } else { vec![] },
    shown: |order| if ORDERS.contains(&order) { Spec::new(&ROTATE_LIFTED, order).both() } else { vec![] },
    ..Family::PLAIN
};

/// The pairs of an even and an odd order that a y rotation of band l couples: those of one sign, zero with the positive
/// ones.
pub fn couplings(l: usize) -> Vec<[isize; 2]> {
    let chain = |sign: isize, lowest: usize| {
        let orders = move |parity: usize| (lowest..=l).filter(move |m| m % 2 == parity).map(move |m| sign * m as isize);
        orders(0).flat_map(move |even| orders(1).map(move |odd| [even, odd]))
    };
    chain(1, 0).chain(chain(-1, 1)).collect()
}

/// What the frequencies k from 1 to l have in a coupling: its entry in the matrix of Ry(β) is Σ factor · sin kβ.
pub fn factors(l: usize, [even, odd]: [isize; 2]) -> Vec<Exact> {
    let swap = |k: isize, m: isize| tables::swap_yz(l, k, m);
    (1..=l as isize).map(|k| &(&swap(k, even) * &swap(-k, odd)) - &(&swap(-k, even) * &swap(k, odd))).collect()
}

/// How many pairs [`lifted`] makes: the multiples of α and γ and the couplings of every band.
fn pairs(order: usize) -> usize {
    2 * (order - 1) + order * (order * order - 1) / 6
}

const PAIRS: &str = "(cos, sin) of α, 2α, …, (n−1)α, then of the multiples of γ, in Rz(α) Ry(β) Rz(γ); then for each band \
                     from 1 and each pair of an even and an odd order of one sign what couples them in the outer \
                     and in the inner shear of Ry(β), the sums of tan(kβ/2) and of sin kβ";

/// What each number of [`PAIRS`] is.
fn holds(order: usize) -> Vec<Held> {
    let pair = |circle: usize, k: usize| [OfAngle::Cos(k), OfAngle::Sin(k)].map(|of| Held { circle, of });
    let multiples = (0..2).flat_map(|circle| (1..order).flat_map(move |k| pair(circle, k)));
    let shear = |l: usize, at: usize, inner: bool| Held { circle: POLAR, of: OfAngle::Shear { l, at, inner } };
    let band = |l: usize| (0..couplings(l).len()).flat_map(move |at| [false, true].map(|inner| shear(l, at, inner)));
    multiples.chain((1..order).flat_map(band)).collect()
}

/// A coupling in the outer and in the inner shear.
#[derive(Clone, Copy, Debug)]
struct Coupling {
    outer: Id,
    inner: Id,
}

/// Rotates one band about y by its shears.
fn y_band(g: &mut Graph, band: &[Id], shears: &[Coupling]) -> Vec<Id> {
    let l = band.len() / 2;
    let place = |m: isize| (l as isize + m) as usize;
    let all: Vec<([isize; 2], &Coupling)> = couplings(l).into_iter().zip(shears).collect();
    let mut out = band.to_vec();
    for shear in 0..3 {
        let old = out.clone();
        for ([even, odd], coupling) in &all {
            let (even, odd) = (place(*even), place(*odd));
            if shear == 1 {
                let term = g.mul(old[even], coupling.inner);
                out[odd] = g.sub(out[odd], term);
            } else {
                out[even] = g.mul_add(old[odd], coupling.outer, out[even]);
            }
        }
    }
    g.stage(&out);
    out
}

/// tan(kβ/2) from `half`, tan(β/2), and the phase of the whole multiple of β that is next below, whatever its length: a
/// quaternion that was rounded to f32 is not quite a unit.
fn half_tangent(g: &mut Graph, half: Id, beta: &[Phase], k: usize) -> Id {
    if k == 1 {
        return half;
    }
    let Phase { cos, sin } = beta[k / 2 - 1];
    let (over, under) = match k % 2 {
        0 => (sin, cos),
        _ => {
            let over = g.mul_add(cos, half, sin);
            let term = g.mul(sin, half);
            (over, g.sub(cos, term))
        }
    };
    let inverse = g.recip(under);
    g.mul(over, inverse)
}

/// The kernel `lifted`: what [`ROTATE_LIFTED`] takes, from a unit quaternion; done once for many signals.
pub fn lifted(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::BoundedTurn(max_angle(order)));
    let g = &mut builder.graph;
    let [alpha, beta, gamma] = phases_of_quaternion(g, &q).map(|phase| multiples(g, phase, order - 1));
    let half = half_tangent_of_quaternion(g, &q);
    let sines: Vec<Id> = beta.iter().map(|phase| phase.sin).collect();
    let tangents: Vec<Id> = (1..order).map(|k| half_tangent(g, half, &beta, k)).collect();
    let mut out: Vec<Id> = [alpha, gamma].iter().flatten().flat_map(|phase| [phase.cos, phase.sin]).collect();
    for l in 1..order {
        for coupling in couplings(l) {
            let factors = factors(l, coupling);
            out.extend([g.dot(&factors, &tangents[..l]), g.dot(&factors, &sines[..l])]);
        }
    }
    builder.finish(out, Shape::Pairs(pairs(order)), PAIRS)
}

/// `rotate` by z, y, z, the y rotation by shears, with all that [`lifted`] makes given.
fn rotate(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let made = Made { by: LIFTED.name, order, kernel: lifted, max_angle: Some(max_angle(order)), holds };
    let cs = builder.param("cs", Shape::Pairs(pairs(order)), Domain::Made(made), PAIRS);
    let c = signal(&mut builder, order);
    let (turns, shears) = cs.split_at(4 * (order - 1));
    let turns: Vec<Phase> = phases(turns);
    let (alpha, gamma) = turns.split_at(order - 1);
    let shears: Vec<Coupling> =
        shears.chunks_exact(2).map(|pair| Coupling { outer: pair[0], inner: pair[1] }).collect();
    let mut rest = &shears[..];
    let out = each_band(&mut builder.graph, &c, order, |g, l, band| {
        let (own, others) = rest.split_at(l * (l + 1) / 2);
        rest = others;
        let band = z_band(g, band, gamma);
        let band = y_band(g, &band, own);
        z_band(g, &band, alpha)
    });
    rotated(builder, order, out)
}
