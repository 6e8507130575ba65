//! The options of a gate.

use super::field::{Field, spanned_key};
use super::meant::meant;
use super::{Reader, pitfall, scalar, shape};
use crate::grammar::{DeclaredOptions, Shape, option};
use crate::model::OptionModel;
use crate::source::Spanned;
use crate::yaml::{Node, NodeKind, Style};

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

    /// `queue: 1,000` in braces: the key after the option is the rest of its number.
    pub(super) fn cut_number(&mut self, field: Field<'_>, rest: Field<'_>) -> Option<OptionModel> {
        let span = field.value.span.to(rest.key_span);
        let text = self.source.snippet(span).to_owned();
        let whole = Node { span, kind: NodeKind::Scalar { text, style: Style::Plain } };
        self.option(Field { value: &whole, ..field })
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
            _ => {
                self.report(shape::option_value::diagnose(field, expected));
                // What follows from the value that is meant is not a mistake.
                let meant = meant(field.key, field.value, expected).values;
                let [value] = <[String; 1]>::try_from(meant).ok()?;
                let is_in_range =
                    option(field.key).is_none_or(|row| row.set(&mut DeclaredOptions::default(), &value).is_ok());
                if !is_in_range {
                    return None;
                }
                return Some(Spanned { value, span: field.value.span });
            }
        };
        self.report(problem);
        None
    }
}
