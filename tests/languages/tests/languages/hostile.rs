//! Bytes that are no message, from plain programs.

use super::program::{Language, PLAIN, Program, SCL};
use scl_tests::System;

/// The promise: what cannot be decoded is counted and skipped, or reported by a gate with `undecodable: fail`, and the
/// next message arrives.
#[test]
fn an_undecodable_message_is_skipped_or_reported_and_the_next_one_arrives() {
    for left in PLAIN {
        for right in SCL {
            let system = System::new();
            let mut left = Program::start(&system, left, "left");
            let mut right = Program::start(&system, right, "right");
            left.get_ready();
            for format in decoded(right.language) {
                for (sends, takes, fails) in [("pub", "sub", false), ("push", "pull", true)] {
                    left.ask(&format!("garbage {sends}_{format}"), "sent");
                    left.ask(&format!("send {sends}_{format} 5 6"), "sent");
                    right.tell(&format!("take {takes}_{format} {}", if fails { 2 } else { 1 }));
                    if fails {
                        right.expect("undecodable");
                    }
                    right.expect("5..6");
                    right.expect_account(&format!("{takes}_{format}"), "0 2 1");
                }
            }
            // Its sender gets no reply.
            for format in decoded(right.language) {
                left.ask(&format!("garbage req_{format}"), "sent");
                right.tell(&format!("serve rep_{format} 1"));
                right.expect("undecodable");
                right.expect("");
                right.expect_account(&format!("rep_{format}"), "0 1 1");
            }
            left.kill();
            right.end();
        }
    }
}

/// The formats that a language decodes. In C, JSON is text that the program reads itself.
fn decoded(language: Language) -> &'static [&'static str] {
    if language == Language::C { &["protobuf"] } else { &["protobuf", "json"] }
}
