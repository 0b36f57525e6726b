//! A language that zonal does not know, C99, as one record in this file and nothing elsewhere: its functions return no
//! arrays, its vectors have no operators, and its own compiler checks what is printed. The text is compiled and run, and
//! its results are those of the interpreter to the last bit: unfused as it is, fused where it writes `fmaf`.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use zonal_codegen::builder::Builder;
use zonal_codegen::emit::language::expression::{Binding, Text};
use zonal_codegen::emit::language::record::{Float, ITEMS, MultiplyAdd, Spelling, Statements, Type, Types, Way, Words};
use zonal_codegen::emit::language::{Arrays, Language, Target, shader};
use zonal_codegen::emit::{Constants, Function, Module};
use zonal_codegen::families::{ALL, Form, Spec};
use zonal_codegen::generate::{GenerateError, build, file};
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::ir::op::Op;
use zonal_codegen::promise::samples;
use zonal_tests::command::Folder;
use zonal_tests::toys;

/// How many inputs each kernel is run on; the first are the extremes.
const CASES: usize = 24;

const C: Language = Language {
    name: "c99",
    title: "C",
    extension: "c",
    forms: &[],
    single: Float { name: "float", literal: |value| shader::literal(value) + "f", tiny: "1e-15f" },
    half: None,
    types: Types {
        vector: |_, n| format!("vec{n}"),
        matrix: |_| "mat3".to_owned(),
        array: |of, n| format!("{of}[{n}]"),
    },
    arrays: &[Arrays::Reference, Arrays::Struct],
    structure: |name, of| {
        let guard = name.to_uppercase();
        let length = of.length.unwrap_or(1);
        format!("#ifndef {guard}\n#define {guard}\ntypedef struct {{ {} {ITEMS}[{length}]; }} {name};\n#endif", of.item)
    },
    parameter: |name, of, way| {
        let constant = if way == Way::In { "const " } else { "" };
        match of.length {
            Some(n) => format!("{constant}{} {name}[restrict {n}]", of.item),
            None => format!("{constant}{} {name}", of.text),
        }
    },
    result: |of| of.text.clone(),
    nothing: "void",
    component: shader::component,
    brackets: |of| (format!("({of}){{"), "}"),
    columns: false,
    trailing_comma: false,
    vector_operators: false,
    multiply_add: MultiplyAdd::Infix,
    spelling: |op| match op {
        Op::Recip(_) => Spelling::Own(|x, _| format!("1.0f / ({})", x[0].text), Binding::Product),
        Op::Rsqrt(_) => Spelling::Own(|x, _| format!("1.0f / sqrtf({})", x[0].text), Binding::Product),
        Op::Sqrt(_) => Spelling::Call("sqrtf"),
        Op::Exp2(_) => Spelling::Call("exp2f"),
        Op::Log2(_) => Spelling::Call("log2f"),
        Op::Abs(_) => Spelling::Call("fabsf"),
        // `fminf` and `fmaxf` leave open which of two zeros they give.
        Op::Min(..) => Spelling::Own(|x, _| chosen([1, 0, 1, 0], x), Binding::Atom),
        Op::Max(..) => Spelling::Own(|x, _| chosen([0, 1, 1, 0], x), Binding::Atom),
        Op::Select(..) => Spelling::Own(|x, _| chosen([0, 1, 2, 3], x), Binding::Atom),
        Op::Neg(_) | Op::Add(..) | Op::Sub(..) | Op::Mul(..) | Op::Fma(..) => Spelling::Infix,
    },
    statements: Statements {
        int: "int",
        declare: |of, name, mutable| format!("{}{of} {name}", if mutable { "" } else { "const " }),
        variable,
        each: |name, from, to, step| format!("for (int {name} = {from}; {name} < {to}; {name} += {step}) {{"),
        at_most: shader::at_most,
        tail: false,
    },
    table: |name, of| {
        (format!("static const {} {name}[{}] = {{", of.item, of.length.expect("a table is an array")), "};")
    },
    constant: |name, of| {
        (format!("const {} {name}[{}] = {{", of.item, of.length.expect("coefficients are an array")), "};")
    },
    doc: "//",
    max_statements: usize::MAX,
    max_table: usize::MAX,
    chunk: None,
    generic: None,
    memory: None,
    template: TEMPLATE,
    reserved: &[KEYWORDS, LIBRARY],
    renames_digits: false,
    refuses: |name| {
        let rest = ["str", "mem", "is", "to"].iter().find_map(|start| name.strip_prefix(start));
        rest.filter(|rest| rest.starts_with(|c: char| c.is_ascii_lowercase()))
            .map(|_| ("is reserved in C for its library", "choose another name, with a prefix perhaps"))
    },
    check: |text| compiler(&["-fsyntax-only", "-x", "c", "-"], text),
};

/// The third of four operands where the first is less than the second, else the fourth.
fn chosen(places: [usize; 4], operands: &[Text]) -> String {
    let [a, b, c, d] = places.map(|place| &operands[place].text);
    format!("({a} < {b} ? {c} : {d})")
}

fn variable(of: &Type, name: &str) -> String {
    match of.length {
        Some(n) => format!("{} {name}[{n}];", of.item),
        None => format!("{} {name};", of.text),
    }
}

static C99: Language = C;

/// C with one rounding where a product and a sum are one operation.
static FUSED: Language = Language { name: "c99_fused", multiply_add: MultiplyAdd::Call("fmaf"), ..C };

/// A language whose record is wrong: C has no such function.
static WRONG: Language = Language {
    name: "wrong",
    spelling: |op| match op {
        Op::Rsqrt(_) => Spelling::Call("inversesqrtf"),
        _ => (C.spelling)(op),
    },
    ..C
};

const TEMPLATE: &str = "\
{% for line in head %}// {{ line }}
{% endfor %}
#ifndef {{ guard }}
#define {{ guard }}
#include <math.h>

#ifndef ZONAL_VECTORS
#define ZONAL_VECTORS
typedef struct { float x, y; } vec2;
typedef struct { float x, y, z; } vec3;
typedef struct { float x, y, z, w; } vec4;
typedef vec3 mat3[3];
#endif
{% for table in tables %}
{{ table }}
{% endfor %}
{%- for f in functions %}
{% for line in f.doc %}// {{ line }}
{% endfor %}{% for table in f.tables %}{{ table }}
{% endfor %}{{ f.result }} {{ f.name }}({{ f.params | join(sep=\", \") }}) {
{%- for line in f.body %}
    {{ line }}
{%- endfor %}
}
{% endfor %}
#endif
";

/// From the standard, 6.4.1.
const KEYWORDS: Words = Words {
    what: "reserved in C",
    words: "auto break case char const continue default do double else enum extern float for goto if inline int long \
        register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while",
};

/// Those of `math.h` whose names end in a letter, from the standard, 7.12.
const LIBRARY: Words = Words {
    what: "a function of C's library",
    words: "acos acosf acosh acoshf asin asinf asinh asinhf atan atanf atanh atanhf cbrt cbrtf ceil ceilf copysign \
        copysignf cos cosf cosh coshf erf erfc erfcf erff exp expf fabs fabsf fdim fdimf floor floorf fma fmaf fmax \
        fmaxf fmin fminf fmod fmodf frexp frexpf hypot hypotf ilogb ilogbf ldexp ldexpf lgamma lgammaf llrint llround \
        log logb logbf logf lrint lround modf modff nan nanf nearbyint nearbyintf nextafter nextafterf pow powf \
        remainder remainderf remquo remquof rint rintf round roundf scalbn scalbnf sin sinf sinh sinhf sqrt sqrtf tan \
        tanf tanh tanhf tgamma tgammaf trunc truncf",
};

/// Runs the compiler on a text: what it says if it refuses it.
fn compiler(arguments: &[&str], text: &str) -> Result<(), String> {
    let options = ["-std=c99", "-Wall", "-Werror", "-ffp-contract=off"];
    let child = Command::new("cc").args(options).args(arguments).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.map_err(|error| format!("`cc` cannot be run ({error}): install a C compiler"))?;
    // A compiler that gives up early does not read to the end; what it says then comes below.
    let _ = child.stdin.take().expect("is piped").write_all(text.as_bytes());
    let output = child.wait_with_output().map_err(|error| format!("`cc` cannot be waited for ({error})"))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

/// Every family once at a low order, in straight lines and as a loop where it has one, for one channel and three, or for one
/// where the catalogue has three alone; and the toys, which hold every operation.
fn sample() -> &'static [Function] {
    static FUNCTIONS: LazyLock<Vec<Function>> = LazyLock::new(|| {
        let low = |shown: fn(usize) -> Vec<Spec>| [4, 3, 2, 5].into_iter().map(shown).find(|specs| !specs.is_empty());
        let specs: Vec<Spec> = ALL
            .iter()
            .flat_map(|family| {
                let mut specs = low(family.shown).unwrap_or_else(|| panic!("{family:?} is shown late"));
                if specs.iter().all(|spec| spec.rgb) {
                    specs.push(specs[0].base());
                }
                specs
            })
            .collect();
        build(&[specs, toys::specs()].concat())
    });
    &FUNCTIONS
}

fn scalars() -> Vec<Function> {
    sample().iter().filter(|function| !function.spec.rgb).cloned().collect()
}

fn module(functions: Vec<Function>, arrays: Option<Arrays>) -> Module {
    Module { name: "sample".to_owned(), origin: "a test".to_owned(), functions, arrays, ..Module::default() }
}

/// A program around the functions: it reads numbers for each case of each, calls it, and writes its result's.
fn program(functions: &[Function], target: Target, arrays: Option<Arrays>, text: &str) -> String {
    let mut main = String::new();
    for function in functions {
        let dialect = function.dialect(target, arrays).expect("is printed");
        let params = function.built.code.params();
        let (shape, kind) = function.built.code.result();
        let result = dialect.passed(shape, kind);
        let mut arguments: Vec<&str> = params.iter().map(|param| param.name).collect();
        main += &format!("    for (int i = 0; i < {CASES}; i++) {{\n");
        for param in params {
            let name = param.name;
            main += &format!("        {}\n", variable(&dialect.passed(param.shape, param.kind), name));
            main += &format!("        if (fread(&{name}, sizeof {name}, 1, stdin) != 1) return 1;\n");
        }
        main += &format!("        {}\n", variable(&result, "out"));
        let name = function.shader_name();
        if dialect.is_written(shape) {
            arguments.push("out");
            main += &format!("        {name}({});\n", arguments.join(", "));
        } else {
            main += &format!("        out = {name}({});\n", arguments.join(", "));
        }
        main += "        if (fwrite(&out, sizeof out, 1, stdout) != 1) return 1;\n    }\n";
    }
    // Twice, since guards let a file meet itself.
    format!("{text}\n{text}\n#include <stdio.h>\nint main(void) {{\n{main}    return 0;\n}}\n")
}

/// Prints, checks, compiles and runs the sample and compares it with the interpreter.
fn runs_as_the_interpreter(target: Target, arrays: Option<Arrays>, contraction: Contraction) {
    let functions = scalars();
    let printed = file(&module(functions.clone(), arrays), target, "");
    let text = printed.unwrap_or_else(|error| panic!("{error}")).text;
    let folder = Folder::new();
    let path = folder.path("sample");
    let arguments = ["-O1", "-x", "c", "-", "-o", path.to_str().expect("a path"), "-lm"];
    compiler(&arguments, &program(&functions, target, arrays, &text)).unwrap_or_else(|error| panic!("{error}"));
    let (mut given, mut wanted) = (Vec::new(), Vec::new());
    for function in &functions {
        let runner = function.built.code.runner::<f32>();
        for input in samples::inputs(function.built.code.params(), 71, CASES, None) {
            let input: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
            let slices: Vec<&[f32]> = input.iter().map(Vec::as_slice).collect();
            wanted.push((function.spec.to_string(), runner.run(&slices, contraction)));
            given.extend(input.concat());
        }
    }
    let mut got = run(&path, &given).into_iter();
    for (spec, want) in wanted {
        let got: Vec<f32> = got.by_ref().take(want.len()).collect();
        let bits = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&got), bits(&want), "{spec} in {target}: {got:?}, not {want:?}");
    }
    assert_eq!(got.next(), None, "no number is left over");
}

/// Runs a program on numbers.
fn run(path: &Path, numbers: &[f32]) -> Vec<f32> {
    let mut child =
        Command::new(path).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("what was compiled runs");
    let mut input = child.stdin.take().expect("is piped");
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
    // Both pipes are full before the program ends.
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("it reads all");
    assert!(output.status.success(), "{}", output.status);
    output.stdout.chunks(4).map(|bytes| f32::from_ne_bytes(bytes.try_into().expect("whole numbers"))).collect()
}

#[test]
fn the_sample_holds_every_family_and_a_loop() {
    let functions = scalars();
    let families: BTreeSet<_> = functions.iter().map(|function| function.spec.family).collect();
    assert!(ALL.iter().all(|family| families.contains(family)) && families.len() > ALL.len());
    assert!(functions.iter().any(|function| function.spec.form == Form::Loop));
    assert!(functions.iter().any(|function| function.spec.family.branch.is_some()));
}

#[test]
fn every_family_computes_what_the_interpreter_does() {
    runs_as_the_interpreter(&C99, None, Contraction::Separate);
}

#[test]
fn every_family_computes_the_same_with_arrays_in_structs() {
    runs_as_the_interpreter(&C99, Some(Arrays::Struct), Contraction::Separate);
}

#[test]
fn every_family_computes_what_the_fused_interpreter_does() {
    runs_as_the_interpreter(&FUSED, None, Contraction::Fused);
}

#[test]
fn three_channels_are_refused_with_what_to_do() {
    let rgb: Vec<&Function> = sample().iter().filter(|function| function.spec.rgb).collect();
    assert!(rgb.len() > 20);
    for function in rgb {
        let error = Module::of(function.clone()).text(&C99).expect_err("C adds no vectors");
        assert_eq!(
            error.to_string(),
            format!(
                "`{}` cannot be printed for c99: C has no operators on vectors, which a signal of three channels needs; \
                 leave `rgb` out and call the function once a channel, or name another target",
                function.spec
            )
        );
    }
}

#[test]
fn arrays_as_values_are_refused() {
    let builder = Builder::new("kernels").target(&C99).arrays(Arrays::Value).spec("rotate:3");
    let error = builder.generate().expect_err("C returns no array").to_string();
    assert!(error.contains("C does not pass arrays as `value`; leave `arrays` out"), "{error}");
}

#[test]
fn a_builder_takes_it_and_its_words_are_no_names() {
    let builder = |name: &str, function: &str| Builder::new(name).target(&C99).named(function, "rotate:3:tensor");
    let files = builder("kernels", "turn").generate().unwrap_or_else(|error| panic!("{error}"));
    let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths, ["kernels.c", "kernels.md"]);
    assert!(files[0].text.contains("void turn(const vec4 q, const float c[restrict 9], float result[restrict 9]) {"));
    for (word, why) in [
        ("char", "is reserved in C"),
        ("signed", "is reserved in C"),
        ("hypot", "is a function of C's library"),
        ("strange", "is reserved in C for its library"),
        ("tone", "is reserved in C for its library"),
    ] {
        let of_function = builder("kernels", word).generate().expect_err("is refused").to_string();
        assert!(of_function.starts_with(&format!("Builder::named:1:1: `{word}` {why};")), "{of_function}");
        let of_files = builder(word, "turn").generate().expect_err("is refused").to_string();
        assert!(of_files.starts_with(&format!("Builder::new:1:1: `{word}` {why};")), "{of_files}");
        // The languages that zonal knows take these.
        Builder::new(word).named(word, "eval:2").plan().unwrap_or_else(|error| panic!("{error}"));
    }
    assert!(builder("kernels", "str_turn").plan().is_ok());
}

#[test]
fn constants_are_printed_and_compiled() {
    let light = Constants { name: "light".to_owned(), doc: "A light.".to_owned(), values: vec![[0.1, -2.0, 1e-15]; 4] };
    let module = Module { constants: vec![light], ..module(vec![], None) };
    let text = file(&module, &C99, "").unwrap_or_else(|error| panic!("{error}")).text;
    assert!(text.contains("const vec3 LIGHT[4] = {\n    (vec3){0.1, -2.0, 1e-15},\n"), "{text}");
}

#[test]
fn what_its_compiler_says_is_reported() {
    let turn = scalars().into_iter().find(|function| function.spec.to_string() == "rotate:4").expect("is there");
    let error = file(&module(vec![turn], None), &WRONG, "").expect_err("C has no inversesqrtf");
    assert!(matches!(error, GenerateError::Invalid(_)));
    let error = error.to_string();
    assert!(error.starts_with("the generated wrong of `sample.c` is refused"), "{error}");
    assert!(error.contains("inversesqrtf") && error.contains("<stdin>:"), "{error}");
}
