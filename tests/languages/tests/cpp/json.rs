//! The codec `json` of C++ beside that of Rust.

use super::build::{Build, binding, program};
use crate::json::{SPELLINGS, UNKNOWN_NAMES, cases, from_json, to_json};
use scl::private::prost::Message;
use scl_tests::{Process, System};
use std::path::Path;

/// The promise: C++ reads what Rust writes, and writes what Rust reads, with every kind of field and value.
#[test]
fn cpp_reads_and_writes_the_same_messages() {
    let mut cpp = start();
    for (message, _) in cases() {
        let bytes = message.encode_to_vec();
        let text = to_json(&message);
        assert_eq!(convert(&mut cpp, "json", text.as_bytes()).map(canonical), Ok(canonical(bytes.clone())), "{text}");
        let written = convert(&mut cpp, "proto", &bytes).expect("JSON");
        let written = String::from_utf8(written).expect("text");
        assert_eq!(from_json(&written).map(|back| back.encode_to_vec()), Ok(bytes), "{written}");
    }
}

/// The promise: what the specification allows is read, and what is not JSON of the type is refused, as in Rust, and so
/// are unknown names of enum values.
#[test]
fn cpp_accepts_and_refuses_the_same_texts() {
    let mut cpp = start();
    let cases = [
        (r#"{"an_int64": 5, "aUint64": "7", "level": 1, "aString": null}"#, true),
        (r#"{"added": {"later": [1, {}]}, "aBool": true}"#, true),
        (r#"{"at": "2026-11-21T19:00:00+01:00", "aFloat": "1.5"}"#, true),
        ("", false),
        ("[]", false),
        ("{} {}", false),
        (r#"{"anInt32": 2147483648}"#, false),
        (r#"{"anInt64": 1.5}"#, false),
        (r#"{"at": "yesterday"}"#, false),
        (r#"{"added": 1, "level": "LEVEL_HIGH", "byName": {"a": {"new": 1, "outer": {"level": -1}}}}"#, true),
        (r#"{"level": 2147483648}"#, false),
        (r#"{"level": true}"#, false),
        (r#"{"asText": "a", "asNumber": 1}"#, false),
    ];
    for (text, is_valid) in cases {
        let read = convert(&mut cpp, "json", text.as_bytes());
        assert_eq!(read.is_ok(), is_valid, "{text}: {read:?}");
        assert_eq!(from_json(text).map(|message| canonical(message.encode_to_vec())).ok(), read.map(canonical).ok());
    }
    for (text, written) in SPELLINGS {
        let read = convert(&mut cpp, "json", text.as_bytes()).map(canonical);
        assert_eq!(read.as_deref(), Ok(written.as_bytes()), "{text}");
    }
    for text in UNKNOWN_NAMES {
        let read = convert(&mut cpp, "json", text.as_bytes());
        assert!(read.is_err(), "{text}: {read:?}");
    }
}

fn start() -> Process {
    let topology = Path::new(env!("CARGO_MANIFEST_DIR")).join("topologies/json.yaml");
    let path = program(&binding().join("tests/programs/json.cpp"), &topology, Build::Plain);
    System::new().start(path.to_str().expect("a path of ASCII"), &[])
}

fn convert(cpp: &mut Process, from: &str, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    cpp.tell(&format!("{from} {hex}"));
    let answer = cpp.next_line();
    let digits = answer.strip_prefix("ok").ok_or_else(|| answer.clone())?.trim();
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).expect("a byte");
    Ok((0..digits.len()).step_by(2).map(byte).collect())
}

/// The same message in the order in which Rust writes it.
fn canonical(bytes: Vec<u8>) -> Vec<u8> {
    let text = to_json(&Message::decode(bytes.as_slice()).expect("protobuf"));
    text.into_bytes()
}
