//! Plain ZeroMQ programs at the other end of all six kinds of gate: libzmq through pyzmq, with and without heartbeats,
//! and the `zeromq` library.

use crate::programs::TWIN;
use scl::spec::GateKind;
use scl::{Component, TransportKind};
use scl_tests::{Process, System, start_python};
use std::thread::park_timeout;
use std::time::Duration;

const ZEROMQ_TWIN: &str = env!("CARGO_BIN_EXE_zeromq_twin");

mod twins {
    scl::topology!("topologies/twins.yaml", only = [left]);
}

/// An implementation of ZeroMQ that is not ours.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Witness {
    /// With the interval of its heartbeats in milliseconds; 0 is none.
    Libzmq(u32),
    Zeromq,
}

const WITNESSES: [Witness; 3] = [Witness::Libzmq(0), Witness::Libzmq(10), Witness::Zeromq];

#[test]
fn every_kind_of_gate_talks_to_plain_zeromq_over_unix_sockets() {
    WITNESSES.iter().for_each(|witness| {
        let system = System::new();
        let mut left = start_left(&system);
        let mut right = witness.start(&system);
        exchange(&mut left, &mut right);
    });
}

#[test]
fn every_kind_of_gate_talks_to_plain_zeromq_over_tcp() {
    WITNESSES.iter().for_each(|witness| {
        let system = System::over(TransportKind::Tcp);
        let mut left = start_left(&system);
        let mut right = witness.start(&system);
        exchange(&mut left, &mut right);
    });
}

#[test]
fn a_program_that_starts_after_plain_zeromq_finds_it() {
    WITNESSES.iter().for_each(|witness| {
        let system = System::new();
        let mut right = witness.spawn(&system);
        // The `zeromq` library is open only after it has connected.
        if *witness != Witness::Zeromq {
            right.expect("open");
        }
        let mut left = start_left(&system);
        if *witness == Witness::Zeromq {
            right.expect("open");
        }
        exchange(&mut left, &mut right);
    });
}

#[test]
fn a_plain_zeromq_program_that_restarts_is_found_again() {
    WITNESSES.iter().for_each(|witness| {
        let system = System::new();
        let mut left = start_left(&system);
        for _ in 0..3 {
            let mut right = witness.start(&system);
            exchange(&mut left, &mut right);
            right.kill();
            left.ask("peers 0", "peers");
        }
    });
}

/// The `zeromq` library reconnects after up to 30 s, so only libzmq is asked to.
#[test]
fn a_program_that_restarts_is_found_again_by_plain_zeromq() {
    for witness in [Witness::Libzmq(0), Witness::Libzmq(10)] {
        let system = System::new();
        let mut left = start_left(&system);
        let mut right = witness.start(&system);
        for _ in 0..3 {
            exchange(&mut left, &mut right);
            left.kill();
            left = start_left(&system);
        }
    }
}

/// Longer than a peer may stay silent before libzmq closes the connection.
#[test]
fn connections_with_heartbeats_last() {
    let system = System::new();
    let mut left = start_left(&system);
    let mut right = Witness::Libzmq(10).start(&system);
    exchange(&mut left, &mut right);
    stream(&mut left, &mut right, 1500);
    right.ask("connected", "0 lost");
    exchange(&mut left, &mut right);
}

impl Witness {
    /// Starts the program that plays `right`.
    fn start(self, system: &System) -> Process {
        let mut right = self.spawn(system);
        right.expect("open");
        right
    }

    fn spawn(self, system: &System) -> Process {
        let addresses = addresses(system);
        let addresses: Vec<&str> = addresses.iter().map(String::as_str).collect();
        match self {
            Self::Zeromq => system.start(ZEROMQ_TWIN, &addresses),
            Self::Libzmq(heartbeat) => start_python("twin.py", &[&[&*heartbeat.to_string()], &addresses[..]].concat()),
        }
    }
}

/// Where each socket of `right` listens or connects: `NAME=ADDRESS`.
fn addresses(system: &System) -> Vec<String> {
    let of_gate = |gate: &scl::spec::GateSpec| {
        let link = &gate.connections[0];
        let connects = |endpoint: &str| match system.transport_kind() {
            TransportKind::Tcp => system.address("twins", endpoint).url(),
            _ => format!("ipc://{}", system.path("twins", endpoint).display()),
        };
        let listens = |endpoint: &str| {
            let scheme = if system.transport_kind() == TransportKind::Tcp { "tcp:" } else { "ipc://" };
            format!("{scheme}{}", system.path("twins", endpoint).display())
        };
        let address = match gate.kind {
            GateKind::Pub => connects(link.endpoint),
            GateKind::Pull | GateKind::Rep => connects(gate.endpoint),
            GateKind::Sub | GateKind::Push | GateKind::Req => listens(link.endpoint),
        };
        format!("{}={address}", link.peer_gate)
    };
    twins::Left::SPEC.gates.iter().map(of_gate).collect()
}

fn start_left(system: &System) -> Process {
    let mut left = system.start(TWIN, &["left", "current_thread"]);
    left.expect("open");
    left
}

/// Messages of every kind in both directions.
fn exchange(left: &mut Process, right: &mut Process) {
    stream(left, right, 50);
    right.ask("push 0 100", "pushed");
    left.ask("jobs 99", "0..100");
    right.ask("call 21", "42");
    // A publisher of plain ZeroMQ messages does not know when its subscriber has subscribed.
    right.tell("values 0");
    while right.try_next_line().is_none() {
        left.ask("publish 0 1", "published");
        park_timeout(Duration::from_millis(1));
    }
    left.ask("publish 1 101", "published");
    right.tell("values 100");
    let received = right.next_line();
    let whole = ["0..101", "1..101"].iter().any(|range| received.split(' ').next_back() == Some(range));
    assert!(whole, "messages are missing: {received}");
    left.ask("push 0 100", "pushed");
    right.ask("jobs 99", "0..100");
    left.ask("call 21", "42");
}

/// Lets the plain program publish at least up to a value; from the first that arrives, none is missing.
fn stream(left: &mut Process, right: &mut Process, last: u64) {
    right.tell("stream");
    left.tell(&format!("values_from {last}"));
    let received = left.next_line();
    assert!(!received.contains(' '), "messages are missing: {received}");
    right.ask("stop", "stopped");
    left.tell("values 1000000");
    let rest = left.next_line();
    assert!(rest.ends_with("1000000..1000001"), "{rest}");
}
