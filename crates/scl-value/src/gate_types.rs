//! The types of a gate.

use crate::MessageType;

/// The types of a gate: of its messages or requests, and of its replies.
#[derive(Debug, Clone)]
pub struct GateTypes {
    /// The messages or requests.
    pub message: MessageType,
    /// The replies; without any, the same as the messages.
    pub reply: MessageType,
}

impl GateTypes {
    /// The types by the names in a gate's payload. What cannot be read is shown as bytes, with the reason.
    pub fn new<'t>(mut names: impl Iterator<Item = &'t str>, codec: &str, descriptors: Option<&[u8]>) -> Self {
        let read = |name: Option<&str>| {
            MessageType::new(name, codec, descriptors).unwrap_or_else(|error| MessageType::opaque(error.to_string()))
        };
        let first = names.next();
        Self { message: read(first), reply: read(names.next().or(first)) }
    }

    /// The type of a reply, or of anything else.
    pub fn of(&self, is_reply: bool) -> &MessageType {
        if is_reply { &self.reply } else { &self.message }
    }
}
