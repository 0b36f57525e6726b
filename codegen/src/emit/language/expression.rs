//! An expression's text and how tightly it binds, so that no parenthesis is written that a reader does not need.

use crate::ir::graph::Kind;

/// How tightly an expression binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Binding {
    /// A sum or a difference.
    Sum,
    /// A product, a quotient or a negation.
    Product,
    /// A name, a positive number, a call or what stands in parentheses.
    Atom,
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Text {
    /// What is written.
    pub text: String,
    /// How tightly it binds.
    pub binding: Binding,
    /// Whether it is one number or one a channel.
    pub kind: Kind,
}

impl Text {
    /// Returns a name, a call or another expression that needs no parentheses.
    pub fn atom(text: impl Into<String>, kind: Kind) -> Self {
        Self { text: text.into(), binding: Binding::Atom, kind }
    }

    /// Returns a constant, which binds as a negation does where it begins with a sign.
    pub fn literal(text: String) -> Self {
        let binding = if text.starts_with('-') { Binding::Product } else { Binding::Atom };
        Self { text, binding, kind: Kind::Scalar }
    }

    /// Returns what is written where at least this binding is needed.
    pub fn at_least(&self, binding: Binding) -> String {
        match self.binding >= binding {
            true => self.text.clone(),
            false => format!("({})", self.text),
        }
    }

    /// Returns whether it begins with a number, as the first factor of a product does.
    pub fn begins_with_a_number(&self) -> bool {
        self.text.starts_with(|c: char| c.is_ascii_digit())
    }

    /// Returns two expressions with an operator between them that groups from the left.
    pub fn infix(a: &Self, operator: &str, b: &Self) -> Self {
        let (binding, above) = match operator {
            "+" | "-" => (Binding::Sum, Binding::Product),
            _ => (Binding::Product, Binding::Atom),
        };
        let text = format!("{} {operator} {}", a.at_least(binding), b.at_least(above));
        Self { text, binding, kind: a.kind.max(b.kind) }
    }
}
