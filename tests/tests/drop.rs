//! The promise: a component may be dropped anywhere, at any time. Nothing panics, hangs or spins, and nothing is left.

use crate::programs::{DROPPER, TWIN};
use scl_tests::System;

const WAYS: [&str; 22] = [
    "inside_its_runtime",
    "in_another_task",
    "in_a_blocking_task",
    "in_a_thread",
    "inside_another_runtime",
    "while_its_runtime_stands_still",
    "after_a_current_thread_runtime",
    "after_a_multi_thread_runtime",
    "after_its_runtime_inside_another",
    "with_a_current_thread_runtime",
    "with_a_multi_thread_runtime",
    "with_a_runtime_in_the_background",
    "with_a_local_set",
    "gate_by_gate",
    "by_a_panic",
    "at_the_end_of_a_thread",
    "unused_after_its_runtime",
    "blocking",
    "blocking_in_a_thread",
    "blocking_inside_a_runtime",
    "blocking_gate_by_gate",
    "at_any_moment",
];

#[test]
fn a_component_with_a_connected_peer_is_dropped_anywhere() {
    let system = System::new();
    let mut right = system.start(TWIN, &["right", "current_thread"]);
    right.expect("open");
    WAYS.iter().for_each(|way| drop_it(&system, way));
}

#[test]
fn a_component_without_a_peer_is_dropped_anywhere() {
    let system = System::new();
    WAYS.iter().for_each(|way| drop_it(&system, way));
}

#[track_caller]
fn drop_it(system: &System, way: &str) {
    let mut dropper = system.start(DROPPER, &[way]);
    let line = dropper.next_line();
    assert_eq!(line, "dropped", "{way}");
    dropper.assert_idle();
    let exit = dropper.wait_for_exit();
    assert!(exit.status.success() && !exit.text().contains("panicked"), "{way}: {exit:?}");
}
