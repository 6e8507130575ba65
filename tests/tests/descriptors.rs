//! No descriptors left: a clear error when opening; later, no busy waiting, and recovery when some become free.

use crate::programs::{PEER, open};
use scl_tests::{Process, RawPeer, System, on_each_transport, wait_until};

#[test]
fn a_component_that_gets_no_descriptors_fails_with_a_clear_error() {
    let exit = System::new().start_after("ulimit -n 12", PEER, &["sink"]).wait_for_exit();
    assert!(!exit.status.success());
    let text = exit.text();
    assert!(text.contains("sink") && text.contains("cannot be opened"), "{text}");
    assert!(text.contains("Too many open files"), "{text}");
}

#[test]
fn pull_and_rep_gates_turn_away_what_they_cannot_accept_and_recover() {
    exhaust("sink", &["sink.jobs.", "sink.answer."], |system, sink| {
        let mut source = open(system, "source");
        source.ask("push 0 10", "pushed");
        sink.ask("pull 10", "0..10");
        sink.tell("serve 1");
        source.ask("call 4", "8");
        sink.expect("served");
    });
}

#[test]
fn a_pub_gate_turns_away_what_it_cannot_accept_and_recovers() {
    exhaust("source", &["source.readings--sink.readings.", "source.readings.tap"], |system, source| {
        source.ask("publish 0 10", "published");
        let mut sink = open(system, "sink");
        sink.ask("receive 10", "0..10");
    });
}

/// Uses up a program's descriptors with silent connections, and asserts that it does not spin; then closes them.
fn exhaust(component: &str, endpoints: &[&str], works: impl Fn(&System, &mut Process)) {
    on_each_transport(|system| {
        let mut victim = system.start_after("ulimit -n 60", PEER, &[component]);
        victim.expect("open");
        let before = victim.descriptors();
        for endpoint in endpoints {
            let address = system.address("six", endpoint);
            let mut strangers: Vec<RawPeer> = (0..100).map(|_| RawPeer::connect(&address)).collect();
            // About 40 of them fit.
            wait_until("those that do not fit are closed", || {
                strangers.iter_mut().filter_map(|stranger| stranger.is_closed().then_some(())).count() >= 50
            });
            victim.assert_idle();
            drop(strangers);
            wait_until("the descriptors are free again", || victim.descriptors() <= before + 2);
        }
        works(&system, &mut victim);
    });
}
