//! The plan of a component as constants, which is how `topology!` puts it into a program.

mod plan;

use std::time::Duration;

pub use scl_plan::{GateKind, GateOptions, ParameterPlan, Undecodable, WhenFull};

/// A component: its name and its gates.
#[derive(Debug)]
pub struct ComponentSpec {
    /// The system's name, the default of `$SCL_SYSTEM`.
    pub system: &'static str,
    /// The component's name, as in the file.
    pub name: &'static str,
    /// Where it is declared: `topology.yaml:4:11`.
    pub declared_at: &'static str,
    /// Its parameters, in file order.
    pub parameters: &'static [ParameterPlan],
    /// Its gates, in file order.
    pub gates: &'static [GateSpec],
    /// The messages it uses, if the topology names `schemas`.
    pub schema: Option<Schema>,
}

/// A kind of components, in a program that may be any of them.
#[derive(Debug)]
pub struct KindSpec {
    /// The kind's name, as in the file.
    pub name: &'static str,
    /// Its components, in file order: their names, and their plans as JSON, without their messages.
    pub components: &'static [(&'static str, &'static str)],
}

/// The protobuf messages that a component uses.
#[derive(Debug, Clone, Copy)]
pub struct Schema {
    /// A hash of `descriptors`: the name of the file `<hash>.schema` in the system's folder.
    pub hash: &'static str,
    /// A serialized `google.protobuf.FileDescriptorSet`.
    pub descriptors: &'static [u8],
}

/// A gate: what it carries, how, and between which gates.
#[derive(Debug)]
pub struct GateSpec {
    /// The gate's name, as in the file.
    pub name: &'static str,
    /// What the gate does.
    pub kind: GateKind,
    /// The type as in the file, `rover.Command -> rover.Status`, or `bytes`.
    pub payload: &'static str,
    /// The codec as in the file.
    pub codec: &'static str,
    /// Where it is declared: `topology.yaml:6:9`.
    pub declared_at: &'static str,
    /// The endpoint that the gate as a whole listens at (`rep` and `pull`), else empty.
    pub endpoint: &'static str,
    /// The endpoint where tools observe the gate (`pub`, `rep` and `pull`), else empty.
    pub tap: &'static str,
    /// A short hash of pattern, type and codec.
    pub contract: &'static str,
    /// The options, defaults filled in.
    pub options: GateOptions,
    /// The gate's connections, in file order.
    pub connections: &'static [ConnectionSpec],
}

impl GateSpec {
    /// Returns the types of the messages that the gate sends, and that it receives.
    #[cfg(feature = "protobuf")]
    pub(crate) fn sent_and_received(&self) -> (Option<&'static str>, Option<&'static str>) {
        match (self.kind, self.exchanged()) {
            (GateKind::Pub | GateKind::Push, _) => (Some(self.payload), None),
            (GateKind::Sub | GateKind::Pull, _) => (None, Some(self.payload)),
            (GateKind::Req, Some((request, reply))) => (Some(request), Some(reply)),
            (GateKind::Rep, Some((request, reply))) => (Some(reply), Some(request)),
            (GateKind::Req | GateKind::Rep, None) => (None, None),
        }
    }

    /// Returns the types of requests and replies, if the gate exchanges them.
    pub(crate) fn exchanged(&self) -> Option<(&'static str, &'static str)> {
        self.payload.split_once(" -> ").filter(|_| self.kind.exchanges())
    }

    /// Returns true if a receiving gate wants only the newest message.
    pub(crate) fn newest_only(&self) -> bool {
        self.options.queue == 1 && self.options.when_full == WhenFull::DropOldest
    }
}

/// One connection, seen from one of its gates.
#[derive(Debug)]
pub struct ConnectionSpec {
    /// The component at the other end.
    pub peer_component: &'static str,
    /// The gate at the other end.
    pub peer_gate: &'static str,
    /// The name of the connection's socket inside the system's folder, contract included.
    pub endpoint: &'static str,
    /// A short hash of pattern, type and codec: two ends that differ in it never talk.
    pub contract: &'static str,
    /// Whether `ready` waits for this peer: false for an `optional` component.
    pub required: bool,
    /// The receiving gate's queue, in messages.
    pub queue: u32,
    /// What happens to messages when that queue is full.
    pub when_full: WhenFull,
    /// The longest message that the peer accepts from this gate, in bytes.
    pub max_size: u64,
    /// How old a message may be when the receiving gate's program receives it. If it is given, the sender says when it
    /// has sent each.
    pub max_age: Option<Duration>,
}
