//! No descriptors left: a clear error when opening; later, no busy waiting, and recovery when some come free.

use scl_tests::{HANGS, Place, Process};
use std::io::ErrorKind;
use std::os::unix::net::UnixStream;

const PEER: &str = env!("CARGO_BIN_EXE_peer");

#[test]
fn a_component_that_gets_no_descriptors_says_so() {
    let place = Place::new("ipc");
    let mut sink = place.start_after("ulimit -n 12", PEER, &["sink"]);
    let said = sink.says_sometime("failed");
    assert!(said.contains("gate `sink.") && said.contains("cannot be opened"), "it names who: {said}");
    sink.says_sometime("Too many open files");
}

#[test]
fn a_pull_and_a_rep_gate_turn_away_what_they_cannot_take_and_recover() {
    crowd_out("sink", &["sink.jobs.", "sink.answer."], |place, sink| {
        let mut source = open(place, "source");
        source.does("push 0 10", "pushed");
        sink.does("pull 10", "0..10");
        sink.tell("serve 1");
        source.does("call 4", "8");
        sink.says("served");
    });
}

#[test]
fn a_pub_gate_turns_away_what_it_cannot_take_and_recovers() {
    crowd_out("source", &["source.readings--sink.readings."], |place, source| {
        source.does("publish 0 10", "published");
        let mut sink = open(place, "sink");
        sink.does("receive 10", "0..10");
    });
}

/// Fills up a program's descriptors with silent connections, sees that it does not spin, then lets go of them.
fn crowd_out(component: &str, endpoints: &[&str], works: impl Fn(&Place, &mut Process)) {
    let place = Place::new("ipc");
    let mut crowded = place.start_after("ulimit -n 60", PEER, &[component]);
    crowded.says("open");
    for endpoint in endpoints {
        let socket = place.socket("six", endpoint);
        let connect = || UnixStream::connect(&socket).expect("connected");
        let crowd: Vec<UnixStream> = (0..100).map(|_| connect()).collect();
        // As many as fit; the last ones were closed again.
        crowd.iter().rev().take(30).for_each(wait_until_closed);
        assert_idle(&mut crowded);
        drop(crowd);
        while crowded.descriptors() > 50 {
            std::thread::yield_now();
        }
    }
    works(&place, &mut crowded);
}

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

/// Reads until the other side closes.
fn wait_until_closed(stream: &UnixStream) {
    use std::io::Read;
    stream.set_read_timeout(Some(HANGS)).expect("a limit");
    let mut greeting = [0; 64];
    loop {
        match { stream }.read(&mut greeting) {
            Ok(0) => return,
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::WouldBlock => panic!("it was not turned away"),
            Err(_) => return,
        }
    }
}

/// A program that waits is asleep when it is asked something, so each question takes it a change of context that it
/// makes by itself; one that spins is awake already.
fn assert_idle(process: &mut Process) {
    const QUESTIONS: u64 = 200;
    let before = process.sleeps();
    for _ in 0..QUESTIONS {
        process.does("idle?", "unknown command `idle?`");
    }
    let slept = process.sleeps() - before;
    // A question may come in the moment between an answer and the sleep, so not all of them are demanded.
    assert!(slept * 2 > QUESTIONS, "it slept {slept} times while it was asked {QUESTIONS} questions one by one");
}
