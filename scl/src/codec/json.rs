//! JSON, for any serde type. The messages of `schemas:` are serde types too, see `message_json`.

use super::{Codec, DecodeError, EncodeError, encode_with};
use bytes::{Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

/// Encodes any serde type as one JSON value, and the messages of `schemas:` as canonical protobuf JSON.
///
/// [Canonical protobuf JSON](https://protobuf.dev/programming-guides/json) is what protobuf's libraries of other
/// languages read and write: names in lowerCamelCase, 64-bit integers as strings, bytes in base64, enum values by name,
/// fields with their default left out. A field that the receiver does not know is skipped, as in `protobuf`, so a
/// Python program reads such frames with `json_format.Parse(.., ignore_unknown_fields=True)` to do the same.
///
/// JSON has neither infinity nor NaN: such numbers are encoded as `null`, which does not decode as a number. Values
/// nested deeper than 128 levels, and anything but white space after the value, are refused.
#[derive(Debug)]
pub struct Json;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Json {
    const NAME: &'static str = "json";

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        encode_with(buffer, |writer| serde_json::to_writer(writer, message))
            .map_err(|error| EncodeError::new("json", "JSON cannot represent its value").caused_by(error))
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        serde_json::from_slice(&bytes).map_err(|error| DecodeError::not_a("JSON value", "json", bytes.len(), error))
    }
}
