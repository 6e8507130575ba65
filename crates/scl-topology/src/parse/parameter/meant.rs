//! What words and values of parameters mean that people write who know another tool.

use crate::grammar::parameter::{LIST, ONE_OF, TYPES};
use crate::habits;
use crate::suggest::similar;
use scl_text::duration;

/// Words of other tools and languages, each with the types that stand for it.
const OTHER_TYPES: [(&str, &[&str]); 19] = [
    ("float", &["f64", "f32"]),
    ("double", &["f64"]),
    ("real", &["f64"]),
    ("number", &["f64", "i32"]),
    ("int", &["i32", "i64"]),
    ("integer", &["i32", "i64"]),
    ("uint", &["u32", "u64"]),
    ("unsigned", &["u32", "u64"]),
    ("usize", &["u64"]),
    ("long", &["i64"]),
    ("byte", &["u8"]),
    ("boolean", &["bool"]),
    ("string", &["text"]),
    ("str", &["text"]),
    ("enum", &[ONE_OF]),
    ("choice", &[ONE_OF]),
    ("time", &["duration"]),
    ("array", &[LIST]),
    ("vector", &[LIST]),
];

/// The types that a word may have meant, at most three.
pub(super) fn types_of(word: &str) -> Vec<&'static str> {
    let lower = habits::compact(word);
    match OTHER_TYPES.iter().find(|(other, _)| *other == lower) {
        Some((_, types)) => types.to_vec(),
        None => match (lower.strip_prefix("uint"), lower.strip_prefix("int"), lower.strip_prefix("float")) {
            (Some(bits), ..) => sized('u', bits),
            (_, Some(bits), _) => sized('i', bits),
            (.., Some(bits)) => sized('f', bits),
            _ => similar(word, TYPES),
        },
    }
}

/// `uint8` and `uint8_t` are `u8`.
fn sized(letter: char, bits: &str) -> Vec<&'static str> {
    let name = format!("{letter}{}", bits.trim_end_matches('t'));
    TYPES.into_iter().filter(|known| *known == name).collect()
}

/// The key that stands for a word of other tools.
pub(super) fn key_of_others(word: &str) -> Option<&'static str> {
    match habits::compact(word).as_str() {
        "value" | "initial" | "defaultvalue" => Some("default"),
        "bounds" | "limits" | "minmax" | "interval" => Some("range"),
        "size" | "count" | "len" | "items" => Some("length"),
        "units" => Some("unit"),
        "dynamic" | "mutable" | "reconfigurable" | "tunable" | "runtime" => Some("live"),
        "description" | "desc" | "comment" | "help" | "summary" => Some("doc"),
        _ => None,
    }
}

/// The type that a value suggests.
pub(super) fn type_of_value(value: &str) -> &'static str {
    match value {
        "true" | "false" => "bool",
        _ if duration::parse(value).is_ok() => "duration",
        _ if value.parse::<i32>().is_ok() => "i32",
        _ if value.parse::<i64>().is_ok() => "i64",
        _ if value.parse::<f64>().is_ok() => "f64",
        _ => "text",
    }
}

/// The type of items that these values suggest.
pub(super) fn type_of_values<'v>(values: impl Iterator<Item = &'v str>) -> &'static str {
    let joined = |one, other| match (one, other) {
        (one, other) if one == other => one,
        ("i32" | "i64", "i32" | "i64") => "i64",
        ("i32" | "i64" | "f64", "i32" | "i64" | "f64") => "f64",
        _ => "text",
    };
    values.map(type_of_value).reduce(joined).unwrap_or("f64")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_other_names() {
        let cases: [(&str, &[&str]); 8] = [
            ("float", &["f64", "f32"]),
            ("Double", &["f64"]),
            ("uint8_t", &["u8"]),
            ("int64", &["i64"]),
            ("float32", &["f32"]),
            ("string", &["text"]),
            ("durration", &["duration"]),
            ("teapot", &[]),
        ];
        for (word, expected) in cases {
            assert_eq!(types_of(word), expected, "{word}");
        }
    }

    #[test]
    fn values_suggest_a_type_for_all() {
        let cases: [(&[&str], &str); 5] = [
            (&["0", "0.5"], "f64"),
            (&["1", "5000000000"], "i64"),
            (&["1ms", "2ms"], "duration"),
            (&["1", "a"], "text"),
            (&[], "f64"),
        ];
        for (values, expected) in cases {
            assert_eq!(type_of_values(values.iter().copied()), expected, "{values:?}");
        }
    }

    #[test]
    fn a_value_suggests_its_type() {
        for (value, expected) in
            [("true", "bool"), ("10ms", "duration"), ("5", "i32"), ("5000000000", "i64"), ("0.8", "f64"), ("a", "text")]
        {
            assert_eq!(type_of_value(value), expected, "{value}");
        }
    }
}
