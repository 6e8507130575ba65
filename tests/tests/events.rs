//! What a program logs is sent to a gate.

use crate::programs::{EVENT_LOGGER, TALKER};
use rustix::process::Signal;
use scl_tests::{Process, System, on_each_transport};
use std::fs;

fn open(system: &System, program: &str) -> Process {
    let mut process = system.start(program, &[]);
    process.expect("open");
    process
}

#[test]
fn events_of_the_level_and_above_are_sent() {
    on_each_transport(|system| {
        let mut logger = open(&system, EVENT_LOGGER);
        let mut talker = open(&system, TALKER);
        ["info one", "debug two", "warn three"].into_iter().for_each(|command| talker.tell(command));
        logger.expect("INFO talker one answer=42");
        logger.expect("WARN talker three");
        // Nothing else costs time.
        talker.ask("level", "info");
        // What is logged while the program ends is sent before it has ended.
        talker.close_input();
        assert!(talker.wait_for_exit().status.success());
        logger.expect("INFO talker last words");
        // The gate that the events went to does not keep the component open.
        let files = fs::read_dir(system.runtime_dir().join("events")).expect("the folder of the system");
        let names = files.flatten().map(|file| file.file_name().to_string_lossy().into_owned());
        let left: Vec<String> = names.filter(|name| name.starts_with("talker")).collect();
        assert_eq!(left, ["talker.lock"]);
    });
}

#[test]
fn events_are_sent_after_a_stop_request() {
    let system = System::new();
    let mut logger = open(&system, EVENT_LOGGER);
    let mut talker = open(&system, TALKER);
    talker.tell("info one");
    logger.expect("INFO talker one answer=42");
    talker.signal(Signal::TERM);
    assert!(talker.wait_for_exit().status.success());
    logger.expect("INFO talker last words");
}

/// The program does not wait for the logger.
#[test]
fn events_wait_for_the_logger() {
    let system = System::new();
    let mut talker = open(&system, TALKER);
    talker.ask("flood 900", "made 900");
    talker.expect_log("queue of `logger.records` is full");
    let mut logger = open(&system, EVENT_LOGGER);
    (800..900).for_each(|number| logger.expect(&format!("INFO talker {number}")));
    talker.tell("info last");
    logger.expect("INFO talker last answer=42");
}

/// SCL logs with `debug` that the logger has connected: in another thread than the one that sends.
#[test]
fn no_event_is_about_the_gate_itself() {
    let system = System::new();
    let mut talker = system.start(TALKER, &["debug"]);
    talker.expect("open");
    for round in 0..3 {
        let mut logger = open(&system, EVENT_LOGGER);
        talker.tell(&format!("info {round}"));
        let last = format!("INFO talker {round} answer=42");
        let about = std::iter::from_fn(|| Some(logger.next_line()).filter(|line| *line != last))
            .find(|line| line.contains("talker.log") || line.contains("logger.records"));
        assert_eq!(about, None);
        logger.kill();
    }
}

/// An account: each event becomes a message, or is among those that the log counts.
#[test]
fn what_is_too_much_is_dropped_and_counted() {
    const ALL: u64 = 200_000;
    let system = System::new();
    let mut logger = open(&system, EVENT_LOGGER);
    let mut talker = open(&system, TALKER);
    talker.tell(&format!("flood {ALL}"));
    let made: u64 = talker.next_line().strip_prefix("made ").and_then(|made| made.parse().ok()).expect("a number");
    let mut dropped = 0;
    while made + dropped < ALL {
        let line = talker.expect_log(" events were not sent");
        let number = line.split(" events").next().and_then(|text| text.split(' ').next_back());
        dropped += number.and_then(|number| number.parse::<u64>().ok()).expect("a number");
    }
    assert_eq!(made + dropped, ALL);
    talker.tell("info last");
    while logger.next_line() != "INFO talker last answer=42" {}
}
