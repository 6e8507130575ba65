//! A hundred restarts of each side: the peer reconnects each time, and leaks no descriptors.

use crate::programs::open;
use scl_tests::{Process, System};

const RESTARTS: u64 = 100;

#[test]
fn a_source_survives_restarts_of_its_sink() {
    let system = System::new();
    let mut source = open(&system, "source");
    for round in 0..RESTARTS {
        let mut sink = open(&system, "sink");
        exchange(&mut source, &mut sink, round);
        sink.kill();
        // What is sent before the source has noticed is on its way to the dead sink and lost with it.
        source.ask("alone", "alone");
    }
    let mut sink = open(&system, "sink");
    exchange(&mut source, &mut sink, RESTARTS);
}

#[test]
fn a_sink_survives_restarts_of_its_source() {
    let system = System::new();
    let mut sink = open(&system, "sink");
    let mut descriptors = Vec::new();
    for round in 0..RESTARTS {
        let mut source = open(&system, "source");
        exchange(&mut source, &mut sink, round);
        descriptors.push(sink.descriptors());
        source.kill();
    }
    let (first, last) = (descriptors[1], descriptors[descriptors.len() - 1]);
    assert!(last <= first + 8, "each restart leaks descriptors: {descriptors:?}");
}

fn exchange(source: &mut Process, sink: &mut Process, round: u64) {
    let (from, to) = (round * 10, round * 10 + 10);
    source.ask(&format!("publish {from} {to}"), "published");
    sink.tell(&format!("receive_up_to {}", to - 1));
    let received = sink.next_line();
    assert!(received.ends_with(&format!("..{to}")), "{received}");
    source.ask(&format!("push {from} {to}"), "pushed");
    sink.ask("pull 10", &format!("{from}..{to}"));
    sink.tell("serve 1");
    source.ask(&format!("call {round}"), &(2 * round).to_string());
    sink.expect("served");
}
