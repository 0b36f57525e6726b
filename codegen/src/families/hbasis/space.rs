//! The functions of the H-basis and of the Half-Life 2 basis as polynomials, and matrices between bases as integrals over
//! the upper hemisphere.

use crate::families::family::{Family, Group, Measure, Spec};
use crate::families::parts::polynomial::Polynomial;
use crate::families::parts::sums::inner;
use crate::families::parts::zonal::cosine_lobe;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Shape};
use crate::math::exact::Exact;

/// What the records of this folder leave as it is: kernels of one order, linear in coefficients that are no bands.
pub(super) const OF_ONE_ORDER: Family =
    Family { group: Group::Irradiance, one_order: true, measure: Measure::Norm, ..Family::PLAIN };

/// What a spec chooses where the normal is to be made a unit first.
pub(super) const NORMALISED: &[&str] = &["normalised"];

/// The shortest mean of normals that a normalised kernel promises something of.
const SHORTEST: f64 = 0.0625;

/// What the monomials of these bases are, in the order of their coefficients.
pub(super) const MONOMIALS: [&str; 6] = ["1", "y", "z", "x", "xy", "x^2-y^2"];

/// √(p/q π^k).
pub(super) fn root(p: i64, q: i64, k: i32) -> Exact {
    Exact::sqrt_ratio(p, q) * Exact::pi_sqrt_power(k)
}

fn axis(i: usize) -> Polynomial {
    let mut powers = [0; 3];
    powers[i] = 1;
    Polynomial::new([(powers, Exact::one())])
}

/// The monomials of six coefficients: 1, y, z, x, xy, x² − y².
pub(super) fn monomials() -> [Polynomial; 6] {
    let [x, y, z] = [0, 1, 2].map(axis);
    let rim = x.times(&x).plus(&-Exact::one(), &y.times(&y));
    [Polynomial::one(), y.clone(), z, x.clone(), x.times(&y), rim]
}

/// For each function of the H-basis its coefficients of [`monomials`] (Habel and Wimmer 2010, eq. 10).
pub(super) fn in_monomials() -> [[Exact; 6]; 6] {
    let (slope, bend) = (root(3, 2, -1), root(15, 2, -1));
    let mut rows: [[Exact; 6]; 6] = std::array::from_fn(|_| std::array::from_fn(|_| Exact::zero()));
    rows[0][0] = root(1, 2, -1);
    rows[1][1] = -&slope;
    rows[2][0] = -&slope;
    rows[2][2] = &slope * &Exact::int(2);
    rows[3][3] = -&slope;
    rows[5][5] = &bend * &Exact::ratio(1, 2);
    rows[4][4] = bend;
    rows
}

/// The first four or all six functions of the H-basis.
pub(super) fn h(count: usize) -> Vec<Polynomial> {
    let monomials = monomials();
    let function = |row: [Exact; 6]| {
        row.iter().zip(&monomials).fold(Polynomial::default(), |sum, (factor, monomial)| sum.plus(factor, monomial))
    };
    in_monomials().into_iter().take(count).map(function).collect()
}

/// The vectors that the three functions of the Half-Life 2 basis are the scalar products of a normal with.
pub(super) fn half_life_vectors() -> [[Exact; 3]; 3] {
    let norm = root(3, 2, -1);
    let along = &norm * &Exact::sqrt_ratio(1, 3);
    let [near, side, far] = [(1, 6), (1, 2), (2, 3)].map(|(p, q)| &norm * &Exact::sqrt_ratio(p, q));
    [[-&near, -&side, along.clone()], [-near, side, along.clone()], [far, Exact::zero(), along]]
}

/// The functions of the Half-Life 2 basis.
pub(super) fn half_life() -> Vec<Polynomial> {
    let function = |vector: [Exact; 3]| {
        vector.iter().enumerate().fold(Polynomial::default(), |sum, (i, factor)| sum.plus(factor, &axis(i)))
    };
    half_life_vectors().into_iter().map(function).collect()
}

/// The components of a direction as functions.
pub(super) fn components() -> Vec<Polynomial> {
    (0..3).map(axis).collect()
}

/// The matrix of integrals over the upper hemisphere, a row for each function.
pub(super) fn integrals(rows: &[Polynomial], columns: &[Polynomial]) -> Vec<Vec<Exact>> {
    rows.iter().map(|row| columns.iter().map(|column| row.times(column).over_hemisphere()).collect()).collect()
}

/// The harmonics of an order, each times what a spec asks for: its band's factor of the cosine unless it is irradiance
/// already, by π where it is irradiance over π.
pub(super) fn light(spec: &Spec) -> Vec<Polynomial> {
    let over = if spec.has("over_pi") { Exact::pi_sqrt_power(-2) } else { Exact::one() };
    crate::math::index::coefficients(spec.order)
        .map(|(l, m)| {
            let cosine = cosine_lobe(l);
            // Irradiance has nothing in the bands that the cosine has not.
            let factor = if spec.has("irradiance") && !cosine.is_zero() { Exact::one() } else { cosine };
            match factor.is_zero() {
                true => Polynomial::default(),
                false => {
                    let unit = [Exact::zero(), Exact::one()];
                    Polynomial::harmonic(l, m, &Exact::one(), unit).scaled(&(&factor * &over))
                }
            }
        })
        .collect()
}

/// Returns each row's sum over the coefficients.
pub(super) fn rows(g: &mut Graph, matrix: &[Vec<Exact>], c: &[Id]) -> Vec<Id> {
    matrix.iter().map(|row| g.dot(row, c)).collect()
}

/// Declares the normal, and makes it a unit where the spec asks for it.
pub(super) fn mean_normal(builder: &mut Builder, spec: &Spec) -> [Id; 3] {
    let is_unit = spec.has(NORMALISED[0]);
    let (least, doc) = match is_unit {
        true => (SHORTEST, "the normal, which is made a unit"),
        false => (0.0, "the normal, or a mean of unit normals, which is taken as it is"),
    };
    let dir = builder.param("dir", Shape::Vec3, Domain::MeanNormal(least), doc);
    let dir = [dir[0], dir[1], dir[2]];
    if !is_unit {
        return dir;
    }
    let g = &mut builder.graph;
    // The tiny number leaves zeros what they are.
    let tiny = g.tiny();
    let square = dir.iter().fold(tiny, |sum, &x| g.mul_add(x, x, sum));
    let shorter = g.rsqrt(square);
    dir.map(|x| g.mul(x, shorter))
}

/// What is wrong with a spec in f16 whose normal is made a unit.
pub(super) fn no_half(spec: &Spec) -> Option<[String; 2]> {
    (spec.half && spec.has(NORMALISED[0])).then(|| {
        let help = "normalise in f32, or leave `normalised` out: a mean of normals is taken as it is";
        ["a length of zero is not told apart in f16".to_owned(), help.to_owned()]
    })
}

/// What is said of normals below the horizon and of their lengths.
pub(super) fn of_normals(spec: &Spec) -> &'static str {
    match spec.has(NORMALISED[0]) {
        true => "The normal is made a unit; a zero one stays zero. Below the horizon the polynomials go on.",
        false => {
            "The normal need not be a unit: means of normals are to be given as they are. Below the horizon the polynomials go on."
        }
    }
}

/// Declares the coefficients of a basis.
pub(super) fn coefficients(builder: &mut Builder, count: usize, doc: &str) -> Vec<Id> {
    builder.param("c", Shape::Array(count), Domain::Signal, doc)
}

/// Returns Σ cᵢ bᵢ.
pub(super) fn product(g: &mut Graph, values: &[Id], c: &[Id]) -> Id {
    inner(g, c, values)
}
