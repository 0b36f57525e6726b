//! Products by the matrix of one factor, which all channels of the other share (docs/MATH.md#one-factor-fixed).

use crate::families::family::{Family, Measure, Spec};
use crate::families::product::cover::{factor, finish};
use crate::families::product::wave::Waves;
use crate::families::product::{COMMON, product};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::ir::listing::Listing;
use crate::math::exact::Exact;
use crate::math::gaunt::{Mode, gaunt};
use crate::math::index::index;
use crate::math::tables::k;

/// The highest order of matrices: 646 numbers.
const HIGHEST: usize = 6;

/// What the families of matrices have in common.
const OF_MATRICES: Family = Family {
    orders: 2..=HIGHEST,
    outside: |order| {
        [format!("the matrix of order {order} is too long"), format!("matrices of products have orders 2 to {HIGHEST}")]
    },
    ..COMMON
};

/// `product_matrix`.
pub static MATRIX: Family = Family {
    name: "product_matrix",
    stem: "product_matrix",
    what: |spec| {
        let order = spec.order;
        format!(
            "The symmetric matrix M(a) by which the product of a function of order {order} and any other is M(a) b, cut off at the order; `product_by_matrix:{order}` applies it."
        )
    },
    kernel: |spec| of_matrix(spec.order),
    measure: Measure::Whole,
    shown: |order| if order <= 4 { Spec::new(&MATRIX, order).both() } else { vec![] },
    ..OF_MATRICES
};

/// `product_by_matrix`.
pub static BY_MATRIX: Family = Family {
    name: "product_by_matrix",
    stem: "product_by_matrix",
    what: |spec| {
        let order = spec.order;
        format!(
            "Multiplies functions of order {order} by the one whose matrix `product_matrix:{order}` made, once for many."
        )
    },
    kernel: |spec| by_matrix(spec.order),
    shown: |order| if order <= 4 { Spec::new(&BY_MATRIX, order).both() } else { vec![] },
    ..OF_MATRICES
};

/// `product_grey`.
pub static GREY: Family = Family {
    name: "product_grey",
    stem: "product_grey",
    what: |spec| {
        let order = spec.order;
        format!(
            "Multiplies a grey function of order {order} and a coloured one; what is made of the grey one alone is made once for all channels."
        )
    },
    kernel: |spec| grey(spec.order),
    shown: |order| if order <= 5 { Spec::new(&GREY, order).both() } else { vec![] },
    ..OF_MATRICES
};

const PACKED: &str = "the entries of the lower triangle of M(a), row by row, without those that are zero for every a";

/// How many numbers the lower triangle of a matrix has.
fn triangle(size: usize) -> usize {
    size * (size + 1) / 2
}

/// The place of an entry in the lower triangle.
fn place(i: usize, j: usize) -> usize {
    triangle(i.max(j)) + i.min(j)
}

/// The lower triangle of the matrix of a function; nothing where it is zero for every function.
fn matrix(g: &mut Graph, order: usize, a: &[Id]) -> Vec<Option<Id>> {
    let zero = g.constant(Exact::zero());
    let waves = Waves::of(a, zero);
    let constant = g.scale(&k(0, 0), a[0]);
    let modes: Vec<Mode> = (0..order).flat_map(|l| (0..=l).map(move |m| (l, m))).collect();
    let mut entries = vec![None; triangle(order * order)];
    for &x in &modes {
        for &y in modes.iter().filter(|y| (y.1, y.0) <= (x.1, x.0)) {
            // Σ over the thirds of the sum's order, and of the difference's.
            let mut sum = |m: usize, is_sum: bool| {
                (m..order).fold([zero; 2], |sum, l| match (l, m) {
                    (0, 0) if x == y => [constant, zero],
                    _ => {
                        let factor = if is_sum { gaunt(x, y, (l, m)) } else { gaunt(y, (l, m), x) };
                        let wave = waves.at((l, m));
                        [0, 1].map(|part| g.scale_add(&factor, wave[part], sum[part]))
                    }
                })
            };
            let plus = sum(x.1 + y.1, true);
            let minus = if y.1 == 0 { [zero; 2] } else { sum(x.1 - y.1, false) };
            let parts = [
                [g.add(plus[0], minus[0]), g.sub(plus[1], minus[1])],
                [g.add(plus[1], minus[1]), g.sub(minus[0], plus[0])],
            ];
            for (of_x, sign_x) in [(0, 1), (1, -1)].into_iter().take(1 + usize::from(x.1 > 0)) {
                for (of_y, sign_y) in [(0, 1), (1, -1)].into_iter().take(1 + usize::from(y.1 > 0)) {
                    let [i, j] = [(x, sign_x), (y, sign_y)].map(|((l, m), sign)| index(l, sign * m as isize));
                    let value = parts[of_x][of_y];
                    entries[place(i, j)] = (value != zero).then_some(value);
                }
            }
        }
    }
    entries
}

/// M b.
fn apply(g: &mut Graph, entries: &[Option<Id>], b: &[Id]) -> Vec<Id> {
    let zero = g.constant(Exact::zero());
    let row = |g: &mut Graph, i: usize| {
        let entries = (0..b.len()).filter_map(|j| entries[place(i, j)].map(|entry| (entry, b[j])));
        entries.fold(zero, |sum, (entry, value)| g.mul_add(entry, value, sum))
    };
    (0..b.len()).map(|i| row(g, i)).collect()
}

fn of_matrix(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let a = factor(&mut builder, "a", order, Domain::Signal);
    let out: Vec<Id> = matrix(&mut builder.graph, order, &a).into_iter().flatten().collect();
    let count = out.len();
    builder.finish(out, Shape::Array(count), PACKED)
}

fn by_matrix(order: usize) -> Kernel {
    // Which entries are zero for every function is seen on one of inputs.
    let mut other = Builder::new();
    let a = factor(&mut other, "a", order, Domain::Signal);
    let known = matrix(&mut other.graph, order, &a);
    let mut builder = Builder::new();
    let count = known.iter().flatten().count();
    let m = builder.param("m", Shape::Array(count), Domain::Grey, PACKED);
    let b = factor(&mut builder, "b", order, Domain::Signal);
    let mut given = m.into_iter();
    let entries: Vec<Option<Id>> = known.iter().map(|entry| entry.and_then(|_| given.next())).collect();
    let out = apply(&mut builder.graph, &entries, &b);
    finish(builder, order, out)
}

/// By the matrix or by the plan, whichever costs less for three channels.
fn grey(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let a = factor(&mut builder, "a", order, Domain::Grey);
    let b = factor(&mut builder, "b", order, Domain::Signal);
    let entries = matrix(&mut builder.graph, order, &a);
    let out = apply(&mut builder.graph, &entries, &b);
    let by_matrix = finish(builder, order, out);
    let by_plan = product(order, order, order, Domain::Grey);
    let cost = |kernel: &Kernel| Listing::new(kernel).cost(3).total;
    if cost(&by_matrix) < cost(&by_plan) { by_matrix } else { by_plan }
}
