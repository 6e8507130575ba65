use bytes::{Bytes, BytesMut};

use super::{Codec, DecodeError, EncodeError};

/// Up to this length, in bytes, a copy into memory that is used again costs less than a second owner.
const SHORT: usize = 512;

/// Carries [`Bytes`] as they are: the codec of gates without a type.
///
/// Neither sending nor receiving copies them: what arrived is handed on, so decoding never fails. Only a short message is
/// copied when it is sent, because a second owner of its memory would cost more. Bytes have a codec of their own because
/// one implementation for them and another for all types of fixed layout would overlap in [`Raw`](super::Raw).
#[derive(Debug)]
pub struct Opaque;

impl Codec<Bytes> for Opaque {
    const NAME: &'static str = "bytes";

    fn encode(message: &Bytes, into: &mut BytesMut) -> Result<(), EncodeError> {
        into.extend_from_slice(message);
        Ok(())
    }

    fn to_frame(message: &Bytes, memory: &mut BytesMut) -> Result<Bytes, EncodeError> {
        if message.len() > SHORT {
            return Ok(message.clone());
        }
        Self::encode(message, memory)?;
        Ok(memory.split().freeze())
    }

    fn decode(bytes: Bytes) -> Result<Bytes, DecodeError> {
        Ok(bytes)
    }
}
