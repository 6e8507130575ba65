//! Frames as they may arrive at a gate, read by every codec.

use super::record::{Flat, Proto, Record, Shape, full_proto, full_record, full_shape};
use scl::bytes::{Bytes, BytesMut};
use scl::codec::{Cbor, Codec, Json, Msgpack, Opaque, Postcard, Protobuf, Raw};
use serde_json::Value;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region};
use std::fmt::Debug;

/// What reading a frame may allocate: some for the words of an error, and for each byte of the frame what the costliest
/// element takes, a map of one message, which has room for eleven.
const SMALL: usize = 16 << 10;
const EACH_BYTE: usize = 2 << 10;

/// What a frame that is judged begins with: which codec reads it, and as what.
const READERS: [fn(Bytes); 14] = [
    judge::<Opaque, Bytes>,
    judge::<Raw, Flat>,
    judge::<Protobuf, Proto>,
    judge::<Json, Record>,
    judge::<Cbor, Record>,
    judge::<Msgpack, Record>,
    judge::<Postcard, Record>,
    judge::<Json, Shape>,
    judge::<Cbor, Shape>,
    judge::<Msgpack, Shape>,
    judge::<Postcard, Shape>,
    judge::<Json, Value>,
    judge::<Msgpack, Value>,
    // Nothing, as it is written in CBOR, is read as an empty list by a type that takes anything.
    |frame| drop(read_within_bounds::<Cbor, Value>(&frame)),
];

/// Reads a frame behind one byte that chooses the codec. There is no panic, and no more memory is taken than befits the
/// frame; whatever is a message can be sent again and arrives as the same.
///
/// # Panics
/// If that does not hold, or the program does not count its allocations with `stats_alloc`.
pub fn codecs(data: &[u8]) {
    if let Some((&choice, frame)) = data.split_first() {
        READERS[usize::from(choice) % READERS.len()](Bytes::copy_from_slice(frame));
    }
}

/// A sound frame for each reader, to start from.
pub fn frames_of_every_codec() -> Vec<Vec<u8>> {
    let value = serde_json::json!({"a": [1, -2, 0.5, null, true, "text"], "b": {"": []}});
    let frames = [
        Bytes::from_static(b"anything"),
        written::<Raw, _>(&Flat::default()),
        written::<Protobuf, _>(&full_proto()),
        written::<Json, _>(&full_record()),
        written::<Cbor, _>(&full_record()),
        written::<Msgpack, _>(&full_record()),
        written::<Postcard, _>(&full_record()),
        written::<Json, _>(&full_shape()),
        written::<Cbor, _>(&full_shape()),
        written::<Msgpack, _>(&full_shape()),
        written::<Postcard, _>(&full_shape()),
        written::<Json, _>(&value),
        written::<Msgpack, _>(&value),
        written::<Cbor, _>(&value),
    ];
    (0..).zip(frames).map(|(choice, frame)| [&[choice], &frame[..]].concat()).collect()
}

fn judge<C: Codec<T>, T: Debug>(frame: Bytes) {
    let Some(message) = read_within_bounds::<C, T>(&frame) else { return };
    let text = format!("{message:?}");
    let again = C::decode(written::<C, T>(&message));
    match again {
        Ok(again) => assert_eq!(format!("{again:?}"), text, "codec `{}` changes what it read of {frame:?}", C::NAME),
        // Numbers beyond what a field holds are read as infinite, for which JSON has no form.
        Err(_) if C::NAME == "json" && text.contains("inf") => {}
        Err(error) => panic!("codec `{}` does not read what it wrote of {text}: {error:?}", C::NAME),
    }
}

fn read_within_bounds<C: Codec<T>, T>(frame: &Bytes) -> Option<T> {
    let allocations = Region::new(&INSTRUMENTED_SYSTEM);
    let counted = Bytes::copy_from_slice(frame);
    let message = C::decode(counted);
    let allocated = allocations.change().bytes_allocated;
    assert!(allocated >= frame.len(), "the program does not count its allocations");
    let bound = SMALL + EACH_BYTE * frame.len();
    assert!(allocated <= bound, "codec `{}` allocated {allocated} bytes for {} of {frame:?}", C::NAME, frame.len());
    message.ok()
}

fn written<C: Codec<T>, T>(message: &T) -> Bytes {
    let mut into = BytesMut::new();
    C::encode(message, &mut into).unwrap_or_else(|error| panic!("{error:?}"));
    into.freeze()
}
