//! Kernels whose arrays lie in a memory of the user's: their text, with functions around it that read and write a private
//! array, equals the f32 interpreter to the last bit and operation, whole and in pieces, result and signal in one place.

use zonal_codegen::emit::language::{Arrays, GLSL, Target, WGSL};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::families::Spec;
use zonal_codegen::generate;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::promise::samples;
use zonal_tests::shader::{Counts, Fma, Language, Shader, Value};
use zonal_tests::spec;

/// How many inputs each kernel is run on.
const CASES: usize = 6;

/// What is printed, with its pieces.
const SPECS: [&str; 9] = [
    "rotate:5",
    "rotate:4:rgb",
    "rotate:4:angles",
    "rotate:5:lifted",
    "rotate:3:lifted:rgb",
    "zhf:4",
    "tilt:5:rgb",
    "basis:4",
    "product:3:rgb",
];

/// A shader around a function, and where numbers lie in its memory.
struct Around {
    text: String,
    /// What is copied into the memory first: numbers of one channel, then signals, the channels of a number together.
    given: usize,
    result: usize,
}

/// The text of a function, with a `run` that takes the memory's numbers and gives the result's.
fn around(function: &Function, target: Target) -> Around {
    let module = Module { arrays: Some(Arrays::Memory), ..Module::of(function.clone()) };
    let text = generate::file(&module, target, "").unwrap_or_else(|error| panic!("{error}")).text;
    let dialect = function.dialect(target, Some(Arrays::Memory)).expect("it is printed");
    let channels = function.spec.channels();
    let (params, (shape, kind)) = (function.built.code.params(), function.built.code.result());
    let scalars: usize = params.iter().filter(|param| param.kind.is_scalar()).map(|param| param.shape.len()).sum();
    // Places of signals count the numbers of all channels as one.
    let (mut scalar, mut signal) = (0, scalars.div_ceil(channels));
    let mut last = 0;
    let mut arguments = Vec::new();
    for param in params {
        let next = if param.kind.is_scalar() { &mut scalar } else { &mut signal };
        last = *next;
        *next += param.shape.len();
        let numbers: Vec<String> = (last..*next).map(|at| format!("given[{at}]")).collect();
        arguments.push(match dialect.is_place(param.shape) {
            true => last.to_string(),
            false => dialect.argument(param.shape, param.kind, &numbers),
        });
    }
    let given = signal * channels;
    let own = kind.numbers(channels);
    // A result of the signal's shape goes to where the signal is.
    let in_place = params.last().is_some_and(|param| (param.shape, param.kind) == (shape, kind));
    let first = if in_place { last } else { given.next_multiple_of(channels) / own };
    arguments.push(first.to_string());
    let result = shape.len() * own;
    let (all, from) = (given.next_multiple_of(channels) + result, first * own);
    let stored: String = (0..given).map(|at| format!("memory[{at}] = given[{at}];\n")).collect();
    let numbers: Vec<String> = (from..from + result).map(|at| format!("memory[{at}]")).collect();
    let (call, numbers) = (format!("{}({})", function.shader_name(), arguments.join(", ")), numbers.join(", "));
    let text = match target == &WGSL {
        true => format!(
            "{text}\nvar<private> memory: array<f32, {all}>;\n\
             fn zonal_read_f32(place: i32) -> f32 {{ return memory[place]; }}\n\
             fn zonal_write_f32(place: i32, number: f32) {{ memory[place] = number; }}\n\
             fn zonal_read_vec3f32(place: i32) -> vec3<f32> {{\n\
             return vec3<f32>(memory[3 * place], memory[3 * place + 1], memory[3 * place + 2]);\n}}\n\
             fn zonal_write_vec3f32(place: i32, number: vec3<f32>) {{\n\
             memory[3 * place] = number.x; memory[3 * place + 1] = number.y; memory[3 * place + 2] = number.z;\n}}\n\
             fn run(given: array<f32, {given}>) -> array<f32, {result}> {{\n{stored}{call};\n\
             return array<f32, {result}>({numbers});\n}}\n"
        ),
        false => format!(
            "float memory[{all}];\n\
             float zonal_read_float(int place) {{ return memory[place]; }}\n\
             void zonal_write_float(int place, float number) {{ memory[place] = number; }}\n\
             vec3 zonal_read_vec3(int place) {{\n\
             return vec3(memory[3 * place], memory[3 * place + 1], memory[3 * place + 2]);\n}}\n\
             void zonal_write_vec3(int place, vec3 number) {{\n\
             memory[3 * place] = number.x; memory[3 * place + 1] = number.y; memory[3 * place + 2] = number.z;\n}}\n\
             {text}\nfloat[{result}] run(float[{given}] given) {{\n{stored}{call};\n\
             return float[{result}]({numbers});\n}}\n"
        ),
    };
    Around { text, given, result }
}

fn check(function: &Function, target: Target, language: Language) {
    let Around { text, given, result } = around(function, target);
    let (spec, channels) = (&function.spec, function.spec.channels());
    let shader = Shader::parse(language, &text).unwrap_or_else(|error| panic!("{spec} in {target}: {error}\n{text}"));
    let (params, (_, kind)) = (function.built.code.params(), function.built.code.result());
    let inputs = samples::inputs(params, 31, CASES + channels - 1, None);
    for case in 0..inputs.len() + 1 - channels {
        // Channels differ in their signals and share their parameters.
        let of = |channel: usize| -> Vec<Vec<f32>> {
            let place = |scalar: bool| if scalar { case } else { case + channel };
            let list = |(at, param): (usize, &zonal_codegen::ir::kernel::Param)| {
                inputs[place(param.kind.is_scalar())][at].iter().map(|&x| x as f32).collect()
            };
            params.iter().enumerate().map(list).collect()
        };
        let all: Vec<Vec<Vec<f32>>> = (0..channels).map(of).collect();
        let (mut scalars, mut signals) = (Vec::new(), Vec::new());
        for (at, param) in params.iter().enumerate() {
            match param.kind.is_scalar() {
                true => scalars.extend(&all[0][at]),
                false => (0..param.shape.len()).for_each(|i| signals.extend(all.iter().map(|lists| lists[at][i]))),
            }
        }
        scalars.resize(given - signals.len(), 0.0);
        scalars.extend(signals);
        let numbers = Value::Array(scalars.into_iter().map(Value::F32).collect());
        let mut counts = Counts::default();
        let got = shader.call("run", &[numbers], &mut counts, Fma::Separate);
        let Ok(Value::Array(got)) = got else { panic!("{spec} in {target}: {got:?}") };
        let bits =
            |value: &Value| if let Value::F32(x) = value { x.to_bits() } else { panic!("{value:?} is no number") };
        let got: Vec<u32> = got.iter().map(bits).collect();
        let own = kind.numbers(channels);
        let runner = function.built.code.runner::<f32>();
        let want: Vec<Vec<f32>> = all
            .iter()
            .take(own)
            .map(|lists| runner.run(&lists.iter().map(Vec::as_slice).collect::<Vec<_>>(), Contraction::Separate))
            .collect();
        let want: Vec<u32> =
            (0..result / own).flat_map(|i| want.iter().map(move |channel| channel[i].to_bits())).collect();
        assert_eq!(got, want, "{spec} in {target}, case {case}");
        let cost = function.built.code.cost(channels);
        let done = [counts.mul, counts.add, counts.choice, counts.special].map(|count| count as usize);
        assert_eq!(done, [cost.mul + cost.fma, cost.add + cost.fma, cost.choice, cost.special], "{spec} in {target}");
    }
}

#[test]
fn arrays_in_memory_are_read_and_written_in_place() {
    let specs: Vec<Spec> =
        SPECS.map(spec).into_iter().flat_map(|spec| [vec![spec.clone()], spec.in_pieces()].concat()).collect();
    assert!(specs.len() > 2 * SPECS.len(), "with pieces");
    for function in generate::build(&specs) {
        check(&function, &WGSL, Language::Wgsl);
        check(&function, &GLSL, Language::Glsl);
    }
}

/// Pieces hold so little at once only in the order in which their operations are done.
#[test]
fn what_shares_factors_is_done_together() {
    for (text, most) in [("zhf:10", 64), ("rotate:10:lifted", 64), ("rotate:10", 64)] {
        for piece in spec(text).in_pieces() {
            let passing = piece.code().footprint().passing;
            assert!(passing <= most, "{piece}: {passing} numbers besides memory");
        }
    }
}

#[test]
fn a_text_says_what_the_user_writes() {
    let module =
        |text: &str| Module { arrays: Some(Arrays::Memory), ..Module::of(generate::build(&[spec(text)]).remove(0)) };
    let text = |spec: &str, target: Target| {
        generate::file(&module(spec), target, "").unwrap_or_else(|error| panic!("{error}")).text
    };
    let wgsl = text("rotate:3:angles:rgb", &WGSL);
    assert!(wgsl.contains("(cs: i32, c: i32, result: i32) {"), "{wgsl}");
    let said = wgsl.replace("\n//     ", " ").replace("\n// ", " ");
    for words in
        ["`zonal_read_f32(cs + i)`", "`zonal_read_vec3f32(c + i)`", "`zonal_write_vec3f32(result + i, number)`"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    let glsl = text("zhf:3:band=2", &GLSL);
    assert!(
        glsl.contains("void sh3_band_2_zhf(ZONAL_HIGHP int s, ZONAL_HIGHP int c, ZONAL_HIGHP int result)"),
        "{glsl}"
    );
    let error = generate::file(&module("taylor15:3:loop"), &WGSL, "").expect_err("a loop").to_string();
    assert!(error.contains("leave `arrays` out"), "{error}");
    let error = generate::file(&module("rotate:3"), &zonal_codegen::emit::language::RUST, "").expect_err("Rust");
    assert!(error.to_string().contains("does not pass arrays as `memory`"), "{error}");
}
