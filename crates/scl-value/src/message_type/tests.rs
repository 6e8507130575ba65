//! Reading and writing messages in every codec.

mod json;
mod negative_zero;
mod refused;
mod round_trips;
mod written;

use super::*;
use crate::testing::{descriptor, descriptors, message_type};
use crate::{read_yaml, to_json, to_yaml};
use expect_test::{Expect, expect};

const SAMPLE: &str = "\
speed: 1.84
position: 0.1
i32: -1
i64: -9007199254740993
u32: 4294967295
u64: 18446744073709551615
on: true
unit: m/s
raw_data: !binary AQL/
mode: AUTO
pose: {x: 1, y: .nan}
samples: [1.1, 2, .inf]
track: [{x: 1}, {y: 2}]
counts: {b: 2, a: 1}
points: {-3: {x: 3}}
place: home
limit: 0
inner: {speed: 2.5}
modes: [MANUAL, 7]
flags: {true: yes}
";

#[test]
fn a_protobuf_message_shows_all_its_fields() {
    let messages = message_type("rover.Measurement", "protobuf");
    let bytes = messages.encode(&read_yaml(SAMPLE).unwrap()).unwrap();
    let value = messages.decode(&bytes).unwrap();
    let FieldsOf(inner, outer) = split_inner(value.clone());
    expect![[r#"
        speed: 1.84
        position: 0.1
        i32: -1
        i64: -9007199254740993
        u32: 4294967295
        u64: 18446744073709551615
        s32: 0
        s64: 0
        f32: 0
        f64: 0
        sf32: 0
        sf64: 0
        on: true
        unit: m/s
        raw_data: !binary AQL/
        mode: AUTO
        pose:
          x: 1.0
          y: .nan
        samples:
        - 1.1
        - 2.0
        - .inf
        track:
        - x: 1.0
          y: 0.0
        - x: 0.0
          y: 2.0
        counts:
          a: 1
          b: 2
        points:
          -3:
            x: 3.0
            y: 0.0
        place: home
        limit: 0
        modes:
        - MANUAL
        - 7
        flags:
          true: yes
    "#]]
    .assert_eq(&to_yaml(&outer));
    expect![[r#"{"speed":2.5,"position":0.0,"i32":0,"i64":0,"u32":0,"u64":0,"s32":0,"s64":0,"f32":0,"f64":0,"sf32":0,"sf64":0,"on":false,"unit":"","raw_data":"","mode":"IDLE","samples":[],"track":[],"counts":{},"points":{},"modes":[],"flags":{}}"#]].assert_eq(&to_json(&inner));
    for text in [to_yaml(&value), to_json(&value)] {
        let again = messages.encode(&read_yaml(&text).unwrap()).unwrap();
        assert_eq!((to_yaml(&messages.decode(&again).unwrap()), again.len()), (to_yaml(&value), bytes.len()));
    }
}

struct FieldsOf(Value, Value);

fn split_inner(value: Value) -> FieldsOf {
    let inner = value.get("inner").unwrap().clone();
    let Value::Map(mut entries) = value else { panic!("not a map") };
    entries.retain(|(key, _)| *key != "inner".into());
    FieldsOf(inner, Value::Map(entries))
}

#[test]
fn json_of_a_schema_is_canonical() {
    let messages = message_type("rover.Measurement", "json");
    let bytes = messages.encode(&read_yaml("{raw_data: AQL/, i64: 5, mode: AUTO, speed: 1.84}").unwrap()).unwrap();
    let text = std::str::from_utf8(&bytes).unwrap();
    assert_eq!(text, r#"{"speed":1.84,"i64":"5","rawData":"AQL/","mode":"AUTO"}"#);
    let value = messages.decode(br#"{"rawData":"AQL/","i64":"5","speed":1.84,"inner":null,"new":{}}"#).unwrap();
    assert_eq!(value.get("i64"), Some(&Value::Int(5)));
    assert_eq!(value.get("unit"), Some(&"".into()));
    assert_eq!(to_json(value.get("@unknown").unwrap()), r#"["new"]"#);
}

#[test]
fn well_known_messages_are_short() {
    let messages = message_type("rover.Known", "protobuf");
    let yaml = "\
at: 2026-11-22T10:00:00.500Z
took: 1.500s
extra:
  a:
  - 1.0
  - null
  - b: true
any:
  '@type': type.googleapis.com/rover.Point
  x: 1.0
  y: 0.0
maybe: 1.84
mask: speed,unit
value: null
list:
- x
empty: {}
";
    let bytes = messages.encode(&read_yaml(yaml).unwrap()).unwrap();
    assert_eq!(to_yaml(&messages.decode(&bytes).unwrap()), yaml);
    let nested = "any: {'@type': x/google.protobuf.Duration, value: 2s}";
    let bytes = messages.encode(&read_yaml(nested).unwrap()).unwrap();
    expect![[r#"{"any":{"@type":"x/google.protobuf.Duration","value":"2s"}}"#]]
        .assert_eq(&to_json(&messages.decode(&bytes).unwrap()));
    // Times that have no text, and types that the schema does not have, are shown as they are.
    let plain = "{at: {seconds: 9223372036854775807, nanos: 0}, any: {type_url: x/other.Type, value: AQL/}}";
    let bytes = messages.encode(&read_yaml(plain).unwrap()).unwrap();
    expect![[r#"{"at":{"seconds":9223372036854775807,"nanos":0},"any":{"type_url":"x/other.Type","value":"AQL/"}}"#]]
        .assert_eq(&to_json(&messages.decode(&bytes).unwrap()));
}

#[test]
fn fields_of_a_newer_type_are_shown_by_number() {
    let newer = message_type("rover.Newer", "protobuf");
    let bytes = newer.encode(&read_yaml("{speed: 1, added: abc, number: 7}").unwrap()).unwrap();
    let value = message_type("rover.Point", "protobuf").decode(&bytes[5..]).unwrap();
    assert_eq!(to_json(&value), r#"{"x":0.0,"y":0.0,"@unknown":{"100":"YWJj","101":7}}"#);
}

#[test]
fn payloads_without_a_known_type_are_shown_as_bytes() {
    let cases = [
        (None, "raw", "the gate carries bytes of no declared type"),
        (Some("rover.Line"), "postcard", "`postcard` messages can be read with the Rust type `rover.Line` only"),
        (Some("rover.Line"), "my_crate::Flat", "the codec `my_crate::Flat` is the program's own"),
    ];
    for (name, codec, why) in cases {
        let messages = MessageType::new(name, codec, None).unwrap();
        let value = messages.decode(&[1, 0xff]).unwrap();
        assert_eq!(value, Value::Opaque(Opaque { length: 2, hex: "01ff".to_owned(), why: why.to_owned() }));
        for text in [to_yaml(&value), to_json(&value), "!binary Af8=".to_owned(), "{hex: 01 FF}".to_owned()] {
            assert_eq!(messages.encode(&read_yaml(&text).unwrap()).unwrap(), &[1, 0xff][..], "{text}");
        }
    }
    let bytes = MessageType::new(None, "raw", None).unwrap();
    assert_eq!(bytes.encode(&read_yaml("{text: hi}").unwrap()).unwrap(), "hi");
    for wrong in ["{hex: 1}", "{hex: zz}", "hello", "{}"] {
        assert!(bytes.encode(&read_yaml(wrong).unwrap()).is_err(), "{wrong}");
    }
}

#[test]
fn a_protobuf_type_needs_its_description() {
    let new = |name, descriptors| MessageType::new(Some(name), "protobuf", descriptors).unwrap_err().to_string();
    assert_eq!(new("rover.Nothing", Some(descriptors())), "the schema has no message `rover.Nothing`");
    assert!(new("rover.Point", None).starts_with("there is no schema for the protobuf message `rover.Point`"));
    assert!(new("rover.Point", Some(&[1, 2, 3])).starts_with("the schema cannot be read: "));
}

#[test]
fn a_template_has_all_fields_and_can_be_encoded() {
    for name in ["rover.Measurement", "rover.Known", "rover.Point"] {
        for codec in ["protobuf", "json"] {
            let messages = message_type(name, codec);
            let template = messages.template().unwrap();
            messages.encode(&read_yaml(&to_yaml(&template)).unwrap()).unwrap();
        }
    }
    let template = message_type("rover.Measurement", "protobuf").template().unwrap();
    expect![[r#"
        speed: 0.0
        position: 0.0
        i32: 0
        i64: 0
        u32: 0
        u64: 0
        s32: 0
        s64: 0
        f32: 0
        f64: 0
        sf32: 0
        sf64: 0
        on: false
        unit: ''
        raw_data: !binary ''
        mode: IDLE
        pose:
          x: 0.0
          y: 0.0
        samples:
        - 0.0
        track:
        - x: 0.0
          y: 0.0
        counts:
          '': 0
        points:
          0:
            x: 0.0
            y: 0.0
        angle: 0.0
        limit: 0
        modes:
        - IDLE
        flags:
          false: ''
    "#]]
    .assert_eq(&to_yaml(&template));
    assert_eq!(MessageType::new(None, "cbor", None).unwrap().template(), None);
}

#[test]
fn columns_are_the_fields_that_are_no_messages() {
    let columns = message_type("rover.Measurement", "protobuf").columns().unwrap();
    let names: Vec<String> = columns.iter().map(ToString::to_string).collect();
    assert_eq!(names[16..20], ["pose.x", "pose.y", "samples", "track"]);
    assert!(names.contains(&"inner".to_owned()) && names.contains(&"goal.x".to_owned()));
}

#[test]
fn a_field_that_the_type_does_not_have_is_named() {
    let messages = message_type("rover.Measurement", "protobuf");
    for path in ["speed", "pose.x", "track[3].y", "counts.any", "points[3].x", "inner.inner.speed", ".", "@unknown"] {
        messages.check_field(&path.parse().unwrap()).unwrap();
    }
    let known = message_type("rover.Known", "protobuf");
    for path in ["at", "extra.a.b", "any.x", "maybe", "value[3]"] {
        known.check_field(&path.parse().unwrap()).unwrap();
    }
    let check = |messages: &MessageType, path: &str, expected: Expect| {
        let error = messages.check_field(&path.parse().unwrap()).unwrap_err();
        expected.assert_eq(&scl_terminal::Problem::from(error).to_string());
    };
    check(
        &messages,
        "pose.z",
        expect![[r#"
            error: message `rover.Point` has no field `z`
              = note: its fields: `x`, `y`
        "#]],
    );
    check(
        &messages,
        "spede",
        expect![[r#"
        error: message `rover.Measurement` has no field `spede`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `position`, `i32`, `i64`, `u32`, `u64`, `s32`, `s64`, `f32`, `f64`, `sf32`, `sf64`, `on`, `unit`, `raw_data`, `mode`, `pose`, `samples`, `track`, `counts` and 8 more
    "#]],
    );
    check(
        &messages,
        "speed.x",
        expect![[r#"
        error: `speed` is a number and has no fields
    "#]],
    );
    check(
        &messages,
        "track.x",
        expect![[r#"
        error: `track` is a list
          = help: name an element: `track[0]`
    "#]],
    );
    check(
        &messages,
        "pose[0]",
        expect![[r#"
        error: `rover.Point` is a message, not a list
    "#]],
    );
    check(
        &known,
        "at.seconds",
        expect![[r#"
        error: `at` is a text and has no fields
    "#]],
    );
}

#[test]
fn messagepack_extensions_and_integer_keys_are_kept() {
    for bytes in [&[0xd5, 5, 1, 2][..], &[0x81, 0x07, 0xc4, 1, 0xff], &[0xc7, 3, 0xff, 1, 2, 3]] {
        let messages = message_type("rover.Measurement", "msgpack");
        assert_eq!(messages.encode(&messages.decode(bytes).unwrap()).unwrap(), bytes);
    }
}
