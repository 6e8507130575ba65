//! Every pattern with every format between every two languages, in whatever order the programs start.

use super::program::{ALL, FORMATS, Program, SCL};
use scl_tests::{System, on_each_transport};

/// The promise: a component may be in any language, and its peers notice no difference.
#[test]
fn every_two_languages_exchange_everything() {
    for left in ALL {
        for right in ALL {
            let system = System::new();
            let mut left = Program::start(&system, left, "left");
            let mut right = Program::start(&system, right, "right");
            exchange(&mut left, &mut right);
            expect_accounts(&mut left, &mut right);
            left.end();
            right.end();
        }
    }
}

/// The promise: that holds on TCP, too.
#[test]
fn every_two_languages_of_scl_exchange_everything_on_each_transport() {
    on_each_transport(|system| {
        for (left, right) in SCL.into_iter().zip(SCL.into_iter().cycle().skip(1)) {
            let mut left = Program::start(&system, left, "left");
            let mut right = Program::start(&system, right, "right");
            exchange(&mut left, &mut right);
            expect_accounts(&mut left, &mut right);
            left.end();
            right.end();
        }
    });
}

/// The promise: what was sent before the receiving program was started waits for it.
#[test]
fn a_receiver_may_start_late() {
    for left in SCL {
        for right in ALL {
            let system = System::new();
            // A program is built when it is first needed, and the request below waits only so long.
            Program::build(right);
            let mut left = Program::start(&system, left, "left");
            for format in FORMATS {
                left.ask(&format!("send pub_{format} 0 50"), "sent");
                left.ask(&format!("send push_{format} 0 50"), "sent");
            }
            left.tell("call req_json 7 9");
            let mut right = Program::start(&system, right, "right");
            right.ask("serve rep_json 2", "7..9");
            left.expect("1007..1009");
            for format in FORMATS {
                right.ask(&format!("take sub_{format} 50"), "0..50");
                right.ask(&format!("take pull_{format} 50"), "0..50");
            }
            left.end();
            right.end();
        }
    }
}

/// The promise: a program that already waits receives what is sent by one that starts later.
#[test]
fn a_sender_may_start_late() {
    for right in ALL {
        for left in ALL {
            let system = System::new();
            let mut right = Program::start(&system, right, "right");
            right.tell("take sub_protobuf 20");
            let mut left = Program::start(&system, left, "left");
            left.get_ready();
            left.ask("send pub_protobuf 0 20", "sent");
            right.expect("0..20");
            right.tell("serve rep_bytes 3");
            left.ask("call req_bytes 0 3", "1000..1003");
            right.expect("0..3");
            left.end();
            right.end();
        }
    }
}

/// Sends a hundred messages over each gate.
#[track_caller]
pub(super) fn exchange(left: &mut Program, right: &mut Program) {
    // A plain publisher is ready when it has its subscriptions.
    right.tell("ready 300000");
    left.get_ready();
    right.expect("ready");
    for format in FORMATS {
        left.ask(&format!("send pub_{format} 0 100"), "sent");
        right.ask(&format!("take sub_{format} 100"), "0..100");
        left.ask(&format!("send push_{format} 0 100"), "sent");
        right.ask(&format!("take pull_{format} 100"), "0..100");
        right.tell(&format!("serve rep_{format} 100"));
        left.ask(&format!("call req_{format} 0 100"), "1000..1100");
        right.expect("0..100");
    }
}

/// Sent, received and rejected after one exchange.
#[track_caller]
fn expect_accounts(left: &mut Program, right: &mut Program) {
    for format in FORMATS {
        left.expect_account(&format!("pub_{format}"), "100 0 0");
        left.expect_account(&format!("push_{format}"), "100 0 0");
        left.expect_account(&format!("req_{format}"), "100 100 0");
        right.expect_account(&format!("sub_{format}"), "0 100 0");
        right.expect_account(&format!("pull_{format}"), "0 100 0");
        right.expect_account(&format!("rep_{format}"), "0 100 0");
    }
}
