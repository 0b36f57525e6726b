//! The proven rounding bounds: nothing that is measured exceeds them, and what is made worse shows.

use std::collections::BTreeMap;
use std::time::Instant;
use zonal_codegen::accuracy::{Meaning, Measure, rounding};
use zonal_codegen::bound::{Bound, prove};
use zonal_codegen::built::kernel;
use zonal_codegen::catalog::standard;
use zonal_codegen::code::Code;
use zonal_codegen::eval::{Contraction, Program};
use zonal_codegen::graph::Kind;
use zonal_codegen::kernel::Shape;
use zonal_codegen::listing::{Listing, Op, Operand, Sign, Step};
use zonal_codegen::samples::{self, Random};
use zonal_codegen::sh::exact::Exact;
use zonal_codegen::spec::{Family, Form, Spec};
use zonal_tests::spec;

const BOTH: [Contraction; 2] = [Contraction::Separate, Contraction::Fused];
/// Steps that the interpreter is given for each kernel and contraction.
const STEPS: usize = 1_500_000;

fn listing(text: &str) -> (Spec, Listing) {
    let spec = spec(text);
    let listing = Listing::new(&kernel(&spec));
    (spec, listing)
}

fn proven(spec: &Spec, listing: &Listing) -> Bound {
    prove(spec, listing).unwrap_or_else(|| panic!("{spec} has no bound"))
}

struct Row {
    spec: Spec,
    bound: [f64; 2],
    measured: [f64; 2],
    inputs: usize,
    seconds: f64,
}

fn row(spec: &Spec) -> Option<Row> {
    let listing = Listing::new(&kernel(spec));
    let start = Instant::now();
    let bound = prove(spec, &listing);
    let seconds = start.elapsed().as_secs_f64();
    if bound.is_none() {
        assert_eq!(spec.family, Family::Zhf, "{spec} has no bound");
    }
    let bound = bound?;
    let inputs = (STEPS / listing.steps.len().max(1)).clamp(2000, 100_000);
    let code = Code::Straight(listing);
    let measured = BOTH.map(|contraction| rounding::<f32>(spec, &code, 7, inputs, contraction));
    Some(Row { spec: spec.clone(), bound: [bound.separate, bound.fused], measured, inputs, seconds })
}

/// Every straight-line kernel of the catalogue but `zhf` has a bound, and keeps it.
#[test]
fn nothing_measured_exceeds_its_bound() {
    let specs: Vec<Spec> = standard().into_iter().filter(|spec| !spec.rgb && spec.form == Form::Unrolled).collect();
    let rows: Vec<Row> = std::thread::scope(|scope| {
        let threads = [0, 1].map(|half| {
            let specs = &specs;
            scope.spawn(move || specs.iter().skip(half).step_by(2).filter_map(row).collect::<Vec<_>>())
        });
        threads.into_iter().flat_map(|thread| thread.join().expect("no kernel panics")).collect()
    });
    assert!(rows.len() > 180);
    let mut families: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in &rows {
        let name = row.spec.to_string().replace(&format!(":{}", row.spec.order), "");
        families.entry(name).or_default().push(row);
    }
    println!("order: proven / measured = ratio, separate; fused");
    for (family, rows) in &mut families {
        println!("{family}");
        rows.sort_by_key(|row| row.spec.order);
        for row in rows {
            let part = |i: usize| {
                format!("{:.1e} / {:.1e} = {:.1}", row.bound[i], row.measured[i], row.bound[i] / row.measured[i])
            };
            println!("  {:2}: {}; {} ({} inputs, {:.3} s)", row.spec.order, part(0), part(1), row.inputs, row.seconds);
        }
    }
    println!("in all {:.2} s", rows.iter().map(|row| row.seconds).sum::<f64>());
    for row in &rows {
        for (bound, measured) in row.bound.iter().zip(row.measured) {
            assert!(measured <= *bound, "{}: measured {measured:e}, proven {bound:e}", row.spec);
        }
    }
    // Bounds are no use if they are far off: half of them are within ten times of what random inputs reach.
    let close = rows.iter().filter(|row| row.bound[0] <= 10.0 * row.measured[0]).count();
    assert!(2 * close > rows.len(), "{close} of {}", rows.len());
}

/// Errors of one input: f32 against f64.
fn error(spec: &Spec, narrow: &Program<f32>, wide: &Program<f64>, input: &[Vec<f64>], contraction: Contraction) -> f64 {
    let rounded: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
    let same: Vec<Vec<f64>> = rounded.iter().map(|list| list.iter().map(|&x| f64::from(x)).collect()).collect();
    let got = narrow.run(&rounded.iter().map(Vec::as_slice).collect::<Vec<_>>(), contraction);
    let want = wide.run(&same.iter().map(Vec::as_slice).collect::<Vec<_>>(), contraction);
    let (measure, meaning) = (Measure::of(spec), Meaning::of(spec));
    let got = got.iter().map(|&x| f64::from(x)).collect();
    measure.error(&meaning.apply(got), &meaning.apply(want), spec.order)
}

/// A nearby input of the same domain.
fn nearby(listing: &Listing, input: &[Vec<f64>], distance: f64, random: &mut Random, most: f64) -> Vec<Vec<f64>> {
    let unit = |list: &mut [f64]| {
        let norm = list.iter().map(|x| x * x).sum::<f64>().sqrt();
        list.iter_mut().for_each(|x| *x /= norm);
    };
    let moved = listing.params.iter().zip(input).map(|(param, list)| {
        let mut list: Vec<f64> = list.iter().map(|x| x + distance * random.signed()).collect();
        match (param.kind, param.shape) {
            (Kind::Signal, _) => (0..list.len().isqrt()).for_each(|l| unit(&mut list[l * l..(l + 1) * (l + 1)])),
            (_, Shape::Scalar) => list[0] = list[0].clamp(-most, most),
            _ => list.chunks_mut(if matches!(param.shape, Shape::Pairs(_)) { 2 } else { 4 }).for_each(unit),
        }
        list
    });
    moved.collect()
}

/// Inputs that are sought for their error, not drawn, stay below the bound too, and come closer to it.
#[test]
fn a_search_for_the_worst_input_stays_below_the_bound() {
    let all =
        ["basis:4", "basis:8", "eval:5", "rotate_y:4", "rotate_z:6", "rotate:3", "rotate:4", "rotate:6:euler", "lf3:4"];
    for text in
        all.into_iter().chain(["taylor2:5", "rotate:5:taylor1", "rotate:4:zxzxz", "rotate:5:align", "rotate:4:zonal"])
    {
        let (spec, listing) = listing(text);
        let bound = proven(&spec, &listing);
        let (narrow, wide) = (Program::<f32>::new(&listing), Program::<f64>::new(&listing));
        let most = spec.max_angle().unwrap_or(std::f64::consts::PI);
        let mut random = Random::new(11);
        for (contraction, bound) in BOTH.into_iter().zip([bound.separate, bound.fused]) {
            let drawn = samples::inputs(&spec, &listing.params, 3, 400, most);
            let of = |input: &[Vec<f64>]| error(&spec, &narrow, &wide, input, contraction);
            let mut best = drawn.into_iter().max_by(|a, b| of(a).total_cmp(&of(b))).expect("inputs were drawn");
            let (first, mut worst) = (of(&best), of(&best));
            for i in 0..3000 {
                let distance = [0.3, 0.03, 1e-3, 1e-6][i % 4];
                let next = nearby(&listing, &best, distance, &mut random, most);
                let found = of(&next);
                assert!(found <= bound, "{text}: {found:e} above {bound:e}");
                if found > worst {
                    (worst, best) = (found, next);
                }
            }
            println!("{text}: drawn {first:.1e}, sought {worst:.1e}, proven {bound:.1e}: {:.1}", bound / worst);
        }
    }
}

/// A constant that is 1e-5 off shows at once: the bound is small enough to tell.
#[test]
fn a_wrong_constant_exceeds_the_bound() {
    for text in ["basis:5", "eval:4", "rotate_y:5", "rotate:5:euler", "tilt:5", "lf3:4", "zhf_weights:4", "swap_yz:5"] {
        let (spec, listing) = listing(text);
        let bound = proven(&spec, &listing).value();
        let wide = Program::<f64>::new(&listing);
        let most = spec.max_angle().unwrap_or(std::f64::consts::PI);
        let inputs = samples::inputs(&spec, &listing.params, 5, 200, most);
        let worst = |listing: &Listing| {
            let narrow = Program::<f32>::new(listing);
            inputs.iter().map(|input| error(&spec, &narrow, &wide, input, Contraction::Fused)).fold(0.0, f64::max)
        };
        assert!(worst(&listing) <= bound, "{text}");
        let mut seen = 0;
        for place in 0..listing.constants.len() {
            let mut wrong = listing.clone();
            wrong.constants[place] = &wrong.constants[place] * &Exact::ratio(100_003, 100_000);
            seen += usize::from(worst(&wrong) > bound);
        }
        assert!(2 * seen > listing.constants.len(), "{text}: {seen} of {}", listing.constants.len());
    }
}

/// (value + 64) − 64 instead of a value: the same function, lossy. It breaks the old bound and keeps its own.
#[test]
fn a_lossy_order_of_operations_has_a_larger_bound() {
    let (spec, listing) = listing("basis:4");
    let mut lossy = listing.clone();
    lossy.constants.push(Exact::int(64));
    let offset = Operand::Const(lossy.constants.len() - 1);
    let mut push = |op| {
        lossy.steps.push(Step { op, kind: Kind::Scalar, uses: 1 });
        Operand::Step(lossy.steps.len() - 1)
    };
    let raised = push(Op::Add(listing.outputs[5], offset));
    let lowered = push(Op::Sub(raised, offset));
    lossy.outputs[5] = lowered;
    let (old, new) = (proven(&spec, &listing), proven(&spec, &lossy));
    for contraction in BOTH {
        let measured = rounding::<f32>(&spec, &Code::Straight(lossy.clone()), 1, 2000, contraction);
        assert!(measured > old.value() && measured <= new.value(), "{measured:e}: {old:?}, {new:?}");
    }
}

/// A sign that is wrong in a phase is no phase any more, so that nothing is concluded from its being one.
#[test]
fn a_wrong_sign_is_not_taken_for_a_phase() {
    for text in ["rotate:4", "angles:4", "rotate_z:4", "rotate:4:align"] {
        let (spec, listing) = listing(text);
        let right = prove(&spec, &listing);
        let products = (0..listing.steps.len()).filter(|&place| {
            let step = listing.steps[place];
            step.kind == Kind::Scalar && matches!(step.op, Op::Fma(.., Sign::MinusProduct | Sign::MinusAddend))
        });
        for place in products {
            let mut wrong = listing.clone();
            if let Op::Fma(a, b, c, _) = wrong.steps[place].op {
                wrong.steps[place].op = Op::Fma(a, b, c, Sign::Plus);
            }
            assert_ne!(prove(&spec, &wrong), right, "{text}, step {place}");
        }
    }
}

/// What MATH section 11 reaches, from a quaternion and for the basis.
#[test]
fn bounds_are_as_close_as_the_best_known() {
    for (text, most) in [
        ("rotate:4", 5.8e-6),
        ("rotate:6", 1.0e-5),
        ("rotate:8", 1.5e-5),
        ("rotate:8:angles", 3.4e-6),
        ("basis:8", 2.8e-6),
        ("basis:10", 7.0e-6),
    ] {
        let (spec, listing) = listing(text);
        let bound = proven(&spec, &listing);
        assert!(bound.fused <= most, "{text}: {:e} above {most:e}", bound.fused);
        assert!(bound.bands.len() == if spec.family == Family::Basis { 0 } else { spec.order });
    }
}

#[test]
fn loops_and_turned_lobes_have_no_bound() {
    for text in ["zhf:4", "basis:4:loop", "rotate:5:loop"] {
        let (spec, listing) = listing(text);
        assert_eq!(prove(&spec, &listing), None, "{text}");
    }
}
