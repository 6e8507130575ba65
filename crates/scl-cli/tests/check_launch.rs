//! `scl check` on launch files: the places of all mistakes, the names of the topology, what is fixed.

use crate::system::System;
use expect_test::expect;
use std::fs;

const TOPOLOGY: &str = "\
components:
  - name: sensor
    gates:
      - images: pub
  - name: controller
    gates:
      - images: sub
connections:
  - [sensor.images, controller.images]
";

const WRONG: &str = "\
components:
  sensr:  # the driver
    comand: [./sensor, --rate, 100]
    restart: \"on-failure\"
    restart_limit: 5/1m
    ready_within: 5
  controller: {command:./controller, essential: yes}
transports: {sensor.image: shm}
";

/// A folder with a topology and a launch file.
fn folder(launch: &str) -> System {
    System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", launch)])
}

/// What `scl check` with these arguments prints, and its exit code.
fn check(system: &System, arguments: &[&str]) -> (String, String, Option<i32>) {
    let output = system.scl(&[&["check"], arguments].concat()).output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap(), output.status.code())
}

#[test]
fn every_mistake_has_its_place() {
    let (out, err, code) = check(&folder(WRONG), &["launch.yaml"]);
    assert_eq!((out.as_str(), code), ("", Some(1)));
    expect![[r#"
        error: [SCL1205] unknown component `sensr`
         --> launch.yaml:2:3
          |
        2 |   sensr:  # the driver
          |   ^^^^^
          |
          = help: did you mean `sensor`?
          = note: the topology has the components `sensor`, `controller`

        error: [SCL1201] unknown key `comand` in component `sensr`
         --> launch.yaml:3:5
          |
        3 |     comand: [./sensor, --rate, 100]
          |     ^^^^^^
          |
          = help: did you mean `command`?

        error: [SCL1202] `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `on-failure`
         --> launch.yaml:4:14
          |
        4 |     restart: "on-failure"
          |              ^^^^^^^^^^^^
          |
          = help: did you mean `restart: on_failure`?

        error: [SCL1202] `restart_limit` is a number of restarts and a time, like `5 in 1m`, not `5/1m`
         --> launch.yaml:5:20
          |
        5 |     restart_limit: 5/1m
          |                    ^^^^
          |
          = help: did you mean `restart_limit: 5 in 1m`?

        error: [SCL1202] `ready_within` is a time like `500ms` or `3s`, not `5`
         --> launch.yaml:6:19
          |
        6 |     ready_within: 5
          |                   ^
          |
          = help: did you mean `ready_within: 5s`?

        error: [SCL0103] missing space after `:`
         --> launch.yaml:7:23
          |
        7 |   controller: {command:./controller, essential: yes}
          |                       ^ YAML reads `command:./controller` as one word
          |
          = help: write `command: ./controller`

        error: [SCL1202] `essential` is `true` or `false`, not `yes`
         --> launch.yaml:7:49
          |
        7 |   controller: {command:./controller, essential: yes}
          |                                                 ^^^
          |
          = help: did you mean `essential: true`?

        error: [SCL1205] unknown gate `sensor.image`
         --> launch.yaml:8:14
          |
        8 | transports: {sensor.image: shm}
          |              ^^^^^^^^^^^^
          |
          = help: did you mean `sensor.images`?
          = note: component `sensor` has the gates `sensor.images`

        launch.yaml: 8 errors
    "#]]
    .assert_eq(&err);
}

#[test]
fn what_is_certain_is_fixed() {
    let system = folder(WRONG);
    let (diff, _, code) = check(&system, &["--fix", "--dry-run", "launch.yaml"]);
    assert_eq!((fs::read_to_string(system.path("launch.yaml")).unwrap().as_str(), code), (WRONG, Some(1)));
    expect![[r#"
        --- launch.yaml
        +++ launch.yaml
        @@ -1,8 +1,8 @@
         components:
        -  sensr:  # the driver
        -    comand: [./sensor, --rate, 100]
        -    restart: "on-failure"
        -    restart_limit: 5/1m
        +  sensor:  # the driver
        +    command: [./sensor, --rate, 100]
        +    restart: on_failure
        +    restart_limit: 5 in 1m
             ready_within: 5
        -  controller: {command:./controller, essential: yes}
        -transports: {sensor.image: shm}
        +  controller: {command: ./controller, essential: true}
        +transports: {sensor.images: shm}
    "#]]
    .assert_eq(&diff);
    let (_, err, code) = check(&system, &["--fix", "launch.yaml"]);
    assert_eq!(code, Some(1));
    assert!(err.starts_with("launch.yaml: 7 problems fixed\n\nerror: [SCL1202] `ready_within`"), "{err}");
    let fixed = fs::read_to_string(system.path("launch.yaml")).unwrap();
    fs::write(system.path("launch.yaml"), fixed.replace("ready_within: 5", "ready_within: 5s")).unwrap();
    assert_eq!(check(&system, &["launch.yaml"]), (String::new(), "launch.yaml: no mistakes\n".to_owned(), Some(0)));
}

#[test]
fn names_are_those_of_the_topology_that_the_file_names() {
    let system = folder("topology: other.yaml\ncomponents: {sensor: {command: ./sensor}}\n");
    let (_, err, _) = check(&system, &["launch.yaml"]);
    assert!(err.contains("the topology file does not exist: `other.yaml`\n --> launch.yaml:1:11"), "{err}");
    system.write("other.yaml", &TOPOLOGY.replace("sensor", "camera"));
    let (_, err, _) = check(&system, &["launch.yaml"]);
    assert!(err.contains("the topology has the components `camera`, `controller`"), "{err}");
    // Mistakes of the topology are not those of the launch file.
    system.write("other.yaml", &TOPOLOGY.replace("pub", "teapot"));
    let (_, err, code) = check(&system, &["launch.yaml"]);
    expect![[r#"
        warning: [SCL1209] the topology `other.yaml` has errors, so names are not checked
         |
         = help: run `scl check other.yaml`

        launch.yaml: 1 warning
    "#]]
    .assert_eq(&err);
    assert_eq!(code, Some(0));
}

#[test]
fn a_file_that_cannot_be_read_is_called_a_launch_file() {
    let (_, err, code) = check(&folder(""), &["launch-sim.yaml"]);
    assert!(err.starts_with("error: [SCL0001] cannot find the launch file `launch-sim.yaml`"), "{err}");
    assert_eq!(code, Some(2));
}

#[test]
fn programs_get_the_same() {
    let system = folder("components: {sensor: {command: ./sensor, restart: allways}}\n");
    let (out, _, code) = check(&system, &["--format", "json", "launch.yaml"]);
    assert_eq!(code, Some(1));
    expect![[r#"
        {"code":"SCL1202","severity":"error","message":"`restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `allways`","file":"launch.yaml","line":1,"column":51,"end_line":1,"end_column":58,"labels":[{"file":"launch.yaml","line":1,"column":51,"end_line":1,"end_column":58,"text":""}],"helps":["did you mean `restart: always`?"],"notes":[],"fixes":[{"file":"launch.yaml","line":1,"column":51,"end_line":1,"end_column":58,"replacement":"always","sure":true,"proposal":0,"help":0}]}
    "#]].assert_eq(&out);
    let (out, _, _) = check(&system, &["--format", "sarif", "launch.yaml"]);
    assert!(out.contains("\"text\": \"value that the key does not accept\""), "{out}");
}
