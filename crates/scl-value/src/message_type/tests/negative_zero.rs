//! The sign of -0.0.

use crate::testing::message_type;
use crate::{read_yaml, to_json};

#[test]
fn negative_zeros_keep_their_sign() {
    let cases: [(&str, &[u8]); 7] = [
        ("{speed: -0.0}", b"\x0d\0\0\0\x80"),
        ("{position: -0.0, unit: a}", b"\x11\0\0\0\0\0\0\0\x80\x72\x01a"),
        ("{speed: 0.0, position: 0}", b""),
        ("{pose: {y: -0.0}}", b"\x8a\x01\x09\x11\0\0\0\0\0\0\0\x80"),
        ("{track: [{x: 1.5}, {x: -0.0}]}", b"\x9a\x01\x09\x09\0\0\0\0\0\0\xf8\x3f\x9a\x01\x09\x09\0\0\0\0\0\0\0\x80"),
        ("{points: {7: {x: -0.0}}}", b"\xaa\x01\x0d\x08\x07\x12\x09\x09\0\0\0\0\0\0\0\x80"),
        ("{angle: -0.0}", b"\xb1\x01\0\0\0\0\0\0\0\x80"),
    ];
    for (yaml, expected) in cases {
        let messages = message_type("rover.Measurement", "protobuf");
        let bytes = messages.encode(&read_yaml(yaml).unwrap()).unwrap();
        assert_eq!(&bytes[..], expected, "{yaml}");
        let shown = to_json(&messages.decode(&bytes).unwrap());
        assert_eq!(shown.contains("-0.0"), yaml.contains("-0.0"), "{shown}");
        let json = message_type("rover.Measurement", "json");
        let text = json.encode(&read_yaml(yaml).unwrap()).unwrap();
        let shown = to_json(&json.decode(&text).unwrap());
        assert_eq!(shown.contains("-0.0"), yaml.contains("-0.0"), "{text:?}");
    }
}
