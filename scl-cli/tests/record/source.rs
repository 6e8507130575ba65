//! A component whose every message the test decides about: ten gates of bytes, and one of each other encoding.

use crate::rover::Rover;
use scl::OpenOptions;
use scl::bytes::Bytes;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::collections::BTreeMap;

/// The viewer never runs, so that its queues drop what nobody takes.
fn topology() -> String {
    let gates: String = (0..10).map(|number| format!("      - g{number}: pub\n")).collect();
    let views: String = (0..10)
        .map(|number| format!("      - g{number}: {{sub: bytes, queue: 1, when_full: drop_oldest}}\n"))
        .collect();
    let connections: String = (0..10).map(|number| format!("  - [source.g{number}, viewer.g{number}]\n")).collect();
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

/// Number of its gates.
pub(super) const GATES: usize = 12;

/// The component `source`, run by this process.
pub(super) struct Source {
    pub(super) rover: Rover,
    component: Option<Component>,
    gates: BTreeMap<String, scl::Pub<Bytes>>,
}

impl Source {
    pub(super) fn start() -> Self {
        let mut source = Self::stopped();
        source.open();
        source
    }

    pub(super) fn stopped() -> Self {
        Self { rover: Rover::of(&topology()), component: None, gates: BTreeMap::new() }
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
        self.component = None;
    }

    pub(super) fn send(&mut self, gate: &str, bytes: &[u8]) {
        self.gates.get_mut(gate).unwrap().send_blocking(&Bytes::copy_from_slice(bytes)).unwrap();
    }

    /// Sends this many numbers at `g0`.
    pub(super) fn send_numbers(&mut self, numbers: std::ops::Range<u64>) {
        numbers.for_each(|number| self.send("g0", &number.to_le_bytes()));
    }
}
