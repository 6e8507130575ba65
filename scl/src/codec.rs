//! What is said: how a message becomes bytes and bytes become a message.
//!
//! A codec knows neither endpoints nor sockets; it sees one message at a time. Each codec is a unit struct that is never
//! built: [`Opaque`] is always there, `Protobuf`, `Json`, `Raw`, `Cbor`, `Msgpack` and `Postcard` have a cargo feature each
//! (the last three are not on by default), and a user's own codec works like these.

#[cfg(any(feature = "cbor", feature = "msgpack", feature = "postcard"))]
mod bounded;
#[cfg(feature = "cbor")]
mod cbor;
mod error;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "msgpack")]
mod msgpack;
mod opaque;
#[cfg(feature = "postcard")]
mod postcard;
#[cfg(feature = "protobuf")]
mod protobuf;
#[cfg(feature = "raw")]
mod raw;

use bytes::{Bytes, BytesMut};

#[cfg(feature = "postcard")]
pub use self::postcard::Postcard;
#[cfg(feature = "cbor")]
pub use cbor::Cbor;
pub use error::{DecodeError, EncodeError};
#[cfg(feature = "json")]
pub use json::Json;
#[cfg(feature = "msgpack")]
pub use msgpack::Msgpack;
pub use opaque::Opaque;
#[cfg(feature = "protobuf")]
pub use protobuf::Protobuf;
#[cfg(feature = "raw")]
pub use raw::Raw;

/// Carries messages of type `T` as bytes.
///
/// One message is one frame: `decode` gets exactly the bytes that `encode` has appended, so a codec needs no length
/// prefix. It must treat every byte string as possible: whatever arrives, it answers with a message or an error.
///
/// # Example
///
/// A codec of one's own, named in the topology by its path (`codec: my_crate::Degrees`):
///
/// ```
/// use scl::codec::{Codec, DecodeError, EncodeError};
/// use bytes::{BufMut, Bytes, BytesMut};
///
/// /// Carries an angle as tenths of a degree.
/// pub struct Degrees;
///
/// impl Codec<f32> for Degrees {
///     const NAME: &'static str = "degrees";
///
///     fn encode(angle: &f32, into: &mut BytesMut) -> Result<(), EncodeError> {
///         if !(-180.0..=180.0).contains(angle) {
///             return Err(EncodeError::new(Self::NAME, format!("{angle} is no angle between -180 and 180")));
///         }
///         into.put_i16((angle * 10.0).round() as i16);
///         Ok(())
///     }
///
///     fn decode(bytes: Bytes) -> Result<f32, DecodeError> {
///         let tenths = <[u8; 2]>::try_from(&bytes[..])
///             .map_err(|error| DecodeError::new(Self::NAME, format!("{} bytes instead of 2", bytes.len())).caused_by(error))?;
///         Ok(f32::from(i16::from_be_bytes(tenths)) / 10.0)
///     }
/// }
///
/// let mut frame = BytesMut::new();
/// Degrees::encode(&-12.5, &mut frame)?;
/// assert_eq!(Degrees::decode(frame.freeze())?, -12.5);
/// assert!(Degrees::decode(Bytes::from_static(b"far too long")).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the codec `{Self}` cannot carry messages of type `{T}`",
    label = "`{T}` lacks what `{Self}` needs of a message",
    note = "`Protobuf` carries types that are `prost::Message` and `Default`: those generated from `schemas`, or with `#[derive(prost::Message)]`",
    note = "`Json`, `Cbor`, `Msgpack` and `Postcard` carry types with `#[derive(serde::Serialize, serde::Deserialize)]`",
    note = "`Raw` carries types of fixed layout: `#[repr(C)]` with `#[derive(zerocopy::IntoBytes, zerocopy::FromBytes, zerocopy::KnownLayout, zerocopy::Immutable)]`",
    note = "`Opaque` carries `bytes::Bytes` only: leave the gate untyped to use it",
    note = "a codec of your own carries what you write `impl scl::codec::Codec<{T}>` for"
)]
pub trait Codec<T>: Send + Sync + 'static {
    /// The codec's name in error texts, as in the topology file.
    const NAME: &'static str;

    /// Appends the bytes of `message` to `into`.
    ///
    /// What `into` held before stays in front, also when this fails.
    ///
    /// # Errors
    ///
    /// [`EncodeError`] when this codec has no bytes for this value.
    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError>;

    /// The bytes of `message` as a frame of its own; `memory` comes and is left empty, but may keep its room.
    ///
    /// By default they are encoded into `memory` and split off. A codec whose messages are [`Bytes`] already hands them on
    /// without a copy.
    ///
    /// # Errors
    ///
    /// Those of [`encode`](Self::encode).
    fn to_frame(message: &T, memory: &mut BytesMut) -> Result<Bytes, EncodeError> {
        Self::encode(message, memory)?;
        Ok(memory.split().freeze())
    }

    /// Reads one message, which must take all of `bytes`.
    ///
    /// # Errors
    ///
    /// [`DecodeError`] when the bytes are no message of this type.
    fn decode(bytes: Bytes) -> Result<T, DecodeError>;
}

#[cfg(all(test, any(feature = "cbor", feature = "msgpack", feature = "postcard")))]
mod serde_tests;
#[cfg(test)]
mod tests;
