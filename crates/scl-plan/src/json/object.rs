//! Reads JSON values. Errors say what was expected, and where.

use crate::error::PlanError;
use scl_text::excerpt::excerpt;
use scl_text::list::quoted_list;
use scl_text::suggest::closest_name;
use serde_json::{Map, Value};
use std::fmt::Display;
use std::time::Duration;

/// A value, and its path in the document.
pub(super) struct At<'v> {
    value: &'v Value,
    path: String,
}

/// An object whose fields are all known.
pub(super) struct Object<'v> {
    fields: &'v Map<String, Value>,
    path: String,
}

impl<'v> At<'v> {
    pub(super) fn document(value: &'v Value) -> Self {
        Self { value, path: String::new() }
    }

    pub(super) fn is_null(&self) -> bool {
        self.value.is_null()
    }

    /// The value as an object.
    pub(super) fn fields(&self) -> Result<&'v Map<String, Value>, PlanError> {
        self.value.as_object().ok_or_else(|| self.wrong("an object"))
    }

    /// The value as an object that has no fields but these.
    pub(super) fn object(&self, known: &[&'static str]) -> Result<Object<'v>, PlanError> {
        let object = Object { fields: self.fields()?, path: self.path.clone() };
        match object.fields.keys().find(|key| !known.contains(&key.as_str())) {
            Some(field) => Err(PlanError::UnknownField {
                at: object.shown_path(),
                field: excerpt(field),
                nearest: closest_name(field, known.iter().copied()),
            }),
            None => Ok(object),
        }
    }

    /// The value of a field whose name is not known beforehand.
    pub(super) fn entry(&self, field: &str) -> Result<At<'v>, PlanError> {
        let value = self.fields()?.get(field).unwrap_or(&Value::Null);
        Ok(At { value, path: joined(&self.path, &excerpt(field)) })
    }

    pub(super) fn text(&self) -> Result<&'v str, PlanError> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    pub(super) fn flag(&self) -> Result<bool, PlanError> {
        self.value.as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    /// A whole number from 0 to `max`, the largest of its type.
    pub(super) fn number<N: TryFrom<u64> + Display>(&self, max: N) -> Result<N, PlanError> {
        let number = self.value.as_u64().and_then(|number| N::try_from(number).ok());
        number.ok_or_else(|| self.wrong(&format!("a whole number from 0 to {max}")))
    }

    /// A duration in nanoseconds.
    pub(super) fn duration(&self) -> Result<Duration, PlanError> {
        self.number(u64::MAX).map(Duration::from_nanos)
    }

    /// The meaning of a word, which must be one of `words`.
    pub(super) fn word<T>(&self, words: &[&str], of: fn(&str) -> Option<T>) -> Result<T, PlanError> {
        let found = self.value.as_str().and_then(of);
        found.ok_or_else(|| self.wrong(&format!("one of {}", quoted_list(words))))
    }

    pub(super) fn list<T>(&self, read: impl Fn(At<'v>) -> Result<T, PlanError>) -> Result<Vec<T>, PlanError> {
        let items = self.value.as_array().ok_or_else(|| self.wrong("a list"))?;
        let at = |(index, value)| At { value, path: format!("{}[{index}]", self.path) };
        items.iter().enumerate().map(|item| read(at(item))).collect()
    }

    /// The error that this value is not what it must be.
    pub(super) fn wrong(&self, expected: &str) -> PlanError {
        let at = if self.path.is_empty() { "the document" } else { &self.path };
        PlanError::Value { at: at.to_owned(), expected: expected.to_owned(), found: excerpt(&self.value.to_string()) }
    }
}

impl<'v> Object<'v> {
    pub(super) fn has(&self, field: &str) -> bool {
        self.fields.contains_key(field)
    }

    pub(super) fn field(&self, field: &'static str) -> Result<At<'v>, PlanError> {
        let missing = || PlanError::Missing { at: self.shown_path(), field };
        let value = self.fields.get(field).ok_or_else(missing)?;
        Ok(At { value, path: self.path_of(field) })
    }

    pub(super) fn path_of(&self, field: &str) -> String {
        joined(&self.path, field)
    }

    pub(super) fn text(&self, field: &'static str) -> Result<String, PlanError> {
        self.field(field)?.text().map(str::to_owned)
    }

    /// A text, or `None` for null.
    pub(super) fn optional_text(&self, field: &'static str) -> Result<Option<String>, PlanError> {
        let value = self.field(field)?;
        match value.is_null() {
            true => Ok(None),
            false => value.text().map(|text| Some(text.to_owned())).map_err(|_| value.wrong("a text or null")),
        }
    }

    fn shown_path(&self) -> String {
        if self.path.is_empty() { "the document".to_owned() } else { format!("`{}`", self.path) }
    }
}

fn joined(path: &str, field: &str) -> String {
    if path.is_empty() { field.to_owned() } else { format!("{path}.{field}") }
}
