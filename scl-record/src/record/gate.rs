//! A gate that is recorded, and its messages on their way to the file.

use crate::format::{ChannelMetadata, Encoding, Part, Topic};
use bytes::Bytes;
use scl_plan::{GateKind, Payload};
use std::collections::BTreeMap;

/// What the file says about a gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Gate {
    pub(crate) component: String,
    pub(crate) gate: String,
    pub(crate) kind: GateKind,
    pub(crate) payload: Payload,
    pub(crate) codec: String,
    pub(crate) contract: String,
    pub(crate) peers: Vec<String>,
    /// Serialized `FileDescriptorSet`.
    pub(crate) descriptors: Option<Bytes>,
}

/// One message, request or reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Message {
    /// Number of the gate.
    pub(crate) gate: usize,
    pub(crate) part: Part,
    /// As in the file.
    pub(crate) sequence: u32,
    pub(crate) sent_ns: u64,
    pub(crate) received_ns: u64,
    /// Messages of the same gate that were lost since the one before.
    pub(crate) lost_before: u64,
    pub(crate) payload: Bytes,
}

impl Message {
    /// Memory that it needs while it waits, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.payload.len() + size_of::<Self>()
    }
}

impl Gate {
    /// As on the command line: `sensor.measurements`.
    pub(crate) fn name(&self) -> String {
        format!("{}.{}", self.component, self.gate)
    }

    pub(crate) fn topic(&self, part: Part) -> Topic {
        Topic { component: self.component.clone(), gate: self.gate.clone(), part }
    }

    /// The channels of the gate: one, or two for requests and replies.
    pub(crate) fn channels(&self) -> Vec<(Part, Encoding<'_>, BTreeMap<String, String>)> {
        let channel = |part, type_name: Option<&String>| {
            let encoding = Encoding::new(&self.codec, type_name.map(String::as_str), self.descriptors.as_deref());
            let metadata = ChannelMetadata {
                kind: self.kind,
                type_name: type_name.cloned(),
                codec: self.codec.clone(),
                contract: self.contract.clone(),
                peers: self.peers.clone(),
            };
            (part, encoding, metadata.to_map())
        };
        match (&self.payload, self.kind) {
            (Payload::Exchange { request, reply }, _) => {
                vec![channel(Part::Request, Some(request)), channel(Part::Reply, Some(reply))]
            }
            (Payload::Bytes, GateKind::Rep) => vec![channel(Part::Request, None), channel(Part::Reply, None)],
            (Payload::Bytes, _) => vec![channel(Part::Message, None)],
            (Payload::Message(name), _) => vec![channel(Part::Message, Some(name))],
        }
    }
}
