//! Zonal coefficients of functions of the angle from an axis: caps, spherical Gaussians, lobes. What is turned, added to a
//! signal or convolved with it takes them (docs/MATH.md#lights).

use crate::families::family::{Family, Group, Measure, Proof, Spec, ZonalFunction};
use crate::families::parts::zonal::{self, Gaussian};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use std::f64::consts::PI;

/// The orders that the catalogue has: those of DirectXMath.
const SHOWN: std::ops::RangeInclusive<usize> = 2..=6;

/// By how much `gaussian:n:f32` errs in exact arithmetic at most, relative to the first coefficient.
const NARROW_ERROR: f64 = 2.3e-8;

/// The sharpest Gaussian that is tried.
pub const SHARPEST: f64 = 1e5;

/// What the records of this file leave as it is.
const ONE_A_BAND: Family =
    Family { group: Group::Light, half: false, measure: Measure::Absolute, proof: Proof::Nothing, ..Family::PLAIN };

/// `cap`.
pub static CAP: Family = Family {
    name: "cap",
    stem: "cap",
    what: |spec| {
        format!(
            "The zonal coefficients of order {} of a cap, which is one within an angle of the axis and zero beyond: a sphere of radius r and radiance one whose centre is as far as d has s = r^2 / d^2. Exact for a cap of any size; s above one, inside of the sphere, is taken for a hemisphere; s that is not a number makes all of them so.",
            spec.order
        )
    },
    kernel: |spec| one_a_band(spec, "s", SQUARED_SINE, squared_sine(), zonal::cap),
    zonal: Some(ZonalFunction { reach: |p| cap_height(p[0][0]), value: |_, _| 1.0, error: 0.0 }),
    shown: |order| shown(&CAP, order),
    ..ONE_A_BAND
};

/// `gaussian`.
pub static GAUSSIAN: Family = Family {
    name: "gaussian",
    stem: "gaussian",
    what: |spec| {
        let Gaussian { limit, start, .. } = Gaussian::exact(spec.order);
        format!(
            "The zonal coefficients of order {} of the spherical Gaussian exp(kappa (cos - 1)), for every sharpness kappa >= 0: downward from band {start} up to kappa = {limit}, upward above, of which one is selected. Kappa that is not a number makes all of them so.",
            spec.order
        )
    },
    kernel: |spec| gaussian_of(spec, Gaussian::exact(spec.order)),
    zonal: Some(GAUSSIAN_FUNCTION),
    shown: |order| shown(&GAUSSIAN, order),
    ..ONE_A_BAND
};

/// `gaussian:n:f32`.
pub static GAUSSIAN_NARROW: Family = Family {
    name: "gaussian",
    method: "f32",
    stem: "gaussian_narrow",
    usual: |_, _| false,
    what: |spec| {
        let Gaussian { limit, start, .. } = Gaussian::NARROW;
        format!(
            "What `gaussian:{}` gives, as exact as f32 is and no more: within 2e-8 of the first coefficient, downward from band {start} up to kappa = {limit}, upward above and without a power.",
            spec.order
        )
    },
    orders: 2..=10,
    outside: |order| {
        let help = format!("leave it out, as in `gaussian:{order}`");
        [format!("what suffices for f32 to order 10 does not at order {order}"), help]
    },
    kernel: |spec| gaussian_of(spec, Gaussian::NARROW),
    zonal: Some(ZonalFunction { error: NARROW_ERROR, ..GAUSSIAN_FUNCTION }),
    shown: |order| shown(&GAUSSIAN_NARROW, order),
    ..ONE_A_BAND
};

const GAUSSIAN_FUNCTION: ZonalFunction =
    ZonalFunction { reach: |_| 2.0, value: |p, short| f64::exp(-p[0][0] * short), error: 0.0 };

/// `phong`.
pub static PHONG: Family = Family {
    name: "phong",
    stem: "phong",
    what: |spec| {
        format!(
            "The zonal coefficients of order {} of the lobe max(0, cos)^s, s any real number >= 0: s = 1 is the clamped cosine, whose coefficients are constants in `convolve_cosine:{}`. S that is not a number makes all of them so.",
            spec.order, spec.order
        )
    },
    kernel: |spec| {
        let doc = "the exponent, not negative";
        one_a_band(spec, "s", doc, Domain::Between(0.0, 1e4), zonal::phong)
    },
    zonal: Some(ZonalFunction { reach: |_| 1.0, value: |p, short| (p[0][0] * f64::ln_1p(-short)).exp(), error: 0.0 }),
    shown: |order| shown(&PHONG, order),
    ..ONE_A_BAND
};

/// `henyey_greenstein`.
pub static HENYEY_GREENSTEIN: Family = Family {
    name: "henyey_greenstein",
    stem: "henyey_greenstein",
    half: true,
    what: |spec| {
        format!(
            "The zonal coefficients of order {} of the phase function (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) (Henyey and Greenstein 1941), whose integral is one.",
            spec.order
        )
    },
    kernel: |spec| {
        let doc = "the mean cosine, from -1 (all backward) to 1 (all forward)";
        one_a_band(spec, "g", doc, Domain::Between(-1.0, 1.0), zonal::henyey_greenstein)
    },
    zonal: Some(ZonalFunction {
        reach: |_| 2.0,
        value: |p, short| {
            let g = p[0][0];
            // At the ends it is no function: all of it lies in one direction.
            let most = if g.abs() < 1.0 { 1.0 - g * g } else { f64::NAN };
            most / (4.0 * PI * ((1.0 - g) * (1.0 - g) + 2.0 * g * short).powf(1.5))
        },
        error: 0.0,
    }),
    shown: |order| shown(&HENYEY_GREENSTEIN, order),
    ..ONE_A_BAND
};

/// What `s` is in words.
pub const SQUARED_SINE: &str = "the squared sine of the half-angle, r^2 / d^2 of a sphere";

/// What `s` may be: beyond one too.
pub fn squared_sine() -> Domain {
    Domain::Between(0.0, 1.25)
}

/// One less the cosine of a cap's half-angle.
pub fn cap_height(s: f64) -> f64 {
    let s = s.min(1.0);
    s / (1.0 + (1.0 - s).sqrt())
}

/// The coefficients of a Gaussian in a kernel, of the sharpness that is declared here.
pub fn declared_gaussian(builder: &mut Builder, order: usize, way: Gaussian) -> Vec<Id> {
    let domain = Domain::Bent(0.0, way.limit as f64, SHARPEST);
    let kappa = builder.param("kappa", Shape::Scalar, domain, "the sharpness, not negative")[0];
    way.coefficients(&mut builder.graph, order, kappa)
}

fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    if SHOWN.contains(&order) { vec![Spec::new(family, order)] } else { vec![] }
}

fn finished(builder: Builder, spec: &Spec, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(spec.order), "the zonal coefficients, one a band")
}

/// A kernel of one number.
fn one_a_band(
    spec: &Spec,
    name: &'static str,
    doc: &str,
    domain: Domain,
    of: fn(&mut Graph, usize, Id) -> Vec<Id>,
) -> Kernel {
    let mut builder = Builder::new();
    let number = builder.param(name, Shape::Scalar, domain, doc)[0];
    let out = of(&mut builder.graph, spec.order, number);
    finished(builder, spec, out)
}

fn gaussian_of(spec: &Spec, way: Gaussian) -> Kernel {
    let mut builder = Builder::new();
    let out = declared_gaussian(&mut builder, spec.order, way);
    finished(builder, spec, out)
}
