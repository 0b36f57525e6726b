//! The operators of a type that is no `Copy`, for references and values alike.

/// Writes an operator for references and values alike.
macro_rules! operator {
    ($type:ty, $trait:ident, $method:ident, |$a:ident, $b:ident| $value:expr) => {
        impl $trait for &$type {
            type Output = $type;
            fn $method(self, other: Self) -> $type {
                let ($a, $b) = (self, other);
                $value
            }
        }
        impl $trait for $type {
            type Output = $type;
            fn $method(self, other: Self) -> $type {
                (&self).$method(&other)
            }
        }
        impl $trait<&$type> for $type {
            type Output = $type;
            fn $method(self, other: &$type) -> $type {
                (&self).$method(other)
            }
        }
        impl $trait<$type> for &$type {
            type Output = $type;
            fn $method(self, other: $type) -> $type {
                self.$method(&other)
            }
        }
    };
}

pub(super) use operator;
