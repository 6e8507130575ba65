//! Killed programs are found again, by programs in any language.

use super::exchange::exchange;
use super::program::{ALL, FORMATS, Program};
use scl_tests::System;

/// The promise: peers reconnect after either side was killed and started again.
#[test]
fn either_side_may_restart() {
    for left in ALL {
        for right in ALL {
            let system = System::new();
            let mut first_left = Program::start(&system, left, "left");
            let mut first_right = Program::start(&system, right, "right");
            exchange(&mut first_left, &mut first_right);
            first_right.kill();
            expect_gone(&mut first_left);
            let mut second_right = Program::start(&system, right, "right");
            exchange(&mut first_left, &mut second_right);
            first_left.kill();
            let mut second_left = Program::start(&system, left, "left");
            exchange(&mut second_left, &mut second_right);
            second_left.end();
            second_right.end();
        }
    }
}

/// Waits until all gates have noticed that the peer is gone, so that nothing is sent to it.
#[track_caller]
fn expect_gone(left: &mut Program) {
    for kind in ["pub", "push", "req"] {
        for format in FORMATS {
            left.ask(&format!("gone {kind}_{format}"), "gone");
        }
    }
}
