//! A program whose task is done: nobody warns about messages that it no longer takes. One that was killed is missed.

use crate::system::System;
use scl::plan::{Plan, SystemPlan};
use scl::untyped::Component;
use std::path::Path;
use std::time::Duration;

const TOPOLOGY: &str = "\
system: flight
components:
  - name: gps
    gates:
      - fix: pub
  - name: mission
    gates:
      - fix: sub
connections:
  - [gps.fix, mission.fix]
";

/// The component that a process plays, and whether the mission is killed.
const PLAYS: &str = "SCL_TEST_COMPLETED_PLAYS";
const KILLED: &str = "SCL_TEST_COMPLETED_KILLED";

const TEST: &str = "run_completed::a_mission_that_has_ended_is_not_missed";

/// More messages than wait in any queue.
const MANY: usize = 100_000;

const READY: Duration = Duration::from_secs(600);

#[test]
fn a_mission_that_has_ended_is_not_missed() {
    match std::env::var(PLAYS).as_deref() {
        Ok("gps") => return gps(),
        Ok(_) => return mission(),
        Err(_) => {}
    }
    let err = fly("");
    assert!(!err.contains("dropping messages"), "{err}");
    assert!(!err.contains("WARN"), "{err}");
}

#[test]
fn a_mission_that_was_killed_is_missed() {
    let err = fly("1");
    assert!(err.contains("queue of `mission.fix` is full; dropping messages: it is not connected"), "{err}");
}

fn fly(killed: &str) -> String {
    let program = std::env::current_exe().unwrap();
    let entry = |name: &str| {
        let command = format!("[{program:?}, --exact, {TEST}, --nocapture, --test-threads, 2]");
        format!(
            "  {name}: {{command: {command}, essential: false, environment: {{{PLAYS}: {name}, {KILLED}: {killed:?}}}}}\n"
        )
    };
    let launch = format!("components:\n{}{}", entry("gps"), entry("mission"));
    let system = System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", &launch)]);
    let plan = system.scl(&["plan"]).output().unwrap();
    system.write("plan.json", &String::from_utf8(plan.stdout).unwrap());
    let output = system.scl(&["run"]).env_remove("SCL_LOG").output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{err}");
    err
}

fn plan(component: &str) -> Plan {
    let system = SystemPlan::from_json(&std::fs::read_to_string("plan.json").unwrap()).unwrap();
    system.component(component).unwrap().clone()
}

/// Sends one message, and many when the mission has ended.
fn gps() {
    scl::host::start_log().unwrap();
    let mut gps = Component::open_blocking(&plan("gps")).unwrap();
    gps.ready_blocking(READY).unwrap();
    let mut fix = gps.publisher("fix").unwrap();
    fix.send_timeout(&b"fix"[..].into(), READY).unwrap();
    while fix.is_connected() {
        std::thread::yield_now();
    }
    // What a program closes last.
    let announcement = Path::new("runtime/flight/mission.json");
    while std::env::var(KILLED).unwrap().is_empty() && announcement.exists() {}
    for _ in 0..MANY {
        fix.send_timeout(&b"fix"[..].into(), READY).unwrap();
    }
}

/// Takes a message, and has done its task.
fn mission() {
    let mut mission = Component::open_blocking(&plan("mission")).unwrap();
    mission.subscriber("fix").unwrap().recv_blocking().unwrap();
    if !std::env::var(KILLED).unwrap().is_empty() {
        rustix::process::kill_process(rustix::process::getpid(), rustix::process::Signal::KILL).unwrap();
    }
}
