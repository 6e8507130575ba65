//! Postcard, for any serde type.

use super::bounded::{self, Floats};
use super::{Codec, DecodeError, EncodeError, encode_with};
use bytes::{Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

/// Encodes any serde type in the compact format of `postcard`, without field names.
///
/// The format does not describe the type, so both ends must be built with the same version of it: a frame of another
/// version is refused if its length or a value does not fit, but may also be decoded as other values. Rename the type
/// when it changes; the contracts of the connection then differ, and the two versions do not connect. Types that accept
/// any value, such as `serde_json::Value` and untagged enums, cannot be decoded. Values nested deeper than 128 levels
/// (each `Some` is one level), data after the value, and sequences with more than 4096 elements beyond the number of
/// bytes of the frame are refused.
#[derive(Debug)]
pub struct Postcard;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Postcard {
    const NAME: &'static str = "postcard";

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        encode_with(buffer, |writer| postcard::to_io(message, writer).map(drop))
            .map_err(|error| EncodeError::new("postcard", "postcard cannot represent its value").caused_by(error))
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let mut input = postcard::Deserializer::from_bytes(&bytes);
        let message = bounded::decode(&mut input, bytes.len(), Floats::OfTheirWidth);
        let read = message.and_then(|message| Ok((message, input.finalize()?)));
        let refused = |error| DecodeError::not_a("postcard value", "postcard", bytes.len(), error);
        let (message, rest) = read.map_err(refused)?;
        if rest.is_empty() {
            return Ok(message);
        }
        let end = bytes.len() - rest.len();
        Err(DecodeError::new("postcard", format!("the value ends after {end} of {} bytes", bytes.len())))
    }
}
