//! Every call, with a peer in Rust.

use crate::programs::{Build, Program, expect_success, on_each_build};
use scl::bytes::Bytes;
use scl_tests::on_each_transport;
use std::time::Duration;

/// Far longer than anything takes.
const LONG: Duration = Duration::from_secs(300);

fn bytes(text: &str) -> Bytes {
    Bytes::copy_from_slice(text.as_bytes())
}

#[test]
fn messages_go_both_ways() {
    on_each_transport(|system| {
        let program = Program::new(system, Build::Plain);
        let (mut peer, mut c) = (program.peer(), program.commands());
        c.ask("ready 60000000000", "");
        c.ask("connected out", "yes");

        let mut out = peer.subscriber("out").unwrap();
        for call in ["send out -1", "send out 0", "send out 1000000000", "send_in_place out -1"] {
            c.ask(&format!("{call} hello from C"), "");
            assert_eq!(out.recv_blocking().unwrap(), "hello from C");
        }
        c.ask("send out -1", "");
        assert_eq!(out.recv_blocking().unwrap(), "");

        let mut values = peer.publisher("values").unwrap();
        for call in ["recv values -1", "recv values 60000000000", "into values -1 64"] {
            values.send_blocking(&bytes("hello from Rust")).unwrap();
            c.ask(call, "hello from Rust");
        }

        let (mut jobs, mut work) = (peer.puller("jobs").unwrap(), peer.pusher("work").unwrap());
        c.ask("send jobs -1 a job", "");
        assert_eq!(jobs.recv_blocking().unwrap(), "a job");
        work.send_blocking(&bytes("more work")).unwrap();
        c.ask("recv work -1", "more work");
        expect_success(c);
    });
}

#[test]
fn requests_are_answered_both_ways() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        let mut questions = peer.replier("question").unwrap();
        for call in ["call question -1 why", "call question 60000000000 why"] {
            c.tell(call);
            let question = questions.recv_blocking().unwrap();
            assert_eq!(*question, "why");
            question.reply(&bytes("because")).unwrap();
            c.expect("because");
        }

        let mut answers = peer.requester("answer").unwrap();
        for reply in ["reply 42", "reply_in_place 42"] {
            std::thread::scope(|scope| {
                let asking = scope.spawn(|| answers.call_blocking(&bytes("how much")));
                c.ask("take answer -1", "how much");
                c.ask(reply, "");
                assert_eq!(asking.join().unwrap().unwrap(), "42");
            });
        }
        // One that is never answered, and one that is taken but freed.
        c.ask("take answer 0", "SCL_NOTHING: no message has arrived yet");
        std::thread::scope(|scope| {
            let asking = scope.spawn(|| answers.call_blocking(&bytes("nothing")));
            c.ask("take answer -1", "nothing");
            c.ask("drop", "");
            // Ends the call, which has no other end than its time limit.
            expect_success(c);
            assert!(asking.join().unwrap().is_err());
        });
    });
}

#[test]
fn the_newest_message_replaces_older_ones() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        c.ask("latest values", "SCL_NOTHING: no message has arrived yet");
        let mut values = peer.publisher("values").unwrap();
        for value in ["1", "2", "3"] {
            values.send_blocking(&bytes(value)).unwrap();
        }
        c.ask("wait -1 values", "1");
        // The first may arrive before the others.
        let mut seen = String::new();
        while seen != "3" {
            c.tell("latest values");
            seen = c.next_line();
        }
        c.ask("latest values", "SCL_NOTHING: no message has arrived yet");
        expect_success(c);
    });
}

#[test]
fn time_limits_are_kept_and_explained() {
    on_each_build(|program| {
        let mut c = program.commands();
        c.ask("recv values 0", "SCL_NOTHING: no message has arrived yet");
        c.ask(
            "recv values 1000000",
            "SCL_TIMEOUT: gate `program.values` received nothing from `peer.values` within 1ms: `peer.values` is not running",
        );
        c.tell("call question 1000000 why");
        let late = c.next_line();
        assert!(late.starts_with("SCL_TIMEOUT: gate `program.question` got no reply from `peer.question`"), "{late}");
        assert!(late.ends_with("`peer.question` is not running"), "{late}");
        c.tell("take answer 1000000");
        c.expect_containing("SCL_TIMEOUT: gate `program.answer` received nothing");
        c.tell("ready 1000000");
        c.expect_containing("SCL_TIMEOUT: component `program` is not ready after ");
        c.tell("wait 1000000 values work");
        c.expect_containing("SCL_TIMEOUT: component `program` received nothing at `program.values` or `program.work`");
        c.ask("wait 0 values work", "SCL_NOTHING: no message has arrived yet");

        // A peer that takes nothing: its queue and the way to it fill up.
        let _peer = program.peer();
        c.ask("ready 60000000000", "");
        let text = "x".repeat(1000);
        let mut first_failure = |limit: &str| {
            loop {
                c.tell(&format!("send lossless {limit} {text}"));
                let line = c.next_line();
                if !line.is_empty() {
                    break line;
                }
            }
        };
        let full = first_failure("0");
        assert!(full.starts_with("SCL_FULL: gate `program.lossless` would have to wait: the queue of `peer.lossless`"));
        // Some of what was sent may still move on into the sockets.
        let late = first_failure("1000000");
        assert!(late.starts_with("SCL_TIMEOUT: gate `program.lossless` did not send the message within 1ms"), "{late}");
        c.tell("close 1000000");
        let left = c.next_line();
        assert!(left.starts_with("SCL_NOT_FLUSHED: component `program` was closed after "), "{left}");
        assert!(left.ends_with(" messages from `program.lossless` to `peer.lossless`"), "{left}");
        expect_success(c);
    });
}

#[test]
fn several_gates_are_waited_for_at_once() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        let (mut values, mut work) = (peer.publisher("values").unwrap(), peer.pusher("work").unwrap());
        c.tell("wait -1 values newest work answer");
        work.send_blocking(&bytes("a job")).unwrap();
        c.expect("4");
        c.ask("wait 0 values work", "2");
        values.send_blocking(&bytes("a value")).unwrap();
        c.ask("wait -1 values", "1");
        c.ask("wait -1 values work", "3");
        c.ask("recv values 0", "a value");
        c.ask("recv work 0", "a job");
        c.ask("wait 0 values work", "SCL_NOTHING: no message has arrived yet");
        expect_success(c);
    });
}

#[test]
fn a_buffer_too_small_loses_nothing() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        let mut values = peer.publisher("values").unwrap();
        for value in ["first message", "second"] {
            values.send_blocking(&bytes(value)).unwrap();
        }
        c.ask("into values -1 5", "13 needed");
        c.ask("wait 0 values", "1");
        c.ask("into values 0 0", "13 needed");
        c.ask("into values 0 13", "first message");
        c.ask("into values -1 1", "6 needed");
        c.ask("recv values 0", "second");
        values.send_blocking(&bytes("third")).unwrap();
        c.ask("into values -1 1", "5 needed");
        c.ask("latest values", "third");
        expect_success(c);
    });
}

#[test]
fn counts_are_json() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        c.ask("ready 60000000000", "");
        c.tell("stats values");
        let empty = c.next_line();
        assert!(empty.contains(r#""received":0"#) && empty.contains(r#""idle_ns":null"#), "{empty}");
        let mut out = peer.subscriber("out").unwrap();
        c.ask("send out -1 hello", "");
        assert_eq!(out.recv_blocking().unwrap(), "hello");
        c.tell("stats out");
        let stats = c.next_line();
        for expected in
            [r#""bytes":5"#, r#""published":1"#, r#""peer":"peer.out""#, r#""connected":true"#, r#""peers":1"#]
        {
            assert!(stats.contains(expected), "{expected} in {stats}");
        }
        expect_success(c);
    });
}

#[test]
fn closing_hands_over_and_says_what_is_left() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        let mut out = peer.subscriber("out").unwrap();
        c.ask("send out -1 the last word", "");
        c.ask("close 60000000000", "");
        assert_eq!(out.recv_timeout(LONG).unwrap(), "the last word");
        c.ask("close 0", "SCL_HANDLE: this is not an open component: it was closed, or never was one");
        expect_success(c);
    });
}
