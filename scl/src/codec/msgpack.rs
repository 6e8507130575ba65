use bytes::{BufMut, Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

use super::{Codec, DecodeError, EncodeError, bounded};

/// Carries any serde type as one MessagePack value, structs as maps by field name.
///
/// A reader passes over fields that it does not know, and an optional field that is not there is `None`, so both ends
/// may have different versions of a type. As in JSON, `Some(None)` reads back as `None`. Values nested deeper than 128
/// levels (each `Some` is one) and anything after the value are refused.
#[derive(Debug)]
pub struct Msgpack;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Msgpack {
    const NAME: &'static str = "msgpack";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        let start = into.len();
        rmp_serde::encode::write_named(&mut (&mut *into).writer(), message).map_err(|error| {
            into.truncate(start);
            EncodeError::new(<Self as Codec<T>>::NAME, "its value has no form in msgpack").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let refused = |reason| DecodeError::new(<Self as Codec<T>>::NAME, reason);
        let mut rest = std::io::Cursor::new(&bytes[..]);
        // The library counts the levels of arrays and maps, but not those of enums.
        let message = bounded::read(&mut rmp_serde::Deserializer::new(&mut rest), bytes.len()).map_err(|error| {
            refused(format!("{} bytes are no msgpack value of the expected type", bytes.len())).caused_by(error)
        })?;
        match bytes.len() as u64 - rest.position() {
            0 => Ok(message),
            more => Err(refused(format!("{more} of {} bytes follow after the value", bytes.len()))),
        }
    }
}
