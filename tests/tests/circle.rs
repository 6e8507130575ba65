//! The circles that the checker refuses as deadlocks stop in fact, and what it proposes keeps them moving.

use crate::programs::CIRCLE;
use scl_tests::{Process, on_each_transport, wait_until};

/// More than both queues, and what may be on the way between them, can hold.
const MANY: usize = 20_000;

/// Sends as many messages as possible without waiting.
fn send(component: &mut Process, most: usize) -> usize {
    component.tell(&format!("send {most}"));
    let line = component.next_line();
    line.trim_start_matches("sent ").parse().expect("a number")
}

#[test]
fn two_publishers_that_wait_for_each_other_stop() {
    on_each_transport(|system| {
        let mut pair = ["left", "right"].map(|component| system.start(CIRCLE, &[component]));
        let mut sent = [0; 2];
        wait_until("both have to wait", || {
            let now = [0, 1].map(|at| send(&mut pair[at], MANY));
            sent = [0, 1].map(|at| sent[at] + now[at]);
            now == [0; 2]
        });
        assert!(sent.iter().all(|&sent| 0 < sent && sent < MANY), "{sent:?}");
        // The only way on: one of them receives, which it does not while it waits.
        pair[1].tell(&format!("take {}", sent[0]));
        pair[1].expect(&format!("took {}", sent[0]));
        wait_until("there is room again", || send(&mut pair[0], 1) == 1);
    });
}

#[test]
fn one_queue_that_drops_keeps_both_moving() {
    on_each_transport(|system| {
        let mut pair = ["free_left", "free_right"].map(|component| system.start(CIRCLE, &[component]));
        let mut sent = 0;
        wait_until("`free_right` has to wait", || {
            let now = send(&mut pair[1], MANY);
            sent += now;
            now == 0
        });
        assert_eq!(send(&mut pair[0], MANY), MANY, "`free_left` never waits");
        pair[0].tell(&format!("take {sent}"));
        pair[0].expect(&format!("took {sent}"));
        wait_until("`free_right` can go on", || send(&mut pair[1], 1) == 1);
    });
}
