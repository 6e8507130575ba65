//! `rate`, `deadline` and `max_age`: what senders and receivers that are too slow look like.

use crate::rover::{COMPONENTS, Rover, TOPOLOGY};
use crate::system::kill;
use serde_json::{Value, json};

#[test]
fn a_sender_that_is_too_slow_is_shown_at_both_ends() {
    let topology = TOPOLOGY
        .replace("measurements: {pub: rover.Measurement}", "measurements: {pub: rover.Measurement, rate: 20Hz}")
        .replace("sensor: {sub: rover.Measurement", "sensor: {sub: rover.Measurement, deadline: 150ms");
    let mut rover = Rover::of(&topology);
    rover.play(&COMPONENTS, |_| {});
    let missed = |info: &Value| info["figures"]["missed"].as_u64().unwrap();

    // A program that is stopped sends nothing, and cannot count that itself.
    let before = missed(&rover.json(&["info", "controller.sensor", "--format", "json"]));
    kill("-STOP", rover.process_id("sensor"));
    let receiver =
        rover.wait_for(&["info", "controller.sensor"], |info| (missed(info) >= before + 3).then(|| info.clone()));
    assert_eq!(receiver["options"]["deadline_s"], json!(0.15));
    assert_eq!(receiver["peers"][0]["figures"]["missed"], receiver["figures"]["missed"]);
    let text = rover.text(&["info", "controller.sensor"]);
    for shown in ["\n  deadline   150ms\n", "\n  missed     ", " LOST  MISSED\n"] {
        assert!(text.contains(shown), "{shown}: {text}");
    }

    kill("-CONT", rover.process_id("sensor"));
    // From the last message before the stop to the first one after it are at least three deadlines, so nine periods.
    let sender = rover.wait_for(&["info", "sensor.measurements"], |info| (missed(info) >= 8).then(|| info.clone()));
    assert_eq!(sender["options"]["period_s"], json!(0.05));
    let top = rover.json(&["top", "--once", "--format", "json"]);
    let gates = top["gates"].as_array().unwrap();
    let shown = gates.iter().find(|gate| gate["gate"] == "sensor.measurements").unwrap_or_else(|| panic!("{top:#}"));
    assert!(shown["missed"].as_u64().unwrap() >= 8, "{shown:#}");

    let found = rover.text(&["doctor"]);
    for finding in [
        "warning  time: `sensor.measurements` of system `rover` promises a message every 50ms, and ",
        "warning  time: `controller.sensor` of system `rover` needs a message every 150ms, and ",
    ] {
        assert!(found.contains(finding), "{found}");
    }
    // Gates without such options miss nothing.
    assert_eq!(missed(&rover.json(&["info", "controller.position", "--format", "json"])), 0);
}

#[test]
fn a_receiver_that_is_too_slow_is_shown() {
    let newest_only = "sensor: {sub: rover.Measurement, queue: 1}";
    let topology = TOPOLOGY.replace(newest_only, "sensor: {sub: rover.Measurement, queue: 200, max_age: 150ms}");
    let mut rover = Rover::of(&topology);
    rover.play(&COMPONENTS, |_| {});
    let count = |info: &Value, name: &str| info["figures"][name].as_u64().unwrap();

    // What is sent while the receiver is stopped waits for it, and is sent at 50 Hz.
    let before = count(&rover.json(&["info", "sensor.measurements", "--format", "json"]), "sent");
    kill("-STOP", rover.process_id("controller"));
    rover.wait_for(&["info", "sensor.measurements"], |info| (count(info, "sent") > before + 100).then_some(()));
    kill("-CONT", rover.process_id("controller"));
    let receiver =
        rover.wait_for(&["info", "controller.sensor"], |info| (count(info, "expired") >= 10).then(|| info.clone()));
    assert!(count(&receiver, "received") >= count(&receiver, "expired"), "{receiver:#}");
    assert_eq!(receiver["options"]["max_age_s"], json!(0.15));
    assert_eq!(receiver["peers"][0]["figures"]["expired"], receiver["figures"]["expired"]);
    let text = rover.text(&["info", "controller.sensor"]);
    for shown in ["\n  max_age    150ms\n", "\n  expired    ", " LOST  EXPIRED\n"] {
        assert!(text.contains(shown), "{shown}: {text}");
    }
    let top = rover.json(&["top", "--once", "--format", "json"]);
    let gates = top["gates"].as_array().unwrap();
    let shown = gates.iter().find(|gate| gate["gate"] == "controller.sensor").unwrap_or_else(|| panic!("{top:#}"));
    assert!(shown["expired"].as_u64().unwrap() >= 10, "{shown:#}");
    let (found, finding) =
        (rover.text(&["doctor"]), "warning  time: `controller.sensor` of system `rover` has dropped ");
    assert!(found.contains(finding), "{found}");
}
