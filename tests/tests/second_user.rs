//! Programs on loopback TCP on a shared machine: another user can neither connect to them nor take a peer's place.
//!
//! A second user exists only if the test runs as root: it then starts a program as the user 65534.

use crate::programs::{STRANGER, open};
use scl::Medium;
use scl_tests::{Address, Process, RawPeer, System};
use std::fs;
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
#[test]
fn another_user_cannot_connect() {
    let Some(stranger) = Stranger::new() else { return };
    let system = System::with_medium(Medium::Tcp);
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.ask("ready 30000", "ready");
    for (_, endpoint, socket_type) in LISTENING {
        let mut program = stranger.start("connect", port(&system, endpoint), socket_type);
        program.expect("heard 0 bytes");
    }
    assert_good(&mut source, &mut sink);
}

/// The same connections are allowed to plain ZeroMQ programs of the same user.
#[test]
fn a_plain_program_of_the_same_user_can_connect() {
    let system = System::with_medium(Medium::Tcp);
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    for (_, endpoint, socket_type) in LISTENING {
        RawPeer::join(&system.address("six", endpoint), socket_type);
    }
    source.ask("ready 30000", "ready");
    assert_good(&mut source, &mut sink);
}

/// The promise: a port that a killed program left behind leads nowhere, even if another user listens there now.
#[test]
fn another_user_cannot_take_the_place_of_a_killed_program() {
    let Some(stranger) = Stranger::new() else { return };
    let pairs = [("source", "sink", &LISTENING[..1], "PUB"), ("sink", "source", &LISTENING[2..3], "PULL")];
    let replier = [("sink", "source", &LISTENING[4..5], "REP")];
    for (killed, other, endpoints, socket_type) in pairs.into_iter().chain(replier) {
        let system = System::with_medium(Medium::Tcp);
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
        source.ask("ready 30000", "ready");
        assert_good(&mut source, &mut sink);
    }
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
    /// Returns `None`, and prints why, if this test is not run by root.
    fn new() -> Option<Self> {
        if !rustix::process::geteuid().is_root() {
            println!("skipped: needs root to start a program as another user");
            return None;
        }
        let folder = TempDir::with_prefix("scl").expect("a folder");
        let program = folder.path().join("stranger");
        fs::copy(STRANGER, &program).expect("copied");
        for path in [folder.path(), &program] {
            fs::set_permissions(path, PermissionsExt::from_mode(0o755)).expect("opened to others");
        }
        Some(Self { _folder: folder, program })
    }

    fn start(&self, what: &str, port: u16, socket_type: &str) -> Process {
        let mut command = Command::new(&self.program);
        command.args([what, &port.to_string(), socket_type]).uid(NOBODY).gid(NOBODY);
        Process::spawn(command)
    }
}
