//! The proven rounding bounds: nothing that is measured exceeds them, and what is made worse shows.

use std::collections::BTreeMap;
use std::time::Instant;
use zonal_codegen::catalog::standard;
use zonal_codegen::families::Spec;
use zonal_codegen::families::family::{Measure, Proof};
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::Shape;
use zonal_codegen::ir::listing::{Listing, Op, Operand, Sign, Step};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::accuracy::{Meaning, rounding};
use zonal_codegen::promise::bound::phases::of_quaternion;
use zonal_codegen::promise::bound::plain::plain;
use zonal_codegen::promise::bound::{Bound, boxes, of, prove, within};
use zonal_codegen::promise::samples::{self, Random};
use zonal_measure::bounds::{self, Bounds, Pair};
use zonal_tests::spec;

const BOTH: [Contraction; 2] = [Contraction::Separate, Contraction::Fused];
/// Steps that the interpreter is given for each kernel.
const STEPS: usize = 4_000_000;

fn listing(text: &str) -> (Spec, Listing) {
    let spec = spec(text);
    let listing = match spec.code() {
        Code::Straight(listing) => listing,
        Code::Loop(kernel) => plain(&Listing::from(&kernel)).expect("a loop of the catalogue is arithmetic"),
        Code::Branch(_) => panic!("{text} is two listings"),
    };
    (spec, listing)
}

fn proven(spec: &Spec, listing: &Listing) -> Bound {
    prove(spec, listing).unwrap_or_else(|| panic!("{spec} has no bound"))
}

/// Nothing that is measured exceeds what is proven, over so many inputs that each kernel costs the same, but two thousand at
/// least. `cargo measure --bounds` runs every kernel on a million.
#[test]
fn nothing_measured_exceeds_its_bound() {
    let start = Instant::now();
    let kernels = bounds::proven();
    let proving = start.elapsed().as_secs_f64();
    assert!(kernels.len() > 300);
    let mut families: BTreeMap<String, Vec<Bounds>> = BTreeMap::new();
    for kernel in &kernels {
        let inputs = (STEPS / kernel.steps().max(1)).clamp(2000, bounds::INPUTS);
        let name = kernel.spec.to_string().replace(&format!(":{}", kernel.spec.order), "");
        families.entry(name).or_default().push(kernel.measured(inputs));
    }
    println!("order: proven / measured = ratio, separate; fused");
    for (family, rows) in &families {
        println!("{family}");
        for row in rows {
            let part = |pair: Pair| format!("{:.1e} / {:.1e} = {:.1}", pair.proven, pair.measured, pair.ratio());
            println!("  {:2}: {}; {} ({} inputs)", row.order, part(row.separate), part(row.fused), row.inputs);
        }
    }
    println!("proven in {proving:.2} s, measured in {:.1} s", start.elapsed().as_secs_f64() - proving);
    let rows: Vec<&Bounds> = families.values().flatten().collect();
    for row in &rows {
        for Pair { proven, measured } in [row.separate, row.fused] {
            assert!(measured <= proven, "{}: measured {measured:e}, proven {proven:e}", row.spec);
        }
    }
    // Bounds are no use if they are far off: half of them are within ten times of what random inputs reach.
    let close = rows.iter().filter(|row| row.separate.ratio() <= 10.0).count();
    assert!(2 * close > rows.len(), "{close} of {}", rows.len());
}

/// All but products, which no proof takes, and what a family says that it has none of.
#[test]
fn every_kernel_of_the_catalogue_has_a_bound_where_it_says_so() {
    let proven: Vec<String> = bounds::proven().iter().map(|kernel| kernel.spec.to_string()).collect();
    for spec in standard().into_iter().filter(|spec| !spec.rgb) {
        let (measure, proof) = (spec.family.measure, spec.proof());
        let expected = !matches!(measure, Measure::Product) && proof != Proof::Nothing;
        assert_eq!(proven.contains(&spec.to_string()), expected, "{spec}");
    }
}

/// The proof of a loop is that of its operations without those that change nothing: it does the same, bit for bit.
#[test]
fn a_loop_without_what_changes_nothing_is_the_same() {
    for text in ["basis:6:loop", "taylor15:6:loop", "rotate:6:loop", "rotate:12:loop"] {
        let (spec, plain) = listing(text);
        let Code::Loop(kernel) = spec.code() else { panic!("{text} is a loop") };
        let whole = Listing::from(&kernel);
        assert!(plain.steps.len() < whole.steps.len(), "{text}");
        let programs = [&whole, &plain].map(Program::<f32>::new);
        for input in samples::inputs(&whole.params, 4, 30, Some(0.4)) {
            let narrow: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
            let narrow: Vec<&[f32]> = narrow.iter().map(Vec::as_slice).collect();
            for contraction in BOTH {
                let [a, b] = programs.each_ref().map(|program| program.run(&narrow, contraction));
                assert!(a.iter().zip(&b).all(|(a, b)| a.abs() == b.abs()), "{text}");
            }
        }
    }
}

/// The quaternion's and the normal's set-up over boxes: as phases they are off by hardly more than what is known by hand
/// and more than what is measured, so that neither analysis is far off.
#[test]
fn boxes_agree_with_the_bound_by_hand() {
    const U: f64 = f32::EPSILON as f64 / 2.0;
    let (_, listing) = listing("angles:4");
    let phases = of_quaternion(&listing).expect("is a quaternion's set-up");
    let inputs = |i: usize| Operand::Input { param: 0, index: i };
    let nudged = |index: usize| {
        let is = |step: &Step| matches!(step.op, Op::Add(a, Operand::Tiny) | Op::Add(Operand::Tiny, a) if a == inputs(index));
        Operand::Step(listing.steps.iter().position(is).expect("a component is nudged"))
    };
    let pairs = [[nudged(3), inputs(2)], [nudged(1), inputs(0)]];
    for (phase, by_hand) in phases[..2].iter().zip([[5.5 + 5f64.sqrt(), 7.5]; 2]) {
        let boxes = boxes::error(&listing, &pairs, &[phase.cos, phase.sin]).expect("is homogeneous");
        for mode in 0..2 {
            assert!(boxes[mode] <= 1.05 * by_hand[mode] * U, "{:e} against {} u", boxes[mode], by_hand[mode]);
            assert!(phase.error[mode] <= by_hand[mode] * U + 1e-11 && phase.error[mode] <= boxes[mode] + 1e-11);
        }
    }
    // Quaternions at every scale of both pairs, poles among them.
    let set_up = Listing { outputs: phases.iter().flat_map(|phase| [phase.cos, phase.sin]).collect(), ..listing };
    let (narrow, wide) = (Program::<f32>::new(&set_up), Program::<f64>::new(&set_up));
    let mut random = Random::new(17);
    let mut worst = [0.0f64; 2];
    for _ in 0..100_000 {
        let ([a, b], [c, d]) = (random.unit::<2>(), random.unit::<2>());
        let scale = 10f64.powf(-4.0 * (1.0 + random.signed()));
        let half = scale.min(1.0 / scale).atan();
        let (sin, cos) = if random.signed() > 0.0 { half.sin_cos() } else { (half.cos(), half.sin()) };
        let q = [sin * a, sin * b, cos * c, cos * d].map(|x| x as f32);
        for (mode, contraction) in BOTH.into_iter().enumerate() {
            let got = narrow.run(&[&q], contraction);
            let want = wide.run(&[&q.map(f64::from)], contraction);
            let off = |i: usize| (f64::from(got[i]) - want[i]).hypot(f64::from(got[i + 1]) - want[i + 1]);
            worst[mode] = worst[mode].max(off(0)).max(off(2));
            assert!(off(4) <= phases[2].error[mode], "{q:?}: {:e}", off(4));
        }
    }
    for (mode, worst) in worst.into_iter().enumerate() {
        let proven = phases[0].error[mode];
        assert!(worst <= proven && proven <= 2.5 * worst, "measured {worst:e}, proven {proven:e}");
    }
}

/// Errors of one input: f32 against f64.
fn error(spec: &Spec, narrow: &Program<f32>, wide: &Program<f64>, input: &[Vec<f64>], contraction: Contraction) -> f64 {
    let rounded: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
    let same: Vec<Vec<f64>> = rounded.iter().map(|list| list.iter().map(|&x| f64::from(x)).collect()).collect();
    let got = narrow.run(&rounded.iter().map(Vec::as_slice).collect::<Vec<_>>(), contraction);
    let want = wide.run(&same.iter().map(Vec::as_slice).collect::<Vec<_>>(), contraction);
    let (measure, meaning) = (spec.family.measure, Meaning::of(spec));
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
    for text in all
        .into_iter()
        .chain(["taylor2:5", "rotate:5:taylor1", "rotate:4:zxzxz", "rotate:5:align", "rotate:4:zonal"])
        .chain(["basis:6:loop", "taylor15:5:loop", "rotate:5:loop", "zhf:5"])
    {
        let (spec, listing) = listing(text);
        let bound = proven(&spec, &listing);
        let (narrow, wide) = (Program::<f32>::new(&listing), Program::<f64>::new(&listing));
        let most = spec.max_angle().unwrap_or(std::f64::consts::PI);
        let mut random = Random::new(11);
        for (contraction, bound) in BOTH.into_iter().zip([bound.separate, bound.fused]) {
            let drawn = samples::inputs(&listing.params, 3, 400, None);
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
    for text in ["basis:5", "eval:4", "rotate_y:5", "rotate:5:euler", "tilt:5", "lf3:4", "zhf_weights:4", "swap_yz:5"]
        .into_iter()
        .chain(["basis:5:loop", "taylor15:5:loop", "rotate:5:loop", "zhf:3"])
    {
        let (spec, listing) = listing(text);
        let bound = proven(&spec, &listing).value();
        let wide = Program::<f64>::new(&listing);
        let inputs = samples::inputs(&listing.params, 5, 200, None);
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
    for text in ["rotate:4", "angles:4", "rotate_z:4", "rotate:4:align", "rotate:4:loop"] {
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

/// What the first prover of this kind reached (docs/MATH.md#rounding-bounds), from a quaternion and for the basis.
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
        assert!(bound.bands.len() == if matches!(spec.family.measure, Measure::Absolute) { 0 } else { spec.order });
    }
}

/// What the planner adds to a method's error: the bound up to a smaller angle is smaller, and holds there.
#[test]
fn a_bound_within_an_angle_holds_there() {
    for text in ["rotate_small:10", "tilt:10", "tilt:8:lf5", "rotate:8:lf3", "rotate_adaptive:8"] {
        let (spec, code) = (spec(text), spec(text).code());
        let whole = of(&spec, &code).expect("is proven").value();
        let mut before = 0.0;
        for degrees in [1.0, 5.0, 15.0] {
            let angle = f64::to_radians(degrees);
            let bound = within(&spec, &code, Some(angle)).expect("is proven");
            assert!(before <= bound.value() && bound.value() <= whole, "{text} at {degrees} degrees");
            before = bound.value();
            let (narrow, wide) = (code.runner::<f32>(), code.runner::<f64>());
            for input in samples::inputs(code.params(), 5, 300, Some(angle)) {
                let rounded: Vec<Vec<f32>> =
                    input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
                let exact: Vec<Vec<f64>> =
                    rounded.iter().map(|list| list.iter().map(|&x| x.into()).collect()).collect();
                let want = wide.run(&exact.iter().map(Vec::as_slice).collect::<Vec<_>>(), Contraction::Separate);
                for (contraction, most) in BOTH.into_iter().zip([bound.separate, bound.fused]) {
                    let got = narrow.run(&rounded.iter().map(Vec::as_slice).collect::<Vec<_>>(), contraction);
                    let got: Vec<f64> = got.into_iter().map(f64::from).collect();
                    let error = spec.family.measure.error(&got, &want, spec.order);
                    assert!(error <= most, "{text} at {degrees} degrees: {error:e}, proven {most:e}");
                }
            }
        }
        // The shears of a high band are no rotation at the largest angle, and not far from one at 5 degrees.
        let near = within(&spec, &code, Some(f64::to_radians(5.0))).expect("is proven").value();
        println!("{text}: {near:.1e} within 5 degrees, {whole:.1e} in all");
        assert!(near < 2e-5, "{text}: {near:e}");
    }
}
