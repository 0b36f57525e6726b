//! What a language is, as data: a record of words, texts and small functions from which everything else prints. A new
//! language is one such record in one file and a row in [`super::ALL`]; nothing else of the generator asks which language
//! it prints.

use crate::emit::language::expression::{Binding, Text};
use crate::emit::language::form::Form;
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::op::{Op, Sign};
use crate::math::exact::Exact;
use std::fmt;

/// A language that kernels are printed in.
pub struct Language {
    /// Its name in specs of what to print, which is the name of its folder too.
    pub name: &'static str,
    /// Its name in sentences.
    pub title: &'static str,
    /// The extension of its files.
    pub extension: &'static str,
    /// The forms that its files can have besides their own.
    pub forms: &'static [Form],
    /// The floating-point numbers that stand for f32.
    pub single: Float,
    /// The floating-point numbers that stand for f16, if it has them.
    pub half: Option<Float>,
    /// The types that are made of numbers.
    pub types: Types,
    /// How arrays can be passed; the first is what is done if nothing else is asked for.
    pub arrays: &'static [Arrays],
    /// A struct of this name that holds one array called [`ITEMS`], declared once however often it stands in a file.
    pub structure: fn(name: &str, of: &Type) -> String,
    /// A parameter in a signature.
    pub parameter: fn(name: &str, of: &Type, way: Way) -> String,
    /// The type of a result in a signature.
    pub result: fn(&Type) -> String,
    /// The type of a function that returns nothing.
    pub nothing: &'static str,
    /// A component of a vector, by its place.
    pub component: fn(usize) -> &'static str,
    /// What stands before and after the items of a value of a type.
    pub brackets: fn(&str) -> (String, &'static str),
    /// Whether a matrix is made of columns in brackets of their own; else of numbers.
    pub columns: bool,
    /// Whether a comma stands after the last item of a value.
    pub trailing_comma: bool,
    /// Whether vectors are added and multiplied with operators: where they are not, no signal has three channels.
    pub vector_operators: bool,
    /// How a product and a sum are written as one operation.
    pub multiply_add: MultiplyAdd,
    /// How an operation is written.
    pub spelling: fn(&Op<()>) -> Spelling,
    /// The statements.
    pub statements: Statements,
    /// What stands before and after the values of a kernel's table.
    pub table: fn(name: &str, of: &Type) -> (String, &'static str),
    /// What stands before and after the values of a constant that others may use.
    pub constant: fn(name: &str, of: &Type) -> (String, &'static str),
    /// What begins a comment above an item.
    pub doc: &'static str,
    /// The most statements of a function that its compilers take in a second or two.
    pub max_statements: usize,
    /// The most values of a table that its compilers take.
    pub max_table: usize,
    /// The most lines of a function; a longer one is cut into parts, which only a language with [`Generic`] can be.
    pub chunk: Option<usize>,
    /// What a language needs whose functions are generic over their numbers.
    pub generic: Option<Generic>,
    /// The functions that read and write a memory of the user's, in a language that passes arrays as places there.
    pub memory: Option<Memory>,
    /// The template of a file, or of a module's items in a language with [`Generic`].
    pub template: &'static str,
    /// The words that no name may be.
    pub reserved: &'static [Words],
    /// Why a name is refused and what to do, for what no list of words can say.
    pub refuses: fn(&str) -> Option<(&'static str, &'static str)>,
    /// Whether what reads it renames a function whose name ends in a digit, as naga does.
    pub renames_digits: bool,
    /// Parses and checks a file: what is wrong with it, with its place. Nothing is without the feature `check`.
    pub check: fn(&str) -> Result<(), String>,
}

/// Accepts every text: what stands for a language's checker where this crate is built without its feature `check`.
#[cfg(not(feature = "check"))]
pub(super) fn unchecked(_: &str) -> Result<(), String> {
    Ok(())
}

/// What the one item of a struct is called that holds an array.
pub const ITEMS: &str = "at";

impl Language {
    /// Returns the form of this name.
    pub fn form(&self, name: &str) -> Option<&'static Form> {
        self.forms.iter().find(|form| form.name == name)
    }
}

impl PartialEq for Language {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Language {}

impl fmt::Debug for Language {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl fmt::Display for Language {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// A floating-point type.
#[derive(Clone, Copy, Debug)]
pub struct Float {
    /// Its name.
    pub name: &'static str,
    /// A constant.
    pub literal: fn(&Exact) -> String,
    /// The constant that is too small to change anything but a zero.
    pub tiny: &'static str,
}

/// The types that are made of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Types {
    /// A vector of so many numbers of a type.
    pub vector: fn(&str, usize) -> String,
    /// Three columns of three numbers of a type.
    pub matrix: fn(&str) -> String,
    /// So many items of a type.
    pub array: fn(&str, usize) -> String,
}

/// The names of the two kinds of numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbers {
    /// One number.
    pub scalar: String,
    /// One number a channel.
    pub signal: String,
}

impl Numbers {
    /// Returns the name of a number of this kind.
    pub fn of(&self, kind: Kind) -> &str {
        if kind.is_scalar() { &self.scalar } else { &self.signal }
    }
}

/// The type of a parameter, a result or a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Type {
    /// Its shape.
    pub shape: Shape,
    /// Its name without the length of an array: of a pair, a vector.
    pub item: String,
    /// How many items it has, if it is an array.
    pub length: Option<usize>,
    /// Its whole name.
    pub text: String,
}

impl Type {
    /// Returns whether it is a struct that holds an array.
    pub fn is_struct(&self) -> bool {
        self.length.is_none() && self.shape.is_array()
    }
}

/// How arrays are passed to a function and how its result comes back if it is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrays {
    /// As a value.
    #[default]
    Value,
    /// As a struct that holds it.
    Struct,
    /// By reference: the result is what is written to a last parameter.
    Reference,
    /// As a value whose items are vectors of four, an item at the head of each and zeros behind it: as uniform buffers hold
    /// them.
    Vec4,
    /// Number by number: a signal is a function of the index, and a number of the result is handed to a function as soon as
    /// it is known, so that fewer live at once and nothing says where numbers lie. What the signal's function gave for an
    /// index is not asked for again after the result of that index, so that both may be one place.
    Sink,
    /// As places in a memory of the user's, where [`Memory`] reads and writes numbers: what a function takes is read where it
    /// is used, and a number of the result is written as soon as it is known, so that an array takes no registers. A signal and
    /// the result may be one place; other arrays, which may be read several times, lie elsewhere.
    Memory,
}

impl Arrays {
    /// All of them, each with its name.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Value, "value"),
        (Self::Struct, "struct"),
        (Self::Reference, "reference"),
        (Self::Vec4, "vec4"),
        (Self::Sink, "sink"),
        (Self::Memory, "memory"),
    ];

    /// Returns its name.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(arrays, _)| *arrays == self).map_or("", |(_, name)| name)
    }

    /// Returns the way of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, known)| *known == name).map(|(arrays, _)| arrays)
    }
}

/// Which way a parameter goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Into the function.
    In,
    /// Out of the function.
    Out,
}

/// How a product and a sum are written as one operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultiplyAdd {
    /// As a product and a sum, which compilers contract.
    Infix,
    /// As a method of the signal, so that its type decides: `fma`, `fms` and `fnma`. A product of two signals is the method
    /// `times`, its sums are `times_fma` and so on.
    Methods,
    /// As a function of this name, of two factors and a summand.
    Call(&'static str),
}

/// How an operation is written.
#[derive(Clone, Copy, Debug)]
pub enum Spelling {
    /// With its operator.
    Infix,
    /// As a function of its operands.
    Call(&'static str),
    /// In its own way, which may depend on the type of its value.
    Own(fn(&[Text], of: &str) -> String, Binding),
}

/// The statements.
#[derive(Clone, Copy, Debug)]
pub struct Statements {
    /// The type of whole numbers.
    pub int: &'static str,
    /// What stands before ` = ` where a value of a type is named; whether it will change.
    pub declare: fn(of: &str, name: &str, mutable: bool) -> String,
    /// Declares a variable whose value comes later.
    pub variable: fn(of: &Type, name: &str) -> String,
    /// The line that opens a loop.
    pub each: fn(name: &str, from: &str, to: &str, step: usize) -> String,
    /// The line that opens what is done where one number is at most another.
    pub at_most: fn(a: &str, b: &str) -> String,
    /// Whether the last expression of a function is its result, without a `return`.
    pub tail: bool,
}

/// The numbers of a table in a language whose functions are generic over theirs.
#[derive(Clone, Copy, Debug)]
pub struct TableNumbers {
    /// Their type.
    pub number: &'static str,
    /// One of them.
    pub literal: fn(&Exact) -> String,
    /// How one becomes a number of a kernel.
    pub convert: fn(&str) -> String,
}

/// What a language needs whose functions are generic over their numbers.
#[derive(Clone, Copy, Debug)]
pub struct Generic {
    /// The names of a number and of a number of a signal.
    pub numbers: [&'static str; 2],
    /// What stands behind the name of a function without a signal, and of one with a signal.
    pub bounds: [&'static str; 2],
    /// What stands behind the name of each in a call.
    pub arguments: [&'static str; 2],
    /// The numbers of its tables.
    pub table: TableNumbers,
    /// The type of the numbers in a constant.
    pub constant: &'static str,
    /// An array of a number of each channel as a number of a signal; the number of channels is three.
    pub channels: &'static str,
    /// A parameter that is a function from an index to a number of this type.
    pub source: fn(name: &str, of: &str) -> String,
    /// A parameter that is a function which takes an index and a number of this type.
    pub sink: fn(name: &str, of: &str) -> String,
}

/// The functions by which a kernel reads and writes a memory of the user's, where arrays are places there: the user writes
/// them. A place is a whole number and counts numbers, or numbers of a signal.
#[derive(Clone, Copy, Debug)]
pub struct Memory {
    /// Whether they have to stand before what calls them.
    pub first: bool,
    /// One that reads a number of this type, so that a text can be checked without the user's.
    pub read: fn(name: &str, of: &str) -> String,
    /// One that writes a number of this type.
    pub write: fn(name: &str, of: &str) -> String,
}

/// Words that no name may be.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// What they are, as in `reserved in …`.
    pub what: &'static str,
    /// The words, with spaces between them.
    pub words: &'static str,
}

impl Language {
    /// Returns the type of a value.
    pub fn type_of(&self, numbers: &Numbers, shape: Shape, kind: Kind) -> Type {
        let Types { vector, matrix, array } = self.types;
        // A shader's signal may be a vector already; what is no array of a signal is made of scalars there.
        let of = if self.generic.is_some() { numbers.of(kind) } else { &numbers.scalar };
        let (item, length) = match shape {
            Shape::Scalar => (numbers.of(kind).to_owned(), None),
            Shape::Vec3 => (vector(of, 3), None),
            Shape::Vec4 => (vector(of, 4), None),
            Shape::Mat3 => (matrix(of), None),
            Shape::Pair => (vector(of, 2), None),
            Shape::Pairs(n) => (vector(of, 2), Some(n)),
            Shape::Array(n) => (numbers.of(kind).to_owned(), Some(n)),
            Shape::Vectors(n) => (vector(of, 3), Some(n)),
        };
        let text = length.map_or_else(|| item.clone(), |n| array(&item, n));
        Type { shape, item, length, text }
    }

    /// Returns an operation as text, its operands in their order, where numbers have these names.
    ///
    /// # Panics
    ///
    /// If the operation does not take operands of their kinds.
    pub fn operation(&self, op: Op<Text>, numbers: &Numbers) -> Text {
        let kind = op.each().map(|text| text.kind).kind().unwrap_or_else(|fault| panic!("{fault}"));
        let methods = self.multiply_add == MultiplyAdd::Methods;
        let of_signals = |b: &Text| !b.kind.is_scalar();
        let product = |a: Text, b: Text| match methods && of_signals(&b) {
            true => method("times", &[a, b], Kind::Product),
            false => Text::infix(&a, "*", &b),
        };
        match op {
            Op::Neg(a) => Text { text: format!("-{}", a.at_least(Binding::Atom)), binding: Binding::Product, kind },
            Op::Add(a, b) => Text::infix(&a, "+", &b),
            Op::Sub(a, b) => Text::infix(&a, "-", &b),
            Op::Mul(a, b) => Text { kind, ..product(a, b) },
            Op::Fma(a, b, c, sign) if methods => {
                let name = match (of_signals(&b), sign) {
                    (false, Sign::Plus) => "fma",
                    (false, Sign::MinusAddend) => "fms",
                    (false, Sign::MinusProduct) => "fnma",
                    (true, Sign::Plus) => "times_fma",
                    (true, Sign::MinusAddend) => "times_fms",
                    (true, Sign::MinusProduct) => "times_fnma",
                };
                method(name, &[a, b, c], kind)
            }
            Op::Fma(a, b, c, sign) if let MultiplyAdd::Call(name) = self.multiply_add => {
                let [a, c] = match sign {
                    Sign::Plus => [a, c],
                    Sign::MinusAddend => [a, self.operation(Op::Neg(c), numbers)],
                    Sign::MinusProduct => [self.operation(Op::Neg(a), numbers), c],
                };
                Text::atom(format!("{name}({})", listed(&[a, b, c])), kind)
            }
            Op::Fma(a, b, c, sign) => {
                let product = Text { kind, ..product(a, b) };
                match sign {
                    Sign::Plus => Text::infix(&c, "+", &product),
                    Sign::MinusAddend => Text::infix(&product, "-", &c),
                    Sign::MinusProduct => Text::infix(&c, "-", &product),
                }
            }
            named => {
                let spelling = (self.spelling)(&named.each().map(|_| ()));
                let operands = named.into_operands();
                match spelling {
                    Spelling::Call(name) => Text::atom(format!("{name}({})", listed(&operands)), kind),
                    Spelling::Own(print, binding) => Text { text: print(&operands, numbers.of(kind)), binding, kind },
                    Spelling::Infix => unreachable!("what has an operator is printed above"),
                }
            }
        }
    }
}

fn listed(operands: &[Text]) -> String {
    operands.iter().map(|operand| operand.text.as_str()).collect::<Vec<_>>().join(", ")
}

fn method(name: &str, operands: &[Text], kind: Kind) -> Text {
    Text::atom(format!("{}.{name}({})", operands[0].at_least(Binding::Atom), listed(&operands[1..])), kind)
}
