use bytes::{Bytes, BytesMut};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::{Codec, DecodeError, EncodeError};

/// Carries types of fixed layout as the bytes they have in memory.
///
/// The fastest codec, for programs on one machine: the bytes depend on the machine's byte order unless the type uses
/// `zerocopy`'s ordered numbers. A frame must be exactly as long as the type. For plain bytes see
/// [`Opaque`](super::Opaque).
#[derive(Debug)]
pub struct Raw;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: IntoBytes + FromBytes + KnownLayout + Immutable> Codec<T> for Raw {
    const NAME: &'static str = "raw";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        into.extend_from_slice(message.as_bytes());
        Ok(())
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        // The error of `read_from_bytes` borrows the buffer and says no more than the lengths do, so it is not kept.
        T::read_from_bytes(&bytes).map_err(|_| {
            let reason = format!("the type takes exactly {} bytes, {} arrived", size_of::<T>(), bytes.len());
            DecodeError::new(<Self as Codec<T>>::NAME, reason)
        })
    }
}
