//! The toys as text: they pass every language's check, read as a person would write them, and give in WGSL, in GLSL and in
//! Rust what the interpreter gives, to the last bit and for the operations that it counts.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use zonal_codegen::emit::language::{self, GLSL, RUST, WGSL};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::generate::{build, file};
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::promise::samples::{self, Random};
use zonal_tests::repository;
use zonal_tests::shader::Language;
use zonal_tests::toys::{self, CHOICES};

pub(crate) static TOYS: LazyLock<Vec<Function>> = LazyLock::new(|| build(&toys::specs()));

pub(crate) fn toy(name: &str) -> &'static Function {
    TOYS.iter().find(|function| function.shader_name() == name).unwrap_or_else(|| panic!("no toy is called {name}"))
}

/// Zeros of both signs, numbers that overflow or vanish where they are multiplied, and what is no number.
const EXTREMES: [f32; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    -0.7,
    1e-42,
    -1e-42,
    f32::MIN_POSITIVE,
    3e38,
    -3e38,
    1e20,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

/// Seeded inputs of a function, and extremes in each place: two in three inputs take all numbers from them.
fn inputs(function: &Function) -> Vec<Vec<Vec<f64>>> {
    let mut all = samples::inputs(function.built.code.params(), 5, 300, None);
    let mut random = Random::new(77);
    for (i, input) in all.iter_mut().enumerate().skip(30) {
        for number in input.iter_mut().flatten() {
            if i % 3 != 0 {
                *number = f64::from(EXTREMES[random.bits() as usize % EXTREMES.len()]);
            }
        }
    }
    all
}

#[test]
fn every_toy_passes_every_languages_check_and_says_that_it_is_measured() {
    assert_eq!(TOYS.len(), 12);
    for function in TOYS.iter() {
        let name = function.shader_name();
        let accuracy = &function.built.accuracy;
        assert!(!accuracy.proven && accuracy.measured_f32 > 0.0, "{name}: {accuracy:?}");
        for target in language::ALL {
            let text = file(&Module::of(function.clone()), target, "");
            let text = text.unwrap_or_else(|error| panic!("{error}")).text.replace(['\n', '/'], " ");
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            let measured = format!("3 times the worst of 256 measured, {:e}; not proven)", accuracy.measured_f32);
            assert!(text.contains(&measured), "{name} in {target}: {text}");
            let relative = match function.spec.family == &CHOICES {
                true => "of the norm of a band, for dir of unit length",
                false => "of the product of both factors' norms, for every input",
            };
            assert!(text.contains(relative), "{name} in {target}: {text}");
        }
    }
    let head =
        |name: &str| module_text(name, &WGSL).lines().find(|line| line.contains("Operations:")).map(str::to_owned);
    let words = ", 7 min, max or select) and 3 special (square root, power of two,";
    let choices = head("sh3_choices").expect("a head says what it costs");
    assert!(choices.contains(words), "{choices}");
    let product = head("sh2_toy_product").expect("a head says what it costs");
    assert!(!product.contains("select") && !product.contains("special"), "{product}");
}

fn module_text(name: &str, target: language::Target) -> String {
    Module::of(toy(name).clone()).text(target).unwrap_or_else(|limit| panic!("{limit}"))
}

#[test]
fn shader_texts_compute_and_cost_what_the_interpreter_does() {
    for function in TOYS.iter() {
        for (target, language) in [(&WGSL, Language::Wgsl), (&GLSL, Language::Glsl)] {
            crate::shaders::check(function, target, language);
            crate::shaders::check_on(function, target, language, &inputs(function));
        }
    }
}

/// What the interpreter gives for one channel or three, the channels of a number side by side, as the fixture has it.
fn run<T: Number>(function: &Function, input: &[&Vec<Vec<f64>>]) -> (Vec<T>, Vec<T>) {
    let (params, runner) = (function.built.code.params(), function.built.code.runner::<T>());
    let narrowed = |list: &Vec<f64>| list.iter().map(|&x| T::from_f64(x)).collect::<Vec<T>>();
    let channel = |channel: &Vec<Vec<f64>>| -> Vec<Vec<T>> {
        let of = |i: usize| narrowed(if params[i].kind.is_scalar() { &input[0][i] } else { &channel[i] });
        (0..params.len()).map(of).collect()
    };
    let channels: Vec<Vec<Vec<T>>> = input.iter().copied().map(channel).collect();
    let interleaved = |lists: &[&Vec<T>]| -> Vec<T> {
        (0..lists[0].len()).flat_map(|i| lists.iter().map(move |list| list[i])).collect()
    };
    let given = params.iter().enumerate().flat_map(|(i, param)| {
        let lists: Vec<&Vec<T>> =
            channels[..param.kind.numbers(input.len())].iter().map(|channel| &channel[i]).collect();
        interleaved(&lists)
    });
    let given = given.collect();
    let results: Vec<Vec<T>> = channels
        .iter()
        .map(|channel| runner.run(&channel.iter().map(Vec::as_slice).collect::<Vec<_>>(), Contraction::Separate))
        .collect();
    (given, interleaved(&results.iter().collect::<Vec<_>>()))
}

/// Bits of which those of what is no number are one.
trait Bits: Number {
    fn text(self) -> String;
}

impl Bits for f32 {
    fn text(self) -> String {
        format!("{:08x}", if self.is_nan() { Self::NAN.to_bits() } else { self.to_bits() })
    }
}

impl Bits for f64 {
    fn text(self) -> String {
        format!("{:016x}", if self.is_nan() { Self::NAN.to_bits() } else { self.to_bits() })
    }
}

fn line<T: Bits>(numbers: &[T]) -> String {
    numbers.iter().map(|&x| x.text()).collect::<Vec<_>>().join(" ")
}

#[test]
fn rust_computes_what_the_interpreter_does() {
    let module = Module { name: "toys".to_owned(), functions: TOYS.clone(), ..Module::default() };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("operations");
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    let (text, program) = (folder.join("toys.rs"), folder.join("program"));
    std::fs::write(&text, file(&module, &RUST, "").expect("the toys are Rust").text).expect("is written");
    let rustc = Command::new("rustc")
        .args(["--edition=2024", "-Copt-level=1", "-o"])
        .args([&program, &repository("tests/fixture/operations.rs")])
        .env("TOYS", &text)
        .output()
        .expect("rustc runs");
    assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
    let (mut calls, mut wanted) = (String::new(), Vec::new());
    for function in TOYS.iter() {
        let (name, all) = (function.shader_name(), inputs(function));
        for i in 0..all.len() - 2 {
            let input: Vec<&Vec<Vec<f64>>> = all[i..i + function.spec.channels()].iter().collect();
            let (given, want) = run::<f32>(function, &input);
            calls += &format!("{name} {}\n", line(&given));
            wanted.push(line(&want));
        }
        for i in 0..40 {
            let input: Vec<&Vec<Vec<f64>>> = all[i..i + function.spec.channels()].iter().collect();
            let (given, want) = run::<f64>(function, &input);
            calls += &format!("{name} {}\n", line(&given));
            wanted.push(line(&want));
        }
    }
    let mut process = Command::new(&program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    process.stdin.take().expect("is piped").write_all(calls.as_bytes()).expect("the program reads before it writes");
    let output = process.wait_with_output().expect("the program ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(text.lines().count(), wanted.len());
    for ((got, want), call) in text.lines().zip(&wanted).zip(calls.lines()) {
        let got: Vec<String> = got
            .split(' ')
            .map(|word| match word.len() {
                8 => f32::from_bits(u32::from_str_radix(word, 16).expect("a number")).text(),
                _ => f64::from_bits(u64::from_str_radix(word, 16).expect("a number")).text(),
            })
            .collect();
        assert_eq!(got.join(" "), *want, "{call}");
    }
}

/// A kernel of a choice of each kind and a product of each sign, as a reader sees it.
#[test]
fn they_read_as_a_person_would_write_them() {
    let body = |name: &str, target: language::Target| -> String {
        let text = module_text(name, target);
        let start =
            if target == &RUST { format!("pub fn {}<", toy(name).spec.base().stem()) } else { format!("{name}(") };
        let lines = text[text.find(&start).expect("its name")..].lines().skip(1);
        // How exact GLSL ES is stands first in every body.
        let lines = lines.filter(|line| !line.starts_with('#') && !line.trim().starts_with("precision"));
        lines.map(str::trim).take_while(|line| *line != "}").collect::<Vec<_>>().join("\n")
    };
    for (target, want) in [(&WGSL, CHOICES_IN_WGSL), (&GLSL, CHOICES_IN_GLSL), (&RUST, CHOICES_IN_RUST)] {
        assert_eq!(body("sh3_choices_rgb", target), want.trim(), "{target}");
    }
    for (target, want) in [(&WGSL, CROSS_IN_WGSL), (&RUST, CROSS_IN_RUST)] {
        assert_eq!(body("sh2_cross_rgb", target), want.trim(), "{target}");
    }
}

const CHOICES_IN_WGSL: &str = "
return array<vec3<f32>, 9>(
c[0] * sqrt(dir.z + 1.0),
select(c[2], c[1], dir.x < dir.y),
select(-c[2], c[3], 0.0 < dir.z),
c[3] * min(max(3.0 * dir.x, -0.5), 0.5),
c[4] * exp2(dir.y),
c[5] * log2(1.5 + 0.5 * dir.z),
c[6] * min(-dir.x, dir.y),
c[7] * abs(dir.x - dir.z),
c[8] * (select(dir.x, dir.y, abs(dir.x) < abs(dir.y)) + max(dir.x, dir.z))
);
";
const CHOICES_IN_GLSL: &str = "
return vec3[9](
c[0] * sqrt(dir.z + 1.0),
mix(c[2], c[1], bvec3(dir.x < dir.y)),
mix(-c[2], c[3], bvec3(0.0 < dir.z)),
c[3] * min(max(3.0 * dir.x, -0.5), 0.5),
c[4] * exp2(dir.y),
c[5] * log2(1.5 + 0.5 * dir.z),
c[6] * min(-dir.x, dir.y),
c[7] * abs(dir.x - dir.z),
c[8] * (mix(dir.x, dir.y, abs(dir.x) < abs(dir.y)) + max(dir.x, dir.z))
);
";
const CHOICES_IN_RUST: &str = "
let t0 = c[8] * (T::choose(T::abs(dir[0]), T::abs(dir[1]), dir[1], dir[0]) + T::max(dir[0], dir[2]));
[
c[0] * T::root(dir[2] + T::lit(1.0)),
V::choose(dir[0], dir[1], c[1], c[2]),
V::choose(T::lit(0.0), dir[2], c[3], -c[2]),
c[3] * T::min(T::max(T::lit(3.0) * dir[0], T::lit(-0.5)), T::lit(0.5)),
c[4] * T::exp2(dir[1]),
c[5] * T::log2(T::lit(0.5).fma(dir[2], T::lit(1.5))),
c[6] * T::min(-dir[0], dir[1]),
c[7] * T::abs(dir[0] - dir[2]),
t0,
]
";
const CROSS_IN_WGSL: &str = "
return array<vec3<f32>, 3>(
a[1] * b[2] - a[2] * b[1] - a[0] * b[0],
a[2] * b[0] - a[0] * b[2] - a[1] * b[1],
a[0] * b[1] - a[1] * b[0] - a[2] * b[2]
);
";
const CROSS_IN_RUST: &str = "
[
a[0].times_fnma(b[0], a[1].times_fms(b[2], a[2].times(b[1]))),
a[1].times_fnma(b[1], a[2].times_fms(b[0], a[0].times(b[2]))),
a[2].times_fnma(b[2], a[0].times_fms(b[1], a[1].times(b[0]))),
]
";
