//! Who can send to a gate with several peers, as an enum.

use scl_topology::rust_name::gate_field;
use scl_topology::senders::{self, Peer};
use scl_topology::topology::{ComponentId, GateId, Topology};

/// The enum of the gates that can send to a `sub` gate.
#[derive(Debug, Clone)]
pub struct Senders {
    /// The kind whose enum it is; `None` for an enum of the gate's own.
    pub kind: Option<String>,
    /// The name of the gate's own enum, in `CamelCase`: `ControllerStatesSender`.
    pub class_name: String,
    /// The values, of a kind in the order of its components.
    pub values: Vec<SenderValue>,
}

/// A value of such an enum.
#[derive(Debug, Clone)]
pub struct SenderValue {
    /// The name in `CamelCase`: different for all values.
    pub class_name: String,
    /// The name in `snake_case`. It may be the same for two values.
    pub snake_name: String,
    /// The gate, as `component.gate`; `None` for a component of a kind that does not send.
    pub path: Option<String>,
}

impl Senders {
    /// The senders of a gate; `None` if there is nobody to tell apart.
    pub(super) fn of(topology: &Topology, gate: GateId) -> Option<Self> {
        let of = topology.gate(gate);
        let class_name = senders::enum_name(topology.type_of(of.component()).name(), of.name());
        Some(match topology.senders(gate)? {
            senders::Senders::OfKind(name) => {
                let peers = topology.peers_of_type(gate);
                let gate_of = |component: ComponentId| {
                    let gate = peers.iter().find(|peer| topology.gate(**peer).component() == component);
                    gate.map(|gate| topology.gate_path(*gate))
                };
                let kind = topology.kinds().find(|(_, kind)| kind.name() == name)?.1;
                let values = kind.components().iter().map(|&id| SenderValue {
                    class_name: topology.component(id).rust_name().to_owned(),
                    snake_name: gate_field(topology.component(id).name()),
                    path: gate_of(id),
                });
                Self { kind: Some(name.to_owned()), class_name, values: values.collect() }
            }
            senders::Senders::Own { variants, .. } => {
                let is_alone =
                    |peer: &Peer<'_>| variants.iter().filter(|(_, it)| it.component == peer.component).count() == 1;
                let values = variants.iter().map(|(variant, peer)| SenderValue {
                    class_name: variant.clone(),
                    snake_name: match is_alone(peer) {
                        true => gate_field(peer.component),
                        false => format!("{}_{}", gate_field(peer.component), gate_field(peer.gate)),
                    },
                    path: Some(format!("{}.{}", peer.component, peer.gate)),
                });
                Self { kind: None, class_name, values: values.collect() }
            }
        })
    }
}
