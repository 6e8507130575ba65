//! What `scl delay` says about gates whose messages are known.

use crate::rover::Rover;
use crate::ticker::{Reports, Ticker};

#[test]
fn delays_are_small_and_of_every_message() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["delay", "sensor.ticks"]);
    ticker.tick_until(|| reports.next()["messages"] != 0);
    reports.wait_for_silence();
    ticker.send(1000);
    assert_eq!(reports.sum_until_silence(["messages"]), [1000]);
    let total = reports.interrupt();
    let delay = |key: &str| total["delay_ms"][key].as_f64().unwrap();
    // One clock gave both times, so nothing is seen before it was sent.
    assert!(0.0 <= delay("min") && delay("min") <= delay("p50") && delay("p50") <= delay("max"), "{total}");
    assert_eq!(total["negative"], 0);
}

#[test]
fn a_table_has_a_line_for_each_gate() {
    let rover = Rover::start();
    let text = rover.measure(&["delay", "sensor.measurements", "controller.commands", "--once"]);
    let words: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(words[0], ["GATE", "MESSAGES", "MIN", "P50", "P99", "MAX", "MEAN"]);
    assert_eq!((words[1][0], words[2][0], words.len()), ("sensor.measurements", "controller.commands", 3));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn a_gate_must_be_named() {
    assert!(Rover::stopped().error(&["delay"], 2).contains("<GATES>"));
}
