//! `scl list`: what runs, what ran, and what is only known as a peer.

use crate::rover::{COMPONENTS, Rover};
use expect_test::expect;
use scl_tests::wait_for;
use serde_json::Value;

#[test]
fn components_and_their_states_are_listed() {
    let mut rover = Rover::start();
    rover.kill("user_interface");
    rover.stop("logger");
    // The figures of the sensor, whose logger is gone, and of the others come a moment later.
    rover.wait_for(&["list"], |list| (list["components"][3]["ready"] == false).then_some(()));
    expect![[r#"
        rover: 2 running, 1 dead, 2 stopped

        COMPONENT STATE PID FOR PROGRAM
        actuator stopped
        controller waiting PID AGE tests
        logger stopped
        sensor waiting PID AGE tests
        user_interface dead PID tests
    "#]]
    .assert_eq(&shown(&rover, &["list"]));
}

#[test]
fn gates_are_listed_with_types_and_peers() {
    let rover = Rover::start();
    // Gates that listen for any number of peers do not wait for them to be ready.
    let listening = ["logger.events pull rover.Event protobuf 2/2", "rover.Status protobuf 1/1\ncontroller.log"];
    let text = wait_for("the peers of all gates", || {
        let text = shown(&rover, &["list", "-v"]);
        (!text.contains("waiting") && listening.iter().all(|gate| text.contains(gate))).then_some(text)
    });
    expect![[r#"
        rover: 4 running, 1 stopped

        COMPONENT STATE PID FOR PROGRAM
        actuator stopped
        controller running PID AGE tests
        logger running PID AGE tests
        sensor running PID AGE tests
        user_interface running PID AGE tests

        GATE KIND TYPE CODEC PEERS
        controller.sensor sub rover.Measurement protobuf 1/1
        controller.position sub rover.Position json 1/1
        controller.actuator pub rover.Setpoint protobuf 0/1
        controller.commands rep rover.Command -> rover.Status protobuf 1/1
        controller.log push rover.Event protobuf 1/1
        logger.events pull rover.Event protobuf 2/2
        logger.images sub bytes raw 1/1
        sensor.measurements pub rover.Measurement protobuf 1/1
        sensor.position pub rover.Position json 1/1
        sensor.image pub bytes raw 1/1
        sensor.log push rover.Event protobuf 1/1
        user_interface.commands req rover.Command -> rover.Status protobuf 1/1
    "#]]
    .assert_eq(&text);
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
    let mut rover = Rover::stopped();
    rover.play_alone("sensor");
    rover.stop("sensor");
    for arguments in [&["list"][..], &["list", "--system", "rover"]] {
        assert!(rover.text(arguments).starts_with("rover: 1 stopped\n"), "{arguments:?}");
    }
    let error = rover.error(&["list", "--system", "rovr"], 2);
    assert!(error.contains("error: there is no system `rovr`\n  = help: did you mean `rover`?"), "{error}");
}

#[test]
fn all_running_systems_are_listed() {
    let mut rover = Rover::start();
    rover.play(&COMPONENTS, |command| {
        command.env("SCL_SYSTEM", "twin");
    });
    rover.write("topology.yaml", "system: third\ncomponents:\n  - name: other\n");
    let text = rover.text(&["list"]);
    assert!(text.starts_with("rover: 4 running") && text.contains("\n\ntwin: 4 running"), "{text}");
    let systems = rover.json(&["list", "--format", "json"])["systems"].clone();
    let names: Vec<_> = systems.as_array().unwrap().iter().map(|system| &system["system"]).collect();
    assert_eq!(names, ["rover", "twin"]);
    let top = rover.text(&["top", "--once", "--period", "100ms"]);
    assert!(top.starts_with("rover:\n") && top.contains("\n\ntwin:\n"), "{top}");
    assert!(rover.text(&["list", "--system", "twin"]).starts_with("twin: "));
    // Everything else needs one.
    let several = "error: several systems are running\n  = help: name one: `--system rover`, or set `SCL_SYSTEM`\n  \
                   = note: running: `rover`, `twin`\n";
    for arguments in [&["info", "sensor"][..], &["echo", "sensor"], &["hz"], &["record"], &["pub", "sensor.image", "x"]]
    {
        assert_eq!(rover.error(arguments, 2), several, "{arguments:?}");
    }
    #[cfg(feature = "run")]
    assert_eq!(rover.error(&["log", "sensor"], 2), several);
}

#[test]
fn nothing_is_cut_in_a_pipe() {
    // Longer than a column, but not too long for the path of a socket.
    let name = "measurement_unit_of_the_left_front_wheel";
    let topology = format!(
        "system: rover\nschemas: [rover.proto]\ncomponents:\n  - name: {name}\n    gates:\n      \
         - measurements: {{pub: rover.Measurement}}\n"
    );
    let mut rover = Rover::of(&topology);
    rover.play_alone(name);
    let gate = format!("{name}.measurements");
    for arguments in [&["list", "-v"][..], &["info", name], &["info", &gate], &["top", "--once"]] {
        let text = rover.text(arguments);
        assert!(text.contains(name) && !text.contains('…'), "{arguments:?}: {text}");
    }
    assert!(rover.text(&["list", "-v"]).contains(&gate));
}

/// A table with single spaces, and with process numbers as `PID`, ages as `AGE` and test programs as `tests`.
fn shown(rover: &Rover, arguments: &[&str]) -> String {
    let text = rover.text(arguments);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let shown = lines.map(|words| match &words[..] {
        [component, state @ .., pid, number, unit, program] if program.starts_with("tests-") => {
            pid.parse::<u32>().unwrap();
            number.parse::<f64>().unwrap();
            assert!(["s", "min"].contains(unit), "{text}");
            format!("{component} {} PID AGE tests\n", state.join(" "))
        }
        [component, "dead", _, program] if program.starts_with("tests-") => format!("{component} dead PID tests\n"),
        words => words.join(" ") + "\n",
    });
    shown.collect()
}
