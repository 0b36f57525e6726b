//! The operations, in one table: what each is called, what it takes, what it costs. The graph, the listing and the loops
//! hold the same [`Op`], each of its own operands. What a table cannot say stands elsewhere: the arithmetic in
//! [`crate::ir::eval`], the text in each language's file, the enclosure in [`crate::promise::bound`] if there is one.
//! Of equal zeros and of what is not a number docs/MATH.md#what-nothing-is-proven-of says what comes.

use std::fmt;

/// What a value is, by its degree in the signals: made of parameters alone, linear in a signal, or a product of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Degree 0: one number, shared by all channels of a signal.
    Scalar,
    /// Degree 1, linear in a signal: as many numbers as the signal has channels.
    Signal,
    /// Degree 2, linear in each of two signals, channel by channel: as many numbers as they have channels.
    Product,
}

impl Kind {
    /// All kinds, by degree.
    pub const ALL: [Self; 3] = [Self::Scalar, Self::Signal, Self::Product];

    /// Returns its degree in the signals.
    pub fn degree(self) -> usize {
        self as usize
    }

    /// Returns whether it is one number however many channels a signal has.
    pub fn is_scalar(self) -> bool {
        self == Self::Scalar
    }

    /// Returns how many numbers it is where a signal has so many channels.
    pub fn numbers(self, channels: usize) -> usize {
        if self.is_scalar() { 1 } else { channels }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["scalar", "signal", "product of signals"][self.degree()])
    }
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
    /// One choice of two numbers: GPUs have an instruction for it, as they have for an addition.
    Choice,
    /// One operation that is slower than arithmetic, counted apart.
    Special,
}

/// What kinds of operands an operation takes, and of what kind its value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Anything, all of one kind, which is the value's.
    Sums,
    /// Two factors, whose degrees add to that of the value, then a summand of its kind perhaps.
    Products,
    /// Scalars alone: the value is linear in nothing.
    Scalars,
    /// Two scalars to compare, then two of anything of one kind to choose from.
    Choice,
}

macro_rules! operations {
    ($($(#[$doc:meta])* $op:ident($($arg:ident: $operand:ty),+ $(; $extra:ident: $type:ty)?): $name:literal, $price:expr, $takes:ident;)+) => {
        /// One operation on operands of a type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Op<A> {
            $($(#[$doc])* $op($($operand),+ $(, $type)?),)+
        }

        impl Op<()> {
            /// The names of all operations, as the table has them.
            pub const NAMES: &[&str] = &[$($name),+];
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
    /// a · b; the factor of the higher degree comes first.
    Mul(a: A, b: A): "product", Price::Mul, Products;
    /// a · b and c, signed as said; the factor of the higher degree comes first.
    Fma(a: A, b: A, c: A; sign: Sign): "multiply-add", Price::Fma, Products;
    /// 1 / a.
    Recip(a: A): "reciprocal", Price::Special, Scalars;
    /// 1 / √a.
    Rsqrt(a: A): "inverse square root", Price::Special, Scalars;
    /// √a.
    Sqrt(a: A): "square root", Price::Special, Scalars;
    /// 2 to the power a.
    Exp2(a: A): "power of two", Price::Special, Scalars;
    /// The logarithm of a to the base 2.
    Log2(a: A): "logarithm", Price::Special, Scalars;
    /// |a|: free, as a negation is.
    Abs(a: A): "absolute value", Price::Free, Scalars;
    /// b where b < a, else a.
    Min(a: A, b: A): "minimum", Price::Choice, Scalars;
    /// b where a < b, else a.
    Max(a: A, b: A): "maximum", Price::Choice, Scalars;
    /// c where a < b, else d. One choice a channel: whatever is chosen by one comparison shares it, so that it is not
    /// counted.
    Select(a: A, b: A, c: A, d: A): "selection", Price::Choice, Choice;
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
        let (scalars, factors) = match self.takes() {
            Takes::Sums => (0, 0),
            Takes::Products => (0, 2),
            Takes::Scalars => (operands.len(), 0),
            Takes::Choice => (2, 0),
        };
        let (scalars, rest) = operands.split_at(scalars);
        let (factors, alike) = rest.split_at(factors);
        if let Some(other) = scalars.iter().find(|kind| !kind.is_scalar()) {
            return Err(format!("there is no {} of a {other}", self.name()));
        }
        let mut kinds = alike.to_vec();
        if let &[a, b] = factors {
            let product = Kind::ALL.get(a.degree() + b.degree());
            kinds.insert(0, *product.ok_or_else(|| format!("there is no product of a {a} and a {b}"))?);
        }
        let kind = kinds.first().copied().unwrap_or(Kind::Scalar);
        match kinds.iter().find(|other| **other != kind) {
            Some(other) => Err(format!("there is no {} of a {kind} and a {other}", self.name())),
            None => Ok(kind),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_follow_from_the_operands() {
        use Kind::{Product, Scalar, Signal};
        for kind in Kind::ALL {
            assert_eq!(Op::Neg(kind).kind(), Ok(kind));
            assert_eq!(Op::Add(kind, kind).kind(), Ok(kind));
            assert_eq!(Op::Mul(kind, Scalar).kind(), Ok(kind));
            assert_eq!(Op::Select(Scalar, Scalar, kind, kind).kind(), Ok(kind));
        }
        assert_eq!(Op::Mul(Signal, Signal).kind(), Ok(Product));
        assert_eq!(Op::Fma(Signal, Signal, Product, Sign::Plus).kind(), Ok(Product));
        assert_eq!(Op::Max(Scalar, Scalar).kind(), Ok(Scalar));
        for (op, why) in [
            (Op::Add(Signal, Product), "there is no sum of a signal and a product of signals"),
            (Op::Sub(Signal, Scalar), "there is no difference of a signal and a scalar"),
            (Op::Mul(Product, Signal), "there is no product of a product of signals and a signal"),
            (
                Op::Fma(Signal, Signal, Signal, Sign::Plus),
                "there is no multiply-add of a product of signals and a signal",
            ),
            (Op::Sqrt(Signal), "there is no square root of a signal"),
            (Op::Min(Scalar, Product), "there is no minimum of a product of signals"),
            (Op::Select(Scalar, Signal, Signal, Signal), "there is no selection of a signal"),
            (Op::Select(Scalar, Scalar, Signal, Product), "there is no selection of a signal and a product of signals"),
        ] {
            assert_eq!(op.kind(), Err(why.to_owned()), "{op:?}");
        }
    }
}
