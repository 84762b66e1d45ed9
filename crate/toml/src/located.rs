//! A value with its place in the document.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

/// The reader recognises a located value by this name.
pub(crate) const NAME: &str = "$mapless_toml::Located";

/// A value and its place in the document. Only [`from_str`](crate::from_str) can read one.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The first byte of the value; of a table, of its header.
    pub begin: usize,
    /// The value.
    pub value: T,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(NAME, Pair(PhantomData))
    }
}

struct Pair<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Pair<T> {
    type Value = Located<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value with its place")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut pair: A) -> Result<Self::Value, A::Error> {
        let entry = pair.next_entry()?;
        let (begin, value) = entry.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        Ok(Located { begin, value })
    }
}
