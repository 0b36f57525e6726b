//! What every family promises by its record: whatever the record says of a kernel, that it turns, that it is linear, that it
//! has another form, is tried on seeded inputs, extremes first. A new family is tested by existing, and fails where
//! nothing can be tested of it. That the basis is orthonormal is checked by itself, since the others rest on it.

use crate::found;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;
use zonal_codegen::emit::language::WGSL;
use zonal_codegen::families::family::{Acts, Measure, Proof};
use zonal_codegen::families::parts::small_angle::parity_shears;
use zonal_codegen::families::{ALL, Family, Form, SmallAngle, Spec};
use zonal_codegen::generate::build;
use zonal_codegen::ir::eval::Number;
use zonal_codegen::ir::op::Kind;
use zonal_codegen::math::half::Half;
use zonal_codegen::promise::accuracy::Meaning;
use zonal_codegen::promise::law;
use zonal_codegen::promise::samples::inputs;
use zonal_tests::shader::Language;
use zonal_tests::toys;
use zonal_tests::turns::{
    Matrix, Origin, Parameters, Sphere, Trial, Turn, composed, identity, inverse, places, product, transposed, turn,
    whole,
};
use zonal_tests::{Runner, larger, norm};

/// The orders at which families are tried; all that a kernel is made of is there at the last.
const ORDERS: RangeInclusive<usize> = 2..=5;
/// How many inputs each kernel is tried on.
pub(crate) const COUNT: usize = 40;
/// The first input that is none of the extremes.
const ORDINARY: usize = 16;
/// What f64 may round off a band of norm one: some hundred operations of 1.1e-16 each, amplified by a lobe set's condition
/// or a lifted rotation's tangents at most a few times.
pub(crate) const ROUNDING: f64 = 1e-13;

/// Whether a property is the kernel's, and if so, what contradicts it.
pub(crate) type Tried = Result<bool, String>;

/// What tries a property on a kernel.
type Property = fn(&Spec) -> Tried;

/// All properties, each with its name.
pub(crate) const PROPERTIES: [(&str, Property); 13] = [
    ("finite", is_finite),
    ("linear", is_linear),
    ("bands", bands_do_not_mix),
    ("norms", norms_are_kept),
    ("turns", it_turns_as_it_says),
    ("identity", no_turn_changes_nothing),
    ("group", turns_are_undone_and_composed),
    ("loop", the_loop_is_the_same),
    ("some bands", some_bands_are_the_same),
    ("half", f16_errs_by_its_roundoff),
    ("zonal", found::it_is_the_function_that_it_says),
    ("found", found::what_is_found_turns_with_the_signal),
    ("basis", found::a_basis_turns_about_z),
];

/// What every kernel has, whatever it does.
pub(crate) const OF_ALL: &str = "finite";

pub(crate) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(what()) }
}

/// A kernel and what it is tried on.
struct Subject {
    runner: Runner<f64>,
    parameters: Parameters,
    trials: Vec<Trial>,
}

impl Subject {
    fn new(spec: &Spec) -> Self {
        let parameters = Parameters::new(spec.code().params());
        Self { runner: Runner::new(spec), trials: parameters.trials(31, COUNT), parameters }
    }

    /// Runs it on one signal, or on none.
    fn run(&self, origins: &[Origin], signal: &[f64]) -> Vec<f64> {
        self.runner.run(&self.given(origins, signal))
    }

    fn given(&self, origins: &[Origin], signal: &[f64]) -> Vec<Vec<f64>> {
        self.parameters.inputs(origins, &[signal.to_vec()])
    }
}

pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<_>>())
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

fn is_finite(spec: &Spec) -> Tried {
    let (narrow, wide) = (Runner::<f32>::new(spec), Runner::<f64>::new(spec));
    for input in inputs(spec.code().params(), 29, COUNT, None) {
        let all = [narrow.run(&input), wide.run(&input)].concat();
        ensure(all.iter().all(|x| x.is_finite()), || format!("{input:?} makes {all:?}"))?;
    }
    Ok(true)
}

/// In each signal of a product sums become sums, else in all signals together; zeros stay zeros, and what is multiplied by a
/// power of two becomes that to the last bit; where a product is of one signal with itself, by the power's square.
fn is_linear(spec: &Spec) -> Tried {
    if !spec.family.has_signal() {
        return Ok(false);
    }
    let (subject, narrow) = (Subject::new(spec), Runner::<f32>::new(spec));
    let is_product = spec.code().result().1 == Kind::Product;
    for (i, trials) in subject.trials.windows(2).enumerate() {
        let (origins, signals) = (&trials[0].origins, &trials[0].signals);
        let all: Vec<usize> = (0..signals.len()).collect();
        let places: Vec<&[usize]> = if is_product { all.chunks(1).collect() } else { vec![&all] };
        for places in places {
            let of = |trial: &Trial| -> Vec<f64> { places.iter().flat_map(|&at| trial.signals[at].clone()).collect() };
            let (x, y) = (&of(&trials[0]), &of(&trials[1]));
            let given = |signal: &[f64]| {
                let (mut all, mut rest) = (signals.clone(), signal);
                for &place in places {
                    let (own, others) = rest.split_at(all[place].len());
                    all[place] = own.to_vec();
                    rest = others;
                }
                subject.parameters.inputs(origins, &all)
            };
            let (of, in_f32) =
                (|signal: &[f64]| subject.runner.run(&given(signal)), |signal: &[f64]| narrow.run(&given(signal)));
            let is_square = is_product && signals.len() == 1;
            let (fx, fy) = (of(x), of(y));
            let sum = |a: f64, x: &[f64], b: f64, y: &[f64]| -> Vec<f64> {
                x.iter().zip(y).map(|(x, y)| a * x + b * y).collect()
            };
            let (got, want) = match is_square {
                true => (sum(1.0, &of(&sum(1.0, x, 1.0, y)), 1.0, &of(&sum(1.0, x, -1.0, y))), sum(2.0, &fx, 2.0, &fy)),
                false => (of(&sum(0.75, x, -1.5, y)), sum(0.75, &fx, -1.5, &fy)),
            };
            let size = [x, y, &fx, &fy].map(|list| norm(list)).iter().sum::<f64>();
            let error = difference(&got, &want);
            ensure(error <= ROUNDING * size, || format!("sums: {error:e} of {size} at {origins:?}"))?;
            let zeros = vec![0.0; x.len()];
            let nothing = [of(&zeros), in_f32(&zeros)].concat();
            ensure(nothing.iter().all(|&x| x == 0.0), || format!("zeros become {nothing:?} at {origins:?}"))?;
            let scaled =
                |list: &[f64], exponent: i32| -> Vec<f64> { list.iter().map(|x| x * 2f64.powi(exponent)).collect() };
            let power = |exponent: i32| if is_square { 2 * exponent } else { exponent };
            for exponent in [-300, 300] {
                let same = bits(&of(&scaled(x, exponent))) == bits(&scaled(&fx, power(exponent)));
                ensure(same, || format!("2^{exponent} times {x:?} at {origins:?}"))?;
            }
            // In f32 products of tiny parameters and small signals are subnormal.
            for exponent in [-40, 40].into_iter().filter(|_| i >= ORDINARY) {
                let same = bits(&in_f32(&scaled(x, exponent))) == bits(&scaled(&in_f32(x), power(exponent)));
                ensure(same, || format!("2^{exponent} times {x:?} at {origins:?} in f32"))?;
            }
        }
    }
    Ok(true)
}

/// A bad number in one band stays in that band: infinite, NaN, huge or denormal.
fn bands_do_not_mix(spec: &Spec) -> Tried {
    let family = spec.family;
    if !matches!(family.measure, Measure::Bands) || family.acts == Acts::Mixes {
        return Ok(false);
    }
    let (subject, narrow, order) = (Subject::new(spec), Runner::<f32>::new(spec), spec.order);
    for trial in subject.trials.iter().skip(ORDINARY).take(4) {
        let (origins, signal) = trial.alone();
        let run = |signal: &[f64]| narrow.run(&subject.given(origins, signal));
        let clean = run(signal);
        // A loop may read beyond its band and multiply by zero, which stops finite numbers alone.
        let bad = [1e38, 1e-38, 1e-45, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        for bad in bad.into_iter().filter(|bad| bad.is_finite() || spec.form == Form::Unrolled) {
            for band in 0..order {
                for place in places(band, order, signal.len()) {
                    let mut spoilt = signal.to_vec();
                    spoilt[place] = bad;
                    let got = run(&spoilt);
                    for l in (0..order).filter(|&l| l != band) {
                        let range = places(l, order, clean.len());
                        let same = bits(&got[range.clone()]) == bits(&clean[range]);
                        ensure(same, || format!("{bad} in band {band} reaches band {l} at {origins:?}"))?;
                    }
                }
            }
        }
    }
    Ok(true)
}

/// Whether it turns its signal, and without an error but rounding's.
fn turns_exactly(spec: &Spec) -> bool {
    matches!(spec.family.measure, Measure::Bands) && spec.family.acts == Acts::Turns && !spec.is_approximate()
}

fn norms_are_kept(spec: &Spec) -> Tried {
    if !turns_exactly(spec) {
        return Ok(false);
    }
    let (subject, order) = (Subject::new(spec), spec.order);
    for trial in &subject.trials {
        let (origins, signal) = trial.alone();
        let out = subject.run(origins, signal);
        for l in 0..order {
            let [before, after] = [signal, &out].map(|list| norm(&list[places(l, order, list.len())]));
            let error = (after / before - 1.0).abs();
            ensure(error <= ROUNDING, || format!("band {l} changes by {error:e} at {origins:?}"))?;
        }
    }
    Ok(true)
}

/// The orthogonal matrix by which a kernel turns band 1, which is (−y, z, −x).
fn of_band_1(run: impl Fn(&[f64]) -> Vec<f64>, order: usize) -> Result<Matrix, String> {
    let mut matrix = Matrix::default();
    for (axis, (place, sign)) in [(3, -1.0), (1, -1.0), (2, 1.0)].into_iter().enumerate() {
        let mut signal = vec![0.0; order * order];
        signal[place] = sign;
        let out = run(&signal);
        matrix[3 * axis..3 * axis + 3].copy_from_slice(&[-out[3], -out[1], out[2]]);
    }
    let square = product(&transposed(&matrix), &matrix);
    let error = difference(&square, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    ensure(error <= ROUNDING, || format!("band 1 is turned by {matrix:?}"))?;
    Ok(matrix)
}

/// Each band is turned as the parameters say, or, where they do not say it, as band 1 is; an approximate rotation errs by at
/// most its method's law. A set-up is tried through what it is made for.
fn it_turns_as_it_says(spec: &Spec) -> Tried {
    let (family, order) = (spec.family, spec.order);
    let through = match family.measure {
        Measure::Through(rotation) => Some(Runner::<f64>::of(&rotation(order))),
        Measure::Bands if family.acts == Acts::Turns => None,
        _ => return Ok(false),
    };
    let (subject, sphere) = (Subject::new(spec), Sphere::new(order));
    for (i, trial) in subject.trials.iter().enumerate() {
        let (origins, signal) = trial.alone();
        let run = |signal: &[f64]| match &through {
            Some(rotation) => rotation.run(&[subject.run(origins, &[]), signal.to_vec()]),
            None => subject.run(origins, signal),
        };
        let mut signal = match &through {
            Some(_) => (0..order * order).map(|place| ((i + 1) * (place + 3)) as f64 % 7.0 - 2.5).collect(),
            None => signal.to_vec(),
        };
        let matrix = match turn(spec, origins) {
            Some(Turn::Whole(matrix)) => matrix,
            Some(Turn::Axis(matrix)) => {
                // A spin about the axis changes nothing of a zonal signal.
                if signal.len() == order * order {
                    (0..signal.len()).filter(|place| *place != place.isqrt() * (place.isqrt() + 1)).for_each(|place| {
                        signal[place] = 0.0;
                    });
                }
                matrix
            }
            None => of_band_1(run, order)?,
        };
        let (got, want) = (run(&signal), sphere.turned(&matrix, &whole(&signal, order)));
        // The quadrature rounds as much in every band.
        let rounding = ROUNDING * norm(&signal);
        let angle = matrix[6].hypot(matrix[7]).atan2(matrix[8]);
        for (l, law) in law::errors(spec, angle).into_iter().enumerate() {
            let range = places(l, order, order * order);
            let (error, size) = (difference(&got[range.clone()], &want[range.clone()]), norm(&want[range]));
            let most = law.max * (1.0 + 1e-9) * size + rounding;
            ensure(error <= most, || format!("band {l} errs by {error:e}, not {most:e}, at {origins:?}"))?;
        }
    }
    Ok(true)
}

/// Where the parameters say no rotation, f32 rounds a few times: 3e-7 is five roundings of a band's largest value, and
/// lobes are as many terms to sum.
fn no_turn_changes_nothing(spec: &Spec) -> Tried {
    let order = spec.order;
    if !matches!(spec.family.measure, Measure::Bands) || spec.family.acts != Acts::Turns {
        return Ok(false);
    }
    let (subject, narrow) = (Subject::new(spec), Runner::<f32>::new(spec));
    let mut tried = false;
    for trial in &subject.trials {
        let (origins, signal) = trial.alone();
        let none: Vec<Origin> = origins.iter().map(identity).collect();
        // A kernel without parameters turns always, and one that leaves a spin open may do it at z.
        let zonal = signal.len() == order;
        if none.is_empty() || (matches!(turn(spec, &none), Some(Turn::Axis(_))) && !zonal) {
            continue;
        }
        let out = narrow.run(&subject.given(&none, signal));
        let want = whole(signal, order);
        for l in 0..order {
            let range = places(l, order, want.len());
            let (error, size) = (difference(&out[range.clone()], &want[range.clone()]), norm(&want[range]));
            let most = if spec.family.proof == Proof::Lobes { 6e-7 } else { 3e-7 };
            ensure(error <= most * size, || format!("band {l} changes by {:e}", error / size))?;
        }
        tried = true;
    }
    Ok(tried)
}

/// Shears of both parities are undone by those of the opposite angle.
fn is_invertible(method: SmallAngle, l: usize) -> bool {
    method == SmallAngle::Exact || !parity_shears(l, method).is_empty()
}

/// What turns exactly, or by shears, is undone by the inverse's parameters; what turns exactly is composed.
fn turns_are_undone_and_composed(spec: &Spec) -> Tried {
    let (family, order) = (spec.family, spec.order);
    let undone = spec.methods.iter().zip(1..).all(|(&method, l)| is_invertible(method, l));
    if !matches!(family.measure, Measure::Bands) || family.acts != Acts::Turns || !undone {
        return Ok(false);
    }
    let subject = Subject::new(spec);
    let mut tried = false;
    for trials in subject.trials.windows(2) {
        let ((a, signal), (b, _)) = (trials[0].alone(), trials[1].alone());
        if signal.len() != order * order {
            return Ok(false);
        }
        let once = subject.run(a, signal);
        let close = |got: &[f64], want: &[f64], what: &str| {
            let error = (0..order).map(|l| {
                let range = places(l, order, want.len());
                difference(&got[range.clone()], &want[range.clone()]) / norm(&want[range])
            });
            let error = error.fold(0.0, larger);
            ensure(error <= 3.0 * ROUNDING, || format!("{what}: {error:e} at {a:?}, {b:?}"))
        };
        let back: Option<Vec<Origin>> = a.iter().map(inverse).collect();
        if let Some(back) = back.filter(|back| !back.is_empty()) {
            close(&subject.run(&back, &once), signal, "there and back")?;
            tried = true;
        }
        let both: Option<Vec<Origin>> = a.iter().zip(b).map(|(a, b)| composed(a, b)).collect();
        if let Some(both) = both.filter(|both| !both.is_empty() && !spec.is_approximate()) {
            close(&subject.run(a, &subject.run(b, signal)), &subject.run(&both, signal), "one after the other")?;
            tried = true;
        }
    }
    Ok(tried)
}

fn the_loop_is_the_same(spec: &Spec) -> Tried {
    let looped = spec.clone().looped();
    if !spec.family.looped.is_some_and(|family| (family.has)(spec)) || spec.form == Form::Loop {
        return Ok(false);
    }
    let (subject, again) = (Subject::new(spec), Runner::<f64>::new(&looped));
    for Trial { origins, signals } in &subject.trials {
        let input = subject.parameters.inputs(origins, signals);
        let (want, got) = (subject.runner.run(&input), again.run(&input));
        let error = difference(&got, &want);
        ensure(error <= ROUNDING * norm(&want), || format!("the loop is {error:e} off at {origins:?}"))?;
    }
    Ok(true)
}

/// A kernel of some bands is that of all of them with nothing in the others.
fn some_bands_are_the_same(spec: &Spec) -> Tried {
    if !spec.family.some_bands || !spec.is_whole() || spec.form == Form::Loop {
        return Ok(false);
    }
    let (subject, order) = (Subject::new(spec), spec.order);
    // Every set of bands but none and all.
    for set in 1..(1usize << order) - 1 {
        let bands: Vec<usize> = (0..order).filter(|l| set >> l & 1 == 1).collect();
        let some = Subject::new(&Spec { bands: bands.clone(), ..spec.clone() });
        let packed = |list: &[f64]| -> Vec<f64> {
            bands.iter().flat_map(|&l| &list[l * l..(l + 1) * (l + 1)]).copied().collect()
        };
        for trial in subject.trials.iter().step_by(5) {
            let (origins, signal) = trial.alone();
            let mut other = signal.to_vec();
            (0..order).filter(|l| !bands.contains(l)).flat_map(|l| l * l..(l + 1) * (l + 1)).for_each(|place| {
                if let Some(x) = other.get_mut(place) {
                    *x = 0.0;
                }
            });
            let want = subject.run(origins, &other);
            let want = if want.len() == order * order { packed(&want) } else { want };
            let got = some.run(origins, &if signal.is_empty() { vec![] } else { packed(signal) });
            let error = difference(&got, &want);
            ensure(got.len() == want.len() && error <= ROUNDING * (1.0 + norm(signal)), || {
                format!("bands {bands:?} are {error:e} off at {origins:?}")
            })?;
        }
    }
    Ok(true)
}

/// f16 errs by its unit roundoff as f32 does by its own, on inputs that both hold, and once more by what it does to constants.
fn f16_errs_by_its_roundoff(spec: &Spec) -> Tried {
    if !spec.takes_half() {
        return Ok(false);
    }
    let half = Spec { half: true, ..spec.clone() };
    let (tiny, narrow, wide) = (Runner::<Half>::new(&half), Runner::<f32>::new(spec), Runner::<f64>::new(spec));
    let (measure, meaning) = (spec.family.measure, Meaning::of(spec));
    let (mut worst_half, mut worst) = (0.0, 0.0);
    for input in inputs(spec.code().params(), 47, COUNT, None) {
        let input: Vec<Vec<f64>> =
            input.iter().map(|list| list.iter().map(|&x| Half::round(x).to_f64()).collect()).collect();
        let want = meaning.apply(wide.run(&input));
        let error = |got: Vec<f64>| measure.error(&meaning.apply(got), &want, spec.order);
        worst_half = larger(worst_half, error(tiny.run(&input)) / Half::UNIT_ROUNDOFF);
        worst = larger(worst, error(narrow.run(&input)) / f32::UNIT_ROUNDOFF);
    }
    ensure(worst_half <= 4.0 * worst.max(1.0), || format!("f16 errs by {worst_half} of its roundoff, f32 by {worst}"))?;
    Ok(true)
}

/// The kernels of a family that the catalogue shows at the orders that are tried, for one channel.
pub(crate) fn specs(family: &'static Family) -> Vec<Spec> {
    let mut specs: Vec<Spec> = ORDERS.flat_map(family.shown).map(|spec| spec.base()).collect();
    specs.dedup();
    // What the catalogue leaves out is tried as it is at its least order.
    if specs.is_empty() {
        specs.push(Spec::new(family, *family.orders.start()));
    }
    specs
}

/// The properties of a family's kernels; each contradiction with its kernel and its property.
pub(crate) fn tried(specs: &[Spec]) -> (BTreeSet<&'static str>, Vec<(String, &'static str)>) {
    let (mut held, mut faults) = (BTreeSet::new(), Vec::new());
    for spec in specs {
        for (name, property) in PROPERTIES {
            match property(spec) {
                Ok(true) => _ = held.insert(name),
                Ok(false) => {}
                Err(fault) => faults.push((format!("{spec}: {name}: {fault}"), name)),
            }
        }
    }
    (held, faults)
}

#[test]
fn every_family_has_the_properties_that_its_record_says() {
    let all: Vec<_> = ALL.par_iter().with_max_len(1).map(|family| (family, tried(&specs(family)))).collect();
    let mut families: BTreeMap<&str, Vec<String>> = PROPERTIES.iter().map(|(name, _)| (*name, vec![])).collect();
    let mut faults = Vec::new();
    for (family, (held, found)) in all {
        faults.extend(found.into_iter().map(|(fault, _)| fault));
        if !held.iter().any(|name| *name != OF_ALL) {
            faults.push(format!("{family:?}: nothing can be tested of it"));
        }
        held.iter().for_each(|name| families.get_mut(name).expect("is listed").push(format!("{family:?}")));
    }
    families
        .iter()
        .for_each(|(name, families)| println!("{name}: {} of {}, {}", families.len(), ALL.len(), families.join(", ")));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(families.values().all(|families| !families.is_empty()), "{families:?}");
}

/// What is linear in each of two signals, or a square of one.
#[test]
fn products_are_linear_in_each_signal() {
    for spec in toys::specs().into_iter().filter(|spec| !spec.rgb) {
        assert_eq!(is_linear(&spec), Ok(true), "{spec}");
    }
}

#[test]
fn three_channels_are_three_scalars() {
    let with_signal = ALL.iter().filter(|family| family.has_signal());
    let least = |family: &'static Family| Spec::new(family, *family.orders.start()).both();
    let lowest = |family: &&'static Family| {
        ORDERS.map(family.shown).find(|specs| !specs.is_empty()).unwrap_or_else(|| least(family))
    };
    let specs: Vec<Spec> = with_signal.flat_map(lowest).filter(|spec| spec.rgb).collect();
    assert!(specs.len() > 25);
    build(&specs).par_iter().for_each(|function| crate::shaders::check(function, &WGSL, Language::Wgsl));
}

#[test]
fn the_basis_is_orthonormal() {
    for order in [2, 5, 10] {
        for (a, row) in Sphere::new(order).gram().into_iter().enumerate() {
            for (b, got) in row.into_iter().enumerate() {
                let error = (got - f64::from(u8::from(a == b))).abs();
                assert!(error <= 1e-13, "order {order}: entry {a}, {b} is {error:e} off");
            }
        }
    }
}
