//! Products of functions on the sphere, cut off at an order: of two, of one with itself, of a grey one with a coloured one, of
//! a zonal one with any (docs/MATH.md#products). What is linear in each of two signals has no proven bound: its error is
//! measured, against the product of both norms.

pub mod chosen;
pub mod cover;
pub mod grey;
pub mod plan;
pub mod rings;
pub mod search;
pub mod wave;
pub mod zonal;

use crate::families::family::{Acts, Family, Group, Measure, Spec};
use crate::families::parts::sums::inner;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use plan::{HIGHEST_ORDER, Task};

/// What the families of this folder have in common.
const COMMON: Family = Family {
    group: Group::Multiply,
    orders: 2..=HIGHEST_ORDER,
    outside: |order| {
        let help = format!("products have orders 2 to {HIGHEST_ORDER}: beyond, multiply on a grid of directions");
        [format!("a product of order {order} is too long"), help]
    },
    measure: Measure::Product,
    acts: Acts::Mixes,
    ..Family::PLAIN
};

/// The highest order of products in the catalogue.
const SHOWN: usize = 6;

/// `product`.
pub static PRODUCT: Family = Family {
    name: "product",
    stem: "product",
    what: |spec| {
        let ([a, b], order) = (spec.factor_orders(), spec.order);
        match spec.factors {
            None => {
                format!("Multiplies two functions of order {order}; what the product has beyond that order is cut off.")
            }
            Some(_) => format!(
                "Multiplies a function of order {a} and one of order {b}; the product is cut off at order {order}."
            ),
        }
    },
    factors: true,
    kernel: |spec| {
        let [a, b] = spec.factor_orders();
        product(a, b, spec.order, Domain::Signal)
    },
    shown: |order| {
        let whole = Spec::new(&PRODUCT, order);
        let with_two = whole.clone().of_factors([2, order]);
        match order {
            2 => whole.both(),
            3..=5 => [whole.both(), with_two.both()].concat(),
            SHOWN => whole.both(),
            _ => vec![],
        }
    },
    ..COMMON
};

/// `square`.
pub static SQUARE: Family = Family {
    name: "square",
    stem: "square",
    what: |spec| {
        let order = spec.order;
        format!("Multiplies a function of order {order} by itself; what the square has beyond that order is cut off.")
    },
    kernel: |spec| cover::kernel(&chosen::plan(Task::square(spec.order)), Domain::Signal),
    shown: |order| if order <= SHOWN { Spec::new(&SQUARE, order).both() } else { vec![] },
    ..COMMON
};

/// `dot`.
pub static DOT: Family = Family {
    name: "dot",
    stem: "dot",
    what: |spec| {
        let order = spec.order;
        format!("The integral over the sphere of the product of two functions of order {order}: the sum of a_i b_i.")
    },
    orders: Family::PLAIN.orders,
    outside: Family::PLAIN.outside,
    kernel: |spec| dot(spec.order),
    shown: |order| Spec::new(&DOT, order).both(),
    ..COMMON
};

/// Returns what a spec's plan is for; nothing where no plan makes it.
pub fn task(spec: &Spec) -> Option<Task> {
    let [a, b] = spec.factor_orders();
    match spec.family {
        family if *family == PRODUCT => Some(Task { orders: [a.min(b), a.max(b), spec.order], square: false }),
        family if *family == SQUARE => Some(Task::square(spec.order)),
        _ => None,
    }
}

/// The product of two functions, of which the first may be grey.
fn product(a: usize, b: usize, order: usize, first: Domain) -> Kernel {
    // A plan serves both ways round: the factors' places in it are exchanged, and the parameters are not.
    let orders = [a.min(b), a.max(b), order];
    let plan = chosen::plan(Task { orders, square: false });
    let mut builder = Builder::new();
    let a_values = cover::factor(&mut builder, "a", a, first);
    let b_values = cover::factor(&mut builder, "b", b, Domain::Signal);
    let places = if a <= b { [&a_values, &b_values] } else { [&b_values, &a_values] };
    let out = cover::product(&mut builder.graph, &plan, places[0], places[1]);
    cover::finish(builder, order, out)
}

fn dot(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let [a, b] = ["a", "b"].map(|name| cover::factor(&mut builder, name, order, Domain::Signal));
    let sum = inner(&mut builder.graph, &a, &b);
    builder.finish(vec![sum], Shape::Scalar, "the integral of the product")
}
