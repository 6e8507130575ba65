//! A running system.

use crate::channels::{Messages, Sent};
use crate::companions::Descriptions;
use crate::graph::{Graph, topic};
use crate::listen::Listen;
use crate::parameters::{Parameters, parameters};
use crate::publishing::Publishing;
use crate::services::service_of;
use crate::source::Source;
use foxglove::websocket::{Capability, Parameter};
use foxglove::{Context, WebSocketServerHandle};
use scl::tap::{Observation, ObservedKind, TapEvent};
use scl_observe::{Commands, ObservedGate, System, Taps, TapsEvent};
use scl_plan::GateKind;
use scl_record::format::{Part, Topic};
use scl_terminal::{Problem, print_err};
use std::collections::{BTreeSet, HashMap};
use std::mem::replace;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::{MissedTickBehavior, interval};

/// The time between two looks at what runs and what panels show.
const PERIOD: Duration = Duration::from_millis(250);

/// A server that shows a running system.
pub(crate) struct Live {
    server: WebSocketServerHandle,
    context: Arc<Context>,
    system: System,
    commands: Option<Commands>,
    descriptions: Descriptions,
    gates: HashMap<String, Gate>,
    has_looked: bool,
    /// The gates that panels show.
    shown: BTreeSet<String>,
    taps: Taps,
    graph: Graph,
    parameters: Vec<Parameter>,
}

/// A gate that has run, and its topics.
struct Gate {
    gate: ObservedGate,
    sources: Vec<Source>,
}

impl Live {
    /// Starts the server. With `commands`, panels may act.
    ///
    /// # Errors
    /// It cannot listen.
    pub(crate) async fn start(
        listen: Listen,
        system: System,
        commands: Option<Commands>,
        descriptions: Descriptions,
    ) -> Result<Self, Problem> {
        let mut capabilities = vec![Capability::ConnectionGraph, Capability::Parameters];
        let handler = Parameters { system: system.clone(), commands: commands.clone() };
        let mut server = listen.server().name(format!("SCL {}", system.name())).parameter_handler(Arc::new(handler));
        if let Some(commands) = &commands {
            capabilities.extend([Capability::Services, Capability::ClientPublish]);
            let publishing = Publishing::new(commands.clone(), Handle::current());
            server = server.supported_encodings(["json"]).listener(Arc::new(publishing));
        }
        let server = listen.start(server.capabilities(capabilities)).await?;
        Ok(Self {
            taps: Taps::open(&system, Vec::new()),
            server,
            context: listen.context,
            system,
            commands,
            descriptions,
            gates: HashMap::new(),
            has_looked: false,
            shown: BTreeSet::new(),
            graph: Graph::default(),
            parameters: Vec::new(),
        })
    }

    pub(crate) fn port(&self) -> u16 {
        self.server.port()
    }

    /// Sends what passes the gates that panels show, until the future is dropped.
    pub(crate) async fn run(mut self) {
        let mut due = interval(PERIOD);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                _ = due.tick() => self.look(),
                event = self.taps.next() => {
                    if let TapsEvent::Event { gate, event: TapEvent::Observed(seen) } = event {
                        let name = self.taps.gates()[gate].name();
                        self.gates.get(&name).into_iter().for_each(|gate| gate.send(&seen));
                    }
                }
            }
        }
    }

    /// Learns what runs, and which gates panels show; nothing while nobody is connected.
    fn look(&mut self) {
        if self.server.client_count() == 0 && self.shown.is_empty() {
            return;
        }
        let components = self.system.components();
        for gate in self.system.gates() {
            self.add(gate);
        }
        if !replace(&mut self.has_looked, true) {
            let topics = self.gates.values().flat_map(|gate| &gate.sources).map(|source| &source.topic);
            if let Some(missing) = self.descriptions.missing(topics) {
                print_err(&format!("note: nothing that runs sends what is needed for {missing}\n"));
            }
        }
        let graph = Graph::of(&components);
        if graph != self.graph {
            if let Err(error) = self.server.publish_connection_graph(graph.to_foxglove()) {
                print_err(&format!("note: {error}\n"));
            }
            self.graph = graph;
        }
        let parameters = parameters(&components);
        let changed = parameters.iter().filter(|parameter| !self.parameters.contains(parameter)).cloned();
        let changed: Vec<Parameter> = changed.collect();
        if !changed.is_empty() {
            self.server.publish_parameter_values(changed);
        }
        self.parameters = parameters;
        let is_shown = |gate: &&Gate| gate.sources.iter().any(Source::is_shown);
        let shown: BTreeSet<String> = self.gates.values().filter(is_shown).map(|gate| gate.gate.name()).collect();
        if shown != self.shown {
            let gates = shown.iter().filter_map(|name| Some(self.gates.get(name)?.gate.clone()));
            self.taps = Taps::open(&self.system, gates.collect());
            self.shown = shown;
        }
    }

    /// Adds a gate, or replaces one that was built anew with other messages.
    fn add(&mut self, gate: ObservedGate) {
        let name = gate.name();
        if self.gates.get(&name).is_some_and(|known| known.gate.contract == gate.contract) {
            return;
        }
        if let Some(old) = self.gates.remove(&name) {
            old.sources.iter().for_each(Source::close);
            self.server.remove_services([topic(&old.gate.component, &old.gate.gate)]);
            self.shown.remove(&name);
        }
        let service = self.commands.as_ref().and_then(|commands| service_of(&gate, commands));
        if let Some(Err(error)) = service.map(|service| self.server.add_services([service])) {
            print_err(&format!("note: `{name}` is no service: {error}\n"));
        }
        self.gates.insert(name, Gate::new(&self.context, gate, &self.descriptions));
    }
}

impl Gate {
    fn new(context: &Arc<Context>, gate: ObservedGate, descriptions: &Descriptions) -> Self {
        let parts: &[Part] = if gate.kind == GateKind::Rep { &[Part::Request, Part::Reply] } else { &[Part::Message] };
        let source = |&part: &Part| {
            let topic = Topic { component: gate.component.clone(), gate: gate.gate.clone(), part };
            let (type_name, descriptors) = (part.type_name(&gate.payload), gate.schema.as_deref());
            Source::new(context, topic, &Messages { codec: &gate.codec, type_name, descriptors }, descriptions)
        };
        let told = |problem: Problem| print_err(&problem.to_string());
        let sources = parts.iter().filter_map(|part| source(part).map_err(told).ok()).collect();
        Self { gate, sources }
    }

    fn send(&self, seen: &Observation) {
        let part = match seen.kind {
            ObservedKind::Message => Part::Message,
            ObservedKind::Request => Part::Request,
            ObservedKind::Reply => Part::Reply,
        };
        let sent = Sent { payload: seen.payload.clone(), time: seen.sent_ns };
        self.sources.iter().filter(|source| source.topic.part == part).for_each(|source| source.send(&sent));
    }
}
