//! What `scl bw` says about gates whose messages are known.

use crate::rover::Rover;
use crate::ticker::{Reports, Ticker};

#[test]
fn bytes_and_sizes_are_exact() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["bw", "sensor.ticks"]);
    ticker.tick_until(|| reports.next()["messages"] != 0);
    reports.wait_for_silence();
    ticker.send(1000);
    // Of 10 to 19 bytes in turn.
    assert_eq!(reports.sum_until_silence(["messages", "bytes"]), [1000, 14_500]);
    let total = reports.interrupt();
    assert_eq!((&total["size"]["min"], &total["size"]["max"]), (&10.into(), &19.into()));
    assert!(total["bytes_per_second"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_table_lists_all_gates_of_the_system() {
    let rover = Rover::start();
    let text = rover.measure(&["bw", "--once"]);
    let header: Vec<_> = text.lines().next().unwrap().split_whitespace().collect();
    assert_eq!(header, ["GATE", "BANDWIDTH", "MESSAGES", "MIN", "MEAN", "MAX"]);
    let image = text.lines().find(|line| line.starts_with("sensor.image ")).unwrap();
    assert!(image.ends_with("1.00 KiB  1.00 KiB  1.00 KiB"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}
