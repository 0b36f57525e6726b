//! Words of a scene that are known elsewhere in the generator, as types for the JSON schema of its format.

use crate::emit::language::{self, Arrays};
use crate::math::convention;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// Makes a type that stands for a word out of a list that the generator knows.
macro_rules! word {
    ($name:ident, $known:expr) => {
        pub(super) struct $name;

        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({ "type": "string", "enum": $known })
            }
        }
    };
}

word!(Language, language::names());
word!(Passed, Arrays::ALL.map(|(_, name)| name));
word!(FormName, language::forms());
word!(ConventionName, convention::names());
