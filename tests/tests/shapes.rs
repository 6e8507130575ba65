//! Programs built from different versions of a message: they connect if protobuf allows it, or refuse and say why.

use crate::programs::SHAPES;
use scl_tests::{Process, System, on_each_transport};

/// The promise: with the same field numbers for other fields, no swapped coordinates are ever exchanged. What connects
/// refuses, and `ready`, the waiting call and the log name the message, the field, and both sides.
#[test]
fn swapped_field_numbers_are_refused_by_name() {
    on_each_transport(|system| {
        for (one, other) in [("original", "swapped"), ("swapped", "original")] {
            let (mut sensor, mut viewer) = (start(&system, one, "sensor"), start(&system, other, "viewer"));
            let (sensor_id, viewer_id) = (sensor.id().to_string(), viewer.id().to_string());
            sensor.ask("publish", "published");
            sensor.ask("push", "pushed");
            let words = ["nav.Position", "`lat`", "`lon`"];
            // The viewer connects to `position`, the sensor to `jobs` and `answer`.
            assert_names(&answer(&mut viewer, "ready 300"), &[&words[..], &["sensor", &sensor_id]].concat());
            assert_names(&answer(&mut sensor, "ready 300"), &[&words[..], &["viewer", &viewer_id]].concat());
            assert_names(&answer(&mut sensor, "call"), &[&words[..], &["viewer", &viewer_id]].concat());
            assert_names(&viewer.expect_log("nav.Position"), &words);
            assert_names(&sensor.expect_log("nav.Position"), &words);
            sensor.kill();
            viewer.kill();
        }
    });
}

/// The promise: a program that was refused is found as soon as it has been built and started again.
#[test]
fn a_program_built_anew_is_found() {
    let system = System::new();
    let mut sensor = start(&system, "original", "sensor");
    let mut viewer = start(&system, "swapped", "viewer");
    answer(&mut viewer, "ready 300");
    viewer.kill();
    let mut viewer = start(&system, "original", "viewer");
    exchange(&mut sensor, &mut viewer);
}

/// The promise: added and removed fields are compatible, in both directions.
#[test]
fn added_and_removed_fields_are_compatible() {
    on_each_transport(|system| {
        for (one, other) in [("original", "extended"), ("extended", "original")] {
            let (mut sensor, mut viewer) = (start(&system, one, "sensor"), start(&system, other, "viewer"));
            exchange(&mut sensor, &mut viewer);
            sensor.kill();
            viewer.kill();
        }
    });
}

/// The promise: another type is refused, and both types are named, not two hashes.
#[test]
fn another_type_is_refused_and_both_are_named() {
    on_each_transport(|system| {
        let (mut sensor, mut viewer) = (start(&system, "original", "sensor"), start(&system, "renamed", "viewer"));
        let words = ["nav.Position", "nav.Location"];
        assert_names(&answer(&mut viewer, "ready 300"), &[&words[..], &["sensor"]].concat());
        assert_names(&answer(&mut sensor, "ready 300"), &[&words[..], &["viewer"]].concat());
        assert_names(&answer(&mut sensor, "call"), &[&words[..], &["viewer"]].concat());
        assert_names(&viewer.expect_log("nav.Position"), &words);
        assert_names(&sensor.expect_log("nav.Position"), &words);
    });
}

fn start(system: &System, variant: &str, component: &str) -> Process {
    let mut process = system.start(SHAPES, &[variant, component]);
    process.expect("open");
    process
}

pub(crate) fn answer(process: &mut Process, command: &str) -> String {
    process.tell(command);
    process.next_line()
}

#[track_caller]
pub(crate) fn assert_names(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}

/// One message in each pattern.
pub(crate) fn exchange(sensor: &mut Process, viewer: &mut Process) {
    sensor.get_ready();
    viewer.get_ready();
    sensor.ask("publish", "published");
    viewer.ask("receive", "52.5 13.4");
    sensor.ask("push", "pushed");
    viewer.ask("pull", "52.5 13.4");
    viewer.tell("serve");
    sensor.ask("call", "52.5 13.4");
    viewer.expect("served");
}
