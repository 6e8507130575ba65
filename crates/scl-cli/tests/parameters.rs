//! `scl get` and `scl set`, and where else the values of parameters are shown.

use crate::rover::{COMPONENTS, Rover, TOPOLOGY};
use crate::system::kill;
use expect_test::expect;
use serde_json::json;

const PARAMETERS: &str = "
    parameters:
      - gain: {f64: 0.8, range: [0, 10], unit: 1/s, live: true}
      - mode: {one_of: [manual, auto], default: manual, live: true}
      - names: {list: text, default: [], live: true}
      - pin: {u8: 4}";

/// The rover, whose controller has parameters.
pub(crate) fn rover() -> Rover {
    let mut rover = Rover::of(&TOPOLOGY.replace("  - name: controller", &format!("  - name: controller{PARAMETERS}")));
    rover.play(&COMPONENTS, |_| {});
    rover
}

#[test]
fn values_are_shown_and_set() {
    let rover = rover();
    expect![[r#"
        PARAMETER         VALUE   UNIT  LIVE
        controller.gain   0.8     1/s   live
        controller.mode   manual        live
        controller.names  []            live
        controller.pin    4
    "#]]
    .assert_eq(&trimmed(&rover.text(&["get"])));
    assert_eq!(rover.text(&["get", "controller.gain"]), "0.8\n");
    let set = ["set", "controller.gain=2.5", "controller.names=[a, \"b, c\"]", "controller.mode=manual"];
    expect![[r#"
        controller.gain: 0.8 -> 2.5
        controller.names: [] -> [a, "b, c"]
        controller.mode: manual
    "#]]
    .assert_eq(&rover.text(&set));
    assert_eq!(rover.text(&["set", "controller.mode", "auto"]), "controller.mode: manual -> auto\n");
    let expected = json!({"gain": "2.5", "mode": "auto", "names": "[a, \"b, c\"]", "pin": "4"});
    assert_eq!(rover.json(&["get", "--format", "json"]), json!({"controller": expected}));
    assert_eq!(rover.json(&["get", "controller", "--format", "json"]), expected);
    assert_eq!(rover.json(&["get", "controller.gain", "--format", "json"]), json!("2.5"));
    assert_eq!(rover.text(&["get", "sensor"]), "no parameters\n");
    assert_eq!(rover.text(&["complete-gates", "--parameters", "controller.m"]), "controller.mode\n");

    assert_eq!(rover.json(&["info", "controller", "--format", "json"])["parameters"], expected);
    let info = rover.text(&["info", "controller"]);
    assert!(info.contains("  parameters  gain = 2.5 1/s, live\n              mode = auto, live\n"), "{info}");
    let top = rover.text(&["top", "--once", "--period", "100ms"]);
    assert!(top.contains("PARAMETER         VALUE\ncontroller.gain   2.5\ncontroller.mode   auto\n"), "{top}");
    let top = rover.json(&["top", "--once", "--period", "100ms", "--format", "json"]);
    let shown: Vec<_> = top["components"].as_array().unwrap().iter().map(|it| it["parameters"].clone()).collect();
    assert_eq!(shown[1], json!({"gain": "2.5", "mode": "auto", "names": "[a, \"b, c\"]"}), "{shown:?}");
}

/// Without spaces at the ends of lines.
fn trimmed(text: &str) -> String {
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

#[test]
fn what_cannot_be_set_is_told_and_changes_nothing() {
    let rover = rover();
    let told = |arguments: &[&str]| rover.error(&[&["set", "controller.mode=auto"], arguments].concat(), 2);
    let cases = [
        "controller.gain=11",
        "controller.gain=high",
        "controller.gian=1",
        "controller.pin=5",
        "controler.gain=1",
        "actuator.gain=1",
        "sensor.gain=1",
        "gain=1",
    ];
    let all: String = cases.iter().map(|case| format!("{case}\n{}", told(&[case]))).collect();
    expect![[r#"
        controller.gain=11
        error: wrong value of `controller.gain`: `11` is not from 0 to 10
          = note: it is `f64` from `0` to `10`, in `1/s`, by default `0.8`, live, declared at topology.yaml:14:9
        controller.gain=high
        error: wrong value of `controller.gain`: expected a finite number, found `high`
          = note: it is `f64` from `0` to `10`, in `1/s`, by default `0.8`, live, declared at topology.yaml:14:9
        controller.gian=1
        error: component `controller` has no parameter `gian`
          = help: did you mean `gain`?
          = note: `scl get controller` shows all
        controller.pin=5
        error: parameter `controller.pin` is fixed while its program runs
          = help: give the value at the start: `scl run --set controller.pin=5`
          = help: or declare it with `live: true`, and build the program anew
          = note: declared at topology.yaml:17:9
        controler.gain=1
        error: system `rover` has no component `controler`
          = help: did you mean `controller`?
          = note: known components: `actuator`, `controller`, `logger`, `sensor`, `user_interface`
        actuator.gain=1
        error: component `actuator` is not running
          = help: give the value at the start: `scl run --set actuator.gain=1`
        sensor.gain=1
        error: component `sensor` has no parameter `gain`
          = note: it has no parameters
        gain=1
        error: expected `component.parameter=value`, found `gain=1`
          = help: write for example `scl set controller.gain=2`
    "#]]
    .assert_eq(&all);
    assert_eq!(rover.text(&["get", "controller.mode"]), "manual\n");
    expect![[r#"
        error: component `controller` has no parameter `gian`
          = help: did you mean `gain`?
          = note: `scl get controller` shows all
    "#]]
    .assert_eq(&rover.error(&["get", "controller.gian"], 2));
    expect![[r#"
        error: component `actuator` is not running
    "#]]
    .assert_eq(&rover.error(&["get", "actuator.gain"], 2));
}

#[test]
fn a_component_that_hangs_is_told_and_a_killed_one_keeps_its_values() {
    let mut rover = rover();
    rover.text(&["set", "controller.gain=3"]);
    kill("-STOP", rover.process_id("controller"));
    let told = rover.error(&["set", "controller.gain=4", "--timeout", "200ms"], 1);
    assert!(told.starts_with("error: component `controller` did not answer within 200ms\n"), "{told}");
    rover.kill("controller");
    assert_eq!(rover.text(&["get", "controller.gain"]), "3\n");
    let told = rover.error(&["set", "controller.gain=4"], 2);
    assert!(told.starts_with("error: component `controller` is not running\n"), "{told}");
    assert!(told.contains("`scl run --set controller.gain=4`"), "{told}");
}
