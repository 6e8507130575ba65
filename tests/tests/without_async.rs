//! Programs without async: what they send is on its way when the call returns, and whoever comes late is served although
//! the program never waits.

use scl_tests::{Place, Process, on_each_transport};

const PEER: &str = env!("CARGO_BIN_EXE_peer");
const PLAIN: &str = env!("CARGO_BIN_EXE_plain");

fn open(place: &Place, program: &str, component: &str) -> Process {
    let mut process = place.start(program, &[component]);
    process.says("open");
    process
}

#[test]
fn a_publisher_that_never_waits_serves_who_comes_late() {
    on_each_transport(|place| {
        let mut source = open(&place, PLAIN, "source");
        source.tell("publish_for_ever");
        for _ in 0..3 {
            let mut sink = open(&place, PEER, "sink");
            sink.tell("receive 1000");
            let received = sink.line();
            assert!(!received.contains("error"), "{received}");
            sink.kill();
        }
    });
}

#[test]
fn what_is_pushed_is_on_its_way_when_the_call_returns() {
    on_each_transport(|place| {
        let mut source = open(&place, PLAIN, "source");
        let mut sink = open(&place, PEER, "sink");
        source.does("ready", "ready");
        source.tell("push_and_stop");
        sink.does("pull 1", "7..8");
    });
}

#[test]
fn a_reply_is_on_its_way_when_the_call_returns() {
    on_each_transport(|place| {
        let mut source = open(&place, PEER, "source");
        let _sink = open(&place, PLAIN, "sink");
        source.does("call 4", "8");
    });
}

#[test]
fn closing_hands_over_everything() {
    on_each_transport(|place| {
        let mut source = open(&place, PLAIN, "source");
        let mut sink = open(&place, PEER, "sink");
        source.does("ready", "ready");
        source.tell("push_and_close");
        sink.does("pull 1000", "0..1000");
        let (status, said) = source.ends();
        assert!(status.success(), "{said:?}");
    });
}
