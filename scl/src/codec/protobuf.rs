//! Protobuf, for the messages of `prost`.

use super::{Codec, DecodeError, EncodeError};
use bytes::{Bytes, BytesMut};
use prost::Message;

/// Encodes the messages of `prost`.
///
/// As protobuf requires, unknown fields are skipped and missing fields have their default, so an empty frame is a valid
/// message. Fields of type `Bytes` share the received buffer. Messages nested deeper than 100 levels are refused. The
/// gate limits the memory of a message only if its type is one of `schemas:`. In messages with your own
/// `#[derive(prost::Message)]`, a -0.0 in a field without `optional` is received as 0.0, because `prost` takes it for
/// the default.
#[derive(Debug)]
pub struct Protobuf;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Message + Default> Codec<T> for Protobuf {
    const NAME: &'static str = "protobuf";

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        buffer.reserve(message.encoded_len());
        message.encode(buffer).map_err(|error| {
            EncodeError::new(<Self as Codec<T>>::NAME, "it does not fit in the buffer").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let length = bytes.len();
        T::decode(bytes).map_err(|error| DecodeError::not_a("protobuf message", "protobuf", length, error))
    }
}
