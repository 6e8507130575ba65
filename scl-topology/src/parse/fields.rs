//! A mapping as the keys that we can read, each once.

use super::{Reader, pitfall};
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::yaml::{Node, NodeKind};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// One key and its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field<'n> {
    /// The key as text.
    pub(super) key: &'n str,
    /// The key's place.
    pub(super) key_span: Span,
    /// The key's node, which knows whether it was quoted.
    pub(super) key_node: &'n Node,
    /// The value.
    pub(super) value: &'n Node,
}

/// The readable keys of a mapping.
#[derive(Debug, Default)]
pub(super) struct Fields<'n> {
    /// In file order, each key once.
    pub(super) list: Vec<Field<'n>>,
    /// A key could not be read, and a problem says so: whatever seems to be missing may be behind it.
    pub(super) damaged: bool,
}

impl<'n> Fields<'n> {
    /// The field with this key.
    pub(super) fn get(&self, key: &str) -> Option<Field<'n>> {
        self.list.iter().copied().find(|field| field.key == key)
    }
}

impl Reader<'_> {
    /// Reads keys; `owner` says whose they are, for example `this component`.
    pub(super) fn fields<'n>(&mut self, entries: &'n [(Node, Node)], owner: &str) -> Fields<'n> {
        let mut fields = Fields::default();
        let mut seen: HashMap<&str, Span> = HashMap::new();
        let mut repeated: HashMap<&str, Diagnostic> = HashMap::new();
        for (key_node, value) in entries {
            if value.span.start == value.span.end
                && let Some(problem) = pitfall::missing_space::in_node(key_node, self.source)
            {
                self.report(problem);
                fields.damaged = true;
                continue;
            }
            let Some(key) = self.key(key_node) else {
                fields.damaged = true;
                continue;
            };
            let field = Field { key, key_span: key_node.span, key_node, value };
            if let Some(&first) = seen.get(key) {
                match repeated.entry(key) {
                    Entry::Occupied(found) => found.into_mut().add_label(field.key_span, "and here"),
                    Entry::Vacant(none) => _ = none.insert(pitfall::duplicate_key::diagnose(&field, first, owner)),
                }
                continue;
            }
            seen.insert(key, key_node.span);
            fields.list.push(field);
        }
        repeated.into_values().for_each(|problem| self.report(problem));
        fields
    }

    fn key<'n>(&mut self, node: &'n Node) -> Option<&'n str> {
        let problem = match &node.kind {
            NodeKind::Unread => return None,
            NodeKind::Scalar { text, .. } if text == "<<" && super::is_plain(node) => {
                pitfall::merge_key::diagnose(node)
            }
            NodeKind::Scalar { text, .. } if !text.is_empty() => return Some(text),
            _ => pitfall::odd_key::diagnose(node),
        };
        self.report(problem);
        None
    }
}
