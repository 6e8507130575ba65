//! Rust types, whose codecs know no gate: 64 times the frame's length, at least 16 MiB.

use crate::{MIB, counted, turn};
use scl::bytes::BytesMut;
use scl::codec::{Cbor, Codec, Msgpack, Postcard};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A list of it needs one byte for each `None`, and 264 in memory.
type Sparse = Option<[u64; 32]>;

/// Formats with names can leave out everything.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
struct Settings {
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Sparse,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Sparse,
}

/// Lists in lists, each of which announces more than it has.
#[derive(Debug, Serialize, Deserialize)]
struct Nest(Vec<Nest>, Sparse);

const COUNT: usize = 300_000;

fn check<C: Codec<T>, T>(case: &str, message: &T) {
    let frame = C::to_frame(message, &mut BytesMut::new()).expect("encoded");
    let (length, codec) = (frame.len(), C::NAME);
    let (decoded, allocated) = counted(|| C::decode(frame));
    // serde allocates up to 1 MiB for announced elements before there are any.
    let limit = ((64 * length).max(16 * MIB) + 2 * MIB) as u64;
    println!("{codec}, {case}: {length} bytes, {} MiB", allocated >> 20);
    assert!(allocated <= limit, "{codec}, {case}: {length} bytes took {allocated}");
    let error = decoded.err().unwrap_or_else(|| panic!("{codec}, {case}: accepted"));
    let cause = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
    // The library of postcard keeps no text.
    assert!(
        codec == "postcard" || cause.contains("takes more memory than 64 times the frame"),
        "{codec}, {case}: {cause}"
    );
}

fn check_all<C>(lists: &[&'static str])
where
    C: Codec<Vec<Sparse>> + Codec<HashMap<u32, Sparse>> + Codec<Vec<Settings>> + Codec<Vec<Box<Settings>>>,
{
    let _turn = turn();
    check::<C, Vec<Sparse>>("absent values", &vec![None; COUNT]);
    if lists.contains(&"names") {
        check::<C, Vec<Settings>>("structs without fields", &vec![Settings::default(); COUNT]);
        check::<C, Vec<Box<Settings>>>("boxes of them", &vec![Box::default(); COUNT]);
    }
    if lists.contains(&"maps") {
        check::<C, HashMap<u32, Sparse>>("maps of absent values", &(0..COUNT as u32).map(|key| (key, None)).collect());
    }
}

#[test]
fn cbor_is_bounded() {
    check_all::<Cbor>(&["names", "maps"]);
}

#[test]
fn msgpack_is_bounded() {
    check_all::<Msgpack>(&["names", "maps"]);
}

#[test]
fn postcard_is_bounded() {
    check_all::<Postcard>(&["maps"]);
}

/// Elements that take no memory and no bytes, and lists that are announced in lists.
#[test]
fn announced_lengths_allocate_little() {
    let _turn = turn();
    let deep = |announced: &[u8]| announced.repeat(10_000);
    let frames: [(&str, Vec<u8>); 3] = [
        ("cbor", deep(b"\x82\x9a\0\x01\0\0")),
        ("msgpack", deep(b"\x92\xdd\0\x01\0\0")),
        ("postcard", deep(b"\x80\x80\x04")),
    ];
    for (codec, frame) in frames {
        let refused = |result: Result<Nest, scl::codec::DecodeError>| assert!(result.is_err(), "{codec}");
        let (_, allocated) = match codec {
            "cbor" => counted(|| refused(decode::<Cbor, _>(&frame))),
            "msgpack" => counted(|| refused(decode::<Msgpack, _>(&frame))),
            _ => counted(|| refused(decode::<Postcard, _>(&frame))),
        };
        assert!(allocated < 20 * MIB as u64, "{codec}: {} MiB", allocated >> 20);
    }
    assert!(decode::<Cbor, Vec<()>>(b"\x9b\x00\0\0\x01\0\0\0\0").is_err());
    assert!(decode::<Postcard, Vec<()>>(b"\xff\xff\xff\xff\xff\x01").is_err());
}

fn decode<C: Codec<T>, T>(frame: &[u8]) -> Result<T, scl::codec::DecodeError> {
    C::decode(scl::bytes::Bytes::copy_from_slice(frame))
}
