//! Taps: what a gate sends, receives or answers, shown to any number of observers, none of which delays anything.

use crate::programs::{TWIN, open};
use crate::stats::dir_of;
use scl::runtime_dir::{ComponentStats, GateFigures};
use scl_tests::zmtp::{command, subscribe};
use scl_tests::{Process, RawPeer, System, on_each_transport, wait_until};
use std::time::{SystemTime, UNIX_EPOCH};

const MESSAGE: u8 = 0;
const REQUEST: u8 = 1;
const REPLY: u8 = 2;

/// The promise: each message at a `pub` and a `pull` gate appears with its number and the time.
#[test]
fn messages_are_observed_with_number_and_time() {
    on_each_transport(|system| {
        let (mut left, mut right) = start_twins(&system);
        let mut published = observe(&system, "left.values.tap");
        let mut pulled = observe(&system, "left.jobs_in.tap");
        let before = now();
        left.ask("publish 1 4", "published");
        right.ask("push 1 4", "pushed");
        left.ask("jobs 3", "1..4");
        for tap in [&mut published, &mut pulled] {
            let observed = [tap.next(), tap.next(), tap.next()];
            let after = now();
            for (observed, value) in observed.iter().zip(1..) {
                assert_eq!(observed.payload, [8, value]);
                assert_eq!((observed.kind, observed.call_id), (MESSAGE, 0));
                assert!((before..=after).contains(&observed.sent), "{before} {observed:?} {after}");
            }
            let first = observed[0].sequence;
            assert_eq!(observed.map(|observed| observed.sequence), [first, first + 1, first + 2]);
        }
    });
}

/// The promise: requests and replies are visible at a `rep` gate, and belong together by their call's id.
#[test]
fn requests_and_replies_are_observed_with_their_call() {
    on_each_transport(|system| {
        let (_left, mut right) = start_twins(&system);
        let mut tap = observe(&system, "left.answer.tap");
        let mut calls = Vec::new();
        for value in [5, 6] {
            right.ask(&format!("call {value}"), &(2 * value).to_string());
            let (request, reply) = (tap.next(), tap.next());
            assert_eq!((request.kind, request.payload), (REQUEST, vec![8, value]));
            assert_eq!((reply.kind, reply.payload), (REPLY, vec![8, 2 * value]));
            assert_eq!(request.call_id, reply.call_id);
            calls.push(request.call_id);
        }
        assert_ne!(calls[0], calls[1]);
    });
}

/// The promise: an observer that stops reading delays nobody, costs bounded memory, and sees a gap when it reads again.
#[test]
fn an_observer_that_stops_reading_delays_nobody() {
    let system = System::new();
    let (mut left, mut right) = start_twins(&system);
    let mut stalled = ["values", "jobs_in", "answer"].map(|gate| observe(&system, &format!("left.{gate}.tap")));
    let before = left.memory();
    for round in 0..100 {
        let (from, to) = (round * 100, round * 100 + 100);
        left.ask(&format!("publish {from} {to} 2000"), "published");
        right.ask(&format!("values {}", to - 1), &format!("{from}..{to}"));
        right.ask(&format!("push {from} {to} 2000"), "pushed");
        left.ask(&format!("jobs {}", to - 1), &format!("{from}..{to}"));
        right.ask(&format!("call {round}"), &(2 * round).to_string());
    }
    let growth = left.memory().saturating_sub(before);
    // 16 MiB for each of the two that are sent long messages.
    assert!(growth < 40 << 10, "{growth} KiB for observers that do not read");
    wait_until("the figures tell what was dropped", || {
        ComponentStats::read(&dir_of(&system, "twins"), "left").is_some_and(|found| {
            let of_observers =
                |gate: &GateFigures| gate.tap_dropped > 0 && gate.dropped_for_observers == gate.tap_dropped;
            // Those of `values` and `jobs_in`; what was called is short.
            found.gates.iter().filter(|gate| of_observers(gate)).count() == 2
        })
    });
    for tap in &mut stalled[..2] {
        let first = tap.next().sequence;
        let mut next = first + 1;
        while tap.next().sequence == next {
            next += 1;
        }
        assert!(next < first + 10_000, "nothing was dropped for an observer that does not read");
    }
}

/// The promise: taps cost nothing that lasts. Observers that come and go leave no descriptors behind.
#[test]
fn observers_come_and_go() {
    let system = System::new();
    let (mut left, mut right) = start_twins(&system);
    let before = left.descriptors();
    for round in 0..100 {
        let mut tap = observe(&system, "left.values.tap");
        left.ask(&format!("publish {round} {} 100", round + 1), "published");
        tap.next();
        right.ask(&format!("values {round}"), &format!("{round}..{}", round + 1));
    }
    scl_tests::wait_until("the observers' descriptors are closed", || left.descriptors() <= before);
}

/// The promise: a tap shows only messages that start with what its observer subscribed to.
#[test]
fn an_observer_gets_what_it_subscribed_to() {
    let system = System::new();
    let mut source = open(&system, "source");
    let mut tap = observe_prefix(&system, "six", "source.readings.tap", b"\x08\x05");
    source.ask("publish 1 10", "published");
    source.ask("publish 5 6", "published");
    assert_eq!([tap.next().payload, tap.next().payload], [[8, 5], [8, 5]]);
}

/// A message at a tap.
#[derive(Debug)]
struct Observed {
    payload: Vec<u8>,
    sequence: u64,
    sent: u64,
    call_id: u64,
    kind: u8,
}

struct Tap(RawPeer);

impl Tap {
    #[track_caller]
    fn next(&mut self) -> Observed {
        let parts = self.0.message().expect("a message at the tap");
        let [payload, meta] = <[Vec<u8>; 2]>::try_from(parts).expect("two frames");
        assert_eq!(meta.len(), 32);
        assert_eq!(meta[25..], [0; 7]);
        let number = |at: usize| u64::from_le_bytes(meta[at..at + 8].try_into().expect("8 bytes"));
        Observed { payload, sequence: number(0), sent: number(8), call_id: number(16), kind: meta[24] }
    }
}

fn observe(system: &System, tap: &str) -> Tap {
    observe_prefix(system, "twins", tap, b"")
}

/// Returns once the subscription has taken effect.
fn observe_prefix(system: &System, name: &str, tap: &str, prefix: &[u8]) -> Tap {
    let mut peer = RawPeer::join(&system.address(name, tap), "SUB");
    peer.send(&[subscribe(prefix), command("PING", b"\0\0subscribed")].concat()).expect("sent");
    assert_eq!(peer.frame().expect("an answer").body, b"\x04PONGsubscribed");
    Tap(peer)
}

fn start_twins(system: &System) -> (Process, Process) {
    let mut twins = ["left", "right"].map(|component| system.start(TWIN, &[component, "current_thread", "wait"]));
    for twin in &mut twins {
        twin.expect("open");
        twin.expect("ready");
    }
    twins.into()
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).expect("a time after 1970").as_nanos() as u64
}
