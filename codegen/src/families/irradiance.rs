//! Irradiance by the normal from coefficients of radiance: at once, or prepared as the coefficients of monomials
//! (docs/MATH.md#evaluation-at-the-floor). Bands that the cosine has not are not read: order 4 is order 3.

use crate::families::basis;
use crate::families::family::{Family, Group, MAX_ORDER, Measure, Spec};
use crate::families::monomial::{AXES, MAX_FLOOR_ORDER, Monomials};
use crate::families::parts::columns::BandScale;
use crate::families::parts::once::once;
use crate::families::parts::params::{direction, signal};
use crate::families::parts::zonal::cosine_lobe;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// The orders that the catalogue has: those of DirectXMath.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// Divides by π.
const OVER_PI: &[&str] = &["over_pi"];

/// The largest order whose irradiance is that of order 3.
const MAX_ONCE_ORDER: usize = 4;

/// `irradiance`, nested by m.
pub static IRRADIANCE: Family = Family {
    name: "irradiance",
    method: "nested",
    stem: "irradiance_nested",
    usual: |order, rgb| !is_once(order, rgb),
    group: Group::Light,
    measure: Measure::Whole,
    choices: &[OVER_PI],
    what: sentence,
    kernel: |spec| {
        kernel(spec, |g, dir, c, of_band| {
            let is_seen = |place: usize| !cosine_lobe(place.isqrt()).is_zero();
            let places: Vec<Option<usize>> = (0..c.len()).map(|place| is_seen(place).then_some(place)).collect();
            basis::sum(g, dir, c, &places, of_band)
        })
    },
    shown: |order| shown(&IRRADIANCE, order),
    ..Family::PLAIN
};

/// `irradiance` of one channel, at once.
pub static IRRADIANCE_ONCE: Family = Family {
    name: "irradiance",
    method: "once",
    stem: "irradiance_once",
    usual: is_once,
    group: Group::Light,
    orders: 2..=MAX_ONCE_ORDER,
    outside: |order| {
        let help = format!("leave `once` out, as in `irradiance:{order}`");
        [format!("what is done at once has an order to {MAX_ONCE_ORDER}"), help]
    },
    measure: Measure::Whole,
    choices: &[OVER_PI],
    what: sentence,
    kernel: |spec| kernel(spec, |g, dir, c, of_band| once(g, [dir[0], dir[1], dir[2]], &c[..c.len().min(9)], of_band)),
    shown: |order| shown(&IRRADIANCE_ONCE, order),
    ..Family::PLAIN
};

/// What the records of prepared irradiance leave as it is.
const PREPARED: Family = Family {
    group: Group::Irradiance,
    orders: 2..=MAX_FLOOR_ORDER,
    outside: |order| {
        let help = format!(
            "take `irradiance:{}`, or `convolve_cosine:{order}` once and then `eval:{order}`",
            order.min(MAX_ORDER)
        );
        [format!("prepared irradiance has an order to {MAX_FLOOR_ORDER}"), help]
    },
    measure: Measure::Norm,
    ..Family::PLAIN
};

/// `to_irradiance`.
pub static TO_IRRADIANCE: Family = Family {
    name: "to_irradiance",
    stem: "to_irradiance",
    choices: &[OVER_PI, AXES],
    what: |spec| {
        let to = Spec { chosen: axis_of(spec), ..Spec::new(&IRRADIANCE_PREPARED, spec.order) };
        let over = if spec.has(OVER_PI[0]) { " divided by pi" } else { ", which `:over_pi` divides by pi" };
        format!(
            "From the coefficients of radiance of order {} to those of monomials of the irradiance{over}, as `{to}` takes them; done once, when they are stored.",
            spec.order
        )
    },
    kernel: |spec| monomials(spec).conversion(if spec.has(OVER_PI[0]) { over_pi } else { cosine_lobe }),
    shown: |order| prepared(&TO_IRRADIANCE, order),
    ..PREPARED
};

/// `irradiance_prepared`.
pub static IRRADIANCE_PREPARED: Family = Family {
    name: "irradiance_prepared",
    stem: "irradiance_prepared",
    choices: &[AXES],
    what: |spec| {
        let from = Spec { chosen: axis_of(spec), ..Spec::new(&TO_IRRADIANCE, spec.order) };
        format!(
            "The irradiance of a surface that faces a direction, from the coefficients that `{from}` makes, of which `:over_pi` divides them by pi. For directions of unit length alone."
        )
    },
    kernel: |spec| monomials(spec).sum("the irradiance"),
    shown: |order| prepared(&IRRADIANCE_PREPARED, order),
    ..PREPARED
};

/// A kernel by what sums the coefficients at the direction, each band times its factor.
fn kernel(spec: &Spec, sum: impl FnOnce(&mut Graph, &[Id], &[Id], BandScale) -> Id) -> Kernel {
    let of_band = if spec.has(OVER_PI[0]) { over_pi_or_one } else { lobe_or_one };
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let c = signal(&mut builder, spec.order);
    let sum = sum(&mut builder.graph, &dir, &c, of_band);
    builder.finish(vec![sum], Shape::Scalar, "the irradiance")
}

/// Whether one channel is best done at once.
fn is_once(order: usize, rgb: bool) -> bool {
    order <= MAX_ONCE_ORDER && !rgb
}

fn axis_of(spec: &Spec) -> Vec<&'static str> {
    AXES.iter().copied().filter(|axis| spec.has(axis)).collect()
}

/// The monomials of the irradiance: those of degree 1 and of every even degree that is a band.
fn monomials(spec: &Spec) -> Monomials {
    Monomials::new(spec, |degree| degree < spec.order && !cosine_lobe(degree).is_zero())
}

fn sentence(spec: &Spec) -> String {
    let order = spec.order;
    let (over, what) = match spec.has(OVER_PI[0]) {
        false => ("", "Divided by pi, as `:over_pi` has it, it is what a white surface sends out."),
        true => (" divided by pi", "It is what a white surface sends out."),
    };
    let same = if order == MAX_ONCE_ORDER { " Band 3 is not read: irradiance has none." } else { "" };
    format!(
        "The irradiance{over} of a surface that faces a direction, from the coefficients of the radiance of order {order}: `convolve_cosine` and `eval` in one. {what}{same}"
    )
}

/// The catalogue's rows of a method: those that the name alone means.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    let usual = |spec: &Spec| (family.usual)(order, spec.rgb);
    if SHOWN.contains(&order) { Spec::new(family, order).both().into_iter().filter(usual).collect() } else { vec![] }
}

fn prepared(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { Spec::new(family, order).both() } else { vec![] }
}

/// The clamped cosine's factor where a band has one, else one: the odd bands above 1 are left out, but what they share with
/// others is not.
fn lobe_or_one(l: usize) -> Exact {
    let factor = cosine_lobe(l);
    if factor.is_zero() { Exact::one() } else { factor }
}

fn over_pi(l: usize) -> Exact {
    cosine_lobe(l) * Exact::pi_sqrt_power(-2)
}

fn over_pi_or_one(l: usize) -> Exact {
    lobe_or_one(l) * Exact::pi_sqrt_power(-2)
}
