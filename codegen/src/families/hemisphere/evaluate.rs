//! Hemispherical harmonics at a direction, and sums of them. z is taken as at least 1e-36, which is the only place where pole,
//! horizon and what lies below it are thought of: one inverse square root maps the hemisphere to the sphere, and all else is
//! the sphere's (docs/MATH.md#hemispherical-harmonics).

use crate::families::basis;
use crate::families::family::{Acts, Family, Measure, Proof, Spec};
use crate::families::hemisphere::{COMMON, signal};
use crate::families::parts::bivariate;
use crate::families::parts::columns::{Columns, Scaled, Sectoral, sectoral_factor};
use crate::families::parts::polynomial::Polynomial;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::index::coefficients;
use num_bigint::BigInt;

/// What a direction below the horizon gets, as a sentence.
const BELOW: &str = "A direction below the horizon gets what the horizon has: (-1)^l sqrt((2l+1)/(2 pi)) for m = 0, zero for the others.";

/// `hsh_basis`.
pub static HSH_BASIS: Family = Family {
    name: "hsh_basis",
    stem: "hsh_basis",
    what: |spec| {
        let order = spec.order;
        format!(
            "The hemispherical harmonics of order {order} at a direction (Gautron et al. 2004, without their singularity at the pole). {BELOW}"
        )
    },
    kernel: |spec| basis(spec.order),
    measure: Measure::Absolute,
    proof: Proof::Nothing,
    shown: |order| vec![Spec::new(&HSH_BASIS, order)],
    ..COMMON
};

/// `hsh_eval`.
pub static HSH_EVAL: Family = Family {
    name: "hsh_eval",
    stem: "hsh_eval",
    what: |spec| {
        let order = spec.order;
        format!(
            "The sum of c_i H_i(dir) over the hemispherical harmonics of order {order}, without storing them. {BELOW}"
        )
    },
    kernel: |spec| eval(spec.order),
    measure: Measure::Whole,
    proof: Proof::Nothing,
    shown: |order| Spec::new(&HSH_EVAL, order).both(),
    ..COMMON
};

/// `hsh_eval_monomial`.
pub static HSH_EVAL_MONOMIAL: Family = Family {
    name: "hsh_eval_monomial",
    stem: "hsh_eval_monomial",
    what: |spec| {
        let order = spec.order;
        format!(
            "The sum of c_i H_i(dir) over the hemispherical harmonics of order {order}, from the coefficients that `hsh_to_monomial:{order}` makes. {BELOW} The error in f32 doubles with each order: from order 7 on `hsh_eval:{order}` is the more exact."
        )
    },
    kernel: |spec| eval_monomial(spec.order),
    measure: Measure::Whole,
    proof: Proof::Nothing,
    shown: |order| Spec::new(&HSH_EVAL_MONOMIAL, order).both(),
    ..COMMON
};

/// `hsh_to_monomial`.
pub static HSH_TO_MONOMIAL: Family = Family {
    name: "hsh_to_monomial",
    stem: "hsh_to_monomial",
    what: |spec| {
        let order = spec.order;
        format!(
            "From hemispherical coefficients of order {order} to those of the monomials that `hsh_eval_monomial:{order}` takes; done once, when they are stored."
        )
    },
    kernel: |spec| to_monomial(spec.order),
    acts: Acts::Mixes,
    shown: |order| Spec::new(&HSH_TO_MONOMIAL, order).both(),
    ..COMMON
};

/// Declares the direction.
fn direction(builder: &mut Builder) -> Vec<Id> {
    builder.param(
        "dir",
        Shape::Vec3,
        Domain::Direction,
        "the direction, of unit length; its z is taken as at least 1e-36",
    )
}

/// z, at least 1e-36, and 1 / √(z² + z). Zero would give zero times infinity.
fn height(g: &mut Graph, z: Id) -> [Id; 2] {
    let least = g.constant(Exact::ratio(1, BigInt::from(10).pow(36)));
    let z = g.max(z, least);
    let square = g.mul_add(z, z, z);
    [z, g.rsqrt(square)]
}

/// k = 2z / √(z² + z) and 2z − 1, by which a direction of height z goes to the stretched sphere.
pub fn stretch(g: &mut Graph, z: Id) -> [Id; 2] {
    let [z, root] = height(g, z);
    let twice = g.scale(&Exact::int(2), z);
    let one = g.constant(Exact::one());
    [g.mul(twice, root), g.sub(twice, one)]
}

/// What the sphere's harmonics are multiplied by.
pub fn hemispheric(_band: usize) -> Exact {
    Exact::sqrt_ratio(2, 1)
}

/// (kx, ky, 2z − 1), k = 2z / √(z² + z), multiplied so that x and y are the harmonics of band 1 already; at orders 2 and 3
/// z too, one operation cheaper and half as exact.
fn stretched(g: &mut Graph, dir: &[Id], order: usize) -> Scaled {
    let [z, root] = height(g, dir[2]);
    let across = &sectoral_factor(1) * &hemispheric(1);
    let size = across.abs();
    let twice = g.scale(&(&size * &Exact::int(2)), z);
    let k = g.mul(twice, root);
    let minus = g.neg(k);
    let (x, y) = (g.mul(minus, dir[0]), g.mul(minus, dir[1]));
    let (z, along) = match order {
        2 | 3 => {
            let constant = g.constant(size.clone());
            (g.sub(twice, constant), size)
        }
        _ => (g.affine(&Exact::int(2), z, &Exact::int(-1)), Exact::one()),
    };
    Scaled { xyz: [x, y, z], across, along }
}

fn basis(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let g = &mut builder.graph;
    let dir = stretched(g, &dir, order);
    let out = Columns::new(g, &dir, order, hemispheric, Sectoral::SafeCubes).values(g, order);
    builder.finish(out, Shape::Array(order * order), "H_lm(dir), bands ascending, m from −l to l")
}

fn eval(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let dir = stretched(g, &dir, order);
    let places: Vec<Option<usize>> = (0..order * order).map(Some).collect();
    let sum = basis::sum_at(g, &dir, &c, &places, hemispheric);
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i H_i(dir)")
}

/// What the coefficients of monomials are.
const LAYOUT: &str = "of the monomials by degree d from d^2 on: Y^d, X Y^(d-1), ..., X^d, then z times those of degree d-1, where (X, Y) = (x, y) sqrt(z/(1+z))";

fn eval_monomial(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let doc = format!("the coefficients {LAYOUT}");
    let c = builder.param("c", Shape::Array(order * order), Domain::Signal, doc);
    let g = &mut builder.graph;
    let [z, root] = height(g, dir[2]);
    let half = g.mul(z, root);
    let (x, y) = (g.mul(half, dir[0]), g.mul(half, dir[1]));
    let sum = bivariate::sum(g, [x, y, z], &bivariate::monomials(order), &c);
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i H_i(dir)")
}

fn to_monomial(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    // X² + Y² = z (1 − z).
    let minus = -Exact::one();
    let square = Polynomial::new([([0, 0, 1], Exact::one()), ([2, 0, 0], minus.clone()), ([0, 2, 0], minus.clone())]);
    let functions: Vec<(Id, Polynomial)> = coefficients(order)
        .zip(&c)
        .map(|((l, m), &c)| {
            let harmonic = Polynomial::harmonic(l, m, &Exact::int(2), [minus.clone(), Exact::int(2)]);
            (c, bivariate::reduced(&harmonic.scaled(&hemispheric(l)), &square))
        })
        .collect();
    let out = bivariate::converted(&mut builder.graph, &functions, &bivariate::monomials(order));
    builder.finish(out, Shape::Array(order * order), format!("the coefficients {LAYOUT}"))
}
