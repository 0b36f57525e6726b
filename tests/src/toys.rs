//! Kernels that no catalogue has, for what no kernel of the catalogue does: every choice, root, power and logarithm, and
//! products of two signals, straight and as loops.

use zonal_codegen::families::family::{Family, Looped, Measure, Spec};
use zonal_codegen::ir::graph::{Graph, Id, Kind};
use zonal_codegen::ir::kernel::{Builder, Domain, Kernel, Param, Shape};
use zonal_codegen::ir::op::Op;
use zonal_codegen::ir::program::{Int, LoopKernel, Num, Stmt, Table};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::index::coefficients;

/// The toys in every form that they have: straight and as a loop, of one channel and of three.
pub fn specs() -> Vec<Spec> {
    let all = [(&CHOICES, 3), (&PRODUCT, 2), (&PRODUCT, 3), (&CROSS, 2)];
    let forms = |(family, order): (&'static Family, usize)| {
        let spec = Spec::new(family, order);
        let looped = family.looped.filter(|looped| (looped.has)(&spec)).map(|_| spec.clone().looped());
        [spec].into_iter().chain(looped).flat_map(Spec::both).collect::<Vec<_>>()
    };
    all.into_iter().flat_map(forms).collect()
}

/// Every choice, root, power and logarithm, of the components of a direction, times coefficients of order 3; and choices
/// of coefficients.
pub static CHOICES: Family = Family {
    name: "choices",
    stem: "choices",
    what: |_| "Multiplies nine coefficients by what a direction's components are compared to: a toy.".to_owned(),
    kernel: |_| choices(),
    looped: Some(Looped { name: "choices", has: |_| true, kernel: |_| choices_loop() }),
    ..Family::PLAIN
};

const DIRECTION: &str = "the direction, of unit length";
const CHOSEN: &str = "the products";

fn choices() -> Kernel {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Vec3, Domain::Direction, DIRECTION);
    let c = builder.param("c", Shape::Array(9), Domain::Signal, "the coefficients");
    let [x, y, z] = dir[..] else { unreachable!("a direction has three components") };
    let g = &mut builder.graph;
    let half = |n: i64| Exact::ratio(n, 2);
    let [zero, low, high] = [half(0), half(-1), half(1)].map(|value| g.constant(value));
    let root = g.affine(&Exact::one(), z, &Exact::one());
    let root = g.sqrt(root);
    let three_x = g.scale(&Exact::int(3), x);
    let clamped = g.clamp(three_x, low, high);
    let power = g.exp2(y);
    let logarithm = g.affine(&half(1), z, &half(3));
    let logarithm = g.log2(logarithm);
    let minus_x = g.neg(x);
    let least = g.min(minus_x, y);
    let apart = g.sub(x, z);
    let apart = g.abs(apart);
    let [size_x, size_y] = [x, y].map(|v| g.abs(v));
    let longer = g.select_less(size_x, size_y, y, x);
    let most = g.max(x, z);
    let last = g.add(most, longer);
    let minus_c = g.neg(c[2]);
    let mut out = vec![
        g.mul(c[0], root),
        g.select_less(x, y, c[1], c[2]),
        g.select_at_most(z, zero, minus_c, c[3]),
        g.mul(c[3], clamped),
    ];
    let factors = [power, logarithm, least, apart, last];
    out.extend(c[4..].iter().zip(factors).map(|(&c, factor)| g.mul(c, factor)));
    builder.finish(out, Shape::Array(9), CHOSEN)
}

fn choices_loop() -> LoopKernel {
    let [x, y, z] = ["x", "y", "z"].map(|name| move || Num::Name(name));
    let half = |n: i64| Num::from(Exact::ratio(n, 2));
    let c = |i: usize| Num::item("c", i);
    let size = |a: Num| Num::of(Op::Abs(a));
    let clamped = Num::of(Op::Min(Num::of(Op::Max(x() * Exact::int(3), half(-1))), half(1)));
    let longer = Num::of(Op::Select(size(x()), size(y()), y(), x()));
    let factors = [
        Num::of(Op::Sqrt(z() + Exact::one())),
        clamped,
        Num::of(Op::Exp2(y())),
        Num::of(Op::Log2(z() * Exact::ratio(1, 2) + Exact::ratio(3, 2))),
        Num::of(Op::Min(-x(), y())),
        size(x() - z()),
        Num::of(Op::Max(x(), z())) + longer,
    ];
    let mut body: Vec<Stmt> =
        ["x", "y", "z"].into_iter().zip(0..).map(|(name, i)| Stmt::Let(name, Num::item("dir", i))).collect();
    body.push(Stmt::Array("factors", factors.len(), Kind::Scalar));
    body.extend(factors.into_iter().enumerate().map(|(i, factor)| Stmt::store("factors", i, factor)));
    let i = Int::Name("i");
    body.extend([
        Stmt::Array("r", 9, Kind::Signal),
        Stmt::store("r", 0, c(0) * Num::item("factors", 0)),
        Stmt::store("r", 1, Num::of(Op::Select(x(), y(), c(1), c(2)))),
        Stmt::store("r", 2, Num::of(Op::Select(half(0), z(), c(3), -c(2)))),
        Stmt::each("i", 3, 9, vec![Stmt::store("r", &i, Num::item("c", &i) * Num::item("factors", &i - 2))]),
    ]);
    LoopKernel {
        params: vec![
            Param::new("dir", Shape::Vec3, Domain::Direction, DIRECTION),
            Param::new("c", Shape::Array(9), Domain::Signal, "the coefficients"),
        ],
        tables: vec![],
        body,
        output: "r",
        result: Shape::Array(9),
        result_kind: Kind::Signal,
        result_doc: CHOSEN.to_owned(),
    }
}

/// The product of two functions on the sphere, cut off at its order (docs/MATH.md#products).
pub static PRODUCT: Family = Family {
    name: "toy_product",
    stem: "toy_product",
    what: |spec| format!("Multiplies two functions of order {}: a toy.", spec.order),
    kernel: |spec| product(spec.order),
    // lavapipe takes half a minute for the table of order 3.
    looped: Some(Looped { name: "toy_product", has: |spec| spec.order == 2, kernel: product_loop }),
    measure: Measure::Product,
    ..Family::PLAIN
};

const FUNCTION: &str = "the coefficients of a function, index l(l+1)+m";
const MULTIPLIED: &str = "the coefficients of the product";

fn product(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let count = order * order;
    let [a, b] = ["a", "b"].map(|name| builder.param(name, Shape::Array(count), Domain::Signal, FUNCTION));
    let g = &mut builder.graph;
    let both = |g: &mut Graph, i: usize, j: usize| -> Id {
        let pair = g.mul(a[i], b[j]);
        if i == j { pair } else { g.mul_add(a[j], b[i], pair) }
    };
    let out = (0..count)
        .map(|k| {
            let pairs = (0..count).flat_map(|i| (i..count).map(move |j| (i, j)));
            let terms: Vec<(Exact, Id)> = pairs
                .map(|(i, j)| (triple(i, j, k), i, j))
                .filter(|(factor, ..)| !factor.is_zero())
                .map(|(factor, i, j)| (factor, both(g, i, j)))
                .collect();
            let (factors, values): (Vec<Exact>, Vec<Id>) = terms.into_iter().unzip();
            g.dot(&factors, &values)
        })
        .collect();
    builder.finish(out, Shape::Array(count), MULTIPLIED)
}

fn product_loop(order: usize) -> LoopKernel {
    let count = order * order;
    let [i, j, k] = ["i", "j", "k"].map(Int::Name);
    let values = coefficients(order)
        .enumerate()
        .flat_map(|(k, _)| (0..count * count).map(move |pair| triple(pair / count, pair % count, k)));
    let term =
        |i: &Int, j: &Int| Num::item("a", i) * Num::item("b", j) * Num::item("TRIPLES", (&k * count + i) * count + j);
    let first = Int::Literal(0);
    let inner = vec![Stmt::Set("sum", Num::from("sum") + term(&i, &j))];
    let row = vec![
        Stmt::Var("sum", term(&first, &first)),
        Stmt::each("j", 1, count, vec![Stmt::Set("sum", Num::from("sum") + term(&first, &j))]),
        Stmt::each("i", 1, count, vec![Stmt::each("j", 0, count, inner)]),
        Stmt::store("r", &k, "sum"),
    ];
    LoopKernel {
        params: ["a", "b"].map(|name| Param::new(name, Shape::Array(count), Domain::Signal, FUNCTION)).to_vec(),
        tables: vec![Table {
            name: "TRIPLES",
            values: values.collect(),
            doc: "the integrals of three harmonics".to_owned(),
        }],
        body: vec![Stmt::Array("r", count, Kind::Product), Stmt::each("k", 0, count, row)],
        output: "r",
        result: Shape::Array(count),
        result_kind: Kind::Product,
        result_doc: MULTIPLIED.to_owned(),
    }
}

/// Products of two vectors with every sign that a sum of them can have.
pub static CROSS: Family = Family {
    name: "cross",
    stem: "cross",
    what: |_| "The cross product of two vectors less the products of their components: a toy.".to_owned(),
    kernel: |_| cross(),
    measure: Measure::Product,
    ..Family::PLAIN
};

fn cross() -> Kernel {
    let mut builder = Builder::new();
    let [a, b] = ["a", "b"].map(|name| builder.param(name, Shape::Array(3), Domain::Signal, "a vector"));
    let g = &mut builder.graph;
    let out = (0..3)
        .map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let [plus, minus, own] = [(j, k), (k, j), (i, i)].map(|(i, j)| g.mul(a[i], b[j]));
            let turned = g.sub(plus, minus);
            g.sub(turned, own)
        })
        .collect();
    builder.finish(out, Shape::Array(3), "the vector")
}

/// A polynomial in x, y and z: its factors and powers.
type Polynomial = Vec<(Exact, [usize; 3])>;

/// The harmonics of the bands 0 to 2 as polynomials, from their explicit forms.
fn harmonic(i: usize) -> Polynomial {
    let per_root_pi = |value: Exact| &value * &Exact::pi_sqrt_power(-1);
    let root = |p: i64, q: i64| per_root_pi(Exact::sqrt_ratio(p, q));
    match i {
        0 => vec![(root(1, 4), [0, 0, 0])],
        1 => vec![(-root(3, 4), [0, 1, 0])],
        2 => vec![(root(3, 4), [0, 0, 1])],
        3 => vec![(-root(3, 4), [1, 0, 0])],
        4 => vec![(root(15, 4), [1, 1, 0])],
        5 => vec![(-root(15, 4), [0, 1, 1])],
        6 => vec![(root(45, 16), [0, 0, 2]), (-root(5, 16), [0, 0, 0])],
        7 => vec![(-root(15, 4), [1, 0, 1])],
        8 => vec![(root(15, 16), [2, 0, 0]), (-root(15, 16), [0, 2, 0])],
        _ => unreachable!("the toys end at order 3"),
    }
}

/// ∫ y_i y_j y_k over the sphere, exactly: ∫ x^a y^b z^c is 4π (a−1)!! (b−1)!! (c−1)!! / (a+b+c+1)!! for even powers.
pub fn triple(i: usize, j: usize, k: usize) -> Exact {
    let odd_product = |n: usize| (1..=n).filter(|m| m % 2 == 1).map(|m| m as i64).product::<i64>();
    let monomial = |powers: [usize; 3]| match powers.iter().all(|power| power % 2 == 0) {
        true => Exact::ratio(
            4 * powers.map(|power| odd_product(power.saturating_sub(1))).iter().product::<i64>(),
            odd_product(powers.iter().sum::<usize>() + 1),
        ),
        false => Exact::zero(),
    };
    let mut sum = Exact::zero();
    for (p, powers_i) in harmonic(i) {
        for (q, powers_j) in harmonic(j) {
            for (r, powers_k) in harmonic(k) {
                let powers = std::array::from_fn(|n| powers_i[n] + powers_j[n] + powers_k[n]);
                sum = &sum + &(&(&(&p * &q) * &r) * &monomial(powers));
            }
        }
    }
    &sum * &Exact::pi_sqrt_power(2)
}
