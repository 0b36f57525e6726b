//! The exact rotation of orders 2 and 3 as a vector and a symmetric traceless tensor: products and sums alone.

use crate::families::family::{Family, Group, Spec};
use crate::families::parts::bands::each_band;
use crate::families::parts::params::{matrix, quaternion, rotated, signal};
use crate::families::parts::quaternion::{matrix_of_quaternion, turned};
use crate::families::parts::sums::inner;
use crate::families::parts::usual::{FROM_QUATERNION, is_tensor};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel};
use crate::math::exact::Exact;
use std::ops::RangeInclusive;

/// The orders that are turned as vector and tensor.
pub const ORDERS: RangeInclusive<usize> = 2..=3;

/// Returns what is wrong with another order, and what to do.
pub fn outside(order: usize) -> [String; 2] {
    let help = "from order 4 on `zyz` is the cheapest exact rotation: leave the method out";
    [format!("this method has orders 2 and 3 only, not {order}"), help.to_owned()]
}

/// The rows of the catalogue of a family that has these orders.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if ORDERS.contains(&order) { Spec::new(family, order).both() } else { vec![] }
}

/// `rotate:n:tensor`, which is `rotate:2`, and `rotate:3` for one channel.
pub static TENSOR: Family = Family {
    name: "rotate",
    method: "tensor",
    stem: "rotate_tensor",
    usual: is_tensor,
    group: Group::Rotate,
    what: |spec| {
        format!("Rotates order {} exactly, as vector and tensor from a quaternion: products and sums only.", spec.order)
    },
    orders: ORDERS,
    outside,
    kernel: |spec| tensor(spec.order),
    does: |order, rgb| if is_tensor(order, rgb) { FROM_QUATERNION.to_vec() } else { vec![] },
    shown: |order| shown(&TENSOR, order),
    ..Family::PLAIN
};

/// `rotate:n:matrix`.
pub static MATRIX: Family = Family {
    name: "rotate",
    method: "matrix",
    stem: "rotate_matrix",
    usual: |_, _| false,
    group: Group::Rotate,
    what: |spec| {
        format!("Rotates order {} exactly, as vector and tensor from a 3x3 matrix: products and sums only.", spec.order)
    },
    orders: ORDERS,
    outside,
    kernel: |spec| from_matrix(spec.order),
    shown: |order| shown(&MATRIX, order),
    ..Family::PLAIN
};

/// Rotates band 1 as the vector (−c₁, −c₋₁, c₀), by a matrix given as rows.
fn matrix_band_1(g: &mut Graph, band: &[Id], rows: &[[Id; 3]; 3]) -> Vec<Id> {
    let v = [g.neg(band[2]), g.neg(band[0]), band[1]];
    let [x, y, z] = std::array::from_fn(|i| inner(g, &v, &rows[i]));
    vec![g.neg(y), z, g.neg(x)]
}

/// Rotates band 2 as a symmetric traceless tensor: 38 operations, no trigonometry
/// (docs/MATH.md#vectors-and-tensors).
fn matrix_band_2(g: &mut Graph, band: &[Id], rows: &[[Id; 3]; 3]) -> Vec<Id> {
    let [xy, yz, zz, zx, xx] = [band[0], band[1], band[2], band[3], band[4]];
    let root3 = Exact::sqrt_ratio(3, 1);
    let weighted = g.scale(&root3, zz);
    let (s11, s22) = (g.sub(xx, weighted), {
        let sum = g.add(xx, weighted);
        g.neg(sum)
    });
    let (s13, s23) = (g.neg(zx), g.neg(yz));
    let image = |g: &mut Graph, r: [Id; 3]| {
        [inner(g, &[s11, xy, s13], &r), inner(g, &[xy, s22, s23], &r), inner(g, &[s13, s23], &r[..2])]
    };
    let (u1, u2) = (image(g, rows[0]), image(g, rows[1]));
    let (r1u1, r2u2) = (inner(g, &u1, &rows[0]), inner(g, &u2, &rows[1]));
    let (difference, sum) = (g.sub(r1u1, r2u2), g.add(r1u1, r2u2));
    let twice = g.scale(&Exact::int(-2), zz);
    let out_yz = inner(g, &u2, &rows[2]);
    let out_zx = inner(g, &u1, &rows[2]);
    vec![
        inner(g, &u1, &rows[1]),
        g.neg(out_yz),
        g.scale_add(&-(&root3 / &Exact::int(2)), sum, twice),
        g.neg(out_zx),
        g.scale(&Exact::ratio(1, 2), difference),
    ]
}

fn matrix_apply(g: &mut Graph, c: &[Id], order: usize, rows: &[[Id; 3]; 3]) -> Vec<Id> {
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        1 => matrix_band_1(g, band, rows),
        _ => matrix_band_2(g, band, rows),
    })
}

/// `rotate` from a 3×3 matrix, orders 2 and 3, without trigonometry.
fn from_matrix(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let m = matrix(&mut builder);
    let c = signal(&mut builder, order);
    let rows: [[Id; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| m[3 * j + i]));
    let out = matrix_apply(&mut builder.graph, &c, order, &rows);
    rotated(builder, order, out)
}

/// Rotates orders 2 and 3 by a unit quaternion: nothing but products and sums.
pub fn apply(g: &mut Graph, q: &[Id], c: &[Id], order: usize) -> Vec<Id> {
    if order == 2 {
        // Cheaper than the matrix for one vector.
        let v = [g.neg(c[3]), g.neg(c[1]), c[2]];
        let turned = turned(g, q, v);
        vec![c[0], g.neg(turned[1]), turned[2], g.neg(turned[0])]
    } else {
        let rows = matrix_of_quaternion(g, q);
        matrix_apply(g, c, order, &rows)
    }
}

/// `rotate` from a unit quaternion as a vector and a tensor.
fn tensor(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder, Domain::Quaternion);
    let c = signal(&mut builder, order);
    let out = apply(&mut builder.graph, &q, &c, order);
    rotated(builder, order, out)
}
