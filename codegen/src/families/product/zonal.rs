//! Products with a zonal function, whose matrix falls apart by orders m: one that is given, the clamped cosine and the
//! indicator of a hemisphere, about z and about any axis (docs/MATH.md#zonal-factors). About an axis the other factor is
//! turned so that the axis is z, and the product is turned back.

use crate::families::family::{Family, Group, Measure, Proof, Spec};
use crate::families::parts::bands::{each_band, y_band, z_band};
use crate::families::parts::params::{normal_as, rotated, signal};
use crate::families::parts::phases::{Phase, YPhases, multiples, phases, phases_of_normal, turn, y_phases};
use crate::families::product::cover::{factor, finish};
use crate::families::product::{COMMON, SHOWN};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Held, Kernel, Made, OfAngle, Shape};
use crate::math::exact::Exact;
use crate::math::gaunt::gaunt;
use crate::math::index::{degrees, index};
use crate::math::tables::{k, legendre_polynomial};

/// A zonal function.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Zonal {
    /// One whose coefficients are given.
    Given,
    /// max(0, cos θ).
    Cosine,
    /// One above the horizon, zero below.
    Hemisphere,
}

/// How an axis is given.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    /// It is z.
    Z,
    /// By a direction.
    Direction,
    /// By the multiples of its angles.
    Angles,
}

/// A family of these products.
const fn family(name: &'static str, stem: &'static str, zonal: Zonal, axis: Axis) -> Family {
    let fixed = !matches!(zonal, Zonal::Given);
    let about_z = matches!(axis, Axis::Z);
    Family {
        name,
        method: if matches!(axis, Axis::Angles) { "angles" } else { "" },
        stem,
        usual: if matches!(axis, Axis::Angles) { |_, _| false } else { |_, _| true },
        half: about_z,
        measure: if fixed { Measure::Bands } else { Measure::Product },
        proof: if fixed && about_z { Proof::Auto } else { Proof::Nothing },
        ..COMMON
    }
}

macro_rules! families {
    ($($(#[$doc:meta])* $name:ident: $spec:literal, $stem:literal, $zonal:ident, $axis:ident, $what:literal, $shown:expr;)+) => {
        $($(#[$doc])* pub static $name: Family = Family {
            what: |spec| format!($what, order = spec.order),
            kernel: |spec| kernel(spec.order, Zonal::$zonal, Axis::$axis),
            shown: |order| if order <= $shown { Spec::new(&$name, order).both() } else { vec![] },
            ..family($spec, $stem, Zonal::$zonal, Axis::$axis)
        };)+
    };
}

families! {
    /// `product_zonal`.
    ZONAL: "product_zonal", "product_zonal", Given, Z,
        "Multiplies a zonal function about z and any function, both of order {order}; the product is cut off at it.", SHOWN;
    /// `product_zonal_about`.
    ZONAL_ABOUT: "product_zonal_about", "product_zonal_about", Given, Direction,
        "Multiplies a zonal function about a direction and any function, both of order {order}; the product is cut off at it.", SHOWN;
    /// `product_zonal_about:n:angles`.
    ZONAL_ANGLES: "product_zonal_about", "product_zonal_about_angles", Given, Angles,
        "Multiplies a zonal function about an axis and any function, both of order {order}, from the multiples that `axis_angles:{order}` makes; the product is cut off at the order.", SHOWN;
    /// `product_cosine`.
    COSINE: "product_cosine", "product_cosine", Cosine, Z,
        "Multiplies a function of order {order} by the clamped cosine max(0, z), of which all bands count; the product is cut off at the order.", SHOWN;
    /// `product_cosine_about`.
    COSINE_ABOUT: "product_cosine_about", "product_cosine_about", Cosine, Direction,
        "Multiplies a function of order {order} by the clamped cosine about a direction, of which all bands count; the product is cut off at the order.", 4;
    /// `product_cosine_about:n:angles`.
    COSINE_ANGLES: "product_cosine_about", "product_cosine_about_angles", Cosine, Angles,
        "Multiplies a function of order {order} by the clamped cosine about an axis, from the multiples that `axis_angles:{order}` makes; the product is cut off at the order.", 4;
    /// `product_hemisphere`.
    HEMISPHERE: "product_hemisphere", "product_hemisphere", Hemisphere, Z,
        "Multiplies a function of order {order} by one where z > 0 and zero elsewhere, of which all bands count; the product is cut off at the order.", SHOWN;
    /// `product_hemisphere_about`.
    HEMISPHERE_ABOUT: "product_hemisphere_about", "product_hemisphere_about", Hemisphere, Direction,
        "Multiplies a function of order {order} by one on the hemisphere about a direction and zero elsewhere, of which all bands count; the product is cut off at the order.", 4;
    /// `product_hemisphere_about:n:angles`.
    HEMISPHERE_ANGLES: "product_hemisphere_about", "product_hemisphere_about_angles", Hemisphere, Angles,
        "Multiplies a function of order {order} by one on the hemisphere about an axis and zero elsewhere, from the multiples that `axis_angles:{order}` makes; the product is cut off at the order.", 4;
}

/// `axis_angles`: what the products about an axis take.
pub static AXIS_ANGLES: Family = Family {
    name: "axis_angles",
    stem: "axis_angles",
    group: Group::Multiply,
    what: |spec| {
        let order = spec.order;
        format!(
            "The multiples of a direction's two angles that products of order {order} about it take; done once for many of them."
        )
    },
    half: false,
    orders: COMMON.orders,
    outside: COMMON.outside,
    kernel: |spec| axis_angles(spec.order),
    measure: Measure::Through(turned_to_axis),
    shown: |order| if order <= SHOWN { vec![Spec::new(&AXIS_ANGLES, order)] } else { vec![] },
    ..Family::PLAIN
};

const PAIRS: &str = "(cos, sin) of φ, 2φ, …, (n−1)φ, then of the multiples of θ, for the axis (sin θ cos φ, sin θ sin φ, cos θ); \
                     last the pair (sin²θ / 2, sin θ cos θ)";

/// The multiples of an axis's angles.
struct Angles {
    phi: Vec<Phase>,
    theta: YPhases,
}

fn pairs(order: usize) -> usize {
    2 * (order - 1) + 1
}

/// What each number of [`PAIRS`] is.
fn holds(order: usize) -> Vec<Held> {
    let pair = |circle: usize, k: usize| [OfAngle::Cos(k), OfAngle::Sin(k)].map(|of| Held { circle, of });
    let multiples = (0..2).flat_map(|circle| (1..order).flat_map(move |k| pair(circle, k)));
    multiples.chain([OfAngle::HalfSquare, OfAngle::Product].map(|of| Held { circle: 1, of })).collect()
}

fn axis_angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = normal_as(&mut builder, "dir", "the axis, of unit length");
    let g = &mut builder.graph;
    let [phi, theta] = phases_of_normal(g, &dir);
    let (phi, theta) = (multiples(g, phi, order - 1), y_phases(g, theta, order - 1));
    let pair = |phase: &Phase| [phase.cos, phase.sin];
    let mut out: Vec<Id> = [&phi, &theta.multiples].into_iter().flatten().flat_map(pair).collect();
    out.extend([theta.half_square, theta.product]);
    builder.finish(out, Shape::Pairs(pairs(order)), PAIRS)
}

/// Declares what [`axis_angles`] makes.
fn angles(builder: &mut Builder, order: usize) -> Angles {
    let made = Made { by: AXIS_ANGLES.name, order, kernel: axis_angles, max_angle: None, holds };
    let cs = builder.param("cs", Shape::Pairs(pairs(order)), Domain::Made(made), PAIRS);
    let (all, count) = (phases(&cs), order - 1);
    let last = all[2 * count];
    let multiples = all[count..2 * count].to_vec();
    let theta = YPhases { multiples, half_square: last.cos, product: last.sin };
    Angles { phi: all[..count].to_vec(), theta }
}

/// e^{2ia}, of a phase of unit length: three operations.
fn doubled(g: &mut Graph, phase: Phase) -> Phase {
    let twice = g.scale(&Exact::int(2), phase.sin);
    let square = g.mul(twice, phase.sin);
    let one = g.constant(Exact::one());
    Phase { cos: g.sub(one, square), sin: g.mul(twice, phase.cos) }
}

/// Adds multiples to the first two, the even ones by doubling.
fn extended(g: &mut Graph, mut all: Vec<Phase>, count: usize) -> Vec<Phase> {
    while all.len() < count {
        let next = all.len() + 1;
        let phase = match next % 2 {
            0 => doubled(g, all[next / 2 - 1]),
            _ => turn(g, all[next - 2], all[0]),
        };
        all.push(phase);
    }
    all
}

fn from_direction(builder: &mut Builder, order: usize) -> Angles {
    let dir = normal_as(builder, "dir", "the axis, of unit length");
    let g = &mut builder.graph;
    let [phi, theta] = phases_of_normal(g, &dir);
    let mut theta = y_phases(g, theta, 2.min(order - 1));
    theta.multiples = extended(g, theta.multiples, order - 1);
    Angles { phi: extended(g, vec![phi], order - 1), theta }
}

/// Turns z to the axis.
fn to_axis(g: &mut Graph, c: &[Id], order: usize, angles: &Angles) -> Vec<Id> {
    each_band(g, c, order, |g, _, band| {
        let band = y_band(g, band, &angles.theta);
        z_band(g, &band, &angles.phi)
    })
}

/// Turns the axis to z.
fn from_axis(g: &mut Graph, c: &[Id], order: usize, angles: &Angles) -> Vec<Id> {
    let back = |g: &mut Graph, all: &[Phase]| -> Vec<Phase> {
        all.iter().map(|phase| Phase { cos: phase.cos, sin: g.neg(phase.sin) }).collect()
    };
    let phi = back(g, &angles.phi);
    let YPhases { half_square, product, .. } = angles.theta;
    let theta = YPhases { multiples: back(g, &angles.theta.multiples), half_square, product: g.neg(product) };
    each_band(g, c, order, |g, _, band| {
        let band = z_band(g, band, &phi);
        y_band(g, &band, &theta)
    })
}

/// The rotation that the set-up is made for.
fn turned_to_axis(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let angles = angles(&mut builder, order);
    let c = signal(&mut builder, order);
    let out = to_axis(&mut builder.graph, &c, order, &angles);
    rotated(builder, order, out)
}

/// ∫_0^1 t^power P_l(t) dt.
fn above_horizon(l: usize, power: i64) -> Exact {
    let term = |(j, c): (usize, &Exact)| c / &Exact::int(j as i64 + 1 + power);
    legendre_polynomial(l, 0).iter().enumerate().map(term).sum()
}

impl Zonal {
    /// The coefficient of a band, of a function that is fixed (docs/MATH.md#zonal-functions).
    fn coefficient(self, l: usize) -> Exact {
        let power = i64::from(self == Self::Cosine);
        k(l, 0) * Exact::int(2) * Exact::pi_sqrt_power(2) * above_horizon(l, power)
    }
}

/// What the coefficients of a fixed function make of the matrix's entry of two bands at an order.
fn fixed_entry(zonal: Zonal, [a, b]: [usize; 2], m: usize) -> Exact {
    (a.abs_diff(b)..=a + b).map(|l| gaunt((l, 0), (a, m), (b, m)) * zonal.coefficient(l)).sum()
}

fn times_fixed(g: &mut Graph, zonal: Zonal, b: &[Id], order: usize) -> Vec<Id> {
    let entry = |l: usize, m: isize| {
        let bands = m.unsigned_abs()..order;
        let factors: Vec<Exact> =
            bands.clone().map(|from| fixed_entry(zonal, [from.min(l), from.max(l)], m.unsigned_abs())).collect();
        let values: Vec<Id> = bands.map(|from| b[index(from, m)]).collect();
        (factors, values)
    };
    let rows: Vec<_> = (0..order).flat_map(|l| degrees(l).map(move |m| (l, m))).map(|(l, m)| entry(l, m)).collect();
    rows.iter().map(|(factors, values)| g.dot(factors, values)).collect()
}

fn times_given(g: &mut Graph, zonal: &[Id], b: &[Id], order: usize) -> Vec<Id> {
    g.lay_out_as_made();
    let zero = g.constant(Exact::zero());
    let constant = g.scale(&k(0, 0), zonal[0]);
    let entry = |g: &mut Graph, low: usize, high: usize, m: usize| {
        let start = if low == high { constant } else { zero };
        (1..order).fold(start, |sum, l| g.scale_add(&gaunt((l, 0), (low, m), (high, m)), zonal[l], sum))
    };
    let mut out = vec![zero; order * order];
    for m in 0..order {
        for low in m..order {
            for high in low..order {
                if (low, m) == (0, 0) {
                    // The first row and column are y_0 times the zonal coefficients: y_0 is left to their ends.
                    continue;
                }
                let value = entry(g, low, high, m);
                for sign in [1, -1].into_iter().take(1 + usize::from(m > 0)) {
                    let [i, j] = [low, high].map(|l| index(l, sign * m as isize));
                    out[i] = g.mul_add(value, b[j], out[i]);
                    if i != j {
                        out[j] = g.mul_add(value, b[i], out[j]);
                    }
                }
            }
        }
    }
    let first = g.scale(&k(0, 0), b[0]);
    let mut sum = g.mul(zonal[0], b[0]);
    for l in 1..order {
        out[index(l, 0)] = g.mul_add(zonal[l], first, out[index(l, 0)]);
        sum = g.mul_add(zonal[l], b[index(l, 0)], sum);
    }
    out[0] = g.scale(&k(0, 0), sum);
    out
}

fn kernel(order: usize, zonal: Zonal, axis: Axis) -> Kernel {
    let mut builder = Builder::new();
    let angles = match axis {
        Axis::Z => None,
        Axis::Direction => Some(from_direction(&mut builder, order)),
        Axis::Angles => Some(angles(&mut builder, order)),
    };
    let given = (zonal == Zonal::Given).then(|| {
        let doc = format!("the {order} coefficients of the zonal function at m = 0, about its own axis");
        builder.param("g", Shape::Array(order), Domain::Signal, doc)
    });
    let b = factor(&mut builder, "b", order, Domain::Signal);
    let g = &mut builder.graph;
    let about_z = |g: &mut Graph, b: &[Id]| match &given {
        Some(coefficients) => times_given(g, coefficients, b, order),
        None => times_fixed(g, zonal, b, order),
    };
    let out = match &angles {
        None => about_z(g, &b),
        Some(angles) => {
            let turned = from_axis(g, &b, order, angles);
            let made = about_z(g, &turned);
            to_axis(g, &made, order, angles)
        }
    };
    finish(builder, order, out)
}
