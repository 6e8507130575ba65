//! Each kind of peer stopped (SIGSTOP) while messages flow, and continued: nothing is lost, the others go on.
//! A stopped subscriber is in `six_kinds.rs`.

use scl_tests::{Place, Process};

const PEER: &str = env!("CARGO_BIN_EXE_peer");

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

#[test]
fn a_publisher_that_stands_still_goes_on_where_it_was() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    source.tell("lossless 0 20000 500");
    sink.does("receive_lossless 100", "0..100");
    source.stop();
    source.go_on();
    sink.does("receive_lossless 19900", "100..20000");
    source.says("published");
}

#[test]
fn a_replier_that_stands_still_answers_when_it_goes_on() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    sink.stop();
    source.tell("call 5");
    sink.tell("serve 2");
    sink.go_on();
    source.says("10");
    source.does("call 6", "12");
    sink.says("served");
    sink.says("served");
}

#[test]
fn a_puller_that_stands_still_makes_the_pusher_wait_and_gets_everything() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    let mut watcher = open(&place, "watcher");
    source.does("peers 3", "peers");
    source.does("push 0 10", "pushed");
    sink.does("pull 10", "0..10");
    sink.stop();
    // The other gates of the pusher go on meanwhile: what fits into the queue is pushed, and published to others.
    source.does("push 10 500 1000", "pushed");
    source.does("publish 0 500", "published");
    watcher.does("receive 500", "0..500");
    source.tell("push 500 5000 10000");
    sink.go_on();
    sink.does("pull 4990", "10..5000");
    source.says("pushed");
    sink.does("receive 500", "0..500");
}
