//! The codecs for any serde type that are off by default: the same checks for all, on hostile frames of each format.
#![allow(clippy::unwrap_used)]

use super::{Codec, DecodeError};
use bytes::{Bytes, BytesMut};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Debug;

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Event {
    name: String,
    values: Vec<Option<f64>>,
    kind: Kind,
    by_axis: BTreeMap<char, i64>,
    inner: Option<Box<Event>>,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
enum Kind {
    Silent,
    Level(u8),
    Pair(u64, i16),
    Named { text: String },
}

fn event() -> Event {
    let plain = |kind, inner| Event {
        name: String::new(),
        values: vec![],
        kind,
        by_axis: BTreeMap::new(),
        inner: Option::map(inner, Box::new),
    };
    let named = plain(Kind::Named { text: "läuft \u{1F600}".into() }, Some(plain(Kind::Silent, None)));
    Event {
        name: "imu".into(),
        values: vec![Some(0.1), None, Some(f64::NEG_INFINITY)],
        by_axis: BTreeMap::from([('x', i64::MIN), ('ß', -1)]),
        ..plain(Kind::Level(255), Some(plain(Kind::Pair(u64::MAX, i16::MIN), Some(named))))
    }
}

/// Nests through `Option`, as [`Chain`] does through enums.
#[derive(Debug, Serialize, Deserialize)]
struct List(Option<Box<List>>);

#[derive(Debug, Serialize, Deserialize)]
enum Chain {
    End,
    Next(Box<Chain>),
}

fn chain(levels: usize) -> Chain {
    (0..levels).fold(Chain::End, |inner, _| Chain::Next(Box::new(inner)))
}

fn encoded<C: Codec<T>, T>(message: &T) -> Bytes {
    let mut buffer = BytesMut::from(&b"before"[..]);
    C::encode(message, &mut buffer).unwrap();
    assert_eq!(buffer.split_to(6), b"before"[..]);
    buffer.freeze()
}

fn decoded<C: Codec<T>, T>(bytes: &[u8]) -> Result<T, DecodeError> {
    C::decode(Bytes::copy_from_slice(bytes))
}

fn refused<C: Codec<T>, T: Debug>(case: &str, bytes: &[u8]) -> DecodeError {
    match decoded::<C, T>(bytes) {
        Ok(message) => panic!("{case}: accepted as {message:.200?}"),
        Err(error) => error,
    }
}

fn check_round_trip_and_ends<C: Codec<Event> + Codec<u32>>() {
    let whole = encoded::<C, _>(&event());
    assert_eq!(decoded::<C, Event>(&whole).unwrap(), event());
    for length in 0..whole.len() {
        refused::<C, Event>(&format!("truncated to {length} bytes"), &whole[..length]);
    }
    refused::<C, Event>("a zero byte at the end", &[&whole[..], b"\0"].concat());
    refused::<C, Event>("twice", &[&whole[..], &whole[..]].concat());
}

/// Strings, bytes, lists and maps that announce more than the frame contains are refused before memory is allocated.
fn check_announced_lengths<C>(cases: &[(&str, &[u8])])
where
    C: Codec<String> + Codec<Vec<u64>> + Codec<Vec<()>> + Codec<BTreeMap<u8, u8>> + Codec<Event>,
{
    for (case, bytes) in cases {
        refused::<C, String>(case, bytes);
        refused::<C, Vec<u64>>(case, bytes);
        refused::<C, Vec<()>>(case, bytes);
        refused::<C, BTreeMap<u8, u8>>(case, bytes);
        refused::<C, Event>(case, bytes);
    }
}

/// Frames of two million bytes that nest throughout, and a megabyte of each byte value.
fn check_nesting<C: Codec<List> + Codec<Chain> + Codec<Event>>(one_level: &[u8]) {
    let deep = one_level.repeat(2_000_000 / one_level.len());
    refused::<C, Chain>("a chain of enums", &deep);
    refused::<C, List>("a chain of enums as a list", &deep);
    for byte in 0..=255 {
        let same = vec![byte; 1_000_000];
        // Some may be accepted; none may crash the process.
        let _ = decoded::<C, List>(&same);
        let _ = decoded::<C, Event>(&same);
    }
    assert!(decoded::<C, Chain>(&encoded::<C, _>(&chain(100))).is_ok());
}

fn check_noise<C: Codec<Event> + Codec<Kind>>() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let whole = encoded::<C, _>(&event());
    for round in 0..20_000 {
        let mut bytes = whole.to_vec();
        for _ in 0..=round % 4 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let index = (state >> 33) as usize % bytes.len();
            bytes[index] = (state >> 24) as u8;
        }
        // A frame that is accepted must be a message that can be encoded again.
        if let Ok(message) = decoded::<C, Event>(&bytes) {
            encoded::<C, _>(&message);
        }
    }
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct First {
    x: u32,
    name: String,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Second {
    x: u32,
    name: String,
    unit: Option<Vec<Kind>>,
}

/// With field names in the frame, each version decodes the other.
#[cfg(any(feature = "cbor", feature = "msgpack"))]
fn check_versions<C: Codec<First> + Codec<Second>>() {
    let second = Second { x: 7, name: "a".into(), unit: Some(vec![Kind::Level(1), Kind::Named { text: "b".into() }]) };
    let first = First { x: 7, name: "a".into() };
    assert_eq!(decoded::<C, First>(&encoded::<C, _>(&second)).unwrap(), first);
    assert_eq!(decoded::<C, Second>(&encoded::<C, _>(&first)).unwrap(), Second { unit: None, ..second });
}

fn check_failed_encode<C: Codec<T>, T>(message: &T, cause: &str) {
    let mut buffer = BytesMut::from(&b"before"[..]);
    let error = C::encode(message, &mut buffer).unwrap_err();
    assert_eq!(buffer, b"before"[..]);
    assert!(error.to_string().contains(&format!("codec `{}` cannot encode", C::NAME)), "{error}");
    assert!(std::error::Error::source(&error).unwrap().to_string().contains(cause), "{:?}", error);
}

/// A type that no serde format can encode.
#[derive(Debug, Deserialize)]
struct Unencodable;

impl Serialize for Unencodable {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::{Error, SerializeSeq};
        let mut written = serializer.serialize_seq(Some(2))?;
        written.serialize_element("half of it")?;
        Err(S::Error::custom("only half can be encoded"))
    }
}

fn check_all<C>(lengths: &[(&str, &[u8])], one_level: &[u8])
where
    C: Codec<Event> + Codec<Kind> + Codec<u32> + Codec<String> + Codec<Vec<u64>> + Codec<Vec<()>>,
    C: Codec<BTreeMap<u8, u8>> + Codec<List> + Codec<Chain>,
{
    check_round_trip_and_ends::<C>();
    check_announced_lengths::<C>(lengths);
    check_nesting::<C>(one_level);
    check_noise::<C>();
}

#[cfg(feature = "cbor")]
#[test]
fn cbor() {
    use super::Cbor;
    let lengths: [(&str, &[u8]); 5] = [
        ("string of 2^64-1 bytes", b"\x7b\xff\xff\xff\xff\xff\xff\xff\xff"),
        ("bytes of 2^62", b"\x5b\x40\0\0\0\0\0\0\0x"),
        ("list of 2^62", b"\x9b\x40\0\0\0\0\0\0\0\x01"),
        ("map of 2^63", b"\xbb\x80\0\0\0\0\0\0\0\x01\x02"),
        ("list without end", b"\x9f\x01\x02"),
    ];
    check_all::<Cbor>(&lengths, b"\xa1\x64Next");
    check_versions::<Cbor>();
    check_failed_encode::<Cbor, _>(&Unencodable, "only half can be encoded");
    let error = refused::<Cbor, u32>("two items", b"\x01\x02");
    assert_eq!(
        error.to_string(),
        "codec `cbor` cannot decode this message: data follows the CBOR item in this 2-byte frame"
    );
}

/// Python and JavaScript send floats of 64 bits, and whole numbers as integers.
#[cfg(feature = "cbor")]
#[test]
fn cbor_decodes_floats_from_numbers_of_any_sort() {
    use super::Cbor;
    for (frame, value) in [
        (&b"\xfb\x3f\xf8\0\0\0\0\0\0"[..], 1.5),
        (b"\xfa\x3f\xc0\0\0", 1.5),
        (b"\xf9\x3e\0", 1.5),
        (b"\xc1\xf9\x3e\0", 1.5),
        (b"\x07", 7.0),
        (b"\x20", -1.0),
    ] {
        let frame = Bytes::copy_from_slice(frame);
        assert_eq!(<Cbor as Codec<f32>>::decode(frame.clone()).unwrap(), value);
        assert_eq!(<Cbor as Codec<f64>>::decode(frame.clone()).unwrap(), f64::from(value));
        assert!(<Cbor as Codec<Vec<f32>>>::decode(frame).is_err());
    }
    refused::<Cbor, f64>("a text", b"\x61\x31");
    refused::<Cbor, f32>("half of 16 bits", b"\xf9\x3e");
}

/// What encoders of other languages may write for the same message: tags on items, keys and the whole, floats as short
/// as possible, texts, lists and maps without a length, and fields that this type does not have.
#[cfg(feature = "cbor")]
#[test]
fn cbor_decodes_what_other_encoders_write() {
    use super::Cbor;
    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Fix {
        t: f64,
        n: u64,
        s: String,
        l: Vec<f32>,
        o: Option<i8>,
    }
    let fix = Fix { t: 1.5, n: 7, s: "ab".into(), l: vec![0.5, -2.0], o: None };
    // `at` is the text `t`, and so on.
    let frames: [&[u8]; 5] = [
        b"\xa5at\xf9\x3e\0an\x07as\x62abal\x82\xf9\x38\0\xf9\xc0\0ao\xf6",
        b"\xd9\xd9\xf7\xa5\xc0at\xc1\xf9\x3e\0an\xd8\x40\x07as\xc0\x62abal\xd8\x28\x82\xf9\x38\0\xf9\xc0\0ao\xf7",
        b"\xbfat\xfa\x3f\xc0\0\0\x7fan\xff\x1b\0\0\0\0\0\0\0\x07as\x7faaab\xffal\x9f\xf9\x38\0\x21\xff\xff",
        b"\xa5az\xc0\x61xat\xf9\x3e\0an\x18\x07as\x62abal\x82\xf9\x38\0\x21",
        b"\xa5al\x82\xf9\x38\0\x21as\x62aban\x07at\xf9\x3e\0az\x82\xc2\x49\x01\0\0\0\0\0\0\0\0\xf9\x7e\0",
    ];
    for frame in frames {
        assert_eq!(decoded::<Cbor, Fix>(frame).unwrap(), fix, "{frame:x?}");
    }
}

#[cfg(feature = "msgpack")]
#[test]
fn msgpack() {
    use super::Msgpack;
    let lengths: [(&str, &[u8]); 4] = [
        ("string of 2^32-1 bytes", b"\xdb\xff\xff\xff\xff"),
        ("bytes of 2^32-1", b"\xc6\xff\xff\xff\xff"),
        ("list of 2^32-1", b"\xdd\xff\xff\xff\xff\x01"),
        ("map of 2^32-1", b"\xdf\xff\xff\xff\xff\x01\x02"),
    ];
    check_all::<Msgpack>(&lengths, b"\x81\xa4Next");
    check_versions::<Msgpack>();
    check_failed_encode::<Msgpack, _>(&Unencodable, "only half can be encoded");
    let error = refused::<Msgpack, u32>("two values", b"\x01\x02");
    let text = "codec `msgpack` cannot decode this message: the value ends after 1 of 2 bytes";
    assert_eq!(error.to_string(), text);
}

/// The same of MessagePack: numbers of any width, extensions in fields that this type does not have.
#[cfg(feature = "msgpack")]
#[test]
fn msgpack_decodes_what_other_encoders_write() {
    use super::Msgpack;
    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Fix {
        t: f64,
        n: u64,
        s: String,
    }
    let fix = Fix { t: 1.5, n: 7, s: "ab".into() };
    let frames: [&[u8]; 4] = [
        b"\x83\xa1t\xca\x3f\xc0\0\0\xa1n\xd3\0\0\0\0\0\0\0\x07\xa1s\xa2ab",
        b"\xde\0\x03\xa1t\xcb\x3f\xf8\0\0\0\0\0\0\xd9\x01n\xcc\x07\xa1s\xdb\0\0\0\x02ab",
        b"\x84\xa1z\xd6\xff\0\0\0\x01\xa1t\xca\x3f\xc0\0\0\xa1n\x07\xa1s\xa2ab",
        b"\x84\xa1t\xca\x3f\xc0\0\0\xa1n\xd0\x07\xa1s\xa2ab\xa1z\x92\xc7\0\x05\xc7\x0c\xff\0\0\0\0\0\0\0\0\0\0\0\0",
    ];
    for frame in frames {
        assert_eq!(decoded::<Msgpack, Fix>(frame).unwrap(), fix, "{frame:x?}");
    }
    assert_eq!(decoded::<Msgpack, f32>(b"\xff").unwrap(), -1.0);
}

#[cfg(feature = "postcard")]
#[test]
fn postcard() {
    use super::Postcard;
    let lengths: [(&str, &[u8]); 2] = [
        ("length of 2^63", b"\x80\x80\x80\x80\x80\x80\x80\x80\x80\x01"),
        ("length of 2^40", b"\x80\x80\x80\x80\x80\x20\x01"),
    ];
    check_all::<Postcard>(&lengths, b"\x01");
    check_failed_encode::<Postcard, _>(&Unencodable, "Serde Serialization Error");
    let error = refused::<Postcard, u32>("two values", b"\x01\x02");
    let text = "codec `postcard` cannot decode this message: the value ends after 1 of 2 bytes";
    assert_eq!(error.to_string(), text);
}

/// Without field names, a frame of another version is too short or too long: an error, never a wrong value.
#[cfg(feature = "postcard")]
#[test]
fn postcard_refuses_a_version_with_one_field_more_or_less() {
    use super::Postcard;
    let first = encoded::<Postcard, _>(&First { x: 7, name: "a".into() });
    refused::<Postcard, Second>("one field less", &first);
    for unit in [None, Some(vec![]), Some(vec![Kind::Level(1)])] {
        let second = encoded::<Postcard, _>(&Second { x: 7, name: "a".into(), unit });
        refused::<Postcard, First>("one field more", &second);
    }
}
