use bytes::{BufMut, Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

use super::{Codec, DecodeError, EncodeError};

/// Carries any serde type as one JSON value.
///
/// JSON has no infinity and no NaN: such numbers are written as `null`, which no plain number reads back. Values nested
/// deeper than 128 levels and anything but white space after the value are refused.
#[derive(Debug)]
pub struct Json;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Json {
    const NAME: &'static str = "json";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        let start = into.len();
        serde_json::to_writer((&mut *into).writer(), message).map_err(|error| {
            into.truncate(start);
            EncodeError::new(<Self as Codec<T>>::NAME, "its value has no form in json").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        serde_json::from_slice(&bytes).map_err(|error| {
            let reason = format!("{} bytes are no json value of the expected type", bytes.len());
            DecodeError::new(<Self as Codec<T>>::NAME, reason).caused_by(error)
        })
    }
}
