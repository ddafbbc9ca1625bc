//! The deserialiser turns a parsed TOML tree into a scene and keeps the path and the place in the
//! text of any fault.
//!
//! A serde deserialiser of its own: the one of the `toml` crate names neither the path nor the
//! nearest known key, and cannot fill what a file leaves out from a preset.

use std::fmt;
use std::ops::Range;

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{DocumentFault, SceneFault};
use crate::scene::nearest_name::nearest;
use crate::scene::preset;

type TomlNode<'a> = Spanned<DeValue<'a>>;

/// A fault on its way up the tree, gathering its path.
#[derive(Debug)]
pub(super) struct DeserializeError {
    /// The fault.
    pub(super) fault: SceneFault,
    /// Bytes of the text it is about.
    pub(super) span: Option<Range<usize>>,
    /// Path, innermost first.
    steps: Vec<PathStep>,
}

#[derive(Debug)]
enum PathStep {
    Key(String),
    Index(usize),
}

impl DeserializeError {
    fn new(fault: SceneFault) -> Self {
        Self { fault, span: None, steps: Vec::new() }
    }

    fn inside(mut self, step: PathStep, span: Range<usize>) -> Self {
        self.steps.push(step);
        self.spanned(span)
    }

    fn spanned(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }

    /// The path as text, for example `cables[0].length_m`.
    pub(super) fn path(&self) -> String {
        let mut path = String::new();
        for step in self.steps.iter().rev() {
            match step {
                PathStep::Key(key) if path.is_empty() => path.push_str(key),
                PathStep::Key(key) => {
                    path.push('.');
                    path.push_str(key);
                }
                PathStep::Index(index) => path.push_str(&format!("[{index}]")),
            }
        }
        path
    }
}

impl fmt::Display for DeserializeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path(), self.fault)
    }
}

impl std::error::Error for DeserializeError {}

impl serde::de::Error for DeserializeError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(SceneFault::Document(DocumentFault::Refused { message: message.to_string() }))
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::new(SceneFault::Type { found: found.to_string(), needed: plain(expected) })
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(found: usize, expected: &dyn Expected) -> Self {
        Self::new(SceneFault::Elements { count: found, needed: plain(expected) })
    }

    fn unknown_field(field: &str, known: &'static [&'static str]) -> Self {
        Self::new(SceneFault::UnknownKey { nearest: nearest(field, known.iter().copied()) })
    }

    fn unknown_variant(variant: &str, known: &'static [&'static str]) -> Self {
        let nearest = nearest(variant, known.iter().copied());
        Self::new(SceneFault::Document(DocumentFault::UnknownWord { word: variant.to_owned(), known, nearest }))
    }

    fn missing_field(field: &'static str) -> Self {
        let mut refusal = Self::new(SceneFault::Document(DocumentFault::Missing));
        refusal.steps.push(PathStep::Key(field.to_owned()));
        refusal
    }
}

/// Rust's names of types in a reader's words.
fn plain(expected: &dyn Expected) -> String {
    match expected.to_string().as_str() {
        "f64" => "a number".to_owned(),
        "u32" | "usize" => "a whole number, 0 or more,".to_owned(),
        other if other.starts_with("struct ") => "a table".to_owned(),
        "a sequence" => "a list".to_owned(),
        other => other.to_owned(),
    }
}

/// A deserialiser over a whole document.
pub(super) struct DocumentDeserializer<'a>(pub(super) &'a DeTable<'a>, pub(super) Range<usize>);

impl<'de> Deserializer<'de> for DocumentDeserializer<'de> {
    type Error = DeserializeError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, DeserializeError> {
        visitor.visit_map(Entries::new(self.0, Vec::new())).map_err(|e| e.spanned(self.1))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

/// A deserialiser over one value.
struct Value<'a>(&'a TomlNode<'a>);

impl<'de> Deserializer<'de> for Value<'de> {
    type Error = DeserializeError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, DeserializeError> {
        let span = self.0.span();
        match self.0.get_ref() {
            DeValue::String(s) => visitor.visit_str(s),
            DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
                Ok(value) => visitor.visit_i64(value),
                // Beyond 64 bits: good enough for the range check to name it.
                Err(_) => visitor.visit_f64(i.as_str().parse().unwrap_or(f64::INFINITY)),
            },
            DeValue::Float(x) => visitor.visit_f64(x.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(b) => visitor.visit_bool(*b),
            DeValue::Datetime(_) => Err(DeserializeError::invalid_type(Unexpected::Other("a date"), &visitor)),
            DeValue::Array(items) => {
                let mut seq = Items { items, next: 0 };
                visitor.visit_seq(&mut seq).and_then(|value| {
                    if seq.next == items.len() {
                        Ok(value)
                    } else {
                        let needed = seq.next.to_string();
                        Err(DeserializeError::new(SceneFault::Elements { count: items.len(), needed }))
                    }
                })
            }
            DeValue::Table(table) => visitor.visit_map(Entries::new(table, Vec::new())),
        }
        .map_err(|e| e.spanned(span))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, DeserializeError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, DeserializeError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, DeserializeError> {
        match self.0.get_ref() {
            DeValue::String(s) => visitor.visit_enum(VariantName(s)).map_err(|e| e.spanned(self.0.span())),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, DeserializeError> {
        match self.0.get_ref() {
            DeValue::Table(table) if name == "Cable" => {
                let defaults = cable_defaults(table)?;
                visitor.visit_map(Entries::new(table, defaults)).map_err(|e| e.spanned(self.0.span()))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

/// The numbers of a cable's preset that its table leaves out.
fn cable_defaults(table: &DeTable<'_>) -> Result<Vec<(&'static str, f64)>, DeserializeError> {
    let Some(value) = table.get("preset") else { return Ok(Vec::new()) };
    let DeValue::String(id) = value.get_ref() else { return Ok(Vec::new()) };
    let Some(preset) = preset::cable_preset(id) else {
        let fault = preset::unknown("cable preset", id, preset::cable_presets().iter().map(|p| p.id));
        return Err(DeserializeError::new(fault).inside(PathStep::Key("preset".to_owned()), value.span()));
    };
    Ok(preset.values().into_iter().filter(|(key, _)| table.get(*key).is_none()).collect())
}

/// The name of an enum's variant.
struct VariantName<'a>(&'a str);

impl<'de> EnumAccess<'de> for VariantName<'_> {
    type Error = DeserializeError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), DeserializeError> {
        let name: StrDeserializer<'_, DeserializeError> = self.0.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> VariantAccess<'de> for VariantName<'_> {
    type Error = DeserializeError;

    fn unit_variant(self) -> Result<(), DeserializeError> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, _: T) -> Result<T::Value, DeserializeError> {
        Err(DeserializeError::invalid_type(Unexpected::Str(self.0), &"a table"))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, DeserializeError> {
        Err(DeserializeError::invalid_type(Unexpected::Str(self.0), &visitor))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, DeserializeError> {
        Err(DeserializeError::invalid_type(Unexpected::Str(self.0), &visitor))
    }
}

struct Items<'a> {
    items: &'a [TomlNode<'a>],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = DeserializeError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, DeserializeError> {
        let Some(item) = self.items.get(self.next) else { return Ok(None) };
        let index = self.next;
        self.next += 1;
        seed.deserialize(Value(item)).map(Some).map_err(|e| e.inside(PathStep::Index(index), item.span()))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len() - self.next)
    }
}

/// The entries of a table, then what a preset adds.
struct Entries<'a, I> {
    entries: I,
    value: Option<(&'a str, &'a TomlNode<'a>)>,
    defaults: std::vec::IntoIter<(&'static str, f64)>,
    default: f64,
}

impl<'a> Entries<'a, ()> {
    fn new(
        table: &'a DeTable<'a>,
        defaults: Vec<(&'static str, f64)>,
    ) -> Entries<'a, impl Iterator<Item = (&'a Spanned<std::borrow::Cow<'a, str>>, &'a TomlNode<'a>)>> {
        Entries { entries: table.iter(), value: None, defaults: defaults.into_iter(), default: 0.0 }
    }
}

impl<'de, I> MapAccess<'de> for Entries<'de, I>
where
    I: Iterator<Item = (&'de Spanned<std::borrow::Cow<'de, str>>, &'de TomlNode<'de>)>,
{
    type Error = DeserializeError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, DeserializeError> {
        if let Some((key, value)) = self.entries.next() {
            let name: &'de str = key.get_ref();
            self.value = Some((name, value));
            let word: StrDeserializer<'_, DeserializeError> = name.into_deserializer();
            return seed.deserialize(word).map(Some).map_err(|e| e.inside(PathStep::Key(name.to_owned()), key.span()));
        }
        let Some((name, value)) = self.defaults.next() else { return Ok(None) };
        self.value = None;
        self.default = value;
        let word: StrDeserializer<'_, DeserializeError> = name.into_deserializer();
        seed.deserialize(word).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, DeserializeError> {
        match self.value.take() {
            Some((key, value)) => {
                seed.deserialize(Value(value)).map_err(|e| e.inside(PathStep::Key(key.to_owned()), value.span()))
            }
            None => seed.deserialize(self.default.into_deserializer()),
        }
    }
}
