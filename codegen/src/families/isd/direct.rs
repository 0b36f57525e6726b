//! Shading as the inner product of the reflectance and the turned light, I = c · D(R) e, which every form of isotropic
//! decomposition equals (docs/MATH.md#shading-without-a-decomposition). The last turn about z is summed before it is done: of
//! the pairs of one order m two sums, then one phase.

use crate::families::basis;
use crate::families::family::{Family, Spec};
use crate::families::isd::{SHADED, SHADING, light, to_local, zonal_light};
use crate::families::parts::bands::{each_band, y_band, z_band};
use crate::families::parts::columns::{self, Scaled};
use crate::families::parts::phases::{Phase, euler, phases_of_quaternion};
use crate::families::parts::quaternion::turned;
use crate::families::parts::sums::inner;
use crate::families::parts::usual::is_tensor;
use crate::families::tensor;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::index::index;
use std::ops::RangeInclusive;

/// The orders that the catalogue has.
const SHOWN: RangeInclusive<usize> = 3..=6;

/// `shade:n:zyz`, from order 4 on `shade:n`.
pub static SHADE: Family = Family {
    name: "shade",
    method: "zyz",
    stem: "shade_zyz",
    usual: |order, rgb| !is_tensor(order, rgb),
    what: |spec| {
        format!(
            "Shades at order {}: the reflectance in the local frame times the light, turned there from the world by z, y, z. What Soler et al. 2015 find by isotropic decomposition.",
            spec.order
        )
    },
    kernel: |spec| by_angles(spec.order, &anisotropic(spec.order)),
    shown: |order| if SHOWN.contains(&order) { Spec::new(&SHADE, order).both() } else { vec![] },
    ..SHADING
};

/// `shade:n:tensor`, which is `shade:2`, and `shade:3` for one channel.
pub static SHADE_TENSOR: Family = Family {
    name: "shade",
    method: "tensor",
    stem: "shade_tensor",
    usual: is_tensor,
    what: |spec| {
        format!(
            "Shades at order {}: the reflectance in the local frame times the light, turned there from the world as vector and tensor, by products and sums alone. What Soler et al. 2015 find by isotropic decomposition.",
            spec.order
        )
    },
    orders: tensor::ORDERS,
    outside: tensor::outside,
    kernel: |spec| by_tensor(spec.order),
    shown: |order| if order == 3 { vec![Spec::new(&SHADE_TENSOR, order)] } else { vec![] },
    ..SHADING
};

/// `shade_isotropic`.
pub static SHADE_ISOTROPIC: Family = Family {
    name: "shade_isotropic",
    stem: "shade_isotropic",
    what: |spec| {
        format!(
            "Shades at order {} by an isotropic reflectance, in the local frame of which z is the normal and x points to the side of the view: no coefficient of a negative order m is left.",
            spec.order
        )
    },
    kernel: |spec| by_angles(spec.order, &isotropic(spec.order)),
    shown: |order| if SHOWN.contains(&order) { Spec::new(&SHADE_ISOTROPIC, order).both() } else { vec![] },
    ..SHADING
};

/// `shade_zonal`.
pub static SHADE_ZONAL: Family = Family {
    name: "shade_zonal",
    stem: "shade_zonal",
    what: |spec| {
        format!(
            "Shades at order {} under a light that is a zonal function about a direction, as a sphere or a cone is: one sum over the reflectance at the light's local direction.",
            spec.order
        )
    },
    kernel: |spec| zonal(spec.order),
    shown: |order| if SHOWN.contains(&order) { Spec::new(&SHADE_ZONAL, order).both() } else { vec![] },
    ..SHADING
};

/// What a reflectance is declared as, and where the coefficient of a band and an order lies.
struct Reflectance {
    count: usize,
    doc: &'static str,
    place: fn(usize, isize) -> Option<usize>,
}

fn anisotropic(order: usize) -> Reflectance {
    Reflectance {
        count: order * order,
        doc: "the coefficients of the reflectance times the cosine in the local frame, index l(l+1)+m",
        place: |l, m| Some(index(l, m)),
    }
}

fn isotropic(order: usize) -> Reflectance {
    Reflectance {
        count: order * (order + 1) / 2,
        doc: "the coefficients of the reflectance times the cosine in the local frame, m from 0 to l, index l(l+1)/2+m",
        place: |l, m| (m >= 0).then(|| l * (l + 1) / 2 + m.unsigned_abs()),
    }
}

impl Reflectance {
    fn declared(&self, builder: &mut Builder) -> Vec<Id> {
        builder.param("c", Shape::Array(self.count), Domain::Signal, self.doc)
    }
}

fn by_tensor(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = to_local(&mut builder);
    let e = light(&mut builder, order);
    let c = anisotropic(order).declared(&mut builder);
    let g = &mut builder.graph;
    let local = tensor::apply(g, &q, &e, order);
    let sum = inner(g, &c, &local);
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}

fn by_angles(order: usize, reflectance: &Reflectance) -> Kernel {
    let mut builder = Builder::new();
    let q = to_local(&mut builder);
    let e = light(&mut builder, order);
    let c = reflectance.declared(&mut builder);
    let g = &mut builder.graph;
    let angles = phases_of_quaternion(g, &q);
    let angles = euler(g, angles, order);
    let before = each_band(g, &e, order, |g, _, band| {
        let band = z_band(g, band, &angles.gamma);
        y_band(g, &band, &angles.beta)
    });
    let factor = |l: usize, m: isize| (reflectance.place)(l, m).map(|place| c[place]);
    let terms: Vec<[Id; 2]> = (0..order).filter_map(|l| Some([factor(l, 0)?, before[index(l, 0)]])).collect();
    let mut sum = summed(g, &terms);
    for m in 1..order {
        let signed = m as isize;
        let pairs: Vec<[Id; 2]> = (m..order).map(|l| [signed, -signed].map(|m| before[index(l, m)])).collect();
        let factors: Vec<[Option<Id>; 2]> = (m..order).map(|l| [signed, -signed].map(|m| factor(l, m))).collect();
        let term = of_order(g, angles.alpha[m - 1], &pairs, &factors);
        sum = g.add(sum, term);
    }
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}

fn summed(g: &mut Graph, terms: &[[Id; 2]]) -> Id {
    let [a, b]: [Vec<Id>; 2] = std::array::from_fn(|side| terms.iter().map(|term| term[side]).collect());
    inner(g, &a, &b)
}

/// Σ over the bands of one order m of factors times pairs (plus, minus) that a phase turns.
fn of_order(g: &mut Graph, Phase { cos, sin }: Phase, pairs: &[[Id; 2]], factors: &[[Option<Id>; 2]]) -> Id {
    if let ([[plus, minus]], [[Some(factor), None]]) = (pairs, factors) {
        // Of one pair alone the turn is cheaper than two sums.
        let (cp, sm) = (g.mul(*plus, cos), g.mul(*minus, sin));
        let turned = g.sub(cp, sm);
        return g.mul(*factor, turned);
    }
    let (mut along, mut across) = (Vec::new(), Vec::new());
    for (&[plus, minus], &[even, odd]) in pairs.iter().zip(factors) {
        if let Some(even) = even {
            along.push([even, plus]);
            let back = g.neg(minus);
            across.push([even, back]);
        }
        if let Some(odd) = odd {
            along.push([odd, minus]);
            across.push([odd, plus]);
        }
    }
    let (along, across) = (summed(g, &along), summed(g, &across));
    let (along, across) = (g.mul(along, cos), g.mul(across, sin));
    g.add(along, across)
}

/// Σ π_l g_l Σ_m c_lm y_lm(R d).
fn zonal(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = to_local(&mut builder);
    let [dir, bands] = zonal_light(&mut builder, order);
    let c = anisotropic(order).declared(&mut builder);
    let g = &mut builder.graph;
    let dir = turned(g, &q, [dir[0], dir[1], dir[2]]);
    let places: Vec<Option<usize>> = (0..order * order).map(Some).collect();
    let sum = basis::weighted_sum_at(g, &Scaled::plain(&dir), &c, &places, columns::zonal, Some(&bands));
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}
