//! The section `connections`.

use super::fields::Field;
use super::{Reader, pitfall, scalar, shape};
use crate::model::ConnectionModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    pub(super) fn read_connections(&mut self, section: Field<'_>) {
        self.model.connections_key = Some(section.key_span);
        match &section.value.kind {
            NodeKind::Sequence { items } => items.iter().for_each(|item| self.read_connection(item)),
            NodeKind::Unread => self.model.cut_off = true,
            // No connections is a warning of its own.
            _ if section.value.is_null() => {}
            _ => {
                self.remember_broken_ends(section.value);
                self.report(shape::section_kind::connections(section));
            }
        }
    }

    fn read_connection(&mut self, item: &Node) {
        match &item.kind {
            NodeKind::Unread => {}
            NodeKind::Sequence { items } => self.read_ends(item.span, items),
            NodeKind::Mapping { .. } => {
                self.report(shape::ends::mapping(item));
                self.recover_pair(item);
            }
            NodeKind::Scalar { .. } if super::name::is_empty(item) => {
                self.report(pitfall::no_value::in_list(item, "list item", self.source));
            }
            NodeKind::Scalar { text, .. } => {
                let problem = self.glued_or(item, shape::ends::text(item, text));
                self.report(problem);
                self.recover_pair(item);
            }
        }
    }

    fn read_ends(&mut self, span: Span, items: &[Node]) {
        let [first, second] = items else {
            self.report(shape::ends::count(span, items));
            return items.iter().for_each(|item| self.remember_broken_ends(item));
        };
        match (self.end(first), self.end(second)) {
            (Some(first), Some(second)) => {
                self.model.connections.push(ConnectionModel { ends: [first, second], span });
            }
            (first, second) => self.model.broken_ends.extend(first.into_iter().chain(second)),
        }
    }

    fn end(&mut self, node: &Node) -> Option<Spanned<String>> {
        match &node.kind {
            NodeKind::Sequence { .. } | NodeKind::Mapping { .. } => {
                self.report(shape::ends::end_is_not_text(node));
                self.remember_broken_ends(node);
                None
            }
            _ => self.name(node, "end of the connection", "an end of a connection"),
        }
    }

    /// A pair in the wrong clothes, such as `a.b -> c.d` or `a.b: c.d`, is a connection for all later checks.
    fn recover_pair(&mut self, item: &Node) {
        let words = words_of(item);
        match <[Spanned<String>; 2]>::try_from(words) {
            Ok(ends) => self.model.connections.push(ConnectionModel { ends, span: item.span }),
            Err(words) => self.model.broken_ends.extend(words),
        }
    }

    /// Notes every text in a value of unknown shape, so that no gate named in it is called unconnected.
    pub(super) fn remember_broken_ends(&mut self, node: &Node) {
        self.model.broken_ends.extend(words_of(node));
    }
}

/// Every word in a value, in file order. The depth of the tree is limited, so that of the recursion is.
fn words_of(node: &Node) -> Vec<Spanned<String>> {
    match &node.kind {
        NodeKind::Unread => Vec::new(),
        NodeKind::Scalar { text, .. } => match text.split_whitespace().collect::<Vec<_>>().as_slice() {
            [_] => scalar(node).into_iter().collect(),
            words => words
                .iter()
                .map(|word| word.trim_matches([',', '[', ']']))
                .filter(|word| word.contains('.'))
                .map(|word| Spanned { value: word.to_owned(), span: node.span })
                .collect(),
        },
        NodeKind::Sequence { items } => items.iter().flat_map(words_of).collect(),
        NodeKind::Mapping { entries } => {
            entries.iter().flat_map(|(key, value)| words_of(key).into_iter().chain(words_of(value))).collect()
        }
    }
}
