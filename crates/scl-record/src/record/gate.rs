//! A gate's channels, and its messages on their way to the file.

use crate::format::{ChannelMetadata, Encoding, Part, Topic};
use bytes::Bytes;
use scl_observe::ObservedGate;
use scl_plan::GateKind;
use std::collections::BTreeMap;

/// One message, request or reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Message {
    /// Number of the gate.
    pub(crate) gate: usize,
    pub(crate) part: Part,
    /// See [`crate::format::sequence`].
    pub(crate) sequence: u32,
    pub(crate) sent_ns: u64,
    pub(crate) received_ns: u64,
    /// Messages of the same gate that were lost since the one before.
    pub(crate) lost_before: u64,
    /// Whether it was sent before the recorder observed the gate.
    pub(crate) latched: bool,
    pub(crate) payload: Bytes,
}

impl Message {
    /// Memory that it needs while it waits, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.payload.len() + size_of::<Self>()
    }
}

/// The channels of a gate: one, or two for requests and replies.
pub(crate) fn channels(gate: &ObservedGate) -> Vec<NewChannel<'_>> {
    let parts: &[Part] = if gate.kind == GateKind::Rep { &[Part::Request, Part::Reply] } else { &[Part::Message] };
    parts.iter().map(|part| channel(gate, *part)).collect()
}

/// A channel as the file describes it.
pub(crate) struct NewChannel<'a> {
    pub(crate) part: Part,
    pub(crate) topic: String,
    pub(crate) encoding: Encoding<'a>,
    pub(crate) metadata: BTreeMap<String, String>,
}

fn channel(gate: &ObservedGate, part: Part) -> NewChannel<'_> {
    let type_name = part.type_name(&gate.payload);
    let metadata = ChannelMetadata {
        kind: gate.kind,
        type_name: type_name.map(str::to_owned),
        codec: gate.codec.clone(),
        contract: gate.contract.clone(),
        peers: gate.peers.clone(),
    };
    let topic = Topic { component: gate.component.clone(), gate: gate.gate.clone(), part };
    NewChannel {
        part,
        topic: topic.to_string(),
        encoding: Encoding::new(&gate.codec, type_name, gate.schema.as_deref()),
        metadata: metadata.to_map(),
    }
}
