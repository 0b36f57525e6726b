//! The docs are what is measured, and what is measured is what the papers' figures and the errors' laws say.

mod hemisphere;
mod stability;

use std::path::Path;
use std::sync::OnceLock;
use zonal_codegen::families::Spec;
use zonal_codegen::families::axis::ROTATE_Y;
use zonal_codegen::families::small_turn::small_y;
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::plan;
use zonal_codegen::promise::accuracy::method_error;
use zonal_codegen::promise::law;
use zonal_codegen::scene::Job;
use zonal_codegen::scene::{Maps, Scene};
use zonal_measure::errors::{Comparison, LEVELS, LOBE, MAX, MEAN, RMS, SHOWN};
use zonal_measure::fronts::{ORDERS, Plan, TURNS};
use zonal_measure::methods::{METHODS, named};
use zonal_measure::papers::{LOBES, SPARSITY, TABLE_2, recomputed};
use zonal_measure::shading::Conditions;
use zonal_measure::{PEERS, Report, Silent, errors, render, stale};

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
    let pictures = fresh().pictures().map(|picture| picture.name.clone());
    let names: Vec<String> =
        render(fresh()).into_iter().map(|file| file.name).chain(pictures).chain([PEERS.to_owned()]).collect();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(names.contains(&name), "{name} is made by nothing");
    }
}

/// The run that the docs hold: a million inputs for every kernel, none above its bound.
#[test]
fn no_kernel_exceeded_its_bound() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measure/measure.json");
    let report: Report = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let bounds = report.bounds.expect("the docs hold bounds");
    assert!(bounds.len() > 370);
    for row in bounds {
        assert!(row.inputs >= 1_000_000, "{}: `cargo measure --bounds`", row.spec);
        for pair in [row.separate, row.fused] {
            assert!(pair.measured <= pair.proven, "{}: {pair:?}", row.spec);
        }
    }
}

/// The angles in degrees at which the errors of Figure 3 of Křivánek et al. 2005 reach 1e-3, 1e-2 and 1e-1, found with
/// 50 digits by other code from the paper's definitions: methods, then [max, mean singular value, rms, lobe cos⁵].
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

/// The terms that the report prints are those that the law begins with.
#[test]
fn laws_begin_with_the_terms_that_are_printed() {
    let third = |l: f64| if l % 2.0 == 1.0 { l * l * l - l } else { l * l * l };
    let lf3 = |l: f64, b: f64| third(l) * b.powi(3) / 24.0;
    let from_band_3 = |l: f64, b: f64| if l < 3.0 { 0.0 } else { lf3(l, b) };
    let taylor15 = |l: f64, b: f64| if l == 1.0 { b.powi(3) / 6.0 } else { (l * b).powi(2) / 4.0 };
    type Term<'a> = (&'a str, &'a str, &'a dyn Fn(f64, f64) -> f64);
    let terms: [Term<'_>; 7] = [
        ("taylor1", "L²/2", &|l, b| (l * b).powi(2) / 2.0),
        ("taylor15", "≈ L²/4 (l = 1: L³/6)", &taylor15),
        ("taylor2", "L³/6", &|l, b| (l * b).powi(3) / 6.0),
        ("lf3", "L³/24, l odd: (l³ − l) β³/24", &lf3),
        ("lf5", "(7 − 3√5) L³/96, l odd: (7 − 3√5) (l³ − l) β³/96", &|l, b| {
            (7.0 - 3.0 * 5f64.sqrt()) * third(l) * b.powi(3) / 96.0
        }),
        ("exact2+lf3", "as LF3, 0 for l ≤ 2", &from_band_3),
        ("tilt", "as LF3, 0 for l ≤ 2", &from_band_3),
    ];
    for (method, (name, formula, term)) in METHODS.iter().zip(terms) {
        assert_eq!((method.name, method.formula), (name, formula));
        let beta = 1e-3;
        for (l, law) in law::errors(&method.spec(10), beta).iter().enumerate().skip(1) {
            let term = term(l as f64, beta);
            // Band 1 of LF3 and LF5 has no term of the third order; Taylor 1.5 is said to be about that: √3/2 of it in band 2.
            let close = if name == "taylor15" { 0.14 } else { 1e-3 };
            assert!((law.max - term).abs() <= close * term + 1e-14, "{name}, band {l}: {}, by {term}", law.max);
        }
    }
}

/// What is measured from the kernels' matrices is the closed form.
#[test]
fn laws_hold_at_every_angle() {
    for curve in &fresh().errors {
        let spec = named(&curve.method).unwrap().spec(curve.order);
        for (error, degrees) in curve.errors[MAX].iter().zip(&fresh().angles) {
            let law = method_error(&spec, degrees.to_radians());
            assert!((error - law).abs() <= 1e-3 * law + 1e-13, "{spec} at {degrees}°: {error}, by law {law}");
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
    let errors = Comparison::new(&"taylor1:3".parse().unwrap()).errors(0.3);
    let at = |k: f64| ((k * 0.3).cos() - 1.0).hypot((k * 0.3).sin() - k * 0.3);
    let all = [at(0.0), at(0.0), at(1.0), at(1.0), at(0.0), at(1.0), at(1.0), at(2.0), at(2.0)];
    assert!((errors[MAX] - at(2.0)).abs() < 1e-13);
    assert!((errors[MEAN] - all.iter().sum::<f64>() / 9.0).abs() < 1e-13);
    assert!((errors[RMS] - (all.iter().map(|x| x * x).sum::<f64>() / 9.0).sqrt()).abs() < 1e-13);
}

#[test]
fn no_front_is_beaten_by_a_whole_method_and_plans_are_on_it() {
    for front in &fresh().fronts {
        for pair in front.points.windows(2) {
            assert!(pair[0].operations < pair[1].operations && pair[0].law > pair[1].law);
        }
        assert_eq!(front.points.last().unwrap().law, 0.0);
        let best = |error: f64| front.points.iter().find(|point| point.law <= error).unwrap().operations;
        for name in ["taylor1", "taylor15", "taylor2", "lf3", "lf5"].iter().filter(|_| front.degrees <= 25.0) {
            let methods = vec![*name; front.order - 1].join("+");
            let spec: Spec = format!("rotate_small:{}:{methods}", front.order).parse().unwrap();
            let operations = spec.code().cost(1).total;
            assert!(best(method_error(&spec, front.degrees.to_radians())) <= operations, "{spec}, {}°", front.degrees);
        }
        for plan in planned(TURNS[0], front.order, front.degrees) {
            assert_eq!(plan.choice.operations, best(plan.choice.law), "{plan:?}");
        }
    }
}

fn planned(turn: Job, order: usize, degrees: f64) -> impl Iterator<Item = &'static Plan> {
    fresh().plans.iter().filter(move |plan| (plan.turn, plan.order, plan.degrees) == (turn, order, degrees))
}

/// No plan errs by more than is predicted, and none is predicted to err by more than its budget. An approximate plan
/// errs by half of what is predicted at least; an exact one errs by rounding alone, whose proven bound no input reaches.
#[test]
fn plans_err_by_what_is_predicted_and_keep_their_budgets() {
    assert_eq!(fresh().plans.len(), TURNS.len() * ORDERS.count() * SHOWN.len() * LEVELS.len());
    for plan in &fresh().plans {
        let predicted = plan.predicted();
        assert!(plan.measured <= predicted && predicted <= plan.budget, "{plan:?}");
        match plan.choice.law {
            0.0 => assert!(plan.measured > f64::from(f32::EPSILON) / 4.0, "{plan:?}"),
            _ => assert!(predicted <= 2.0 * plan.measured, "{plan:?}"),
        }
    }
}

/// What a scene gets by the same budgets costs what the report says, and is as good.
#[test]
fn scenes_get_plans_that_are_as_cheap() {
    let order = 5;
    for turn in TURNS {
        let plans: Vec<&Plan> = SHOWN.iter().flat_map(|degrees| planned(turn, order, *degrees)).collect();
        let kind = serde_json::to_value(turn).unwrap();
        let rotation = |plan: &&Plan| {
            let Plan { degrees, budget, .. } = plan;
            format!("[[rotation]]\nkind = {kind}\norder = {order}\nmax_angle = {degrees}\nmax_error = {budget}\n")
        };
        let rotations: String = plans.iter().map(rotation).collect();
        let text = format!("name = \"plans\"\n{rotations}");
        let scene = Scene::parse("plans.toml", &text, Maps::Embedded(&[])).unwrap();
        for (chosen, plan) in plan::Plan::new(&scene).unwrap().kernels.iter().zip(plans) {
            assert_eq!(chosen.row.cost.total, plan.choice.operations, "{}: {plan:?}", chosen.row.spec);
            assert!(chosen.method_error.unwrap() <= plan.choice.law, "{}: {plan:?}", chosen.row.spec);
        }
    }
}

/// The operations of rotations about y that a search by hand found cheapest for 1e-1, 1e-2, 1e-3 and 1e-4; zero where it
/// used a method that does not exist here, five shears.
#[test]
fn plans_are_no_worse_than_those_found_by_hand() {
    // The search took the angle as given; a kernel makes it and its square of the sine.
    let angle = 5;
    let about_y = |plan: &Plan| {
        let spec: Spec = plan.choice.spec.parse().unwrap();
        let kernel = match law::methods(&spec) {
            Some((methods, _)) => small_y(spec.order, methods),
            None => Spec::new(&ROTATE_Y, spec.order).kernel(),
        };
        Listing::new(&kernel).cost(1).total
    };
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
        for (plan, wanted) in planned(Job::Quaternion, order, degrees).zip(wanted) {
            let found = about_y(plan);
            assert!(wanted == 0 || found <= wanted + angle, "{plan:?}: {found} about y, by hand {wanted}");
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
    for method in &METHODS {
        for order in method.first_order..=10 {
            assert!(fresh().curve(method.name, order).is_some(), "{}, order {order}", method.name);
        }
    }
}

/// What docs/MATH.md#ringing was written from, found by other code: one light without an ambient, and the maps' mean of order 3.
#[test]
fn ringing_errs_as_was_found_by_other_means() {
    let all = zonal_measure::ringing::measure(&Silent);
    assert_eq!(all.len(), 9);
    let lamp = [0.088, 0.080, 0.139, 0.209, 0.426, 0.352, 0.140, 0.099];
    for ((way, got), want) in zonal_measure::ringing::WAYS.iter().zip(&all[0].errors).zip(lamp) {
        assert!((got - want).abs() < 0.002, "{way}: {got}, not {want}");
    }
    let ringing: Vec<&str> = all[1..].iter().filter(|map| map.least < 0.0).map(|map| map.light.as_str()).collect();
    assert_eq!(ringing, ["sunrise"]);
    // What leaves nothing negative costs little where little is, and the square of the Laplacian much.
    let sunrise = all.iter().find(|map| map.light == "sunrise").expect("is a map");
    assert!(sunrise.errors[2] < 1.1 * sunrise.errors[0] && sunrise.errors[4] > 2.0 * sunrise.errors[0], "{sunrise:?}");
}

/// What Soler et al. 2015 say of their Figure 13, and of shading: sharing ruins profiles with local support and no others, and
/// whatever the mother functions, the integral is that of the bands.
#[test]
fn isotropic_decomposition_is_as_its_paper_says() {
    let shading = &fresh().shading;
    let condition = |mother: &str, shared: bool, bands: usize| {
        let spread = |row: &&Conditions| row.mother == mother && row.shared == shared && !row.searched;
        let mut rows = shading.conditions.iter().filter(spread);
        let row = rows.next().expect("is measured");
        row.conditions[row.bands.iter().position(|known| *known == bands).expect("is measured")]
    };
    for bands in [8, 12] {
        assert!(condition("Legendre", true, bands) <= condition("Legendre", false, bands), "{bands} bands");
        for mother in ["Gaussian", "clamped Phong", "Gauss-Legendre"] {
            let [own, shared] = [false, true].map(|shared| condition(mother, shared, bands));
            assert!(own < 1e5 && shared > 1e6, "{mother}, {bands} bands: {own:e}, shared {shared:e}");
        }
    }
    for row in shading.conditions.iter().filter(|row| row.searched) {
        let worst = row.conditions.iter().copied().fold(1.0, f64::max);
        assert!(row.bands.contains(&8) && worst < 100.0 && worst < 0.3 * condition(&row.mother, false, 8), "{row:?}");
    }
    for form in &shading.forms {
        let [decomposed, direct, isotropic, zonal, direct_zonal] = form.operations[..] else { panic!("five forms") };
        for channels in [0, 1] {
            assert!(isotropic[channels] < direct[channels] && direct[channels] < decomposed[channels], "{form:?}");
            // In RGB at order 3 both take nearly the same.
            assert!(direct_zonal[channels] <= zonal[channels] + 2, "{form:?}");
        }
    }
    for reflectance in ["phong:20", "ward:0.3", "ward:0.25:0.6"] {
        let of = |mother: &str| -> Vec<_> {
            let rows = shading.convergence.iter().filter(|row| row.reflectance == reflectance && row.mother == mother);
            rows.map(|row| (row.bands, row.error)).collect()
        };
        let (harmonic, gaussian) = (of("harmonic"), of("Gaussian"));
        assert_eq!((harmonic.len(), gaussian.len()), (6, 3), "{reflectance}");
        assert!(harmonic.windows(2).all(|pair| pair[1].1 < pair[0].1), "{reflectance}: {harmonic:?}");
        assert!(harmonic[5].1 < 0.01, "{reflectance}: {harmonic:?}");
        for (bands, error) in gaussian {
            let (_, same) = harmonic.iter().find(|row| row.0 == bands).expect("is measured");
            assert!((error - same).abs() <= 1e-3 * same, "{reflectance}, {bands} bands: {error:e}, {same:e}");
        }
    }
}

/// What Soler et al. 2015 say of filtering: reciprocity is kept by what has it; energy is over the sphere, not view by view; a
/// kernel pays where fewer pairs are known than there are coefficients.
#[test]
fn filtering_keeps_reciprocity_and_not_the_albedo() {
    let filtering = &fresh().filtering;
    let [uneven, even] = filtering.reciprocity;
    // Rounding of sums of 4096 products, against what noise does.
    assert!(even.iter().all(|change| *change < 1e-12) && uneven.iter().all(|change| *change > 0.1), "{filtering:?}");
    let [bands, widest, .., narrowest] = &filtering.kernels[..] else { panic!("seven kernels") };
    for row in &filtering.kernels {
        assert!((row.everywhere - bands.everywhere).abs() < 1e-3 && row.above < 1.0, "{row:?}");
    }
    assert!((bands.everywhere - 1.0).abs() < 0.01, "{bands:?}");
    assert!(widest.albedos[0] < 0.8 * bands.albedos[0] && widest.whole[2] > 1.1 * bands.whole[2], "{widest:?}");
    assert!(narrowest.errors[0] > bands.errors[0], "every kernel blurs");
    let best = filtering.kernels[1..].iter().map(|row| row.errors[3]).fold(f64::INFINITY, f64::min);
    assert!(best < 0.8 * bands.errors[3] && filtering.pictures[1] < 0.7 * filtering.pictures[0], "{best}");
}

/// Figures 4 and 12 and the paper's L = √s: more bands err less, and √s of them are too few.
#[test]
fn glossy_surfaces_converge_and_ring() {
    let glossy = &fresh().glossy;
    for row in &glossy.convergence {
        assert!(row.errors.windows(2).all(|pair| pair[1] < pair[0]) && row.errors[4] < 0.02, "{row:?}");
    }
    for row in &glossy.needed {
        assert!(row.at_root > 0.4 && row.bands[0] as f64 > 1.8 * row.exponent.sqrt(), "{row:?}");
    }
    for row in &glossy.ringing {
        let reach = row.bands as f64 / row.exponent.sqrt();
        assert!(reach > 2.0 || row.least < -1e-3, "{row:?}");
        assert!(reach < 3.5 || (row.negative == 0.0 && row.least > -1e-3), "{row:?}");
    }
}
