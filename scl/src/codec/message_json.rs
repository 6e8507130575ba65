//! Canonical protobuf JSON, for the messages of `schemas:`.
//!
//! Messages convert through their protobuf encoding and a description of their type, so that they need no code per
//! field, and well-known types, `NaN`, unknown enum values and presence are as in every other implementation
//! (<https://protobuf.dev/programming-guides/json>).

use super::enum_names;
use prost::Message;
use prost_reflect::{DescriptorPool, DeserializeOptions, DynamicMessage, MessageDescriptor, SerializeOptions};
use serde::de::{Deserializer, Error as _};
use serde::ser::{Error as _, Serializer};
use std::sync::OnceLock;

/// The types of a topology's schemas.
#[derive(Debug)]
pub struct MessagePool {
    descriptors: &'static [u8],
    decoded: OnceLock<Result<DescriptorPool, String>>,
}

impl MessagePool {
    /// Types described by a serialized `google.protobuf.FileDescriptorSet`.
    pub const fn new(descriptors: &'static [u8]) -> Self {
        Self { descriptors, decoded: OnceLock::new() }
    }

    fn find(&self, name: &str) -> Result<MessageDescriptor, String> {
        let decode = || DescriptorPool::decode(self.descriptors).map_err(|error| error.to_string());
        let pool = self.decoded.get_or_init(decode).as_ref().map_err(String::clone)?;
        pool.get_message_by_name(name).ok_or_else(|| format!("the schemas do not declare `{name}`"))
    }
}

/// One type of a pool, looked up once.
#[derive(Debug)]
pub struct MessageType {
    pool: &'static MessagePool,
    name: &'static str,
    found: OnceLock<Result<MessageDescriptor, String>>,
}

impl MessageType {
    /// The type with this full name.
    pub const fn new(pool: &'static MessagePool, name: &'static str) -> Self {
        Self { pool, name, found: OnceLock::new() }
    }

    /// Serializes a message of this type.
    pub fn serialize<S: Serializer>(&self, message: &impl Message, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes = message.encode_to_vec();
        let described = DynamicMessage::decode(self.descriptor().map_err(S::Error::custom)?, bytes.as_slice());
        let described = described.map_err(S::Error::custom)?;
        // Fields with default values are skipped, and -0.0 would count as a default. If the message contains one, write
        // out all fields; the meaning is the same.
        let options = SerializeOptions::new().skip_default_fields(!scl_shape::loses_sign(&described));
        described.serialize_with_options(serializer, &options)
    }

    /// Deserializes a message of this type. Unknown fields are skipped, as in every other codec: a newer program may
    /// send them. Unknown names of enum values are refused, because skipping them would change what the message says.
    pub fn deserialize<'de, M: Message + Default, D: Deserializer<'de>>(&self, deserializer: D) -> Result<M, D::Error> {
        let options = DeserializeOptions::new().deny_unknown_fields(false);
        let descriptor = self.descriptor().map_err(D::Error::custom)?;
        let deserializer = enum_names::checked(&descriptor, deserializer);
        let described = DynamicMessage::deserialize_with_options(descriptor, deserializer, &options)?;
        M::decode(scl_shape::encode(&described).as_slice()).map_err(D::Error::custom)
    }

    fn descriptor(&self) -> Result<MessageDescriptor, String> {
        self.found.get_or_init(|| self.pool.find(self.name)).clone()
    }
}
