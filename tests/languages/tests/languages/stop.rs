//! SIGTERM while a program waits: it ends with success, and what it has sent arrives.

use super::program::{ALL, FORMATS, Program, SCL};
use scl_tests::System;

/// The promise: SIGTERM ends every waiting call, and the exit code is 0.
#[test]
fn sigterm_ends_a_program_that_waits() {
    for language in SCL {
        for (component, waits) in [
            ("right", "take sub_protobuf 1"),
            ("right", "take pull_json 1"),
            ("right", "serve rep_bytes 1"),
            ("left", "call req_protobuf 0 1"),
            ("left", "send push_bytes 0 2000"),
        ] {
            let system = System::new();
            let mut program = Program::start(&system, language, component);
            program.tell(waits);
            let exit = program.terminate();
            assert_eq!(exit.code(), 0, "{language:?} after `{waits}`: {exit:?}");
        }
    }
}

/// The promise: a program that is told to stop hands over what it has sent.
#[test]
fn what_was_sent_before_sigterm_arrives() {
    for left in SCL {
        for right in ALL {
            let system = System::new();
            let mut left = Program::start(&system, left, "left");
            let mut right = Program::start(&system, right, "right");
            left.get_ready();
            for format in FORMATS {
                left.ask(&format!("send pub_{format} 0 500"), "sent");
                left.ask(&format!("send push_{format} 0 500"), "sent");
            }
            // Nobody answers.
            left.tell("call req_json 0 1");
            let exit = left.terminate();
            assert_eq!(exit.code(), 0, "{exit:?}");
            for format in FORMATS {
                right.ask(&format!("take sub_{format} 500"), "0..500");
                right.ask(&format!("take pull_{format} 500"), "0..500");
            }
            right.kill();
        }
    }
}
