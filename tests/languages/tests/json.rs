//! The codec `json` for messages of schemas: canonical protobuf JSON, beside Google's implementation for Python.

use scl::Component;
use scl::bytes::{Bytes, BytesMut};
use scl::codec::{Codec, Json};
use scl::private::prost::Message;
use scl::private::prost_types::value::Kind;
use scl::private::prost_types::{Duration, FieldMask, Struct, Timestamp, Value};
use scl_tests::{python_with_packages, python_with_scl};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

scl::topology!("topologies/json.yaml");

use json::{Everything, Level, everything};

pub(crate) fn to_json(message: &Everything) -> String {
    let mut buffer = BytesMut::new();
    Json::encode(message, &mut buffer).expect("a message that JSON can represent");
    String::from_utf8(buffer.to_vec()).expect("text")
}

pub(crate) fn from_json(text: &str) -> Result<Everything, String> {
    let decoded = Json::decode(Bytes::copy_from_slice(text.as_bytes()));
    decoded.map_err(|error| {
        format!("{error}: {}", std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default())
    })
}

/// Messages that use every field, every special value and every well-known type, with their texts as in the
/// specification.
pub(crate) fn cases() -> Vec<(Everything, &'static str)> {
    let default = Everything::default;
    let inner = |text: &str| everything::Inner { text: text.to_owned(), outer: None };
    let value = |kind| Value { kind: Some(kind) };
    vec![
        (default(), r"{}"),
        (
            Everything { a_double: f64::NAN, a_float: f32::INFINITY, ..default() },
            r#"{"aDouble":"NaN","aFloat":"Infinity"}"#,
        ),
        (Everything { a_double: -1.5, a_float: 0.1, ..default() }, r#"{"aDouble":-1.5,"aFloat":0.1}"#),
        (Everything { doubles: vec![f64::MAX, -0.0, 1e-300, f64::NEG_INFINITY], ..default() }, ""),
        (
            Everything { an_int32: i32::MIN, an_int64: i64::MIN, a_uint32: u32::MAX, a_uint64: u64::MAX, ..default() },
            r#"{"anInt32":-2147483648,"anInt64":"-9223372036854775808","aUint32":4294967295,"aUint64":"18446744073709551615"}"#,
        ),
        (
            Everything { a_sint64: -1, a_fixed64: 1 << 53, a_sfixed64: -(1 << 53), a_bool: true, ..default() },
            r#"{"aSint64":"-1","aFixed64":"9007199254740992","aSfixed64":"-9007199254740992","aBool":true}"#,
        ),
        (
            Everything { a_string: "läuft \"\u{1F600}\"\n\0".into(), some_bytes: vec![0xff, 0xfe, 0], ..default() },
            r#"{"aString":"läuft \"😀\"\n\u0000","someBytes":"//4A"}"#,
        ),
        (Everything { level: Level::High.into(), ..default() }, r#"{"level":"LEVEL_HIGH"}"#),
        (
            Everything { level: 77, levels: vec![-1, 0, 77], ..default() },
            r#"{"level":77,"levels":["LEVEL_MINUS","LEVEL_LOW",77]}"#,
        ),
        (Everything { inner: Some(Box::new(inner(""))), ..default() }, r#"{"inner":{}}"#),
        (
            Everything { numbers: vec![1, -2], many_bytes: vec![vec![], vec![1]], ..default() },
            r#"{"numbers":["1","-2"],"manyBytes":["","AQ=="]}"#,
        ),
        (
            Everything {
                by_name: [("a b".to_owned(), inner("x"))].into(),
                by_number: [(-5, false)].into(),
                ..default()
            },
            r#"{"byName":{"a b":{"text":"x"}},"byNumber":{"-5":false}}"#,
        ),
        (Everything { choice: Some(everything::Choice::AsText(String::new())), ..default() }, r#"{"asText":""}"#),
        (Everything { choice: Some(everything::Choice::AsNumber(0)), ..default() }, r#"{"asNumber":"0"}"#),
        (Everything { choice: Some(everything::Choice::AsNull(0)), ..default() }, r#"{"asNull":null}"#),
        (Everything { maybe: Some(0), renamed: 3, ..default() }, r#"{"maybe":0,"otherName":3}"#),
        (
            Everything {
                at: Some(Timestamp { seconds: 1, nanos: 500_000_000 }),
                took: Some(Duration { seconds: -1, nanos: -5_000_000 }),
                ..default()
            },
            r#"{"at":"1970-01-01T00:00:01.500Z","took":"-1.005s"}"#,
        ),
        (
            Everything {
                any_object: Some(Struct { fields: BTreeMap::from([("a".to_owned(), value(Kind::NumberValue(1.5)))]) }),
                any_value: Some(value(Kind::NullValue(0))),
                ..default()
            },
            r#"{"anyObject":{"a":1.5},"anyValue":null}"#,
        ),
        (
            Everything {
                wrapped: Some(i64::MAX),
                mask: Some(FieldMask { paths: vec!["a_b.c".into(), "d".into()] }),
                ..default()
            },
            r#"{"wrapped":"9223372036854775807","mask":"aB.c,d"}"#,
        ),
    ]
}

#[test]
fn messages_have_the_texts_of_the_specification() {
    for (message, text) in cases() {
        let found = to_json(&message);
        if !text.is_empty() {
            assert_eq!(found, text);
        }
        let back = from_json(&found).expect("what was encoded is decoded");
        assert_eq!(back.encode_to_vec(), message.encode_to_vec(), "{found}");
    }
}

#[test]
fn every_spelling_of_the_specification_is_read() {
    for (read, canonical) in SPELLINGS {
        assert_eq!(from_json(read).map(|message| to_json(&message)), Ok(canonical.to_owned()), "{read}");
    }
}

/// Texts that programs may send, and their canonical forms.
pub(crate) const SPELLINGS: [(&str, &str); 12] = [
    (r#"{"an_int64": 5}"#, r#"{"anInt64":"5"}"#),
    (
        r#"{"anInt64": "5", "aUint64": 7, "anInt32": 1e2, "aUint32": 3.0}"#,
        r#"{"anInt32":100,"anInt64":"5","aUint32":3,"aUint64":"7"}"#,
    ),
    (r#"{"someBytes": "_-4", "manyBytes": ["AQ"]}"#, r#"{"someBytes":"/+4=","manyBytes":["AQ=="]}"#),
    (r#"{"level": 1, "levels": [-1]}"#, r#"{"level":"LEVEL_HIGH","levels":["LEVEL_MINUS"]}"#),
    (r#"{"level": "1", "levels": ["-1"]}"#, r#"{"level":"LEVEL_HIGH","levels":["LEVEL_MINUS"]}"#),
    (
        r#"{"added": "LEVEL_NEW", "inner": {"level": "LEVEL_NEW"}, "byName": {"LEVEL_NEW": {"text": "LEVEL_NEW"}}}"#,
        r#"{"inner":{},"byName":{"LEVEL_NEW":{"text":"LEVEL_NEW"}}}"#,
    ),
    (r#"{"level_by_name": {"a": 1}, "as_level": 0}"#, r#"{"asLevel":"LEVEL_LOW","levelByName":{"a":"LEVEL_HIGH"}}"#),
    (r#"{"aString": null, "numbers": null, "inner": null}"#, "{}"),
    (r#"{"aDouble": "-Infinity", "aFloat": "1.5"}"#, r#"{"aDouble":"-Infinity","aFloat":1.5}"#),
    (r#"{"at": "2026-11-21T19:00:00+01:00"}"#, r#"{"at":"2026-11-21T18:00:00Z"}"#),
    (r#"{"added": {"later": [1, {}]}, "aBool": true, "inner": {"new": 1}}"#, r#"{"aBool":true,"inner":{}}"#),
    (r#"{"other_name": 1, "renamed": 3}"#, r#"{"otherName":3}"#),
];

/// Texts with names that their enum does not have, beside fields that may be unknown.
pub(crate) const UNKNOWN_NAMES: [&str; 13] = [
    r#"{"level": "77"}"#,
    r#"{"levels": ["4294967295"]}"#,
    r#"{"level": "LEVEL_NEW"}"#,
    r#"{"level": ""}"#,
    r#"{"level": "LEVEL_NEW", "level": "LEVEL_LOW"}"#,
    r#"{"levels": ["LEVEL_LOW", "LEVEL_NEW"]}"#,
    r#"{"added": {"level": 1}, "level": "LEVEL_NEW"}"#,
    r#"{"added": 1, "inner": {"outer": {"level": "level_low"}}}"#,
    r#"{"byName": {"a": {"outer": {"levels": ["LEVEL_HIGH", "high"]}}}}"#,
    r#"{"levelByName": {"a": "LEVEL_LOW", "b": "LEVEL_NEW"}}"#,
    r#"{"level_by_name": {"level": "LEVEL_NEW"}}"#,
    r#"{"asLevel": "LEVEL_NEW"}"#,
    r#"{"asNull": "NULL"}"#,
];

#[test]
fn unknown_names_of_enum_values_are_refused() {
    for text in UNKNOWN_NAMES {
        let error = from_json(text).expect_err(text);
        assert!(error.contains("is not a value of the enum `"), "{text}: {error}");
    }
}

#[test]
fn other_texts_are_refused() {
    for text in refused() {
        let found = from_json(&text);
        assert!(found.is_err(), "{}: {found:?}", &text[..text.len().min(80)]);
    }
}

fn refused() -> Vec<String> {
    let nested = format!("{}{}", r#"{"inner":{"outer":"#.repeat(200), "{}".to_owned() + &"}}".repeat(200));
    let cases = [
        "",
        "[]",
        "null",
        "{} {}",
        r#"{"anInt32": 2147483648}"#,
        r#"{"aUint64": "-1"}"#,
        r#"{"anInt64": 1.5}"#,
        r#"{"anInt64": ""}"#,
        r#"{"aBool": "true"}"#,
        r#"{"aString": 5}"#,
        r#"{"someBytes": "!"}"#,
        r#"{"manyBytes": ["AQ==", "A!=="]}"#,
        r#"{"level": 2147483648}"#,
        r#"{"level": 1.5}"#,
        r#"{"level": true}"#,
        r#"{"level": {}}"#,
        r#"{"aDouble": "high"}"#,
        r#"{"inner": []}"#,
        r#"{"numbers": {}}"#,
        r#"{"byNumber": {"a": true}}"#,
        r#"{"at": "yesterday"}"#,
        r#"{"took": "1"}"#,
        r#"{"numbers": [null]}"#,
        r#"{"asText": "a", "asNumber": 1}"#,
        &nested,
        &"[".repeat(1_000_000),
        &format!(r#"{{"anyValue": {}"#, "[".repeat(100_000)),
    ];
    cases.map(str::to_owned).into()
}

#[tokio::test]
async fn gates_with_the_codec_json_carry_messages_of_schemas() {
    let (mut here, mut peer) = Here::test().await.expect("a component");
    let sent = Everything { a_uint64: u64::MAX, level: Level::High.into(), ..Everything::default() };
    here.everything.send(&sent).await.expect("sent");
    assert_eq!(peer.everything.recv().await.expect("received"), sent);
}

/// A Python program that converts messages with `google.protobuf.json_format`.
struct Python {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    _descriptors: tempfile::NamedTempFile,
}

impl Python {
    /// Google's implementation alone.
    fn start(message: &str) -> Self {
        Self::run(python_with_packages(), "canonical_json.py", &[], message)
    }

    /// The codec `json` of the package `scl`.
    fn start_scl(message: &str) -> Self {
        Self::run(python_with_scl(), "codec.py", &["json"], message)
    }

    fn run(python: &Path, script: &str, arguments: &[&str], message: &str) -> Self {
        let mut descriptors = tempfile::NamedTempFile::new().expect("a file");
        descriptors.write_all(Here::SPEC.schema.expect("a schema").descriptors).expect("written");
        let script = format!("{}/python/{script}", env!("CARGO_MANIFEST_DIR"));
        let mut child = Command::new(python)
            .arg(script)
            .args(arguments)
            .args([message.as_ref(), descriptors.path().as_os_str()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("Python");
        let (input, output) = (child.stdin.take().expect("a pipe"), child.stdout.take().expect("a pipe"));
        Self { child, input, output: BufReader::new(output), _descriptors: descriptors }
    }

    fn convert(&mut self, from: &str, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        writeln!(self.input, "{from} {hex}").expect("Python runs");
        let mut answer = String::new();
        self.output.read_line(&mut answer).expect("an answer");
        let digits = answer.trim_end().strip_prefix("ok").ok_or_else(|| answer.clone())?.trim().to_owned();
        let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).expect("a byte");
        Ok((0..digits.len()).step_by(2).map(byte).collect())
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

#[test]
fn python_reads_and_writes_the_same_messages() {
    agrees_with(Python::start("json.Everything"));
}

#[test]
fn the_package_for_python_reads_and_writes_the_same_messages() {
    agrees_with(Python::start_scl("json.Everything"));
}

#[test]
fn the_package_for_python_reads_and_refuses_the_same_texts() {
    let mut python = Python::start_scl("json.Everything");
    for (read, canonical) in SPELLINGS {
        let message = python.convert("json", read.as_bytes()).unwrap_or_else(|error| panic!("{read}: {error}"));
        let written = python.convert("proto", &message).expect("JSON");
        assert_eq!(String::from_utf8(written).as_deref(), Ok(canonical), "{read}");
    }
    for text in refused().into_iter().chain(UNKNOWN_NAMES.map(str::to_owned)) {
        let found = python.convert("json", text.as_bytes());
        let error = found.err().unwrap_or_else(|| panic!("accepted: {}", &text[..text.len().min(80)]));
        assert!(error.contains("gate `there.gate` received an undecodable message from `here.gate`"), "{error}");
    }
}

fn agrees_with(mut python: Python) {
    for (message, _) in cases() {
        let text = to_json(&message);
        let read = python.convert("json", text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(
            Everything::decode(read.as_slice()).expect("protobuf").encode_to_vec(),
            message.encode_to_vec(),
            "{text}"
        );
        let written = python.convert("proto", &message.encode_to_vec()).expect("JSON");
        let written = String::from_utf8(written).expect("text");
        let back = from_json(&written).unwrap_or_else(|error| panic!("{written}: {error}"));
        assert_eq!(back.encode_to_vec(), message.encode_to_vec(), "{written}");
    }
}
