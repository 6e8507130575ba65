//! Commands that go on until they are stopped end in order on each of the signals.

use crate::rover::Rover;
use crate::system::Started;
use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

/// Only ends a test that hangs.
const LIMIT: Duration = Duration::from_secs(60);

/// The signals with their numbers.
const SIGNALS: [(&str, u32); 3] = [("-INT", 2), ("-TERM", 15), ("-HUP", 1)];

#[test]
fn each_signal_ends_each_command_in_order() {
    let mut rover = Rover::stopped();
    rover.play_alone("sensor");
    // The commands with their exit codes; the controller is not running, so nothing replies.
    let cases: [(&[&str], i32); 7] = [
        (&["echo", "sensor.measurements"], 0),
        (&["hz", "sensor.measurements"], 0),
        (&["delay", "sensor.measurements"], 0),
        (&["bw", "sensor.measurements"], 0),
        (&["pub", "controller.actuator", "{}", "--ready", "60s"], 0),
        (&["call", "controller.commands", "{}", "--timeout", "60s"], 1),
        (&["record", "controller.commands", "-o", "all.mcap", "--overwrite"], 1),
    ];
    for (arguments, code) in cases {
        for (signal, number) in SIGNALS {
            let command = Started::spawn(&mut rover.scl(arguments));
            let started = Instant::now();
            while !catches(command.process_id(), number) {
                assert!(started.elapsed() < LIMIT, "{arguments:?} does not handle {signal}");
            }
            command.signal(signal);
            let (status, _, errors) = command.finish();
            assert_eq!(status.code(), Some(code), "{arguments:?} {signal}: {errors}");
        }
    }
}

#[test]
fn a_command_started_by_nohup_goes_on_at_a_hangup() {
    let mut rover = Rover::stopped();
    rover.play_alone("sensor");
    let scl = rover.scl(&["echo", "sensor.measurements"]);
    let mut nohup = Command::new("nohup");
    nohup.arg(scl.get_program()).args(scl.get_args());
    nohup.envs(scl.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let command = Started::spawn(&mut nohup);
    let started = Instant::now();
    while !catches(command.process_id(), 15) {
        assert!(started.elapsed() < LIMIT, "SIGTERM is not handled");
    }
    assert!(!catches(command.process_id(), 1), "SIGHUP is handled");
    command.signal("-TERM");
    let (status, _, errors) = command.finish();
    assert_eq!(status.code(), Some(0), "{errors}");
}

/// Whether a process has a handler for a signal.
fn catches(process: u32, signal: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(caught.trim(), 16).unwrap() >> (signal - 1) & 1 == 1
}
