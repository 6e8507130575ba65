//! XML, which SCL does not support; the paper compares with it.

use super::record::Record;
use scl::bytes::{Bytes, BytesMut};
use scl::codec::{Codec, DecodeError, EncodeError};

const NAME: &str = "xml";

pub(super) struct Xml;

impl Codec<Record> for Xml {
    const NAME: &'static str = NAME;

    fn encode(message: &Record, into: &mut BytesMut) -> Result<(), EncodeError> {
        let text = quick_xml::se::to_string(message);
        let text = text.map_err(|error| EncodeError::new(NAME, "it cannot be written as xml").caused_by(error))?;
        into.extend_from_slice(text.as_bytes());
        Ok(())
    }

    fn decode(bytes: Bytes) -> Result<Record, DecodeError> {
        quick_xml::de::from_reader(&bytes[..])
            .map_err(|error| DecodeError::new(NAME, "the bytes are not a record in xml").caused_by(error))
    }
}
