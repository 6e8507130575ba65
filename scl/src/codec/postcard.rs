use bytes::{BufMut, Bytes, BytesMut};
use serde::{Serialize, de::DeserializeOwned};

use super::{Codec, DecodeError, EncodeError, bounded};

/// Carries any serde type in the compact format of `postcard`, without field names.
///
/// The bytes say nothing about the type, so both ends must be built from the same version of it: a frame of another
/// version is refused where its length or a value does not fit, but may also be read as other values. Name the type
/// anew when it changes, then the contract of the connection keeps the two apart. Types that look at what comes next,
/// such as `serde_json::Value` or untagged enums, cannot be read. Values nested deeper than 128 levels (each `Some` is
/// one), anything after the value, and sequences of more elements than the frame has bytes and 4096 are refused.
#[derive(Debug)]
pub struct Postcard;

// Without this attribute the compiler would complain about the bounds below instead of showing the text of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: Serialize + DeserializeOwned> Codec<T> for Postcard {
    const NAME: &'static str = "postcard";

    fn encode(message: &T, into: &mut BytesMut) -> Result<(), EncodeError> {
        let start = into.len();
        postcard::to_io(message, (&mut *into).writer()).map(drop).map_err(|error| {
            into.truncate(start);
            EncodeError::new(<Self as Codec<T>>::NAME, "its value has no form in postcard").caused_by(error)
        })
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        let refused = |reason| DecodeError::new(<Self as Codec<T>>::NAME, reason);
        let mut input = postcard::Deserializer::from_bytes(&bytes);
        let message = bounded::read(&mut input, bytes.len());
        let read = message.and_then(|message| Ok((message, input.finalize()?)));
        let (message, rest) = read.map_err(|error| {
            refused(format!("{} bytes are no postcard value of the expected type", bytes.len())).caused_by(error)
        })?;
        if rest.is_empty() {
            return Ok(message);
        }
        Err(refused(format!("{} of {} bytes follow after the value", rest.len(), bytes.len())))
    }
}
