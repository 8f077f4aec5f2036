//! Summaries as JSON.

use std::path::Path;

use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, IntoDeserializer, Visitor};
use serde::{Serialize, forward_to_deserialize_any};
use serde_json::{Error, Value};

use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;

/// Writes `value` to the file `path` as indented JSON, completely or not at all. Numbers that are
/// not finite become `null`.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    write_file(path, |out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

/// Reads what [`write_json`] has written: `null` where there should be a number is NaN.
pub fn from_json<T: DeserializeOwned>(json: Value) -> std::result::Result<T, Error> {
    T::deserialize(NullIsNan(json))
}

struct NullIsNan(Value);

impl<'de> Deserializer<'de> for NullIsNan {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> std::result::Result<V::Value, Error> {
        match self.0 {
            Value::Array(all) => {
                visitor.visit_seq(SeqDeserializer::new(all.into_iter().map(NullIsNan)))
            }
            Value::Object(all) => {
                let all = all.into_iter().map(|(key, value)| (key, NullIsNan(value)));
                visitor.visit_map(MapDeserializer::new(all))
            }
            plain => plain.deserialize_any(visitor),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> std::result::Result<V::Value, Error> {
        match self.0 {
            Value::Null => visitor.visit_f64(f64::NAN),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(
        self,
        visitor: V,
    ) -> std::result::Result<V::Value, Error> {
        match self.0 {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> std::result::Result<V::Value, Error> {
        self.0.deserialize_enum(name, variants, visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 char str string bytes byte_buf unit
        unit_struct newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

impl IntoDeserializer<'_, Error> for NullIsNan {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}
