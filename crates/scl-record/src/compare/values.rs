//! Whether two messages are equal, and where they differ.

use super::CompareOptions;
use super::side::{Side, Waiting};
use scl_terminal::{Problem, escape};
use scl_text::excerpt::start_of;
use scl_value::{FieldPath, MessageType, Opaque, Value, key_text, to_json};

/// Maximum number of characters shown of a value.
const SHOWN: usize = 60;

/// The rules of a comparison: which fields are compared, and with which tolerances.
pub(super) struct Rules<'o> {
    options: &'o CompareOptions,
    /// For each named field, whether any compared message had it.
    found: Vec<bool>,
}

/// The first field in which two messages differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FieldDifference {
    /// Empty for the message itself.
    pub(super) field: FieldPath,
    /// Both values as JSON; `None` if the message has no such field.
    pub(super) values: [Option<String>; 2],
}

impl<'o> Rules<'o> {
    pub(super) fn new(options: &'o CompareOptions) -> Self {
        Self { options, found: vec![false; options.fields.len()] }
    }

    /// Compares two messages; `None` if they are equal.
    pub(super) fn difference(&mut self, sides: &[Side; 2], messages: [&Waiting; 2]) -> Option<FieldDifference> {
        let [first, second] = messages;
        if first.payload == second.payload && self.found.iter().all(|found| *found) {
            return None;
        }
        let values = [first.value(&sides[0]), second.value(&sides[1])];
        let [Some(one), Some(other)] = values else { return bytes_difference(messages) };
        if self.found.is_empty() {
            return self.value_difference(FieldPath::default(), Some(one), Some(other));
        }
        let mut difference = None;
        for (index, field) in self.options.fields.iter().enumerate() {
            let values = [field.find(one), field.find(other)];
            self.found[index] |= values.iter().any(Option::is_some);
            if difference.is_none() {
                difference = self.value_difference(field.clone(), values[0], values[1]);
            }
        }
        difference
    }

    /// Checks that each of the named fields was in a message: a misspelt one would never differ.
    pub(super) fn check_fields(&self) -> Result<(), Problem> {
        match self.options.fields.iter().zip(&self.found).find(|(_, found)| !**found) {
            Some((field, _)) => Err(Problem::new(format!("no compared message has a field `{field}`"))
                .help("`scl compare` without `--field` names the fields that differ")),
            None => Ok(()),
        }
    }

    fn value_difference(
        &self,
        field: FieldPath,
        one: Option<&Value>,
        other: Option<&Value>,
    ) -> Option<FieldDifference> {
        match (one, other) {
            (Some(Value::Map(ones)), Some(Value::Map(others))) => {
                let keys = ones.iter().map(|(key, _)| key);
                let more = others.iter().map(|(key, _)| key).filter(|key| !ones.iter().any(|(known, _)| known == *key));
                let value = |map: &'_ [(Value, Value)], key: &Value| map.iter().position(|(known, _)| known == key);
                keys.chain(more).find_map(|key| {
                    let name = key_text(key);
                    let one = value(ones, key).map(|index| &ones[index].1);
                    let other = value(others, key).map(|index| &others[index].1);
                    self.value_difference(field.clone().field(&name), one, other)
                })
            }
            (Some(Value::List(ones)), Some(Value::List(others))) => {
                (0..ones.len().max(others.len())).find_map(|index| {
                    self.value_difference(field.clone().element(index), ones.get(index), others.get(index))
                })
            }
            (Some(one), Some(other)) if self.are_equal(one, other) => None,
            (None, None) => None,
            _ => Some(FieldDifference { field, values: [one.map(shown), other.map(shown)] }),
        }
    }

    fn are_equal(&self, one: &Value, other: &Value) -> bool {
        let are_same = one == other;
        let (Some(one), Some(other)) = (one.as_number(), other.as_number()) else { return are_same };
        let larger = one.abs().max(other.abs());
        let CompareOptions { within, relative, .. } = *self.options;
        let tolerance = within.max(relative * larger);
        // -0.0 equals 0.0, but a program that divides by it gets a different result.
        if larger == 0.0 && one.is_sign_negative() != other.is_sign_negative() {
            return within > 0.0 || relative > 0.0;
        }
        if are_same {
            return true;
        }
        // Decimal numbers that differ by exactly the tolerance may differ by slightly more in binary.
        let rounding = 4.0 * f64::EPSILON * larger;
        let is_near = tolerance > 0.0 && (one - other).abs() <= tolerance + rounding;
        is_near || one.is_nan() && other.is_nan() || one == other && is_exact(one)
    }
}

fn bytes_difference(messages: [&Waiting; 2]) -> Option<FieldDifference> {
    if messages[0].payload == messages[1].payload {
        return None;
    }
    let values = messages.map(|message| Some(shown_bytes(&message.payload)));
    Some(FieldDifference { field: FieldPath::default(), values })
}

/// Whether `f64` represents every whole number of this size exactly.
fn is_exact(number: f64) -> bool {
    number.abs() < (1_u64 << 53) as f64
}

/// A message as JSON, or its bytes if it cannot be decoded.
pub(super) fn shown_message(message_type: &MessageType, payload: &[u8]) -> String {
    match message_type.decode(payload) {
        Ok(Value::Opaque(_)) | Err(_) => shown_bytes(payload),
        Ok(value) => shown(&value),
    }
}

fn shown_bytes(payload: &[u8]) -> String {
    let Opaque { length, hex, .. } = Opaque::new(payload, "");
    cut(&format!("{length} bytes: {hex}"))
}

/// A value as JSON, safe for a terminal and not too long.
fn shown(value: &Value) -> String {
    cut(&to_json(value))
}

fn cut(text: &str) -> String {
    start_of(&escape(text), SHOWN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differs(options: &CompareOptions, one: Value, other: Value) -> Option<String> {
        let FieldDifference { field, values } =
            Rules::new(options).value_difference(FieldPath::default(), Some(&one), Some(&other))?;
        let [one, other] = values.map(|value| value.unwrap_or_else(|| "nothing".to_owned()));
        Some(format!("{field}: {one} {other}"))
    }

    #[test]
    fn numbers_are_equal_within_the_tolerances_and_all_else_exactly() {
        let exact = CompareOptions::default();
        let near = CompareOptions { within: 0.1, ..CompareOptions::default() };
        let relative = CompareOptions { relative: 0.01, ..CompareOptions::default() };
        let pose = |x: f64| Value::fields([("pose", Value::List(vec![x.into(), 2.0.into()]))]);
        let big = 1_u64 << 60;
        let cases = [
            (&exact, pose(1.0), pose(1.0), None),
            (&exact, pose(1.0), pose(1.000_001), Some("pose[0]: 1.0 1.000001")),
            (&near, pose(1.0), pose(1.1), None),
            (&near, pose(1.0), pose(1.11), Some("pose[0]: 1.0 1.11")),
            (&near, pose(f64::NAN), pose(f64::NAN), None),
            (&relative, pose(1000.0), pose(1009.0), None),
            (&relative, pose(1000.0), pose(1011.0), Some("pose[0]: 1000.0 1011.0")),
            (&exact, Value::Int(2), Value::Float(2.0), None),
            (&exact, pose(0.0), pose(-0.0), Some("pose[0]: 0.0 -0.0")),
            (&exact, pose(-0.0), pose(-0.0), None),
            (&near, pose(0.0), pose(-0.0), None),
            (&relative, pose(0.0), pose(-0.0), None),
            (
                &exact,
                Value::Uint(u64::MAX),
                Value::Uint(u64::MAX - 1),
                Some(".: 18446744073709551615 18446744073709551614"),
            ),
            (&exact, big.into(), (big + 1).into(), Some(".: 1152921504606846976 1152921504606846977")),
            (&near, "1".into(), "1.01".into(), Some(".: \"1\" \"1.01\"")),
            (&near, Value::List(vec![]), Value::List(vec![Value::Int(1)]), Some("[0]: nothing 1")),
            (&near, Value::fields([("a", Value::Int(1))]), Value::fields([("b", Value::Int(1))]), Some("a: 1 nothing")),
            (&near, Value::Null, false.into(), Some(".: null false")),
        ];
        for (rules, one, other, expected) in cases {
            assert_eq!(differs(rules, one.clone(), other.clone()).as_deref(), expected, "{one:?} {other:?}");
        }
    }
}
