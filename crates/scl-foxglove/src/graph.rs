//! The connections of a system, as panels draw them.

use foxglove::websocket::ConnectionGraph;
use scl_observe::Component;
use scl_plan::{GateKind, GatePlan};
use scl_record::format::{Part, Topic};
use std::collections::BTreeMap;

/// The components that send to each topic, that receive from it, and that answer each service.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Graph {
    published: BTreeMap<String, Vec<String>>,
    subscribed: BTreeMap<String, Vec<String>>,
    services: BTreeMap<String, Vec<String>>,
}

impl Graph {
    /// The graph of the components that run.
    pub(crate) fn of(components: &[Component]) -> Self {
        let mut graph = Self::default();
        for component in components.iter().filter(|component| component.is_running()) {
            for gate in component.gates() {
                graph.add(&component.name, gate);
            }
        }
        graph
    }

    fn add(&mut self, component: &str, gate: &GatePlan) {
        let own = || topic(component, &gate.name);
        let peers = || gate.connections.iter().map(|it| topic(&it.peer_component, &it.peer_gate));
        let (map, topics): (_, Vec<String>) = match gate.kind {
            GateKind::Pub => (&mut self.published, vec![own()]),
            GateKind::Push => (&mut self.published, peers().collect()),
            GateKind::Sub => (&mut self.subscribed, peers().collect()),
            GateKind::Pull => (&mut self.subscribed, vec![own()]),
            GateKind::Rep => (&mut self.services, vec![own()]),
            GateKind::Req => return,
        };
        for topic in topics {
            let components = map.entry(topic).or_default();
            if !components.iter().any(|known| known == component) {
                components.push(component.to_owned());
            }
        }
    }

    pub(crate) fn to_foxglove(&self) -> ConnectionGraph {
        let mut graph = ConnectionGraph::new();
        self.published.iter().for_each(|(topic, ids)| graph.set_published_topic(topic, ids));
        self.subscribed.iter().for_each(|(topic, ids)| graph.set_subscribed_topic(topic, ids));
        self.services.iter().for_each(|(service, ids)| graph.set_advertised_service(service, ids));
        graph
    }
}

/// The topic of a gate's messages, as in recordings; that of a `rep` gate is the name of its service.
pub(crate) fn topic(component: &str, gate: &str) -> String {
    Topic { component: component.to_owned(), gate: gate.to_owned(), part: Part::Message }.to_string()
}
