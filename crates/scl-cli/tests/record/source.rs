//! A component whose every message the test decides about: ten gates of bytes, and one of each other encoding.

use super::recorder::{Recorder, counts};
use crate::rover::Rover;
use scl::OpenOptions;
use scl::bytes::Bytes;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use scl_tests::wait_until;
use std::collections::BTreeMap;
use std::ops::Range;

/// The viewer never runs, so that its queues drop what nobody takes.
fn topology(count: u32) -> String {
    let gates: String = (0..count).map(|number| format!("      - g{number}: pub\n")).collect();
    let views: String =
        (0..count).map(|number| format!("      - g{number}: {{sub: , queue: 1, when_full: drop_oldest}}\n")).collect();
    let connections: String = (0..count).map(|number| format!("  - [source.g{number}, viewer.g{number}]\n")).collect();
    format!(
        "\
system: rover
schemas: [rover.proto]
components:
  - name: source
    gates:
{gates}      - measurements: {{pub: rover.Measurement}}
      - position: {{pub: rover.Position, codec: json}}
  - name: viewer
    optional: true
    gates:
{views}      - measurements: {{sub: rover.Measurement, queue: 1, when_full: drop_oldest}}
      - position: {{sub: rover.Position, queue: 1, when_full: drop_oldest}}
connections:
{connections}  - [source.measurements, viewer.measurements]
  - [source.position, viewer.position]
"
    )
}

/// The component `source`, run by this process.
pub(super) struct Source {
    pub(super) rover: Rover,
    component: Option<Component>,
    gates: BTreeMap<String, scl::Pub<Bytes>>,
    /// Number of messages that each gate has sent since it was opened.
    sent: BTreeMap<String, u64>,
}

impl Source {
    pub(super) fn start() -> Self {
        Self::start_with(10)
    }

    /// With this many gates of bytes.
    pub(super) fn start_with(count: u32) -> Self {
        Self::start_of(&topology(count))
    }

    /// With one gate of bytes, which is latched.
    pub(super) fn start_latched() -> Self {
        Self::start_of(&topology(1).replace("g0: pub\n", "g0: {pub: , latched: true}\n"))
    }

    fn start_of(topology: &str) -> Self {
        let rover = Rover::of(topology);
        let mut source = Self { rover, component: None, gates: BTreeMap::new(), sent: BTreeMap::new() };
        source.open();
        source
    }

    /// Starts to record these gates into `flight.mcap`, and sends until the recorder sees all of them: a connection is
    /// reported a moment before the gate knows of it.
    pub(super) fn record(&mut self, gates: &[&str], arguments: &[&str]) -> Recorder {
        let names: Vec<String> = gates.iter().map(|gate| format!("source.{gate}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let recorder = Recorder::start(&self.rover, gates.len(), &[&names[..], arguments].concat());
        let file = self.rover.path("flight.mcap");
        wait_until("the recorder sees all gates", || {
            gates.iter().for_each(|gate| self.send(gate, b""));
            recorder.signal("-USR1");
            counts(&file).len() == gates.len()
        });
        recorder
    }

    /// Number of messages that a gate has sent: the sequence of the next one.
    pub(super) fn sent(&self, gate: &str) -> u64 {
        self.sent.get(gate).copied().unwrap_or(0)
    }

    pub(super) fn open(&mut self) {
        let plan = std::fs::read_to_string(self.rover.path("plan.json")).unwrap();
        let plan = SystemPlan::from_json(&plan).unwrap();
        let plan = plan.component("source").unwrap();
        let options = OpenOptions::new().runtime_dir(self.rover.runtime_dir()).system("rover");
        let mut component = Component::open_blocking_with(plan, options).unwrap();
        self.gates =
            plan.gates.iter().map(|gate| (gate.name.clone(), component.publisher(&gate.name).unwrap())).collect();
        self.component = Some(component);
    }

    pub(super) fn close(&mut self) {
        self.gates.clear();
        self.sent.clear();
        self.component = None;
    }

    pub(super) fn send(&mut self, gate: &str, bytes: &[u8]) {
        self.gates.get_mut(gate).unwrap().send_blocking(&Bytes::copy_from_slice(bytes)).unwrap();
        *self.sent.entry(gate.to_owned()).or_default() += 1;
    }

    /// Sends this many messages at `g0`; their sequences.
    pub(super) fn send_numbers(&mut self, count: u64) -> Range<u64> {
        let first = self.sent("g0");
        (0..count).for_each(|number| self.send("g0", &number.to_le_bytes()));
        first..self.sent("g0")
    }
}
