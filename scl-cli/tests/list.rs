//! `scl list`: what runs, what ran, and what is only known as a peer.

use crate::rover::Rover;
use expect_test::expect;
use serde_json::Value;

#[test]
fn components_and_their_states_are_listed() {
    let mut rover = Rover::start();
    rover.kill("user_interface");
    rover.stop("logger");
    expect![[r#"
        rover: 2 running, 1 dead, 2 stopped
        COMPONENT STATE PID FOR PROGRAM
        actuator stopped
        controller running N AGE tests
        logger stopped
        sensor not ready N AGE tests
        user_interface dead N tests
    "#]]
    .assert_eq(&shown(&rover, &["list"]));
}

#[test]
fn gates_are_listed_with_types_and_peers() {
    let rover = Rover::start();
    expect![[]].assert_eq(&shown(&rover, &["list", "-v"]));
}

#[test]
fn json_has_the_same_and_more() {
    let rover = Rover::start();
    let list = rover.json(&["list", "--format", "json"]);
    assert_eq!(list["system"], "rover");
    let component = |name: &str| list["components"].as_array().unwrap().iter().find(|it| it["name"] == name).unwrap();
    let sensor = component("sensor");
    assert_eq!(sensor["state"], "running");
    assert_eq!(sensor["pid"], rover.process_id("sensor"));
    assert!(sensor["program"].as_str().unwrap().starts_with('/'));
    let gates: Vec<&Value> = sensor["gates"].as_array().unwrap().iter().map(|gate| &gate["name"]).collect();
    assert_eq!(gates, ["sensor.measurements", "sensor.position", "sensor.image", "sensor.log"]);
    assert_eq!(sensor["gates"][0]["type"]["message"], "rover.Measurement");
    assert_eq!(component("actuator")["state"], "stopped");
}

#[test]
fn without_a_running_system_the_way_out_is_shown() {
    let rover = Rover::stopped();
    expect![[r#"
        error: no system is running
          = help: start one, for example with `scl run`
          = note: the runtime folder does not exist (`SCL_RUNTIME_DIR` chooses another)
    "#]]
    .assert_eq(&rover.error(&["list"], 2));
}

#[test]
fn a_stopped_system_is_found_by_its_name_or_its_topology() {
    let mut rover = Rover::start_with(&["sensor"], |_| {});
    rover.stop("sensor");
    for arguments in [&["list"][..], &["list", "--system", "rover"]] {
        assert!(rover.text(arguments).starts_with("rover: 1 stopped\n"), "{arguments:?}");
    }
    let error = rover.error(&["list", "--system", "rovr"], 2);
    assert!(error.contains("error: there is no system `rovr`\n  = help: did you mean `rover`?"), "{error}");
}

/// A table with single spaces, process numbers as `N`, ages as `AGE` and test programs as `tests`.
fn shown(rover: &Rover, arguments: &[&str]) -> String {
    let text = rover.text(arguments);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let word = |word: &str| match word {
        _ if word.starts_with("tests-") => "tests".to_owned(),
        _ if word.parse::<u32>().is_ok() => "N".to_owned(),
        _ => word.to_owned(),
    };
    let line = |line: &str| {
        let words: Vec<String> = line.split_whitespace().map(word).collect();
        words.join(" ") + "\n"
    };
    text.lines().filter(|it| !it.is_empty()).map(line).collect()
}
