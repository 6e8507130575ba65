use bytes::{Bytes, BytesMut};
use prost::Message;

use super::{Codec, DecodeError, EncodeError};

/// Carries protobuf messages of `prost`.
///
/// As protobuf demands, unknown fields are skipped and missing ones get their default, so an empty frame is a valid
/// message. Fields of type `Bytes` share the buffer that arrived. Messages nested deeper than 100 levels are refused.
#[derive(Debug)]
pub struct Protobuf;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Message + Default> Codec<T> for Protobuf {
    const NAME: &'static str = "protobuf";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        into.reserve(message.encoded_len());
        message.encode(into).map_err(|error| {
            EncodeError::new(<Self as Codec<T>>::NAME, "there is no room for it in the buffer").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let length = bytes.len();
        T::decode(bytes).map_err(|error| {
            let reason = format!("{length} bytes are no valid protobuf message of the expected type");
            DecodeError::new(<Self as Codec<T>>::NAME, reason).caused_by(error)
        })
    }
}
