//! Components that start later, or again, while a recording runs.

use super::recorder::{Recorder, counts, figures, messages};
use super::source::{GATES, Source};
use crate::rover::Rover;
use scl_tests::wait_until;

#[test]
fn components_that_start_later_are_recorded() {
    let mut rover = Rover::start_with(&[], |_| {});
    // The system's folder must be there.
    rover.play(&["logger"], |command| {
        command.env("SCL_READY", "no");
    });
    let recorder = Recorder::start(&rover, 1, &["--format", "json"]);
    rover.play(&["sensor", "controller", "user_interface"], |_| {});
    let file = rover.path("flight.mcap");
    wait_until("every gate is recorded", || counts(&file).len() == 7);
    let report = recorder.stop_json();
    assert_eq!(report["gates"].as_array().unwrap().len(), 6);
}

#[test]
fn a_component_that_starts_again_is_recorded_on() {
    let mut source = Source::start();
    let recorder = Recorder::start(&source.rover, GATES, &["--format", "json"]);
    let file = source.rover.path("flight.mcap");
    source.send_numbers(0..100);
    wait_until("the first run is recorded", || messages(&file).len() == 100);
    source.close();
    source.open();
    // What is sent before the recorder has connected again is lost, and counted.
    let mut sent = 0;
    wait_until("the second run is recorded", || {
        source.send_numbers(sent..sent + 1);
        sent += 1;
        messages(&file).len() > 100
    });
    let report = recorder.stop_json();
    let (recorded, lost) = figures(&report, "source.g0");
    assert_eq!(recorded + lost, 100 + sent);
    let second = messages(&file)[100..].iter().map(|message| u64::from(message.sequence)).collect::<Vec<_>>();
    assert_eq!(second, (lost..sent).collect::<Vec<_>>());
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
