//! Operations that no kernel of the catalogue does: what they give, extremes included, what is folded, which kinds they
//! refuse, and what is promised of kernels with them.

use crate::toys::TOYS;
use std::collections::BTreeSet;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::language::{GLSL, WGSL};
use zonal_codegen::families::Spec;
use zonal_codegen::generate::{build, file};
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::graph::{Graph, Id, Kind, Node};
use zonal_codegen::ir::kernel::{Builder, Domain, Shape};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::ir::op::Op;
use zonal_codegen::ir::program::{LoopKernel, Num, Stmt};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::half::Half;
use zonal_codegen::promise::accuracy::rounding;
use zonal_codegen::promise::{bound, samples};
use zonal_tests::spec;
use zonal_tests::toys::{CHOICES, PRODUCT};

/// The choices from their definition, with the functions of `std`.
fn chosen(dir: &[f64], c: &[f64]) -> Vec<f64> {
    let [x, y, z] = dir[..] else { panic!("a direction has three components") };
    vec![
        (1.0 + z).sqrt() * c[0],
        if x < y { c[1] } else { c[2] },
        if z <= 0.0 { -c[2] } else { c[3] },
        (3.0 * x).clamp(-0.5, 0.5) * c[3],
        y.exp2() * c[4],
        (1.5 + z / 2.0).log2() * c[5],
        f64::min(-x, y) * c[6],
        (x - z).abs() * c[7],
        (x.max(z) + if x.abs() < y.abs() { y } else { x }) * c[8],
    ]
}

#[test]
fn choices_are_what_they_are_called() {
    for looped in [false, true] {
        let spec = Spec::new(&CHOICES, 3);
        let spec = if looped { spec.looped() } else { spec };
        let runner = spec.code().runner::<f64>();
        let (mut sides, code) = (BTreeSet::new(), spec.code());
        for input in samples::inputs(code.params(), 9, 2000, None) {
            let [dir, c] = &input[..] else { panic!("a direction and coefficients") };
            sides.insert([
                dir[0] < dir[1],
                dir[2] <= 0.0,
                dir[0].abs() < dir[1].abs(),
                3.0 * dir[0] < -0.5,
                3.0 * dir[0] > 0.5,
            ]);
            let got = runner.run(&[dir, c], Contraction::Separate);
            for (got, want) in got.iter().zip(chosen(dir, c)) {
                // A few roundings of numbers below eight.
                assert!((got - want).abs() < 8.0 * f64::EPSILON, "{dir:?}: {got} is not {want}");
            }
        }
        assert!(sides.len() > 16, "{sides:?}");
    }
}

/// An operation that is added to the table has to be in a toy, so that it is printed, run and counted in every language.
#[test]
fn every_operation_of_the_table_is_in_a_toy_or_a_set_up() {
    let set_up = build(&[spec("lifted:4")]);
    let mut done = BTreeSet::new();
    for function in TOYS.iter().chain(&set_up) {
        let listing = match &function.built.code {
            Code::Straight(listing) => listing.clone(),
            Code::Loop(kernel) => Listing::from(kernel),
            Code::Branch(_) => panic!("no toy has a branch"),
        };
        done.extend(listing.steps.iter().map(|step| step.op.name()));
    }
    assert_eq!(done, Op::NAMES.iter().copied().collect());
}

/// Runs one operation of up to four numbers in `T`.
fn once<T: Number>(count: usize, of: impl Fn(&mut Graph, &[Id]) -> Id, numbers: &[f64]) -> T {
    let mut builder = Builder::new();
    let x = builder.param("x", Shape::Array(count), Domain::Direction, "numbers");
    let out = of(&mut builder.graph, &x);
    let kernel = builder.finish(vec![out], Shape::Scalar, "a number");
    let numbers: Vec<T> = numbers.iter().map(|&x| T::from_f64(x)).collect();
    Program::<T>::new(&Listing::new(&kernel)).run(&[&numbers], Contraction::Separate)[0]
}

/// What each operation gives in f16, f32 and f64 where a definition says it to the last bit.
fn exactly(count: usize, of: impl Fn(&mut Graph, &[Id]) -> Id, numbers: &[f64], want: f64) {
    let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
    let got = [
        once::<Half>(count, &of, numbers).to_f64(),
        once::<f32>(count, &of, numbers).to_f64(),
        once::<f64>(count, &of, numbers).to_f64(),
    ];
    assert!(got.iter().all(|&got| bits(got) == bits(want)), "{numbers:?}: {got:?}, not {want}");
}

#[test]
fn extremes_give_what_is_documented() {
    const NAN: f64 = f64::NAN;
    const INF: f64 = f64::INFINITY;
    for (a, b, least, most) in [
        (1.0, 2.0, 1.0, 2.0),
        (2.0, 1.0, 1.0, 2.0),
        (-1.0, 1.0, -1.0, 1.0),
        (INF, -INF, -INF, INF),
        // Of equal zeros the first; and so where one is not a number.
        (0.0, -0.0, 0.0, 0.0),
        (-0.0, 0.0, -0.0, -0.0),
        (1.0, NAN, 1.0, 1.0),
        (NAN, 1.0, NAN, NAN),
    ] {
        exactly(2, |g, x| g.min(x[0], x[1]), &[a, b], least);
        exactly(2, |g, x| g.max(x[0], x[1]), &[a, b], most);
    }
    for (x, size) in [(0.0, 0.0), (-0.0, 0.0), (-2.5, 2.5), (2.5, 2.5), (-INF, INF), (NAN, NAN)] {
        exactly(1, |g, x| g.abs(x[0]), &[x], size);
    }
    for (x, root) in [(0.0, 0.0), (-0.0, -0.0), (6.25, 2.5), (INF, INF), (-1.0, NAN), (NAN, NAN)] {
        exactly(1, |g, x| g.sqrt(x[0]), &[x], root);
    }
    for (x, power) in [(0.0, 1.0), (-0.0, 1.0), (3.0, 8.0), (-2.0, 0.25), (-INF, 0.0), (INF, INF), (NAN, NAN)] {
        exactly(1, |g, x| g.exp2(x[0]), &[x], power);
    }
    for (x, logarithm) in [(1.0, 0.0), (0.25, -2.0), (0.0, -INF), (-0.0, -INF), (-1.0, NAN), (INF, INF), (NAN, NAN)] {
        exactly(1, |g, x| g.log2(x[0]), &[x], logarithm);
    }
    for (x, clamped) in [(-3.0, -1.0), (0.5, 0.5), (3.0, 2.0), (-INF, -1.0)] {
        exactly(
            1,
            |g, x| {
                let [low, high] = [-1, 2].map(|n| g.constant(Exact::int(n)));
                g.clamp(x[0], low, high)
            },
            &[x],
            clamped,
        );
    }
    for (a, b, less, at_most) in [
        (1.0, 2.0, 3.0, 3.0),
        (2.0, 1.0, 4.0, 4.0),
        (1.0, 1.0, 4.0, 3.0),
        (0.0, -0.0, 4.0, 3.0),
        (NAN, 1.0, 4.0, 3.0),
        (1.0, NAN, 4.0, 3.0),
    ] {
        exactly(4, |g, x| g.select_less(x[0], x[1], x[2], x[3]), &[a, b, 3.0, 4.0], less);
        exactly(4, |g, x| g.select_at_most(x[0], x[1], x[2], x[3]), &[a, b, 3.0, 4.0], at_most);
    }
    // The smallest number and the largest of f32 are no exception.
    for x in [f32::from_bits(1), f32::MIN_POSITIVE, f32::MAX] {
        let one = f64::from(x);
        assert_eq!(once::<f32>(1, |g, x| g.abs(x[0]), &[-one]), x);
        assert_eq!(once::<f32>(2, |g, x| g.min(x[0], x[1]), &[one, 0.0]), 0.0);
        assert_eq!(once::<f32>(2, |g, x| g.max(x[0], x[1]), &[one, 0.0]), x);
        assert_eq!(once::<f32>(4, |g, x| g.select_less(x[0], x[1], x[2], x[3]), &[0.0, one, 1.0, 2.0]), 1.0);
    }
}

#[test]
fn constants_are_folded_where_that_is_exact() {
    let mut g = Graph::new();
    let x = g.input(0, 0, Kind::Scalar);
    let y = g.input(0, 1, Kind::Scalar);
    let mut of = |value: Exact| g.constant(value);
    let root_half = of(Exact::sqrt_ratio(1, 2));
    let [two, three, minus_two, quarter, minus_one] = [2, 3, -2, 0, -1].map(|n| match n {
        0 => of(Exact::ratio(1, 4)),
        n => of(Exact::int(n)),
    });
    let half = of(Exact::ratio(1, 2));
    let root_two = of(Exact::sqrt_ratio(2, 1));
    assert_eq!(g.min(two, three), two);
    assert_eq!(g.max(two, minus_two), two);
    assert_eq!(g.min(root_half, half), half, "0.5 is below 0.7");
    assert_eq!(g.abs(minus_two), two);
    assert_eq!((g.sqrt(quarter), g.sqrt(two)), (half, root_two));
    assert_eq!(g.select_less(two, three, x, y), x);
    assert_eq!(g.select_at_most(two, two, x, y), x);
    assert_eq!(g.select_less(x, x, x, y), y);
    assert_eq!(g.select_less(x, y, two, two), two);
    let [minus_x, minus_y] = [x, y].map(|v| g.neg(v));
    let (size, most) = (g.abs(x), g.max(x, y));
    assert_eq!((g.abs(minus_x), g.abs(size)), (size, size));
    let least = g.min(minus_x, minus_y);
    assert_eq!(least, g.neg(most), "signs stand outside");
    let chosen = g.select_less(x, y, minus_x, minus_y);
    assert!(matches!(g.node(chosen), Node::Op(Op::Neg(_))));
    // What is not exact is left to the program.
    let [power, logarithm, no_number] = [g.exp2(two), g.log2(two), g.sqrt(minus_one)];
    assert!([power, logarithm, no_number].iter().all(|&id| matches!(g.node(id), Node::Op(_))));
}

fn panics(what: impl FnOnce() + std::panic::UnwindSafe) -> String {
    let error = std::panic::catch_unwind(what).expect_err("it is refused");
    error
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| error.downcast_ref::<&str>().map(|text| (*text).to_owned()))
        .unwrap_or_default()
}

#[test]
fn wrong_kinds_are_refused() {
    let refused = |of: fn(&mut Graph, Id, Id) -> Id| {
        panics(move || {
            let mut g = Graph::new();
            let (x, c) = (g.input(0, 0, Kind::Scalar), g.input(1, 0, Kind::Signal));
            of(&mut g, x, c);
        })
    };
    assert_eq!(refused(|g, _, c| g.sqrt(c)), "there is no square root of a signal");
    assert_eq!(refused(|g, x, c| g.max(x, c)), "there is no maximum of a signal");
    assert_eq!(refused(|g, x, c| g.add(x, c)), "there is no sum of a scalar and a signal");
    assert_eq!(
        refused(|g, x, c| {
            let d = g.neg(c);
            g.select_less(c, x, c, d)
        }),
        "there is no selection of a signal"
    );
    assert_eq!(
        refused(|g, x, c| {
            let y = g.abs(x);
            g.select_less(x, c, x, y)
        }),
        "there is no selection of a signal"
    );
    assert_eq!(
        refused(|g, x, c| {
            let y = g.abs(x);
            g.select_less(x, y, x, c)
        }),
        "there is no selection of a scalar and a signal"
    );
    assert_eq!(
        refused(|g, _, c| {
            let d = g.mul(c, c);
            g.add(c, d)
        }),
        "there is no sum of a signal and a product of signals"
    );
    assert_eq!(
        refused(|g, _, c| {
            let d = g.mul(c, c);
            g.mul(c, d)
        }),
        "there is no product of a product of signals and a signal"
    );
    let mixed = panics(|| {
        let mut builder = Builder::new();
        let c = builder.param("c", Shape::Array(2), Domain::Signal, "numbers");
        let square = builder.graph.mul(c[0], c[0]);
        builder.finish(vec![square, c[1]], Shape::Array(2), "both");
    });
    assert_eq!(mixed, "a result is linear in a signal, or in each of two");
}

#[test]
fn wrong_kinds_in_loops_are_refused() {
    let refused = |body: Vec<Stmt>, array: Kind| {
        let mut kernel: LoopKernel = (PRODUCT.looped.expect("it has a loop").kernel)(2);
        kernel.body = [vec![Stmt::Array("r", 4, array)], body].concat();
        panics(move || drop(Listing::from(&kernel)))
    };
    let (a, b) = (|| Num::item("a", 0), || Num::item("b", 0));
    let one = || Num::from(Exact::one());
    let store = |value: Num| vec![Stmt::store("r", 0, value)];
    assert!(refused(store(one() * a()), Kind::Signal).starts_with("a signal is the second factor"));
    assert!(
        refused(store(a() * b() + a()), Kind::Product)
            .starts_with("there is no multiply-add of a product of signals and a signal")
    );
    assert!(refused(store(a() * b()), Kind::Signal).contains("`r` holds one kind"));
    let names = vec![Stmt::Var("s", a()), Stmt::Set("s", a() * b())];
    assert!(refused(names, Kind::Product).contains("`s` has one kind"));
}

/// Other inputs than those that the promise was made from.
#[test]
fn what_is_promised_holds() {
    for function in TOYS.iter().filter(|function| !function.spec.rgb) {
        for contraction in [Contraction::Separate, Contraction::Fused] {
            let error = rounding::<f32>(&function.spec, &function.built.code, 4711, 2000, contraction);
            let promised = function.built.accuracy.rounding_f32;
            assert!(error > 0.0 && error <= promised, "{}: {error:e} above {promised:e}", function.spec);
        }
    }
}

#[test]
fn nothing_is_proven_of_them() {
    for function in TOYS.iter() {
        assert_eq!(bound::of(&function.spec, &function.built.code), None, "{}", function.spec);
    }
    // A root alone is enough: the rest of this kernel is proven.
    let proven = |root: bool| {
        let mut builder = Builder::new();
        let dir = builder.param("dir", Shape::Vec3, Domain::Direction, "a direction");
        let g = &mut builder.graph;
        let square = g.mul(dir[0], dir[0]);
        let last = if root { g.sqrt(square) } else { square };
        let kernel = builder.finish(vec![square, last], Shape::Array(2), "numbers");
        bound::of(&spec("basis:2"), &Code::Straight(Listing::new(&kernel))).is_some()
    };
    assert_eq!((proven(false), proven(true)), (true, false));
}

#[test]
fn they_work_in_f16() {
    for function in TOYS.iter().filter(|function| function.spec.takes_half()) {
        let spec = Spec { half: true, ..function.spec.clone() };
        let functions = build(std::slice::from_ref(&spec));
        let accuracy = functions[0].built.accuracy.clone();
        let module = Module { name: spec.name(), functions, ..Module::default() };
        let text = file(&module, &WGSL, "").unwrap_or_else(|error| panic!("{error}")).text;
        assert!(text.contains("\nenable f16;\n") && text.contains("Error: f16 rounding at most"), "{spec}:\n{text}");
        assert!(!accuracy.proven, "{spec}");
        if spec.family == &CHOICES {
            // Inputs are rounded to f16 too, so that a comparison may come out the other way: the promise says so.
            assert!(accuracy.measured_f32 > 0.1 && accuracy.rounding_f32 >= accuracy.measured_f32, "{accuracy:?}");
            continue;
        }
        // f16's unit roundoff is 8192 times f32's, and inputs are rounded to it besides.
        let ratio = accuracy.measured_f32 / function.built.accuracy.measured_f32;
        assert!((1000.0..80_000.0).contains(&ratio), "{spec}: {ratio}");
        let refused = file(&module, &GLSL, "").expect_err("GLSL has no f16").to_string();
        assert!(refused.contains("only WGSL has f16"), "{refused}");
    }
}
