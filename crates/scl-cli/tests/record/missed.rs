//! The messages that gates have missed, in a recording.

use super::recorder::Recorder;
use crate::rover::{COMPONENTS, Rover, TOPOLOGY};
use crate::system::kill;
use serde_json::Value;

#[test]
fn a_recording_has_what_was_missed_while_it_ran() {
    let topology =
        TOPOLOGY.replace("sensor: {sub: rover.Measurement", "sensor: {sub: rover.Measurement, deadline: 150ms");
    let mut rover = Rover::of(&topology);
    rover.play(&COMPONENTS, |_| {});
    let missed = |info: &Value| info["figures"]["missed"].as_u64().unwrap();
    let stop_the_sensor = |rover: &Rover| {
        let before = missed(&rover.json(&["info", "controller.sensor", "--format", "json"]));
        kill("-STOP", rover.process_id("sensor"));
        rover.wait_for(&["info", "controller.sensor"], |info| (missed(info) >= before + 3).then_some(()));
        kill("-CONT", rover.process_id("sensor"));
    };
    // What was missed before the recording does not count.
    stop_the_sensor(&rover);
    let recorder = Recorder::start(&rover, 1, &["controller.actuator"]);
    stop_the_sensor(&rover);
    recorder.stop();
    let after = missed(&rover.json(&["info", "controller.sensor", "--format", "json"]));

    let info = rover.json(&["info", "./flight.mcap", "--format", "json"]);
    let gate = &info["missed"][0];
    assert_eq!(gate["gate"], "controller.sensor", "{info:#}");
    let count = gate["missed"].as_u64().unwrap();
    assert!((3..=after - 3).contains(&count), "{count} of {after}");
    assert_eq!(gate["peers"][0]["gate"], "sensor.measurements");
    assert_eq!(gate["peers"][0]["missed"], gate["missed"]);
    let text = rover.text(&["info", "./flight.mcap"]);
    let line = format!("  missed       controller.sensor {count}, of sensor.measurements {count}\n");
    assert!(text.contains(&line), "{text}");
}
