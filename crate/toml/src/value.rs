//! The deserializer: from a parsed document to a type.

use std::borrow::Cow;
use std::ops::Range;

use serde::de::value::{StrDeserializer, UsizeDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

use crate::{Error, located};

/// Reads a whole document.
pub(crate) fn read<T: DeserializeOwned>(table: &Spanned<DeTable<'_>>) -> Result<T, Error> {
    T::deserialize(Value { kind: Kind::Table(table.get_ref()), span: table.span() })
}

/// A value of the document and its place.
struct Value<'a> {
    kind: Kind<'a>,
    span: Range<usize>,
}

#[derive(Clone, Copy)]
enum Kind<'a> {
    String(&'a str),
    Integer(&'a DeInteger<'a>),
    Float(&'a str),
    Boolean(bool),
    Datetime,
    Array(&'a DeArray<'a>),
    Table(&'a DeTable<'a>),
}

impl<'a> Value<'a> {
    fn new(value: &'a Spanned<DeValue<'a>>) -> Self {
        let kind = match value.get_ref() {
            DeValue::String(text) => Kind::String(text),
            DeValue::Integer(number) => Kind::Integer(number),
            DeValue::Float(number) => Kind::Float(number.as_str()),
            DeValue::Boolean(truth) => Kind::Boolean(*truth),
            DeValue::Datetime(_) => Kind::Datetime,
            DeValue::Array(items) => Kind::Array(items),
            DeValue::Table(entries) => Kind::Table(entries),
        };
        Self { kind, span: value.span() }
    }

    /// The error for a value of another kind than expected.
    fn unexpected(&self, expected: &dyn Expected) -> Error {
        let found = match self.kind {
            Kind::String(text) => Unexpected::Str(text),
            Kind::Integer(number) => match integer(number) {
                Some(value) => Unexpected::Signed(value),
                None => Unexpected::Other("a large integer"),
            },
            Kind::Float(text) => float(text).map_or(Unexpected::Other("a float"), Unexpected::Float),
            Kind::Boolean(truth) => Unexpected::Bool(truth),
            Kind::Datetime => Unexpected::Other("a date or time"),
            Kind::Array(_) => Unexpected::Seq,
            Kind::Table(_) => Unexpected::Map,
        };
        Error::invalid_type(found, expected).at(self.span.clone())
    }

    fn table(&self, expected: &dyn Expected) -> Result<Entries<'a>, Error> {
        match self.kind {
            Kind::Table(table) => Ok(Entries { rest: table.iter(), value: None }),
            _ => Err(self.unexpected(expected)),
        }
    }

    fn array(&self, expected: &dyn Expected) -> Result<Items<'a>, Error> {
        match self.kind {
            Kind::Array(array) => Ok(Items { rest: array.iter() }),
            _ => Err(self.unexpected(expected)),
        }
    }
}

fn integer(number: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// `1e999` overflows a float and is refused; `inf` is allowed.
fn float(text: &str) -> Option<f64> {
    let value: f64 = text.parse().ok()?;
    (value.is_finite() || text.contains("inf") || text.contains("nan")).then_some(value)
}

impl<'de> Deserializer<'de> for Value<'_> {
    type Error = Error;

    // Not inlined: each visitor has one of these, and the compiler would copy it to every field that reads
    // it.
    #[inline(never)]
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let read = match self.kind {
            Kind::String(text) => visitor.visit_str(text),
            Kind::Integer(number) => match integer(number) {
                Some(value) => visitor.visit_i64(value),
                None => match u64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(value) => visitor.visit_u64(value),
                    // The same error as for `0x` without digits.
                    Err(_) if number.as_str().is_empty() => Err(Error::custom("integer: expected digits")),
                    Err(_) => Err(Error::custom(format_args!(
                        "integer {}: expected one of 64 bits",
                        number.as_str()
                    ))),
                },
            },
            Kind::Float(text) => match float(text) {
                Some(value) => visitor.visit_f64(value),
                None => Err(Error::custom(format_args!("number {text}: expected one of double precision"))),
            },
            Kind::Boolean(truth) => visitor.visit_bool(truth),
            Kind::Datetime => Err(self.unexpected(&visitor)),
            Kind::Array(items) => visitor.visit_seq(Items { rest: items.iter() }),
            Kind::Table(table) => visitor.visit_map(Entries { rest: table.iter(), value: None }),
        };
        read.map_err(|error| error.at(self.span))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_map(visitor)
    }

    #[inline(never)]
    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let entries = self.table(&visitor)?;
        visitor.visit_map(entries).map_err(|error| error.at(self.span))
    }

    #[inline(never)]
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let items = self.array(&visitor)?;
        visitor.visit_seq(items).map_err(|error| error.at(self.span))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        if name == located::NAME {
            let begin = self.span.start;
            return visitor.visit_map(Pair { begin: Some(begin), value: Some(self) });
        }
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.kind {
            Kind::String(name) => {
                visitor.visit_enum(name.into_deserializer()).map_err(|error: Error| error.at(self.span))
            }
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct identifier
    }
}

/// The entries of a table.
struct Entries<'a> {
    rest: toml::map::Iter<'a, Spanned<Cow<'a, str>>, Spanned<DeValue<'a>>>,
    value: Option<&'a Spanned<DeValue<'a>>>,
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        let name: StrDeserializer<'_, Error> = key.get_ref().as_ref().into_deserializer();
        seed.deserialize(name).map(Some).map_err(|error| error.at(key.span()))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let value = self.value.take().ok_or_else(value_before_key)?;
        seed.deserialize(Value::new(value))
    }
}

#[cold]
fn value_before_key() -> Error {
    Error::custom("a value was read before its key")
}

/// The items of an array.
struct Items<'a> {
    rest: std::slice::Iter<'a, Spanned<DeValue<'a>>>,
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.rest.next().map(|item| seed.deserialize(Value::new(item))).transpose()
    }
}

/// A value's place and the value, as an entry's key and value.
struct Pair<'a> {
    begin: Option<usize>,
    value: Option<Value<'a>>,
}

impl<'de> MapAccess<'de> for Pair<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some(begin) = self.begin.take() else { return Ok(None) };
        let place: UsizeDeserializer<Error> = begin.into_deserializer();
        seed.deserialize(place).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let value = self.value.take().ok_or_else(value_before_key)?;
        seed.deserialize(value)
    }
}
