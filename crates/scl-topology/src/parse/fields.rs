//! Reads the keys of a mapping, each once.

use super::dialect::Dialect;
use super::field::{Field, Fields};
use super::topology_dialect::TOPOLOGY;
use super::{Reader, pitfall};
use crate::confusable;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

impl Reader<'_> {
    /// Reads keys; `owner` says whose they are, for example `this component`.
    pub(super) fn fields<'n>(&mut self, entries: &'n [(Node, Node)], owner: &str) -> Fields<'n> {
        fields(entries, owner, self.source, &TOPOLOGY, &mut self.problems)
    }
}

/// Reads the keys of a mapping, and reports those that are repeated, are no words, or are damaged; `owner` says in
/// messages whose they are, for example `this component`.
pub fn fields<'n>(
    entries: &'n [(Node, Node)],
    owner: &str,
    source: &SourceFile,
    dialect: &Dialect,
    problems: &mut Diagnostics,
) -> Fields<'n> {
    let mut fields = Fields::default();
    let mut seen: HashMap<&str, (Span, Span)> = HashMap::new();
    let mut repeated: HashMap<&str, Diagnostic> = HashMap::new();
    for (key_node, value) in entries {
        let glued = match &key_node.kind {
            _ if value.span.start == value.span.end => pitfall::missing_space::in_node(key_node, source, dialect),
            NodeKind::Scalar { text, .. } => pitfall::missing_space::in_key(key_node, text, dialect),
            _ => None,
        };
        if let Some(problem) = glued {
            problems.push(problem);
            fields.damaged = true;
            continue;
        }
        // The anchor of `<<: *name` is a problem of its own.
        if key_node.text() == Some("<<") && matches!(value.kind, NodeKind::Unread) {
            fields.damaged = true;
            continue;
        }
        let Some(key) = key(key_node, source, dialect, problems) else {
            fields.damaged = true;
            continue;
        };
        let field = Field { key, key_span: key_node.span, key_node, value };
        if let Some(&first) = seen.get(key) {
            match repeated.entry(key) {
                Entry::Occupied(found) => found.into_mut().add_label(field.key_span, "and here"),
                Entry::Vacant(none) => _ = none.insert(pitfall::key::duplicate(&field, first, owner, source)),
            }
            fields.repeated.push(field);
            continue;
        }
        seen.insert(key, (key_node.span, key_node.span.to(value.span)));
        fields.list.push(field);
    }
    problems.extend(joined(repeated.into_values().collect()));
    fields
}

/// Joins the reports of repeated keys: they are one mistake, mostly a part that was copied, or two parts that were
/// merged.
fn joined(mut repeated: Vec<Diagnostic>) -> Option<Diagnostic> {
    repeated.sort_by_key(|problem| problem.primary.as_ref().map(|label| label.span));
    let mut repeated = repeated.into_iter();
    let mut first = repeated.next()?;
    for other in repeated {
        other.primary.iter().for_each(|label| first.add_label(label.span, "repeated too"));
    }
    Some(first)
}

fn key<'n>(node: &'n Node, source: &SourceFile, dialect: &Dialect, problems: &mut Diagnostics) -> Option<&'n str> {
    let problem = match &node.kind {
        NodeKind::Unread => return None,
        NodeKind::Scalar { text, .. } if text == "<<" && node.is_plain() => {
            pitfall::unsupported::merge_key(node, dialect)
        }
        NodeKind::Scalar { text, .. } if !text.is_empty() => {
            return Some(known_key(node, text, source, dialect, problems));
        }
        _ => pitfall::key::not_a_word(node),
    };
    problems.push(problem);
    None
}

/// The key as written, or the one that it looks like.
fn known_key<'n>(
    node: &Node,
    written: &'n str,
    source: &SourceFile,
    dialect: &Dialect,
    problems: &mut Diagnostics,
) -> &'n str {
    if written.is_ascii() {
        return written;
    }
    let retyped = confusable::retyped(written);
    let Some(known) = (dialect.word)(retyped.trim_matches(['"', '\'', ' '])) else { return written };
    problems.extend(pitfall::look_alike::in_word(node, written, "the key", source));
    known
}
