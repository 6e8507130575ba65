//! The values of parameters in a recording.

use super::recorder::Recorder;
use crate::parameters::rover;
use serde_json::json;

#[test]
fn a_recording_has_the_last_values_and_shows_each_attachment_once() {
    let rover = rover();
    let recorder = Recorder::start(&rover, 1, &["sensor.measurements"]);
    rover.text(&["set", "controller.gain=7"]);
    recorder.stop();
    let info = rover.json(&["info", "./flight.mcap", "--format", "json"]);
    let expected = json!({"gain": "7", "mode": "manual", "names": "[]", "pin": "4"});
    assert_eq!(info["parameters"], json!({"controller": expected}), "{info:#}");
    assert_eq!(info["attachments"], json!(["topology.yaml", "plan.json", "parameters.json"]));
    let text = rover.text(&["info", "./flight.mcap"]);
    assert!(text.contains("  parameters   controller.gain = 7\n               controller.mode = manual\n"), "{text}");
}
