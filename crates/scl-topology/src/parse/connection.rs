//! The section `connections`.

use super::field::Field;
use super::{Reader, pitfall, scalar, shape};
use crate::confusable;
use crate::diagnostic::{Diagnostic, Edit};
use crate::model::ConnectionModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    pub(super) fn read_connections(&mut self, section: Field<'_>) {
        self.model.connections_key = Some(section.key_span);
        match &section.value.kind {
            NodeKind::Sequence { items } => match shape::pairs::of(items) {
                Some(pairs) => self.read_split_pairs(pairs),
                None => items.iter().for_each(|item| self.read_connection(item)),
            },
            NodeKind::Unread => self.model.cut_off = true,
            // A file without connections gets its own warning.
            _ if section.value.is_null() => {}
            _ => {
                self.remember_broken_ends(section.value);
                self.report(self.glued_dash(section.value).unwrap_or_else(|| {
                    self.glued_or(section.value, shape::section_kind::connections(section, self.source))
                }));
            }
        }
    }

    fn read_split_pairs(&mut self, pairs: Vec<[Spanned<String>; 2]>) {
        self.problems.extend(shape::pairs::diagnose(&pairs, self.source));
        let connection = |ends: [Spanned<String>; 2]| {
            let span = ends[0].span;
            ConnectionModel::new(ends, span)
        };
        self.model.connections.extend(pairs.into_iter().map(connection));
    }

    pub(super) fn read_connection(&mut self, item: &Node) {
        match &item.kind {
            NodeKind::Unread => {}
            NodeKind::Sequence { items } => self.read_ends(item, items),
            NodeKind::Mapping { entries } if self.read_stray_component("connections", item, entries) => {}
            NodeKind::Mapping { .. } => {
                self.report(shape::ends::mapping(item, self.source));
                self.recover_pair(item);
            }
            NodeKind::Scalar { .. } if super::name::is_empty(item) => {
                self.report(pitfall::no_value::in_list(item, "list item", self.source));
            }
            NodeKind::Scalar { text, .. } => {
                let look_alike = pitfall::look_alike::in_word(item, text, "a connection", self.source);
                self.report(
                    look_alike.unwrap_or_else(|| self.glued_or(item, shape::ends::text(item, text, self.source))),
                );
                self.recover_pair(item);
            }
        }
    }

    fn read_ends(&mut self, item: &Node, items: &[Node]) {
        let span = item.span;
        let [first, second] = items else {
            if let [only] = items {
                return self.read_one_end(span, only);
            }
            self.report(shape::ends::count(span, items, self.source));
            return match shape::ends::recovered(item) {
                Some(ends) => self.push_recovered(ends, span),
                None => items.iter().for_each(|item| self.remember_broken_ends(item)),
            };
        };
        if let Some(problem) = shape::ends::branched(span, [first, second], self.source) {
            self.report(problem);
            return self.remember_broken_ends(item);
        }
        match (self.end(first), self.end(second)) {
            (Some(first), Some(second)) => {
                self.model.connections.push(ConnectionModel::new([first, second], span));
            }
            (first, second) => self.model.broken_ends.extend(first.into_iter().chain(second)),
        }
    }

    /// Reads a list of one item, which may be two ends without a comma between them.
    fn read_one_end(&mut self, span: Span, item: &Node) {
        let look_alike =
            scalar(item).and_then(|text| pitfall::look_alike::in_word(item, &text.value, "a connection", self.source));
        self.report(look_alike.unwrap_or_else(|| shape::ends::count(span, std::slice::from_ref(item), self.source)));
        self.recover_pair(item);
    }

    /// The problem of a text that is `-[a.b, c.d]`, or `-- [a.b, c.d]`: a list item with an odd dash.
    fn glued_dash(&self, value: &Node) -> Option<Diagnostic> {
        let NodeKind::Scalar { text, .. } = &value.kind else { return None };
        if !value.is_plain() || !text.starts_with('-') {
            return None;
        }
        if text.starts_with("--") {
            let start = value.span.start as usize;
            let dash = vec![Edit::new(self.source.span(start..start + 1), "")];
            let problem = pitfall::dash::doubled(&(start..start + 2), self.source.text(), self.source);
            return Some(problem.carry(dash, false));
        }
        Some(self.dash_without_space(value.span))
    }

    /// A dash at the start of a value, with no space after it.
    pub(super) fn dash_without_space(&self, value: Span) -> Diagnostic {
        let start = value.start as usize;
        let space = vec![Edit::new(self.source.span(start + 1..start + 1), " ")];
        pitfall::dash::without_space(&(start..start + 1), self.source.text(), self.source).carry(space, false)
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

    /// Reads a pair in another notation, such as `a.b -> c.d` or `a.b: c.d`, as a connection for all later checks.
    fn recover_pair(&mut self, item: &Node) {
        if let Some(ends) = shape::ends::recovered(item) {
            return self.push_recovered(ends, item.span);
        }
        let words = words_of(item);
        match <[Spanned<String>; 2]>::try_from(words) {
            Ok(ends) => self.model.connections.push(ConnectionModel::new(ends, item.span)),
            Err(words) => self.model.broken_ends.extend(words),
        }
    }

    fn push_recovered(&mut self, ends: [String; 2], span: Span) {
        let ends = ends.map(|value| Spanned { value, span });
        self.model.connections.push(ConnectionModel::new(ends, span));
    }

    /// Notes every text in a value of unknown shape, so that no gate named in it is called unconnected.
    pub(super) fn remember_broken_ends(&mut self, node: &Node) {
        self.model.broken_ends.extend(words_of(node));
    }
}

/// Every word in a value, in file order. The depth of the tree bounds the recursion.
fn words_of(node: &Node) -> Vec<Spanned<String>> {
    match &node.kind {
        NodeKind::Unread => Vec::new(),
        NodeKind::Scalar { text, .. } => {
            let text = confusable::retyped(text);
            match shape::ends::words(&text).as_slice() {
                [only] if *only == text => scalar(node).into_iter().collect(),
                words => words
                    .iter()
                    .filter(|word| word.contains('.'))
                    .map(|word| Spanned { value: (*word).to_owned(), span: node.span })
                    .collect(),
            }
        }
        NodeKind::Sequence { items } => items.iter().flat_map(words_of).collect(),
        NodeKind::Mapping { entries } => {
            entries.iter().flat_map(|(key, value)| words_of(key).into_iter().chain(words_of(value))).collect()
        }
    }
}
