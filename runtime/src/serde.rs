//! Coefficients as sequences, of any order: arrays above 32 items have no serialisation of their own in serde. For a field,
//! `#[serde(with = "zonal::serde")]`.
//!
//! ```
//! #[derive(serde::Serialize, serde::Deserialize)]
//! struct Probe {
//!     #[serde(with = "zonal::serde")]
//!     radiance: [[f32; 3]; 36],
//! }
//!
//! # #[cfg(feature = "order6")]
//! # fn main() {
//! let text = serde_json::to_string(&Probe { radiance: [[0.5; 3]; 36] }).unwrap();
//! let probe: Probe = serde_json::from_str(&text).unwrap();
//! assert_eq!(probe.radiance, [[0.5; 3]; 36]);
//! # }
//! # #[cfg(not(feature = "order6"))]
//! # fn main() {}
//! ```

use core::fmt;
use core::marker::PhantomData;

use serde_core::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use serde_core::ser::{SerializeTuple, Serializer};
use serde_core::{Deserialize, Serialize};

use crate::coefficients::Coefficients;

/// Writes coefficients as serde writes arrays.
///
/// # Errors
///
/// Those of the serialiser.
pub fn serialize<C, S>(c: &C, serializer: S) -> Result<S::Ok, S::Error>
where
    C: Coefficients<Element: Serialize>,
    S: Serializer,
{
    let mut tuple = serializer.serialize_tuple(C::COUNT)?;
    c.as_ref().iter().try_for_each(|element| tuple.serialize_element(element))?;
    tuple.end()
}

/// Reads what [`serialize`] writes.
///
/// # Errors
///
/// Those of the deserialiser, and if there are fewer or more coefficients than the order has.
pub fn deserialize<'de, C, D>(deserializer: D) -> Result<C, D::Error>
where
    C: Coefficients<Element: Deserialize<'de>>,
    D: Deserializer<'de>,
{
    deserializer.deserialize_tuple(C::COUNT, Reader(PhantomData))
}

struct Reader<C>(PhantomData<C>);

impl<'de, C: Coefficients<Element: Deserialize<'de>>> Visitor<'de> for Reader<C> {
    type Value = C;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} coefficients of order {}", C::COUNT, C::ORDER)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<C, A::Error> {
        let mut c = C::zero();
        for (i, element) in c.as_mut().iter_mut().enumerate() {
            *element = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        match sequence.next_element::<IgnoredAny>()? {
            Some(_) => Err(A::Error::invalid_length(C::COUNT + 1, &self)),
            None => Ok(c),
        }
    }
}
