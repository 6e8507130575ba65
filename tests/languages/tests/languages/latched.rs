//! A latched publisher in each language, and subscribers in every language that start late and again.

use super::program::{ALL, Program, SCL};
use scl_tests::{System, on_each_transport};

/// The promise: the last message is there at once in every language, and SCL's say that it is latched, and how old it
/// is.
#[test]
fn late_and_restarted_subscribers_in_every_language_get_the_last_message() {
    for left in SCL {
        for right in ALL {
            check(&System::new(), left, right);
        }
    }
}

/// The promise: that holds on TCP, too.
#[test]
fn that_holds_on_each_transport() {
    on_each_transport(|system| {
        for (left, right) in SCL.into_iter().zip(SCL.into_iter().cycle().skip(1)) {
            check(&system, left, right);
        }
    });
}

#[track_caller]
fn check(system: &System, left: super::program::Language, right: super::program::Language) {
    let mut left = Program::start(system, left, "left");
    left.ask("send pub_latched_bytes 0 3", "sent");
    let mut first = Program::start(system, right, "right");
    first.ask("take sub_latched_bytes 3", "0..3");
    expect_age(&mut first, "latched");
    // A plain program in the component's place leaves what waits for the component.
    let again = if first.is_plain() { "0..3" } else { "2..3" };
    let count = if first.is_plain() { 3 } else { 1 };
    first.kill();
    left.ask("gone pub_latched_bytes", "gone");
    let mut second = Program::start(system, right, "right");
    second.ask(&format!("take sub_latched_bytes {count}"), again);
    expect_age(&mut second, "latched");
    left.ask("send pub_latched_bytes 3 4", "sent");
    second.ask("take sub_latched_bytes 1", "3..4");
    expect_age(&mut second, "new");
    left.end();
    second.end();
}

#[track_caller]
fn expect_age(right: &mut Program, expected: &str) {
    if !right.is_plain() {
        right.ask("age sub_latched_bytes", expected);
    }
}
