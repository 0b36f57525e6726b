//! The loop forms: equal to the unrolled kernels and to the goldens, stable at high orders, and printed so that the text
//! does bit for bit what the interpreter does, for the operations that it counts.

use serde_json::Value as Json;
use std::path::Path;
use std::process::Command;
use zonal_codegen::builder::Builder;
use zonal_codegen::emit::dialect::Dialect;
use zonal_codegen::emit::language::shader::MAX_TABLE;
use zonal_codegen::emit::language::{GLSL, RUST, Target, WGSL};
use zonal_codegen::emit::loop_body::{print, too_long};
use zonal_codegen::families::SmallAngle;
use zonal_codegen::families::Spec;
use zonal_codegen::families::about_y::about_y;
use zonal_codegen::families::basis::BASIS;
use zonal_codegen::families::loops::{basis_loop, rotate_loop, taylor15_loop};
use zonal_codegen::families::zyz::ZYZ;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::{Kernel, Shape};
use zonal_codegen::ir::listing::{Cost, Listing};
use zonal_codegen::ir::op::Op;
use zonal_codegen::ir::program::{Int, LoopKernel, Num, Stmt, Table};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::samples::Random;
use zonal_tests::shader::{Counts, Fma, Language, Shader, Value};
use zonal_tests::{band_error, golden, norm, numbers, repository};

type Loop = fn(usize) -> LoopKernel;
const LOOPS: [(&str, Loop); 3] = [("taylor15", taylor15_loop), ("basis", basis_loop), ("rotate", rotate_loop)];

/// How far f32 may be off, relative to a band's norm.
const F32: f64 = 3e-6;

fn unrolled(name: &str, order: usize) -> Kernel {
    match name {
        "taylor15" => about_y(order, &vec![SmallAngle::Taylor15; order - 1]),
        "basis" => Spec::new(&BASIS, order).kernel(),
        _ => Spec::new(&ZYZ, order).kernel(),
    }
}

fn noise(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| f64::from(random.signed() as f32)).collect()
}

fn unit(x: Vec<f64>) -> Vec<f64> {
    let norm = norm(&x);
    x.iter().map(|x| x / norm).collect()
}

/// The numbers that f32 holds, so that their rounding is no error of a kernel.
fn narrowed(x: Vec<f64>) -> Vec<f64> {
    x.into_iter().map(|x| f64::from(x as f32)).collect()
}

/// Arguments for a kernel: unit vectors, a small angle, any signal.
fn arguments(kernel: &LoopKernel, random: &mut Random) -> Vec<Vec<f64>> {
    let shapes = kernel.params.iter().map(|param| param.shape);
    let arguments = shapes.map(|shape| match shape {
        Shape::Scalar => vec![random.signed() * 0.4],
        Shape::Vec3 | Shape::Vec4 => unit(noise(random, shape.len())),
        _ => noise(random, shape.len()),
    });
    arguments.collect()
}

fn rounded<T: Number>(inputs: &[Vec<f64>]) -> Vec<Vec<T>> {
    inputs.iter().map(|input| input.iter().map(|&x| T::from_f64(x)).collect()).collect()
}

fn slices<T>(inputs: &[Vec<T>]) -> Vec<&[T]> {
    inputs.iter().map(Vec::as_slice).collect()
}

fn run<T: Number>(program: &Program<T>, inputs: &[Vec<f64>]) -> Vec<f64> {
    let out = program.run(&slices(&rounded::<T>(inputs)), Contraction::Separate);
    out.into_iter().map(T::to_f64).collect()
}

#[track_caller]
fn assert_bands(got: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(got.len(), expected.len(), "{what}");
    let error = band_error(got, expected);
    assert!(error <= tolerance, "{what}: {error:e}");
}

fn cases(name: &str) -> Vec<Json> {
    golden(name)["cases"].as_array().expect("a golden file has cases").clone()
}

#[test]
fn loops_equal_the_unrolled_kernels() {
    for (name, make) in LOOPS {
        for order in 2..=10 {
            let kernel = make(order);
            let listing = Listing::new(&unrolled(name, order));
            assert_eq!(kernel.params, listing.params, "{name} {order}");
            assert_eq!((kernel.result, kernel.result_kind), (listing.result, listing.result_kind));
            let (narrow, wide) =
                (Program::<f32>::new(&Listing::from(&kernel)), Program::<f64>::new(&Listing::from(&kernel)));
            let straight = Program::<f64>::new(&listing);
            let mut random = Random::new(order as u64);
            for _ in 0..20 {
                let inputs = arguments(&kernel, &mut random);
                let expected = straight.run(&slices(&inputs), Contraction::Separate);
                let what = format!("{name} {order}");
                assert_bands(&run(&wide, &inputs), &expected, 1e-13, &what);
                assert_bands(&run(&narrow, &inputs), &expected, F32, &what);
                let fused = wide.run(&slices(&inputs), Contraction::Fused);
                assert_bands(&fused, &expected, 1e-13, &what);
            }
        }
    }
}

#[test]
fn the_basis_is_the_golden_one() {
    for order in [2, 5, 20] {
        let kernel = basis_loop(order);
        let (narrow, wide) =
            (Program::<f32>::new(&Listing::from(&kernel)), Program::<f64>::new(&Listing::from(&kernel)));
        for case in cases("basis") {
            let expected = &numbers(&case["y"])[..order * order];
            let inputs = [numbers(&case["unit"])];
            let what = format!("order {order}, {}", case["name"]);
            assert_bands(&run(&wide, &inputs), expected, 1e-14 * order as f64, &what);
            assert_bands(&run(&narrow, &inputs), expected, F32, &what);
        }
    }
}

#[test]
fn rotations_are_the_golden_ones() {
    for order in [2, 6, 12] {
        let kernel = rotate_loop(order);
        let (narrow, wide) =
            (Program::<f32>::new(&Listing::from(&kernel)), Program::<f64>::new(&Listing::from(&kernel)));
        let c = noise(&mut Random::new(3), order * order);
        for case in cases("rotations") {
            let [w, x, y, z] = unit(numbers(&case["quat_wxyz"])).try_into().expect("four numbers");
            let mut expected = Vec::new();
            for (l, matrix) in case["D"].as_array().expect("matrices").iter().take(order).enumerate() {
                for row in matrix.as_array().expect("rows") {
                    let row = numbers(row);
                    expected.push(row.iter().zip(&c[l * l..]).map(|(d, c)| d * c).sum::<f64>());
                }
            }
            let inputs = [vec![x, y, z, w], c.clone()];
            let what = format!("order {order}, {}", case["name"]);
            assert_bands(&run(&wide, &inputs), &expected, 1e-13, &what);
            assert_bands(&run(&narrow, &inputs), &expected, F32, &what);
        }
    }
}

/// Directions at the poles, close to them and elsewhere.
fn directions() -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for z in [1.0, -1.0] {
        for off in [0.0, 1e-8, 1e-4, 0.01, 0.7] {
            all.push(unit(vec![0.6 * off, -0.8 * off, z]));
        }
    }
    all.extend([vec![1.0, 0.0, 0.0], vec![0.0, -1.0, 0.0]]);
    all
}

/// Σ_m y_lm² = (2l + 1) / 4π: neither a NaN nor an overflow, and no lost value, passes that.
#[track_caller]
fn assert_norms(values: &[f64], tolerance: f64, what: &str) {
    for l in 0..values.len().isqrt() {
        let sum: f64 = values[l * l..(l + 1) * (l + 1)].iter().map(|y| y * y).sum();
        let expected = (2 * l + 1) as f64 / (4.0 * std::f64::consts::PI);
        assert!((sum / expected - 1.0).abs() <= tolerance, "{what}, band {l}: {:e}", sum / expected - 1.0);
    }
}

#[test]
fn the_basis_is_stable_at_high_orders() {
    let kernel = basis_loop(64);
    let (narrow, wide) = (Program::<f32>::new(&Listing::from(&kernel)), Program::<f64>::new(&Listing::from(&kernel)));
    for dir in directions().into_iter().map(narrowed) {
        let reference = run(&wide, std::slice::from_ref(&dir));
        assert_bands(&run(&narrow, std::slice::from_ref(&dir)), &reference, 3e-5, &format!("{dir:?}"));
    }
    let wide = Program::<f64>::new(&Listing::from(&basis_loop(128)));
    for dir in directions() {
        assert_norms(&run(&wide, std::slice::from_ref(&dir)), 1e-11, &format!("{dir:?}"));
    }
}

#[test]
fn the_rotation_is_stable_at_order_64() {
    let kernel = rotate_loop(64);
    let (narrow, wide) = (Program::<f32>::new(&Listing::from(&kernel)), Program::<f64>::new(&Listing::from(&kernel)));
    let c = noise(&mut Random::new(5), 64 * 64);
    // The identity's middle rotation is none: J J = 1.
    let identity = vec![0.0, 0.0, 0.0, 1.0];
    assert_bands(&run(&wide, &[identity.clone(), c.clone()]), &c, 1e-13, "identity");
    assert_bands(&run(&narrow, &[identity, c.clone()]), &c, F32, "identity");
    let q = unit(vec![0.3, -0.5, 0.2, 0.8]);
    let back = vec![-q[0], -q[1], -q[2], q[3]];
    let turned = run(&wide, &[q.clone(), c.clone()]);
    assert_bands(&run(&wide, &[back, turned.clone()]), &c, 1e-13, "there and back");
    // An angle that f32 rounds by u is off by 63 u at the last degree.
    assert_bands(&run(&narrow, &[q, c]), &turned, 64.0 * 6e-8 * 4.0, "f32");
}

#[test]
fn a_rotated_direction_has_the_rotated_basis() {
    let order = 40;
    let basis = Program::<f64>::new(&Listing::from(&basis_loop(order)));
    let rotation = Program::<f64>::new(&Listing::from(&rotate_loop(order)));
    let [x, y, z, w]: [f64; 4] = unit(vec![0.1, 0.7, -0.4, 0.3]).try_into().expect("four numbers");
    let d: [f64; 3] = unit(vec![0.2, -0.5, 0.6]).try_into().expect("three numbers");
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let t = cross([x, y, z], d).map(|t| 2.0 * t);
    let u = cross([x, y, z], t);
    let turned = (0..3).map(|i| d[i] + w * t[i] + u[i]).collect();
    let expected = run(&basis, &[turned]);
    let got = run(&rotation, &[vec![x, y, z, w], run(&basis, &[d.to_vec()])]);
    assert_bands(&got, &expected, 1e-13, "order 40");
}

#[test]
fn tables_have_the_size_they_promise() {
    for order in [2, 3, 10, 36, 37] {
        let lengths = |kernel: &LoopKernel| -> Vec<usize> { kernel.tables.iter().map(|t| t.values.len()).collect() };
        assert_eq!(lengths(&taylor15_loop(order)), [order * order; 2]);
        let pairs = order * (order - 1) / 2;
        assert_eq!(lengths(&basis_loop(order)), [pairs, pairs, order - 1]);
        let kernel = rotate_loop(order);
        assert_eq!(lengths(&kernel), [order * (order * order + 2) / 3 - 1]);
        let refused = too_long(&kernel, &WGSL).map(|table| table.name);
        assert_eq!(refused, (order > 36).then_some("J"), "up to {MAX_TABLE} entries");
    }
}

/// Rust's tables are f64 alone: the nearest f64 has to round to the nearest f32.
#[test]
fn no_table_is_rounded_twice() {
    for (name, make) in LOOPS {
        for value in make(24).tables.iter().flat_map(|table| &table.values) {
            assert_eq!(value.to_f64() as f32, value.to_f32(), "{name}");
        }
    }
}

#[test]
fn costs_are_the_written_ones() {
    let cost = |kernel: &LoopKernel, channels| {
        let Cost { mul, add, fma, special, .. } = Listing::from(kernel).cost(channels);
        [mul, add, fma, special]
    };
    // A middle element: 2 mul and 3 fma (one of them on scalars); the first is free, the last has one fma less.
    assert_eq!(cost(&taylor15_loop(5), 1), [2 + 2 * 23 + 2, 0, 3 * 23 + 2, 0]);
    assert_eq!(cost(&taylor15_loop(5), 3), [2 + 3 * (2 * 23 + 2), 0, 24 + 3 * (2 * 23 + 1), 0]);
    for order in 2..=10 {
        let straight = Listing::new(&unrolled("rotate", order)).cost(1).total;
        let looped = Listing::from(&rotate_loop(order)).cost(1);
        assert_eq!(looped.special, 1);
        assert!(looped.total >= straight, "order {order}: {looped:?} against {straight}");
    }
}

/// A kernel's text as a whole file.
fn text(kernel: &LoopKernel, dialect: Dialect, name: &str) -> String {
    let body = print(kernel, dialect, &name.to_uppercase());
    let params: Vec<String> = kernel.params.iter().map(|param| dialect.parameter(param)).collect();
    let params = params.join(", ");
    let result = dialect.type_of(kernel.result, kernel.result_kind).text;
    let head = match dialect.language.name {
        "wgsl" => format!("fn {name}({params}) -> {result} {{"),
        // What the template begins a file with, where it is no GLSL ES.
        "glsl" => format!("#define ZONAL_HIGHP\n{result} {name}({params}) {{"),
        _ => format!("pub fn {name}<T: Real, V: Signal<T>>({params}) -> {result} {{"),
    };
    let lines: Vec<String> = body.lines.iter().map(|line| format!("    {line}")).collect();
    let tail = match dialect.language.statements.tail {
        true => body.result,
        false => format!("return {};", body.result),
    };
    let (define, head) = head.rsplit_once('\n').unwrap_or(("", &head));
    format!("{define}\n{}\n{head}\n{}\n    {tail}\n}}\n", body.tables.join("\n"), lines.join("\n"))
}

fn argument(shape: Shape, kind: Kind, channels: &[Vec<f32>]) -> Value {
    let one = |i: usize| match (kind, channels.len()) {
        (Kind::Signal | Kind::Product, 3) => Value::Vec(channels.iter().map(|channel| channel[i]).collect()),
        _ => Value::F32(channels[0][i]),
    };
    match shape {
        Shape::Scalar => one(0),
        Shape::Array(n) => Value::Array((0..n).map(one).collect()),
        _ => Value::Vec(channels[0].clone()),
    }
}

/// Runs a kernel's text and the interpreter on the same numbers.
fn compare(name: &str, kernel: &LoopKernel, target: Target, rgb: bool) {
    let dialect = Dialect { rgb, ..Dialect::new(target) };
    let text = text(kernel, dialect, "kernel");
    let language = if target == &WGSL { Language::Wgsl } else { Language::Glsl };
    let shader = Shader::parse(language, &text).unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
    let program = Program::<f32>::new(&Listing::from(kernel));
    let channels = if rgb { 3 } else { 1 };
    let mut random = Random::new(1);
    for _ in 0..3 {
        // Channels share all but the signal.
        let mut inputs = vec![rounded::<f32>(&arguments(kernel, &mut random)); channels];
        for inputs in &mut inputs {
            for (input, param) in inputs.iter_mut().zip(&kernel.params) {
                if !param.kind.is_scalar() {
                    input.fill_with(|| random.signed() as f32);
                }
            }
        }
        let arguments: Vec<Value> = (0..kernel.params.len())
            .map(|i| {
                let channels: Vec<Vec<f32>> = inputs.iter().map(|inputs| inputs[i].clone()).collect();
                argument(kernel.params[i].shape, kernel.params[i].kind, &channels)
            })
            .collect();
        let results: Vec<Vec<f32>> =
            inputs.iter().map(|inputs| program.run(&slices(inputs), Contraction::Separate)).collect();
        let mut counts = Counts::default();
        let got = shader
            .call("kernel", &arguments, &mut counts, Fma::Separate)
            .unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
        assert_eq!(got, argument(kernel.result, kernel.result_kind, &results), "{name} {dialect:?}");
        let cost = Listing::from(kernel).cost(channels);
        let expected = Counts {
            mul: (cost.mul + cost.fma) as u64,
            add: (cost.add + cost.fma) as u64,
            fma: 0,
            choice: cost.choice as u64,
            special: cost.special as u64,
        };
        assert_eq!(counts, expected, "{name} {dialect:?}");
    }
}

#[test]
fn shader_text_does_what_the_interpreter_does() {
    for (name, make) in LOOPS {
        for order in [2, 3, 5, 10] {
            let kernel = make(order);
            for target in [&WGSL, &GLSL] {
                compare(name, &kernel, target, false);
                if !kernel.result_kind.is_scalar() {
                    compare(name, &kernel, target, true);
                }
            }
        }
    }
}

/// A kernel of no meaning that does everything the language can.
#[test]
fn every_operation_is_printed_as_it_is_run() {
    let [x, y] = ["x", "y"].map(|name| || Num::Name(name));
    let i = Int::Name("i");
    let index = (&i * 7 + 3 - &i / (&i + 1)) % 4;
    let body = vec![
        Stmt::Array("r", 4, Kind::Scalar),
        Stmt::Let("x", Num::item("v", 0) - Num::item("T", 1) * Num::item("v", 1)),
        Stmt::Var("y", Num::item("T", 0) * (x() - Num::item("v", 2)) - x()),
        Stmt::Counter("k", Int::Literal(5) - 3 - 2),
        Stmt::For {
            name: "i",
            from: Int::Literal(0),
            to: Int::Literal(8),
            step: 2,
            body: vec![
                Stmt::Int("at", index),
                Stmt::Set("y", -(y() - (x() - (y() + Num::Tiny))) * (-(x() * x()) + y())),
                Stmt::Set("y", y() + Num::of(Op::Recip(y() * y() + Exact::one()))),
                Stmt::store("r", "k", -(x() * Exact::int(-2)) * (y() * y() + Exact::one()).rsqrt()),
                Stmt::Set("y", y() * (Num::item("r", "k") * Num::item("T", "at")) + Exact::int(-1)),
                Stmt::Advance("k"),
            ],
        },
    ];
    let values = [1, -3, 5, 7].map(|p| Exact::ratio(p, 3)).to_vec();
    let mut kernel = basis_loop(2);
    kernel.params[0].name = "v";
    kernel.tables = vec![Table { name: "T", values, doc: "one line\nand another".to_owned() }];
    kernel.body = body;
    for target in [&WGSL, &GLSL] {
        compare("everything", &kernel, target, false);
    }
}

#[test]
fn taylor15_reads_the_same_in_every_language() {
    let kernel = taylor15_loop(2);
    let body = |target| print(&kernel, Dialect { rgb: true, ..Dialect::new(target) }, "SH_TAYLOR");
    let wgsl = [
        "var r: array<vec3<f32>, 4>;",
        "let half_square = 0.5 * beta * beta;",
        "r[0] = c[0];",
        "for (var i = 1; i < 3; i += 1) {",
        "    r[i] = c[i] * (1.0 + half_square * SH_TAYLOR_DDY_DIAG[i]) \
         + (c[i - 1] * SH_TAYLOR_DY_SUB_DIAG[i] - c[i + 1] * SH_TAYLOR_DY_SUB_DIAG[i + 1]) * beta;",
        "}",
        "r[3] = c[3] * (1.0 + half_square * SH_TAYLOR_DDY_DIAG[3]) + c[2] * SH_TAYLOR_DY_SUB_DIAG[3] * beta;",
    ];
    assert_eq!(body(&WGSL).lines, wgsl);
    let glsl = wgsl.map(|line| {
        line.replace("var r: array<vec3<f32>, 4>", "vec3 r[4]")
            .replace("let half", "float half")
            .replace("var i", "int i")
    });
    assert_eq!(body(&GLSL).lines, glsl);
    let rust = [
        "let mut r = [V::zero(); 4];",
        "let half_square = T::lit(0.5) * beta * beta;",
        "r[0] = c[0];",
        "for i in 1..3 {",
        "    r[i] = c[i + 1].fnma(T::lit(SH_TAYLOR_DY_SUB_DIAG[i + 1]), c[i - 1] * T::lit(SH_TAYLOR_DY_SUB_DIAG[i]))\
         .fma(beta, c[i] * half_square.fma(T::lit(SH_TAYLOR_DDY_DIAG[i]), T::lit(1.0)));",
        "}",
        "r[3] = (c[2] * T::lit(SH_TAYLOR_DY_SUB_DIAG[3]))\
         .fma(beta, c[3] * half_square.fma(T::lit(SH_TAYLOR_DDY_DIAG[3]), T::lit(1.0)));",
    ];
    assert_eq!(body(&RUST).lines, rust);
    assert_eq!(
        body(&RUST).tables[0],
        "// dD/dbeta at 0, from m - 1 to m\n#[allow(clippy::approx_constant)]\n\
         static SH_TAYLOR_DY_SUB_DIAG: [f64; 4] = [\n    0.0, 0.0, 0.0, -1.0\n];"
    );
    assert_eq!(
        body(&WGSL).tables[1],
        "// the diagonal of the second derivative of D at 0\n\
         const SH_TAYLOR_DDY_DIAG = array<f32, 4>(\n    0.0, 0.0, -1.0, -1.0\n);"
    );
}

/// In Rust a rotation may have its angles in f64 and its bands in f32. It then keeps 5e-7 of a band's norm to order 64,
/// which f32 alone does not: an error of an angle counts l times.
#[test]
fn a_tall_rotation_is_exact_where_its_angles_are() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tall");
    Builder::new("tall").spec("rotate:64:loop").target(&RUST).write(&folder).expect("is written");
    let program = folder.join("program");
    let rustc = Command::new("rustc")
        .args(["--edition=2024", "-Copt-level=1", "-o"])
        .args([&program, &repository("tests/fixture/tall.rs")])
        .env("TALL", folder.join("tall.rs"))
        .output()
        .expect("rustc runs");
    assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
    let output = Command::new(&program).output().expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    let errors: Vec<f64> = text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    println!("angles in f64, in f32: {errors:?}");
    assert!(errors[0] <= 5e-7 && errors[1] > 2.0 * errors[0], "{errors:?}");
}

#[test]
fn what_has_no_loop_form_is_refused() {
    for text in ["eval:3:loop", "eval:20:loop", "shade:5:loop", "product:3:loop", "light_sphere:4:rgb:loop"] {
        let error = text.parse::<Spec>().expect_err("it has no loop form");
        assert!(error.to_string().contains("no loop form"), "{text}: {error}");
    }
}
