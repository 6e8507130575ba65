//! Rust types in JSON, CBOR and MessagePack, read and written by the package for Python.

use scl::bytes::{Bytes, BytesMut};
use scl::codec::{Cbor, Codec, Json, Msgpack};
use scl_tests::{Process, python_with_scl};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A field of every sort.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Everything {
    unit: (),
    truth: bool,
    least: i64,
    most: u64,
    small: f32,
    float: f64,
    text: String,
    bytes: Vec<u8>,
    nothing: Option<u8>,
    something: Option<Inner>,
    list: Vec<Inner>,
    pair: (u8, String),
    named: BTreeMap<String, i32>,
    numbered: BTreeMap<i16, bool>,
    plain: Choice,
    with_value: Choice,
    with_fields: Choice,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Inner {
    value: i32,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Choice {
    Plain,
    Value(u8),
    Fields { a: u8 },
}

fn example() -> Everything {
    Everything {
        unit: (),
        truth: true,
        least: i64::MIN,
        most: u64::MAX,
        small: 0.1,
        float: f64::MAX,
        text: "läuft \"\u{1F600}\"\n\0".into(),
        bytes: vec![0, 255],
        nothing: None,
        something: Some(Inner { value: -1 }),
        list: vec![Inner { value: 1 }, Inner { value: 2 }],
        pair: (7, "seven".into()),
        named: [("a b".into(), -5)].into(),
        numbered: [(-3, false), (4, true)].into(),
        plain: Choice::Plain,
        with_value: Choice::Value(9),
        with_fields: Choice::Fields { a: 1 },
    }
}

/// Sends a value to Python, which decodes it and encodes what it has found.
fn through_python<C: Codec<T>, T>(value: &T) -> Result<T, String> {
    let mut buffer = BytesMut::new();
    C::encode(value, &mut buffer).expect("a value that the codec can represent");
    let answer = python::<C, T>(&buffer);
    let digits = answer.strip_prefix("ok ").ok_or(&answer)?;
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).expect("a byte");
    let frame: Vec<u8> = (0..digits.len()).step_by(2).map(byte).collect();
    C::decode(Bytes::from(frame)).map_err(|error| format!("{error:?}: {digits}"))
}

fn python<C: Codec<T>, T>(frame: &[u8]) -> String {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/codec.py");
    let mut python = Process::start(python_with_scl(), &[script, C::NAME, "nav.Everything"], &[]);
    let digits: String = frame.iter().map(|byte| format!("{byte:02x}")).collect();
    python.tell(&format!("again {digits}"));
    python.next_line()
}

#[test]
fn values_survive_the_way_through_python() {
    assert_eq!(through_python::<Json, _>(&example()), Ok(example()));
    assert_eq!(through_python::<Cbor, _>(&example()), Ok(example()));
    assert_eq!(through_python::<Msgpack, _>(&example()), Ok(example()));
}

#[test]
fn floats_that_are_no_numbers_survive_in_binary_codecs() {
    for value in [f64::INFINITY, f64::NEG_INFINITY, -0.0] {
        assert_eq!(through_python::<Cbor, _>(&value), Ok(value));
        assert_eq!(through_python::<Msgpack, _>(&value), Ok(value));
    }
    assert!(through_python::<Cbor, f64>(&f64::NAN).is_ok_and(f64::is_nan));
    assert!(through_python::<Msgpack, f64>(&f64::NAN).is_ok_and(f64::is_nan));
}

#[test]
fn undecodable_frames_are_refused_and_counted() {
    for answer in [python::<Json, ()>(b"{"), python::<Cbor, ()>(b"\x81"), python::<Msgpack, ()>(b"\xc1")] {
        assert!(answer.starts_with("error "), "{answer}");
        assert!(answer.contains("gate `there.gate` received an undecodable message from `here.gate`"), "{answer}");
        assert!(answer.ends_with(" 1"), "{answer}");
    }
}
