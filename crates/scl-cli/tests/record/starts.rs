//! Components that start later, or again, while a recording runs.

use super::recorder::{Recorder, counts, figures, messages, sequences, summary};
use super::source::Source;
use crate::rover::{COMPONENTS, Rover};
use scl_plan::SystemPlan;
use scl_tests::wait_until;

#[test]
fn components_that_start_later_are_recorded() {
    let mut rover = Rover::start();
    ["user_interface", "sensor", "controller"].iter().for_each(|component| rover.stop(component));
    let recorder = Recorder::start(&rover, 1, &["--format", "json"]);
    rover.play(&["sensor", "controller", "user_interface"], |_| {});
    let file = rover.path("flight.mcap");
    wait_until("every gate is recorded", || counts(&file).len() == 7);
    let report = recorder.stop_json();
    assert_eq!(report["gates"].as_array().unwrap().len(), 6);
    let (bytes, summary) = (std::fs::read(&file).unwrap(), summary(&file));
    let plans = summary.attachment_indexes.iter().filter(|attachment| attachment.name == "plan.json");
    let planned: Vec<usize> = plans
        .map(|index| {
            let found = mcap::read::attachment(&bytes, index).unwrap();
            SystemPlan::from_json(std::str::from_utf8(&found.data).unwrap()).unwrap().components.len()
        })
        .collect();
    assert!(planned.len() > 1 && planned.is_sorted(), "{planned:?}");
    assert_eq!(planned.last(), Some(&4), "the last one is complete");
}

#[test]
fn a_component_that_starts_again_is_recorded_on() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &["--format", "json"]);
    let file = source.rover.path("flight.mcap");
    let sent = source.send_numbers(100).collect::<Vec<_>>();
    wait_until("the first run is recorded", || sequences(&file, "/source/g0", sent[0]) == sent);
    let first_run = messages(&file).len();
    source.close();
    source.open();
    // What is sent before the recorder has connected again is lost, and counted.
    wait_until("the second run is recorded", || {
        source.send_numbers(1);
        recorder.signal("-USR1");
        messages(&file).len() > first_run
    });
    let report = recorder.stop_json();
    let (recorded, lost) = figures(&report, "source.g0");
    assert_eq!(recorded + lost, first_run as u64 + source.sent("g0"));
    let second: Vec<u64> = messages(&file)[first_run..].iter().map(|message| message.sequence.into()).collect();
    assert_eq!(second, (lost..source.sent("g0")).collect::<Vec<_>>());
}

/// The topology file, if there is one, tells which gates there will be.
#[test]
fn a_system_that_has_never_run_is_waited_for() {
    let mut rover = Rover::stopped();
    let gates = ["sensor.measurements", "controller.commands"];
    let arguments = ["record", "--system", "rover", "-o", "flight.mcap"];
    let mut recorder = Recorder::spawn(rover.scl(&[&arguments[..], &gates].concat()));
    recorder.wait_for("`sensor.measurements` is not running; recording it once it has started");
    recorder.wait_for("waiting");
    rover.play(&COMPONENTS, |_| {});
    let file = rover.path("flight.mcap");
    wait_until("both gates are recorded", || {
        recorder.signal("-USR1");
        counts(&file).len() == 3
    });
    recorder.stop();
}

#[test]
fn names_of_a_system_that_does_not_run_are_checked() {
    let rover = Rover::stopped();
    let error = rover.error(&["record", "--system", "rover", "sensor.measurement"], 2);
    assert!(error.contains("did you mean `measurements`?"), "{error}");
    let error = rover.error(&["record", "--system", "rover", "senor"], 2);
    assert!(error.contains("did you mean `sensor`?"), "{error}");
}

#[test]
fn a_gate_that_is_not_running_yet_is_waited_for() {
    let mut source = Source::start();
    source.close();
    let mut recorder = Recorder::start(&source.rover, 0, &["source.g1", "--system", "rover"]);
    source.open();
    recorder.wait_for("`source.g1` has started");
    wait_until("it is recorded", || {
        source.send("g1", b"tick");
        counts(&source.rover.path("flight.mcap")).contains_key("/source/g1")
    });
    recorder.stop();
}
