//! No descriptors left: a clear error when opening; later, no busy waiting, and recovery when some come free.

use scl_tests::{Place, Process};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

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
        while !crowd.iter().rev().take(30).all(is_closed) {
            std::thread::yield_now();
        }
        assert_idle(&crowded);
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

fn is_closed(stream: &UnixStream) -> bool {
    use std::io::Read;
    stream.set_nonblocking(true).expect("not blocking");
    let mut greeting = [0; 64];
    loop {
        match { stream }.read(&mut greeting) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(error) => return error.kind() != std::io::ErrorKind::WouldBlock,
        }
    }
}

/// A program that spins uses as much processor time as goes by; one that waits uses none.
fn assert_idle(process: &Process) {
    let (started, before) = (Instant::now(), process.ticks());
    std::thread::sleep(Duration::from_millis(500));
    let used = process.ticks() - before;
    let ticks = started.elapsed().as_millis() as u64 / 10;
    assert!(used * 4 < ticks, "{used} of {ticks} ticks were used while there was nothing to do");
}
