//! What tools print as JSON, programs with floats as their only numbers read, and tools take back.

use super::round_trips::any_message;
use crate::testing::message_type;
use crate::{MessageType, read_yaml, to_json};
use proptest::prelude::*;
use serde_json::Value as Json;

/// A text of JSON as jq and JavaScript write it again: all numbers have been floats.
fn through_floats(text: &str) -> String {
    fn rounded(value: Json) -> Json {
        match value {
            Json::Number(number) => number.as_f64().into(),
            Json::Array(items) => items.into_iter().map(rounded).collect(),
            Json::Object(entries) => entries.into_iter().map(|(key, value)| (key, rounded(value))).collect(),
            other => other,
        }
    }
    rounded(serde_json::from_str(text).unwrap()).to_string()
}

fn printed(messages: &MessageType, bytes: &[u8]) -> String {
    to_json(&messages.for_json(messages.decode(bytes).unwrap()))
}

#[test]
fn large_whole_numbers_are_texts_if_the_type_is_known() {
    let yaml = "{i64: -9007199254740993, u64: 18446744073709551615, s64: 9007199254740992, f64: 9007199254740993, \
                inner: {sf64: -9223372036854775808}, counts: {a: 1}}";
    for codec in ["protobuf", "json"] {
        let messages = message_type("rover.Measurement", codec);
        let text = printed(&messages, &messages.encode(&read_yaml(yaml).unwrap()).unwrap());
        for expected in [
            r#""i64":"-9007199254740993""#,
            r#""u64":"18446744073709551615""#,
            r#""s64":9007199254740992"#,
            r#""f64":"9007199254740993""#,
            r#""sf64":"-9223372036854775808""#,
            r#""counts":{"a":1}"#,
        ] {
            assert!(text.contains(expected), "{codec}: {expected} in {text}");
        }
    }
    // Without a type, a text would be sent as a text.
    for codec in ["json", "cbor", "msgpack"] {
        let messages = MessageType::new(Some("rover.Measurement"), codec, None).unwrap();
        let bytes = messages.encode(&read_yaml("{u64: 18446744073709551615}").unwrap()).unwrap();
        let text = printed(&messages, &bytes);
        assert_eq!(text, r#"{"u64":18446744073709551615}"#, "{codec}");
        assert_eq!(messages.encode(&read_yaml(&text).unwrap()).unwrap(), bytes, "{codec}");
    }
}

proptest! {
    #[test]
    fn messages_survive_programs_that_have_only_floats(message in any_message()) {
        let messages = message_type("rover.Measurement", "protobuf");
        if messages.decode(&message).is_ok() {
            let expected = printed(&messages, &message);
            let text = through_floats(&expected);
            let again = messages.encode(&read_yaml(&text).unwrap()).unwrap();
            // Not the bytes: JSON has one NaN, and floats have many.
            prop_assert_eq!(printed(&messages, &again), expected, "{}", text);
        }
    }
}
