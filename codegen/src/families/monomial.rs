//! Evaluation in monomials. To order 8 it is A(x, y) + z B(x, y), any axis in the place of z, by Horner's rule in both: n² − 1
//! multiply-adds a channel and nothing shared, the floor for n² free coefficients
//! (docs/MATH.md#evaluation-at-the-floor). Beyond, where the elimination of z² would cost digits, it is Σ over m of Re or
//! Im (x + iy)^m times a polynomial in z (docs/MATH.md#monomials). The coefficients are turned once, when they are stored,
//! by `to_monomial`.

use crate::families::family::{Acts, Family, Group, Measure, Spec};
use crate::families::parts::bivariate;
use crate::families::parts::params::{direction, signal};
use crate::families::parts::phases::{Phase, turn};
use crate::families::parts::polynomial::{Polynomial, Powers};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::index::{coefficients, index};
use crate::math::tables;

/// The largest order at which the powers of two coordinates replace those of x + iy.
pub const MAX_FLOOR_ORDER: usize = 8;

/// The largest order at which f32 errs by not more than may be lost to an evaluation: the error doubles with each order.
pub const MAX_EXACT_ORDER: usize = 6;

/// The axes that may be the linear one in the place of z, as a spec chooses them.
pub const AXES: &[&str] = &["x", "y"];

/// `eval_monomial`.
pub static EVAL_MONOMIAL: Family = Family {
    name: "eval_monomial",
    stem: "eval_monomial",
    group: Group::Evaluate,
    choices: &[AXES],
    fault: axis_fault,
    what: |spec| {
        let of = spec.sibling(&TO_MONOMIAL);
        let order = spec.order;
        let growth = match order <= MAX_FLOOR_ORDER {
            true => format!(
                " For directions of unit length alone. The error in f32 doubles with each order: from order {} on `eval` is the more exact.",
                MAX_EXACT_ORDER + 1
            ),
            false => String::new(),
        };
        format!(
            "The sum of c_i y_i(dir) over the harmonics of order {order}, from the coefficients that `{of}` makes.{growth}"
        )
    },
    kernel: |spec| match spec.order <= MAX_FLOOR_ORDER {
        true => Monomials::new(spec, |_| true).sum("Σ c_i y_i(dir)"),
        false => columns(spec.order),
    },
    measure: Measure::Whole,
    shown: |order| Spec::new(&EVAL_MONOMIAL, order).both(),
    ..Family::PLAIN
};

/// `to_monomial`.
pub static TO_MONOMIAL: Family = Family {
    name: "to_monomial",
    stem: "to_monomial",
    group: Group::Evaluate,
    choices: &[AXES],
    fault: axis_fault,
    what: |spec| {
        let of = spec.sibling(&EVAL_MONOMIAL);
        let order = spec.order;
        format!(
            "From the coefficients of the harmonics of order {order} to those of the monomials that `{of}` takes; done once, when they are stored."
        )
    },
    kernel: |spec| match spec.order <= MAX_FLOOR_ORDER {
        true => Monomials::new(spec, |_| true).conversion(|_| Exact::one()),
        false => to_columns(spec.order),
    },
    acts: Acts::Mixes,
    shown: |order| Spec::new(&TO_MONOMIAL, order).both(),
    ..Family::PLAIN
};

fn axis_fault(spec: &Spec) -> Option<[String; 2]> {
    let chosen = AXES.iter().find(|axis| spec.has(axis))?;
    (spec.order > MAX_FLOOR_ORDER).then(|| {
        let help = format!("leave `{chosen}` out, or take an order to {MAX_FLOOR_ORDER}");
        [format!("at order {} monomials are powers of x + iy and z", spec.order), help]
    })
}

/// The monomials of a spec's axes, of some degrees.
pub struct Monomials {
    order: usize,
    /// Which axes x, y, z are the two free coordinates and the linear one.
    axes: [usize; 3],
    powers: Vec<Powers>,
    /// What their coefficients are.
    layout: String,
}

impl Monomials {
    /// Those of the degrees that are there.
    pub fn new(spec: &Spec, is_there: impl Fn(usize) -> bool) -> Self {
        let axes = match (spec.has("x"), spec.has("y")) {
            (true, _) => [1, 2, 0],
            (_, true) => [0, 2, 1],
            _ => [0, 1, 2],
        };
        let [a, b, linear] = axes.map(|axis| ["x", "y", "z"][axis]);
        let degrees: Vec<usize> = (0..spec.order).filter(|&d| is_there(d)).collect();
        let which = match degrees.len() == spec.order {
            true => "by degree d, from index d^2 on".to_owned(),
            false => {
                let degrees: Vec<String> = degrees.iter().map(usize::to_string).collect();
                format!("of the degrees d = {}, one after the other", degrees.join(", "))
            }
        };
        let layout = format!(
            "the coefficients of the monomials {which}: {b}^d, {a} {b}^(d-1), ..., {a}^d, then {linear} times those of degree d-1"
        );
        let all = bivariate::monomials(spec.order);
        let powers = all.into_iter().filter(|powers| degrees.contains(&powers.iter().sum())).collect();
        Self { order: spec.order, axes, powers, layout }
    }

    /// The kernel of their sum at a direction.
    pub fn sum(&self, result: &str) -> Kernel {
        let mut builder = Builder::new();
        let dir = direction(&mut builder);
        let c = builder.param("c", Shape::Array(self.powers.len()), Domain::Signal, self.layout.clone());
        let at = self.axes.map(|axis| dir[axis]);
        let sum = bivariate::sum(&mut builder.graph, at, &self.powers, &c);
        builder.finish(vec![sum], Shape::Scalar, result)
    }

    /// The kernel that makes their coefficients of those of harmonics, each band scaled.
    pub fn conversion(&self, scale: fn(usize) -> Exact) -> Kernel {
        let mut builder = Builder::new();
        let c = signal(&mut builder, self.order);
        let mut place = [0; 3];
        self.axes.iter().enumerate().for_each(|(at, &axis)| place[axis] = at);
        let square = bivariate::on_the_sphere();
        let functions: Vec<(Id, Polynomial)> = coefficients(self.order)
            .zip(&c)
            .map(|((l, m), &c)| {
                let harmonic = Polynomial::harmonic(l, m, &Exact::one(), [Exact::zero(), Exact::one()]);
                (c, bivariate::reduced(&harmonic.scaled(&scale(l)).renamed(place), &square))
            })
            .collect();
        let out = bivariate::converted(&mut builder.graph, &functions, &self.powers);
        builder.finish(out, Shape::Array(self.powers.len()), self.layout.clone())
    }
}

const COLUMNS: &str = "of z^(l−|m|) Re (x+iy)^m, Im and |m| for m < 0, index l(l+1)+m";

/// The kernel `eval_monomial` in powers of x + iy.
fn columns(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let c = builder.param("c", Shape::Array(order * order), Domain::Signal, format!("the coefficients {COLUMNS}"));
    let g = &mut builder.graph;
    let [x, y, z] = [dir[0], dir[1], dir[2]];
    let horner = |g: &mut Graph, m: isize| -> Id {
        let coefficients = (m.unsigned_abs()..order).map(|l| c[index(l, m)]);
        coefficients.rev().reduce(|nested, next| g.mul_add(nested, z, next)).expect("a column holds its own degree")
    };
    let mut sum = horner(g, 0);
    let mut power = Phase { cos: x, sin: y };
    for m in 1..order as isize {
        if m > 1 {
            power = turn(g, power, Phase { cos: x, sin: y });
        }
        for (part, sign) in [(power.cos, 1), (power.sin, -1)] {
            let column = horner(g, sign * m);
            sum = g.mul_add(column, part, sum);
        }
    }
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i y_i(dir)")
}

/// The kernel `to_monomial` in powers of x + iy, a triangular map in each m.
fn to_columns(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let zero = g.constant(Exact::zero());
    let mut out = vec![zero; order * order];
    let extent = order as isize - 1;
    for m in -extent..=extent {
        let lowest = m.unsigned_abs();
        for l in (lowest..order).rev() {
            let factor = tables::basis_factor(l, m);
            for (power, value) in tables::legendre_polynomial(l, lowest).into_iter().enumerate() {
                let place = index(lowest + power, m);
                out[place] = g.scale_add(&(&factor * &value), c[index(l, m)], out[place]);
            }
        }
    }
    builder.finish(out, Shape::Array(order * order), format!("the coefficients {COLUMNS}"))
}
