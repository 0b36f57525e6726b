//! CUDA C as a language, for what NVIDIA's compiler makes of kernels: signals of three channels are a struct with operators, special
//! operations the hardware's own.

use zonal_codegen::emit::language::expression::{Binding, Text};
use zonal_codegen::emit::language::record::{Float, ITEMS, MultiplyAdd, Spelling, Statements, Type, Types, Way};
use zonal_codegen::emit::language::{Arrays, Language, shader};
use zonal_codegen::ir::op::Op;

/// CUDA C, as clang takes it without NVIDIA's headers.
pub static CUDA: Language = Language {
    name: "cuda",
    title: "CUDA C",
    extension: "cu",
    forms: &[],
    single: Float { name: "float", literal: |value| shader::literal(value) + "f", tiny: "1e-15f" },
    half: None,
    types: Types {
        vector: |_, n| format!("vec{n}"),
        matrix: |_| "mat3".to_owned(),
        array: |of, n| format!("{of}[{n}]"),
    },
    arrays: &[Arrays::Reference],
    structure: |name, of| format!("struct {name} {{ {} {ITEMS}[{}]; }};", of.item, of.length.unwrap_or(1)),
    parameter: |name, of, way| {
        let constant = if way == Way::In { "const " } else { "" };
        match of.length {
            Some(n) => format!("{constant}{} (&{name})[{n}]", of.item),
            None => format!("{constant}{}& {name}", of.text),
        }
    },
    result: |of| of.text.clone(),
    nothing: "void",
    component: shader::component,
    brackets: |of| (format!("{of}{{"), "}"),
    columns: false,
    trailing_comma: false,
    vector_operators: true,
    multiply_add: MultiplyAdd::Infix,
    spelling: |op| match op {
        Op::Recip(_) => Spelling::Call("__nvvm_rcp_approx_ftz_f"),
        Op::Rsqrt(_) => Spelling::Call("__nvvm_rsqrt_approx_ftz_f"),
        Op::Sqrt(_) => Spelling::Call("__nvvm_sqrt_approx_ftz_f"),
        Op::Exp2(_) => Spelling::Call("__nvvm_ex2_approx_ftz_f"),
        Op::Log2(_) => Spelling::Call("__nvvm_lg2_approx_ftz_f"),
        Op::Abs(_) => Spelling::Call("__builtin_fabsf"),
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
    table: |name, of| (format!("static const {} {name}[{}] = {{", of.item, of.length.unwrap_or(1)), "};"),
    constant: |name, of| (format!("const {} {name}[{}] = {{", of.item, of.length.unwrap_or(1)), "};"),
    doc: "//",
    max_statements: usize::MAX,
    max_table: usize::MAX,
    chunk: None,
    generic: None,
    memory: None,
    template: TEMPLATE,
    reserved: &[],
    renames_digits: false,
    refuses: |_| None,
    // NVIDIA's compiler checks it.
    check: |_| Ok(()),
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

const TEMPLATE: &str = "\
#define DEVICE static inline __attribute__((device, always_inline))
struct vec2 { float x, y; };
struct vec3 { float x, y, z; };
struct vec4 { float x, y, z, w; };
typedef vec3 mat3[3];
DEVICE vec3 operator+(const vec3& a, const vec3& b) { return vec3{a.x + b.x, a.y + b.y, a.z + b.z}; }
DEVICE vec3 operator-(const vec3& a, const vec3& b) { return vec3{a.x - b.x, a.y - b.y, a.z - b.z}; }
DEVICE vec3 operator-(const vec3& a) { return vec3{-a.x, -a.y, -a.z}; }
DEVICE vec3 operator*(const vec3& a, float b) { return vec3{a.x * b, a.y * b, a.z * b}; }
DEVICE vec3 operator*(float b, const vec3& a) { return vec3{a.x * b, a.y * b, a.z * b}; }
DEVICE vec3 operator*(const vec3& a, const vec3& b) { return vec3{a.x * b.x, a.y * b.y, a.z * b.z}; }
{% for f in functions %}
DEVICE {{ f.result }} {{ f.name }}({{ f.params | join(sep=\", \") }}) {
{%- for line in f.body %}
    {{ line }}
{%- endfor %}
}
{% endfor %}
";
