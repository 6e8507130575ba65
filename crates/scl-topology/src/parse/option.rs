//! The options of a gate.

use super::field::{Field, spanned_key};
use super::{Reader, pitfall, scalar, shape};
use crate::grammar::{Shape, option};
use crate::model::OptionModel;
use crate::source::Spanned;
use crate::yaml::NodeKind;

impl Reader<'_> {
    /// One option, if its value has the right shape.
    pub(super) fn option(&mut self, field: Field<'_>) -> Option<OptionModel> {
        let value = match option(field.key)?.shape {
            Shape::Text => self.text(field),
            Shape::Name | Shape::Codec => self.name_in(field, &format!("value of `{}`", field.key)),
            shape => self.shaped(field, shape),
        }?;
        let quoted = !field.value.is_plain();
        Some(OptionModel { key: spanned_key(field), value, quoted })
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
            NodeKind::Scalar { text, .. } if expected.fits(text, field.value.is_plain()) => {
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
