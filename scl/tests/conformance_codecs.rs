//! Every codec keeps every guarantee.

use bytes::Bytes;
use scl::codec::Opaque;
use scl::conformance::codec;

#[test]
fn opaque() {
    codec::all::<Opaque, _>(&[Bytes::new(), Bytes::from_static(b"\0\xff text")]);
}

#[cfg(feature = "protobuf")]
#[test]
fn protobuf() {
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
    let inner = Some(Box::new(Reading { serial: u64::MAX, ..Reading::default() }));
    let reading = Reading { serial: 7, sensor: "imu".into(), values: vec![0.5, f64::INFINITY], inner };
    codec::all::<scl::codec::Protobuf, _>(&[Reading::default(), reading]);
}

#[cfg(feature = "raw")]
#[test]
fn raw() {
    codec::all::<scl::codec::Raw, [u8; 0]>(&[[]]);
    codec::all::<scl::codec::Raw, [u64; 3]>(&[[0, 1, u64::MAX]]);
}

#[cfg(any(feature = "json", feature = "cbor", feature = "msgpack", feature = "postcard"))]
mod any_serde_type {
    use scl::codec::Codec;
    use scl::conformance::codec;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Event {
        name: String,
        values: Vec<Option<i64>>,
        kind: Kind,
        inner: Option<Box<Event>>,
    }

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    enum Kind {
        Silent,
        Level(f64),
        Pair(u64, i16),
        Named { text: String, of: Box<Kind> },
    }

    fn check<C: Codec<Event> + Codec<u64> + Codec<String> + Codec<Vec<f32>>>() {
        codec::all::<C, u64>(&[0, 1, u64::MAX]);
        codec::all::<C, String>(&[String::new(), "läuft \u{1F600}".into()]);
        codec::all::<C, Vec<f32>>(&[vec![], vec![0.5; 300]]);
        let event = |kind, inner| Event { name: "imu".into(), values: vec![Some(i64::MIN), None], kind, inner };
        let named = Kind::Named { text: "a".into(), of: Box::new(Kind::Silent) };
        let events = [event(Kind::Level(-0.1), None), event(Kind::Pair(1, -1), Some(Box::new(event(named, None))))];
        codec::all::<C, Event>(&events);
    }

    #[cfg(feature = "json")]
    #[test]
    fn json() {
        check::<scl::codec::Json>();
    }

    #[cfg(feature = "cbor")]
    #[test]
    fn cbor() {
        check::<scl::codec::Cbor>();
    }

    #[cfg(feature = "msgpack")]
    #[test]
    fn msgpack() {
        check::<scl::codec::Msgpack>();
    }

    #[cfg(feature = "postcard")]
    #[test]
    fn postcard() {
        check::<scl::codec::Postcard>();
    }
}
