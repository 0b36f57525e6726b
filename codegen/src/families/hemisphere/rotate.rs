//! Rotations on the hemisphere. What they mean depends on what a function is below the horizon: a lobe vanishes there, a
//! record of radiance goes on (docs/MATH.md#rotation-on-the-hemisphere). Each is turned about y, from z to a normal, or by a
//! quaternion, and by one of three methods: shears of the generator for small angles, spherical harmonics for any, the
//! stretched sphere's rotation to compare with.

use crate::families::family::{Family, Job, Measure, Proof, Spec};
use crate::families::hemisphere::evaluate::stretch;
use crate::families::hemisphere::methods::{about_y, between_z, by_the_sphere, stretched_angle};
use crate::families::hemisphere::shears::{self, WAYS, Way};
use crate::families::hemisphere::table;
use crate::families::hemisphere::{COMMON, in_words, signal};
use crate::families::parts::params::{normal, quaternion};
use crate::families::parts::phases::{Phase, phases, phases_of_normal, phases_of_quaternion};
use crate::families::parts::small_angle::of_sine;
use crate::families::parts::sums::inner;
use crate::families::tilt;
use crate::ir::eval::{Contraction, Program};
use crate::ir::graph::Id;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::ir::listing::Listing;
use crate::math::exact::Exact;
use crate::math::hemisphere::{self, Below, SPHERICAL_ORDER};

/// The largest angle in degrees that the shears are meant for.
pub const SHEARED_DEGREES: f64 = 10.0;

/// The largest tilt in degrees of equation 13 in closed form, which divides by twice the cosine.
const CLOSED_DEGREES: f64 = 80.0;

/// The method by spherical harmonics.
const SH: &str = "sh";
/// That by the stretched sphere.
const EQUATION_13: &str = "eq13";

/// The other methods: spherical harmonics of an order, and the stretched sphere's.
const METHODS: &[&str] = &[
    SH,
    EQUATION_13,
    "sh=2",
    "sh=3",
    "sh=4",
    "sh=5",
    "sh=6",
    "sh=7",
    "sh=8",
    "sh=9",
    "sh=10",
    "sh=11",
    "sh=12",
    "sh=13",
    "sh=14",
    "sh=15",
    "sh=16",
];

/// What all these rotations have in common.
const ROTATION: Family = Family {
    measure: Measure::Norm,
    choices: &[METHODS],
    unproven: METHODS,
    max_angle: |spec| match method(spec) {
        Method::Shears => Some(SHEARED_DEGREES.to_radians()),
        _ => None,
    },
    fault: |spec| match method(spec) {
        Method::Sphere(spherical) if spherical < spec.order => {
            let message = format!("{spherical} spherical bands hold less than {} hemispherical ones", spec.order);
            Some([
                message,
                format!("name an order of {} to {SPHERICAL_ORDER}, as in `sh={}`", spec.order, spec.order + 2),
            ])
        }
        _ => None,
    },
    ..COMMON
};

/// `hsh_y_lobe`.
pub static Y_LOBE: Family = Family {
    name: "hsh_y_lobe",
    stem: "hsh_y_lobe",
    what: |spec| sentence(spec, Below::Zero, "about y"),
    kernel: |spec| y(spec, Below::Zero),
    unproven: &[EQUATION_13],
    shown: |order| shown(&Y_LOBE, order),
    ..ROTATION
};

/// `hsh_y_record`.
pub static Y_RECORD: Family = Family {
    name: "hsh_y_record",
    stem: "hsh_y_record",
    what: |spec| sentence(spec, Below::GoesOn, "about y"),
    kernel: |spec| y(spec, Below::GoesOn),
    unproven: &[EQUATION_13],
    shown: |order| shown(&Y_RECORD, order),
    ..ROTATION
};

/// `hsh_tilt_lobe`.
pub static TILT_LOBE: Family = Family {
    name: "hsh_tilt_lobe",
    stem: "hsh_tilt_lobe",
    what: |spec| sentence(spec, Below::Zero, "from z to a normal by the shortest way"),
    kernel: |spec| to_normal(spec, Below::Zero),
    shown: |order| shown(&TILT_LOBE, order),
    ..ROTATION
};

/// `hsh_tilt_record`.
pub static TILT_RECORD: Family = Family {
    name: "hsh_tilt_record",
    stem: "hsh_tilt_record",
    what: |spec| sentence(spec, Below::GoesOn, "from z to a normal by the shortest way"),
    kernel: |spec| to_normal(spec, Below::GoesOn),
    shown: |order| shown(&TILT_RECORD, order),
    ..ROTATION
};

/// `hsh_rotate_lobe`.
pub static ROTATE_LOBE: Family = Family {
    name: "hsh_rotate_lobe",
    stem: "hsh_rotate_lobe",
    what: |spec| sentence(spec, Below::Zero, "by a quaternion, z, y, z"),
    kernel: |spec| by_quaternion(spec, Below::Zero),
    // Two phases of a quaternion at once, and no method that is exact.
    proof: Proof::Nothing,
    shown: |order| shown(&ROTATE_LOBE, order),
    ..ROTATION
};

/// `hsh_rotate_record`.
pub static ROTATE_RECORD: Family = Family {
    name: "hsh_rotate_record",
    stem: "hsh_rotate_record",
    what: |spec| sentence(spec, Below::GoesOn, "by a quaternion, z, y, z"),
    kernel: |spec| by_quaternion(spec, Below::GoesOn),
    proof: Proof::Nothing,
    shown: |order| shown(&ROTATE_RECORD, order),
    ..ROTATION
};

/// How a function is turned about y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    /// By shears of the generator.
    Shears,
    /// In spherical harmonics of this order.
    Sphere(usize),
    /// As on the stretched sphere.
    Stretched,
}

fn method(spec: &Spec) -> Method {
    match spec.chosen.iter().find(|choice| METHODS.contains(choice)) {
        None => Method::Shears,
        Some(&EQUATION_13) => Method::Stretched,
        Some(choice) => {
            let order = choice.split_once('=').and_then(|(_, order)| order.parse().ok());
            Method::Sphere(order.unwrap_or(spec.order + 2))
        }
    }
}

fn sentence(spec: &Spec, below: Below, how: &str) -> String {
    let (order, whose) = (spec.order, in_words(below));
    let by = match (method(spec), below) {
        (Method::Shears, Below::Zero) => format!(
            "by three shears of the generator C A C^T: within {SHEARED_DEGREES} degrees a few per cent of its norm, then the error grows fast and `:sh` is the better one"
        ),
        (Method::Shears, Below::GoesOn) => format!(
            "by three shears of the generator C A E of the best extension: some per cent of its norm per five degrees, which is what nobody knows below the horizon; beyond {SHEARED_DEGREES} degrees `:sh=16` or `hsh_rotate_table` with its matrix is the better one"
        ),
        (Method::Sphere(spherical), Below::Zero) => format!(
            "exactly in spherical harmonics of order {spherical}, C D C^T (first method of Gautron et al. 2004), at every angle: what it errs by is what that many bands lose"
        ),
        (Method::Sphere(spherical), Below::GoesOn) => format!(
            "exactly in spherical harmonics of order {spherical}, C D E with the best extension E, at every angle"
        ),
        (Method::Stretched, _) => "as on the stretched sphere, where the pole moves by acos(2 cos(beta) - 1) (equation 13 of Gautron et al. 2004), for any function: the pole alone goes where it should, and nothing below a right angle comes up".to_owned(),
    };
    format!("Rotates hemispherical coefficients of order {order} {how}, of {whose}: {by}.")
}

fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    let spec = Spec::new(family, order);
    match order {
        3 => [spec.clone().both(), spec.clone().choosing(SH).both(), spec.choosing(EQUATION_13).both()].concat(),
        4..=6 => spec.both(),
        _ => vec![],
    }
}

/// The matrix, by rows, that a spec's method turns about y by, by an angle in radians.
pub fn matrix(spec: &Spec, below: Below, angle: f64) -> Vec<Vec<f64>> {
    let order = spec.order;
    if spec.family == &table::ROTATE_TABLE {
        return hemisphere::about_y(order, below, angle);
    }
    let turn = Program::<f64>::new(&Listing::new(&y(spec, below)));
    let parameter = match method(spec) {
        Method::Shears => vec![angle],
        _ => vec![angle.cos(), angle.sin()],
    };
    let column = |column: usize| {
        let unit: Vec<f64> = (0..order * order).map(|place| f64::from(u8::from(place == column))).collect();
        turn.run(&[&parameter, &unit], Contraction::Separate)
    };
    let columns: Vec<Vec<f64>> = (0..order * order).map(column).collect();
    (0..order * order).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

/// What turns hemispherical coefficients, a kind of rotation given: every method that is worth weighing.
pub fn candidates(job: Job, order: usize, below: Below) -> Vec<Spec> {
    let family = match (job, below) {
        (Job::Y, Below::Zero) => &Y_LOBE,
        (Job::Y, Below::GoesOn) => &Y_RECORD,
        (Job::Tilt, Below::Zero) => &TILT_LOBE,
        (Job::Tilt, Below::GoesOn) => &TILT_RECORD,
        (Job::Quaternion, Below::Zero) => &ROTATE_LOBE,
        (Job::Quaternion, Below::GoesOn) => &ROTATE_RECORD,
        (Job::Zyz, _) => return vec![Spec::new(&table::ROTATE_TABLE, order)],
    };
    let spec = Spec::new(family, order);
    let more = order + 4;
    let by_the_sphere = [SH.to_owned(), format!("{SH}={more}")];
    let choices = by_the_sphere.iter().map(String::as_str).chain([EQUATION_13]);
    std::iter::once(spec.clone()).chain(choices.map(|choice| spec.clone().choosing(choice))).collect()
}

/// The cheapest of the ways in which a kernel's shears can take their angle.
fn cheapest(kernel: impl Fn([Way; 2]) -> Kernel) -> Kernel {
    let cost = |kernel: &Kernel| Listing::new(kernel).cost(1).total;
    WAYS.map(kernel).into_iter().min_by_key(cost).expect("there are ways")
}

fn finished(builder: Builder, order: usize, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(order * order), "the rotated hemispherical coefficients")
}

/// About y: by β for shears, by its cosine and sine for what is exact in them.
fn y(spec: &Spec, below: Below) -> Kernel {
    let order = spec.order;
    type Turned<'a> = &'a dyn Fn(&mut Builder, &[Id], Phase) -> Vec<Id>;
    let exactly = |turned: Turned<'_>| {
        let mut builder = Builder::new();
        let cs = builder.param("cs", Shape::Pair, Domain::Phases, "(cos β, sin β)");
        let c = signal(&mut builder, order);
        let out = turned(&mut builder, &c, phases(&cs)[0]);
        finished(builder, order, out)
    };
    match method(spec) {
        Method::Shears => cheapest(|ways| {
            let mut builder = Builder::new();
            let domain = Domain::Angle(SHEARED_DEGREES.to_radians());
            let beta = builder.param("beta", Shape::Scalar, domain, "the angle about y in radians, small")[0];
            let c = signal(&mut builder, order);
            let out = shears::about_y(&mut builder.graph, &c, order, below, beta, ways);
            finished(builder, order, out)
        }),
        Method::Sphere(spherical) => {
            exactly(&|builder, c, beta| by_the_sphere(&mut builder.graph, c, spherical, below, beta))
        }
        Method::Stretched => exactly(&|builder, c, beta| {
            let beta = stretched_angle(&mut builder.graph, beta);
            about_y(&mut builder.graph, c, beta)
        }),
    }
}

/// From z to a normal.
fn to_normal(spec: &Spec, below: Below) -> Kernel {
    let order = spec.order;
    match method(spec) {
        Method::Shears => cheapest(|ways| {
            let mut builder = Builder::new();
            let n = normal(&mut builder, Domain::Tilt(SHEARED_DEGREES.to_radians()));
            let c = signal(&mut builder, order);
            let g = &mut builder.graph;
            // β / sin β to the third order.
            let square = inner(g, &n[..2], &n[..2]);
            let factor = g.affine(&Exact::ratio(1, 6), square, &Exact::one());
            let beta = [g.mul(factor, n[0]), g.mul(factor, n[1])];
            let out = shears::tilted(g, &c, order, below, beta, ways);
            finished(builder, order, out)
        }),
        Method::Stretched if order <= 3 => {
            let mut builder = Builder::new();
            let n = normal(&mut builder, Domain::Tilt(CLOSED_DEGREES.to_radians()));
            let c = signal(&mut builder, order);
            let g = &mut builder.graph;
            let [k, z] = stretch(g, n[2]);
            let n = [g.mul(k, n[0]), g.mul(k, n[1]), z];
            let out = tilt::exactly(g, &n, &c, order);
            finished(builder, order, out)
        }
        other => {
            let mut builder = Builder::new();
            let n = normal(&mut builder, Domain::Hemisphere);
            let c = signal(&mut builder, order);
            let g = &mut builder.graph;
            let [phi, beta] = phases_of_normal(g, &n);
            let back = Phase { cos: phi.cos, sin: g.neg(phi.sin) };
            let out = between_z(g, &c, [phi, back], |g, c| match other {
                Method::Sphere(spherical) => by_the_sphere(g, c, spherical, below, beta),
                _ => {
                    let beta = stretched_angle(g, beta);
                    about_y(g, c, beta)
                }
            });
            finished(builder, order, out)
        }
    }
}

/// By a quaternion.
fn by_quaternion(spec: &Spec, below: Below) -> Kernel {
    let order = spec.order;
    let method = method(spec);
    let kernel = |ways: [Way; 2]| {
        let mut builder = Builder::new();
        let domain = match method {
            Method::Shears => Domain::SmallTurn(SHEARED_DEGREES.to_radians()),
            _ => Domain::Quaternion,
        };
        let q = quaternion(&mut builder, domain);
        let c = signal(&mut builder, order);
        let g = &mut builder.graph;
        let [alpha, beta, gamma] = phases_of_quaternion(g, &q);
        let out = between_z(g, &c, [alpha, gamma], |g, c| match method {
            Method::Shears => {
                let [beta, _] = of_sine(g, beta.sin);
                shears::about_y(g, c, order, below, beta, ways)
            }
            Method::Sphere(spherical) => by_the_sphere(g, c, spherical, below, beta),
            Method::Stretched => {
                let beta = stretched_angle(g, beta);
                about_y(g, c, beta)
            }
        });
        finished(builder, order, out)
    };
    match method {
        Method::Shears => cheapest(kernel),
        _ => kernel(WAYS[0]),
    }
}
