//! Families that are wrong in one way each, so that every property of `properties.rs` is known to be able to fail: records
//! in this file alone, which no list holds.

use crate::properties::{PROPERTIES, specs, tried};
use std::collections::BTreeSet;
use zonal_codegen::families::SmallAngle;
use zonal_codegen::families::about_y::ABOUT_Y;
use zonal_codegen::families::axis::ROTATE_Y;
use zonal_codegen::families::basis::BASIS;
use zonal_codegen::families::family::{Acts, Family, Measure, Spec, ZonalFunction};
use zonal_codegen::families::fitted::DOMINANT;
use zonal_codegen::families::monomial::TO_MONOMIAL;
use zonal_codegen::families::tilt::{TILT, TILT_SCALE};
use zonal_codegen::families::zonal_functions::{CAP, cap_height};
use zonal_codegen::families::zyz::{ANGLES, ZYZ};
use zonal_codegen::ir::graph::{Graph, Id, Kind};
use zonal_codegen::ir::kernel::{Builder, Domain, Kernel, Shape};
use zonal_codegen::math::exact::Exact;

/// The rotation about y with its results changed.
fn about_y(spec: &Spec, change: impl Fn(&mut Graph, &mut Vec<Id>)) -> Kernel {
    let mut kernel = (ROTATE_Y.kernel)(spec);
    change(&mut kernel.graph, &mut kernel.outputs);
    kernel
}

/// It makes signals longer.
static STRETCHED: Family = Family {
    name: "stretched",
    kernel: |spec| about_y(spec, |g, out| out.iter_mut().for_each(|id| *id = g.scale(&Exact::ratio(1001, 1000), *id))),
    shown: |order| vec![Spec::new(&STRETCHED, order)],
    ..Family::PLAIN
};

/// Some of band 1 is added to band 0.
static SPILT: Family = Family {
    name: "spilt",
    kernel: |spec| about_y(spec, |g, out| out[0] = g.scale_add(&Exact::ratio(1, 1000), out[2], out[0])),
    shown: |order| vec![Spec::new(&SPILT, order)],
    ..Family::PLAIN
};

/// It is no linear map: a graph lets nothing be added to a signal, but a signal may be multiplied with itself.
static SQUARED: Family = Family {
    name: "squared",
    kernel: |spec| about_y(spec, |g, out| out.iter_mut().for_each(|id| *id = g.mul(*id, *id))),
    shown: |order| vec![Spec::new(&SQUARED, order)],
    ..Family::PLAIN
};

/// It divides by a sine.
static INFINITE: Family = Family {
    name: "infinite",
    kernel: |spec| {
        about_y(spec, |g, out| {
            let sine = g.input(0, 1, Kind::Scalar);
            let inverse = g.recip(sine);
            out[0] = g.mul(out[0], inverse);
        })
    },
    shown: |order| vec![Spec::new(&INFINITE, order)],
    ..Family::PLAIN
};

/// It does nothing with its quaternion.
static IDLE: Family = Family {
    name: "idle",
    half: false,
    kernel: |spec| {
        let mut builder = Builder::new();
        builder.param("q", Shape::Vec4, Domain::Quaternion, "a rotation");
        let count = Shape::Array(spec.order * spec.order);
        let c = builder.param("c", count, Domain::Signal, "a signal");
        builder.finish(c, count, "it")
    },
    shown: |order| vec![Spec::new(&IDLE, order)],
    ..Family::PLAIN
};

/// It scales, and says that it turns.
static SCALING: Family = Family {
    name: "scaling",
    kernel: TILT_SCALE.kernel,
    shown: |order| vec![Spec::new(&SCALING, order)],
    ..Family::PLAIN
};

/// It mixes bands, and says that it does not.
static MIXING: Family = Family {
    name: "mixing",
    kernel: TO_MONOMIAL.kernel,
    acts: Acts::Bands,
    shown: |order| vec![Spec::new(&MIXING, order)],
    ..Family::PLAIN
};

/// It is approximate, and says that it is exact.
static INEXACT: Family = Family {
    name: "inexact",
    kernel: |spec| (TILT.kernel)(&Spec::new(&TILT, spec.order)),
    shown: |order| vec![Spec::new(&INEXACT, order)],
    ..Family::PLAIN
};

/// It is of first order, and says that it turns by shears.
static LAWLESS: Family = Family {
    name: "lawless",
    by_band: ABOUT_Y.by_band,
    does: ABOUT_Y.does,
    kernel: |spec| (ABOUT_Y.kernel)(&Spec::new(&ABOUT_Y, spec.order).by(SmallAngle::Taylor1)),
    shown: |order| vec![Spec::new(&LAWLESS, order)],
    ..Family::PLAIN
};

/// Its loop and its kernel of some bands are those of another order of results.
static REORDERED: Family = Family {
    name: "reordered",
    some_bands: true,
    looped: BASIS.looped,
    measure: Measure::Absolute,
    kernel: |spec| {
        let mut kernel = (BASIS.kernel)(spec);
        kernel.outputs.reverse();
        kernel
    },
    shown: |order| vec![Spec::new(&REORDERED, order)],
    ..Family::PLAIN
};

/// What it makes is of the opposite rotation.
static BACKWARDS: Family = Family {
    name: "backwards",
    half: false,
    measure: ANGLES.measure,
    kernel: |spec| {
        let mut kernel = (ANGLES.kernel)(spec);
        for place in (1..kernel.outputs.len()).step_by(2) {
            kernel.outputs[place] = kernel.graph.neg(kernel.outputs[place]);
        }
        kernel
    },
    shown: |order| vec![Spec::new(&BACKWARDS, order)],
    ..Family::PLAIN
};

/// It says that it works in f16, which does not hold the number that keeps its angles defined.
static TOO_NARROW: Family = Family {
    name: "too_narrow",
    kernel: ZYZ.kernel,
    shown: |order| vec![Spec::new(&TOO_NARROW, order)],
    ..Family::PLAIN
};

/// It says that it is a cap of half the size.
static SHRUNK: Family = Family {
    name: "shrunk",
    half: false,
    measure: Measure::Absolute,
    kernel: CAP.kernel,
    zonal: Some(ZonalFunction { reach: |p| cap_height(p[0][0] / 2.0), value: |_, _| 1.0, error: 0.0 }),
    shown: |order| vec![Spec::new(&SHRUNK, order)],
    ..Family::PLAIN
};

/// Its directions are mirrored.
static MIRRORED: Family = Family {
    name: "mirrored",
    half: false,
    measure: Measure::Absolute,
    kernel: |spec| {
        let mut kernel = (DOMINANT.kernel)(spec);
        kernel.outputs[0] = kernel.graph.neg(kernel.outputs[0]);
        kernel
    },
    shown: |order| vec![Spec::new(&MIRRORED, order)],
    ..Family::PLAIN
};

/// Nothing is said of it.
static SILENT: Family = Family {
    name: "silent",
    half: false,
    measure: Measure::Absolute,
    kernel: CAP.kernel,
    shown: |order| vec![Spec::new(&SILENT, order)],
    ..Family::PLAIN
};

#[test]
fn every_property_can_fail() {
    let wrong: [(&Family, &[&str]); 14] = [
        (&STRETCHED, &["norms", "turns", "identity", "group"]),
        (&SPILT, &["bands", "norms", "turns", "group"]),
        (&SQUARED, &["linear"]),
        (&INFINITE, &["finite"]),
        (&IDLE, &["turns"]),
        (&SCALING, &["norms"]),
        (&MIXING, &["bands"]),
        (&INEXACT, &["norms", "turns"]),
        (&LAWLESS, &["turns", "group"]),
        (&REORDERED, &["loop", "some bands", "basis"]),
        (&BACKWARDS, &["turns"]),
        (&TOO_NARROW, &["half"]),
        (&SHRUNK, &["zonal"]),
        (&MIRRORED, &["found"]),
    ];
    for (family, expected) in &wrong {
        let (_, faults) = tried(&specs(family));
        let failed: BTreeSet<&str> = faults.iter().map(|(_, name)| *name).collect();
        let missing: Vec<_> = expected.iter().filter(|name| !failed.contains(**name)).collect();
        assert!(missing.is_empty(), "{family:?} has {missing:?}: {faults:#?}");
    }
    let caught: BTreeSet<&str> = wrong.iter().flat_map(|(_, expected)| *expected).copied().collect();
    assert_eq!(caught, PROPERTIES.iter().map(|(name, _)| *name).collect());
}

#[test]
fn a_family_of_which_nothing_is_said_is_told_from_the_others() {
    assert_eq!(tried(&specs(&SILENT)), (BTreeSet::from([crate::properties::OF_ALL]), vec![]));
}
