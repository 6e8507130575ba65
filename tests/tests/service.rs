//! What programs tell a service manager: that they are ready, for whom they wait, that they stop, and that they are
//! alive.

use crate::programs::{FRESH, WATCHED};
use rustix::process::Signal;
use scl_tests::{Process, ServiceManager, System};
use std::time::Duration;

const MODES: [&str; 3] = ["async", "blocking", "threads"];
/// How soon the manager wants to hear that a program is alive.
const PERIOD: Duration = Duration::from_millis(600);
/// More notifications than a program sends that hangs, and fewer than one that does not.
const MANY: usize = 12;

/// The promise: a program is ready when its required peers are connected, although it never asks for that; until then
/// it names them. A stop request is reported.
#[test]
fn readiness_and_stops_are_reported() {
    for mode in MODES {
        let (system, manager) = (System::new(), ServiceManager::new());
        let viewer = start(&system, &manager, &[mode, "idle"], &[]);
        assert_eq!(manager.next(), "STATUS=waiting for `clock.ticks`\n", "{mode}");
        let newest = system.runtime_dir().join("newest");
        let clock = system.start_with(FRESH, &["clock", "async"], &[("NEWEST", newest.to_str().expect("UTF-8"))]);
        let ready = manager.next();
        assert_eq!(ready, "READY=1\nSTATUS=all required peers are connected\n", "{mode}");
        drop(clock);
        assert_eq!(manager.next(), "STATUS=waiting for `clock.ticks`\n", "{mode}");
        if mode != "threads" {
            viewer.signal(Signal::TERM);
            assert_eq!(manager.next(), "STOPPING=1\n", "{mode}");
        }
    }
}

/// The promise: a program that waits for a silent peer is alive, as is one that calls its gates less often than the
/// manager asks but within its period, and one that has not called any yet.
#[test]
fn a_program_that_waits_or_takes_its_time_is_alive() {
    for mode in MODES {
        for task in ["wait", "idle"] {
            let (system, manager) = (System::new(), ServiceManager::new());
            let _viewer = start(&system, &manager, &[mode, task], &watchdog());
            (0..MANY).for_each(|_| manager.expect("WATCHDOG=1"));
        }
        let (system, manager) = (System::new(), ServiceManager::new());
        let mut viewer = start(&system, &manager, &[mode, "pace"], &watchdog());
        // Twelve calls are four periods, in each of which at least one notification is due.
        (0..MANY).for_each(|_| viewer.expect("called"));
        let mut alive = 0;
        while let Some(heard) = manager.next_within(Duration::from_millis(1)) {
            alive += heard.lines().filter(|line| *line == "WATCHDOG=1").count();
        }
        assert!(alive >= 4, "{mode}: {alive}");
    }
}

/// The promise: a program that computes forever is silent for longer than the manager's period.
#[test]
fn a_program_that_hangs_is_silent() {
    for mode in MODES {
        let (system, manager) = (System::new(), ServiceManager::new());
        let mut viewer = start(&system, &manager, &[mode, "hang"], &watchdog());
        manager.expect("WATCHDOG=1");
        viewer.expect("computing");
        let heard = (0..MANY).take_while(|_| manager.next_within(PERIOD).is_some()).count();
        assert!(heard < MANY, "{mode}: it goes on reporting that it is alive");
    }
}

/// The promise: a watchdog that is meant for another process is none, and without a manager nothing happens.
#[test]
fn a_watchdog_of_another_process_is_not_fed() {
    let (system, manager) = (System::new(), ServiceManager::new());
    let more = [watchdog()[0], ("WATCHDOG_PID", "1")];
    let viewer = start(&system, &manager, &["blocking", "wait"], &more);
    assert_eq!(manager.next(), "STATUS=waiting for `clock.ticks`\n");
    assert_eq!(manager.next_within(PERIOD), None);
    viewer.signal(Signal::TERM);
    assert_eq!(viewer.wait_for_exit().code(), 0);
    for address in ["", "relative", "/nowhere/at/all", "@scl-nobody-listens"] {
        let more = [watchdog()[0], ("NOTIFY_SOCKET", address)];
        let mut viewer = system.start_with(WATCHED, &["blocking", "wait"], &more);
        viewer.expect("open");
        viewer.signal(Signal::TERM);
        assert_eq!(viewer.wait_for_exit().code(), 0, "{address}");
    }
}

fn watchdog() -> [(&'static str, &'static str); 1] {
    [("WATCHDOG_USEC", "600000")]
}

#[track_caller]
fn start(system: &System, manager: &ServiceManager, arguments: &[&str], more: &[(&str, &str)]) -> Process {
    let more = [&[("NOTIFY_SOCKET", manager.address())], more].concat();
    let mut process = system.start_with(WATCHED, arguments, &more);
    process.expect("open");
    process
}
