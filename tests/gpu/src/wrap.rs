//! Shaders around a generated function, which has neither an entry point nor a version of its own: a compute shader that
//! calls it once a thread with numbers from a buffer, and a fragment shader for compilers that only look.

use zonal_codegen::emit::dialect::{Dialect, Target};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::graph::Kind;
use zonal_codegen::kernel::Shape;

/// The numbers of every call start at a multiple of so many in a buffer: 256 bytes, as WebGPU asks of offsets.
pub const ALIGNMENT: usize = 64;

/// The text of the file that holds one function.
///
/// # Panics
///
/// If the function does not fit its target: the catalogue's all do.
pub fn file(function: &Function, target: Target) -> String {
    let module = Module {
        name: function.shader_name(),
        origin: format!("`{}`", function.spec),
        functions: vec![function.clone()],
        constants: vec![],
    };
    module.shader(target).unwrap_or_else(|limit| panic!("{limit}"))
}

fn dialect(function: &Function, target: Target) -> Dialect {
    Dialect { target, rgb: function.spec.rgb, half: function.spec.half }
}

/// How many channels a number of this kind has in the function's text.
pub fn channels(function: &Function, kind: Kind) -> usize {
    match kind {
        Kind::Signal => function.spec.channels(),
        Kind::Scalar => 1,
    }
}

/// How many numbers a call takes.
pub fn input_len(function: &Function) -> usize {
    function.built.code.params().iter().map(|param| param.shape.len() * channels(function, param.kind)).sum()
}

/// How many numbers a call returns.
pub fn output_len(function: &Function) -> usize {
    let (shape, kind) = function.built.code.result();
    shape.len() * channels(function, kind)
}

/// A value of this shape, made of numbers that `next` names one after the other.
fn value(dialect: Dialect, shape: Shape, kind: Kind, next: &mut impl FnMut() -> String) -> String {
    let of = |shape: Shape| dialect.type_of(shape, kind);
    let (items, part) = match shape {
        Shape::Scalar if kind == Kind::Signal && dialect.rgb => (3, None),
        Shape::Scalar => return next(),
        Shape::Array(n) => (n, Some(Shape::Scalar)),
        Shape::Pairs(n) => (n, Some(Shape::Pair)),
        Shape::Vectors(n) => (n, Some(Shape::Vec3)),
        plain => (plain.len(), None),
    };
    let parts: Vec<String> = (0..items)
        .map(|_| match part {
            Some(part) => value(dialect, part, kind, next),
            None => next(),
        })
        .collect();
    format!("{}({})", of(shape), parts.join(", "))
}

/// The function's file and an entry point that calls it once. Its input is all parameters' numbers, the channels of a
/// number together, padded to whole vectors of four; its result likewise. Each call is a dispatch of its own with other
/// offsets into the buffers, so that every index is a constant: a software driver compiles that many times faster than
/// an index by thread. `text` is the file, in WGSL or GLSL.
pub fn compute(function: &Function, target: Target, text: &str) -> String {
    let dialect = dialect(function, target);
    let glsl = target == Target::Glsl;
    let (define, four) = if glsl { ("vec4", "vec4") } else { ("let", "vec4<f32>") };
    let (input, output) = (input_len(function).div_ceil(4), output_len(function).div_ceil(4));
    let reads: String = (0..input).map(|i| format!("    {define} in{i}_ = inputs[{i}];\n")).collect();
    let letter = |place: usize| [".x", ".y", ".z", ".w"][place % 4];
    let mut places = 0..;
    let mut next = || {
        let place = places.next().expect("there is always a next number");
        format!("in{}_{}", place / 4, letter(place))
    };
    let params = function.built.code.params();
    let arguments: Vec<String> =
        params.iter().map(|param| value(dialect, param.shape, param.kind, &mut next)).collect();
    let call = format!("{}({})", function.shader_name(), arguments.join(", "));
    let (shape, kind) = function.built.code.result();
    let channels = channels(function, kind);
    let number = |place: usize| match (place / channels < shape.len(), channels) {
        (false, _) => "0.0".to_owned(),
        (true, 1) => dialect.component("result", shape, place),
        (true, _) => format!("{}{}", dialect.component("result", shape, place / channels), letter(place % channels)),
    };
    let writes: String = (0..output)
        .map(|i| {
            let numbers = [0, 1, 2, 3].map(|j| number(4 * i + j)).join(", ");
            format!("    outputs[{i}] = {four}({numbers});\n")
        })
        .collect();
    match glsl {
        true => format!(
            "#version 450\n{text}\n\
             layout(local_size_x = 1) in;\n\
             layout(std430, set = 0, binding = 0) readonly buffer Inputs {{ vec4 inputs[{input}]; }};\n\
             layout(std430, set = 0, binding = 1) buffer Outputs {{ vec4 outputs[{output}]; }};\n\
             void main() {{\n{reads}    {} result = {call};\n{writes}}}\n",
            dialect.type_of(shape, kind)
        ),
        false => format!(
            "{text}\n\
             @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>, {input}>;\n\
             @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>, {output}>;\n\
             @compute @workgroup_size(1)\n\
             fn main() {{\n{reads}    let result = {call};\n{writes}}}\n"
        ),
    }
}

/// A fragment shader in a version of GLSL, from the function's file: the arguments are uniforms, the result is a colour.
pub fn fragment(function: &Function, version: &str, text: &str) -> String {
    let dialect = dialect(function, Target::Glsl);
    let (shape, kind) = function.built.code.result();
    let params = function.built.code.params();
    let uniforms: String = params.iter().map(|param| format!("uniform {};\n", dialect.parameter(param))).collect();
    let arguments: Vec<&str> = params.iter().map(|param| param.name).collect();
    let last = dialect.component("result", shape, shape.len() - 1);
    let precision = if version.ends_with("es") { "precision highp float;\n" } else { "" };
    format!(
        "#version {version}\n{precision}{text}\n{uniforms}out vec4 colour;\n\
         void main() {{\n    {} result = {}({});\n    colour = vec4({last}{});\n}}\n",
        dialect.type_of(shape, kind),
        function.shader_name(),
        arguments.join(", "),
        if channels(function, kind) == 3 { ", 1.0" } else { "" }
    )
}
