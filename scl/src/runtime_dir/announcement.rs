//! What a running component offers, for tools and for error texts.

use super::SystemDir;
use super::error::RuntimeDirError;
use super::owned_path::OwnedPath;
use super::small_file::{read_file, write_temp};
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::transport_choice::TransportChoice;
use crate::transport_kind::TransportKind;
use rustix::fs::OFlags;
use scl_plan::Plan;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::slice::from_ref;
use std::time::{Duration, SystemTime};

/// The version of the format. It is incremented for changes that readers must know about, not for new keys alone.
const VERSION: u32 = 1;

/// Maximum size of an announcement that is read, in bytes: more than a gate with ten thousand connections needs.
const LIMIT: u64 = 16 << 20;

/// What a running component publishes about itself in `<component>.json`.
///
/// It is published before the component's endpoints are opened. A connecting end reads it to name what differs between
/// two builds; addresses are not in it. When reading, keys that are missing because the writer is older are left empty,
/// and unknown keys are ignored.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Announcement {
    /// The version of the file's format.
    pub version: u32,
    /// The component.
    pub component: String,
    /// The id of its process, as that process sees it. Outside of its container, the process has another id.
    pub pid: u32,
    /// When it was opened; written in whole milliseconds.
    pub started: SystemTime,
    /// The path of the program. Bytes that are not UTF-8 are replaced in the file.
    pub program: PathBuf,
    /// The host that the component runs on, if that is another one: then the process is a gateway that stands in for it
    /// here.
    pub host: Option<String>,
    /// The hash of the protobuf messages it was built with, which are in `<hash>.schema`.
    pub schema: Option<String>,
    /// All endpoints of all its gates, in file order.
    pub endpoints: Vec<AnnouncedEndpoint>,
    /// The component's plan, without its [`schema`](scl_plan::Plan::schema), whose hash is in `schema` above. `None` if
    /// the component was built with a release that did not announce it, or with another version of the format.
    pub plan: Option<Plan>,
}

/// One endpoint of a gate, and what it was built for.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AnnouncedEndpoint {
    /// The gate.
    pub gate: String,
    /// What the gate does: `pub`, `sub`, `req`, `rep`, `push` or `pull`.
    #[serde(default)]
    pub kind: String,
    /// Whether this is the gate's tap, where tools observe it.
    #[serde(default)]
    pub tap: bool,
    /// The endpoint's name, contract included.
    pub endpoint: String,
    /// The contract.
    pub contract: String,
    /// The type as in the topology file.
    pub payload: String,
    /// The codec as in the topology file.
    pub codec: String,
    /// The gates that it connects to, as `<component>.<gate>`.
    #[serde(default, deserialize_with = "texts")]
    pub peers: Vec<String>,
    /// What it listens on: `ipc`, `tcp` or `shm`. Empty for an end that only connects, and if the writer is older.
    #[serde(default, alias = "medium")]
    pub transport: String,
}

impl Announcement {
    /// Returns an announcement of this process, opened now, without endpoints.
    pub fn of_this_process(component: impl Into<String>) -> Self {
        Self {
            version: VERSION,
            component: component.into(),
            pid: std::process::id(),
            started: SystemTime::now(),
            program: std::env::current_exe().unwrap_or_default(),
            host: None,
            schema: None,
            endpoints: Vec::new(),
            plan: None,
        }
    }

    /// Returns an announcement of this process, opened now, with the endpoints of a component.
    pub(crate) fn of(spec: &ComponentSpec, choice: &TransportChoice) -> Self {
        Self {
            schema: spec.schema.map(|schema| schema.hash.to_owned()),
            endpoints: spec.gates.iter().flat_map(|gate| endpoints(spec, gate, choice)).collect(),
            plan: Some(spec.plan()),
            ..Self::of_this_process(spec.name)
        }
    }

    /// Writes the file, with mode 0600 and in one step. Dropping the returned value removes it, unless it was replaced.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError`] if the component's name cannot be the name of a file, or the file cannot be written.
    #[doc(hidden)]
    pub fn publish(&self, dir: &SystemDir) -> Result<OwnedPath, RuntimeDirError> {
        let path = dir.file_of(&self.component, ".json")?;
        write_temp(dir.folder(), &path, format!("{:#}\n", self.to_json()).as_bytes())?.rename(&path, OFlags::PATH)
    }

    /// Reads the announcement of a component, if there is one and it can be understood.
    ///
    /// It may be that of a killed process.
    pub fn read(dir: &SystemDir, component: &str) -> Option<Self> {
        let path = dir.file_of(component, ".json").ok()?;
        Self::from_json(&serde_json::from_slice(&read_file(&path, LIMIT).ok()?).ok()?)
    }

    pub(crate) fn to_json(&self) -> Value {
        let started = self.started.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_millis();
        json!({
            "version": self.version,
            "component": self.component,
            "pid": self.pid,
            "started_ms": u64::try_from(started).unwrap_or(u64::MAX),
            "program": self.program.to_string_lossy(),
            "host": self.host,
            "schema": self.schema,
            "endpoints": self.endpoints,
            "plan": self.plan.as_ref().and_then(plan_to_json),
        })
    }

    pub(crate) fn from_json(json: &Value) -> Option<Self> {
        let started = Duration::from_millis(json["started_ms"].as_u64()?);
        Some(Self {
            version: json["version"].as_u64().and_then(|version| version.try_into().ok()).unwrap_or(0),
            component: text(json, "component")?,
            pid: json["pid"].as_u64()?.try_into().ok()?,
            started: SystemTime::UNIX_EPOCH.checked_add(started)?,
            program: text(json, "program")?.into(),
            host: text(json, "host"),
            schema: text(json, "schema"),
            endpoints: Vec::deserialize(&json["endpoints"]).ok()?,
            plan: Some(&json["plan"])
                .filter(|plan| plan.is_object())
                .and_then(|plan| Plan::from_json(&plan.to_string()).ok()),
        })
    }
}

fn endpoints(spec: &ComponentSpec, gate: &GateSpec, choice: &TransportChoice) -> Vec<AnnouncedEndpoint> {
    let listens = !gate.tap.is_empty();
    let peers =
        || gate.connections.iter().map(|connection| format!("{}.{}", connection.peer_component, connection.peer_gate));
    let endpoint = |name: &str, contract: &str, peers: Vec<String>, kind: TransportKind| AnnouncedEndpoint {
        gate: gate.name.to_owned(),
        kind: gate.kind.word().to_owned(),
        tap: false,
        endpoint: name.to_owned(),
        contract: contract.to_owned(),
        payload: gate.payload.to_owned(),
        codec: gate.codec.to_owned(),
        peers,
        transport: if listens { kind.word().to_owned() } else { String::new() },
    };
    let mut endpoints = if gate.endpoint.is_empty() {
        let connections = gate.connections.iter().zip(peers());
        let announced = |(connection, peer): (&ConnectionSpec, String)| {
            let kind = choice.of(spec, gate, from_ref(connection));
            endpoint(connection.endpoint, connection.contract, vec![peer], kind)
        };
        connections.map(announced).collect()
    } else {
        vec![endpoint(gate.endpoint, gate.contract, peers().collect(), choice.of(spec, gate, gate.connections))]
    };
    if listens {
        let tap = endpoint(gate.tap, gate.contract, Vec::new(), choice.of(spec, gate, &[]));
        endpoints.push(AnnouncedEndpoint { tap: true, ..tap });
    }
    endpoints
}

/// Returns the plan as `docs/plan.md` describes it, without its messages, which are in a separate file.
fn plan_to_json(plan: &Plan) -> Option<Value> {
    serde_json::from_str(&Plan { schema: None, ..plan.clone() }.to_json()).ok()
}

fn text(json: &Value, key: &str) -> Option<String> {
    json[key].as_str().map(str::to_owned)
}

/// Reads the texts of a list. Skips anything else, which comes from a newer release.
fn texts<'de, D: Deserializer<'de>>(list: D) -> Result<Vec<String>, D::Error> {
    let list = Vec::<Value>::deserialize(list)?;
    Ok(list.iter().filter_map(|item| Some(item.as_str()?.to_owned())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{GateKind, GateOptions, Schema, WhenFull};
    use scl_plan::{ConnectionPlan, GatePlan, Payload};

    const fn connection(peer_component: &'static str, endpoint: &'static str) -> ConnectionSpec {
        ConnectionSpec {
            peer_component,
            peer_gate: "peer",
            endpoint,
            contract: "aaaa",
            required: true,
            queue: 1,
            when_full: WhenFull::Wait,
            max_size: 1,
            max_age: None,
        }
    }

    const fn gate(
        kind: GateKind,
        endpoint: &'static str,
        tap: &'static str,
        connections: &'static [ConnectionSpec],
    ) -> GateSpec {
        GateSpec {
            name: "gate",
            kind,
            payload: "nav.Position",
            codec: "protobuf",
            declared_at: "nav.yaml:3:4",
            endpoint,
            tap,
            contract: "aaaa",
            options: GateOptions::DEFAULT,
            connections,
        }
    }

    #[test]
    fn the_announcement_of_a_huge_component_can_be_read() {
        let names = || (0..10_000).map(|index| format!("component_with_a_usual_name_{index}"));
        let plan = Plan {
            system: "nav".to_owned(),
            component: "gps".to_owned(),
            declared_at: "nav.yaml:1:2".to_owned(),
            schema: None,
            parameters: Vec::new(),
            gates: vec![GatePlan {
                name: "position".to_owned(),
                kind: GateKind::Pub,
                payload: Payload::Message("nav.Position".to_owned()),
                codec: "protobuf".to_owned(),
                declared_at: "nav.yaml:3:4".to_owned(),
                endpoint: None,
                tap: Some("gps.position.tap".to_owned()),
                contract: "aaaabbbb".to_owned(),
                options: GateOptions::DEFAULT,
                connections: names().map(|peer| connection_plan(&peer)).collect(),
            }],
        };
        let endpoint = |peer: String| AnnouncedEndpoint {
            gate: "position".to_owned(),
            kind: "pub".to_owned(),
            endpoint: format!("gps.position--{peer}.position.aaaabbbb"),
            contract: "aaaabbbb".to_owned(),
            payload: "nav.Position".to_owned(),
            codec: "protobuf".to_owned(),
            peers: vec![format!("{peer}.position")],
            ..AnnouncedEndpoint::default()
        };
        let mut announcement = Announcement::of_this_process("gps");
        announcement.endpoints = names().map(endpoint).collect();
        announcement.plan = Some(plan.clone());
        let text = format!("{:#}\n", announcement.to_json());
        assert!(text.len() as u64 <= LIMIT, "{} bytes", text.len());
        let read = Announcement::from_json(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!((read.plan, read.endpoints), (Some(plan), announcement.endpoints));
    }

    fn connection_plan(peer: &str) -> ConnectionPlan {
        ConnectionPlan {
            peer_component: peer.to_owned(),
            peer_gate: "position".to_owned(),
            endpoint: format!("gps.position--{peer}.position.aaaabbbb"),
            contract: "aaaabbbb".to_owned(),
            required: true,
            queue: 100,
            when_full: WhenFull::DropOldest,
            max_size: 1 << 26,
            max_age: None,
        }
    }

    #[test]
    fn all_endpoints_of_a_component_are_announced() {
        static PUB: [ConnectionSpec; 2] =
            [connection("one", "gps.gate--one.peer.aaaa"), connection("two", "gps.gate--two.peer.aaaa")];
        static REP: [ConnectionSpec; 2] = [connection("one", "gps.gate.aaaa"), connection("two", "gps.gate.aaaa")];
        static REQ: [ConnectionSpec; 1] = [connection("map", "map.peer.aaaa")];
        static GATES: [GateSpec; 3] = [
            gate(GateKind::Pub, "", "gps.gate.tap", &PUB),
            gate(GateKind::Rep, "gps.gate.aaaa", "gps.gate.tap", &REP),
            gate(GateKind::Req, "", "", &REQ),
        ];
        let schema = Some(Schema { hash: "1111", descriptors: b"" });
        let spec = ComponentSpec {
            system: "nav",
            name: "gps",
            declared_at: "nav.yaml:1:2",
            parameters: &[],
            gates: &GATES,
            schema,
        };
        let announcement = Announcement::of(&spec, &"ipc,one.peer=shm".parse().unwrap());
        assert_eq!((announcement.version, announcement.pid), (VERSION, std::process::id()));
        assert_eq!(announcement.schema.as_deref(), Some("1111"));
        let said = announcement.endpoints.iter().map(|found| {
            assert_eq!((&*found.gate, &*found.contract), ("gate", "aaaa"));
            assert_eq!((&*found.payload, &*found.codec), ("nav.Position", "protobuf"));
            format!("{} {} {} [{}] {}", found.kind, found.tap, found.endpoint, found.peers.join(" "), found.transport)
        });
        let said: Vec<_> = said.collect();
        assert_eq!(
            said,
            [
                "pub false gps.gate--one.peer.aaaa [one.peer] shm",
                "pub false gps.gate--two.peer.aaaa [two.peer] ipc",
                "pub true gps.gate.tap [] ipc",
                "rep false gps.gate.aaaa [one.peer two.peer] shm",
                "rep true gps.gate.tap [] ipc",
                "req false map.peer.aaaa [map.peer] ",
            ]
        );
    }
}
