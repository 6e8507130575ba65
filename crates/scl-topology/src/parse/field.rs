//! The keys of a mapping with their values, and where they stand.

use super::with_dash;
use crate::source::{SourceFile, Span, Spanned};
use crate::yaml::Node;

/// One key and its value.
#[derive(Debug, Clone, Copy)]
pub struct Field<'n> {
    /// The key as text.
    pub key: &'n str,
    /// The key's place.
    pub key_span: Span,
    /// The key's node, which knows whether it was quoted.
    pub key_node: &'n Node,
    /// The value.
    pub value: &'n Node,
}

/// The readable keys of a mapping.
#[derive(Debug, Default)]
pub struct Fields<'n> {
    /// In file order, each key once.
    pub list: Vec<Field<'n>>,
    /// The second and later fields of the same key; a problem says so.
    pub repeated: Vec<Field<'n>>,
    /// A key could not be read, and a problem says so. A key that seems to be missing may be this one.
    pub damaged: bool,
}

impl<'n> Fields<'n> {
    /// The field with this key.
    pub fn get(&self, key: &str) -> Option<Field<'n>> {
        self.list.iter().copied().find(|field| field.key == key)
    }

    /// All fields with this key, the repeated ones too.
    pub(super) fn all(&self, key: &str) -> impl Iterator<Item = Field<'n>> {
        self.list.iter().chain(&self.repeated).copied().filter(move |field| field.key == key)
    }
}

/// The key with its place.
pub(super) fn spanned_key(field: Field<'_>) -> Spanned<String> {
    Spanned { value: field.key.to_owned(), span: field.key_span }
}

/// From the first character of an item, its `-` included, to the end of its first key.
pub(super) fn head(item: &Node, fields: &Fields<'_>, source: &SourceFile) -> Span {
    let start = with_dash(item.span, source);
    match fields.list.first() {
        Some(first) => Span { end: first.key_span.end, ..start },
        None => start,
    }
}

/// The end of a key, its colon included if it follows at once.
pub(super) fn end_with_colon(key: Span, source: &SourceFile) -> u32 {
    let follows = source.text().get(key.end as usize..).is_some_and(|rest| rest.starts_with(':'));
    key.end + u32::from(follows)
}
