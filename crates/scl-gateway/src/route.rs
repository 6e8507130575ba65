//! The connections that cross hosts, computed from the plan of the system and the hosts of the launch file.
//!
//! Every host computes them on its own, and all must get the same result, so no route depends on the host that computes
//! it.

use crate::deployment::Deployment;
use scl_plan::{ConnectionPlan, GateKind, GatePlan, Plan, SystemPlan};

/// A path from one host to another. For `pub` and `sub` it is one connection; for `pull` and `rep`, whose socket serves
/// many peers, it carries everything that one host sends to that gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Route {
    /// Whether the route carries messages or requests.
    pub pattern: Pattern,
    /// Where messages or requests come from.
    pub from: RouteEnd,
    /// The `sub`, `pull` or `rep` gate.
    pub to: RouteEnd,
    /// The name of the socket, in the folder of the system on either host.
    pub endpoint: String,
    /// The receiving gate's queue, in messages.
    pub queue: u32,
    /// Whether a sender waits for slow receivers instead of dropping messages.
    pub lossless: bool,
    /// Whether the publisher keeps its last message for subscribers that join.
    pub latched: bool,
    /// The longest message that an end of the route accepts, in bytes; for requests, the longest request or reply.
    pub max_size: u64,
    /// The zenoh key: `scl/<system>/<component>/<gate>/<component>/<gate>/<contract>`, and for `pull` and `rep` with
    /// `host:<name>/push` or `host:<name>/req` as the sender.
    pub key: String,
}

/// What a route carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// Messages in one direction.
    Messages {
        /// Whether the sending gate listens (`pub`) or the receiving one (`pull`).
        listens_at_sender: bool,
    },
    /// Requests and their replies.
    Requests,
}

/// One end of a route.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RouteEnd {
    /// The host.
    pub host: String,
    /// The component; `None` if any component of the host may connect there.
    pub component: Option<String>,
    /// The component's gate; `None` if `component` is.
    pub gate: Option<String>,
}

/// The routes that begin or end at a host, in the order of the topology file.
///
/// A component that is on no host has none.
pub fn routes(system: &SystemPlan, deployment: &Deployment, host: &str) -> Vec<Route> {
    let mut routes = Vec::new();
    for plan in &system.components {
        let Some(from) = deployment.host_of(&plan.component) else { continue };
        for gate in plan.gates.iter().filter(|gate| gate.kind.is_source()) {
            for connection in &gate.connections {
                let Some(to) = deployment.host_of(&connection.peer_component) else { continue };
                if from.name != to.name && [&from.name, &to.name].contains(&&host.to_owned()) {
                    add(&mut routes, route(system, (&from.name, plan), (&to.name, gate), connection));
                }
            }
        }
    }
    routes
}

/// Adds a route. If another component of the same host has it already, only raises its `max_size` as needed.
fn add(routes: &mut Vec<Route>, route: Route) {
    match routes.iter_mut().find(|known| known.key == route.key) {
        // The rest depends only on the receiving gate, even `lossless`: a gate may make its senders wait only if all of
        // them allow it.
        Some(known) => known.max_size = known.max_size.max(route.max_size),
        None => routes.push(route),
    }
}

fn route(
    system: &SystemPlan,
    (from_host, plan): (&str, &Plan),
    (to_host, gate): (&str, &GatePlan),
    connection: &ConnectionPlan,
) -> Route {
    let ConnectionPlan { peer_component, peer_gate, endpoint, contract, queue, when_full, .. } = connection;
    let pattern = match gate.kind {
        GateKind::Req | GateKind::Rep => Pattern::Requests,
        kind => Pattern::Messages { listens_at_sender: kind.listens() },
    };
    let is_alone = pattern == Pattern::Messages { listens_at_sender: true };
    let sender = match is_alone {
        true => format!("{}/{}", plan.component, gate.name),
        // Component names contain no colon, so this cannot be the name of another sender.
        false => format!("host:{from_host}/{}", gate.kind.word()),
    };
    let replies = if pattern == Pattern::Requests { gate.options.max_size } else { 0 };
    Route {
        pattern,
        from: RouteEnd {
            host: from_host.to_owned(),
            component: is_alone.then(|| plan.component.clone()),
            gate: is_alone.then(|| gate.name.clone()),
        },
        to: RouteEnd {
            host: to_host.to_owned(),
            component: Some(peer_component.clone()),
            gate: Some(peer_gate.clone()),
        },
        endpoint: endpoint.clone(),
        queue: *queue,
        lossless: gate.options.waits_for(*when_full),
        latched: gate.options.latched,
        max_size: connection.max_size.max(replies),
        key: format!("scl/{}/{sender}/{peer_component}/{peer_gate}/{contract}", system.system),
    }
}

#[cfg(test)]
mod tests;
