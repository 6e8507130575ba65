//! The codecs that are on by default: round trips, truncated and hostile frames, error messages.
#![allow(clippy::unwrap_used)]

use super::{Codec, Opaque};
use bytes::{Bytes, BytesMut};
use std::fmt::Debug;

#[test]
fn opaque_keeps_any_bytes_without_a_copy() {
    check_round_trip::<Opaque, _>(&[Bytes::new(), Bytes::from_static(b"\0\xff text"), Bytes::from(vec![7; 100_000])]);
    let sent = Bytes::from(vec![7; 1000]);
    assert_eq!(Opaque::decode(sent.clone()).unwrap().as_ptr(), sent.as_ptr());
    assert_eq!(Opaque::to_frame(&sent, &mut BytesMut::new()).unwrap().as_ptr(), sent.as_ptr());
}

#[cfg(feature = "protobuf")]
mod protobuf {
    use super::*;
    use crate::codec::Protobuf;

    #[derive(Clone, PartialEq, prost::Message)]
    struct Reading {
        #[prost(uint64, tag = "1")]
        serial: u64,
        #[prost(string, tag = "2")]
        sensor: String,
        #[prost(double, repeated, tag = "3")]
        values: Vec<f64>,
        #[prost(message, optional, boxed, tag = "4")]
        inner: Option<Box<Reading>>,
    }

    fn reading() -> Reading {
        let inner = Some(Box::new(Reading { serial: u64::MAX, ..Reading::default() }));
        Reading { serial: 7, sensor: "imu".into(), values: vec![0.5, f64::INFINITY], inner }
    }

    #[test]
    fn round_trip() {
        check_round_trip::<Protobuf, _>(&[Reading::default(), reading()]);
        assert_eq!(<Protobuf as Codec<Reading>>::decode(Bytes::new()).unwrap(), Reading::default());
    }

    #[test]
    fn truncated_is_an_error_or_a_prefix_of_the_fields() {
        let whole = encoded::<Protobuf, _>(&reading());
        let accepted: Vec<usize> = (0..=whole.len())
            .filter(|&length| <Protobuf as Codec<Reading>>::decode(whole.slice(..length)).is_ok())
            .collect();
        // Protobuf has no end marker, so a frame that is cut between two fields is a message, and no other is.
        assert_eq!(accepted, [0, 2, 7, 25, whole.len()]);
    }

    #[test]
    fn hostile_bytes_are_errors() {
        let nested = nest(150);
        let cases: [(&str, &[u8]); 6] = [
            ("length of 2^63 in a string", b"\x12\xff\xff\xff\xff\xff\xff\xff\xff\x7f"),
            ("number of 11 bytes", b"\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"),
            ("field number 0", b"\x00\x00"),
            ("group that never ends", b"\x0b\x0b\x0b"),
            ("text that is not UTF-8", b"\x12\x02\xff\xfe"),
            ("150 levels", &nested),
        ];
        for (case, bytes) in cases {
            check_refused::<Protobuf, Reading>(case, bytes, "protobuf");
        }
        assert!(<Protobuf as Codec<Reading>>::decode(nest(50).into()).is_ok());
        check_noise::<Protobuf, Reading>();
    }

    fn nest(levels: usize) -> Vec<u8> {
        (0..levels).fold(Vec::new(), |inner, _| {
            let mut outer = vec![0x22];
            prost::encode_length_delimiter(inner.len(), &mut outer).unwrap();
            outer.extend(inner);
            outer
        })
    }
}

#[cfg(feature = "json")]
mod json {
    use std::collections::BTreeMap;

    use serde::{Deserialize, Serialize};

    use super::*;
    use crate::codec::Json;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Event {
        name: String,
        values: Vec<Option<f64>>,
        inner: Option<Box<Event>>,
    }

    fn event() -> Event {
        let inner = Some(Box::new(Event { name: String::new(), values: vec![], inner: None }));
        Event { name: "läuft \"\u{1F600}\"\n".into(), values: vec![Some(0.25), None], inner }
    }

    #[test]
    fn round_trip() {
        check_round_trip::<Json, _>(&[event()]);
    }

    #[test]
    fn numbers_keep_their_last_digit() {
        check_round_trip::<Json, _>(&[2.222_222_222_222_222_6e283, 0.1 + 0.2, f64::MIN_POSITIVE, f64::MAX, -5e-324]);
    }

    #[test]
    fn truncated_is_an_error_at_every_length() {
        let whole = encoded::<Json, _>(&event());
        for length in 0..whole.len() {
            check_refused::<Json, Event>("truncated", &whole[..length], "json");
        }
    }

    #[test]
    fn hostile_bytes_are_errors() {
        let nested = "[".repeat(1_000_000);
        let cases: [(&str, &[u8]); 6] = [
            ("an empty frame", b""),
            ("trailing value", b"{\"name\":\"\",\"values\":[],\"inner\":null} 1"),
            ("trailing zero byte", b"{\"name\":\"\",\"values\":[],\"inner\":null}\0"),
            ("another type", b"[1, 2]"),
            ("text that is not UTF-8", b"\"\xff\""),
            ("a million levels", nested.as_bytes()),
        ];
        for (case, bytes) in cases {
            check_refused::<Json, Event>(case, bytes, "json");
        }
        check_refused::<Json, serde_json::Value>("a million levels of any value", nested.as_bytes(), "json");
        check_noise::<Json, Event>();
    }

    #[test]
    fn a_failed_encode_leaves_the_buffer_as_it_was() {
        let unwritable = BTreeMap::from([(vec![1_u8], 1_u8)]);
        let mut buffer = BytesMut::from(&b"before"[..]);
        let error = <Json as Codec<BTreeMap<Vec<u8>, u8>>>::encode(&unwritable, &mut buffer).unwrap_err();
        assert_eq!(buffer, b"before"[..]);
        assert_eq!(error.to_string(), "codec `json` cannot encode this message: JSON cannot represent its value");
        assert_eq!(std::error::Error::source(&error).unwrap().to_string(), "key must be a string");
    }
}

#[cfg(feature = "raw")]
mod raw {
    use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

    use super::*;
    use crate::codec::Raw;

    #[derive(Debug, PartialEq, IntoBytes, FromBytes, KnownLayout, Immutable)]
    #[repr(C)]
    struct Attitude {
        quaternion: [f64; 3],
        stamp: u64,
    }

    fn attitude() -> Attitude {
        Attitude { quaternion: [0.5, -0.5, 1e300], stamp: u64::MAX }
    }

    #[test]
    fn round_trip() {
        check_round_trip::<Raw, _>(&[attitude()]);
        check_round_trip::<Raw, [u8; 0]>(&[[]]);
    }

    #[test]
    fn any_other_length_is_an_error_with_both_lengths() {
        let whole = encoded::<Raw, _>(&attitude());
        for length in (0..whole.len()).chain([33, 4096]) {
            let bytes = vec![0xff; length];
            check_refused::<Raw, Attitude>(&format!("{length} bytes"), &bytes, "raw");
        }
        let error = <Raw as Codec<Attitude>>::decode(whole.slice(1..)).unwrap_err();
        assert_eq!(error.to_string(), "codec `raw` cannot decode this message: expected exactly 32 bytes, received 31");
    }

    #[test]
    fn unaligned_bytes_are_decoded() {
        let mut frame = BytesMut::from(&b"x"[..]);
        Raw::encode(&attitude(), &mut frame).unwrap();
        let frame = frame.freeze();
        for shift in 0..8 {
            let mut shifted = vec![0; shift];
            shifted.extend_from_slice(&frame[1..]);
            let read: Attitude = Raw::decode(Bytes::from(shifted).slice(shift..)).unwrap();
            assert_eq!(read, attitude());
        }
    }
}

/// Encodes after other bytes, to catch a codec that overwrites or drops them.
fn check_round_trip<C: Codec<T>, T: PartialEq + Debug>(messages: &[T]) {
    for message in messages {
        let mut buffer = BytesMut::from(&b"before"[..]);
        C::encode(message, &mut buffer).unwrap();
        assert_eq!(buffer.split_to(6), b"before"[..]);
        assert_eq!(C::decode(buffer.freeze()).unwrap(), *message);
    }
}

#[cfg(any(feature = "protobuf", feature = "json", feature = "raw"))]
fn encoded<C: Codec<T>, T>(message: &T) -> Bytes {
    let mut buffer = BytesMut::new();
    C::encode(message, &mut buffer).unwrap();
    buffer.freeze()
}

#[cfg(any(feature = "protobuf", feature = "json", feature = "raw"))]
fn check_refused<C: Codec<T>, T>(case: &str, bytes: &[u8], codec: &str) {
    match C::decode(Bytes::copy_from_slice(bytes)) {
        Ok(_) => panic!("{case}: accepted"),
        Err(error) => assert_eq!(error.codec(), codec, "{case}"),
    }
}

/// Random bytes that are accepted must be a message that can be encoded again.
#[cfg(any(feature = "protobuf", feature = "json"))]
fn check_noise<C: Codec<T>, T>() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut refused = 0;
    for round in 0..20_000 {
        let bytes: Vec<u8> = std::iter::repeat_with(|| next(&mut state)).take(round % 40).collect();
        match C::decode(bytes.into()) {
            Ok(message) => C::encode(&message, &mut BytesMut::new()).unwrap(),
            Err(error) => {
                refused += 1;
                assert!(std::error::Error::source(&error).is_some() && !error.reason().is_empty());
            }
        }
    }
    assert!(refused > 10_000, "only {refused} of 20000 random frames were refused");
}

#[cfg(any(feature = "protobuf", feature = "json"))]
fn next(state: &mut u64) -> u8 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 32) as u8
}
