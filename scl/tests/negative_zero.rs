//! The sign of -0.0: messages of `schemas:` have the bytes that C++ and Python send.
#![allow(clippy::unwrap_used)]

use bytes::{Bytes, BytesMut};
use scl::codec::{Codec, Json, Protobuf};

scl::topology!("floats.yaml");

use rover::floats::Choice;
use rover::{Floats, Mixed};

fn encoded<T>(message: &T) -> Bytes
where
    Protobuf: Codec<T>,
{
    let mut buffer = BytesMut::new();
    <Protobuf as Codec<T>>::encode(message, &mut buffer).unwrap();
    buffer.freeze()
}

const WIDE: &[u8] = b"\x09\0\0\0\0\0\0\0\x80";

/// A field of this number and wire type 2 with a content.
fn field(key: u8, content: &[u8]) -> Vec<u8> {
    [&[key, u8::try_from(content.len()).unwrap()], content].concat()
}

#[test]
fn negative_zeros_are_sent_and_zeros_are_not() {
    let wide = || Floats { wide: -0.0, ..Floats::default() };
    let cases: [(Floats, Vec<u8>); 12] = [
        (Floats::default(), vec![]),
        (Floats { wide: 0.0, narrow: 0.0, text: "a".into(), ..Floats::default() }, field(0x52, b"a")),
        (wide(), WIDE.to_vec()),
        (Floats { narrow: -0.0, ..Floats::default() }, b"\x15\0\0\0\x80".to_vec()),
        (Floats { wide: -1.5, ..Floats::default() }, b"\x09\0\0\0\0\0\0\xf8\xbf".to_vec()),
        (Floats { list: vec![-0.0, 0.0], ..Floats::default() }, field(0x1a, b"\0\0\0\0\0\0\0\x80\0\0\0\0\0\0\0\0")),
        (
            Floats { by_name: [("a".to_owned(), -0.0)].into(), ..Floats::default() },
            field(0x22, b"\x0a\x01a\x11\0\0\0\0\0\0\0\x80"),
        ),
        (Floats { by_number: [(1, -0.0)].into(), ..Floats::default() }, field(0x4a, b"\x08\x01\x15\0\0\0\x80")),
        (Floats { inner: Some(Box::new(wide())), ..Floats::default() }, field(0x2a, WIDE)),
        (Floats { choice: Some(Choice::Chosen(0.0)), ..Floats::default() }, b"\x31\0\0\0\0\0\0\0\0".to_vec()),
        (Floats { choice: Some(Choice::Other(Box::new(wide()))), ..Floats::default() }, field(0x3a, WIDE)),
        (
            Floats { all: vec![wide(), Floats::default()], ..Floats::default() },
            [field(0x42, WIDE), vec![0x42, 0]].concat(),
        ),
    ];
    for (message, expected) in cases {
        let frame = encoded(&message);
        assert_eq!(frame, expected, "{message:?}");
        let decoded = <Protobuf as Codec<Floats>>::decode(frame).unwrap();
        // Equal texts, unlike equal numbers, have equal signs.
        assert_eq!(format!("{decoded:?}"), format!("{message:?}"));
        let mut text = BytesMut::new();
        <Json as Codec<Floats>>::encode(&message, &mut text).unwrap();
        let decoded = <Json as Codec<Floats>>::decode(text.freeze()).unwrap();
        assert_eq!(format!("{decoded:?}"), format!("{message:?}"));
    }
}

/// Beside a field that has a value or none, zeros are sent: they mean the same.
#[test]
fn fields_that_may_have_no_value_keep_theirs() {
    for (plain, maybe) in [(-0.0, None), (0.0, Some(0.0)), (-0.0, Some(-0.0)), (1.0, None)] {
        let within = [(7, Floats { wide: plain, ..Floats::default() })].into();
        let message = Mixed { plain, maybe, within };
        let decoded = <Protobuf as Codec<Mixed>>::decode(encoded(&message)).unwrap();
        assert_eq!(format!("{decoded:?}"), format!("{message:?}"));
    }
}
