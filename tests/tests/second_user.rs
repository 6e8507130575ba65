//! Programs on loopback TCP on a shared machine: another user can neither connect to them nor take a peer's place.
//!
//! Only root can start a program as another user, here 65534.

use crate::programs::{PEER, STRANGER, open};
use scl::TransportKind;
use scl_needs::needs;
use scl_tests::{Address, Process, RawPeer, System};
use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

const NOBODY: u32 = 65534;
/// Every end that listens, with the socket type of its peers.
const LISTENING: [(&str, &str, &str); 6] = [
    ("source", "source.readings--sink.readings.", "SUB"),
    ("source", "source.readings.tap", "SUB"),
    ("sink", "sink.jobs.", "PUSH"),
    ("sink", "sink.jobs.tap", "SUB"),
    ("sink", "sink.answer.", "REQ"),
    ("sink", "sink.answer.tap", "SUB"),
];

/// The promise: another user can read, command and answer nothing. It is disconnected without a word.
#[needs("root")]
#[test]
fn another_user_cannot_connect() {
    let stranger = Stranger::new();
    let system = System::over(TransportKind::Tcp);
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    for (_, endpoint, socket_type) in LISTENING {
        let mut program = stranger.start("connect", port(&system, endpoint), socket_type);
        program.expect("heard 0 bytes");
    }
    assert_good(&mut source, &mut sink);
}

/// The same connections are allowed to plain ZeroMQ programs of the same user.
#[test]
fn a_plain_program_of_the_same_user_can_connect() {
    let system = System::over(TransportKind::Tcp);
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    for (_, endpoint, socket_type) in LISTENING {
        RawPeer::join(&system.address("six", endpoint), socket_type);
    }
    source.get_ready();
    assert_good(&mut source, &mut sink);
}

/// The promise: a port that a killed program left behind leads nowhere, even if another user listens there now.
#[needs("root")]
#[test]
fn another_user_cannot_take_the_place_of_a_killed_program() {
    let stranger = Stranger::new();
    let pairs = [("source", "sink", &LISTENING[..1], "PUB"), ("sink", "source", &LISTENING[2..3], "PULL")];
    let replier = [("sink", "source", &LISTENING[4..5], "REP")];
    for (killed, other, endpoints, socket_type) in pairs.into_iter().chain(replier) {
        let system = System::over(TransportKind::Tcp);
        let victim = open(&system, killed);
        let port = port(&system, endpoints[0].1);
        victim.kill();
        let mut program = stranger.start("listen", port, socket_type);
        program.expect("listening");
        let mut other_process = open(&system, other);
        // Long enough for many attempts to connect: it is the absence of a connection that is shown here.
        other_process.tell("ready 500");
        let error = other_process.next_line();
        assert!(error.contains("not ready"), "{error}");
        // What connected, if anything, did not say a word.
        let log = program.kill_and_read();
        assert!(log.iter().all(|line| line == "heard 0 bytes"), "{log:?}");
        let killed_process = open(&system, killed);
        let (mut source, mut sink) =
            if killed == "source" { (killed_process, other_process) } else { (other_process, killed_process) };
        source.get_ready();
        assert_good(&mut source, &mut sink);
    }
}

/// The table of all sockets takes the longer to read the more programs a machine runs.
#[needs("root")]
#[test]
fn refusing_connections_does_not_read_the_table_of_sockets() {
    let stranger = Stranger::new();
    let system = System::over(TransportKind::Tcp);
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    let _neighbours: Vec<_> = (0..200).map(|_| TcpListener::bind("127.0.0.1:0").expect("a port")).collect();
    let row = 150;
    let (before, connections) = (sink.bytes_read(), 500);
    let mut program = stranger.start("flood", port(&system, "sink.jobs."), &connections.to_string());
    program.expect("refused");
    let read = sink.bytes_read() - before;
    assert!(read < connections * 200 * row / 10, "{read} bytes were read to refuse {connections} connections");
    assert_good(&mut source, &mut sink);
}

/// A sandbox without netlink: the table is read instead, and everybody is told apart as before.
#[needs("root", "python3")]
#[test]
fn another_user_cannot_connect_where_the_kernel_is_not_to_be_asked() {
    let stranger = Stranger::new();
    let system = System::over(TransportKind::Tcp);
    let [mut source, mut sink] = ["source", "sink"].map(|component| {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/without_netlink.py");
        let mut process = system.start("python3", &[script, PEER, component]);
        process.expect("open");
        process
    });
    source.get_ready();
    let mut program = stranger.start("flood", port(&system, "sink.jobs."), "10");
    let mut other = stranger.start("connect", port(&system, "sink.answer."), "REQ");
    other.expect("heard 0 bytes");
    program.expect("refused");
    assert_good(&mut source, &mut sink);
    sink.kill();
    let mut sink = open(&system, "sink");
    source.get_ready();
    assert_good(&mut source, &mut sink);
}

fn assert_good(source: &mut Process, sink: &mut Process) {
    source.ask("publish 0 10", "published");
    sink.ask("receive 10", "0..10");
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
    sink.tell("serve 1");
    source.ask("call 4", "8");
    sink.expect("served");
}

fn port(system: &System, endpoint: &str) -> u16 {
    match system.address("six", endpoint) {
        Address::Tcp(address) => address.port(),
        Address::Unix(path) => panic!("{} is a Unix socket", path.display()),
    }
}

/// A program that another user can run, in a folder that others may enter.
struct Stranger {
    _folder: TempDir,
    program: PathBuf,
}

impl Stranger {
    fn new() -> Self {
        let folder = TempDir::with_prefix("scl").expect("a folder");
        let program = folder.path().join("stranger");
        fs::copy(STRANGER, &program).expect("copied");
        for path in [folder.path(), &program] {
            fs::set_permissions(path, PermissionsExt::from_mode(0o755)).expect("opened to others");
        }
        Self { _folder: folder, program }
    }

    fn start(&self, what: &str, port: u16, socket_type: &str) -> Process {
        let mut command = Command::new(&self.program);
        command.args([what, &port.to_string(), socket_type]).uid(NOBODY).gid(NOBODY);
        Process::spawn(command)
    }
}
