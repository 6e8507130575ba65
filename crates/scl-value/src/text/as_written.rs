//! The second pass over a YAML text, which adds to the scalars of the first pass how they were written.

use crate::value::{Value, Written, key_text};
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// The value that the first pass read at the same place of the text.
pub(super) struct AsWritten(pub(super) Value);

impl<'de> DeserializeSeed<'de> for AsWritten {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        match self.0 {
            Value::List(_) => input.deserialize_seq(self),
            Value::Map(_) => input.deserialize_map(self),
            meaning @ (Value::Null | Value::Bool(_) | Value::Int(_) | Value::Uint(_) | Value::Float(_)) => {
                // Deserialized as a string, a scalar is returned as it was written.
                let text = String::deserialize(input)?;
                let is_lost = !text.is_empty() && text != key_text(&meaning);
                Ok(if is_lost { Value::Written(Box::new(Written { text, meaning })) } else { meaning })
            }
            // YAML 1.1 and 1.2 read different numbers here, so it stays a text.
            Value::Text(text) if has_leading_zero(&text) => {
                IgnoredAny::deserialize(input)?;
                Ok(Value::Written(Box::new(Written { meaning: Value::Text(text.clone()), text })))
            }
            other => {
                IgnoredAny::deserialize(input)?;
                Ok(other)
            }
        }
    }
}

/// Whether a text is a number with digits after a leading zero.
fn has_leading_zero(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    let mut bytes = digits.bytes();
    bytes.next() == Some(b'0')
        && bytes.next().is_some_and(|byte| byte.is_ascii_digit())
        && digits.parse::<f64>().is_ok()
}

impl<'de> Visitor<'de> for AsWritten {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the list or map of the first reading")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let Value::List(mut items) = self.0 else { return Err(A::Error::custom("it was no list")) };
        for item in &mut items {
            let read = AsWritten(std::mem::replace(item, Value::Null));
            *item = input.next_element_seed(read)?.ok_or_else(|| A::Error::custom("an item is missing"))?;
        }
        // A YAML list ends only when another element is requested.
        input.next_element::<IgnoredAny>()?;
        Ok(Value::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let Value::Map(mut entries) = self.0 else { return Err(A::Error::custom("it was no map")) };
        for (key, value) in &mut entries {
            let read = AsWritten(std::mem::replace(key, Value::Null));
            *key = input.next_key_seed(read)?.ok_or_else(|| A::Error::custom("a key is missing"))?;
            *value = input.next_value_seed(AsWritten(std::mem::replace(value, Value::Null)))?;
        }
        input.next_key::<IgnoredAny>()?;
        Ok(Value::Map(entries))
    }
}

#[cfg(test)]
mod tests {
    use crate::value::{Value, key_text};
    use crate::{read_yaml, to_json};

    /// The scalars of a text as written, and their meaning.
    fn scalars(text: &str) -> String {
        let value = read_yaml(text).unwrap();
        let mut open = vec![&value];
        let mut told = Vec::new();
        while let Some(value) = open.pop() {
            match value {
                Value::List(items) => open.extend(items.iter().rev()),
                Value::Map(entries) => open.extend(entries.iter().rev().flat_map(|(key, value)| [value, key])),
                Value::Written(written) => told.push(format!("{}={}", written.text, to_json(&written.meaning))),
                other => told.push(key_text(other)),
            }
        }
        told.join(" ")
    }

    #[test]
    fn what_was_written_is_kept_where_its_meaning_loses_it() {
        let cases = [
            ("[0x10, 0x1F, 0o17, 0b11, +5, -0]", "0x10=16 0x1F=31 0o17=15 0b11=3 +5=5 -0=0"),
            ("[1.10, 1.0, 1e3, .5, 1.84]", "1.10=1.1 1.0 1e3=1000.0 .5=0.5 1.84"),
            ("[True, true, ~, null, NULL]", "True=true true ~=null null NULL=null"),
            ("{a: , b: !x 0x10}", "a null b 0x10=16"),
            ("[.inf, -.INF, .NaN]", ".inf=\"Infinity\" -.INF=\"-Infinity\" .NaN=\"NaN\""),
            (
                "[18446744073709551615, 18446744073709551616]",
                "18446744073709551615 18446744073709551616=1.8446744073709552e+19",
            ),
            ("[017, 00, 0, '017', 007.5, 0x]", "017=\"017\" 00=\"00\" 0 017=\"017\" 007.5=7.5 0x"),
            ("[yes, on, 2026-01-02, 1_000, 12:30, '0x10', \"1.10\"]", "yes on 2026-01-02 1_000 12:30 0x10 1.10"),
            ("{0x10: {1.10: [0x2]}, ~: a}", "0x10=16 1.10=1.1 0x2=2 ~=null a"),
            ("a: &a [0x10]\nb: *a", "a 0x10=16 b 0x10=16"),
            ("- 0x1\n- !binary AQL/\n- |\n  0x2\n- {}\n- []\n- 0x3", "0x1=1 \"AQL/\" 0x2\n 0x3=3"),
            ("0x10", "0x10=16"),
        ];
        for (text, expected) in cases {
            assert_eq!(scalars(text), expected, "{text}");
        }
    }
}
