//! Shaders around a generated function, which has neither an entry point nor a version of its own: a compute shader that
//! calls it once a thread with numbers from a buffer, a fragment shader that calls it for a row of pixels with numbers
//! from a texture, and one for compilers that only look.

use zonal_codegen::emit::dialect::Dialect;
use zonal_codegen::emit::language::record::Way;
use zonal_codegen::emit::language::{Arrays, GLSL, Target};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::Param;

/// How many cases one workgroup of a compute shader computes.
pub const GROUP: usize = 64;
/// How many numbers a vector holds: cases start and end at whole vectors of four.
pub const VECTOR: usize = 4;

/// The text of the file that holds one function.
///
/// # Panics
///
/// If the function does not fit its target: the catalogue's all do.
pub fn file(function: &Function, dialect: Dialect) -> String {
    let module = Module { arrays: Some(dialect.arrays), ..Module::of(function.clone()) };
    module.text(dialect.language).unwrap_or_else(|limit| panic!("{limit}"))
}

/// How a function is printed in a language that passes arrays in one way, or in its own.
///
/// # Panics
///
/// If the language cannot.
pub fn dialect(function: &Function, target: Target, arrays: Option<Arrays>) -> Dialect {
    function.dialect(target, arrays).unwrap_or_else(|limit| panic!("{limit}"))
}

/// How many channels a number of this kind has in the function's text.
pub fn channels(function: &Function, kind: Kind) -> usize {
    kind.numbers(function.spec.channels())
}

/// How many vectors of four a call's parameters fill.
pub fn input_vectors(function: &Function) -> usize {
    let numbers = |param: &Param| param.shape.len() * channels(function, param.kind);
    function.built.code.params().iter().map(numbers).sum::<usize>().div_ceil(VECTOR)
}

/// How many vectors of four a call's result fills.
pub fn output_vectors(function: &Function) -> usize {
    let (shape, kind) = function.built.code.result();
    (shape.len() * channels(function, kind)).div_ceil(VECTOR)
}

/// A call of a function on one case, whose numbers are the vectors `in0_`, `in1_`, …: all parameters one after the
/// other, the channels of a number together.
struct Call {
    /// The statements that make it and name what it gives `result`.
    statements: String,
    /// The components of `result`, four to a vector, padded with zeros.
    vectors: Vec<String>,
}

impl Call {
    fn new(function: &Function, dialect: Dialect) -> Self {
        let letter = |place: usize| [".x", ".y", ".z", ".w"][place % VECTOR];
        let mut places = 0..;
        let mut next = || {
            let place = places.next().expect("there is always a next number");
            format!("in{}_{}", place / VECTOR, letter(place))
        };
        let mut number = |kind: Kind| match !kind.is_scalar() && dialect.rgb {
            true => format!("{}({}, {}, {})", dialect.number(kind), next(), next(), next()),
            false => next(),
        };
        // A structure is filled item by item: naga's GLSL front end takes the constructor of an array inside that of a
        // structure for another type in some of the texts that other compilers accept.
        let mut filled = String::new();
        let mut argument = |param: &Param| {
            let numbers: Vec<String> = (0..param.shape.len()).map(|_| number(param.kind)).collect();
            if dialect.structure(&dialect.type_of(param.shape, param.kind)).is_none() {
                return dialect.argument(param.shape, param.kind, &numbers);
            }
            let name = format!("given_{}", param.name);
            let passed = dialect.passed(param.shape, param.kind);
            filled += &format!("{}\n    ", (dialect.language.statements.variable)(&passed, &name));
            for (place, number) in numbers.iter().enumerate() {
                filled += &format!("{} = {number};\n    ", dialect.component(&name, param.shape, param.kind, place));
            }
            name
        };
        let arguments: Vec<String> = function.built.code.params().iter().map(&mut argument).collect();
        let (shape, kind) = function.built.code.result();
        let channels = channels(function, kind);
        let number = |place: usize| match (place / channels < shape.len(), channels) {
            (false, _) => "0.0".to_owned(),
            (true, 1) => dialect.component("result", shape, kind, place),
            (true, _) => {
                format!("{}{}", dialect.component("result", shape, kind, place / channels), letter(place % channels))
            }
        };
        let vector = |i: usize| format!("vec4({})", [0, 1, 2, 3].map(|j| number(VECTOR * i + j)).join(", "));
        let vectors = (0..output_vectors(function)).map(vector).collect();
        Self { statements: filled + &call(function, dialect, arguments), vectors }
    }
}

/// The statements that call a function and name what it gives `result`.
fn call(function: &Function, dialect: Dialect, mut arguments: Vec<String>) -> String {
    let (name, (shape, kind)) = (function.shader_name(), function.built.code.result());
    let (statements, passed) = (dialect.language.statements, dialect.passed(shape, kind));
    if dialect.is_written(shape) {
        arguments.push("result".to_owned());
        return format!("{}\n    {name}({});", (statements.variable)(&passed, "result"), arguments.join(", "));
    }
    let start = (statements.declare)(&passed.text, "result", false);
    format!("{start} = {name}({});", arguments.join(", "))
}

/// One line a vector.
fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(|i| format!("    {}\n", line(i))).collect()
}

/// The function's file and a compute shader that calls it, a case a thread. `text` is the file, in WGSL or GLSL.
///
/// One dispatch takes all cases: a dispatch a case with constant indices compiles no faster on lavapipe (36 s of processor
/// time for 128 texts either way, 2048 cases each) and runs slower on SwiftShader, and there every further case costs.
pub fn compute(function: &Function, dialect: Dialect, text: &str) -> String {
    let Call { statements, vectors } = Call::new(function, dialect);
    let (takes, gives) = (input_vectors(function), vectors.len());
    let glsl = dialect.language == &GLSL;
    let define = if glsl { "vec4" } else { "let" };
    let reads = lines(takes, |i| format!("{define} in{i}_ = inputs[at * {takes}u + {i}u];"));
    let writes = lines(gives, |i| {
        let vector = &vectors[i];
        match glsl {
            true => format!("outputs[at * {gives}u + {i}u] = {vector};"),
            false => format!("outputs[at * {gives}u + {i}u] = vec4<f32>{};", &vector["vec4".len()..]),
        }
    });
    match glsl {
        true => format!(
            "#version 450\n{text}\n\
             layout(local_size_x = {GROUP}) in;\n\
             layout(std430, set = 0, binding = 0) readonly buffer Inputs {{ vec4 inputs[]; }};\n\
             layout(std430, set = 0, binding = 1) buffer Outputs {{ vec4 outputs[]; }};\n\
             void main() {{\n    uint at = gl_GlobalInvocationID.x;\n{reads}    {statements}\n{writes}}}\n"
        ),
        false => format!(
            "{text}\n\
             @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;\n\
             @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;\n\
             @compute @workgroup_size({GROUP})\n\
             fn main(@builtin(global_invocation_id) thread: vec3<u32>) {{\n    let at = thread.x;\n{reads}    \
             {statements}\n{writes}}}\n"
        ),
    }
}

/// How many vectors one pixel gives: WebGL2 has at least so many targets to draw into.
pub const TARGETS: usize = 8;

/// The function's GLSL file and a fragment shader for WebGL2 that calls it: a row of pixels is a case, whose inputs are a
/// row of a texture; a pixel gives [`TARGETS`] vectors of the result, one a target, the last pixel zeros behind its end.
pub fn pixels(function: &Function, dialect: Dialect, text: &str) -> String {
    let Call { statements, mut vectors } = Call::new(function, dialect);
    let reads = lines(input_vectors(function), |i| format!("vec4 in{i}_ = texelFetch(inputs, ivec2({i}, at.y), 0);"));
    let targets = TARGETS.min(vectors.len());
    vectors.resize(vectors.len().next_multiple_of(targets), "vec4(0.0)".to_owned());
    let gives = vectors.len();
    let outs: String = (0..targets).map(|i| format!("layout(location = {i}) out vec4 colour{i}_;\n")).collect();
    let writes = lines(targets, |i| format!("colour{i}_ = outputs[at.x * {targets} + {i}];"));
    format!(
        "#version 300 es\nprecision highp float;\nprecision highp int;\n{text}\n\
         uniform highp sampler2D inputs;\n{outs}\
         void main() {{\n    ivec2 at = ivec2(gl_FragCoord.xy);\n{reads}    {statements}\n    \
         vec4 outputs[{gives}] = vec4[{gives}](\n        {}\n    );\n{writes}}}\n",
        vectors.join(",\n        ")
    )
}

/// A fragment shader in a version of GLSL, from the function's file: the arguments are uniforms, the result is a colour.
pub fn fragment(function: &Function, dialect: Dialect, version: &str, text: &str) -> String {
    let (shape, kind) = function.built.code.result();
    let params = function.built.code.params();
    // A parameter may be called as what GLSL has built in, a uniform may not.
    let arguments: Vec<String> = params.iter().map(|param| format!("given_{}", param.name)).collect();
    let uniform = |(param, name): (&Param, &String)| {
        let parameter = dialect.language.parameter;
        format!("uniform {};\n", parameter(name, &dialect.passed(param.shape, param.kind), Way::In))
    };
    let uniforms: String = params.iter().zip(&arguments).map(uniform).collect();
    let last = dialect.component("result", shape, kind, shape.len() - 1);
    let precision = if version.ends_with("es") { "precision highp float;\n" } else { "" };
    format!(
        "#version {version}\n{precision}{text}\n{uniforms}out vec4 colour;\n\
         void main() {{\n    {}\n    colour = vec4({last}{});\n}}\n",
        call(function, dialect, arguments),
        if channels(function, kind) == 3 { ", 1.0" } else { "" }
    )
}
