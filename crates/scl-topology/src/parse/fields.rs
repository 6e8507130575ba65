//! Reads a mapping as the keys that we can read, each once.

use super::field::{Field, Fields};
use super::words::known_word;
use super::{Reader, pitfall};
use crate::confusable;
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::yaml::{Node, NodeKind};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

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
                    Entry::Vacant(none) => _ = none.insert(pitfall::key::duplicate(&field, first, owner)),
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
                pitfall::unsupported::merge_key(node)
            }
            NodeKind::Scalar { text, .. } if !text.is_empty() => return Some(self.known_key(node, text)),
            _ => pitfall::key::not_a_word(node),
        };
        self.report(problem);
        None
    }
}
