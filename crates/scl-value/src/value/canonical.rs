//! The canonical form of values, for comparisons.

use super::{EXACT, Value};

/// Returns the form that all values with the same meaning have in common: maps are in one order, whole numbers of one
/// kind.
pub(crate) fn canonical(value: &Value) -> Value {
    match value {
        Value::Float(number) if number.fract() == 0.0 && number.abs() <= EXACT as f64 => Value::Int(*number as i64),
        // NaN has many bit patterns; use one of them.
        Value::Float(number) if number.is_nan() => Value::Float(f64::NAN),
        Value::List(items) => Value::List(items.iter().map(canonical).collect()),
        Value::Map(entries) => {
            let mut sorted: Vec<_> = entries.iter().map(|(key, value)| (canonical(key), canonical(value))).collect();
            sorted.sort_by_cached_key(|(key, _)| format!("{key:?}"));
            Value::Map(sorted)
        }
        Value::Written(written) => canonical(&written.meaning),
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_yaml;
    use crate::self_describing::write_msgpack;

    #[test]
    fn equal_values_have_the_same_bytes() {
        let canonical = |yaml| write_msgpack(&canonical(&read_yaml(yaml).unwrap())).unwrap();
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
