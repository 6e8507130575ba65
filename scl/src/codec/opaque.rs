//! Plain bytes, for gates without a type.

use super::{Codec, DecodeError, EncodeError};
use bytes::{Bytes, BytesMut};

/// Up to this length, in bytes, copying into a reused buffer costs less than sharing ownership.
const SHORT: usize = 512;

/// Sends and receives [`Bytes`] unchanged: the codec of gates without a type.
///
/// Neither encoding nor decoding copies, except for messages of up to 512 bytes, which are copied when they are sent
/// because sharing their memory would cost more. Decoding never fails.
// Separate from `Raw`, whose implementation for all types of fixed layout would overlap with one for `Bytes`.
#[derive(Debug)]
pub struct Opaque;

impl Codec<Bytes> for Opaque {
    const NAME: &'static str = "bytes";

    fn encode(message: &Bytes, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        buffer.extend_from_slice(message);
        Ok(())
    }

    fn to_frame(message: &Bytes, buffer: &mut BytesMut) -> Result<Bytes, EncodeError> {
        if message.len() > SHORT {
            return Ok(message.clone());
        }
        Self::encode(message, buffer)?;
        Ok(buffer.split().freeze())
    }

    fn decode(bytes: Bytes) -> Result<Bytes, DecodeError> {
        Ok(bytes)
    }
}
