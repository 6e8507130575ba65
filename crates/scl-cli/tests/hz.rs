//! What `scl hz` says about gates whose messages are known.

use crate::rover::Rover;
use crate::system::{SpawnGuarded, kill};
use crate::ticker::{Reports, Ticker};

#[test]
fn every_message_is_counted_once() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["hz", "sensor.ticks"]);
    ticker.tick_until(|| reports.next()["messages"] != 0);
    // From here on everything that is sent is known.
    reports.wait_for_silence();
    ticker.send(5000);
    let [messages, lost] = reports.sum_until_silence(["messages", "lost"]);
    assert_eq!((messages, lost), (5000, 0));
    let total = reports.interrupt();
    assert_eq!(total["lost"], 0);
    assert!(total["messages"].as_u64().unwrap() > 5000);
}

#[test]
fn messages_that_the_tool_was_too_slow_for_are_lost() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["hz", "sensor.ticks"]);
    ticker.tick_until(|| reports.next()["messages"] != 0);
    reports.wait_for_silence();
    kill("-STOP", reports.process_id());
    // More than the tap keeps and the socket holds.
    ticker.send(40_000);
    kill("-CONT", reports.process_id());
    let [messages, lost] = reports.sum_until_silence(["messages", "lost"]);
    assert_eq!(messages + lost, 40_000);
    assert!(lost > 0 && messages > 0, "{messages} {lost}");
}

#[test]
fn periods_are_those_of_the_sender() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["hz", "sensor.ticks"]);
    // However slow this machine is: the sender never sends earlier than after 5 ms.
    ticker.tick_until(|| reports.next()["messages"] != 0);
    let total = reports.interrupt();
    let period = |key: &str| total["period_ms"][key].as_f64().unwrap();
    assert!(period("min") >= 5.0, "{total}");
    assert!(
        period("min") <= period("p50") && period("p50") <= period("p99") && period("p99") <= period("max"),
        "{total}"
    );
    assert!((total["rate_hz"].as_f64().unwrap() - 1000.0 / period("mean")).abs() < 1.0, "{total}");
}

#[test]
fn a_table_lists_all_gates_of_the_system() {
    let rover = Rover::start();
    let text = rover.measure(&["hz", "--once"]);
    let mut lines = text.lines();
    assert_eq!(lines.next().unwrap().split_whitespace().collect::<Vec<_>>(), HEADER);
    let mut gates: Vec<_> = lines.map(|line| line.split_whitespace().next().unwrap()).collect();
    gates.sort_unstable();
    let expected = [
        "controller.actuator",
        "controller.commands",
        "logger.events",
        "sensor.image",
        "sensor.measurements",
        "sensor.position",
    ];
    assert_eq!(gates, expected);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

const HEADER: [&str; 8] = ["GATE", "RATE", "MIN", "P50", "P99", "MAX", "JITTER", "LOST"];

#[test]
fn a_gate_that_receives_is_measured_at_its_senders() {
    let rover = Rover::start();
    let note = "note: `controller.sensor` is measured where its messages come from: `sensor.measurements`\n";
    let text = rover.measure_with_note(&["hz", "controller.sensor", "--once"], note);
    assert!(text.contains("\nsensor.measurements "), "{text}");
}

#[test]
fn a_silent_gate_says_what_its_component_does() {
    let ticker = Ticker::start();
    let output = ticker.rover.scl(&["hz", "sensor.ticks", "--once"]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("no messages (running)"), "{text}");
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn a_component_that_restarts_is_measured_again() {
    let mut ticker = Ticker::start();
    let mut reports = Reports::start(&ticker.rover, &["hz", "sensor.ticks"]);
    ticker.tick_until(|| reports.next()["messages"] != 0);
    ticker.close();
    while reports.next()["state"] != "not running" {}
    ticker.open();
    ticker.tick_until(|| reports.next()["messages"] != 0);
    assert_eq!(reports.interrupt()["lost"], 0);
}

#[test]
fn it_ends_when_its_reader_has_gone() {
    let rover = Rover::start();
    let mut process = rover.scl(&["hz"]).stdout(std::process::Stdio::piped()).spawn_guarded();
    drop(process.stdout.take());
    assert_eq!(process.wait().unwrap().code(), Some(0));
}

#[test]
fn wrong_names_are_explained() {
    let rover = Rover::start();
    let error = rover.error(&["hz", "sensor.measurement"], 2);
    assert!(error.contains("error: component `sensor` has no gate `measurement`"), "{error}");
    assert!(error.contains("help: did you mean `sensor.measurements`?"), "{error}");
    let error = rover.error(&["hz", "actuator.setpoint"], 2);
    assert!(error.contains("error: component `actuator` is not running"), "{error}");
    let error = rover.error(&["hz", "sensor.image", "--window", "0"], 2);
    assert!(error.contains("invalid value '0' for '--window <N>'"), "{error}");
}

#[test]
fn without_a_system_it_says_how_to_start_one() {
    let rover = Rover::stopped();
    assert!(rover.error(&["hz"], 2).starts_with("error: no system is running\n"));
}
