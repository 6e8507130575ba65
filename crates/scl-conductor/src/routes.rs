//! The connections that do not always carry everything at once.

use crate::faults::{FaultRule, What, Whom};
use crate::random::Between;
use scl_plan::{GateKind, Plan, SystemPlan};
use scl_text::gate_name::split;

/// A connection on which a scenario has an influence.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Route {
    /// The component that connects.
    pub(crate) component: String,
    /// The name of the socket to which it connects.
    pub(crate) endpoint: String,
    /// How long it takes what the component sends to arrive, and what is sent to it.
    pub(crate) delays: [Between; 2],
    /// The gates at both ends, as `component.gate`; of the connecting component, several gates may share a socket.
    ends: Vec<String>,
}

impl Route {
    /// Whether it begins or ends at a component, or at a gate as `component.gate`.
    pub(crate) fn ends_at(&self, target: &str) -> bool {
        self.ends.iter().any(|end| end == target || split(end).is_some_and(|(component, _)| component == target))
    }
}

/// `component.gate`.
pub(crate) fn full_name(component: &str, gate: &str) -> String {
    format!("{component}.{gate}")
}

/// Whether a gate sends something: messages, requests or replies.
pub(crate) fn sends(kind: GateKind) -> bool {
    kind.is_source() || kind.exchanges()
}

/// Returns the connections that carry messages of one of these gates late, or that faults can cut.
pub(crate) fn routes(system: &SystemPlan, delays: &[(String, Between)], faults: &[FaultRule]) -> Vec<Route> {
    if delays.is_empty() && !faults.iter().any(|rule| matches!(rule.what, What::Cut(_))) {
        return Vec::new();
    }
    let mut routes: Vec<Route> = Vec::new();
    for route in system.components.iter().flat_map(|plan| all_of(plan, delays)) {
        match routes.iter_mut().find(|it| it.component == route.component && it.endpoint == route.endpoint) {
            Some(shared) => shared.ends.extend(route.ends),
            None => routes.push(route),
        }
    }
    routes.retain(|route| route.delays != [Between::default(); 2] || faults.iter().any(|rule| may_cut(rule, route)));
    routes
}

/// The connections that a component makes.
fn all_of<'a>(plan: &'a Plan, delays: &'a [(String, Between)]) -> impl Iterator<Item = Route> + 'a {
    let connecting = plan.gates.iter().filter(|gate| !gate.kind.listens());
    connecting.flat_map(move |gate| {
        gate.connections.iter().map(move |connection| {
            let own = full_name(&plan.component, &gate.name);
            let peer = full_name(&connection.peer_component, &connection.peer_gate);
            // What gates that only receive send, such as acknowledgements, is not delayed.
            let delay = |name: &str| delays.iter().find(|(delayed, _)| delayed == name).map(|(_, between)| *between);
            let delays = [delay(&own), delay(&peer)].map(Option::unwrap_or_default);
            let (component, endpoint) = (plan.component.clone(), connection.endpoint.clone());
            Route { component, endpoint, delays, ends: vec![own, peer] }
        })
    })
}

fn may_cut(rule: &FaultRule, route: &Route) -> bool {
    let (Whom::Each(targets) | Whom::Any(targets)) = &rule.whom;
    matches!(rule.what, What::Cut(_)) && targets.iter().any(|target| route.ends_at(target))
}

#[cfg(test)]
impl Route {
    /// A connection between two gates, of which the first one connects.
    pub(crate) fn between(own: &str, peer: &str, delays: [Between; 2]) -> Self {
        let component = split(own).map_or(own, |(component, _)| component).to_owned();
        Self { component, endpoint: peer.to_owned(), delays, ends: vec![own.to_owned(), peer.to_owned()] }
    }
}
