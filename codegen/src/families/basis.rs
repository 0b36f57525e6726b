//! The basis at a direction, and sums over it that do not store it.

use crate::families::family::{Family, Group, Looped, Measure, Spec};
use crate::families::loops;
use crate::families::parts::columns::{self, BandScale, Columns, Scaled, Sectoral};
use crate::families::parts::once::once;
use crate::families::parts::params::{direction, signal};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::index::index;
use crate::math::tables;

/// The bands that irradiance has below order 5: the cosine lobe has no band 3.
pub const IRRADIANCE_BANDS: [usize; 4] = [0, 1, 2, 4];

/// `basis`.
pub static BASIS: Family = Family {
    name: "basis",
    stem: "basis",
    group: Group::Evaluate,
    what: |spec| {
        format!(
            "The spherical harmonics {} at a direction, accurate also near the poles (Sloan 2013's recurrence, rearranged).",
            spec.which_bands()
        )
    },
    some_bands: true,
    looped: Some(Looped { name: "basis", has: Spec::is_whole, kernel: loops::basis_loop }),
    kernel: |spec| basis(spec.order, &spec.bands),
    measure: Measure::Absolute,
    shown: |order| vec![Spec::new(&BASIS, order), Spec::new(&BASIS, order).looped()],
    ..Family::PLAIN
};

/// `eval`.
pub static EVAL: Family = Family {
    name: "eval",
    method: "nested",
    stem: "eval",
    group: Group::Evaluate,
    what: |spec| {
        format!("The sum of c_i y_i(dir) over the harmonics {}, without storing the basis.", spec.which_bands())
    },
    some_bands: true,
    kernel: |spec| eval(spec.order, &spec.bands),
    measure: Measure::Whole,
    shown: |order| {
        let mut specs = Spec::new(&EVAL, order).both();
        if order == 5 {
            let irradiance = Spec { bands: IRRADIANCE_BANDS.to_vec(), ..Spec::new(&EVAL, order) };
            specs.extend(irradiance.both());
        }
        specs
    },
    ..Family::PLAIN
};

/// `eval:n:once`.
pub static EVAL_ONCE: Family = Family {
    name: "eval",
    method: "once",
    stem: "eval_once",
    usual: |_, _| false,
    group: Group::Evaluate,
    orders: 2..=3,
    outside: |order| {
        let help = format!("leave `once` out, as in `eval:{order}`");
        [format!("a sum is done at once at the orders 2 and 3, not at order {order}"), help]
    },
    what: |spec| {
        format!(
            "The sum of c_i y_i(dir) over the harmonics of order {}, for one channel in the fewest operations; channels share none of them.",
            spec.order
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let dir = direction(&mut builder);
        let c = signal(&mut builder, spec.order);
        let sum = once(&mut builder.graph, [dir[0], dir[1], dir[2]], &c, columns::orthonormal);
        builder.finish(vec![sum], Shape::Scalar, "Σ c_i y_i(dir)")
    },
    measure: Measure::Whole,
    shown: |order| Spec::only(&EVAL_ONCE, order).into_iter().collect(),
    ..Family::PLAIN
};

/// The flat indices that the coefficients of some bands have in a packed array of those bands alone.
fn packed(bands: &[usize], order: usize) -> Vec<Option<usize>> {
    let mut places = vec![None; order * order];
    let mut next = 0;
    for &l in bands {
        for place in &mut places[l * l..(l + 1) * (l + 1)] {
            *place = Some(next);
            next += 1;
        }
    }
    places
}

fn coefficients_of(bands: &[usize]) -> usize {
    bands.iter().map(|l| 2 * l + 1).sum()
}

/// Up to which order a basis is calculated band after band, so that memory is written in its order. Above, by columns the
/// polynomials of one m live at a time, and by bands those of all.
const BY_BANDS: usize = 5;

/// All values of the bands at a direction: the kernel `basis`.
fn basis(order: usize, bands: &[usize]) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let all = columns::values(&mut builder.graph, &dir, order, columns::orthonormal);
    let outputs: Vec<Id> = bands.iter().flat_map(|&l| all[l * l..(l + 1) * (l + 1)].to_vec()).collect();
    if order > BY_BANDS {
        let column = |m: usize| bands.iter().filter(move |&&l| l >= m).flat_map(move |&l| degrees(l, m));
        builder.graph.lay_out_in((0..order).flat_map(column).map(|i| all[i]).collect());
    }
    let count = outputs.len();
    builder.finish(outputs, Shape::Array(count), "y_lm(dir), bands ascending, m from −l to l")
}

/// The harmonics of a band with the degree m, positive and negative.
fn degrees(l: usize, m: usize) -> impl Iterator<Item = usize> {
    let signs = if m == 0 { 1 } else { 2 };
    [m as isize, -(m as isize)].into_iter().take(signs).map(move |m| index(l, m))
}

/// Σ c_i y_i(dir) without storing the basis: the kernel `eval`.
fn eval(order: usize, bands: &[usize]) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let count = coefficients_of(bands);
    let c = builder.param("c", Shape::Array(count), Domain::Signal, "the coefficients of the bands, ascending");
    let sum = sum(&mut builder.graph, &dir, &c, &packed(bands, order), columns::orthonormal);
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i y_i(dir)")
}

/// Σ c_i y_i(dir), each band of y scaled, over the harmonics that have a place in `c`: one entry of `places` a harmonic of
/// the order. Nested by m: a coefficient costs one operation a channel, the polynomials are shared by channels and by
/// cosine and sine.
///
/// # Panics
///
/// If no harmonic has a place.
pub fn sum(g: &mut Graph, dir: &[Id], c: &[Id], places: &[Option<usize>], scale: BandScale) -> Id {
    sum_at(g, &Scaled::plain(dir), c, places, scale)
}

/// [`sum`] at a direction in other coordinates.
///
/// # Panics
///
/// If no harmonic has a place.
pub fn sum_at(g: &mut Graph, dir: &Scaled, c: &[Id], places: &[Option<usize>], scale: BandScale) -> Id {
    weighted_sum_at(g, dir, c, places, scale, None)
}

/// Returns what [`sum_at`] does with each band multiplied by a weight too: n (n + 1) / 2 operations more, which channels share.
///
/// # Panics
///
/// If no harmonic has a place.
pub fn weighted_sum_at(
    g: &mut Graph,
    dir: &Scaled,
    c: &[Id],
    places: &[Option<usize>],
    scale: BandScale,
    weights: Option<&[Id]>,
) -> Id {
    let order = places.len().isqrt();
    let basis = Columns::new(g, dir, order, scale, Sectoral::UnitLength);
    let mut sum: Option<Id> = None;
    for m in 0..order {
        let mut polynomials = basis.polynomials(g, m, order);
        if let Some(weights) = weights {
            polynomials.iter_mut().zip(&weights[m..]).for_each(|(value, &weight)| *value = g.mul(*value, weight));
        }
        for negative in [false, true] {
            if negative && m == 0 {
                continue;
            }
            let signed = if negative { -(m as isize) } else { m as isize };
            let column = |g: &mut Graph, odd: usize| -> Option<Id> {
                let mut nested: Option<Id> = None;
                for (d, &polynomial) in polynomials.iter().enumerate().filter(|(d, _)| d % 2 == odd) {
                    let Some(place) = places[index(m + d, signed)] else {
                        continue;
                    };
                    let term = g.mul(polynomial, c[place]);
                    nested = Some(match nested {
                        None => term,
                        Some(sum) => g.add(sum, term),
                    });
                }
                nested
            };
            let (even, odd) = (column(g, 0), column(g, 1));
            let nested = match (even, odd) {
                (None, None) => continue,
                (Some(even), None) => even,
                (even, Some(odd)) => {
                    // For m = 0 the even part holds y_{0,0} already and the odd part is a multiple of y_{1,0}.
                    let step = if m == 0 {
                        let y00 = &columns::sectoral_factor(0) * &scale(0);
                        let y10 = &basis.ratio(tables::legendre_recurrence(1, 0).0, 1, 0) * &y00;
                        basis.along(g, &y10)
                    } else {
                        basis.step(g, m)
                    };
                    let odd = g.mul(odd, step);
                    even.map_or(odd, |even| g.add(even, odd))
                }
            };
            let pair = basis.pairs[m];
            let term = match (m, negative) {
                (0, _) => nested,
                (_, false) => g.mul(nested, pair.cos),
                (_, true) => g.mul(nested, pair.sin),
            };
            sum = Some(match sum {
                None => term,
                Some(sum) => g.add(sum, term),
            });
        }
    }
    sum.expect("a harmonic has a place")
}
