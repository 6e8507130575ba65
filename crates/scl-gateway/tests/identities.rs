//! Gateways that have right certificates, but are not what they should be: of another system, of another topology, a
//! second one for the same host, or one that claims what runs elsewhere.

use crate::files::{Files, launch};
use crate::fleet::{BOARD, Fleet, GROUND};
use crate::gateway::Gateway;
use crate::network::Network;

const TOPOLOGY: &str = include_str!("two_hosts.yaml");

#[test]
fn a_gateway_of_another_system_is_refused() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground"]));
    fleet.start_gateway("board");
    fleet.play("source");
    let other = fleet.beside(&TOPOLOGY.replace("system: fleet", "system: other"));
    let ground = fleet.network.host("ground");
    let log = other.path("log");
    let gateway = Gateway::start(ground, "ground", &other.topology(), &other.launch(), &log);
    let sink = ground.play("sink", &other.plan());
    fleet.gateway("board").wait_for_log("`other`");
    assert_eq!(fleet.player("source").counts("readings", "account sink.readings").get("connected"), 0);
    gateway.kill();
    sink.kill();
    fleet.start_gateway("ground");
    fleet.play("sink");
    fleet.still_works();
}

/// `sink.readings` expects something else there. What is the same in both topologies connects.
#[test]
fn a_gateway_of_another_topology_connects_what_is_the_same() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground"]));
    fleet.start_gateway("board");
    fleet.play("source");
    let changed = TOPOLOGY.replace("- readings: pub", "- readings: {pub: fleet.Reading, codec: json}");
    assert_ne!(changed, TOPOLOGY);
    let other = fleet.beside(&changed);
    let ground = fleet.network.host("ground");
    let log = other.path("log");
    let mut gateway = Gateway::start(ground, "ground", &other.topology(), &other.launch(), &log);
    let sink = ground.play("sink", &other.plan());
    fleet.player("source").ask("lossless", "send 100 0 100");
    fleet.player("source").wait_for("lossless", "account sink.lossless", |counts| counts.get("connected") == 1);
    // Said where the receiver is, which waits for the sender.
    gateway.wait_for_log("host `board` has the connection `source/readings/sink/readings` with contract ");
    assert_eq!(fleet.player("source").counts("readings", "account sink.readings").get("connected"), 0);
    gateway.kill();
    sink.kill();
    fleet.start_gateway("ground");
    fleet.play("sink");
    fleet.still_works();
}

#[test]
fn a_second_gateway_on_the_same_host_does_not_start() {
    let mut fleet = Fleet::start();
    fleet.send_all();
    let (host, log) = (fleet.network.host("ground"), fleet.files.path("second.log"));
    let second = Gateway::start(host, "ground", &fleet.files.topology(), &fleet.files.launch(), &log);
    let status = second.wait_for_exit();
    let log = std::fs::read_to_string(log).unwrap();
    assert!(!status.success() && log.contains("cannot listen on `10.77.0.2:7447`"), "{status}: {log}");
    fleet.stop_all();
    fleet.exact_accounts();
    fleet.still_works();
}

/// It has a copy of the certificate, on another machine that has another address.
#[test]
fn a_second_gateway_of_a_host_elsewhere_is_refused() {
    let mut fleet = Fleet::start_on(Network::new(&["board", "ground", "copy"]));
    fleet.send_all();
    let copy = fleet.network.host("copy");
    let files = fleet.beside(TOPOLOGY);
    let [board, ground] = ["board", "ground"].map(|name| fleet.network.host(name));
    let theirs = launch(&[(board, BOARD), (ground, GROUND)]).replace(&ground.address, &copy.address);
    files.write("launch.yaml", &theirs);
    let log = files.path("log");
    let _second = Gateway::start(copy, "ground", &files.topology(), &files.launch(), &log);
    let sink = copy.play("sink", &files.plan());
    scl_tests::wait_until("a gateway names the second `ground`", || {
        let logs = [std::fs::read_to_string(&log).unwrap_or_default(), fleet.gateway("board").log()];
        logs.iter().any(|log| log.contains("second gateway") || log.contains("OtherAddress") || log.contains("address"))
    });
    fleet.player("sink").answer_to_next("lossless");
    fleet.stop_all();
    // What arrived there is missing here.
    fleet.exact_accounts();
    sink.kill();
    fleet.still_works();
}

/// It has a certificate of its own, and a launch file of its own, which says that it runs `sink`.
#[test]
fn a_host_that_claims_components_of_another_gets_nothing() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground", "guest"]));
    let [board, ground, guest] = ["board", "ground", "guest"].map(|name| fleet.network.host(name));
    let (own, little) = (&["source", "helper"], &["local_control"]);
    fleet.files.write("launch.yaml", &launch(&[(board, own), (ground, GROUND), (guest, little)]));
    fleet.files.make_keys(&[]);
    let files = fleet.beside(TOPOLOGY);
    files.write("launch.yaml", &launch(&[(board, own), (ground, little), (guest, GROUND)]));
    let log = files.path("log");
    let gateway = Gateway::start(guest, "guest", &files.topology(), &files.launch(), &log);
    let sink = guest.play("sink", &files.plan());
    fleet.start_gateway("board");
    fleet.play("source");
    fleet.gateway("board").wait_for_log("`guest`");
    fleet.player("source").ask("readings", "send 100 0 100");
    assert_eq!(fleet.player("source").counts("readings", "account sink.readings").get("connected"), 0);

    // With the real one beside it, everything goes there.
    fleet.start_gateway("ground");
    fleet.play("sink");
    fleet.still_works();
    let mut sink = sink;
    for gate in ["readings", "newest_kept", "control", "lossless", "jobs"] {
        assert_eq!(sink.counts(gate, "report").get("count"), 0, "{gate}");
    }
    gateway.kill();
    fleet.still_works();
}

impl Fleet {
    /// Files of another system with the same launch file and certificates.
    fn beside(&self, topology: &str) -> Files {
        let files = Files::of(topology);
        files.write("launch.yaml", &std::fs::read_to_string(self.files.launch()).unwrap());
        std::os::unix::fs::symlink(self.files.path("keys"), files.path("keys")).unwrap();
        files
    }
}
