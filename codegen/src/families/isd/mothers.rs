//! Isotropic decomposition by mother functions other than harmonics: the matrix M of all levels, its inverse, and shading by
//! the light convolved with each level's function (docs/MATH.md#mother-functions). Levels share no directions. Which functions
//! is a choice; an M that no shader's precision inverts is refused with its condition number.

use crate::families::family::{Acts, Family, Group, Measure, Proof, Spec};
use crate::families::isd::directions::{best_of, exact_unit, values};
use crate::families::isd::mother::{Decomposition, Levels, Mother};
use crate::families::isd::{SHADED, SHADING, light_and_back};
use crate::families::parts::params::signal;
use crate::families::parts::sums::inner;
use crate::families::parts::{columns, turned};
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::{Exact, Real};
use crate::math::inverse::inverse;
use crate::math::tables::legendre_polynomial;
use std::ops::RangeInclusive;

/// The orders: a matrix has order⁴ entries.
const ORDERS: RangeInclusive<usize> = 3..=5;
/// What a spec chooses from; the first if it does not.
const CHOICES: &[&str] = &[Mother::OWN[0].1, Mother::OWN[1].1, Mother::OWN[2].1, Mother::OWN[3].1];
/// What weights are.
const WEIGHTS: &str = "the weights, 2l+1 for level l from l^2 on, in the order of the level's directions";

fn outside(order: usize) -> [String; 2] {
    let [least, most] = [ORDERS.start(), ORDERS.end()];
    let help = format!("they have orders {least} to {most}; `isd_matrix` and `shade` take others");
    [format!("no mother functions are made into kernels of order {order}"), help]
}

/// What the families share.
const DECOMPOSED: Family = Family {
    group: Group::Shade,
    acts: Acts::Mixes,
    measure: Measure::Norm,
    proof: Proof::Nothing,
    half: false,
    orders: ORDERS,
    outside,
    choices: &[CHOICES],
    fault: |spec| Set::of(spec).err(),
    ..Family::PLAIN
};

/// `mother_matrix`.
pub static MOTHER_MATRIX: Family = Family {
    name: "mother_matrix",
    stem: "mother_matrix",
    what: |spec| {
        format!(
            "From the weights of turned copies of {} functions, one a level, to coefficients of order {}: c = M lambda (Soler et al. 2015, equations 16 and 17).",
            mother(spec).name(),
            spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let lambda = weights(&mut builder, spec.order);
        product(builder, &lambda, &set(spec).matrix(), "the coefficients, index l(l+1)+m")
    },
    shown: |order| shown(&MOTHER_MATRIX, order),
    ..DECOMPOSED
};

/// `mother_weights`.
pub static MOTHER_WEIGHTS: Family = Family {
    name: "mother_weights",
    stem: "mother_weights",
    what: |spec| {
        let (name, order) = (mother(spec).name(), spec.order);
        format!(
            "From coefficients of order {order} to the weights of turned copies of {name} functions: the inverse of `{}` (Soler et al. 2015).",
            spec.sibling(&MOTHER_MATRIX)
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let c = signal(&mut builder, spec.order);
        product(builder, &c, &set(spec).inverse(), WEIGHTS)
    },
    shown: |order| shown(&MOTHER_WEIGHTS, order),
    ..DECOMPOSED
};

/// `mother_shade`.
pub static MOTHER_SHADE: Family = Family {
    name: "mother_shade",
    stem: "mother_shade",
    what: |spec| {
        let (name, order) = (mother(spec).name(), spec.order);
        format!(
            "Shades by turned copies of {name} functions, of order {order}: the light, convolved with each level's function, at the level's directions, times the weights that `{}` makes (Soler et al. 2015, equations 6 and 17). `shade:{order}` gives the same for fewer operations.",
            spec.sibling(&MOTHER_WEIGHTS)
        )
    },
    orders: ORDERS,
    outside,
    choices: &[CHOICES],
    fault: |spec| Set::of(spec).err(),
    proof: Proof::Nothing,
    kernel: |spec| shade(spec),
    shown: |order| shown(&MOTHER_SHADE, order),
    ..SHADING
};

/// The rows of the catalogue: the lowest order, by the first of the functions.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if order == *ORDERS.start() { Spec::new(family, order).both() } else { vec![] }
}

fn mother(spec: &Spec) -> Mother {
    spec.chosen.iter().find_map(|choice| Mother::of_word(choice)).unwrap_or(Mother::OWN[0].0)
}

fn weights(builder: &mut Builder, order: usize) -> Vec<Id> {
    builder.param("lambda", Shape::Array(order * order), Domain::Signal, WEIGHTS)
}

/// The directions of a spec, which have been found to do.
fn set(spec: &Spec) -> Set {
    Set::of(spec).unwrap_or_else(|[message, help]| unreachable!("{message}; {help}"))
}

/// Kept directions, those of level l from l² on, and the functions that are turned to them.
struct Set {
    mother: Mother,
    order: usize,
    directions: Vec<[Exact; 3]>,
}

impl Set {
    /// Those of a spec, or why its matrix is of no use.
    fn of(spec: &Spec) -> Result<Self, [String; 2]> {
        let (mother, order) = (mother(spec), spec.order);
        let bands = order - 1;
        // The even function is tried at the directions of the one that it should be.
        let of = if mother == Mother::EvenPhong { Mother::Phong } else { mother };
        let none = || {
            let message = format!("no directions are kept for {} mother functions of {bands} bands", mother.name());
            [message, "`zonal search-directions --mother` finds them".to_owned()]
        };
        let record = best_of(Some(of), bands).ok_or_else(none)?;
        let unit = |v: &[f64; 3]| {
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            v.map(|x| x / length)
        };
        let own: Vec<[f64; 3]> = record.directions.iter().map(unit).collect();
        let made = Levels::own(bands, &own).and_then(|levels| Decomposition::new(mother, &levels));
        if let Err(message) = made {
            let (message, help) = message.split_once("; ").unwrap_or((&message, ""));
            return Err([message.to_owned(), help.to_owned()]);
        }
        let directions = record.directions.iter().map(|v| exact_unit(*v)).collect::<Option<_>>().ok_or_else(none)?;
        Ok(Self { mother, order, directions })
    }

    /// β_ll' π_l' for every band l' of a level: 2π ∫ φ_l P_l'.
    fn factors(&self, level: usize) -> Vec<Real> {
        let tau = Real::from_ratio(2, 1) * Real::pi();
        let moments = moments(self.mother, level, 2 * self.order);
        let polynomial = |l: usize| legendre_polynomial(l, 0).iter().map(Exact::to_real).collect::<Vec<_>>();
        let own = match self.mother {
            Mother::GaussLegendre => polynomial(level),
            _ => vec![Real::from_ratio(1, 1)],
        };
        let integral = |l: usize| {
            let mut sum = Real::zero();
            for (i, a) in own.iter().enumerate() {
                for (j, b) in polynomial(l).iter().enumerate() {
                    sum = sum + a * b * &moments[i + j];
                }
            }
            &tau * &sum
        };
        (0..self.order).map(integral).collect()
    }

    /// M by its rows, to 512 bits.
    fn matrix(&self) -> Vec<Vec<Exact>> {
        let columns: Vec<Vec<Exact>> = self
            .directions
            .iter()
            .enumerate()
            .map(|(i, direction)| {
                let factors = self.factors(i.isqrt());
                let band = |l: usize| {
                    let factor = Exact::real(factors[l].clone());
                    values(l, direction).into_iter().map(move |y| &factor * &y)
                };
                (0..self.order).flat_map(band).collect()
            })
            .collect();
        (0..columns.len()).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect()
    }

    fn inverse(&self) -> Vec<Vec<Exact>> {
        let rows: Vec<Vec<Real>> = self.matrix().iter().map(|row| row.iter().map(Exact::to_real).collect()).collect();
        let inverse = inverse(&rows).expect("a matrix of that condition has an inverse");
        inverse.into_iter().map(|row| row.into_iter().map(Exact::real).collect()).collect()
    }
}

/// e⁻¹ by its series, to more bits than are kept.
fn inverse_e() -> Real {
    let (mut term, mut sum) = (Real::from_ratio(1, 1), Real::from_ratio(1, 1));
    for k in 1..200i64 {
        term = term * Real::from_ratio(-1, k);
        sum = sum + &term;
    }
    sum
}

/// The integrals of z^k times the weight of a level, k below `count`: a Gaussian exp(−(1 − z) l²), max(0, z)^(4l) or z^(4l).
fn moments(mother: Mother, level: usize, count: usize) -> Vec<Real> {
    let kappa = (level * level) as i64;
    let power = |k: usize, from: i64| {
        // From −1 or 0 to 1.
        let exponent = (4 * level + k + 1) as i64;
        let low = if from < 0 && exponent % 2 != 0 { -1 } else { i64::from(from < 0) };
        Real::from_ratio(1 - low, exponent)
    };
    match mother {
        Mother::Phong => (0..count).map(|k| power(k, 0)).collect(),
        Mother::EvenPhong => (0..count).map(|k| power(k, -1)).collect(),
        _ if kappa == 0 => (0..count).map(|k| power(k, -1)).collect(),
        _ => {
            let (mut falling, one_over_e) = (Real::from_ratio(1, 1), inverse_e());
            (0..2 * kappa).for_each(|_| falling = &falling * &one_over_e);
            let mut all: Vec<Real> = Vec::new();
            for k in 0..count {
                // By parts: (1 − (−1)^k e^(−2κ)) / κ − k/κ times the one before.
                let ends = match k % 2 {
                    0 => Real::from_ratio(1, 1) - &falling,
                    _ => Real::from_ratio(1, 1) + &falling,
                };
                let before = all.last().map_or_else(Real::zero, |before| before * &Real::from_ratio(k as i64, 1));
                all.push((ends - before) / Real::from_ratio(kappa, 1));
            }
            all
        }
    }
}

fn product(mut builder: Builder, signal: &[Id], matrix: &[Vec<Exact>], doc: &str) -> Kernel {
    let out: Vec<Id> = matrix.iter().map(|row| builder.graph.dot(row, signal)).collect();
    builder.finish(out, Shape::Array(matrix.len()), doc)
}

/// Σ λ_lj Σ_l' β_ll' π_l' Σ_m e_l'm y_l'm(R⁻¹ z_lj).
fn shade(spec: &Spec) -> Kernel {
    let order = spec.order;
    let mut builder = Builder::new();
    let (e, back) = light_and_back(&mut builder, order);
    let lambda = weights(&mut builder, order);
    let g = &mut builder.graph;
    let set = set(spec);
    let factors: Vec<Vec<Exact>> = (0..order).map(|l| set.factors(l).into_iter().map(Exact::real).collect()).collect();
    let mut sum = None;
    for (i, dir) in turned::directions(g, &back, &set.directions).iter().enumerate() {
        let y = columns::values(g, dir, order, columns::orthonormal);
        let bands: Vec<Id> =
            (0..order).map(|l| inner(g, &e[l * l..(l + 1) * (l + 1)], &y[l * l..(l + 1) * (l + 1)])).collect();
        let convolved = g.dot(&factors[i.isqrt()], &bands);
        let term = g.mul(convolved, lambda[i]);
        sum = Some(sum.map_or(term, |sum| g.add(sum, term)));
    }
    let sum = sum.expect("there are directions");
    builder.finish(vec![sum], Shape::Scalar, SHADED)
}
