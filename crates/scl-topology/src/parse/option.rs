//! The options of a gate.

use super::field::{Field, end_with_colon, spanned_key};
use super::meant::meant;
use super::pitfall::habit::template::placeholder;
use super::{Reader, pitfall, scalar, shape};
use crate::grammar::{DeclaredOptions, GateKind, MEMORY, Shape, memory, option};
use crate::habits;
use crate::model::OptionModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind, Style};

impl Reader<'_> {
    /// One option, if its value has the right shape, or if this kind of gate does not have it: then no value is right.
    pub(super) fn option(&mut self, field: Field<'_>, kind: Option<GateKind>) -> Option<OptionModel> {
        let row = option(field.key)?;
        let value = match row.shape {
            _ if matches!(field.value.kind, NodeKind::Unread) => None,
            _ if kind.is_some_and(|kind| !row.fits(kind)) => Some(self.written(field)),
            shape if field.key == "queue" && kind == Some(GateKind::Pull) && is_word(field.value, shape) => {
                self.report(shape::option_value::group(field, self.source));
                return None;
            }
            Shape::Text => self.text(field),
            Shape::Name | Shape::Codec => self.name_in(field, &format!("value of `{}`", field.key)),
            shape => self.shaped(field, shape),
        }?;
        let quoted = !field.value.is_plain();
        Some(OptionModel { key: spanned_key(field), value, quoted })
    }

    /// A key of another tool for an option that this kind of gate does not have.
    pub(super) fn misplaced(&mut self, field: Field<'_>, kind: Option<GateKind>) -> Option<OptionModel> {
        let (key, value) = shape::unknown_key::misplaced(field, kind?)?;
        let written = self.written(field);
        let value = Spanned { value: value.unwrap_or(written.value), ..written };
        Some(OptionModel { key: Spanned { value: key, span: field.key_span }, value, quoted: false })
    }

    /// A value as it is written; empty behind its key if there is none.
    fn written(&self, field: Field<'_>) -> Spanned<String> {
        let start = end_with_colon(field.key_span, self.source);
        let span = match field.value.is_null() {
            true => Span { start, end: start, ..field.key_span },
            false => field.value.span,
        };
        scalar(field.value)
            .filter(|_| !field.value.is_null())
            .unwrap_or_else(|| Spanned { value: self.source.snippet(span).to_owned(), span })
    }

    /// `queue: 1,000` in braces: the key after the option is the rest of its number.
    pub(super) fn cut_number(
        &mut self,
        field: Field<'_>,
        rest: Field<'_>,
        kind: Option<GateKind>,
    ) -> Option<OptionModel> {
        let span = field.value.span.to(rest.key_span);
        let text = self.source.snippet(span).to_owned();
        let whole = Node { span, kind: NodeKind::Scalar { text, style: Style::Plain } };
        self.option(Field { value: &whole, ..field }, kind)
    }

    /// `true` or `false`.
    pub(super) fn boolean(&mut self, field: Field<'_>) -> Option<bool> {
        self.shaped(field, Shape::Boolean).map(|value| value.value == "true")
    }

    /// A value of this shape, as written.
    pub(super) fn shaped(&mut self, field: Field<'_>, expected: Shape) -> Option<Spanned<String>> {
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
            NodeKind::Scalar { text, .. } if placeholder(text).is_some() => {
                let written = self.source.snippet(field.value.span);
                let at = placeholder(written).unwrap_or(0..written.len());
                let start = field.value.span.start as usize;
                pitfall::habit::template::unfilled(start + at.start..start + at.end, self.source)
            }
            _ => {
                self.report(shape::option_value::diagnose(field, expected, self.source));
                // What follows from the value that is meant is not a mistake.
                let meant = meant(field.key, field.value, expected).values;
                let [value] = <[String; 1]>::try_from(meant).ok()?;
                let is_in_range = match option(field.key) {
                    Some(row) => row.set(&mut DeclaredOptions::default(), &value).is_ok(),
                    None => field.key != MEMORY || memory(&value).is_ok(),
                };
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

/// Whether a value looks like a name, and is not a number in other words.
fn is_word(value: &Node, shape: Shape) -> bool {
    let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.' | '/');
    let is_name = |text: &str| text.starts_with(char::is_alphabetic) && text.chars().all(is_letter);
    value.text().is_some_and(|text| is_name(text) && habits::of_value("queue", text).is_none())
        && meant("queue", value, shape).values.is_empty()
}
