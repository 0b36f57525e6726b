//! GLSL that is the same text in 4.50, 3.30 and ES 3.00, without a version of its own. Where it is GLSL ES its numbers are
//! highp, whatever the shader around it says: the macro in signatures, a statement in bodies, both in the template.

use crate::emit::language::expression::Text;
use crate::emit::language::form::{self, Form};
#[cfg(not(feature = "check"))]
use crate::emit::language::record::unchecked as check;
use crate::emit::language::record::{
    Arrays, Float, ITEMS, Language, Memory, MultiplyAdd, Statements, Type, Types, Way, Words,
};
use crate::emit::language::shader;

/// GLSL that is the same text in 4.50, 3.30 and ES 3.00.
pub static GLSL: Language = Language {
    name: "glsl",
    title: "GLSL",
    extension: "glsl",
    forms: &[Form {
        name: form::BARE,
        extension: "glsl",
        what: form::BARE_WHAT,
        text: |_, text| {
            // The statements in bodies stay, since GLSL from 1.30 on takes them, ES or not.
            form::bare(&text, |line| line.starts_with('#')).replace(&format!("{HIGHP} "), "")
        },
    }],
    single: Float { name: "float", literal: shader::literal, tiny: "1e-15" },
    half: None,
    types: Types {
        vector: |_, n| format!("vec{n}"),
        matrix: |_| "mat3".to_owned(),
        array: |of, n| format!("{of}[{n}]"),
    },
    arrays: &[Arrays::Value, Arrays::Struct, Arrays::Reference, Arrays::Vec4, Arrays::Memory],
    structure,
    parameter: |name, of, way| match way {
        Way::In => format!("{} {name}", precise(of)),
        Way::Out => format!("out {} {name}", precise(of)),
    },
    result: precise,
    nothing: "void",
    component: shader::component,
    brackets: shader::constructor,
    columns: false,
    trailing_comma: false,
    vector_operators: true,
    multiply_add: MultiplyAdd::Infix,
    spelling: |op| shader::spelling(op, "inversesqrt", select),
    statements: Statements {
        int: "int",
        declare: |of, name, _| format!("{of} {name}"),
        variable: |of, name| match of.length {
            Some(n) => format!("{} {name}[{n}];", of.item),
            None => format!("{} {name};", of.text),
        },
        each: |name, from, to, step| format!("for (int {name} = {from}; {name} < {to}; {name} += {step}) {{"),
        at_most: shader::at_most,
        tail: false,
    },
    table,
    constant: table,
    doc: "//",
    max_statements: shader::MAX_STATEMENTS,
    max_table: shader::MAX_TABLE,
    chunk: None,
    generic: None,
    memory: Some(Memory {
        first: true,
        read: |name, of| format!("{of} {name}(int place) {{ return {of}(0.0); }}"),
        write: |name, of| format!("void {name}(int place, {of} number) {{}}"),
    }),
    template: zonal_templates::GLSL,
    reserved: &[RESERVED, shader::FUNCTIONS],
    refuses,
    renames_digits: true,
    check,
};

/// The macro that is `highp` in GLSL ES and nothing elsewhere: naga takes no such word before a parameter.
const HIGHP: &str = "ZONAL_HIGHP";

/// Keywords and reserved words whose names end in a letter, but for the opaque types, from the specifications of GLSL
/// 4.60 and GLSL ES 3.00, sections 3.6 to 3.8.
const RESERVED: Words = Words {
    what: "reserved in GLSL",
    words: "active asm atomic_uint attribute bool break buffer case cast centroid class coherent common const \
        continue default discard do double else enum extern external false filter fixed flat float for goto half highp if \
        in inline inout input int interface invariant layout long lowp main mediump namespace noinline noperspective out \
        output partial patch precise precision public readonly resource restrict return sample sampler samplerShadow \
        shared short sizeof smooth static struct subroutine superp switch template this true typedef uint uniform union \
        unsigned using varying void volatile while writeonly defined",
};

/// What the opaque types begin with, after an `i` or a `u` perhaps, and what they end in.
const OPAQUE: ([&str; 5], [&str; 14]) = (
    ["sampler", "image", "texture", "subpassInput", "imageBuffer"],
    [
        "1D",
        "2D",
        "3D",
        "Cube",
        "Rect",
        "Array",
        "Buffer",
        "MS",
        "Shadow",
        "1DArray",
        "2DArray",
        "CubeArray",
        "2DRect",
        "2DMS",
    ],
);

fn refuses(name: &str) -> Option<(&'static str, &'static str)> {
    if name.contains("__") {
        return Some(("holds `__`, which is reserved in GLSL and renamed by naga", "write single underscores"));
    }
    if name.to_ascii_lowercase().starts_with("gl_") {
        return Some(("starts with `gl_`, which is reserved in GLSL", "begin it with another word"));
    }
    let bare = name.strip_prefix(['i', 'u']).unwrap_or(name);
    let (heads, tails) = OPAQUE;
    let is_opaque =
        |text: &str| heads.iter().any(|head| text.strip_prefix(head).is_some_and(|tail| tails.contains(&tail)));
    (is_opaque(bare) || is_opaque(name))
        .then_some(("is reserved in GLSL", "choose another name, with a prefix perhaps"))
}

/// By `mix` and not by `? :`, which may leave out what is not chosen. A vector is chosen by a vector of truth values.
fn select(x: &[Text], of: &str) -> String {
    let is_less = format!("{} < {}", x[0].text, x[1].text);
    let by = if of.starts_with("vec") { format!("b{of}({is_less})") } else { is_less };
    format!("mix({}, {}, {by})", x[3].text, x[2].text)
}

/// A type with its precision, which a struct may not have.
fn precise(of: &Type) -> String {
    if of.is_struct() { of.text.clone() } else { format!("{HIGHP} {}", of.text) }
}

fn table(name: &str, of: &Type) -> (String, &'static str) {
    (format!("const {} {name} = {}(", precise(of), of.text), ");")
}

fn structure(name: &str, of: &Type) -> String {
    let (guard, Type { item, length, .. }) = (name.to_uppercase(), of);
    let length = length.unwrap_or(1);
    format!("#ifndef {guard}\n#define {guard}\nstruct {name} {{ {HIGHP} {item} {ITEMS}[{length}]; }};\n#endif")
}

/// A drop-in carries neither a version nor an entry point: both are added here.
#[cfg(feature = "check")]
fn check(text: &str) -> Result<(), String> {
    let whole = format!("#version 450\n{text}\nvoid main() {{}}\n");
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    let module =
        naga::front::glsl::Frontend::default().parse(&options, &whole).map_err(|error| error.emit_to_string(&whole))?;
    shader::validate(&module, &whole)
}
