//! What cannot be encoded or decoded, and what users read about it.

use super::*;

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
