//! Loops, the second, equal form of a kernel: tables and a few statements over them, for orders at which straight lines
//! are too long. The interpreter here runs a loop kernel and counts its operations; it knows nothing of text.

use crate::eval::{Contraction, Number};
use crate::graph::Kind;
use crate::kernel::{Param, Shape};
use crate::listing::{Cost, Sign};
use crate::sh::exact::Exact;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops;

/// What a parameter, a table, an array or a value is called. A name has one meaning in a kernel, and its kind is the
/// same wherever it is declared again.
pub type Name = &'static str;

/// An operation on whole numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntOp {
    /// a + b.
    Add,
    /// a − b, which is never negative.
    Sub,
    /// a · b.
    Mul,
    /// a / b without its rest.
    Div,
    /// The rest of a / b.
    Rem,
}

/// A whole number, never negative; arithmetic on it is free.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Int {
    /// A number.
    Literal(usize),
    /// A loop's variable, a named number or a counter.
    Name(Name),
    /// An operation on two numbers.
    Op(IntOp, Box<[Int; 2]>),
}

/// An operation on floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumOp {
    /// −a.
    Neg,
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a · b; a signal comes first.
    Mul,
    /// a · b and c, signed as said; a signal comes first in the product.
    Fma(Sign),
    /// 1 / a.
    Recip,
    /// 1 / √a.
    Rsqrt,
}

/// A float.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Num {
    /// A constant.
    Const(Exact),
    /// The smallest number that matters; see [`crate::graph::Node::Tiny`].
    Tiny,
    /// A value or a parameter that is one number.
    Name(Name),
    /// An item of a parameter, a table or an array; of a vector, at a literal place.
    Item(Name, Int),
    /// An operation on one to three floats.
    Op(NumOp, Vec<Num>),
}

/// A statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stmt {
    /// Names a whole number.
    Int(Name, Int),
    /// Starts a counter.
    Counter(Name, Int),
    /// Raises a counter by one.
    Advance(Name),
    /// Names a float.
    Let(Name, Num),
    /// Declares a float that changes.
    Var(Name, Num),
    /// Changes one.
    Set(Name, Num),
    /// Declares an array of a length; what it holds before it is stored has no meaning.
    Array(Name, usize, Kind),
    /// Stores an item of an array.
    Store(Name, Int, Num),
    /// Repeats.
    For {
        /// The variable.
        name: Name,
        /// Its first value.
        from: Int,
        /// Above its last value.
        to: Int,
        /// What it grows by.
        step: usize,
        /// What is done for each value.
        body: Vec<Stmt>,
    },
}

/// A constant array of numbers.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name, in capitals.
    pub name: Name,
    /// Its values.
    pub values: Vec<Exact>,
    /// What it holds, in one line or more.
    pub doc: String,
}

/// A kernel as a loop.
#[derive(Clone, Debug)]
pub struct LoopKernel {
    /// The parameters, in order.
    pub params: Vec<Param>,
    /// The tables.
    pub tables: Vec<Table>,
    /// The statements.
    pub body: Vec<Stmt>,
    /// The array that holds the result at the end.
    pub output: Name,
    /// The shape of the result.
    pub result: Shape,
    /// Whether the result is linear in the signal.
    pub result_kind: Kind,
    /// What the result holds.
    pub result_doc: String,
}

impl Int {
    fn op(op: IntOp, a: Self, b: Self) -> Self {
        match (op, &a, &b) {
            (_, &Self::Literal(a), &Self::Literal(b)) => Self::Literal(op.of(a, b)),
            (IntOp::Add | IntOp::Sub, _, Self::Literal(0)) => a,
            _ => Self::Op(op, Box::new([a, b])),
        }
    }
}

impl IntOp {
    fn of(self, a: usize, b: usize) -> usize {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Rem => a % b,
        }
    }
}

impl Num {
    /// An item of a parameter, a table or an array.
    pub fn item(name: Name, index: impl Into<Int>) -> Self {
        Self::Item(name, index.into())
    }

    /// 1 / √self.
    #[must_use]
    pub fn rsqrt(self) -> Self {
        Self::Op(NumOp::Rsqrt, vec![self])
    }

    /// A sum takes a product into one operation, the second one if there are two.
    fn sum(self, other: Self, minus: bool) -> Self {
        let (product_last, product_first, plain) = match minus {
            false => (Sign::Plus, Sign::Plus, NumOp::Add),
            true => (Sign::MinusProduct, Sign::MinusAddend, NumOp::Sub),
        };
        match (self, other) {
            (c, Self::Op(NumOp::Mul, mut ab)) => {
                ab.push(c);
                Self::Op(NumOp::Fma(product_last), ab)
            }
            (Self::Op(NumOp::Mul, mut ab), c) => {
                ab.push(c);
                Self::Op(NumOp::Fma(product_first), ab)
            }
            (a, b) => Self::Op(plain, vec![a, b]),
        }
    }
}

impl ops::Neg for Num {
    type Output = Self;

    fn neg(self) -> Self {
        Self::Op(NumOp::Neg, vec![self])
    }
}

macro_rules! convert {
    ($($of:ident from $from:ty: $make:expr;)*) => { $(
        impl From<$from> for $of {
            fn from(value: $from) -> Self {
                ($make)(value)
            }
        }
    )* };
}

convert! {
    Int from usize: Int::Literal;
    Int from Name: Int::Name;
    Int from &Int: Int::clone;
    Num from Exact: Num::Const;
    Num from Name: Num::Name;
    Num from &Num: Num::clone;
}

macro_rules! operators {
    ($($of:ident $trait:ident $method:ident: $make:expr;)*) => { $(
        impl<R: Into<$of>> ops::$trait<R> for $of {
            type Output = $of;

            fn $method(self, other: R) -> $of {
                ($make)(self, other.into())
            }
        }

        impl<R: Into<$of>> ops::$trait<R> for &$of {
            type Output = $of;

            fn $method(self, other: R) -> $of {
                ($make)(self.clone(), other.into())
            }
        }
    )* };
}

operators! {
    Int Add add: |a, b| Int::op(IntOp::Add, a, b);
    Int Sub sub: |a, b| Int::op(IntOp::Sub, a, b);
    Int Mul mul: |a, b| Int::op(IntOp::Mul, a, b);
    Int Div div: |a, b| Int::op(IntOp::Div, a, b);
    Int Rem rem: |a, b| Int::op(IntOp::Rem, a, b);
    Num Add add: |a: Num, b| a.sum(b, false);
    Num Sub sub: |a: Num, b| a.sum(b, true);
    Num Mul mul: |a, b| Num::Op(NumOp::Mul, vec![a, b]);
}

impl Stmt {
    /// A loop over every whole number from `from` to below `to`.
    pub fn each(name: Name, from: impl Into<Int>, to: impl Into<Int>, body: Vec<Self>) -> Self {
        Self::For { name, from: from.into(), to: to.into(), step: 1, body }
    }

    /// Stores an item of an array.
    pub fn store(array: Name, index: impl Into<Int>, value: impl Into<Num>) -> Self {
        Self::Store(array, index.into(), value.into())
    }
}

impl LoopKernel {
    /// What it costs for a signal of so many channels.
    pub fn cost(&self, channels: usize) -> Cost {
        let blank = |len: usize| vec![0.0f32; len];
        let program = LoopProgram {
            kernel: self.clone(),
            tables: self.tables.iter().map(|table| blank(table.values.len())).collect(),
        };
        let inputs: Vec<Vec<f32>> = self.params.iter().map(|p| blank(p.shape.len())).collect();
        let inputs: Vec<&[f32]> = inputs.iter().map(Vec::as_slice).collect();
        let [scalar, signal] = program.execute(&inputs, Contraction::Separate).counts;
        let of = |count: fn(&Cost) -> usize| count(&scalar) + channels * count(&signal);
        let (mul, add, fma) = (of(|c| c.mul), of(|c| c.add), of(|c| c.fma));
        Cost { mul, add, fma, special: of(|c| c.special), total: mul + add + fma }
    }
}

/// A loop kernel with its tables rounded to `T`.
#[derive(Clone, Debug)]
pub struct LoopProgram<T> {
    kernel: LoopKernel,
    tables: Vec<Vec<T>>,
}

impl<T: Number> LoopProgram<T> {
    /// Rounds the tables of a kernel.
    pub fn new(kernel: &LoopKernel) -> Self {
        let round = |table: &Table| table.values.iter().map(T::nearest).collect();
        Self { kernel: kernel.clone(), tables: kernel.tables.iter().map(round).collect() }
    }

    /// Runs it for one channel. `inputs` holds one slice a parameter, of as many numbers as its shape says; the result
    /// has as many numbers as the kernel's.
    ///
    /// # Panics
    ///
    /// If a slice is shorter than its parameter's shape, or the kernel names what it has not declared, leaves an array
    /// or has a signal as the second factor of a product.
    pub fn run(&self, inputs: &[&[T]], contraction: Contraction) -> Vec<T> {
        self.execute(inputs, contraction).floats[self.kernel.output].1.to_vec()
    }

    fn execute<'a>(&'a self, inputs: &[&'a [T]], contraction: Contraction) -> Machine<'a, T> {
        let kernel = &self.kernel;
        let params = kernel.params.iter().zip(inputs);
        let params = params.map(|(param, &input)| (param.name, (param.kind, Cow::Borrowed(input))));
        let tables = kernel.tables.iter().zip(&self.tables);
        let tables = tables.map(|(table, values)| (table.name, (Kind::Scalar, Cow::Borrowed(&values[..]))));
        let mut machine = Machine {
            contraction,
            ints: HashMap::new(),
            floats: params.chain(tables).collect(),
            counts: [Cost::default(); 2],
        };
        machine.block(&kernel.body);
        machine
    }
}

struct Machine<'a, T: Clone> {
    contraction: Contraction,
    ints: HashMap<Name, usize>,
    floats: HashMap<Name, (Kind, Cow<'a, [T]>)>,
    /// Operations on scalars, then on signals.
    counts: [Cost; 2],
}

impl<T: Number> Machine<'_, T> {
    fn block(&mut self, body: &[Stmt]) {
        for stmt in body {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match stmt {
            Stmt::Int(name, value) | Stmt::Counter(name, value) => {
                self.ints.insert(name, self.int(value));
            }
            Stmt::Advance(name) => {
                self.ints.insert(name, self.ints[name] + 1);
            }
            Stmt::Let(name, value) | Stmt::Var(name, value) | Stmt::Set(name, value) => {
                let (value, kind) = self.num(value);
                self.floats.insert(name, (kind, Cow::Owned(vec![value])));
            }
            Stmt::Array(name, len, kind) => {
                let unknown = vec![T::from_f64(f64::NAN); *len];
                self.floats.insert(name, (*kind, Cow::Owned(unknown)));
            }
            Stmt::Store(name, index, value) => {
                let (index, (value, _)) = (self.int(index), self.num(value));
                let array = self.floats.get_mut(name).expect("the array is declared");
                array.1.to_mut()[index] = value;
            }
            Stmt::For { name, from, to, step, body } => {
                for i in (self.int(from)..self.int(to)).step_by(*step) {
                    self.ints.insert(name, i);
                    self.block(body);
                }
            }
        }
    }

    fn int(&self, value: &Int) -> usize {
        match value {
            Int::Literal(value) => *value,
            Int::Name(name) => self.ints[name],
            Int::Op(op, ab) => op.of(self.int(&ab[0]), self.int(&ab[1])),
        }
    }

    fn item(&self, name: Name, index: usize) -> (T, Kind) {
        let (kind, items) = &self.floats[name];
        (items[index], *kind)
    }

    fn num(&mut self, value: &Num) -> (T, Kind) {
        let (op, args) = match value {
            Num::Const(value) => return (T::nearest(value), Kind::Scalar),
            Num::Tiny => return (T::TINY, Kind::Scalar),
            Num::Name(name) => return self.item(name, 0),
            Num::Item(name, index) => return self.item(name, self.int(index)),
            Num::Op(op, args) => (*op, args),
        };
        let mut values = [(T::ZERO, Kind::Scalar); 3];
        for (value, arg) in values.iter_mut().zip(args) {
            *value = self.num(arg);
        }
        let [(a, _), (b, second), (c, _)] = values;
        let kind = values.iter().map(|(_, kind)| *kind).max().unwrap_or(Kind::Scalar);
        let product = matches!(op, NumOp::Mul | NumOp::Fma(_));
        assert!(!product || second == Kind::Scalar, "a signal is the second factor of {value:?}");
        let count = &mut self.counts[kind as usize];
        match op {
            NumOp::Neg => {}
            NumOp::Add | NumOp::Sub => count.add += 1,
            NumOp::Mul => count.mul += 1,
            NumOp::Fma(_) => count.fma += 1,
            NumOp::Recip | NumOp::Rsqrt => count.special += 1,
        }
        let value = match op {
            NumOp::Neg => -a,
            NumOp::Add => a + b,
            NumOp::Sub => a - b,
            NumOp::Mul => a * b,
            NumOp::Recip => T::ONE / a,
            NumOp::Rsqrt => T::ONE / a.root(),
            NumOp::Fma(sign) => {
                let (a, c) = match sign {
                    Sign::Plus => (a, c),
                    Sign::MinusAddend => (a, -c),
                    Sign::MinusProduct => (-a, c),
                };
                match self.contraction {
                    Contraction::Fused => a.fused(b, c),
                    Contraction::Separate => a * b + c,
                }
            }
        };
        (value, kind)
    }
}
