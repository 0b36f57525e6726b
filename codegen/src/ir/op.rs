//! The operations, in one table: what each is called, what it takes, what it costs. The graph, the listing and the loops
//! hold the same [`Op`], each of its own operands. What a table cannot say stands elsewhere: the arithmetic in
//! [`crate::ir::eval`], the text in each language's file, the enclosure in [`crate::promise::bound`].

/// What a value is: a parameter of the kernel, or linear in its signal (one number a channel).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// One number, shared by all channels of a signal.
    Scalar,
    /// Linear in the signal: as many numbers as the signal has channels.
    Signal,
}

/// How the two parts of a fused operation are signed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sign {
    /// a · b + c.
    Plus,
    /// a · b − c.
    MinusAddend,
    /// c − a · b.
    MinusProduct,
}

/// What an operation costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Price {
    /// Nothing: hardware has it as a modifier of an operand.
    Free,
    /// One addition.
    Add,
    /// One multiplication.
    Mul,
    /// One fused multiply-add.
    Fma,
    /// One operation that is slower than arithmetic, counted apart.
    Special,
}

/// What kinds of operands an operation takes, and of what kind its value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Anything; a signal makes a signal.
    Sums,
    /// Two factors, then a summand perhaps; a signal makes a signal, two of them one that is linear in each.
    Products,
    /// Scalars alone: the value is linear in nothing.
    Scalars,
    /// Two scalars to compare, then two of anything to choose from.
    Choice,
}

macro_rules! operations {
    ($($(#[$doc:meta])* $op:ident($($arg:ident: $operand:ty),+ $(; $extra:ident: $type:ty)?): $name:literal, $price:expr, $takes:ident;)+) => {
        /// One operation on operands of a type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Op<A> {
            $($(#[$doc])* $op($($operand),+ $(, $type)?),)+
        }

        impl<A> Op<A> {
            /// Returns the same operation on other operands, which are made in the order in which they are written.
            pub fn map<B>(self, mut of: impl FnMut(A) -> B) -> Op<B> {
                match self {
                    $(Self::$op($($arg),+ $(, $extra)?) => Op::$op($(of($arg)),+ $(, $extra)?),)+
                }
            }

            /// Returns the same operation on borrowed operands.
            pub fn each(&self) -> Op<&A> {
                match self {
                    $(Self::$op($($arg),+ $(, $extra)?) => Op::$op($($arg),+ $(, *$extra)?),)+
                }
            }

            /// Returns the name of the operation.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$op(..) => $name,)+
                }
            }

            /// Returns what the operation costs.
            pub fn price(&self) -> Price {
                match self {
                    $(Self::$op(..) => $price,)+
                }
            }

            /// Returns what kinds of operands the operation takes.
            pub fn takes(&self) -> Takes {
                match self {
                    $(Self::$op(..) => Takes::$takes,)+
                }
            }
        }
    };
}

operations! {
    /// −a.
    Neg(a: A): "negation", Price::Free, Sums;
    /// a + b.
    Add(a: A, b: A): "sum", Price::Add, Sums;
    /// a − b.
    Sub(a: A, b: A): "difference", Price::Add, Sums;
    /// a · b; a signal comes first.
    Mul(a: A, b: A): "product", Price::Mul, Products;
    /// a · b and c, signed as said; a signal comes first in the product.
    Fma(a: A, b: A, c: A; sign: Sign): "multiply-add", Price::Fma, Products;
    /// 1 / a.
    Recip(a: A): "reciprocal", Price::Special, Scalars;
    /// 1 / √a.
    Rsqrt(a: A): "inverse square root", Price::Special, Scalars;
}

impl<A> Op<A> {
    /// Returns the operands, in the order in which they are written.
    pub fn operands(&self) -> impl Iterator<Item = A> + use<A>
    where
        A: Copy,
    {
        let mut all = [None; 4];
        let mut places = all.iter_mut();
        self.each().map(|&operand| places.next().map(|place| *place = Some(operand)));
        all.into_iter().flatten()
    }
}

impl<A> Op<A> {
    /// Returns the operands as a list, in the order in which they are written.
    pub fn into_operands(self) -> Vec<A> {
        let mut all = Vec::new();
        self.map(|operand| all.push(operand));
        all
    }
}

impl Op<Kind> {
    /// Returns the kind of the value, or why the operation does not take operands of these kinds.
    pub fn kind(&self) -> Result<Kind, String> {
        let operands: Vec<Kind> = self.operands().collect();
        let scalars = match self.takes() {
            Takes::Sums | Takes::Products => 0,
            Takes::Scalars => operands.len(),
            Takes::Choice => 2,
        };
        match operands[..scalars].contains(&Kind::Signal) {
            true => Err(format!("a {} of a signal", self.name())),
            false => Ok(operands.into_iter().max().unwrap_or(Kind::Scalar)),
        }
    }
}
