//! The least value of an order-3 function on the sphere, with its direction and a lower bound, in straight lines: Jacobi's
//! rotations diagonalise the quadratic part, then Newton's steps climb to the root of the Lagrange dual
//! (docs/MATH.md#ringing). Every iterate is a lower bound; what f32 may round off of it is taken away.

use crate::families::family::{Family, Group, Measure, Proof, Spec};
use crate::families::parts::sums::inner;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Shape};
use crate::math::exact::Exact;

/// How often each of the three planes is turned: after the fourth time the planes are left apart to f64's rounding.
const SWEEPS: usize = 4;
/// How many steps Newton takes: six leave rounding, but for functions whose root is nearly double, of which eight leave 3e-7.
const STEPS: usize = 8;
/// How much of the bound is taken away, in square roots of the tiny number, 3e-8 in f32 and 1e-15 in f64.
const DOUBT: i64 = 32;

/// What the records of this file leave as it is.
const FOUND: Family = Family {
    group: Group::Irradiance,
    orders: 3..=3,
    outside: |order| {
        let help = "take `window:n` at another order, or the first nine coefficients";
        [format!("the least value of order {order} is no root in one variable"), help.to_owned()]
    },
    half: false,
    measure: Measure::Absolute,
    proof: Proof::Nothing,
    ..Family::PLAIN
};

/// `minimum`.
pub static MINIMUM: Family = Family {
    name: "minimum",
    stem: "minimum",
    direction: Some(1),
    what: |_| {
        "The least value on the sphere of a function of order 3, where it lies, and a bound below it: with rounding in f32 or f64 no value is less than the bound. Of irradiance, give its coefficients. For bands from 1e-7 to 1e15 in size.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder);
        let Least { value, direction: [x, y, z], bound, .. } = least(&mut builder.graph, &c);
        let doc = "the least value, the direction x, y, z of unit length in which it is, the bound";
        builder.finish(vec![value, x, y, z, bound], Shape::Array(5), doc)
    },
    shown: |order| Spec::only(&MINIMUM, order).into_iter().collect(),
    ..FOUND
};

/// `lerp_to_dc`.
pub static LERP_TO_DC: Family = Family {
    name: "lerp_to_dc",
    stem: "lerp_to_dc",
    what: |_| {
        "Fades a function of order 3 towards its mean until it is negative nowhere: the bands above 0 times s = m / (m - least), where m is the mean and least the bound that `minimum:3` finds; s is 1 where nothing is negative and 0 where the mean is not positive. For data that is blended; a shader clamps at no cost.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder);
        let g = &mut builder.graph;
        let Least { mean, bound, .. } = least(g, &c);
        let (zero, one, tiny) = (g.constant(Exact::zero()), g.constant(Exact::one()), g.tiny());
        let depth = g.sub(mean, bound);
        let depth = g.max(depth, tiny);
        let inverse = g.recip(depth);
        let share = g.mul(mean, inverse);
        let share = g.clamp(share, zero, one);
        let out = c.iter().enumerate().map(|(place, &c)| if place == 0 { c } else { g.mul(c, share) }).collect();
        builder.finish(out, Shape::Array(9), "the coefficients of the faded function")
    },
    shown: |order| Spec::only(&LERP_TO_DC, order).into_iter().collect(),
    ..FOUND
};

fn coefficients(builder: &mut Builder) -> Vec<Id> {
    builder.param("c", Shape::Array(9), Domain::Coefficients, "the coefficients of one channel, index l(l+1)+m")
}

/// What is found of a function.
struct Least {
    mean: Id,
    value: Id,
    direction: [Id; 3],
    bound: Id,
}

/// The function mean + b·n + nᵀAn in the eigenbasis of A.
struct Diagonal {
    mean: Id,
    linear: [Id; 3],
    values: [Id; 3],
    /// The rotations that led there: the plane, cosine and sine.
    turns: Vec<([usize; 2], [Id; 2])>,
}

/// (cos a − sin b, sin a + cos b).
fn turned(g: &mut Graph, [cos, sin]: [Id; 2], [a, b]: [Id; 2]) -> [Id; 2] {
    let (left, right) = (g.mul(sin, b), g.mul(sin, a));
    let (ca, cb) = (g.mul(cos, a), g.mul(cos, b));
    [g.sub(ca, left), g.add(cb, right)]
}

/// Jacobi's method, cyclic.
fn diagonal(g: &mut Graph, c: &[Id]) -> Diagonal {
    let factor = |p: i64, q: i64| Exact::sqrt_ratio(p, q) * Exact::pi_sqrt_power(-1);
    let mean = g.scale(&factor(1, 4), c[0]);
    let slope = factor(3, 4);
    let mut linear = [(-&slope, c[3]), (-&slope, c[1]), (slope, c[2])].map(|(factor, c)| g.scale(&factor, c));
    let (bend, height) = (factor(15, 16), g.scale(&factor(5, 16), c[6]));
    let rim = g.scale(&bend, c[8]);
    let (sum, below) = (g.add(rim, height), g.sub(rim, height));
    let mut values = [below, g.neg(sum), g.scale(&Exact::int(2), height)];
    // Entry i is that of the other two axes.
    let mut beside = [(-&bend, c[5]), (-&bend, c[7]), (bend, c[4])].map(|(factor, c)| g.scale(&factor, c));
    let (zero, one, tiny) = (g.constant(Exact::zero()), g.constant(Exact::one()), g.tiny());
    let mut turns = Vec::new();
    for plane in [[0, 1], [0, 2], [1, 2]].repeat(SWEEPS) {
        let [p, q] = plane;
        let r = 3 - p - q;
        let (apart, twice) = (g.sub(values[q], values[p]), g.scale(&Exact::int(2), beside[r]));
        let square = inner(g, &[apart, twice], &[apart, twice]);
        let (length, size) = (g.sqrt(square), g.abs(apart));
        let sum = g.add(size, length);
        let sum = g.add(sum, tiny);
        let inverse = g.recip(sum);
        let minus = g.neg(twice);
        let signed = g.select_less(apart, zero, minus, twice);
        let tangent = g.mul(signed, inverse);
        let secant = g.mul_add(tangent, tangent, one);
        let cos = g.rsqrt(secant);
        let turn = [cos, g.mul(tangent, cos)];
        let shift = g.mul(tangent, beside[r]);
        (values[p], values[q]) = (g.sub(values[p], shift), g.add(values[q], shift));
        // The entry between r and p is that of q.
        [beside[q], beside[p]] = turned(g, turn, [beside[q], beside[p]]);
        beside[r] = zero;
        [linear[p], linear[q]] = turned(g, turn, [linear[p], linear[q]]);
        turns.push((plane, turn));
    }
    Diagonal { mean, linear, values, turns }
}

/// The largest of three, or the least.
fn last_of(g: &mut Graph, [a, b, c]: [Id; 3], choose: fn(&mut Graph, Id, Id) -> Id) -> Id {
    let first = choose(g, a, b);
    choose(g, first, c)
}

fn least(g: &mut Graph, c: &[Id]) -> Least {
    let Diagonal { mean, linear, values, turns } = diagonal(g, c);
    let (zero, one, tiny) = (g.constant(Exact::zero()), g.constant(Exact::one()), g.tiny());
    let half = linear.map(|b| g.scale(&Exact::ratio(1, 2), b));
    // λ = μ − the least eigenvalue: gaps are exact where they vanish.
    let lowest = last_of(g, values, Graph::min);
    let gaps = values.map(|value| g.sub(value, lowest));
    let starts = std::array::from_fn(|i| {
        let size = g.abs(half[i]);
        g.sub(size, gaps[i])
    });
    let mut mu = last_of(g, starts, Graph::max);
    let at = |g: &mut Graph, mu: Id| {
        let above = g.add(mu, tiny);
        let inverse = gaps.map(|gap| {
            let sum = g.add(gap, above);
            g.recip(sum)
        });
        let x: [Id; 3] = std::array::from_fn(|i| g.mul(half[i], inverse[i]));
        (inverse, x)
    };
    for _ in 0..STEPS {
        let (inverse, x) = at(g, mu);
        let squares = x.map(|x| g.mul(x, x));
        let sum = g.add(squares[0], squares[1]);
        let square = g.add(sum, squares[2]);
        let slope = inner(g, &squares, &inverse);
        let slope = g.add(slope, tiny);
        let (length, inverse) = (g.sqrt(square), g.recip(slope));
        let excess = g.sub(length, one);
        let step = g.mul(excess, square);
        let step = g.mul(step, inverse);
        let step = g.max(step, zero);
        mu = g.add(mu, step);
    }
    let (_, x) = at(g, mu);
    let square = inner(g, &x, &x);
    // Where the root is the end of the domain, what is missing lies along the axis of the least value.
    let missing = g.sub(one, square);
    let enough = g.constant(Exact::ratio(1, 1i64 << 20));
    let missing = g.select_less(enough, missing, missing, zero);
    let is_first = |g: &mut Graph, i: usize, yes: Id, no: Id| g.select_at_most(gaps[i], zero, yes, no);
    let own = is_first(g, 1, x[1], x[2]);
    let own = is_first(g, 0, x[0], own);
    let longer = g.mul_add(own, own, missing);
    let longer = g.sqrt(longer);
    let minus = g.neg(longer);
    let longer = g.select_less(own, zero, minus, longer);
    let second = is_first(g, 1, longer, x[1]);
    let third = is_first(g, 1, x[2], longer);
    let whole = [is_first(g, 0, longer, x[0]), is_first(g, 0, x[1], second), is_first(g, 0, x[2], third)];
    let square = inner(g, &whole, &whole);
    let shorter = g.rsqrt(square);
    let mut n = whole.map(|x| {
        let unit = g.mul(x, shorter);
        g.neg(unit)
    });
    let curved: [Id; 3] = std::array::from_fn(|i| g.mul_add(values[i], n[i], linear[i]));
    let value = inner(g, &curved, &n);
    let value = g.add(value, mean);
    // mean − λ − Σ x b / 2, less what may be rounded off.
    let dual = inner(g, &x, &half);
    let climb = g.sub(lowest, mu);
    let dual = g.sub(climb, dual);
    let dual = g.add(dual, mean);
    let (of_mean, of_lowest) = (g.abs(mean), g.abs(lowest));
    let size = g.add(of_mean, of_lowest);
    let size = g.add(size, mu);
    let (square, unit) = (g.mul(size, size), g.tiny());
    let square = g.mul(square, unit);
    let root = g.sqrt(square);
    let doubt = g.scale(&Exact::int(DOUBT), root);
    let bound = g.sub(dual, doubt);
    for &([p, q], [cos, sin]) in turns.iter().rev() {
        let back = g.neg(sin);
        [n[p], n[q]] = turned(g, [cos, back], [n[p], n[q]]);
    }
    Least { mean, value, direction: n, bound }
}
