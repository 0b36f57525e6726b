//! A language as one function is printed in it: how many channels its signal has, how wide its numbers are and how
//! arrays are passed. Types, components and values follow from the language's record.

use crate::emit::language::expression::Text;
use crate::emit::language::record::{Float, ITEMS, Numbers, Type, Types, Way};
use crate::emit::language::{Arrays, Target};
use crate::ir::graph::Kind;
use crate::ir::kernel::{Param, Shape};
use crate::ir::op::Op;
use crate::math::exact::Exact;

/// A language and what the text of one function depends on besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dialect {
    /// The language.
    pub language: Target,
    /// Whether the signal is a vector of three, in a language that is not generic over it.
    pub rgb: bool,
    /// Whether numbers are f16.
    pub half: bool,
    /// How arrays are passed.
    pub arrays: Arrays,
}

/// A value as its text is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Laid {
    /// What stands before the items.
    pub open: String,
    /// The items, as many in a line as belong together.
    pub lines: Vec<String>,
    /// What stands after them.
    pub close: &'static str,
}

/// A place so many numbers behind another one.
fn placed(name: &str, index: usize) -> String {
    if index == 0 { name.to_owned() } else { format!("{name} + {index}") }
}

impl Dialect {
    /// Returns a language with a signal of one channel and numbers of f32, its arrays passed as it does by itself.
    pub fn new(language: Target) -> Self {
        let arrays = language.arrays.first().copied().unwrap_or_default();
        Self { language, rgb: false, half: false, arrays }
    }

    fn float(self) -> Float {
        self.language.half.filter(|_| self.half).unwrap_or(self.language.single)
    }

    /// Returns what numbers are called.
    pub fn numbers(self) -> Numbers {
        if let Some(generic) = &self.language.generic {
            let [scalar, signal] = generic.numbers.map(str::to_owned);
            return Numbers { scalar, signal };
        }
        let scalar = self.float().name;
        let signal = if self.rgb { (self.language.types.vector)(scalar, 3) } else { scalar.to_owned() };
        Numbers { scalar: scalar.to_owned(), signal }
    }

    /// Returns the type of one number of this kind.
    pub fn number(self, kind: Kind) -> String {
        self.numbers().of(kind).to_owned()
    }

    /// Returns an operation as text, its operands in their order.
    pub fn operation(self, op: Op<Text>) -> Text {
        self.language.operation(op, &self.numbers())
    }

    /// Returns the type of a value inside a function.
    pub fn type_of(self, shape: Shape, kind: Kind) -> Type {
        self.language.type_of(&self.numbers(), shape, kind)
    }

    /// Returns the type of a parameter or a result, a struct perhaps that holds an array.
    pub fn passed(self, shape: Shape, kind: Kind) -> Type {
        let of = self.type_of(shape, kind);
        if let Some(length) = of.length.filter(|_| self.arrays == Arrays::Vec4) {
            let Types { vector, array, .. } = self.language.types;
            let item = vector(&self.numbers().scalar, 4);
            return Type { text: array(&item, length), item, ..of };
        }
        match self.structure(&of) {
            Some(name) => Type { shape, item: name.clone(), length: None, text: name },
            None => of,
        }
    }

    /// Returns the name of the struct that a value is passed in, if it is: it says how many items of which type.
    pub fn structure(self, of: &Type) -> Option<String> {
        let item = || of.item.chars().filter(char::is_ascii_alphanumeric).collect::<String>();
        let length = of.length.filter(|_| self.arrays == Arrays::Struct)?;
        Some(format!("zonal_{length}_{}s", item()))
    }

    /// Returns the declaration of the struct that a value is passed in, if it is.
    pub fn declaration(self, shape: Shape, kind: Kind) -> Option<String> {
        let of = self.type_of(shape, kind);
        self.structure(&of).map(|name| (self.language.structure)(&name, &of))
    }

    /// Returns whether a result of this shape is written to a parameter.
    pub fn is_written(self, shape: Shape) -> bool {
        self.arrays == Arrays::Reference && shape.is_array() || self.is_handed_over(shape)
    }

    /// Returns whether a result of this shape is handed to a function, number by number.
    pub fn is_handed_over(self, shape: Shape) -> bool {
        self.arrays == Arrays::Sink && matches!(shape, Shape::Array(_)) || self.is_place(shape)
    }

    /// Returns whether a value is asked of a function, number by number.
    pub fn is_asked_for(self, shape: Shape, kind: Kind) -> bool {
        self.is_place(shape) || self.is_handed_over(shape) && !kind.is_scalar()
    }

    /// Returns whether a value of this shape is a place in a memory of the user's.
    pub fn is_place(self, shape: Shape) -> bool {
        self.arrays == Arrays::Memory && shape.is_array()
    }

    /// Returns the type of a place.
    fn place(self) -> Type {
        let int = self.language.statements.int.to_owned();
        Type { shape: Shape::Scalar, item: int.clone(), length: None, text: int }
    }

    /// Returns the name of the function of the user's that reads or writes a number of a kind.
    pub fn accessor(self, does: &str, kind: Kind) -> String {
        format!("zonal_{does}_{}", self.number(kind).replace(|c: char| !c.is_ascii_alphanumeric(), ""))
    }

    /// Returns the statement that hands over a number of the result.
    pub fn hand_over(self, name: &str, shape: Shape, kind: Kind, place: usize, number: &str) -> String {
        match self.is_place(shape) {
            true => format!("{}({}, {number});", self.accessor("write", kind), placed(name, place)),
            false => format!("{name}({place}, {number});"),
        }
    }

    /// Returns a parameter in a signature.
    pub fn parameter(self, param: &Param) -> String {
        if let Some(generic) = self.language.generic.as_ref().filter(|_| self.is_asked_for(param.shape, param.kind)) {
            return (generic.source)(param.name, &self.number(param.kind));
        }
        let of = if self.is_place(param.shape) { self.place() } else { self.passed(param.shape, param.kind) };
        (self.language.parameter)(param.name, &of, Way::In)
    }

    /// Returns the parameter that a result is written to.
    pub fn output(self, name: &str, shape: Shape, kind: Kind) -> String {
        if let Some(generic) = self.language.generic.as_ref().filter(|_| self.is_handed_over(shape)) {
            return (generic.sink)(name, &self.number(kind));
        }
        if self.is_place(shape) {
            return (self.language.parameter)(name, &self.place(), Way::In);
        }
        (self.language.parameter)(name, &self.passed(shape, kind), Way::Out)
    }

    /// Returns what is indexed of a parameter or a result.
    pub fn items(self, name: &str, shape: Shape) -> String {
        match self.arrays == Arrays::Struct && shape.is_array() {
            true => format!("{name}.{ITEMS}"),
            false => name.to_owned(),
        }
    }

    /// Returns what stands behind an item of an array of numbers of this kind where the item is more than the number.
    pub fn within(self, kind: Kind) -> &'static str {
        match (self.arrays == Arrays::Vec4, self.rgb && !kind.is_scalar()) {
            (false, _) => "",
            (true, false) => (self.language.component)(0),
            (true, true) => ".xyz",
        }
    }

    /// Returns component `index`, in flat order, of a parameter or a result whose numbers are of a kind.
    pub fn component(self, name: &str, shape: Shape, kind: Kind, index: usize) -> String {
        if self.is_place(shape) {
            // A pair is two numbers, and a vector three.
            return format!("{}({})", self.accessor("read", kind), placed(name, index));
        }
        let name = self.items(name, shape);
        let of = |size: usize| format!("{name}[{}]{}", index / size, (self.language.component)(index % size));
        match shape {
            Shape::Scalar => name,
            Shape::Vec3 | Shape::Vec4 | Shape::Pair => format!("{name}{}", (self.language.component)(index)),
            Shape::Mat3 | Shape::Vectors(_) => of(3),
            Shape::Pairs(_) => of(2),
            Shape::Array(_) if self.is_asked_for(shape, kind) => format!("{name}({index})"),
            Shape::Array(_) => format!("{name}[{index}]{}", self.within(kind)),
        }
    }

    /// Returns the numbers of a value grouped as the items of its type: a pair is one item of an array of pairs.
    pub fn grouped(self, shape: Shape, kind: Kind, numbers: &[String]) -> Vec<String> {
        let part = match shape {
            Shape::Pairs(_) => Some(Shape::Pair),
            Shape::Vectors(_) => Some(Shape::Vec3),
            _ => None,
        };
        let part = part.map(|part| (part.len(), (self.language.brackets)(&self.type_of(part, kind).text)));
        let column = || (self.language.brackets)(&self.type_of(Shape::Vec3, kind).text);
        let (size, brackets) = match (part, shape) {
            (Some((size, brackets)), _) => (size, Some(brackets)),
            (None, Shape::Mat3) => (3, self.language.columns.then(column)),
            (None, _) => (1, None),
        };
        if self.arrays == Arrays::Vec4 && shape.is_array() {
            return numbers.chunks(size).map(|group| self.padded(kind, group)).collect();
        }
        let (open, close) = brackets.unwrap_or_default();
        numbers.chunks(size).map(|group| format!("{open}{}{close}", group.join(", "))).collect()
    }

    /// Returns numbers of a kind as a vector of four, with zeros behind them.
    pub fn padded(self, kind: Kind, numbers: &[String]) -> String {
        let channels = if self.rgb && !kind.is_scalar() { 3 } else { 1 };
        let (open, close) = (self.language.brackets)(&(self.language.types.vector)(&self.numbers().scalar, 4));
        let zeros = ", 0.0".repeat(4 - channels * numbers.len());
        format!("{open}{}{zeros}{close}", numbers.join(", "))
    }

    /// Returns a value as it is passed, but for a struct around it, laid out; nothing for a single number.
    pub fn laid(self, shape: Shape, kind: Kind, numbers: &[String]) -> Option<Laid> {
        if shape == Shape::Scalar {
            return None;
        }
        let of = if self.arrays == Arrays::Vec4 { self.passed(shape, kind) } else { self.type_of(shape, kind) };
        let (open, close) = (self.language.brackets)(&of.text);
        let mut lines = self.grouped(shape, kind, numbers);
        let last = lines.len() - 1;
        for (i, line) in lines.iter_mut().enumerate() {
            if i < last || self.language.trailing_comma {
                line.push(',');
            }
        }
        Some(Laid { open, lines, close })
    }

    /// Returns a value as an argument, in one line.
    pub fn argument(self, shape: Shape, kind: Kind, numbers: &[String]) -> String {
        let value = match self.laid(shape, kind, numbers) {
            Some(Laid { open, lines, close }) => format!("{open}{}{close}", lines.join(" ")),
            None => numbers.concat(),
        };
        match self.structure(&self.type_of(shape, kind)) {
            Some(name) => {
                let (open, close) = (self.language.brackets)(&name);
                format!("{open}{value}{close}")
            }
            None => value,
        }
    }

    /// Returns a positive or negative constant.
    pub fn literal(self, value: &Exact) -> String {
        (self.float().literal)(value)
    }

    /// Returns zero, as a number of a kind.
    pub fn zero(self, kind: Kind) -> String {
        let (of, literal) = (self.number(kind), self.literal(&Exact::zero()));
        if kind.is_scalar() {
            return literal;
        }
        if self.language.generic.is_some() {
            return format!("{of}::zero()");
        }
        let (open, close) = (self.language.brackets)(&of);
        if self.rgb { format!("{open}{}{close}", [&literal[..]; 3].join(", ")) } else { literal }
    }

    /// Returns the constant that is too small to change anything but a zero.
    pub fn tiny(self) -> &'static str {
        self.float().tiny
    }
}
