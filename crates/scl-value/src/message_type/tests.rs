//! Reading and writing messages in every codec.

mod json;
mod negative_zero;
mod written;

use super::*;
use crate::testing::{descriptor, descriptors, message_type};
use crate::{read_yaml, to_json, to_yaml};
use expect_test::{Expect, expect};
use proptest::prelude::*;
use prost::Message;
use prost_reflect::DynamicMessage;

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

#[track_caller]
fn check_encode_error(text: &str, expected: Expect) {
    let error = message_type("rover.Measurement", "protobuf").encode(&read_yaml(text).unwrap()).unwrap_err();
    expected.assert_eq(&scl_terminal::Problem::from(error).to_string());
}

#[test]
fn a_wrong_value_is_named_with_its_field_and_type() {
    check_encode_error(
        "{sped: 1}",
        expect![[r#"
        error: message `rover.Measurement` has no field `sped`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `position`, `i32`, `i64`, `u32`, `u64`, `s32`, `s64`, `f32`, `f64`, `sf32`, `sf64`, `on`, `unit`, `raw_data`, `mode`, `pose`, `samples`, `track`, `counts` and 8 more
    "#]],
    );
    check_encode_error(
        "{speed: fast}",
        expect![[r#"
        error: field `speed`: expected a number (float), found the text `fast`
    "#]],
    );
    check_encode_error(
        "{speed: 1e300}",
        expect![[r#"
        error: field `speed`: 1e300 is too large for a number of 32 bits (float)
    "#]],
    );
    check_encode_error(
        "{i32: 1.5}",
        expect![[r#"
        error: field `i32`: expected a whole number from -2147483648 to 2147483647 (int32), found 1.5
    "#]],
    );
    check_encode_error(
        "{u32: -1}",
        expect![[r#"
        error: field `u32`: expected a whole number from 0 to 4294967295 (uint32), found -1
    "#]],
    );
    check_encode_error(
        "{i64: 18446744073709551615}",
        expect![[r#"
        error: field `i64`: expected a whole number from -9223372036854775808 to 9223372036854775807 (int64), found 18446744073709551615
    "#]],
    );
    check_encode_error(
        "{on: 1}",
        expect![[r#"
        error: field `on`: expected true or false, found 1
    "#]],
    );
    check_encode_error(
        "{unit: 12}",
        expect![[r#"
        error: field `unit`: expected a text, found 12
          = help: quote it: '12'
    "#]],
    );
    check_encode_error(
        "{raw_data: '*'}",
        expect![[r#"
            error: field `raw_data`: expected bytes as base64: Invalid symbol 42, offset 0
        "#]],
    );
    check_encode_error(
        "{mode: AUT}",
        expect![[r#"
        error: field `mode`: `rover.Mode` has no value `AUT`
          = help: did you mean `AUTO`?
          = note: its values: `IDLE`, `AUTO`, `MANUAL`
    "#]],
    );
    check_encode_error(
        "{pose: 1}",
        expect![[r#"
            error: field `pose`: expected the fields of `rover.Point`, found 1
              = note: its fields: `x`, `y`
        "#]],
    );
    check_encode_error(
        "{pose: {z: 1}}",
        expect![[r#"
            error: field `pose`: message `rover.Point` has no field `z`
              = note: its fields: `x`, `y`
        "#]],
    );
    check_encode_error(
        "{samples: 1}",
        expect![[r#"
            error: field `samples`: expected a list, found 1
              = help: write `samples: [...]`
        "#]],
    );
    check_encode_error(
        "{track: [{x: 1}, {x: a}]}",
        expect![[r#"
        error: field `track[1].x`: expected a number (double), found the text `a`
    "#]],
    );
    check_encode_error(
        "{counts: {a: b}}",
        expect![[r#"
        error: field `counts[a]`: expected a whole number from -2147483648 to 2147483647 (int32), found the text `b`
    "#]],
    );
    check_encode_error(
        "{points: {a: {}}}",
        expect![[r#"
        error: field `points[a]`: expected a whole number from -2147483648 to 2147483647 (int32), found the text `a`
    "#]],
    );
    check_encode_error(
        "{angle: 1, place: a}",
        expect![[r#"
        error: the fields `angle` and `place` exclude each other
          = note: they belong to the oneof `target`
    "#]],
    );
    check_encode_error(
        "{raw_data: AA==, rawData: AA==}",
        expect![[r#"
        error: the field `raw_data` is given twice
    "#]],
    );
    check_encode_error(
        "3",
        expect![[r#"
            error: expected the fields of `rover.Measurement`, found 3
              = note: its fields: `speed`, `position`, `i32`, `i64`, `u32`, `u64`, `s32`, `s64`, `f32`, `f64`, `sf32`, `sf64`, `on`, `unit`, `raw_data`, `mode`, `pose`, `samples`, `track`, `counts` and 8 more
        "#]],
    );
}

#[test]
fn an_undecodable_payload_says_where_and_why() {
    let protobuf = "a protobuf message `rover.Measurement`";
    let json = "the JSON of a message `rover.Measurement`";
    let cases: [(&str, &[u8], &str, &str); 14] = [
        ("protobuf", &[0x0d, 1, 2], protobuf, "field `speed` at byte 1: expected 4 bytes, found 2"),
        ("protobuf", &[8, 1], protobuf, "field `speed` at byte 0: expected a 4-byte number, found a varint"),
        ("protobuf", &[0x72, 2, b'a', 0xff], protobuf, "field `unit` at byte 3: the text is not valid UTF-8"),
        ("protobuf", &[0x8a, 1, 3, 9, 0, 0], protobuf, "field `pose.x` at byte 4: expected 8 bytes, found 2"),
        ("protobuf", &[0x72, 0xff, 0x0f], protobuf, "field `unit` at byte 3: expected 2047 bytes, found 0"),
        ("protobuf", &[0x07], protobuf, "at byte 0: expected the start of a field"),
        ("protobuf", &[0xff; 12], protobuf, "at byte 0: expected the start of a field"),
        ("json", b"{\"speed\": fast}", json, "expected ident at line 1 column 13"),
        ("json", b"{\"speed\": \"x\"}", json, "field `speed`: expected a number (float), found the text `x`"),
        ("json", b"{\"pose\": {\"x\": []}}", json, "field `pose.x`: expected a number (double), found a list"),
        ("cbor", &[0xa1, 0x61], "a CBOR item", "at byte 2: the item is truncated"),
        ("cbor", &[0x01, 0x02], "a CBOR item", "at byte 1: data follows the item"),
        ("msgpack", &[0x01, 0x02], "a MessagePack value", "at byte 1: data follows the value"),
        ("msgpack", &[0xc1], "a MessagePack value", "at byte 1: wrong msgpack marker Reserved"),
    ];
    for (codec, bytes, what, reason) in cases {
        let error = message_type("rover.Measurement", codec).decode(bytes).unwrap_err().to_string();
        assert_eq!(error, format!("this {}-byte payload is not {what}: {reason}", bytes.len()));
    }
}

#[test]
fn deep_and_large_payloads_are_refused() {
    let nested = |depth: usize| {
        (0..depth).fold(Vec::new(), |inner: Vec<u8>, _| {
            let mut bytes = vec![0xd2, 0x01];
            prost::encoding::encode_varint(inner.len() as u64, &mut bytes);
            bytes.extend(inner);
            bytes
        })
    };
    assert!(message_type("rover.Measurement", "protobuf").decode(&nested(99)).is_ok());
    let cases: [(&str, Vec<u8>, &str); 9] = [
        ("protobuf", nested(100), "nested deeper than 100 levels"),
        ("protobuf", nested(10_000), "nested deeper than 100 levels"),
        ("protobuf", [&[0x92, 0x01][..], &[0x80, 0x80, 0x80, 0x0a], &vec![0; 20 << 20]].concat(), "more than 4194304"),
        ("protobuf", [0x9a, 0x01, 0].repeat(5 << 20), "more than 4194304"),
        ("json", b"[".repeat(1 << 20), "nested deeper than 100 levels"),
        ("json", [b"[", &b"0,".repeat(5 << 20)[..], b"0]"].concat(), "more than 4194304"),
        ("cbor", vec![0x81; 1 << 20], "nested deeper than 100 levels"),
        ("cbor", vec![0x9b, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0xff], ""),
        ("msgpack", vec![0x91; 1 << 20], "nested deeper than 100 levels"),
    ];
    for (codec, bytes, expected) in cases {
        let error = message_type("rover.Measurement", codec).decode(&bytes).unwrap_err().to_string();
        assert!(error.contains(expected), "{codec}: {error}");
    }
    // Each `Any` begins with the decoder's limits anew.
    let any = (0..10_000).fold(Vec::new(), |inner: Vec<u8>, _| {
        let mut bytes = b"\x0a\x15x/google.protobuf.Any\x12".to_vec();
        prost::encoding::encode_varint(inner.len() as u64, &mut bytes);
        bytes.extend(inner);
        bytes
    });
    let mut known = vec![0x22];
    prost::encoding::encode_varint(any.len() as u64, &mut known);
    known.extend(any);
    assert!(message_type("rover.Known", "protobuf").decode(&known).is_ok());
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

/// The keys that YAML and protobuf have.
fn any_key() -> BoxedStrategy<Value> {
    prop_oneof![".{0,8}".prop_map(Value::Text), any::<i64>().prop_map(Value::Int), any::<bool>().prop_map(Value::Bool)]
        .boxed()
}

/// Any value that CBOR and MessagePack have.
fn any_value(key: BoxedStrategy<Value>) -> BoxedStrategy<Value> {
    let float = prop_oneof![any::<f64>(), any::<f32>().prop_map(crate::value::widen)];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::Bool),
        any::<i64>().prop_map(Value::Int),
        any::<u64>().prop_map(Value::from),
        float.prop_filter("NaN differs from itself", |number| !number.is_nan()).prop_map(Value::Float),
        ".{0,8}".prop_map(Value::Text),
        prop::collection::vec(any::<u8>(), 0..8).prop_map(Value::Bytes),
    ];
    leaf.prop_recursive(4, 40, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::List),
            prop::collection::vec((key.clone(), inner), 0..6).prop_map(Value::Map),
        ]
    })
    .boxed()
}

/// The bytes of a message of the schema, written by the library alone.
fn any_message() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..200).prop_map(|seed| {
        let descriptor = descriptor("rover.Measurement");
        let mut message = DynamicMessage::new(descriptor.clone());
        for pair in seed.chunks_exact(9) {
            let Some(field) = descriptor.get_field(u32::from(pair[0]) % 28 + 1) else { continue };
            let bits = u64::from_le_bytes(pair[1..].try_into().unwrap());
            set_field(&mut message, &field, bits);
        }
        message.encode_to_vec()
    })
}

fn set_field(message: &mut DynamicMessage, field: &prost_reflect::FieldDescriptor, bits: u64) {
    use prost_reflect::{Kind, MapKey, Value as V};
    let scalar = |kind: &Kind| match kind {
        Kind::Double => V::F64(f64::from_bits(bits)),
        Kind::Float => V::F32(f32::from_bits(bits as u32)),
        Kind::Int32 | Kind::Sint32 | Kind::Sfixed32 => V::I32(bits as i32),
        Kind::Int64 | Kind::Sint64 | Kind::Sfixed64 => V::I64(bits as i64),
        Kind::Uint32 | Kind::Fixed32 => V::U32(bits as u32),
        Kind::Uint64 | Kind::Fixed64 => V::U64(bits),
        Kind::Bool => V::Bool(bits.is_multiple_of(2)),
        Kind::String => V::String(char::from_u32(bits as u32 % 0x500).map_or_else(String::new, String::from)),
        Kind::Bytes => V::Bytes(bits.to_le_bytes().to_vec().into()),
        Kind::Enum(_) => V::EnumNumber(bits as i32 % 4),
        Kind::Message(inner) => V::Message(DynamicMessage::new(inner.clone())),
    };
    let value = match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            let key = match entry.map_entry_key_field().kind() {
                Kind::Bool => MapKey::Bool(bits.is_multiple_of(2)),
                Kind::Int32 => MapKey::I32(bits as i32),
                _ => MapKey::String(bits.to_string()),
            };
            V::Map([(key, scalar(&entry.map_entry_value_field().kind()))].into())
        }
        kind if field.is_list() => V::List(vec![scalar(&kind); bits as usize % 4]),
        kind => scalar(&kind),
    };
    message.set_field(field, value);
}

proptest! {
    #[test]
    fn protobuf_messages_come_back_as_they_were(bytes in any_message()) {
        let protobuf = message_type("rover.Measurement", "protobuf");
        let value = protobuf.decode(&bytes).unwrap();
        let again = protobuf.encode(&value).unwrap();
        // Not byte by byte: maps have no order, and a NaN has one text, whatever its bits.
        prop_assert_eq!((to_json(&protobuf.decode(&again).unwrap()), again.len()), (to_json(&value), bytes.len()));
        let from_text = protobuf.encode(&read_yaml(&to_yaml(&value)).unwrap()).unwrap();
        prop_assert_eq!(to_json(&protobuf.decode(&from_text).unwrap()), to_json(&value));
        let json = message_type("rover.Measurement", "json");
        let value = json.decode(&json.encode(&value).unwrap()).unwrap();
        prop_assert_eq!(to_json(&json.decode(&json.encode(&value).unwrap()).unwrap()), to_json(&value));
    }

    #[test]
    fn values_come_back_as_they_were(value in any_value(any_value(any_key()))) {
        for codec in ["cbor", "msgpack"] {
            let messages = MessageType::new(Some("rover.Measurement"), codec, None).unwrap();
            prop_assert_eq!(messages.decode(&messages.encode(&value).unwrap()).unwrap(), value.clone(), "{}", codec);
        }
        let json = MessageType::new(None, "json", None).unwrap();
        let bytes = json.encode(&value).unwrap();
        prop_assert_eq!(json.encode(&json.decode(&bytes).unwrap()).unwrap(), bytes);
    }

    #[test]
    fn yaml_comes_back_as_it_was(value in any_value(any_key())) {
        prop_assert_eq!(read_yaml(&to_yaml(&value)).unwrap(), value);
    }

    #[test]
    fn no_payload_panics(message in any_message(), value in any_value(any_key()), cut in any::<usize>(),
                         changes in prop::collection::vec((any::<usize>(), any::<u8>()), 0..6)) {
        for codec in ["protobuf", "json", "cbor", "msgpack"] {
            for name in ["rover.Measurement", "rover.Known"] {
                let messages = message_type(name, codec);
                let mut bytes = match codec {
                    "protobuf" => message.clone(),
                    "json" => to_json(&value).into_bytes(),
                    _ => messages.encode(&value).unwrap().to_vec(),
                };
                bytes.truncate(cut % (bytes.len() + 1));
                let length = bytes.len().max(1);
                for (place, byte) in &changes {
                    bytes.get_mut(place % length).into_iter().for_each(|old| *old = *byte);
                }
                if let Ok(value) = messages.decode(&bytes) {
                    let again = messages.encode(&value);
                    prop_assert!(again.is_ok(), "{:?}: {:?}", again, value);
                    read_yaml(&to_yaml(&value)).unwrap();
                }
                to_yaml(&messages.show(&bytes));
            }
        }
    }

    /// Checking a payload and decoding it agree.
    #[test]
    fn what_is_accepted_can_be_decoded(bytes in prop::collection::vec(any::<u8>(), 0..40)) {
        let descriptor = descriptor("rover.Measurement");
        let decoded = DynamicMessage::decode(descriptor, &bytes[..]);
        let shown = message_type("rover.Measurement", "protobuf").decode(&bytes);
        prop_assert_eq!(decoded.is_ok(), shown.is_ok(), "{:?} {:?}", decoded.err(), shown);
    }
}
