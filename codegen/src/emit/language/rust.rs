//! Rust, generic over the numbers of parameters and of the signal.

use crate::emit::language::expression::{Binding, Text};
#[cfg(not(feature = "check"))]
use crate::emit::language::record::unchecked as check;
use crate::emit::language::record::{
    Arrays, Float, Generic, Language, MultiplyAdd, Spelling, Statements, TableNumbers, Type, Types, Way, Words,
};
use crate::ir::kernel::Shape;
use crate::ir::op::Op;
use crate::math::exact::Exact;

/// Rust, generic over the scalar and the signal.
pub static RUST: Language = Language {
    name: "rust",
    title: "Rust",
    extension: "rs",
    forms: &[],
    single: Float { name: "T", literal, tiny: "T::TINY" },
    half: None,
    types: Types { vector: array, matrix: |of| array(&array(of, 3), 3), array },
    arrays: &[Arrays::Value, Arrays::Sink],
    structure: |name, of| format!("pub struct {name} {{ pub at: {} }}", of.text),
    parameter,
    result: |of| of.text.clone(),
    nothing: "()",
    component: |place| ["[0]", "[1]", "[2]", "[3]"][place],
    brackets: |_| ("[".to_owned(), "]"),
    columns: true,
    trailing_comma: true,
    vector_operators: true,
    multiply_add: MultiplyAdd::Methods,
    spelling,
    statements: Statements {
        int: "usize",
        declare: |_, name, mutable| format!("let {}{name}", if mutable { "mut " } else { "" }),
        variable: |of, name| match of.length {
            Some(n) => format!("let mut {name} = [{}::zero(); {n}];", of.item),
            None => format!("let mut {name} = {}::zero();", of.text),
        },
        each: |name, from, to, step| match step {
            1 => format!("for {name} in {from}..{to} {{"),
            _ => format!("for {name} in ({from}..{to}).step_by({step}) {{"),
        },
        at_most: |a, b| format!("if ({a}).at_most({b}) {{"),
        tail: true,
    },
    // A constant would be copied wherever it is indexed.
    table: |name, of| (format!("#[allow(clippy::approx_constant)]\nstatic {name}: {} = [", of.text), "];"),
    constant: |name, of| (format!("pub const {name}: {} = [", of.text), "];"),
    doc: "///",
    max_statements: usize::MAX,
    max_table: usize::MAX,
    // rustc's stack does not take thousands of nested bindings.
    chunk: Some(400),
    generic: Some(Generic {
        numbers: ["T", "V"],
        bounds: ["<T: Real>", "<T: Real, V: Signal<T>>"],
        arguments: ["::<T>", "::<T, V>"],
        table: TableNumbers {
            number: "f64",
            literal: |value| format!("{:?}", value.to_f64()),
            convert: |item| format!("T::lit({item})"),
        },
        constant: "f32",
        channels: "[T; 3]",
        source: |name, of| format!("{name}: &impl Fn(usize) -> {of}"),
        sink: |name, of| format!("{name}: &mut impl FnMut(usize, {of})"),
    }),
    memory: None,
    template: zonal_templates::RUST,
    reserved: &[RESERVED],
    refuses: |_| None,
    renames_digits: false,
    check,
};

/// Keywords and reserved words, from the Rust reference.
const RESERVED: Words = Words {
    what: "reserved in Rust",
    words: "Self abstract as async await become box break const continue crate do dyn else enum extern false \
        final fn for gen if impl in let loop macro match mod move mut override priv pub ref return self static struct \
        super trait true try type typeof unsafe unsized use virtual where while yield",
};

fn array(of: &str, n: usize) -> String {
    format!("[{of}; {n}]")
}

/// Arrays of arrays and of signals are taken by reference.
fn parameter(name: &str, of: &Type, way: Way) -> String {
    match (way, of.shape) {
        (Way::Out, _) => format!("{name}: &mut {}", of.text),
        (Way::In, Shape::Array(_) | Shape::Pairs(_) | Shape::Mat3) => format!("{name}: &{}", of.text),
        (Way::In, _) => format!("{name}: {}", of.text),
    }
}

/// The nearest f64; both roundings where the f64 would not round to the nearest f32.
fn literal(value: &Exact) -> String {
    let (wide, narrow) = (value.to_f64(), value.to_f32());
    match wide as f32 == narrow {
        true => format!("T::lit({wide:?})"),
        false => format!("T::lit2({narrow:?}, {wide:?})"),
    }
}

fn spelling(op: &Op<()>) -> Spelling {
    match op {
        Op::Neg(_) | Op::Add(..) | Op::Sub(..) | Op::Mul(..) | Op::Fma(..) => Spelling::Infix,
        Op::Recip(_) => Spelling::Call("T::recip"),
        Op::Rsqrt(_) => Spelling::Call("T::rsqrt"),
        Op::Sqrt(_) => Spelling::Call("T::root"),
        Op::Exp2(_) => Spelling::Call("T::exp2"),
        Op::Log2(_) => Spelling::Call("T::log2"),
        Op::Abs(_) => Spelling::Call("T::abs"),
        Op::Min(..) => Spelling::Call("T::min"),
        Op::Max(..) => Spelling::Call("T::max"),
        Op::Select(..) => Spelling::Own(select, Binding::Atom),
    }
}

fn select(x: &[Text], of: &str) -> String {
    format!("{of}::choose({}, {}, {}, {})", x[0].text, x[1].text, x[2].text, x[3].text)
}

#[cfg(feature = "check")]
fn check(text: &str) -> Result<(), String> {
    syn::parse_file(text).map(|_| ()).map_err(|error| {
        let start = error.span().start();
        format!("{error} at line {}, column {}", start.line, start.column + 1)
    })
}
