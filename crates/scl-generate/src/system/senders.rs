//! Who can send to a gate with several peers, as an enum.

use scl_topology::rust_name::gate_field;
use scl_topology::senders::{self, Peer};
use scl_topology::topology::{GateId, Topology};

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
        let class_name =
            senders::enum_name(topology.type_of(topology.gate(gate).component()).name(), topology.gate(gate).name());
        let path = |peer: &Peer<'_>| format!("{}.{}", peer.component, peer.gate);
        Some(match topology.senders(gate)? {
            senders::Senders::OfKind(name) => {
                let peers: Vec<String> =
                    topology.peers_of_type(gate).into_iter().map(|it| topology.gate_path(it)).collect();
                let of_component = |component: &str| {
                    peers.iter().find(|path| path.split_once('.').is_some_and(|(of, _)| of == component)).cloned()
                };
                let kind = topology.kinds().find(|(_, kind)| kind.name() == name)?.1;
                let components = kind.components().iter().map(|id| topology.component(*id));
                let values = components.map(|component| SenderValue {
                    class_name: component.rust_name().to_owned(),
                    snake_name: gate_field(component.name()),
                    path: of_component(component.name()),
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
                    path: Some(path(peer)),
                });
                Self { kind: None, class_name, values: values.collect() }
            }
        })
    }
}
