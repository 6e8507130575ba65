use bytes::{BufMut, Bytes, BytesMut};
use cbor4ii::core::dec::Read;
use cbor4ii::core::utils::SliceReader;
use cbor4ii::serde::Deserializer;
use serde::{Serialize, de::DeserializeOwned};

use super::{Codec, DecodeError, EncodeError, bounded};

/// Carries any serde type as one CBOR item (RFC 8949), structs as maps by field name.
///
/// A reader passes over fields that it does not know, and an optional field that is not there is `None`, so both ends
/// may have different versions of a type. Values nested deeper than 128 levels (each `Some` is one), floats of 16 bits,
/// and anything after the item are refused. The unit type is written as an empty list, and read as one by types that look
/// at what comes next: `serde_json::Value::Null` does not come back as itself.
#[derive(Debug)]
pub struct Cbor;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Cbor {
    const NAME: &'static str = "cbor";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        let start = into.len();
        cbor4ii::serde::to_writer((&mut *into).writer(), message).map_err(|error| {
            into.truncate(start);
            EncodeError::new(<Self as Codec<T>>::NAME, "its value has no form in cbor").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let refused = |reason| DecodeError::new(<Self as Codec<T>>::NAME, reason);
        let mut input = Deserializer::new(SliceReader::new(&bytes));
        let message = bounded::read(&mut input, bytes.len()).map_err(|error| {
            refused(format!("{} bytes are no cbor item of the expected type", bytes.len())).caused_by(error)
        })?;
        match input.into_inner().fill(1) {
            Ok(rest) if rest.as_ref().is_empty() => Ok(message),
            _ => Err(refused(format!("{} bytes are more than one cbor item", bytes.len()))),
        }
    }
}
