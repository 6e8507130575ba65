//! A name, wherever one stands: of a component, a gate, a type, a file.

use super::field::Field;
use super::{Reader, pitfall, scalar, shape};
use crate::confusable;
use crate::source::Spanned;
use crate::yaml::{Node, NodeKind, Style};

impl Reader<'_> {
    /// The name in the value of a key; `what` is its part in a message, for example `component name`.
    pub(super) fn name_in(&mut self, field: Field<'_>, what: &str) -> Option<Spanned<String>> {
        if is_empty(field.value) {
            self.report(pitfall::no_value::in_field(field, what, self.source));
            return None;
        }
        self.name(field.value, what, &format!("`{}`", field.key))
    }

    /// The name that a node is; `place` is where it stands, for example `` `name` ``.
    pub(super) fn name(&mut self, node: &Node, what: &str, place: &str) -> Option<Spanned<String>> {
        match &node.kind {
            NodeKind::Unread => return None,
            NodeKind::Scalar { .. } if is_empty(node) => {
                self.report(pitfall::no_value::in_list(node, what, self.source));
                return None;
            }
            NodeKind::Scalar { text, style: Style::Block } => {
                self.report(pitfall::misread_name::text_block(node, text, self.source));
                let value = text.trim().to_owned();
                return (!value.is_empty() && !value.contains('\n')).then_some(Spanned { value, span: node.span });
            }
            // YAML reads some texts without quotes as booleans or numbers.
            NodeKind::Scalar { text, .. } if node.is_plain() => self.problems.extend(
                pitfall::misread_name::find_boolean(text, node.span)
                    .or_else(|| pitfall::misread_name::find_number(text, node.span)),
            ),
            NodeKind::Scalar { .. } => {}
            _ => {
                self.report(shape::option_value::not_text(place, node));
                return None;
            }
        }
        scalar(node).map(|word| self.in_ascii(node, word, what))
    }

    /// Reports characters of a word that only look like ASCII characters, and returns the word with the ones that were
    /// meant.
    pub(super) fn in_ascii(&mut self, node: &Node, word: Spanned<String>, what: &str) -> Spanned<String> {
        // Files may have any name.
        if word.value.is_ascii() || matches!(what, "schema file" | "folder of schemas" | "included file") {
            return word;
        }
        let Some(problem) = pitfall::look_alike::in_word(node, &word.value, what, self.source) else { return word };
        self.report(problem);
        let retyped = confusable::retyped(&word.value);
        Spanned { value: retyped.trim_matches(['"', '\'', ' ']).to_owned(), ..word }
    }
}

/// Nothing at all, or quotes with nothing in them.
pub(super) fn is_empty(node: &Node) -> bool {
    node.is_null() || matches!(&node.kind, NodeKind::Scalar { text, .. } if text.trim().is_empty())
}
