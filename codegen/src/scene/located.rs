//! Values of a scene and where they were written, as serde finds them.

use crate::families::family::{MAX_ORDER, MIN_ORDER};
use crate::promise::registers::MOST;
use crate::scene::diagnostic::{Diagnostic, Place, Source};
use serde::Deserialize;
use serde::de::{Deserializer, Visitor};
use serde_spanned::Spanned;
use std::fmt;
use std::sync::Arc;

/// The most signals that a rotation may turn: beyond it, only what is done for each of them counts.
pub(super) const MAX_SIGNALS: usize = 1_000_000;

/// A value and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where.
    pub place: Place,
}

/// A value as serde finds it, with its place in the text.
#[derive(Deserialize)]
#[serde(transparent)]
pub(super) struct Placed<T>(Spanned<T>);

#[cfg(feature = "schema")]
impl<T: schemars::JsonSchema> schemars::JsonSchema for Placed<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        T::json_schema(generator)
    }
}

/// An order in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// A number of bands.
    Number(usize),
    /// As many as the environment needs.
    Environment,
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Order {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Order".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "anyOf": [{ "type": "integer", "minimum": MIN_ORDER, "maximum": MAX_ORDER }, { "const": "environment" }]
        })
    }
}

impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OrderVisitor;
        impl Visitor<'_> for OrderVisitor {
            type Value = Order;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "an order from {MIN_ORDER} to {MAX_ORDER} or \"environment\"")
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Order, E> {
                match usize::try_from(value) {
                    Ok(order) if (MIN_ORDER..=MAX_ORDER).contains(&order) => Ok(Order::Number(order)),
                    _ => {
                        Err(E::custom(format!("order {value} is out of range: orders are {MIN_ORDER} to {MAX_ORDER}")))
                    }
                }
            }
            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Order, E> {
                self.visit_i64(i64::try_from(value).unwrap_or(i64::MAX))
            }
            fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Order, E> {
                match value {
                    "environment" => Ok(Order::Environment),
                    other => Err(E::custom(format!("`{other}` is no order: write a number, or \"environment\""))),
                }
            }
        }
        deserializer.deserialize_any(OrderVisitor)
    }
}

/// Locates what serde found.
pub(super) struct Locator(pub(super) Arc<Source>);

impl Locator {
    pub(super) fn at<T>(&self, spanned: Placed<T>) -> Located<T> {
        let place = Place { source: Arc::clone(&self.0), span: spanned.0.span() };
        Located { value: spanned.0.into_inner(), place }
    }

    /// A value that may be left out, which then stands at another's place.
    pub(super) fn or_default<T: Default, U>(&self, value: Option<Placed<T>>, place: &Placed<U>) -> Located<T> {
        match value {
            Some(value) => self.at(value),
            None => {
                let place = Place { source: Arc::clone(&self.0), span: place.0.span() };
                Located { value: T::default(), place }
            }
        }
    }

    /// A number within bounds, of which the lower may be excluded.
    pub(super) fn number(
        &self,
        spanned: Placed<f64>,
        what: &str,
        least: f64,
        most: f64,
    ) -> Result<Located<f64>, Diagnostic> {
        let located = self.at(spanned);
        match located.value > least && located.value <= most {
            true => Ok(located),
            false => Err(Diagnostic::at(
                &located.place,
                format!("{what} {} is out of range", located.value),
                match most == f64::MAX {
                    true => format!("write a number above {least}"),
                    false => format!("write a number above {least} and up to {most}"),
                },
            )),
        }
    }

    pub(super) fn signals(&self, spanned: Placed<i64>) -> Result<usize, Diagnostic> {
        let located = self.at(spanned);
        let count = usize::try_from(located.value).ok().filter(|count| (1..=MAX_SIGNALS).contains(count));
        count.ok_or_else(|| {
            let message = format!("{} signals are out of range", located.value);
            Diagnostic::at(&located.place, message, format!("write a number from 1 to {MAX_SIGNALS}"))
        })
    }

    pub(super) fn registers(&self, spanned: Placed<i64>) -> Result<Located<usize>, Diagnostic> {
        let located = self.at(spanned);
        match usize::try_from(located.value).ok().filter(|count| (1..=MOST).contains(count)) {
            Some(value) => Ok(Located { value, place: located.place }),
            None => {
                let message = format!("{} registers are out of range", located.value);
                Err(Diagnostic::at(&located.place, message, format!("write a number from 1 to {MOST}")))
            }
        }
    }

    pub(super) fn angle(&self, spanned: Placed<f64>) -> Result<Located<f64>, Diagnostic> {
        self.number(spanned, "an angle in degrees of", 0.0, 180.0)
    }
}
