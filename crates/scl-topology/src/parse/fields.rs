//! A mapping as the keys that we can read, each once.

use super::{Reader, pitfall};
use crate::confusable;
use crate::diagnostic::Diagnostic;
use crate::grammar::{self, GateKind};
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
    /// The second and later fields of the same key; a problem says so.
    pub(super) repeated: Vec<Field<'n>>,
    /// A key could not be read, and a problem says so: whatever seems to be missing may be behind it.
    pub(super) damaged: bool,
}

impl<'n> Fields<'n> {
    /// The field with this key.
    pub(super) fn get(&self, key: &str) -> Option<Field<'n>> {
        self.list.iter().copied().find(|field| field.key == key)
    }

    /// All fields with this key, the repeated ones too.
    pub(super) fn all(&self, key: &str) -> impl Iterator<Item = Field<'n>> {
        self.list.iter().chain(&self.repeated).copied().filter(move |field| field.key == key)
    }
}

impl Reader<'_> {
    /// Reads keys; `owner` says whose they are, for example `this component`.
    pub(super) fn fields<'n>(&mut self, entries: &'n [(Node, Node)], owner: &str) -> Fields<'n> {
        let mut fields = Fields::default();
        let mut seen: HashMap<&str, Span> = HashMap::new();
        let mut repeated: HashMap<&str, Diagnostic> = HashMap::new();
        for (key_node, value) in entries {
            let glued = match &key_node.kind {
                _ if value.span.start == value.span.end => pitfall::missing_space::in_node(key_node, self.source),
                NodeKind::Scalar { text, .. } => pitfall::missing_space::in_key(key_node, text),
                _ => None,
            };
            if let Some(problem) = glued {
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
                fields.repeated.push(field);
                continue;
            }
            seen.insert(key, key_node.span);
            fields.list.push(field);
        }
        self.report_repeated(repeated.into_values().collect());
        fields
    }

    /// Several repeated keys are one mistake, mostly a piece that was copied, or two that have run into one.
    fn report_repeated(&mut self, mut repeated: Vec<Diagnostic>) {
        repeated.sort_by_key(|problem| problem.primary.as_ref().map(|label| label.span));
        let mut repeated = repeated.into_iter();
        let Some(mut first) = repeated.next() else { return };
        for other in repeated {
            other.primary.iter().for_each(|label| first.add_label(label.span, "repeated too"));
        }
        self.report(first);
    }

    /// The key as written, or the one that it looks like.
    fn known_key<'n>(&mut self, node: &Node, written: &'n str) -> &'n str {
        if written.is_ascii() {
            return written;
        }
        let retyped = confusable::retyped(written);
        let Some(known) = known_word(retyped.trim_matches(['"', '\'', ' '])) else { return written };
        if let Some(problem) = pitfall::look_alike::in_word(node, written, "the key", self.source) {
            self.report(problem);
        }
        known
    }

    fn key<'n>(&mut self, node: &'n Node) -> Option<&'n str> {
        let problem = match &node.kind {
            NodeKind::Unread => return None,
            NodeKind::Scalar { text, .. } if text == "<<" && super::is_plain(node) => {
                pitfall::merge_key::diagnose(node)
            }
            NodeKind::Scalar { text, .. } if !text.is_empty() => return Some(self.known_key(node, text)),
            _ => pitfall::odd_key::diagnose(node),
        };
        self.report(problem);
        None
    }
}

/// One of the words that the format knows as keys.
pub(super) fn known_word(word: &str) -> Option<&'static str> {
    let keys = grammar::SECTIONS.iter().chain(&grammar::COMPONENT_KEYS).map(|key| key.key);
    let kinds = GateKind::ALL.into_iter().map(GateKind::word);
    let options = grammar::OPTIONS.iter().map(|option| option.key);
    keys.chain(kinds).chain(options).find(|known| *known == word)
}
