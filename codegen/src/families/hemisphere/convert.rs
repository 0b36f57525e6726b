//! From spherical to hemispherical harmonics by the sparse matrix C, and back: by its transpose where the function vanishes
//! below the horizon, by the best extension where it goes on (docs/MATH.md#the-matrix-c).

use crate::families::family::{Family, Measure, Spec};
use crate::families::hemisphere::{COMMON, signal};
use crate::families::parts::params;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::hemisphere::{self, Below, HIGHEST_ORDER, SPHERICAL_ORDER};
use crate::math::index::{coefficients, index};

/// What constant maps between bases have in common.
const OF_CONVERSIONS: Family = Family { measure: Measure::Norm, ..COMMON };

/// `sh_to_hsh`.
pub static SH_TO_HSH: Family = Family {
    name: "sh_to_hsh",
    stem: "sh_to_hsh",
    converts: Some(2..=SPHERICAL_ORDER),
    what: |spec| {
        let [from, to] = spec.factor_orders();
        format!(
            "From spherical harmonics of order {from} to hemispherical ones of order {to}: the function above the horizon, projected (C of Gautron et al. 2004, eq. 18, corrected)."
        )
    },
    kernel: |spec| {
        let [from, to] = spec.factor_orders();
        let mut builder = Builder::new();
        let c = params::signal(&mut builder, from);
        let out = to_hemisphere(&mut builder.graph, &c, to);
        builder.finish(out, Shape::Array(to * to), "the hemispherical coefficients, index l(l+1)+m")
    },
    shown: |order| {
        let spec = Spec::new(&SH_TO_HSH, order);
        let more = spec.clone().of_factors([order + 2, order]);
        if order <= SHOWN { [spec.both(), more.both()].concat() } else { spec.both() }
    },
    ..OF_CONVERSIONS
};

/// `hsh_to_sh`.
pub static HSH_TO_SH: Family = Family {
    name: "hsh_to_sh",
    stem: "hsh_to_sh",
    what: |spec| {
        let [from, to] = spec.factor_orders();
        format!(
            "From hemispherical harmonics of order {from} to spherical ones of order {to}, of a function that is zero below the horizon: the transpose of `sh_to_hsh`. `hsh_extend` is for one that goes on."
        )
    },
    kernel: |spec| from_hemisphere(spec.factor_orders(), Below::Zero),
    shown: |order| if order <= SHOWN { shown(&HSH_TO_SH, order) } else { vec![] },
    ..TO_THE_SPHERE
};

/// `hsh_extend`.
pub static HSH_EXTEND: Family = Family {
    name: "hsh_extend",
    stem: "hsh_extend",
    what: |spec| {
        let [from, to] = spec.factor_orders();
        format!(
            "From hemispherical harmonics of order {from} to spherical ones of order {to}, of a function that goes on below the horizon: the best linear extension where the power of a coefficient falls off as (1+l)^-1.6, as that of radiance does. `hsh_to_sh` is for one that is zero there."
        )
    },
    kernel: |spec| from_hemisphere(spec.factor_orders(), Below::GoesOn),
    shown: |order| shown(&HSH_EXTEND, order),
    ..TO_THE_SPHERE
};

/// What the maps to the sphere have in common.
const TO_THE_SPHERE: Family = Family {
    converts: Some(2..=HIGHEST_ORDER),
    orders: 2..=SPHERICAL_ORDER,
    outside: Family::PLAIN.outside,
    ..OF_CONVERSIONS
};

/// Up to which order of the hemisphere the catalogue has maps to and from more bands of the sphere.
const SHOWN: usize = 6;

/// The square map, and that from two orders less.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    let spec = Spec::new(family, order);
    match order {
        2 | 3 => spec.both(),
        _ if order > SHOWN + 2 => spec.both(),
        _ => [spec.clone().both(), spec.of_factors([order - 2, order]).both()].concat(),
    }
}

/// Σ over bands of what `entry` says of a band and of another, both of order m.
fn mapped(g: &mut Graph, c: &[Id], to: usize, entry: impl Fn(usize, usize, isize) -> Exact) -> Vec<Id> {
    let from = c.len().isqrt();
    coefficients(to)
        .map(|(l, m)| {
            let bands = m.unsigned_abs()..from;
            let factors: Vec<Exact> = bands.clone().map(|k| entry(l, k, m)).collect();
            let values: Vec<Id> = bands.map(|k| c[index(k, m)]).collect();
            g.dot(&factors, &values)
        })
        .collect()
}

/// C c.
pub fn to_hemisphere(g: &mut Graph, c: &[Id], order: usize) -> Vec<Id> {
    mapped(g, c, order, hemisphere::overlap)
}

/// Cᵀ c or E c.
pub fn to_sphere(g: &mut Graph, c: &[Id], order: usize, below: Below) -> Vec<Id> {
    let from = c.len().isqrt();
    match below {
        Below::Zero => mapped(g, c, order, |spherical, l, m| hemisphere::overlap(l, spherical, m)),
        Below::GoesOn => mapped(g, c, order, |spherical, l, m| hemisphere::extension(from, spherical, l, m)),
    }
}

fn from_hemisphere([from, to]: [usize; 2], below: Below) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, from);
    let out = to_sphere(&mut builder.graph, &c, to, below);
    builder.finish(out, Shape::Array(to * to), "the spherical coefficients, index l(l+1)+m")
}
