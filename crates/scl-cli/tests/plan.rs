//! What `scl plan` prints, and that it comes back as the same plan.

use crate::system::System;
use expect_test::{Expect, expect};
use scl_plan::{Plan, SystemPlan};
use std::collections::BTreeSet;
use std::process::{Output, Stdio};

const ROVER: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement, codec: json}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, codec: json, queue: 1}
connections:
  - [sensor.measurements, controller.sensor]
";

fn scl_plan(files: &[(&str, &str)], arguments: &[&str]) -> Output {
    System::of_files(files).scl(&[&["plan"], arguments].concat()).output().unwrap()
}

#[track_caller]
fn check(files: &[(&str, &str)], arguments: &[&str], code: i32, expected_error: Expect) {
    let output = scl_plan(files, arguments);
    expected_error.assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(code), true));
}

#[test]
fn a_plan_names_everything_a_program_needs() {
    let output = scl_plan(&[("topology.yaml", ROVER)], &["--component", "controller"]);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    let text = String::from_utf8(output.stdout).unwrap();
    expect![[r#"
        {
          "version": 1,
          "system": "rover",
          "components": [
            {
              "name": "controller",
              "declared_at": "topology.yaml:6:11",
              "schema": null,
              "gates": [
                {
                  "name": "sensor",
                  "kind": "sub",
                  "payload": {
                    "message": "rover.Measurement"
                  },
                  "codec": "json",
                  "declared_at": "topology.yaml:8:9",
                  "endpoint": null,
                  "tap": null,
                  "contract": "ptascz5j",
                  "max_size": 67108864,
                  "queue": 1,
                  "when_full": "drop_oldest",
                  "backpressure": false,
                  "latched": false,
                  "timeout_ns": 1000000000,
                  "in_flight": 1,
                  "undecodable": "skip",
                  "connections": [
                    {
                      "peer_component": "sensor",
                      "peer_gate": "measurements",
                      "endpoint": "sensor.measurements--controller.sensor.ptascz5j",
                      "contract": "ptascz5j",
                      "required": true,
                      "queue": 1,
                      "when_full": "drop_oldest",
                      "max_size": 67108864
                    }
                  ]
                }
              ]
            }
          ],
          "schemas": {}
        }
    "#]]
    .assert_eq(&text);
    assert_eq!(Plan::from_json(&text).unwrap().to_json(), text);
}

#[test]
fn every_component_is_planned_in_file_order() {
    let text = String::from_utf8(scl_plan(&[("rover.yaml", ROVER)], &["rover.yaml"]).stdout).unwrap();
    let system = SystemPlan::from_json(&text).unwrap();
    let names: Vec<&str> = system.components.iter().map(|plan| plan.component.as_str()).collect();
    assert_eq!((system.system.as_str(), names), ("rover", vec!["sensor", "controller"]));
    assert_eq!(system.to_json(), text);
    assert_eq!(system.component("sensor").unwrap().gates[0].declared_at, "rover.yaml:5:9");
}

/// Two lamps of a kind, and one that is not.
const LAMPS: &str = "\
kinds:
  - {name: lamp, gates: []}
components:
  - {name: red, kind: lamp}
  - {name: white, gates: []}
  - {name: green, kind: lamp}
";

#[test]
fn the_plan_of_a_kind_is_that_of_its_components() {
    let of = |arguments: &[&str]| {
        let output = scl_plan(&[("topology.yaml", LAMPS)], arguments);
        let plan = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
        let kinds: Vec<String> =
            plan.kinds.iter().map(|kind| format!("{}={}", kind.name, kind.components.join("+"))).collect();
        let names: Vec<String> = plan.components.into_iter().map(|plan| plan.component).collect();
        format!("{} {}", names.join(","), kinds.join(","))
    };
    assert_eq!(of(&[]), "red,white,green lamp=red+green");
    assert_eq!(of(&["--component", "lamp"]), "red,green lamp=red+green");
    assert_eq!(of(&["--component", "green"]), "green ");
}

#[test]
fn messages_are_in_the_plan() {
    let schema = "syntax = \"proto3\"; package rover; message Measurement { double speed = 1; }";
    let yaml = ROVER.replace("system: rover", "schemas: [rover.proto]").replace(", codec: json", "");
    let lonely = "connections:\n  - [sensor.measurements, controller.sensor]";
    let yaml = yaml.replace(lonely, &format!("  - name: clock\n    gates: []\n{lonely}"));
    let output = scl_plan(&[("topology.yaml", &yaml), ("rover.proto", schema)], &[]);
    let system = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
    let schemas = ["sensor", "controller", "clock"].map(|name| system.component(name).unwrap().schema.clone());
    assert!(schemas[0].as_ref().unwrap().descriptors.windows(5).any(|bytes| bytes == b"speed"));
    assert_eq!((&schemas[1], &schemas[2]), (&schemas[0], &None));
}

#[test]
fn a_topology_is_read_from_standard_input() {
    let system = System::of_files(&[("rover.yaml", ROVER)]);
    let input = Stdio::from(std::fs::File::open(system.path("rover.yaml")).unwrap());
    let output = system.scl(&["plan", "-"]).stdin(input).output().unwrap();
    let plan = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
    assert_eq!(plan.components[1].declared_at, "<stdin>:6:11");
}

#[test]
fn an_unknown_component_is_answered_with_the_known_ones() {
    check(
        &[("topology.yaml", ROVER)],
        &["--component", "sensr"],
        1,
        expect![[r#"
        error: system `rover` has no component `sensr`; did you mean `sensor`?
          = note: its 2 components: `sensor`, `controller`
    "#]],
    );
    check(
        &[("topology.yaml", ROVER)],
        &["--component", "display"],
        1,
        expect![[r#"
        error: system `rover` has no component `display`
          = note: its 2 components: `sensor`, `controller`
    "#]],
    );
    let many = (0..12).map(|number| format!("  - name: part_{number}\n    gates: []\n"));
    let many = format!("components:\n{}", many.collect::<String>());
    check(
        &[("topology.yaml", &many)],
        &["--component", "display"],
        1,
        expect![[r#"
        error: system `topology` has no component `display`
          = note: its 12 components: `part_0`, `part_1`, `part_2`, `part_3`, `part_4`, `part_5`, `part_6`, `part_7`, `part_8`, `part_9`, ...
    "#]],
    );
}

#[test]
fn a_topology_with_errors_has_no_plan() {
    for (file, text, code) in [("topology.yaml", "unknown section `colour`", 1), ("nowhere.yaml", "cannot find", 2)] {
        let output = scl_plan(&[("topology.yaml", "colour: red\n")], &[file]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(text), "{error}");
        assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(code), true));
    }
}

/// `docs/plan.md` explains every field, and no other.
#[test]
fn the_format_is_documented() {
    let page = include_str!("../../../docs/plan.md");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let names = rows.filter_map(|line| line.split('|').nth(1)).flat_map(|cell| cell.split(','));
    let documented: BTreeSet<&str> = names.map(|name| name.trim().trim_matches('`')).collect();
    let yaml = ROVER.replace(
        "gates:\n      - measurements",
        "gates:\n      - ask: {req: A -> B, unconnected: ok}\n      - measurements",
    );
    let yaml = yaml
        .replace("codec: json}", "codec: json, rate: 100Hz}")
        .replace("codec: json, queue: 1}", "codec: json, queue: 1, deadline: 1s, max_age: 1s}")
        .replace(
            "components:\n",
            "kinds:\n  - {name: lamp, parameters: PARAMETERS, gates: []}\ncomponents:\n  - {name: red, kind: lamp}\n",
        )
        .replace(
            "PARAMETERS",
            "[{a: {f64: 1, range: [0, 2], unit: m, doc: text, live: true}}, {b: {one_of: [c, d]}}, {e: {list: u8, length: 2}}]",
        );
    let text = String::from_utf8(scl_plan(&[("topology.yaml", &yaml)], &[]).stdout).unwrap();
    let keys = text.lines().filter_map(|line| line.trim().strip_prefix('"')?.split_once("\":"));
    let printed: BTreeSet<&str> = keys.map(|(key, _)| key).collect();
    assert_eq!(documented, printed);
    // The example is a shortened one of the same format.
    let example = page.split("```").nth(1).unwrap().trim_start_matches("json");
    let example = example.replace("CkwKC3Jv...", "");
    assert_eq!(SystemPlan::from_json(&example).unwrap().components[0].gates[0].connections.len(), 1);
}

/// The topology of `docs/memory.md`.
fn page_topology() -> (&'static str, String) {
    let page = include_str!("../../../docs/memory.md");
    let example = page.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    (page, example.to_owned())
}

/// Standard output and standard error of `scl plan --memory`.
fn memory(topology: &str, arguments: &[&str]) -> (String, String) {
    let output = scl_plan(&[("topology.yaml", topology)], &[&["--memory"], arguments].concat());
    let [out, error] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(output.status.code(), Some(0), "{error}");
    (out, error)
}

#[test]
fn what_the_gates_may_hold_is_printed() {
    let (page, topology) = page_topology();
    let (table, advice) = memory(&topology, &[]);
    expect![[r#"
        COMPONENT, GATE  KIND     MESSAGES  WAITING  IN FLIGHT  LATCHED    TOTAL  BOUND
        camera                                40MiB       8MiB     4MiB    52MiB  64MiB
          frames         pub     10 x 4MiB    40MiB       8MiB     4MiB    52MiB
        detector                            6.29GiB     133MiB           6.42GiB
          objects        pub   100 x 64MiB  6.25GiB     128MiB           6.38GiB
          frames         sub     10 x 4MiB    40MiB       5MiB             45MiB
        map                                 6.25GiB      65MiB           6.32GiB
          objects        sub   100 x 64MiB  6.25GiB      65MiB           6.32GiB
        system rover                                                     12.8GiB
          = help: declare `max_size` at `map.objects`: with the defaults, 100 messages of 64MiB, 6.25GiB may wait at each end
          = note: this is an upper bound on messages over sockets, without shared memory (`shm`)
    "#]].assert_eq(&format!("{table}{advice}"));
    assert!(page.contains(&format!("```console\n$ scl plan --memory\n{table}{advice}```\n")), "the page differs");
}

const MOTORS: &str = "\
kinds:
  - name: motor
    memory: 2MiB
    gates:
      - setpoint: {sub: Setpoint, queue: 1, max_size: 1KiB}
      - state: {pub: State}
components:
  - {name: left, kind: motor}
  - {name: right, kind: motor}
  - name: controller
    gates:
      - setpoints: {pub: Setpoint, latched: true}
      - states: {sub: State, max_size: 4KiB}
      - path: {req: Goal -> Path, max_size: 1MiB}
  - name: planner
    gates:
      - path: {rep: Goal -> Path, max_size: 1KiB}
      - debug: {pub: Trace, unconnected: ok}
connections:
  - [controller.setpoints, each motor.setpoint]
  - [each motor.state, controller.states]
  - [controller.path, planner.path]
";

#[test]
fn components_of_a_kind_that_hold_the_same_are_one_row() {
    let (table, advice) = memory(MOTORS, &[]);
    expect![[r#"
        COMPONENT, GATE       KIND    MESSAGES  WAITING  IN FLIGHT  LATCHED       TOTAL  BOUND
        motor (2 components)                     401KiB     101KiB           2 x 502KiB   2MiB
          state               pub   100 x 4KiB   400KiB      68KiB               468KiB
          setpoint            sub     1 x 1KiB     1KiB      33KiB                34KiB
        controller                               401KiB    4.29MiB     1KiB     4.68MiB
          states              sub   100 x 4KiB   400KiB    2.01MiB               2.4MiB
          path                req                          2.28MiB              2.28MiB
          setpoints           pub     1 x 1KiB     1KiB       3KiB     1KiB        5KiB
        planner                                            2.26MiB              2.26MiB
          path                rep                          2.26MiB              2.26MiB
        system topology                                                         7.91MiB
          = note: this is an upper bound on messages over sockets, without shared memory (`shm`)
    "#]]
    .assert_eq(&format!("{table}{advice}"));
    // Only one of them has a publisher.
    let other = MOTORS.replace("each motor.setpoint", "left.setpoint");
    let names =
        |text: &str| text.lines().filter(|line| !line.starts_with(' ')).map(|line| line[..10].to_owned()).collect();
    let names: Vec<String> = names(&memory(&other, &["--component", "motor"]).0);
    assert_eq!(names, ["COMPONENT,", "left      ", "right     ", "system top"]);
}

#[test]
fn what_the_gates_may_hold_is_json_in_bytes() {
    let (json, advice) = memory(MOTORS, &["--component", "left", "--format", "json"]);
    expect![[r#"
        {
          "components": [
            {
              "bound": 2097152,
              "gates": [
                {
                  "in_flight": 33792,
                  "kind": "sub",
                  "latched": 0,
                  "longest": 1024,
                  "messages": 1,
                  "name": "setpoint",
                  "total": 34816,
                  "waiting": 1024
                },
                {
                  "in_flight": 69632,
                  "kind": "pub",
                  "latched": 0,
                  "longest": 4096,
                  "messages": 100,
                  "name": "state",
                  "total": 479232,
                  "waiting": 409600
                }
              ],
              "kind": "motor",
              "name": "left",
              "total": 514048
            }
          ],
          "system": "topology",
          "total": 514048
        }
    "#]]
    .assert_eq(&json);
    assert_eq!(advice, "");
}
