//! How the bytes of one type in one codec are read and written.

#[cfg(test)]
mod tests;

use crate::error::{DecodeError, Mismatch, TypeError};
use crate::field_kind::FieldKind;
use crate::path::FieldPath;
use crate::protobuf::{self, Unknown};
use crate::self_describing::{read_cbor, read_json, read_msgpack, write_cbor, write_msgpack};
use crate::text;
use crate::value::{Opaque, Value, canonical, key_text, to_json};
use bytes::Bytes;
use prost_reflect::{DescriptorPool, MessageDescriptor, SerializeOptions};

/// A type of messages in a codec.
#[derive(Debug, Clone)]
pub struct MessageType {
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Protobuf(MessageDescriptor),
    // Canonical protobuf JSON.
    ProtobufJson(MessageDescriptor),
    Json,
    Cbor,
    Msgpack,
    Opaque { why: String },
}

impl MessageType {
    /// The messages of a type in a codec, both named as in a plan. `descriptors` is a serialized
    /// `google.protobuf.FileDescriptorSet`.
    ///
    /// The messages of a codec that cannot be read without the program's own type are opaque: they are shown as bytes.
    ///
    /// # Errors
    /// The codec is `protobuf`, and the descriptors are missing, cannot be read or do not contain the type.
    pub fn new(type_name: Option<&str>, codec: &str, descriptors: Option<&[u8]>) -> Result<Self, TypeError> {
        let described = || described(type_name?, descriptors?).transpose();
        let form = match (codec, type_name) {
            ("protobuf", Some(name)) => match described().transpose()? {
                Some(message) => Form::Protobuf(message),
                None if descriptors.is_some() => return Err(TypeError::Unknown { name: name.to_owned() }),
                None => return Err(TypeError::Undescribed { name: name.to_owned() }),
            },
            ("json", _) => described().transpose()?.map_or(Form::Json, Form::ProtobufJson),
            ("cbor", _) => Form::Cbor,
            ("msgpack", _) => Form::Msgpack,
            (_, None) => Form::Opaque { why: "the gate carries bytes of no declared type".to_owned() },
            ("raw" | "postcard", Some(name)) => {
                let why = format!("`{codec}` messages can be read with the Rust type `{name}` only");
                Form::Opaque { why }
            }
            (codec, Some(_)) => Form::Opaque { why: format!("the codec `{codec}` is the program's own") },
        };
        Ok(Self { form })
    }

    /// Messages that are shown as bytes, and why.
    pub fn opaque(why: impl Into<String>) -> Self {
        Self { form: Form::Opaque { why: why.into() } }
    }

    /// Returns true if messages are shown as bytes.
    pub fn is_opaque(&self) -> bool {
        matches!(self.form, Form::Opaque { .. })
    }

    /// Returns true if the fields of messages are known before one is decoded.
    pub fn is_described(&self) -> bool {
        self.descriptor().is_some()
    }

    /// Reads a message.
    ///
    /// Fields of protobuf have the names of the `.proto` file; fields without presence are shown with their default.
    /// Timestamps and durations are texts as in protobuf's JSON. Fields that the type does not have are under the key
    /// `@unknown`.
    ///
    /// # Errors
    /// The payload is not a message of the type, is nested deeper than 100 levels or has more than 4 Mi values.
    pub fn decode(&self, bytes: &[u8]) -> Result<Value, DecodeError> {
        let wrong = |expected: &str| {
            let (length, expected) = (bytes.len(), expected.to_owned());
            move |(reason, offset)| DecodeError { length, expected, path: String::new(), offset, reason }
        };
        match &self.form {
            Form::Protobuf(message) => protobuf::decode(message, bytes).map_err(|fault| DecodeError {
                length: bytes.len(),
                expected: format!("a protobuf message `{}`", message.full_name()),
                path: fault.path,
                offset: Some(fault.offset),
                reason: fault.reason,
            }),
            Form::ProtobufJson(message) => {
                let expected = format!("the JSON of a message `{}`", message.full_name());
                let json = read_json(bytes).map_err(wrong(&expected))?;
                protobuf::from_json(message, &json)
                    .map_err(|error| DecodeError { path: error.path.clone(), ..wrong(&expected)((error.reason, None)) })
            }
            Form::Json => read_json(bytes).map_err(wrong("a JSON value")),
            Form::Cbor => read_cbor(bytes).map_err(wrong("a CBOR item")),
            Form::Msgpack => read_msgpack(bytes).map_err(wrong("a MessagePack value")),
            Form::Opaque { why } => Ok(Value::Opaque(Opaque::new(bytes, why))),
        }
    }

    /// Like [`decode`](Self::decode), but returns the bytes and the reason instead of an error.
    pub fn show(&self, bytes: &[u8]) -> Value {
        self.decode(bytes).unwrap_or_else(|error| Value::Opaque(Opaque::new(bytes, error.to_string())))
    }

    /// Returns a decoded message as it is printed in JSON. If the type is described, whole numbers beyond 2^53 become
    /// texts, as in protobuf's JSON, and [`encode`](Self::encode) takes them back; other messages are unchanged,
    /// because in them they would stay texts.
    pub fn for_json(&self, value: Value) -> Value {
        if self.is_described() { value.with_large_numbers_as_texts() } else { value }
    }

    /// Returns bytes that are equal for messages with the same meaning, whatever the order of their fields and maps;
    /// the payload itself if it cannot be decoded.
    pub fn canonical(&self, payload: &[u8]) -> Bytes {
        let value = self.decode(payload).ok().filter(|value| !matches!(value, Value::Opaque(_)));
        let written = value.and_then(|value| write_msgpack(&canonical(&value)).ok());
        written.unwrap_or_else(|| Bytes::copy_from_slice(payload))
    }

    /// Writes a message.
    ///
    /// It accepts everything that `decode` returns, and what protobuf's JSON accepts: names in lowerCamelCase, numbers
    /// as texts, bytes in base64, enum values by name or number. Opaque messages are written from bytes, `{hex: 01ff}`
    /// or `{text: hello}`.
    ///
    /// # Errors
    /// The value is not one of the type: the error names the field and what is expected there.
    pub fn encode(&self, value: &Value) -> Result<Bytes, Mismatch> {
        match &self.form {
            Form::Protobuf(message) => {
                Ok(scl_shape::encode(&protobuf::from_value(message, value, &mut Unknown::Refuse)?).into())
            }
            Form::ProtobufJson(message) => {
                let message = protobuf::from_value(message, value, &mut Unknown::Refuse)?;
                // The serializer would skip -0.0 as a default value and lose its sign. Then write all default values,
                // which means the same.
                let options = SerializeOptions::new().skip_default_fields(!scl_shape::loses_sign(&message));
                let mut json = Vec::new();
                message
                    .serialize_with_options(&mut serde_json::Serializer::new(&mut json), &options)
                    .map_err(|error| Mismatch::new(error.to_string()))?;
                Ok(json.into())
            }
            Form::Json => exact(value).map(|()| to_json(value).into()),
            Form::Cbor => exact(value).and_then(|()| write_cbor(value)),
            Form::Msgpack => exact(value).and_then(|()| write_msgpack(value)),
            Form::Opaque { why } => text::opaque_bytes(value).map(Bytes::from).map_err(|error| error.note(why)),
        }
    }

    /// An example message with all fields; `None` if the type is not known. It can be encoded: of a `oneof`, it has the
    /// first field.
    pub fn template(&self) -> Option<Value> {
        Some(protobuf::template(self.descriptor()?))
    }

    /// The paths of all fields that are not messages themselves, as columns of a table; `None` if the type is not
    /// known.
    pub fn columns(&self) -> Option<Vec<FieldPath>> {
        Some(protobuf::columns(self.descriptor()?))
    }

    /// Checks that a message may have a field. If the type is not known, every field may exist.
    ///
    /// # Errors
    /// The type has no such field; the error lists its fields.
    pub fn check_field(&self, path: &FieldPath) -> Result<(), Mismatch> {
        self.kind_of(path).map(drop)
    }

    /// Returns what kind of value is at a path.
    pub(crate) fn kind_of(&self, path: &FieldPath) -> Result<FieldKind, Mismatch> {
        self.descriptor().map_or(Ok(FieldKind::Unknown), |message| protobuf::kind_of(message, path))
    }

    fn descriptor(&self) -> Option<&MessageDescriptor> {
        match &self.form {
            Form::Protobuf(message) | Form::ProtobufJson(message) => Some(message),
            Form::Json | Form::Cbor | Form::Msgpack | Form::Opaque { .. } => None,
        }
    }
}

/// Refuses whole numbers that were read as floats because they have more than 64 bits.
fn exact(value: &Value) -> Result<(), Mismatch> {
    match value {
        Value::Written(written) if matches!(written.meaning, Value::Float(_)) => {
            let text = &written.text;
            let is_whole = text.trim_start_matches(['-', '+']).bytes().all(|byte| byte.is_ascii_digit());
            let error = || Mismatch::new(format!("the number {text} has more than 64 bits"));
            if is_whole {
                Err(error().help(format!("quote it, or write `{text}.0` for the nearest float")))
            } else {
                Ok(())
            }
        }
        Value::List(items) => {
            let mut items = items.iter().enumerate();
            items.try_for_each(|(index, item)| exact(item).map_err(|error| error.below(&format!("[{index}]"))))
        }
        Value::Map(entries) => entries.iter().try_for_each(|(key, value)| {
            let name = key_text(key);
            exact(key).and_then(|()| exact(value)).map_err(|error| error.below(&name))
        }),
        _ => Ok(()),
    }
}

fn described(name: &str, descriptors: &[u8]) -> Result<Option<MessageDescriptor>, TypeError> {
    let pool = DescriptorPool::decode(descriptors).map_err(|error| TypeError::Schema { reason: error.to_string() })?;
    Ok(pool.get_message_by_name(name))
}
