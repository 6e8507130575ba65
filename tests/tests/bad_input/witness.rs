//! Watches `left` during and after an attack.

use super::end::End;
use crate::programs::TWIN;
use rustix::process::{Resource, getrlimit, setrlimit};
use scl_tests::{Process, RawPeer, System, wait_until};
use std::sync::{Mutex, PoisonError};

/// How much memory an attack may cost, in KiB. Each end may keep a few buffers of 64 KiB for each of 64 strangers.
const GROWTH: u64 = 64 << 10;

/// Runs an attack against each end of `left`. It returns connections that stay open while `left` is watched.
pub(crate) fn withstands(attack: impl Fn(&End) -> Vec<RawPeer>) {
    let system = System::new();
    watch(&system, system.start(TWIN, &["left", "current_thread"]), attack, true);
}

/// [`withstands`] for a program with few descriptors. If the strangers use them up for good, they leave before the good
/// peer comes.
pub(crate) fn withstands_with_descriptors(descriptors: u64, use_them_up: bool, attack: impl Fn(&End) -> Vec<RawPeer>) {
    // Two such attacks at once would need more descriptors than this process may have.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    raise_own_limit();
    let system = System::new();
    let left = system.start_after(&format!("ulimit -n {descriptors}"), TWIN, &["left", "current_thread"]);
    watch(&system, left, attack, !use_them_up);
}

fn watch(system: &System, mut left: Process, attack: impl Fn(&End) -> Vec<RawPeer>, may_stay: bool) {
    left.expect("open");
    let ends = End::all(system);
    assert_eq!(ends.len(), 9, "three gates that listen, their taps, and three gates that connect");
    let before = left.memory();
    let connections: Vec<(&End, Vec<RawPeer>)> = ends.iter().map(|end| (end, attack(end))).collect();
    left.assert_idle();
    assert_bounded(&left, before);
    // Strangers that connected stay; those in the place of the peer have to leave it.
    let (stay, leave): (Vec<_>, Vec<_>) = connections.into_iter().partition(|(end, _)| may_stay && end.listens());
    let stay: Vec<Vec<RawPeer>> = stay.into_iter().map(|(_, connections)| connections).collect();
    drop(leave);
    drop(ends);
    let mut right = system.start(TWIN, &["right", "current_thread", "wait"]);
    right.expect("open");
    right.expect("ready");
    until_served(&mut left, &mut right);
    exchange(&mut left, &mut right, 1_000_000);
    drop(stay);
    exchange(&mut left, &mut right, 2_000_000);
    left.assert_idle();
    assert_bounded(&left, before);
    let exit = left.wait_for_exit();
    assert!(exit.status.success() && !exit.text().contains("panicked"), "{exit:?}");
}

/// A publisher learns of a subscriber a moment after that is ready, and what it publishes before reaches nobody.
fn until_served(publisher: &mut Process, subscriber: &mut Process) {
    subscriber.tell("values 0");
    wait_until("the subscriber receives", || {
        publisher.ask("publish 0 1", "published");
        subscriber.try_next_line().is_some()
    });
}

/// Messages of every kind in both directions.
fn exchange(left: &mut Process, right: &mut Process, first: u64) {
    send_all_kinds(left, right, first);
    send_all_kinds(right, left, first);
}

fn send_all_kinds(from: &mut Process, to: &mut Process, first: u64) {
    let (last, end) = (first + 99, first + 100);
    for (send, sent, received) in [("publish", "published", "values"), ("push", "pushed", "jobs")] {
        from.ask(&format!("{send} {first} {end}"), sent);
        to.tell(&format!("{received} {last}"));
        let line = to.next_line();
        // What strangers sent before may have been a message by chance, and the first one may have come more than once.
        assert!(line.ends_with(&format!("{first}..{end}")), "{received}: {line}");
    }
    from.ask(&format!("call {first}"), &(2 * first).to_string());
}

#[track_caller]
fn assert_bounded(left: &Process, before: u64) {
    let growth = left.memory().saturating_sub(before);
    assert!(growth < GROWTH, "the attack costs {growth} KiB");
}

/// The attackers in this process need more descriptors than usual.
fn raise_own_limit() {
    let limit = getrlimit(Resource::Nofile);
    setrlimit(Resource::Nofile, rustix::process::Rlimit { current: limit.maximum, maximum: limit.maximum })
        .expect("more descriptors");
    assert!(
        limit.maximum.is_none_or(|maximum| maximum >= 16_000),
        "this test needs `ulimit -Hn` of at least 16000: {limit:?}"
    );
}
