//! Codecs: encoding messages into bytes and decoding them.
//!
//! A codec knows neither endpoints nor sockets; it handles one message at a time. Each codec is a unit struct that is
//! never constructed. [`Opaque`] is always available; `Protobuf`, `Json`, `Raw`, `Cbor`, `Msgpack` and `Postcard` have
//! one cargo feature each, the last three of them off by default. You can implement [`Codec`] for codecs of your own.

#[cfg(any(feature = "cbor", feature = "msgpack", feature = "postcard", all(feature = "json", feature = "protobuf")))]
#[macro_use]
mod visit_plain;
#[cfg(any(feature = "cbor", feature = "msgpack", feature = "postcard"))]
mod bounded;
#[macro_use]
mod by_feature;
#[cfg(feature = "cbor")]
mod cbor;
#[cfg(all(feature = "json", feature = "protobuf"))]
mod enum_names;
mod error;
#[cfg(feature = "json")]
mod json;
#[cfg(all(feature = "json", feature = "protobuf"))]
pub(crate) mod message_json;
#[cfg(feature = "msgpack")]
mod msgpack;
mod opaque;
#[cfg(feature = "postcard")]
mod postcard;
#[cfg(feature = "protobuf")]
mod protobuf;
#[cfg(feature = "raw")]
mod raw;

use bytes::{BufMut, Bytes, BytesMut};

pub use error::{DecodeError, EncodeError};
pub use opaque::Opaque;

codecs! {
    "protobuf" protobuf Protobuf
    "json" json Json
    "cbor" cbor Cbor
    "msgpack" msgpack Msgpack
    "postcard" postcard Postcard
    "raw" raw Raw
}

/// Encodes messages of type `T` into bytes and decodes them.
///
/// One message is one frame: `decode` receives exactly the bytes that `encode` appended, so a codec needs no length
/// prefix. The bytes may come from any program: `decode` must return a message or an error for every input.
///
/// # Example
///
/// A codec of your own, named in the topology file by its path (`codec: my_crate::Degrees`):
///
/// ```
/// use scl::codec::{Codec, DecodeError, EncodeError};
/// use bytes::{BufMut, Bytes, BytesMut};
///
/// /// Encodes an angle in tenths of a degree.
/// pub struct Degrees;
///
/// impl Codec<f32> for Degrees {
///     const NAME: &'static str = "degrees";
///
///     fn encode(angle: &f32, buffer: &mut BytesMut) -> Result<(), EncodeError> {
///         if !(-180.0..=180.0).contains(angle) {
///             return Err(EncodeError::new(Self::NAME, format!("{angle} is not between -180 and 180")));
///         }
///         buffer.put_i16((angle * 10.0).round() as i16);
///         Ok(())
///     }
///
///     fn decode(bytes: Bytes) -> Result<f32, DecodeError> {
///         let tenths = <[u8; 2]>::try_from(&bytes[..])
///             .map_err(|_| DecodeError::new(Self::NAME, format!("expected 2 bytes, received {}", bytes.len())))?;
///         Ok(f32::from(i16::from_be_bytes(tenths)) / 10.0)
///     }
/// }
///
/// let mut frame = BytesMut::new();
/// Degrees::encode(&-12.5, &mut frame)?;
/// assert_eq!(Degrees::decode(frame.freeze())?, -12.5);
/// assert!(Degrees::decode(Bytes::from_static(b"too long")).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the codec `{Self}` does not support messages of type `{T}`",
    label = "`{T}` does not meet the requirements of `{Self}`",
    note = "`Protobuf` supports types that are `prost::Message` and `Default`: those generated from `schemas`, or with `#[derive(prost::Message)]`",
    note = "`Json` supports the messages of `schemas` too, in protobuf's canonical form",
    note = "`Json`, `Cbor`, `Msgpack` and `Postcard` support types with `#[derive(serde::Serialize, serde::Deserialize)]`",
    note = "`Raw` supports types of fixed layout: `#[repr(C)]` with `#[derive(zerocopy::IntoBytes, zerocopy::FromBytes, zerocopy::KnownLayout, zerocopy::Immutable)]`",
    note = "`Opaque` supports only `bytes::Bytes`: it is the codec of gates without a type",
    note = "a codec of your own supports the types for which it implements `scl::codec::Codec<{T}>`"
)]
pub trait Codec<T>: Send + Sync + 'static {
    /// The codec's name in error messages, as in the topology file.
    const NAME: &'static str;

    /// The length of every message in bytes, if all messages have the same length. Transports that reserve memory for
    /// the longest message of a connection then reserve no more than that. Default: `None`.
    const FIXED_LENGTH: Option<usize> = None;

    /// Encodes `message` and appends the bytes to `buffer`. What `buffer` contained before stays unchanged, even on
    /// failure.
    ///
    /// # Errors
    ///
    /// [`EncodeError`] if this codec cannot represent the value.
    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError>;

    /// Encodes `message` into one frame. `buffer` must be empty and is left empty; its capacity is reused.
    ///
    /// The default implementation encodes into `buffer` and splits the bytes off. A codec whose messages are [`Bytes`]
    /// returns them without a copy.
    ///
    /// # Errors
    ///
    /// Those of [`encode`](Self::encode).
    fn to_frame(message: &T, buffer: &mut BytesMut) -> Result<Bytes, EncodeError> {
        Self::encode(message, buffer)?;
        Ok(buffer.split().freeze())
    }

    /// Decodes one message, which must consist of all of `bytes`.
    ///
    /// # Errors
    ///
    /// [`DecodeError`] if the bytes are not a message of this type.
    fn decode(bytes: Bytes) -> Result<T, DecodeError>;
}

/// Appends an encoding to the buffer, or leaves the buffer as it was.
#[allow(dead_code, reason = "the codecs that use it may be off")]
fn encode_with<E>(
    buffer: &mut BytesMut,
    encode: impl FnOnce(bytes::buf::Writer<&mut BytesMut>) -> Result<(), E>,
) -> Result<(), E> {
    let start = buffer.len();
    encode((&mut *buffer).writer()).inspect_err(|_| buffer.truncate(start))
}

#[cfg(all(test, any(feature = "cbor", feature = "msgpack", feature = "postcard")))]
mod serde_tests;
#[cfg(test)]
mod tests;
