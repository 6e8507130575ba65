//! CBOR, for any serde type.

use super::bounded::{self, Floats};
use super::{Codec, DecodeError, EncodeError, encode_with};
use bytes::{Bytes, BytesMut};
use cbor4ii::core::dec::Read;
use cbor4ii::core::utils::SliceReader;
use cbor4ii::serde::Deserializer;
use serde::{Serialize, de::DeserializeOwned};
use std::convert::Infallible;

/// Encodes any serde type as one CBOR item (RFC 8949), structs as maps with field names.
///
/// Unknown fields are skipped and missing optional fields become `None`, so the two ends may use different versions of
/// a type. Floats are decoded from numbers of any sort, because other languages have floats of one width only and write
/// whole numbers as integers, or shorten floats to 16 bits. Tags are ignored, except those of big numbers: any other
/// tagged item is decoded as if it had no tag. Values nested deeper than 128 levels (each `Some` is one level), and
/// data after the item are refused. The unit type is encoded as an empty list, and types that accept any value decode
/// it as such: `serde_json::Value::Null` becomes an empty array.
#[derive(Debug)]
pub struct Cbor;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Cbor {
    const NAME: &'static str = "cbor";

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        encode_with(buffer, |writer| cbor4ii::serde::to_writer(writer, message))
            .map_err(|error| EncodeError::new("cbor", "CBOR cannot represent its value").caused_by(error))
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let decoded = decode(&bytes).or_else(|error| match scl_cbor::simplify(&bytes) {
            Some(simple) => decode(&simple),
            None => Err(error),
        });
        decoded.map_err(|error| match error {
            Refused::Item(error) => DecodeError::not_a("CBOR item", "cbor", bytes.len(), error),
            Refused::Rest => {
                let reason = format!("data follows the CBOR item in this {}-byte frame", bytes.len());
                DecodeError::new("cbor", reason)
            }
        })
    }
}

/// Why a frame is not decoded.
enum Refused {
    Item(cbor4ii::serde::DecodeError<Infallible>),
    /// Data follows the item.
    Rest,
}

fn decode<T: DeserializeOwned>(frame: &[u8]) -> Result<T, Refused> {
    let mut input = Deserializer::new(SliceReader::new(frame));
    let message = bounded::decode(&mut input, frame.len(), Floats::OfAnyNumber).map_err(Refused::Item)?;
    match input.into_inner().fill(1) {
        Ok(rest) if rest.as_ref().is_empty() => Ok(message),
        _ => Err(Refused::Rest),
    }
}
