//! Lights, each added to a signal: its intensity, one number a channel, times the coefficients of a zonal function that is
//! turned to its direction (docs/MATH.md#lights). The intensity is a signal, since only what is of a signal's degree can be
//! added to one; so a kernel is linear in the signal and the intensity together.

use crate::families::family::{Acts, Family, Group, Measure, Proof, Spec};
use crate::families::parts::columns;
use crate::families::parts::params::{direction, signal};
use crate::families::parts::zonal::{self, Gaussian};
use crate::families::zonal_functions::{SQUARED_SINE, declared_gaussian, squared_sine};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// The orders that the catalogue has: those of DirectXMath.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// What the records of this file leave as it is.
const ADDED: Family = Family { group: Group::Light, measure: Measure::Added, acts: Acts::Bands, ..Family::PLAIN };

/// `light_directional`.
pub static LIGHT_DIRECTIONAL: Family = Family {
    name: "light_directional",
    stem: "light_directional",
    what: |spec| {
        format!(
            "Adds a directional light to coefficients of order {}: light is the irradiance of a surface that faces it.",
            spec.order
        )
    },
    kernel: |spec| directional(spec.order),
    shown: |order| shown(&LIGHT_DIRECTIONAL, order),
    ..ADDED
};

/// `light_sphere`.
pub static LIGHT_SPHERE: Family = Family {
    name: "light_sphere",
    stem: "light_sphere",
    what: |spec| {
        format!(
            "Adds a spherical light to coefficients of order {}: light is its radiance. Exact for a sphere of any size; inside of it, where s is above one, it is a hemisphere about its centre.",
            spec.order
        )
    },
    half: false,
    proof: Proof::Nothing,
    kernel: |spec| {
        lobe(spec.order, |builder, order| {
            let s = builder.param("s", Shape::Scalar, squared_sine(), SQUARED_SINE)[0];
            zonal::cap(&mut builder.graph, order, s)
        })
    },
    shown: |order| shown(&LIGHT_SPHERE, order),
    ..ADDED
};

/// `light_cone`.
pub static LIGHT_CONE: Family = Family {
    name: "light_cone",
    stem: "light_cone",
    what: |spec| {
        format!(
            "Adds a light that fills a cone to coefficients of order {}: light is its radiance. The cone may be wider than a hemisphere, up to the whole sphere at cos = -1.",
            spec.order
        )
    },
    half: false,
    proof: Proof::Nothing,
    kernel: |spec| {
        lobe(spec.order, |builder, order| {
            let doc = "the cosine of the cone's half-angle, from -1 to 1";
            let cos = builder.param("cos", Shape::Scalar, Domain::Between(-1.0, 1.0), doc)[0];
            zonal::cone(&mut builder.graph, order, cos)
        })
    },
    shown: |order| shown(&LIGHT_CONE, order),
    ..ADDED
};

/// `light_hemisphere`.
pub static LIGHT_HEMISPHERE: Family = Family {
    name: "light_hemisphere",
    stem: "light_hemisphere",
    what: |spec| {
        format!(
            "Adds a sky and a ground to coefficients of order {}: the radiance is top in the direction, bottom against it, and linear in the cosine between, so that only the bands 0 and 1 change.",
            spec.order
        )
    },
    kernel: |spec| hemisphere(spec.order),
    shown: |order| shown(&LIGHT_HEMISPHERE, order),
    ..ADDED
};

/// `light_gaussian`.
pub static LIGHT_GAUSSIAN: Family = Family {
    name: "light_gaussian",
    stem: "light_gaussian",
    what: |spec| {
        format!(
            "Adds a spherical Gaussian, light exp(kappa (cos - 1)), to coefficients of order {}, for every sharpness kappa >= 0: light is its radiance at the centre.",
            spec.order
        )
    },
    half: false,
    proof: Proof::Nothing,
    kernel: |spec| lobe(spec.order, |builder, order| declared_gaussian(builder, order, Gaussian::exact(order))),
    shown: |order| shown(&LIGHT_GAUSSIAN, order),
    ..ADDED
};

fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { Spec::new(family, order).both() } else { vec![] }
}

/// Declares a light's intensity, which is one where a list of inputs leaves it out.
fn intensity(builder: &mut Builder, name: &'static str, doc: &str) -> Id {
    let light = builder.param(name, Shape::Scalar, Domain::Signal, doc)[0];
    builder.usually(1.0);
    light
}

fn finished(builder: Builder, order: usize, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(order * order), "the coefficients with the light added")
}

fn directional(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let light = intensity(&mut builder, "light", "the light's irradiance, one number a channel");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let y = columns::values(g, &dir, order, columns::orthonormal);
    let out = c.iter().zip(y).map(|(&c, y)| g.mul_add(light, y, c)).collect();
    finished(builder, order, out)
}

/// A light whose zonal coefficients are made of the parameters that `zonal` declares.
fn lobe(order: usize, zonal: impl FnOnce(&mut Builder, usize) -> Vec<Id>) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let e = zonal(&mut builder, order);
    let light = intensity(&mut builder, "light", "the light's radiance, one number a channel");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let y = columns::values(g, &dir, order, columns::zonal);
    let e: Vec<Id> = e.into_iter().map(|e| g.mul(light, e)).collect();
    let band = |place: usize| place.isqrt();
    let out = y.iter().enumerate().map(|(place, &y)| g.mul_add(e[band(place)], y, c[place])).collect();
    finished(builder, order, out)
}

/// Half of top and bottom in band 0, half of their difference in band 1.
fn hemisphere(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = direction(&mut builder);
    let top = intensity(&mut builder, "top", "the radiance in the direction, one number a channel");
    let bottom = intensity(&mut builder, "bottom", "the radiance against the direction, one number a channel");
    let mut out = signal(&mut builder, order);
    let g: &mut Graph = &mut builder.graph;
    let (sum, difference) = (g.add(top, bottom), g.sub(top, bottom));
    out[0] = g.scale_add(&Exact::pi_sqrt_power(1), sum, out[0]);
    let slope = g.scale(&(Exact::sqrt_ratio(1, 3) * Exact::pi_sqrt_power(1)), difference);
    let minus = g.neg(slope);
    for (place, slope, axis) in [(1, minus, dir[1]), (2, slope, dir[2]), (3, minus, dir[0])] {
        out[place] = g.mul_add(slope, axis, out[place]);
    }
    finished(builder, order, out)
}
