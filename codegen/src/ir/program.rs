//! Loops, the second, equal form of a kernel: tables and a few statements over them, for orders at which straight lines
//! are too long. A loop is laid out as the operations that it does, one by one: so it is run, counted and proven as
//! straight lines are.

use crate::ir::graph::Kind;
use crate::ir::kernel::{Param, Shape};
use crate::ir::listing::{Listing, Operand, Step};
use crate::ir::op::{Op, Sign, Takes};
use crate::math::exact::Exact;
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

/// A float.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Num {
    /// A constant.
    Const(Exact),
    /// The smallest number that matters; see [`crate::ir::graph::Node::Tiny`].
    Tiny,
    /// A value or a parameter that is one number.
    Name(Name),
    /// An item of a parameter, a table or an array; of a vector, at a literal place.
    Item(Name, Int),
    /// An operation on floats.
    Op(Box<Op<Num>>),
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
    /// So many items of an array from a place on are a stage of a proof; see [`crate::ir::graph::Graph::stage`]. Nothing is
    /// done.
    Stage(Name, Int, Int),
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
    /// Whether the result is linear in the signal, or in each of two.
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

    /// Returns an operation as a float.
    pub fn of(op: Op<Self>) -> Self {
        Self::Op(Box::new(op))
    }

    /// Returns 1 / √self.
    #[must_use]
    pub fn rsqrt(self) -> Self {
        Self::of(Op::Rsqrt(self))
    }

    /// Returns the factors of a product, or the number itself.
    fn factors(self) -> Result<(Self, Self), Self> {
        match self {
            Self::Op(op) => match *op {
                Op::Mul(a, b) => Ok((a, b)),
                op => Err(Self::of(op)),
            },
            other => Err(other),
        }
    }

    /// A sum takes a product into one operation, the second one if there are two.
    fn sum(self, other: Self, minus: bool) -> Self {
        let (product_last, product_first) = match minus {
            false => (Sign::Plus, Sign::Plus),
            true => (Sign::MinusProduct, Sign::MinusAddend),
        };
        Self::of(match other.factors() {
            Ok((a, b)) => Op::Fma(a, b, self, product_last),
            Err(other) => match (self.factors(), minus) {
                (Ok((a, b)), _) => Op::Fma(a, b, other, product_first),
                (Err(this), false) => Op::Add(this, other),
                (Err(this), true) => Op::Sub(this, other),
            },
        })
    }
}

impl ops::Neg for Num {
    type Output = Self;

    fn neg(self) -> Self {
        Self::of(Op::Neg(self))
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
    Num Mul mul: |a, b| Num::of(Op::Mul(a, b));
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

impl From<&LoopKernel> for Listing {
    /// The operations that a loop does, in the order in which it does them.
    ///
    /// # Panics
    ///
    /// If the kernel names what it has not declared, reads what it has not stored, leaves an array, has the factor of the
    /// higher degree second in a product, or gives a name or an array a value of another kind than it has.
    fn from(kernel: &LoopKernel) -> Self {
        let mut constants: Vec<Exact> = Vec::new();
        let mut floats: HashMap<Name, (Kind, Vec<Option<Operand>>)> = HashMap::new();
        for (param, of) in kernel.params.iter().enumerate() {
            let items = (0..of.shape.len()).map(|index| Some(Operand::Input { param, index }));
            floats.insert(of.name, (of.kind, items.collect()));
        }
        for table in &kernel.tables {
            let first = constants.len();
            constants.extend(table.values.iter().cloned());
            let items = (first..constants.len()).map(|place| Some(Operand::Const(place)));
            floats.insert(table.name, (Kind::Scalar, items.collect()));
        }
        let mut trace = Trace { ints: HashMap::new(), floats, constants, steps: vec![], stages: vec![] };
        trace.block(&kernel.body);
        let outputs = trace.floats[kernel.output].1.iter().map(|item| item.expect("the result is stored")).collect();
        let mut listing = Self {
            params: kernel.params.clone(),
            constants: trace.constants,
            steps: trace.steps,
            outputs,
            stages: trace.stages,
            directions: vec![],
            result: kernel.result,
            result_kind: kernel.result_kind,
            result_doc: kernel.result_doc.clone(),
        };
        listing.count_uses();
        listing
    }
}

struct Trace {
    ints: HashMap<Name, usize>,
    floats: HashMap<Name, (Kind, Vec<Option<Operand>>)>,
    constants: Vec<Exact>,
    steps: Vec<Step>,
    stages: Vec<Vec<Operand>>,
}

impl Trace {
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
                let before = self.floats.insert(name, (kind, vec![Some(value)]));
                before.inspect(|(before, _)| assert_eq!(*before, kind, "`{name}` has one kind"));
            }
            Stmt::Array(name, len, kind) => {
                self.floats.insert(name, (*kind, vec![None; *len]));
            }
            Stmt::Store(name, index, value) => {
                let (index, (value, kind)) = (self.int(index), self.num(value));
                let (of, items) = self.floats.get_mut(name).expect("the array is declared");
                assert_eq!(*of, kind, "`{name}` holds one kind");
                items[index] = Some(value);
            }
            Stmt::Stage(name, from, count) => {
                let (from, count) = (self.int(from), self.int(count));
                self.stages.push((from..from + count).map(|index| self.item(name, index).0).collect());
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

    fn item(&self, name: Name, index: usize) -> (Operand, Kind) {
        let (kind, items) = &self.floats[name];
        (items[index].expect("the item is stored"), *kind)
    }

    fn num(&mut self, value: &Num) -> (Operand, Kind) {
        let op = match value {
            Num::Const(value) => {
                self.constants.push(value.clone());
                return (Operand::Const(self.constants.len() - 1), Kind::Scalar);
            }
            Num::Tiny => return (Operand::Tiny, Kind::Scalar),
            Num::Name(name) => return self.item(name, 0),
            Num::Item(name, index) => return self.item(name, self.int(index)),
            Num::Op(op) => op.each().map(|arg| self.num(arg)),
        };
        if op.takes() == Takes::Products {
            let kinds: Vec<Kind> = op.operands().map(|(_, kind)| kind).collect();
            assert!(kinds[0] >= kinds[1], "a {} is the second factor of {value:?}", kinds[1]);
        }
        let kind = op.map(|(_, kind)| kind).kind().unwrap_or_else(|fault| panic!("{fault}: {value:?}"));
        self.steps.push(Step { op: op.map(|(operand, _)| operand), kind, uses: 0 });
        (Operand::Step(self.steps.len() - 1), kind)
    }
}
