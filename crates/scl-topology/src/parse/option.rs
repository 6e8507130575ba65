//! The options of a gate.

use super::fields::Field;
use super::{Reader, is_plain, pitfall, scalar, shape};
use crate::grammar::{GateKind, OPTIONS, Shape, option};
use crate::model::OptionModel;
use crate::source::Spanned;
use crate::suggest::similar;
use crate::yaml::NodeKind;

/// Whether this key is an option of some gate.
pub(super) fn is_key(key: &str) -> bool {
    option(key).is_some()
}

/// Whether this key is an option, or looks more like one than like a kind.
pub(super) fn is_like(key: &str) -> bool {
    let kinds = GateKind::ALL.map(GateKind::word);
    is_key(key) || similar(key, kinds).is_empty() && !similar(key, OPTIONS.iter().map(|option| option.key)).is_empty()
}

impl Reader<'_> {
    /// One option, if its value has the right shape.
    pub(super) fn option(&mut self, field: Field<'_>) -> Option<OptionModel> {
        let value = match option(field.key)?.shape {
            Shape::Text => self.text(field),
            Shape::Name | Shape::Codec => self.name_in(field, &format!("value of `{}`", field.key)),
            shape => self.shaped(field, shape),
        }?;
        let quoted = !is_plain(field.value);
        Some(OptionModel { key: super::sections::spanned_key(field), value, quoted })
    }

    /// `true` or `false`.
    pub(super) fn boolean(&mut self, field: Field<'_>) -> Option<bool> {
        self.shaped(field, Shape::Boolean).map(|value| value.value == "true")
    }

    fn shaped(&mut self, field: Field<'_>, expected: Shape) -> Option<Spanned<String>> {
        let problem = match &field.value.kind {
            NodeKind::Unread => return None,
            _ if super::name::is_empty(field.value) => {
                pitfall::no_value::in_field(field, &format!("value of `{}`", field.key), self.source)
            }
            NodeKind::Scalar { text, .. } if expected.fits(text, is_plain(field.value)) => {
                match pitfall::leading_zero::find(field, text) {
                    Some(problem) if matches!(expected, Shape::Number { .. }) => problem,
                    _ => return scalar(field.value),
                }
            }
            _ => shape::option_value::diagnose(field, expected),
        };
        self.report(problem);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::is_like;

    #[test]
    fn a_misspelt_kind_is_no_option() {
        for (key, like) in [("queue", true), ("que", true), ("publ", false), ("publish", false), ("reqq", false)] {
            assert_eq!(is_like(key), like, "{key}");
        }
    }
}
