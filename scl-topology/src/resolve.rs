//! Where the gates of a checked topology meet: contracts and the names of sockets.
//!
//! A contract is a short mark of what two ends must agree on: pattern, types, codec. It stands in the name of the
//! socket, so programs that were built from different contracts never meet. Names of gates, options and other parts of
//! the file do not change it.

use crate::fingerprint;
use crate::topology::{ConnectionId, Gate, GateId, GateKind, Payload, Topology};

/// The longest path of a socket, in bytes, without the final zero (`sun_path` of Linux).
pub const LONGEST_PATH: usize = 107;

/// The characters of a contract.
pub const CONTRACT_LENGTH: usize = fingerprint::SHORT_LENGTH;

/// The end of the name of a tap.
pub(crate) const TAP: &str = ".tap";

/// The folder of all systems where it is longest: the largest user id there is.
const LONGEST_ROOT: &str = "/run/user/4294967295/scl";

/// The contract of a connection: eight characters of `a-z2-7`.
pub fn contract(topology: &Topology, connection: ConnectionId) -> String {
    // The receiving end has one contract for all its peers, so it is the one that counts.
    gate_contract(topology, topology.connection(connection).sink())
}

/// The contract of a gate with any of its peers: eight characters of `a-z2-7`.
pub fn gate_contract(topology: &Topology, gate: GateId) -> String {
    let gate = topology.gate(gate);
    let pattern = match gate.kind() {
        GateKind::Pub | GateKind::Sub => "pub/sub",
        GateKind::Req | GateKind::Rep => "req/rep",
        GateKind::Push | GateKind::Pull => "push/pull",
    };
    let [first, second] = type_texts(gate);
    fingerprint::short([pattern, first, second, gate.codec().word()])
}

/// The name of a connection's socket in the folder of its system.
///
/// For `pub` and `sub` it is `<pub>.<gate>--<sub>.<gate>.<contract>`. Where the longest usual folder leaves no room for
/// that, the end of the gates' names is replaced by `~` and a fingerprint of them; the contract always stays the part
/// after the last dot. For `req` and `push` it is the socket of the gate at the other end, see [`gate_endpoint`].
pub fn endpoint(topology: &Topology, connection: ConnectionId) -> String {
    let link = topology.connection(connection);
    if let Some(own) = gate_endpoint(topology, link.sink()) {
        return own;
    }
    let pair = format!("{}--{}", topology.gate_path(link.source()), topology.gate_path(link.sink()));
    let room = connection_room(topology.system());
    format!("{}.{}", shortened(&pair, room), contract(topology, connection))
}

/// How many bytes of a path are left for the two gates of a connection.
pub(crate) fn connection_room(system: &str) -> usize {
    LONGEST_PATH.saturating_sub(folder_length(system) + 1 + CONTRACT_LENGTH)
}

/// The name of the socket at which a `rep` or `pull` gate listens for all its peers: `<component>.<gate>.<contract>`.
/// The other kinds have none.
pub fn gate_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    let listens = matches!(topology.gate(gate).kind(), GateKind::Rep | GateKind::Pull);
    listens.then(|| format!("{}.{}", topology.gate_path(gate), gate_contract(topology, gate)))
}

/// The name of the socket at which tools observe a `pub`, `rep` or `pull` gate: `<component>.<gate>.tap`. The other
/// kinds have none.
///
/// No contract is `tap`, and no other file of a component has this ending, so gates may be called `lock` or `json`.
pub fn tap_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    topology.gate(gate).kind().listens().then(|| format!("{}{TAP}", topology.gate_path(gate)))
}

/// The longest usual folder of a system, with a slash at its end.
pub(crate) fn longest_folder(system: &str) -> String {
    format!("{LONGEST_ROOT}/{system}/")
}

pub(crate) fn folder_length(system: &str) -> usize {
    LONGEST_ROOT.len() + system.len() + 2
}

/// Names are ASCII once they are checked, so that any byte is the end of a character.
pub(crate) fn shortened(pair: &str, room: usize) -> String {
    if pair.len() <= room {
        return pair.to_owned();
    }
    let kept = room.saturating_sub(1 + CONTRACT_LENGTH);
    format!("{}~{}", pair.get(..kept).unwrap_or(""), fingerprint::short([pair]))
}

fn type_texts(gate: &Gate) -> [&str; 2] {
    match gate.payload() {
        Payload::Bytes => ["", ""],
        Payload::Message(name) => [name.dotted(), ""],
        Payload::Exchange { request, reply } => [request.dotted(), reply.dotted()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::testing::topology;

    const FILE: &str = "components:
  - name: sensor
    gates:
      - fix: {pub: nav.Fix, codec: json}
      - work: {push: nav.Job}
      - ask: {req: A -> B}
  - name: pilot
    gates:
      - gps: {sub: nav.Fix, queue: 1}
      - jobs: pull
      - orders: {rep: A -> B}
  - name: other
    gates:
      - fix: sub
      - work: push
connections:
  - [sensor.fix, pilot.gps]
  - [pilot.jobs, sensor.work]
  - [sensor.ask, pilot.orders]
  - [other.fix, sensor.fix]
  - [other.work, pilot.jobs]
";

    fn endpoints(yaml: &str) -> Vec<String> {
        let topology = topology(yaml);
        topology.connections().map(|(id, _)| endpoint(&topology, id)).collect()
    }

    #[test]
    fn sockets_are_named_after_their_gates() {
        assert_eq!(
            endpoints(FILE),
            [
                "sensor.fix--pilot.gps.5eyd5c3s",
                "pilot.jobs.26t2nsae",
                "pilot.orders.yrvcf33f",
                "sensor.fix--other.fix.5eyd5c3s",
                "pilot.jobs.26t2nsae",
            ]
        );
    }

    #[test]
    fn gates_have_their_own_sockets_by_kind() {
        let topology = topology(FILE);
        let gates = || topology.components().flat_map(|(_, component)| component.gates());
        let own: Vec<_> = gates().filter_map(|&gate| gate_endpoint(&topology, gate)).collect();
        assert_eq!(own, ["pilot.jobs.26t2nsae", "pilot.orders.yrvcf33f"]);
        let taps: Vec<_> = gates().filter_map(|&gate| tap_endpoint(&topology, gate)).collect();
        assert_eq!(taps, ["sensor.fix.tap", "pilot.jobs.tap", "pilot.orders.tap"]);
    }

    #[test]
    fn contracts_change_with_what_they_are_about_only() {
        let contracts = |yaml: &str| {
            let topology = topology(yaml);
            topology.connections().map(|(id, _)| contract(&topology, id)).collect::<Vec<_>>()
        };
        let before = contracts(FILE);
        let same = [
            ("sensor", "probe"),
            ("queue: 1", "queue: 7"),
            ("gates:", "doc: Text.\n    gates:"),
            ("work: push\n", "work: push\n      - more: pub\n"),
        ];
        for (from, to) in same {
            assert_eq!(contracts(&FILE.replace(from, to)), before, "{from} to {to}");
        }
        for (from, to, changed) in
            [("nav.Fix", "nav.Place", [0, 3]), ("nav.Job", "Job", [1, 4]), ("json", "cbor", [0, 3])]
        {
            let after = contracts(&FILE.replace(from, to));
            let differ: Vec<usize> = (0..5).filter(|&at| after[at] != before[at]).collect();
            assert_eq!(differ, changed, "{from} to {to}");
        }
    }

    #[test]
    fn request_and_reply_are_not_interchangeable() {
        let swapped = FILE.replace("A -> B", "B -> A");
        assert_ne!(endpoints(FILE)[2], endpoints(&swapped)[2]);
    }

    #[test]
    fn long_names_fit_into_the_path_and_stay_apart() {
        const SYSTEM: &str = "twenty_characters_ok";
        let long = "a_name_that_is_a_little_longer_than";
        let yaml = FILE.replace("pilot", &format!("{long}_one")).replace("other", &format!("{long}_two"));
        let yaml = format!("system: {SYSTEM}\n{yaml}");
        let names = endpoints(&yaml);
        let room = LONGEST_PATH - folder_length(SYSTEM);
        assert!(names.iter().all(|name| name.len() <= room), "{names:?}");
        assert!(names[0].starts_with("sensor.fix--") && names[0].contains('~'), "{names:?}");
        assert_ne!(names[0], names[3]);
        assert_eq!(names[0].rsplit('.').next(), endpoints(FILE)[0].rsplit('.').next());
    }
}
