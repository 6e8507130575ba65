//! The connections of a system, and their names.

use scl_plan::{ConnectionPlan, GatePlan, SystemPlan};

/// A connection, seen from its sending gate.
pub(super) struct Connection<'p> {
    pub(super) component: &'p str,
    pub(super) gate: &'p GatePlan,
    pub(super) plan: &'p ConnectionPlan,
}

impl Connection<'_> {
    /// Returns a unique name: two gates are connected at most once.
    pub(super) fn name(&self) -> String {
        connection_name(self.component, self.gate, self.plan)
    }

    /// The components at both ends, the sending one first.
    pub(super) fn components(&self) -> (String, String) {
        (self.component.to_owned(), self.plan.peer_component.clone())
    }
}

/// All connections, in the order of their sending gates.
pub(super) fn connections_of(plan: &SystemPlan) -> impl Iterator<Item = Connection<'_>> {
    let gates = plan.components.iter().flat_map(|it| it.gates.iter().map(|gate| (it.component.as_str(), gate)));
    let sending = gates.filter(|(_, gate)| gate.kind.is_source());
    sending.flat_map(|(component, gate)| gate.connections.iter().map(move |plan| Connection { component, gate, plan }))
}

/// Returns the name of a connection, from the gate that sends or asks to its peer:
/// `sensor.measurements -> controller.sensor`.
pub(super) fn connection_name(component: &str, gate: &GatePlan, connection: &ConnectionPlan) -> String {
    let own = format!("{component}.{}", gate.name);
    let peer = format!("{}.{}", connection.peer_component, connection.peer_gate);
    if gate.kind.is_source() { format!("{own} -> {peer}") } else { format!("{peer} -> {own}") }
}
