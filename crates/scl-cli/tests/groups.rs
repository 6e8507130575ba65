//! Components in groups, `arm.sensor`: how they run, and how the commands name them.

use crate::publish::{elsewhere, open};
use crate::rover::{Rover, TOPOLOGY};
use crate::system::{System, without_times};
use expect_test::expect;
use std::time::Duration;

const LONG: Duration = Duration::from_secs(300);

/// The usual system, with sensor and controller in the group `arm`.
fn topology() -> String {
    let ends = TOPOLOGY.replace("[sensor.", "[arm.sensor.").replace("[controller.", "[arm.controller.");
    let ends = ends.replace(" controller.", " arm.controller.");
    ends.replace("name: sensor", "name: arm.sensor").replace("name: controller", "name: arm.controller")
}

/// The system, of which the required components run.
fn grouped() -> Rover {
    let mut rover = Rover::of(&topology());
    rover.play(&["arm.sensor", "arm.controller", "logger", "user_interface"], |_| {});
    rover
}

/// The files of the components of the group, without sockets of peers.
fn files(rover: &Rover) -> Vec<String> {
    let found = std::fs::read_dir(rover.runtime_dir().join("rover")).unwrap();
    let mut names: Vec<String> = found.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| name.starts_with("arm"));
    names.sort();
    names
}

#[test]
fn components_in_groups_find_each_other() {
    let mut rover = grouped();
    let names = files(&rover);
    assert!(
        names.contains(&"arm+sensor.lock".to_owned()) && names.contains(&"arm+controller.json".to_owned()),
        "{names:?}"
    );
    assert!(names.contains(&"arm+sensor.measurements.tap".to_owned()), "{names:?}");
    assert!(names.iter().any(|name| name.starts_with("arm+sensor.measurements--arm+controller.sensor.")), "{names:?}");
    assert!(
        names.iter().all(|name| name.starts_with("arm+sensor.") || name.starts_with("arm+controller.")),
        "{names:?}"
    );
    // What a killed component leaves is removed, and nothing else is.
    rover.kill("arm.sensor");
    rover.play(&["arm.sensor"], |_| {});
    assert_eq!(files(&rover), names);
    let states = rover.json(&["list", "--format", "json"]);
    let running = states["components"].as_array().unwrap().iter().filter(|it| it["state"] == "running");
    let names: Vec<&str> = running.map(|it| it["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["arm.controller", "arm.sensor", "logger", "user_interface"]);
}

#[test]
fn commands_name_components_and_gates_in_full() {
    let rover = grouped();
    let value = rover.text(&["echo", "arm.sensor.measurements", "-n", "1"]);
    assert!(value.contains("speed"), "{value}");
    for (name, key) in [("arm.sensor", "component"), ("arm.sensor.measurements", "gate")] {
        let shown = rover.text(&["info", name]);
        assert!(shown.starts_with(&format!("{key} {name}")) || shown.contains(name), "{shown}");
    }
    let top = rover.json(&["top", "--once", "--format", "json"]);
    let gates: Vec<&str> = top["gates"].as_array().unwrap().iter().map(|row| row["gate"].as_str().unwrap()).collect();
    assert!(gates.contains(&"arm.controller.sensor"), "{gates:?}");
    assert_eq!(rover.text(&["complete-gates", "arm.sensor.m"]), "arm.sensor.measurements\n");
    assert_eq!(rover.text(&["complete-gates", "--components", "arm.s"]), "arm.sensor\n");
    // The peers know the gate if no topology file is there.
    let output = elsewhere(&rover, &["hz", "arm.sensor.measurements", "--once"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn messages_are_sent_in_the_place_of_a_component_in_a_group() {
    let rover = Rover::of(&topology());
    let mut controller = open(&rover, "arm.controller");
    let mut sensor = controller.subscriber("sensor").unwrap();
    rover.text(&["pub", "arm.sensor.measurements", "{speed: 1.5}"]);
    assert_eq!(sensor.recv_timeout(LONG).unwrap(), [&[9][..], &1.5_f64.to_le_bytes()].concat());
}

#[test]
fn wrong_names_are_explained() {
    let rover = grouped();
    let told: Vec<String> = [
        &["info", "arm"][..],
        &["info", "sensor"],
        &["echo", "arm"],
        &["echo", "sensor.measurements"],
        &["echo", "arm.sensor.measurement"],
        &["echo", "arm.senor.measurements"],
    ]
    .iter()
    .map(|arguments| format!("{}\n{}", arguments.join(" "), rover.error(arguments, 2)))
    .collect();
    expect![[r#"
        info arm
        error: system `rover` has no component `arm`
          = help: did you mean `arm.controller`?
          = note: known components: `actuator`, `arm.controller`, `arm.sensor`, `logger`, `user_interface`

        info sensor
        error: system `rover` has no component `sensor`
          = help: did you mean `arm.sensor`?
          = note: known components: `actuator`, `arm.controller`, `arm.sensor`, `logger`, `user_interface`

        echo arm
        error: system `rover` has no component `arm`
          = help: did you mean `arm.sensor`?
          = note: known in `topology.yaml`: `arm.sensor`, `arm.controller`, `logger`, `user_interface`, `actuator`

        echo sensor.measurements
        error: system `rover` has no component `sensor`
          = help: did you mean `arm.sensor`?
          = note: known in `topology.yaml`: `arm.sensor`, `arm.controller`, `logger`, `user_interface`, `actuator`

        echo arm.sensor.measurement
        error: component `arm.sensor` has no gate `measurement`
          = help: did you mean `arm.sensor.measurements`?
          = note: its gates: `arm.sensor.measurements`, `arm.sensor.position`, `arm.sensor.image`, `arm.sensor.log`

        echo arm.senor.measurements
        error: system `rover` has no component `arm.senor`
          = help: did you mean `arm.sensor`?
          = note: known in `topology.yaml`: `arm.sensor`, `arm.controller`, `logger`, `user_interface`, `actuator`
    "#]]
    .assert_eq(&told.join("\n"));
}

#[test]
fn recordings_have_the_full_names() {
    let rover = grouped();
    let output = rover.scl(&["record", "arm.sensor", "-o", "flight.mcap", "--for", "1s"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let shown = rover.text(&["info", "flight.mcap"]);
    assert!(shown.contains("arm.sensor.measurements"), "{shown}");
}

const ARM: &str = "\
system: rover
components:
  - {name: arm.planner, gates: [{path: {pub: u32}}]}
  - {name: arm.driver, gates: [{path: {sub: u32}}]}
codec: json
connections:
  - [arm.planner.path, arm.driver.path]
";

#[test]
fn a_launch_file_names_components_in_full() {
    let launch = "\
transports: {arm.planner.path: tcp}
components:
  arm.planner: {command: 'echo $SCL_COMPONENT $SCL_TRANSPORT'}
  arm.driver: {command: echo driver}
";
    let system = System::of_files(&[("topology.yaml", ARM), ("launch.yaml", launch)]);
    let output = system.run(&[]);
    let mut lines: Vec<&str> = std::str::from_utf8(&output.stdout).unwrap().lines().collect();
    lines.sort_unstable();
    assert_eq!(
        lines,
        ["arm.driver  | driver", "arm.planner | rover.arm.planner arm.planner.path=tcp"],
        "{}",
        without_times(&output.stderr)
    );
    let log = system.scl(&["log", "arm.planner"]).output().unwrap();
    assert!(String::from_utf8_lossy(&log.stdout).contains("rover.arm.planner"), "{log:?}");
}

#[test]
fn wrong_names_in_a_launch_file_are_explained() {
    let launch = "\
transports: {arm.path: tcp, arm.planner: tcp, planner.path: shm}
components:
  planner: {command: 'true'}
  arm.drivr: {command: 'true'}
";
    let system = System::of_files(&[("topology.yaml", ARM), ("launch.yaml", launch)]);
    expect![[r#"
        error: [SCL1205] unknown component `arm`
         --> ./launch.yaml:1:14
          |
        1 | transports: {arm.path: tcp, arm.planner: tcp, planner.path: shm}
          |              ^^^
          |
          = help: did you mean `arm.planner` or `arm.driver`?
          = note: the topology has the components `arm.planner`, `arm.driver`

        error: [SCL1205] unknown gate `arm.planner`
         --> ./launch.yaml:1:29
          |
        1 | transports: {arm.path: tcp, arm.planner: tcp, planner.path: shm}
          |                             ^^^^^^^^^^^
          |
          = help: did you mean `arm.planner.path`?
          = note: the topology has the components `arm.planner`, `arm.driver`

        error: [SCL1205] unknown component `planner`
         --> ./launch.yaml:3:3
          |
        1 | transports: {arm.path: tcp, arm.planner: tcp, planner.path: shm}
          |                                               ------- here too
        2 | components:
        3 |   planner: {command: 'true'}
          |   ^^^^^^^
          |
          = help: did you mean `arm.planner`?
          = note: the topology has the components `arm.planner`, `arm.driver`

        error: [SCL1205] unknown component `arm.drivr`
         --> ./launch.yaml:4:3
          |
        4 |   arm.drivr: {command: 'true'}
          |   ^^^^^^^^^
          |
          = help: did you mean `arm.driver`?
          = note: the topology has the components `arm.planner`, `arm.driver`

    "#]]
    .assert_eq(&without_times(&system.run(&[]).stderr));
}
