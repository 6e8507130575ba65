//! Values as texts that can be compared.

use super::{EXACT, Value};
use std::fmt::Write;

/// A text that two values have in common if they mean the same: maps in any order, whole numbers of any kind.
pub(crate) fn canonical(value: &Value) -> String {
    let mut text = String::new();
    write(&mut text, value);
    text
}

fn write(text: &mut String, value: &Value) {
    // Writing into a text cannot fail.
    let _written = match value {
        Value::Null => write!(text, "null"),
        Value::Bool(flag) => write!(text, "{flag}"),
        Value::Int(number) => write!(text, "{number}"),
        Value::Uint(number) => write!(text, "{number}"),
        Value::Float(number) if number.fract() == 0.0 && number.abs() <= EXACT as f64 => {
            write!(text, "{}", *number as i64)
        }
        Value::Float(number) => write!(text, "{number:e}"),
        Value::Text(content) => write!(text, "{content:?}"),
        Value::Bytes(bytes) => write!(text, "bytes{bytes:?}"),
        Value::List(items) => {
            text.push('[');
            for item in items {
                write(text, item);
                text.push(',');
            }
            write!(text, "]")
        }
        Value::Map(entries) => {
            let mut sorted: Vec<_> = entries.iter().map(|(key, value)| (canonical(key), value)).collect();
            sorted.sort_by(|(one, _), (other, _)| one.cmp(other));
            text.push('{');
            for (key, value) in sorted {
                text.push_str(&key);
                text.push(':');
                write(text, value);
                text.push(',');
            }
            write!(text, "}}")
        }
        Value::Opaque(opaque) => write!(text, "opaque{opaque:?}"),
        Value::Written(written) => return write(text, &written.meaning),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_yaml;

    #[test]
    fn equal_values_have_the_same_text() {
        let canonical = |yaml| canonical(&read_yaml(yaml).unwrap());
        for (one, other) in [
            ("{a: 1, b: {c: [1, 2], d: x}}", "{b: {d: x, c: [1.0, 2]}, a: 1e0}"),
            ("{x: -0.0}", "{x: 0}"),
            ("{10: a, 9: b}", "{9: b, 10: a}"),
            ("{a: .nan}", "{a: .nan}"),
        ] {
            assert_eq!(canonical(one), canonical(other));
        }
        for (one, other) in [
            ("{a: 1}", "{a: '1'}"),
            ("[1, 2]", "[2, 1]"),
            ("{a: 9007199254740993}", "{a: 9007199254740992}"),
            ("{a: !binary AQL/}", "{a: AQL/}"),
            ("{a: 0.1}", "{a: 0.10000001}"),
            ("{a: {}}", "{a: []}"),
            ("['a', 'b']", "['a,\"b']"),
        ] {
            assert_ne!(canonical(one), canonical(other));
        }
    }
}
