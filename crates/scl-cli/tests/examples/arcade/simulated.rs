//! Flights in simulated time.

use super::flight::Flown;
use super::recording::Recording;
use super::write_json;
use crate::aircraft::arcade::{Arbitration, Authority};
use crate::simulated::simulate;
use crate::system::System;
use crate::{example, lock_machine};
use serde_json::json;
use std::path::Path;

/// The parts of Figure 6 except the world itself, each killed once.
const KILLS: [&str; 8] = [
    "configuration",
    "blackbox",
    "gps_sensor",
    "power_management",
    "autopilot",
    "uav_mission",
    "mission_arbiter",
    "communication",
];

/// The same from its first message to its last, although nothing about the machine is.
#[test]
fn a_flight_through_random_kills_is_repeated_to_the_last_bit() {
    let _machine = lock_machine();
    let scenario = std::fs::read_to_string(example("arcade").join("rough_day.yaml")).unwrap();
    let page = include_str!("../../../../../docs/simulate.md");
    assert!(page.contains(&format!("```yaml\n{scenario}```\n")), "docs/simulate.md shows another scenario");
    // It ends before what it expects, so that only the recordings say anything.
    let recordings = ["first", "second"].map(|name| {
        let flown = simulate("arcade", name, &["--seed", "5", "--until", "25s"], &scenario);
        assert!(flown.log.contains("`autopilot` is killed"), "{}", flown.log);
        std::fs::read(flown.file).unwrap()
    });
    assert!(recordings[0] == recordings[1], "the recordings differ");
}

#[test]
fn every_part_is_killed_once_and_the_flight_goes_on() {
    let _machine = lock_machine();
    let kill = |(component, at): (&str, usize)| format!("  - {{at: {at}s, kill: {component}}}\n");
    let faults: String = KILLS.into_iter().zip((8..).step_by(5)).map(kill).collect();
    let scenario = format!("until: 90s\nfaults:\n{faults}expect: [{{exit: uav_mission, code: 0}}]\n");
    let flown = fly("kills", &[], &scenario);
    flown.check("survey.yaml");
    for component in KILLS {
        let line = format!("`{component}` was restarted once; last reason: killed by signal 9 (SIGKILL)");
        assert!(flown.log.contains(&line), "{component}\n{}", flown.log);
    }
    let pauses = flown.recording.check_beats(1);
    println!("readings without a beat while the autopilot was started again: {}", pauses[0]);
    assert_eq!(flown.recording.flight.last().unwrap().restarts, 1);
    let kills = KILLS.into_iter().zip((8..).step_by(5));
    let kills = kills.map(|(component, at)| json!({"component": component, "time_us": at * 1_000_000_u64}));
    write_json("kills", &kills.collect());
}

#[test]
fn with_little_charge_the_arbiter_brings_the_aircraft_home() {
    let _machine = lock_machine();
    let scenario = "until: 90s\nexpect: [{exit: uav_mission, code: 1}]\n";
    let flown = fly("low-battery", &["--profile", "low-battery"], scenario);
    flown.recording.check_landing();
    flown.recording.check_attitude();
    flown.recording.check_beats(0);
    let is_safety = |arbitration: &&Arbitration| arbitration.authority() == Authority::Safety;
    let decided = flown.recording.arbitration.iter().find(is_safety);
    assert!(decided.is_some_and(|it| it.reason.starts_with("low power")), "{decided:?}\n{}", flown.log);
    // The mission has failed, but nothing else.
    assert!(flown.log.contains("scl: non-essential component `uav_mission` failed"), "{}", flown.log);
    assert_eq!(flown.code, Some(0), "{}", flown.log);
}

/// The autopilot in C alone, for which all others are played, does what its twin in Rust has done in their flight.
#[test]
fn a_recorded_flight_is_flown_again_in_c_and_each_time_the_same() {
    let _machine = lock_machine();
    let flown = simulate("arcade", "twins", &["--profile", "rust-autopilot", "--profile", "hop"], "until: 28s\n");
    assert_eq!(flown.code, Some(0), "{}", flown.log);
    let played =
        format!("simulator,{}", KILLS.iter().filter(|it| **it != "autopilot").copied().collect::<Vec<_>>().join(","));
    let replay = ["--replay", flown.file.to_str().unwrap(), "--as", &played];
    let again = ["twins-again", "twins-third"].map(|name| {
        let again = simulate("arcade", name, &replay, "until: 28s\n");
        assert_eq!(again.code, Some(0), "{}", again.log);
        again.file
    });
    check_equal(&flown.file, &again[0], "1e-6");
    check_equal(&again[0], &again[1], "0");
}

/// The set-points of two recordings are the same within this difference.
#[track_caller]
fn check_equal(first: &Path, second: &Path, within: &str) {
    assert!(Recording::read(first).motors.len() > 1000);
    let [first, second] = [first, second].map(|file| file.to_str().unwrap());
    let compare = ["compare", first, second, "--gate", "autopilot.motors", "--within", within];
    let output = System::of_files(&[]).scl(&compare).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

/// Flies in simulated time, with more arguments of `scl simulate`, through a scenario. The recording gets this name.
fn fly(name: &str, arguments: &[&str], scenario: &str) -> Flown {
    let flown = simulate("arcade", name, arguments, scenario);
    Flown { recording: Recording::read(&flown.file), log: flown.log, code: flown.code }
}
