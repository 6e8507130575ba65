//! Where the gates of a checked topology meet: contracts and the names of sockets.
//!
//! A contract is a short mark of what two ends must agree on: pattern, types, codec. It stands in the name of the
//! socket, so programs that were built from different contracts never meet. Names of gates, options and other parts of
//! the file do not change it.

use crate::topology::{Codec, ConnectionId, Gate, GateId, GateKind, Payload, Topology};

/// The longest path of a socket, in bytes, without the final zero (`sun_path` of Linux).
pub const LONGEST_PATH: usize = 107;

/// The characters of a contract.
pub const CONTRACT_LENGTH: usize = 8;

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
    fingerprint([pattern, first, second, codec_text(gate.codec())])
}

/// The name of a connection's socket in the folder of its system.
///
/// For `pub` and `sub` it is `<pub>.<gate>--<sub>.<gate>.<contract>`. Where the longest usual folder leaves no room for
/// that, the end of the gates' names is replaced by `~` and a fingerprint of them; the contract always stays the part
/// after the last dot. For `req` and `push` it is the socket of the gate at the other end, see [`gate_endpoint`].
pub fn endpoint(topology: &Topology, connection: ConnectionId) -> String {
    let link = topology.connection(connection);
    if let Some(own) = shared_endpoint(topology, link.sink()) {
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

/// The name of the socket that belongs to a gate as a whole.
///
/// `rep` and `pull` gates listen at `<component>.<gate>.<contract>`, a `pub` gate lets tools listen at its tap
/// `<component>.<gate>.tap`; the other gates have none. No contract is `tap`, and no file of a component ends so, which
/// leaves gates free to be called `lock` or `json`.
pub fn gate_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    match topology.gate(gate).kind() {
        GateKind::Pub => Some(format!("{}{TAP}", topology.gate_path(gate))),
        _ => shared_endpoint(topology, gate),
    }
}

fn shared_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    matches!(topology.gate(gate).kind(), GateKind::Rep | GateKind::Pull)
        .then(|| format!("{}.{}", topology.gate_path(gate), gate_contract(topology, gate)))
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
    format!("{}~{}", pair.get(..kept).unwrap_or(""), fingerprint([pair]))
}

fn type_texts(gate: &Gate) -> [&str; 2] {
    match gate.payload() {
        Payload::Bytes => ["", ""],
        Payload::Message(name) => [name.dotted(), ""],
        Payload::Exchange { request, reply } => [request.dotted(), reply.dotted()],
    }
}

fn codec_text(codec: &Codec) -> &str {
    match codec {
        Codec::Protobuf => "protobuf",
        Codec::Json => "json",
        Codec::Cbor => "cbor",
        Codec::Msgpack => "msgpack",
        Codec::Postcard => "postcard",
        Codec::Raw => "raw",
        Codec::Path(path) => path,
    }
}

/// Forty bits of FNV-1a (64 bits) over the parts, as eight characters. Written out here because programs of different
/// versions and languages must agree on it for ever.
pub(crate) fn fingerprint<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    const ALPHABET: &[u8; 32] = b"abcdefghijklmnopqrstuvwxyz234567";
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for part in parts {
        // The zero after each part keeps `ab`, `c` and `a`, `bc` apart.
        for byte in part.bytes().chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    // The upper half of the product has met every byte; the lower one folds in what it lacks.
    let folded = hash ^ (hash >> 40);
    let letter = |at: usize| char::from(ALPHABET[(folded >> (5 * at)) as usize % 32]);
    (0..CONTRACT_LENGTH).map(letter).collect()
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
        let gates = topology.components().flat_map(|(_, component)| component.gates());
        let own: Vec<_> = gates.filter_map(|&gate| gate_endpoint(&topology, gate)).collect();
        assert_eq!(own, ["sensor.fix.tap", "pilot.jobs.26t2nsae", "pilot.orders.yrvcf33f"]);
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

    #[test]
    fn the_hash_never_changes() {
        assert_eq!(fingerprint([""; 0]), "znutocs4");
        assert_eq!(fingerprint(["ab", "c"]), "cmzg4j5f");
        assert_ne!(fingerprint(["ab", "c"]), fingerprint(["a", "bc"]));
    }
}
