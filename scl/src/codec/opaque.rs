use bytes::{Bytes, BytesMut};

use super::{Codec, DecodeError, EncodeError};

/// Carries [`Bytes`] as they are: the codec of gates without a type.
///
/// Neither sending nor receiving copies them: what arrived is handed on, so decoding never fails. Bytes have a codec of their own because
/// one implementation for them and another for all types of fixed layout would overlap in [`Raw`](super::Raw).
#[derive(Debug)]
pub struct Opaque;

impl Codec<Bytes> for Opaque {
    const NAME: &'static str = "bytes";

    fn encode(message: &Bytes, into: &mut BytesMut) -> Result<(), EncodeError> {
        into.extend_from_slice(message);
        Ok(())
    }

    fn to_frame(message: &Bytes, _memory: &mut BytesMut) -> Result<Bytes, EncodeError> {
        Ok(message.clone())
    }

    fn decode(bytes: Bytes) -> Result<Bytes, DecodeError> {
        Ok(bytes)
    }
}
