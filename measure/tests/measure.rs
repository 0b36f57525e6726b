//! The docs are what is measured, and what is measured is what the papers' figures and the errors' laws say.

mod stability;

use std::path::Path;
use std::sync::OnceLock;
use zonal_codegen::accuracy::band_errors;
use zonal_codegen::kernels::y_rotation::Small;
use zonal_codegen::spec::{Family, Method as RotationMethod, Spec};
use zonal_measure::errors::{Comparison, LOBE, MAX, MEAN, RMS};
use zonal_measure::fronts::budgets;
use zonal_measure::methods::{Method, Way};
use zonal_measure::papers::{LOBES, SPARSITY, TABLE_2, recomputed};
use zonal_measure::{Report, Silent, errors, render, stale};

fn fresh() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| Report::measure(&Silent))
}

#[test]
fn the_docs_are_not_stale() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measure");
    let found = stale(&folder, fresh());
    assert!(
        found.is_empty(),
        "{} differences, `cargo measure` writes the docs again:\n{}",
        found.len(),
        found.join("\n")
    );
    let names: Vec<String> = render(fresh()).into_iter().map(|file| file.name).collect();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(names.contains(&name), "{name} is made by nothing");
    }
}

/// The angles in degrees at which the errors of Figure 3 of paper 000 reach 1e-3, 1e-2 and 1e-1, found with 50 digits by
/// other code from the paper's definitions: methods, then [max, mean singular value, rms, lobe cos⁵].
type Crossings = (&'static str, usize, [Option<[f64; 3]>; 4]);
const FIGURE_3: [Crossings; 8] = [
    (
        "taylor1",
        5,
        [Some([0.64, 2.03, 6.42]), Some([1.28, 4.05, 12.90]), Some([1.03, 3.27, 10.41]), Some([1.23, 3.88, 12.35])],
    ),
    (
        "taylor15",
        5,
        [Some([0.95, 3.00, 9.09]), Some([1.73, 5.45, 16.50]), Some([1.47, 4.62, 14.07]), Some([1.68, 5.28, 16.19])],
    ),
    (
        "taylor2",
        5,
        [Some([2.60, 5.61, 12.14]), Some([4.59, 9.91, 21.51]), Some([3.75, 8.09, 17.53]), Some([4.32, 9.32, 20.24])],
    ),
    ("exact2+lf3", 5, [Some([4.13, 8.86, 18.63]), Some([6.45, 13.9, 29.4]), None, None]),
    (
        "taylor1",
        8,
        [Some([0.37, 1.16, 3.67]), Some([0.79, 2.50, 7.96]), Some([0.64, 2.01, 6.40]), Some([1.19, 3.75, 11.94])],
    ),
    (
        "taylor15",
        8,
        [Some([0.53, 1.68, 5.16]), Some([1.04, 3.26, 9.89]), Some([0.87, 2.75, 8.45]), Some([1.61, 5.08, 15.56])],
    ),
    (
        "taylor2",
        8,
        [Some([1.49, 3.21, 6.93]), Some([2.83, 6.11, 13.26]), Some([2.30, 4.96, 10.75]), Some([4.10, 8.85, 19.24])],
    ),
    ("exact2+lf3", 8, [Some([2.37, 5.10, 10.64]), Some([3.86, 8.28, 17.0]), None, None]),
];

#[test]
fn figure_3_is_reproduced() {
    for (method, order, norms) in FIGURE_3 {
        let curve = fresh().curve(method, order).unwrap();
        for (norm, wanted) in [MAX, MEAN, RMS, LOBE].into_iter().zip(norms) {
            for (angle, wanted) in curve.reaches[norm][1..].iter().zip(wanted.into_iter().flatten()) {
                let angle = angle.unwrap();
                // One in the last printed digit; LF3's odd bands have got better coefficients since, by half a percent.
                let close = if method == "exact2+lf3" { 0.006 * wanted } else { 0.01 };
                assert!((angle - wanted).abs() <= close, "{method}, order {order}: {angle}, not {wanted}");
            }
        }
    }
}

/// The generator's own figures, found by another iteration.
#[test]
fn errors_are_those_of_the_files_heads() {
    for (method, family) in [
        (Way::Uniform(Small::Taylor15), Family::SmallY(vec![Small::Taylor15; 5])),
        (Way::Uniform(Small::Lf3), Family::Rotate(RotationMethod::Small(vec![Small::Lf3; 5]))),
        (Way::Tilt, Family::Tilt(Small::Lf3.from_band_3(6))),
    ] {
        let angles = [0.05, 0.4];
        let comparison = Comparison::new(method, 6);
        for (angle, wanted) in angles.iter().zip(band_errors(&Spec::new(family.clone(), 6), &angles)) {
            for (band, wanted) in comparison.bands(*angle).iter().zip(wanted) {
                assert!((band[0] - wanted).abs() <= 1e-6 * wanted + 1e-12, "{family:?}: {}, not {wanted}", band[0]);
            }
        }
    }
}

/// A law holds to a fifth where it says that the error is below a hundredth.
#[test]
fn laws_hold_for_small_errors() {
    let report = fresh();
    for method in Method::all() {
        // At order 2 LF3 has only band 1, far better than the others and without a law.
        for curve in report.errors.iter().filter(|curve| curve.method == method.name && curve.order > 2) {
            let mut held = 0;
            for (error, degrees) in curve.errors[MAX].iter().zip(&report.angles) {
                let law = method.law(curve.order, degrees.to_radians());
                // The law is the first term of a series in lβ.
                let small = (curve.order - 1) as f64 * degrees.to_radians() < 0.9;
                if law > 1e-9 && law < 1e-2 && small {
                    held += 1;
                    let name = (method.name, curve.order);
                    assert!((error / law - 1.0).abs() < 0.2, "{name:?} at {degrees}°: {error}, by law {law}");
                }
            }
            assert!(held > 10);
        }
    }
}

#[test]
fn a_lobe_and_the_norms_are_as_defined() {
    // The cosine lobe's bands are as 1/2 : 1/√3 : √5/8, and it has no band 3.
    let cosine = errors::lobe(1, 4);
    for (got, wanted) in cosine.iter().zip([0.5, 1.0 / 3f64.sqrt(), 5f64.sqrt() / 8.0, 0.0]) {
        assert!((got / cosine[0] - 2.0 * wanted).abs() < 1e-14);
    }
    // Taylor 1 errs by |e^{ikβ} − 1 − ikβ| at frequency k.
    let errors = Comparison::new(Way::Uniform(Small::Taylor1), 3).errors(0.3);
    let at = |k: f64| ((k * 0.3).cos() - 1.0).hypot((k * 0.3).sin() - k * 0.3);
    let all = [at(0.0), at(0.0), at(1.0), at(1.0), at(0.0), at(1.0), at(1.0), at(2.0), at(2.0)];
    assert!((errors[MAX] - at(2.0)).abs() < 1e-13);
    assert!((errors[MEAN] - all.iter().sum::<f64>() / 9.0).abs() < 1e-13);
    assert!((errors[RMS] - (all.iter().map(|x| x * x).sum::<f64>() / 9.0).sqrt()).abs() < 1e-13);
}

#[test]
fn no_front_is_beaten_by_a_whole_method_and_errors_keep_their_budget() {
    for front in &fresh().fronts {
        for pair in front.points.windows(2) {
            assert!(pair[0].operations < pair[1].operations && pair[0].error > pair[1].error);
        }
        for whole in &front.uniform {
            let best =
                front.points.iter().filter(|point| point.error <= whole.error).map(|point| point.operations).min();
            assert!(best.unwrap() <= whole.operations, "order {}, {}°", front.order, front.degrees);
        }
        assert_eq!(front.points.last().unwrap().error, 0.0);
    }
}

/// The operations of rotations about y that a search by hand found cheapest for 1e-1, 1e-2, 1e-3 and 1e-4; zero where it
/// used a method that does not exist here, five shears.
#[test]
fn fronts_are_no_worse_than_those_found_by_hand() {
    for (order, degrees, wanted) in [
        (3, 5.0, [11, 21, 22, 22]),
        (3, 15.0, [21, 22, 22, 22]),
        (4, 5.0, [24, 50, 51, 56]),
        (4, 15.0, [50, 56, 56, 56]),
        (5, 5.0, [42, 87, 101, 106]),
        (5, 10.0, [69, 101, 106, 106]),
        (5, 15.0, [87, 106, 106, 106]),
        (5, 25.0, [100, 106, 106, 106]),
        (6, 5.0, [65, 132, 171, 184]),
        (6, 10.0, [110, 171, 184, 184]),
        (6, 15.0, [0, 176, 184, 184]),
        (6, 25.0, [170, 184, 184, 184]),
        (8, 5.0, [171, 246, 0, 416]),
        (8, 10.0, [216, 0, 416, 416]),
        (8, 15.0, [0, 407, 416, 416]),
        (8, 25.0, [384, 416, 416, 416]),
        (10, 5.0, [309, 0, 0, 776]),
        (10, 10.0, [0, 0, 776, 776]),
        (10, 15.0, [0, 767, 776, 776]),
        (10, 25.0, [0, 776, 776, 776]),
        (3, 45.0, [22; 4]),
        (4, 45.0, [56; 4]),
        (5, 45.0, [106; 4]),
        (6, 45.0, [184; 4]),
        (8, 45.0, [416; 4]),
        (10, 45.0, [776; 4]),
    ] {
        let front = fresh().fronts.iter().find(|front| front.order == order && front.degrees == degrees).unwrap();
        for ((error, choice), wanted) in budgets(&front.points).into_iter().zip(wanted) {
            let choice = choice.unwrap();
            let name = (order, degrees, error);
            assert!(choice.error <= error, "{name:?}: {choice:?}");
            assert!(wanted == 0 || choice.operations <= wanted, "{name:?}: {choice:?}, by hand {wanted}");
        }
    }
}

#[test]
fn tables_1_and_2_are_reproduced() {
    for (lobes, (l, sparsity)) in LOBES.iter().zip((2..).zip(SPARSITY)) {
        let share = 100.0 * (1.0 - lobes.iter().sum::<usize>() as f64 / (2 * l + 1usize).pow(2) as f64);
        assert!((share - sparsity as f64).abs() <= 0.5, "band {l}: {share}, printed {sparsity}");
    }
    let sets = &fresh().factorisation;
    for band in &sets.bands {
        let found = zonal_measure::factorisation::sparsity(band.l, band.nonzeros);
        assert!(found >= SPARSITY[band.l - 2] as f64 - 0.5, "band {}: {found}", band.l);
        assert!(band.condition < 200.0);
    }
    for (printed, nonzeros) in TABLE_2.iter().zip(&sets.x_nonzeros) {
        let right = recomputed(printed, *nonzeros);
        let shown = |c: &zonal_measure::papers::Column| (c.z, c.z_optimised, c.basis, c.values, c.tabulated);
        assert_eq!(shown(printed), shown(&right), "order {}", printed.order);
        // The print evaluates the basis once too seldom, and its x is two short at most, or dense from 15 on.
        assert_eq!(printed.standard + printed.basis, right.standard, "order {}", printed.order);
        assert_eq!(printed.zxzxz, 3 * printed.z + 2 * printed.x);
        assert!(printed.order >= 15 || right.x - printed.x <= 2, "order {}", printed.order);
    }
}

#[test]
fn rounding_is_near_the_precision() {
    for (spec, f32_limit, f64_limit) in [("rotate:8", 4e-6, 1e-14), ("lf3:5", 1e-6, 1e-15), ("basis:10", 5e-6, 1e-14)] {
        let found = fresh().rounding.iter().find(|rounding| rounding.spec == spec).unwrap();
        let (narrow, wide) = (found.f32.unwrap(), found.f64.unwrap());
        assert!(narrow < f32_limit && narrow > 1e-8, "{spec}: {narrow}");
        assert!(wide < f64_limit && wide > 1e-17, "{spec}: {wide}");
    }
}

#[test]
fn every_method_is_measured_at_every_order() {
    for method in Method::all() {
        let first = if matches!(method.way, Way::Uniform(_)) { 2 } else { 4 };
        for order in first..=10 {
            assert!(fresh().curve(method.name, order).is_some(), "{}, order {order}", method.name);
        }
    }
}
