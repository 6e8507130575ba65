//! A gate that can be observed, and the taps where its messages are seen.

use scl::bytes::Bytes;
use scl_plan::{GateKind, GatePlan, Payload};

/// A gate, and where its messages can be seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObservedGate {
    /// The component.
    pub component: String,
    /// The gate.
    pub gate: String,
    /// Its kind.
    pub kind: GateKind,
    /// What it carries.
    pub payload: Payload,
    /// The codec, as in the topology file.
    pub codec: String,
    /// A short hash of pattern, types and codec.
    pub contract: String,
    /// The gates at the other ends of its connections, as `component.gate`.
    pub peers: Vec<String>,
    /// The protobuf messages that its program was built with: a serialized `google.protobuf.FileDescriptorSet`.
    pub schema: Option<Bytes>,
    /// Where its messages are seen: its own tap, or, for a `sub`, `req` or `push` gate, those of its running peers,
    /// where messages of their other peers are seen, too.
    pub taps: Vec<Tap>,
}

/// The tap of a listening gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tap {
    /// The component that listens.
    pub component: String,
    /// Its gate.
    pub gate: String,
    /// The name of the tap's socket, as in plans.
    pub socket: String,
}

impl ObservedGate {
    /// `component.gate`.
    pub fn name(&self) -> String {
        format!("{}.{}", self.component, self.gate)
    }

    /// Creates the gate of a component's plan, observed at these taps.
    pub(crate) fn new(component: &str, plan: &GatePlan, schema: Option<Bytes>, taps: Vec<Tap>) -> Self {
        Self {
            component: component.to_owned(),
            gate: plan.name.clone(),
            kind: plan.kind,
            payload: plan.payload.clone(),
            codec: plan.codec.clone(),
            contract: plan.contract.clone(),
            peers: peer_names(plan).collect(),
            schema,
            taps,
        }
    }

    /// Whether both gates carry the same messages in the same way, so that one can be read like the other.
    pub(crate) fn carries_the_same(&self, other: &Self) -> bool {
        let facts = |gate: &'_ Self| (gate.kind, gate.payload.clone(), gate.codec.clone(), gate.contract.clone());
        facts(self) == facts(other) && self.schema == other.schema && self.taps == other.taps
    }
}

/// The gates at the other ends of a gate's connections.
pub(crate) fn peer_names(plan: &GatePlan) -> impl Iterator<Item = String> {
    plan.connections.iter().map(|connection| format!("{}.{}", connection.peer_component, connection.peer_gate))
}

/// The gate's own tap, if it has one.
pub(crate) fn own_tap(component: &str, plan: &GatePlan) -> Option<Tap> {
    let socket = plan.tap.clone()?;
    Some(Tap { component: component.to_owned(), gate: plan.name.clone(), socket })
}
