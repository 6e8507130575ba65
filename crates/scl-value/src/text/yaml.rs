//! Values as YAML, and from YAML or JSON, as users write them.

use super::as_written::AsWritten;
use crate::limits::Budget;
use crate::self_describing::{AnyValue, read_json};
use crate::value::{Format, InFormat, Value, to_json};
use scl_terminal::Problem;
use serde::de::DeserializeSeed;
use thiserror::Error;

/// The byte order mark that may precede a text in UTF-8.
pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// A text is not one value in YAML or JSON.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("this message is not valid YAML or JSON: {reason}")]
pub struct ReadError {
    reason: String,
}

impl From<ReadError> for Problem {
    fn from(error: ReadError) -> Self {
        Problem::new(error.to_string()).help("write for example '{speed: 1.0, unit: m/s}', quoted for the shell")
    }
}

/// Reads a value from YAML, which includes JSON: `{speed: 1.0}`. An empty text is an empty map. A byte order mark is
/// ignored.
///
/// # Errors
/// The text is not YAML, has several documents, or unfolds into too many values.
pub fn read_yaml(text: &str) -> Result<Value, ReadError> {
    // Windows editors may put it at the start of a file.
    let text = text.trim_start_matches(BYTE_ORDER_MARK);
    if text.trim().is_empty() {
        return Ok(Value::Map(Vec::new()));
    }
    let input = || serde_yaml::Deserializer::from_str(text);
    // Not all JSON is valid YAML: for example, YAML does not allow unescaped control characters above U+007E.
    let read = read_json(text.as_bytes()).or_else(|_| AnyValue::new(&Budget::new()).deserialize(input()));
    let value = read.map_err(|error| ReadError { reason: error.to_string() })?;
    Ok(AsWritten(value.clone()).deserialize(input()).unwrap_or(value))
}

/// A value as YAML, as a user would write it, with a newline at the end. `read_yaml` reads it back.
pub fn to_yaml(value: &Value) -> String {
    serde_yaml::to_string(&InFormat(value, Format::Yaml)).unwrap_or_else(|_| format!("{}\n", to_json(value)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::expect;

    #[test]
    fn yaml_looks_as_a_user_would_write_it() {
        let value = Value::fields([
            ("speed", 1.84.into()),
            ("whole", 1.0.into()),
            ("count", Value::Int(-3)),
            ("nan", f64::NAN.into()),
            ("infinite", f64::NEG_INFINITY.into()),
            ("unit", "m/s".into()),
            ("digits", "12".into()),
            ("escape", "a\u{1b}[31m\u{9b}".into()),
            ("lines", "a\nb".into()),
            ("bytes", Value::Bytes(vec![1, 2, 255])),
            ("list", Value::List(vec![Value::Int(1), Value::fields([("x", Value::Null)])])),
            ("empty", Value::Map(Vec::new())),
            ("map", Value::Map(vec![(Value::Int(7), true.into())])),
        ]);
        let text = to_yaml(&value);
        expect![[r#"
            speed: 1.84
            whole: 1.0
            count: -3
            nan: .nan
            infinite: -.inf
            unit: m/s
            digits: '12'
            escape: "a\e[31m\x9B"
            lines: |-
              a
              b
            bytes: !binary AQL/
            list:
            - 1
            - x: null
            empty: {}
            map:
              7: true
        "#]]
        .assert_eq(&text);
        let back = read_yaml(&text).unwrap();
        assert_eq!(to_yaml(&back), text);
    }

    #[test]
    fn texts_of_the_command_line_are_yaml_or_json() {
        let cases = [
            ("{speed: 1.0}", r#"{"speed":1.0}"#),
            (r#"{"speed": 1, "unit": "m/s"}"#, r#"{"speed":1,"unit":"m/s"}"#),
            ("speed: 1e3\nlist:\n- a\n- yes", r#"{"speed":1000.0,"list":["a","yes"]}"#),
            ("", "{}"),
            ("{\"a\": \"\u{7f}\u{9b}\", \"b\": \"\\ud83d\\ude00\"}", "{\"a\":\"\\u007f\\u009b\",\"b\":\"😀\"}"),
            ("\u{feff}", "{}"),
            ("\u{feff}{a: 1}", r#"{"a":1}"#),
            ("3", "3"),
            ("!binary AQL/", r#""AQL/""#),
            ("{bytes: !binary AQL/}", r#"{"bytes":"AQL/"}"#),
            ("18446744073709551615", "18446744073709551615"),
        ];
        for (text, expected) in cases {
            assert_eq!(to_json(&read_yaml(text).unwrap()), expected, "{text}");
        }
        assert_eq!(read_yaml("!binary AQL/").unwrap(), Value::Bytes(vec![1, 2, 255]));
    }

    #[test]
    fn a_mistake_says_where_it_is() {
        expect!["this message is not valid YAML or JSON: did not find expected ',' or '}' at line 2 column 1, while parsing a flow mapping"].assert_eq(&read_yaml("{speed: 1").unwrap_err().to_string());
        expect!["this message is not valid YAML or JSON: deserializing from YAML containing more than one document is not supported"].assert_eq(&read_yaml("a: 1\n---\nb: 2").unwrap_err().to_string());
    }
}
