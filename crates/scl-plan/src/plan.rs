//! The values of a plan.

use crate::kind::{GateKind, WhenFull};
use crate::options::GateOptions;
use crate::parameter::ParameterPlan;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// Everything a program needs to run one component.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct Plan {
    /// The system's name.
    #[cfg_attr(feature = "json", serde(skip))]
    pub system: String,
    /// The component's name, as in the topology file.
    #[cfg_attr(feature = "json", serde(rename = "name"))]
    pub component: String,
    /// Where it is declared: `topology.yaml:4:11`.
    pub declared_at: String,
    /// The protobuf messages of its gates, if the topology names `schemas`.
    pub schema: Option<Schema>,
    /// Its parameters, in the order of the topology file.
    #[cfg_attr(feature = "json", serde(skip_serializing_if = "Vec::is_empty"))]
    pub parameters: Vec<ParameterPlan>,
    /// Its gates, in the order of the topology file.
    pub gates: Vec<GatePlan>,
}

impl Plan {
    /// The parameter with this name.
    pub fn parameter(&self, name: &str) -> Option<&ParameterPlan> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// The gate with this name.
    pub fn gate(&self, name: &str) -> Option<&GatePlan> {
        self.gates.iter().find(|gate| gate.name == name)
    }
}

/// A gate: what it carries, how, and between which gates.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct GatePlan {
    /// The gate's name, as in the topology file.
    pub name: String,
    /// What it does.
    pub kind: GateKind,
    /// What it carries.
    pub payload: Payload,
    /// The codec: a word such as `protobuf`, or the Rust path of a codec of the user's own.
    pub codec: String,
    /// Where it is declared: `topology.yaml:6:9`.
    pub declared_at: String,
    /// The endpoint at which the gate listens for all its peers; only `rep` and `pull` gates have one.
    pub endpoint: Option<String>,
    /// The endpoint at which tools observe the gate; only `pub`, `rep` and `pull` gates have one.
    pub tap: Option<String>,
    /// A short hash of pattern, types and codec.
    pub contract: String,
    /// The options, defaults filled in.
    #[cfg_attr(feature = "json", serde(flatten))]
    pub options: GateOptions,
    /// The gate's connections, in the order of the topology file. A `req` gate has at most one.
    pub connections: Vec<ConnectionPlan>,
}

/// One connection, seen from one of its gates.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct ConnectionPlan {
    /// The component at the other end.
    pub peer_component: String,
    /// The gate at the other end.
    pub peer_gate: String,
    /// The name of the connection's socket inside the folder of the system, contract included.
    pub endpoint: String,
    /// A short hash of pattern, types and codec: two ends that differ in it never talk.
    pub contract: String,
    /// Whether `ready` waits for this peer: false for an `optional` component.
    pub required: bool,
    /// The receiving gate's queue, in messages.
    pub queue: u32,
    /// What happens when the queue is full.
    pub when_full: WhenFull,
    /// The longest message that the peer accepts from this gate, in bytes. For a gate that only receives, its own
    /// limit.
    pub max_size: u64,
    /// How old a message may be when the receiving gate's program receives it. If it is given, the sender says when it
    /// has sent each.
    #[cfg_attr(
        feature = "json",
        serde(
            rename = "max_age_ns",
            skip_serializing_if = "Option::is_none",
            serialize_with = "crate::nanoseconds::of_interval"
        )
    )]
    pub max_age: Option<Duration>,
}

/// What a gate carries.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "json", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Payload {
    /// Messages of one type, of `pub`, `sub`, `push` and `pull`, as in the topology file: `rover.Measurement`.
    Message(String),
    /// Bytes of no declared type, in both directions.
    #[cfg_attr(feature = "json", serde(untagged))]
    Bytes,
    /// A request and its reply, of `req` and `rep`.
    #[cfg_attr(feature = "json", serde(untagged))]
    Exchange {
        /// The type of requests.
        request: String,
        /// The type of replies.
        reply: String,
    },
}

impl Payload {
    /// The names of the types: none, one or two.
    pub fn types(&self) -> impl Iterator<Item = &str> {
        let [first, second] = match self {
            Payload::Bytes => [None, None],
            Payload::Message(name) => [Some(name), None],
            Payload::Exchange { request, reply } => [Some(request), Some(reply)],
        };
        first.into_iter().chain(second).map(String::as_str)
    }
}

/// As in the topology file: `rover.Measurement`, `rover.Command -> rover.Status`, or `bytes`.
impl fmt::Display for Payload {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Payload::Bytes => out.write_str("bytes"),
            Payload::Message(name) => out.write_str(name),
            Payload::Exchange { request, reply } => write!(out, "{request} -> {reply}"),
        }
    }
}

/// The protobuf messages of a component's gates: the shapes to which the type names of its payloads refer.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Schema {
    /// A hash of `descriptors`.
    pub hash: String,
    /// A serialized `google.protobuf.FileDescriptorSet`. Components with the same messages share it.
    pub descriptors: Arc<[u8]>,
}
