//! `--for zmq`: the sockets of a system, for programs with only a ZeroMQ library. docs/generate.md has the format.

use crate::output::File;
use crate::system::{Gate, System};
use scl_plan::{GatePlan, Payload, Plan};
use serde::{Serialize, Serializer};

/// The version of the format. It grows when a field changes its meaning or is removed, but not when a field is added.
const VERSION: u64 = 1;

/// How the configuration is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Format {
    /// JSON.
    #[default]
    Json,
    /// YAML.
    Yaml,
}

/// `<system>.zmq.json`.
pub(crate) fn json(system: &System) -> Vec<File> {
    // Cannot fail: only maps with keys other than strings cannot be serialized.
    let text = serde_json::to_string_pretty(&Document::of(system)).unwrap_or_default();
    vec![File { name: format!("{}.zmq.json", system.snake_name()), text: text + "\n" }]
}

/// `<system>.zmq.yaml`.
pub(crate) fn yaml(system: &System) -> Vec<File> {
    // Cannot fail, as above.
    let text = serde_yaml::to_string(&Document::of(system)).unwrap_or_default();
    vec![File { name: format!("{}.zmq.yaml", system.snake_name()), text: format!("# {}\n{text}", system.header()) }]
}

#[derive(Serialize)]
struct Document<'a> {
    version: u64,
    topology: &'a str,
    system: &'a str,
    schemas: Vec<&'a str>,
    schema_folders: &'a [String],
    components: InOrder<ComponentEntry<'a>>,
}

#[derive(Serialize)]
struct ComponentEntry<'a> {
    doc: Option<&'a str>,
    gates: InOrder<GateEntry<'a>>,
}

#[derive(Serialize)]
struct GateEntry<'a> {
    kind: &'static str,
    doc: Option<&'a str>,
    payload: Option<PayloadEntry<'a>>,
    codec: &'a str,
    contract: &'a str,
    zmq_socket_type: String,
    zmq_method: &'static str,
    zmq_endpoints: Vec<String>,
    zmq_tap: Option<String>,
    peers: Vec<String>,
    queue: u32,
    when_full: &'static str,
    max_size: u64,
    timeout_ns: u64,
}

#[derive(Serialize)]
#[serde(untagged)]
enum PayloadEntry<'a> {
    Message { message: &'a str },
    Exchange { request: &'a str, reply: &'a str },
}

impl<'a> Document<'a> {
    fn of(system: &'a System) -> Self {
        let files = system.descriptors.iter().flat_map(|set| &set.file).map(|file| file.name());
        let entries = system.plan.components.iter().filter_map(|plan| ComponentEntry::of(system, plan));
        Self {
            version: VERSION,
            topology: &system.topology_file,
            system: &system.name,
            schemas: files.collect(),
            schema_folders: &system.schema_folders,
            components: InOrder(entries.collect()),
        }
    }
}

impl<'a> ComponentEntry<'a> {
    fn of(system: &'a System, plan: &'a Plan) -> Option<(String, Self)> {
        let component = system.components.iter().find(|component| component.includes(&plan.component))?;
        let instance = component.instances.iter().find(|instance| instance.name == plan.component);
        let doc = instance.and_then(|instance| instance.doc.as_ref()).or(component.doc.as_ref());
        let gates = component.gates.iter().zip(&plan.gates);
        let gates = gates.map(|(gate, plan)| (plan.name.clone(), GateEntry::of(gate, plan)));
        Some((plan.component.clone(), Self { doc: doc.map(String::as_str), gates: InOrder(gates.collect()) }))
    }
}

impl<'a> GateEntry<'a> {
    fn of(gate: &'a Gate, plan: &'a GatePlan) -> Self {
        // A gate that listens for all its peers has one endpoint, the others have one per connection.
        let endpoints: Vec<&str> = match &plan.endpoint {
            Some(endpoint) => vec![endpoint],
            None => plan.connections.iter().map(|connection| connection.endpoint.as_str()).collect(),
        };
        Self {
            kind: plan.kind.word(),
            doc: gate.doc.as_deref(),
            payload: payload(&plan.payload),
            codec: &plan.codec,
            contract: &plan.contract,
            // The socket of a plain ZeroMQ program that takes the component's place.
            zmq_socket_type: plan.kind.word().to_ascii_uppercase(),
            zmq_method: if plan.kind.listens() { "bind" } else { "connect" },
            zmq_endpoints: endpoints.into_iter().map(address).collect(),
            zmq_tap: plan.tap.as_deref().map(address),
            peers: plan.connections.iter().map(|it| format!("{}.{}", it.peer_component, it.peer_gate)).collect(),
            queue: plan.options.queue,
            when_full: plan.options.when_full.word(),
            max_size: plan.options.max_size,
            timeout_ns: scl_text::duration::nanoseconds(plan.options.timeout),
        }
    }
}

fn payload(payload: &Payload) -> Option<PayloadEntry<'_>> {
    match payload {
        Payload::Bytes => None,
        Payload::Message(message) => Some(PayloadEntry::Message { message }),
        Payload::Exchange { request, reply } => Some(PayloadEntry::Exchange { request, reply }),
    }
}

/// The address of an endpoint, with a placeholder for the folder of the system, which depends on the user and the
/// environment of the program.
fn address(endpoint: &str) -> String {
    format!("ipc://{{folder}}/{endpoint}")
}

/// A map in the order of the topology file.
struct InOrder<T>(Vec<(String, T)>);

impl<T: Serialize> Serialize for InOrder<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
