//! Programs without async: a message is on its way when the call returns, and late peers are served although the
//! program never waits.

use crate::programs::{PEER, PLAIN, open_with};
use scl_tests::on_each_transport;

#[test]
fn a_publisher_that_never_waits_serves_late_subscribers() {
    on_each_transport(|system| {
        let mut source = open_with(&system, PLAIN, "source");
        source.tell("publish_forever");
        for _ in 0..3 {
            let mut sink = open_with(&system, PEER, "sink");
            sink.tell("receive 1000");
            let received = sink.next_line();
            assert!(!received.contains("error"), "{received}");
            sink.kill();
        }
    });
}

#[test]
fn a_pushed_message_is_on_its_way_when_the_call_returns() {
    on_each_transport(|system| {
        let mut source = open_with(&system, PLAIN, "source");
        let mut sink = open_with(&system, PEER, "sink");
        source.ask("ready", "ready");
        source.tell("push_and_stop");
        source.wait_until_stopped();
        sink.ask("pull 1", "7..8");
    });
}

#[test]
fn a_reply_is_on_its_way_when_the_call_returns() {
    on_each_transport(|system| {
        let mut source = open_with(&system, PEER, "source");
        let _sink = open_with(&system, PLAIN, "sink");
        source.ask("call 4", "8");
    });
}

#[test]
fn closing_hands_over_what_was_pushed() {
    on_each_transport(|system| {
        let mut source = open_with(&system, PLAIN, "source");
        let mut sink = open_with(&system, PEER, "sink");
        source.ask("ready", "ready");
        source.tell("push_and_close");
        sink.ask("pull 1000", "0..1000");
        let exit = source.wait_for_exit();
        assert!(exit.status.success(), "{exit:?}");
    });
}
