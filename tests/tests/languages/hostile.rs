//! Bytes that are no message, from plain programs.

use super::program::{PLAIN, Program, SCL};
use scl_tests::System;

/// The promise: what cannot be decoded is reported and counted, and the next message arrives.
#[test]
fn an_undecodable_message_is_reported_and_the_next_one_arrives() {
    for left in PLAIN {
        for right in SCL {
            let system = System::new();
            let mut left = Program::start(&system, left, "left");
            let mut right = Program::start(&system, right, "right");
            left.ask("ready 60000", "ready");
            for (sends, takes) in [("pub_protobuf", "sub_protobuf"), ("push_protobuf", "pull_protobuf")] {
                left.ask(&format!("garbage {sends}"), "sent");
                left.ask(&format!("send {sends} 5 6"), "sent");
                right.tell(&format!("take {takes} 2"));
                right.expect("undecodable");
                right.expect("5..6");
                right.expect_account(takes, "0 2 1");
            }
            // Its sender gets no reply.
            left.ask("garbage req_protobuf", "sent");
            right.tell("serve rep_protobuf 1");
            right.expect("undecodable");
            right.expect("");
            right.expect_account("rep_protobuf", "0 1 1");
            left.kill();
            right.end();
        }
    }
}
