//! The options of a gate, and the kinds of value that they take.

use super::fields::Field;
use super::{Reader, is_plain, pitfall, scalar, shape};
use crate::model::OptionModel;
use crate::size::{self, SizeError};
use crate::source::Spanned;
use crate::suggest::similar;
use crate::topology::{GateKind, WhenFull};
use crate::yaml::{NodeKind, Style};

/// What a value must look like; its range is not checked here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Value {
    /// A paragraph.
    Text,
    /// A name of one word or path.
    Name,
    /// A whole number, perhaps out of range.
    Number,
    /// A number and a unit of time.
    Duration,
    /// A whole number and a unit of [`size`].
    Size,
    /// `true` or `false`.
    Boolean,
    /// One of some words.
    Word(&'static [&'static str]),
}

/// An option: its key, the shape of its value, the kinds of gate that have it.
pub(crate) struct OptionRule {
    pub(crate) key: &'static str,
    pub(crate) value: Value,
    pub(crate) kinds: &'static [GateKind],
}

use GateKind::{Pub, Pull, Push, Rep, Req, Sub};

/// All options, in the order in which messages list them.
pub(crate) const OPTIONS: [OptionRule; 9] = [
    OptionRule { key: "doc", value: Value::Text, kinds: &GateKind::ALL },
    OptionRule { key: "codec", value: Value::Name, kinds: &GateKind::ALL },
    OptionRule { key: "queue", value: Value::Number, kinds: &[Sub, Pull] },
    OptionRule { key: "when_full", value: Value::Word(&WhenFull::WORDS), kinds: &[Sub, Pull] },
    OptionRule { key: "backpressure", value: Value::Boolean, kinds: &[Pub, Push] },
    OptionRule { key: "max_size", value: Value::Size, kinds: &[Sub, Pull, Req, Rep] },
    OptionRule { key: "timeout", value: Value::Duration, kinds: &[Req] },
    OptionRule { key: "share", value: Value::Boolean, kinds: &[Push] },
    OptionRule { key: "unconnected", value: Value::Word(&["ok"]), kinds: &GateKind::ALL },
];

/// The rule of an option.
pub(crate) fn rule(key: &str) -> Option<&'static OptionRule> {
    OPTIONS.iter().find(|option| option.key == key)
}

/// Whether this key is an option of some gate.
pub(super) fn is_key(key: &str) -> bool {
    rule(key).is_some()
}

/// Whether this key is an option, or looks more like one than like a kind.
pub(super) fn is_like(key: &str) -> bool {
    let kinds = GateKind::ALL.map(GateKind::word);
    is_key(key) || similar(key, kinds).is_empty() && !similar(key, OPTIONS.iter().map(|option| option.key)).is_empty()
}

impl Reader<'_> {
    /// One option, if its value has the right shape.
    pub(super) fn option(&mut self, field: Field<'_>) -> Option<OptionModel> {
        let rule = rule(field.key)?;
        let value = match rule.value {
            Value::Text => self.text(field),
            Value::Name => self.name_in(field, &format!("value of `{}`", field.key)),
            shape => self.shaped(field, shape),
        }?;
        let quoted = !is_plain(field.value);
        Some(OptionModel { key: super::sections::spanned_key(field), value, quoted })
    }

    /// `true` or `false`.
    pub(super) fn boolean(&mut self, field: Field<'_>) -> Option<bool> {
        self.shaped(field, Value::Boolean).map(|value| value.value == "true")
    }

    fn shaped(&mut self, field: Field<'_>, expected: Value) -> Option<Spanned<String>> {
        let problem = match &field.value.kind {
            NodeKind::Unread => return None,
            _ if super::name::is_empty(field.value) => {
                pitfall::no_value::in_field(field, &format!("value of `{}`", field.key), self.source)
            }
            NodeKind::Scalar { text, style } if fits(text, *style, expected) => return scalar(field.value),
            _ => shape::option_value::diagnose(field, expected),
        };
        self.report(problem);
        None
    }
}

fn fits(text: &str, style: Style, expected: Value) -> bool {
    match expected {
        Value::Number => style == Style::Plain && is_whole_number(text),
        Value::Boolean => style == Style::Plain && matches!(text, "true" | "false"),
        Value::Duration => is_duration(text),
        // A size that is too large is a matter of range.
        Value::Size => size::parse(text) != Err(SizeError::Malformed),
        Value::Word(words) => words.contains(&text),
        Value::Text | Value::Name => true,
    }
}

/// Digits, perhaps with a sign; the sign is a matter of range.
pub(super) fn is_whole_number(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// A number, perhaps with a fraction, and one of the units `us`, `ms`, `s`.
fn is_duration(text: &str) -> bool {
    let number = ["us", "ms", "s"].iter().find_map(|unit| text.strip_suffix(unit)).unwrap_or("").trim_end();
    let number = number.strip_prefix(['-', '+']).unwrap_or(number);
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    [whole, fraction].iter().all(|part| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::{is_duration, is_like, is_whole_number};

    #[test]
    fn numbers_and_durations() {
        for good in ["0", "16", "-1", "+4"] {
            assert!(is_whole_number(good), "{good}");
        }
        for bad in ["", "-", "1.5", "0x10", "1_000", "many", "1e3"] {
            assert!(!is_whole_number(bad), "{bad}");
        }
        for good in ["500ms", "1s", "1.5 s", "20us", "0s", "-1s"] {
            assert!(is_duration(good), "{good}");
        }
        for bad in ["", "s", "500", "1 min", "ms500", "1.s", ".5s", "1h", "1 000ms"] {
            assert!(!is_duration(bad), "{bad}");
        }
    }

    #[test]
    fn a_misspelt_kind_is_no_option() {
        for (key, like) in [("queue", true), ("que", true), ("publ", false), ("publish", false), ("reqq", false)] {
            assert_eq!(is_like(key), like, "{key}");
        }
    }
}
