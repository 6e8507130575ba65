//! The channels of panels.

use foxglove::{ChannelBuilder, Context, FoxgloveError, PartialMetadata, RawChannel, Schema};
use scl::bytes::Bytes;
use scl_record::format::Encoding;
use scl_value::{MessageType, to_json};
use std::sync::Arc;

/// A schema that any message in JSON fits.
const ANY_OBJECT: &[u8] = br#"{"type":"object"}"#;

/// What the messages of a topic are.
pub(crate) struct Messages<'s> {
    pub(crate) codec: &'s str,
    pub(crate) type_name: Option<&'s str>,
    /// A serialized `FileDescriptorSet`.
    pub(crate) descriptors: Option<&'s [u8]>,
}

/// A message.
#[derive(Debug, Clone)]
pub(crate) struct Sent {
    pub(crate) payload: Bytes,
    /// When it was sent, in nanoseconds since 1970.
    pub(crate) time: u64,
}

/// A channel, and how its messages get there.
pub(crate) struct Channel {
    channel: Arc<RawChannel>,
    /// Set for codecs that panels do not understand, whose messages are sent as JSON.
    translated: Option<MessageType>,
}

impl Channel {
    /// Makes a channel of a topic with these messages.
    ///
    /// # Errors
    /// The library refuses it.
    pub(crate) fn new(context: &Arc<Context>, topic: &str, messages: &Messages<'_>) -> Result<Self, FoxgloveError> {
        let Messages { codec, type_name, descriptors } = *messages;
        let is_translated = matches!(codec, "cbor" | "msgpack") && type_name.is_some();
        let encoding = Encoding::new(if is_translated { "json" } else { codec }, type_name, descriptors);
        let schema = Schema::new(encoding.schema_name, encoding.schema_encoding, encoding.schema.to_vec());
        let builder = ChannelBuilder::new(topic).context(context).message_encoding(encoding.message.as_ref());
        let translated = is_translated.then(|| MessageType::new(type_name, codec, descriptors).ok()).flatten();
        Ok(Self { channel: builder.schema(schema).build_raw()?, translated })
    }

    /// Makes a channel of a topic, whose messages are protobuf with this schema.
    ///
    /// # Errors
    /// The library refuses it.
    pub(crate) fn of_schema(context: &Arc<Context>, topic: &str, schema: Schema) -> Result<Self, FoxgloveError> {
        let builder = ChannelBuilder::new(topic).context(context).message_encoding("protobuf").schema(schema);
        Ok(Self { channel: builder.build_raw()?, translated: None })
    }

    /// Whether a panel shows it.
    pub(crate) fn is_shown(&self) -> bool {
        self.channel.has_sinks()
    }

    pub(crate) fn send(&self, sent: &Sent) {
        let time = PartialMetadata::with_log_time(sent.time);
        match &self.translated {
            Some(messages) => {
                let text = to_json(&messages.for_json(messages.show(&sent.payload)));
                self.channel.log_with_meta(text.as_bytes(), time);
            }
            None => self.channel.log_with_meta(&sent.payload, time),
        }
    }

    pub(crate) fn close(&self) {
        self.channel.close();
    }
}

/// The schema of messages that panels write as JSON.
pub(crate) fn any_object(name: &str) -> Schema {
    Schema::new(name, "jsonschema", ANY_OBJECT)
}
