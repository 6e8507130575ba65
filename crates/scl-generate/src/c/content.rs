//! The content that the functions of a gate pass: structs of protobuf-c, or bytes.

use super::protobuf_c;
use crate::system::{Gate, MessageUse};
use scl_plan::Payload;

/// What is passed in one direction of a gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    /// A message of `schemas:` in protobuf.
    Struct {
        /// `Rover__Measurement`.
        name: String,
        /// The prefix of its functions: `rover__measurement`.
        prefix: String,
    },
    /// Bytes that the program encodes and decodes.
    Bytes,
}

impl Content {
    /// How a message that the gate carries is passed.
    pub(super) fn of(gate: &Gate, message: &MessageUse) -> Self {
        if gate.plan.codec != "protobuf" || !message.in_schemas {
            return Content::Bytes;
        }
        let prefix = protobuf_c::function_prefix(&message.dotted);
        Content::Struct { name: protobuf_c::type_name(&message.dotted), prefix }
    }

    /// The message or request of a gate, and its reply.
    pub(super) fn both(gate: &Gate) -> [Self; 2] {
        [0, 1].map(|index| gate.types.get(index).map_or(Content::Bytes, |message| Content::of(gate, message)))
    }

    pub(super) fn is_struct(&self) -> bool {
        matches!(self, Content::Struct { .. })
    }
}

/// Describes in a comment what a gate carries and how: `rover.Command -> rover.Status in protobuf`.
pub(super) fn described(gate: &Gate) -> String {
    let (payload, codec) = (&gate.plan.payload, &gate.plan.codec);
    if *payload == Payload::Bytes {
        return "bytes without a type".to_owned();
    }
    let has_bytes = gate.types.iter().any(|message| !Content::of(gate, message).is_struct());
    let rest = if has_bytes { "; the program encodes and decodes" } else { "" };
    format!("{payload} in {codec}{rest}")
}
