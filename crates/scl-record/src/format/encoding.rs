//! How a gate's codec and type become MCAP's message encoding and schema.

use std::borrow::Cow;

/// Message encoding and schema of a channel. The schema is always a separate record, never MCAP's id 0 for "none":
/// several readers reject that for encodings that need a schema, and the name of the type would be lost.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Encoding<'a> {
    /// MCAP's message encoding: the codec's word (`protobuf`), or the path of a user-defined codec; `raw` for bytes.
    pub message: Cow<'a, str>,
    /// Name of the schema: the type as in the topology file, or `bytes`.
    pub schema_name: &'a str,
    /// `protobuf`, `jsonschema`, or empty if there is no schema that other programs understand.
    pub schema_encoding: &'static str,
    /// For `protobuf` a serialized `FileDescriptorSet`, for `jsonschema` a JSON Schema.
    pub schema: Cow<'a, [u8]>,
}

impl<'a> Encoding<'a> {
    /// The encoding of one codec and type; `descriptors` is the serialized `FileDescriptorSet` of the component's
    /// messages.
    pub fn new(codec: &'a str, type_name: Option<&'a str>, descriptors: Option<&'a [u8]>) -> Self {
        let Some(schema_name) = type_name else {
            // Gates without a message type carry raw bytes, whatever codec the system's other gates use.
            return Self { message: "raw".into(), schema_name: "bytes", schema_encoding: "", schema: [][..].into() };
        };
        let (schema_encoding, schema) = match (codec, descriptors) {
            ("protobuf", Some(descriptors)) => ("protobuf", descriptors),
            // Readers of JSON messages require a schema; one that allows any object is enough.
            ("json", _) => ("jsonschema", ANY_OBJECT),
            _ => ("", &[][..]),
        };
        Self { message: codec.into(), schema_name, schema_encoding, schema: schema.into() }
    }
}

const ANY_OBJECT: &[u8] = br#"{"type":"object"}"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_schemas_that_others_understand_are_named() {
        let cases = [
            ("protobuf", Some(&b"set"[..]), "protobuf", &b"set"[..]),
            ("protobuf", None, "", b""),
            ("json", Some(b"set"), "jsonschema", ANY_OBJECT),
            ("cbor", None, "", b""),
            ("my_crate::Flat", Some(b"set"), "", b""),
        ];
        for (codec, descriptors, schema_encoding, schema) in cases {
            let encoding = Encoding::new(codec, Some("rover.Measurement"), descriptors);
            assert_eq!((encoding.schema_encoding, &*encoding.schema), (schema_encoding, schema), "{codec}");
            assert_eq!((&*encoding.message, encoding.schema_name), (codec, "rover.Measurement"));
        }
        let bytes = Encoding::new("protobuf", None, Some(b"set"));
        assert_eq!((&*bytes.message, bytes.schema_name, bytes.schema_encoding), ("raw", "bytes", ""));
    }
}
