//! Each kind of peer paused (SIGSTOP) while messages flow, then resumed: nothing is lost, the others continue.
//! A paused subscriber is in `six_kinds.rs`.

use crate::programs::open;
use scl_tests::System;

#[test]
fn a_paused_publisher_continues_where_it_was() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    source.tell("lossless 0 20000 500");
    sink.ask("receive_lossless 100", "0..100");
    source.pause();
    source.resume();
    sink.ask("receive_lossless 19900", "100..20000");
    source.expect("published");
}

#[test]
fn a_paused_replier_answers_when_it_is_resumed() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    sink.pause();
    source.tell("call 5");
    sink.tell("serve 2");
    sink.resume();
    source.expect("10");
    source.ask("call 6", "12");
    sink.expect("served");
    sink.expect("served");
}

#[test]
fn a_paused_puller_makes_the_pusher_wait_and_gets_everything() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    let mut watcher = open(&system, "watcher");
    source.ask("peers 3", "peers");
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
    sink.pause();
    // The pusher's other gates continue: what fits into the queue is pushed, and others receive what is published.
    source.ask("push 10 500 1000", "pushed");
    source.ask("publish 0 500", "published");
    watcher.ask("receive 500", "0..500");
    source.tell("push 500 5000 10000");
    sink.resume();
    sink.ask("pull 4990", "10..5000");
    source.expect("pushed");
    sink.ask("receive 500", "0..500");
}
