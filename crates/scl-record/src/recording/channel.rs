//! A channel of a recording: one gate, or one direction of a `rep` gate.

use crate::format::{ChannelMetadata, Topic};
use bytes::Bytes;
use mcap::records::Channel;
use scl_terminal::escape;
use scl_value::MessageType;

/// What a recording says about the messages of one topic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedChannel {
    pub topic: Topic,
    pub metadata: ChannelMetadata,
    /// How the type is described: `protobuf`, `jsonschema` or empty.
    pub schema_encoding: String,
    /// With `protobuf`, a serialized `FileDescriptorSet`.
    pub schema: Bytes,
}

/// A topic of another program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OtherTopic {
    pub topic: String,
    /// MCAP's message encoding: `cdr`.
    pub encoding: String,
    /// Name of the schema: `sensor_msgs/msg/Imu`; empty if there is none.
    pub schema_name: String,
    /// Why it is not one of SCL's topics: `its metadata has no `kind``.
    pub reason: String,
    /// Messages read so far, which are left out.
    pub messages: u64,
}

impl OtherTopic {
    pub(super) fn new(channel: &Channel, schema_name: &str, reason: String) -> Self {
        let (topic, encoding) = (channel.topic.clone(), channel.message_encoding.clone());
        Self { topic, encoding, schema_name: schema_name.to_owned(), reason, messages: 0 }
    }
}

/// A schema of a file.
#[derive(Debug, Clone, Default)]
pub(super) struct RecordedSchema {
    pub(super) name: String,
    pub(super) encoding: String,
    pub(super) data: Bytes,
}

impl RecordedChannel {
    /// Reads a channel's record.
    ///
    /// # Errors
    /// Why the channel was not recorded by SCL: `its metadata has no `kind``.
    pub(super) fn new(channel: &Channel, schema: RecordedSchema) -> Result<Self, String> {
        let topic = Topic::parse(&channel.topic).ok_or("it is not `/<component>/<gate>`")?;
        let metadata = ChannelMetadata::from_map(&channel.metadata)
            .ok_or_else(|| format!("its metadata has no {}", ChannelMetadata::missing(&channel.metadata)))?;
        Ok(Self { topic, metadata, schema_encoding: schema.encoding, schema: schema.data })
    }

    /// The serialized `FileDescriptorSet` of the messages, if the recording has one.
    pub fn descriptors(&self) -> Option<&[u8]> {
        (self.schema_encoding == "protobuf").then_some(&*self.schema)
    }

    /// Returns the type that decodes its messages; opaque if the recording does not describe them.
    pub fn message_type(&self) -> MessageType {
        let (type_name, codec) = (self.metadata.type_name.as_deref(), &self.metadata.codec);
        MessageType::new(type_name, codec, self.descriptors())
            .unwrap_or_else(|error| MessageType::opaque(error.to_string()))
    }

    /// The type and the codec, for messages: `` `rover.Measurement` (protobuf) ``.
    pub fn type_and_codec(&self) -> String {
        type_and_codec(self.metadata.type_name.as_deref(), &self.metadata.codec)
    }
}

/// A type and its codec, for messages: `` `rover.Measurement` (protobuf) ``.
pub(crate) fn type_and_codec(type_name: Option<&str>, codec: &str) -> String {
    format!("`{}` ({})", escape(type_name.unwrap_or("bytes")), escape(codec))
}
