//! WGSL, WebGPU's shading language.

use crate::emit::language::expression::Text;
use crate::emit::language::form::{self, Form};
#[cfg(not(feature = "check"))]
use crate::emit::language::record::unchecked as check;
use crate::emit::language::record::{Arrays, Float, Language, Memory, MultiplyAdd, Statements, Type, Types, Words};
use crate::emit::language::shader;

/// WebGPU's shading language.
pub static WGSL: Language = Language {
    name: "wgsl",
    title: "WGSL",
    extension: "wgsl",
    forms: &[
        Form {
            name: "naga_oil",
            extension: "wgsl",
            what: "a module of naga_oil, as Bevy took shaders up to 0.19, imported as `zonal::` and the name of the file",
            text: |stem, text| format!("#define_import_path zonal::{stem}\n\n{text}"),
        },
        Form {
            name: "wesl",
            extension: "wesl",
            what: "a module of a WESL package, as Bevy takes shaders from 0.20 on",
            text: |_, text| text,
        },
        Form {
            name: form::BARE,
            extension: "wgsl",
            what: form::BARE_WHAT,
            text: |_, text| form::bare(&text, |_| false),
        },
    ],
    single: Float { name: "f32", literal: shader::literal, tiny: "1e-15" },
    half: Some(Float { name: "f16", literal: shader::half_literal, tiny: "1e-15" }),
    types: Types {
        vector: |of, n| format!("vec{n}<{of}>"),
        matrix: |of| format!("mat3x3<{of}>"),
        array: |of, n| format!("array<{of}, {n}>"),
    },
    arrays: &[Arrays::Value, Arrays::Vec4, Arrays::Memory],
    structure: |name, of| format!("struct {name} {{ at: {} }}", of.text),
    parameter: |name, of, _| format!("{name}: {}", of.text),
    result: |of| of.text.clone(),
    nothing: "",
    component: shader::component,
    brackets: shader::constructor,
    columns: false,
    trailing_comma: false,
    vector_operators: true,
    multiply_add: MultiplyAdd::Infix,
    spelling: |op| shader::spelling(op, "inverseSqrt", select),
    statements: Statements {
        int: "i32",
        declare: |_, name, mutable| format!("{} {name}", if mutable { "var" } else { "let" }),
        variable: |of, name| format!("var {name}: {};", of.text),
        each: |name, from, to, step| format!("for (var {name} = {from}; {name} < {to}; {name} += {step}) {{"),
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
        first: false,
        read: |name, of| format!("fn {name}(place: i32) -> {of} {{ return {of}(); }}"),
        write: |name, of| format!("fn {name}(place: i32, number: {of}) {{}}"),
    }),
    template: zonal_templates::WGSL,
    reserved: &[RESERVED, shader::FUNCTIONS],
    refuses: |_| None,
    renames_digits: true,
    check,
};

/// Keywords and reserved words, and the predeclared types whose names end in a letter, from the specification of WGSL.
const RESERVED: Words = Words {
    what: "reserved in WGSL",
    words: "NULL Self abstract active alias alignas alignof array as asm asm_fragment async atomic attribute auto \
        await become binding_array bitcast bool break case cast catch class co_await co_return co_yield coherent \
        column_major common compile compile_fragment concept const const_assert const_cast consteval constexpr constinit \
        continue continuing crate debugger decltype default delete demote demote_to_helper diagnostic discard do \
        dynamic_cast else enable enum explicit export extends extern external fallthrough false filter final finally fn \
        for friend from fxgroup get goto groupshared highp if impl implements import inline instanceof interface layout \
        let loop lowp macro macro_rules match mediump meta mod module move mut mutable namespace new nil noexcept noinline \
        nointerpolation non_coherent noncoherent noperspective null nullptr of operator override package packoffset \
        partial partition pass patch pixelfragment precise precision premerge priv protected ptr pub public readonly ref regardless \
        register reinterpret_cast require requires resource restrict return self set shared sizeof smooth snorm static \
        static_assert static_cast std struct subroutine super switch target template this thread_local throw trait true \
        try type typedef typeid typename typeof union unless unorm unsafe unsized use using var varying virtual volatile \
        wgsl where while with writeonly yield",
};

fn select(x: &[Text], _: &str) -> String {
    format!("select({}, {}, {} < {})", x[3].text, x[2].text, x[0].text, x[1].text)
}

fn table(name: &str, of: &Type) -> (String, &'static str) {
    (format!("const {name} = {}(", of.text), ");")
}

#[cfg(feature = "check")]
fn check(text: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    shader::validate(&module, text)
}
