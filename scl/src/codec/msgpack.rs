//! MessagePack, for any serde type.

use super::bounded::{self, Floats};
use super::{Codec, DecodeError, EncodeError, encode_with};
use bytes::{Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

/// Encodes any serde type as one MessagePack value, structs as maps with field names.
///
/// Unknown fields are skipped and missing optional fields become `None`, so the two ends may use different versions of
/// a type. As in JSON, `Some(None)` is decoded as `None`. Values nested deeper than 128 levels (each `Some` is one
/// level) and data after the value are refused.
#[derive(Debug)]
pub struct Msgpack;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Msgpack {
    const NAME: &'static str = "msgpack";

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        encode_with(buffer, |mut writer| rmp_serde::encode::write_named(&mut writer, message))
            .map_err(|error| EncodeError::new("msgpack", "MessagePack cannot represent its value").caused_by(error))
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let mut rest = std::io::Cursor::new(&bytes[..]);
        // The library limits the depth of arrays and maps, but not of enums.
        let message = bounded::decode(&mut rmp_serde::Deserializer::new(&mut rest), bytes.len(), Floats::OfTheirWidth)
            .map_err(|error| DecodeError::not_a("MessagePack value", "msgpack", bytes.len(), error))?;
        match rest.position() {
            end if end == bytes.len() as u64 => Ok(message),
            end => Err(DecodeError::new("msgpack", format!("the value ends after {end} of {} bytes", bytes.len()))),
        }
    }
}
